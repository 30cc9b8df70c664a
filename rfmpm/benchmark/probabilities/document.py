"""The report of the estimators: probabilities.md and its picture."""

import multiprocessing
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np

from rfmpm.benchmark.probabilities import model_problems, rare, slope, stratified
from rfmpm.benchmark.probabilities.bank import columns
from rfmpm.benchmark.probabilities.cases import COMPONENTS, NUMBERS, REPLICATE, studies
from rfmpm.benchmark.probabilities.picture import draw
from rfmpm.benchmark.probabilities.repeats import Bank, Judged, judge, repeats
from rfmpm.benchmark.probabilities.slope import QUESTIONS, Reference, makers
from rfmpm.benchmark.probabilities.text import RARE, TEXT
from rfmpm.study import Study

SIZES = (32, 64, 128)  # realisations on 0.25 m cells
COVERED = 128  # of them for the table of coverage
COARSE_SIZE = 256
REPEATS, SLOWER = 300, 3  # of a mean or a probability; a quantile has fewer by this factor
SEED = 2026
FEW = {"fine": 48, "coarse": 1024, "latin_hypercube": 256, "sobol": 256}  # rows for a look at the machinery


def run(folder: Path, quick: bool, tell: Callable[[str], None]) -> Path:
    """Judge the estimators and write the report.

    Args:
        folder: where probabilities.md, its picture and its rows go; made if missing.
        quick: few rows, few repeats and one small probability: a look at the machinery.
        tell: is told the progress, line by line.

    Returns:
        The report's path.
    """
    folder.mkdir(parents=True, exist_ok=True)
    cases = studies(FEW if quick else NUMBERS)
    found = columns(folder, cases, tell)
    banks = slope.banks(cases, found)
    number = 10 if quick else REPEATS
    fine = _fine(banks, number, SIZES[:1] if quick else SIZES, tell)
    references = {name: slope.reference(banks["pair"], question) for name, question in QUESTIONS.items()}
    coarse = list(_coarse(banks, number, tell))
    curves = {name: {one: list(sizes.values()) for one, sizes in by.items()} for name, by in fine.items()}
    draw(curves, references, folder / "probabilities.png")
    small = rare.limit_of(found["coarse"].run_out)
    seeds = rare.SEEDS[:1] if quick else rare.SEEDS
    subsets = list(rare.subset_simulations(cases["coarse"], small.limit, seeds, rare.SIZES, tell))
    path = folder / "probabilities.md"
    text = TEXT.format(
        rows=", ".join(f"{len(column.run_out)} ({name.replace('_', ' ')})" for name, column in found.items()),
        ratio=banks["pair"].cost[1],
        repeats=number,
        fewer=number // SLOWER,
        gains="\n".join(_gains(fine, references)),
        coverage="\n".join(_coverage(fine, references, SIZES[0] if quick else COVERED)),
        coarse_rows=len(found["coarse"].run_out),
        replicate=REPLICATE,
        components=COMPONENTS,
        coarse="\n".join(coarse),
        small=_small(small, len(found["coarse"].run_out)),
        rare=rare_section(folder, cases["coarse"], small, quick, tell),
        subset_most=rare.AT_MOST,
        **rare.SIZES,
        subsets="\n".join(_subsets(subsets, small)),
        plain=round((1.0 - small.probability) / small.probability / 0.3**2),
    )
    path.write_text(text, encoding="utf-8")
    return path


def rare_section(folder: Path, study: Study, small: rare.Small, quick: bool, tell: Callable[[str], None]) -> str:
    """Write what the report says of stratified sampling: on the slope, and on model problems beside other ways.

    Args:
        folder: that holds the rows of its campaigns, or gets them.
        study: on the coarse cells.
        small: the probability in question.
        quick: one campaign, few repeats: a look at the machinery.
        tell: is told the progress.
    """
    chosen = stratified.SEEDS[:1] if quick else stratified.SEEDS
    found = list(stratified.campaigns(study, small.limit, chosen, folder, tell))
    return RARE.format(
        at_most=stratified.AT_MOST,
        stratified="\n".join(stratified.lines(found, chosen, small)),
        repeats=2 if quick else model_problems.REPEATS,
        most=model_problems.MOST,
        problems="\n".join(model_problems.table(2 if quick else model_problems.REPEATS, tell)),
    )


Found = dict[str, dict[str, dict[int, Judged]]]  # by question, estimator and number of realisations


def _fine(banks: dict[str, Bank], number: int, sizes: tuple[int, ...], tell: Callable[[str], None]) -> Found:
    truths = {name: slope.reference(banks["pair"], question).value for name, question in QUESTIONS.items()}
    jobs = [(name, estimator, size) for name in QUESTIONS for size in sizes for estimator in _of("pair")]
    return _carried_out(jobs, banks, truths, number, tell)


def _of(*where: str) -> list[str]:
    """The estimators that draw from some of the banks."""
    return [name for name, (bank, _) in makers(QUESTIONS["mean"], 1).items() if bank in where]


def _carried_out(
    jobs: list[tuple[str, str, int]],
    banks: dict[str, Bank],
    truths: dict[str, float],
    number: int,
    tell: Callable[[str], None],
) -> Found:
    """Judge question, estimator and number of realisations of each job, as many at once as there are processors."""
    found: Found = {}
    with multiprocessing.get_context("fork").Pool() as pool:
        judged = pool.imap(partial(_judged, banks, truths, number), jobs)
        for (name, estimator, size), one in zip(jobs, judged, strict=True):
            found.setdefault(name, {}).setdefault(estimator, {})[size] = one
            tell(f"{name}, {estimator}, {size}: error {one.root_mean_square_error:.4g}, coverage {one.coverage:.3f}")
    return found


def _judged(banks: dict[str, Bank], truths: dict[str, float], number: int, job: tuple[str, str, int]) -> Judged:
    name, estimator, size = job
    where, make = makers(QUESTIONS[name], size)[estimator]
    if QUESTIONS[name].kind == "quantile":  # each takes a hundred times as long
        number //= SLOWER
    return judge(list(repeats(make, banks[where], number, SEED)), truths[name])


def _plain_deviation(by: dict[str, dict[int, Judged]], reference: Reference) -> float:
    """Root-mean-square error of plain Monte Carlo times the root of its cost."""
    if np.isfinite(reference.deviation):
        return reference.deviation
    plain = next(iter(by.values()))
    return float(np.mean([judged.root_mean_square_error * np.sqrt(judged.cost) for judged in plain.values()]))


def _gains(found: Found, references: dict[str, Reference]) -> Iterator[str]:
    yield "| question | reference | estimator | realisations: cost, error, gain |"
    yield "|---|---|---|---|"
    for name, by in found.items():
        deviation, reference = _plain_deviation(by, references[name]), references[name]
        for estimator, sizes in by.items():
            cells = [
                f"{size}: {one.cost:.0f}, {one.root_mean_square_error:.3g}, "
                f"**{deviation**2 / one.cost / one.root_mean_square_error**2 * _finite(size):.1f}**"
                for size, one in sizes.items()
            ]
            known = f"{reference.value:.4g} ± {reference.standard_error:.2g}"
            yield f"| {name} | {known} | {estimator} | {'; '.join(cells)} |"


def _finite(size: int) -> float:
    """What the square of an error lacks where so many realisations are drawn without putting them back."""
    return 1.0 - size / NUMBERS["fine"]


def _coverage(found: Found, references: dict[str, Reference], size: int) -> Iterator[str]:
    yield f"| question | estimator, {size} | bias / standard error | coverage |"
    yield "|---|---|---|---|"
    for name, by in found.items():
        for estimator, sizes in by.items():
            yield f"| {name} | {estimator} | {_bias(sizes[size], references[name])} | {sizes[size].coverage:.3f} |"


def _bias(judged: Judged, reference: Reference) -> str:
    return f"{judged.bias / np.hypot(judged.bias_error, reference.standard_error):+.1f}"


def _coarse(banks: dict[str, Bank], number: int, tell: Callable[[str], None]) -> Iterator[str]:
    references = {name: slope.reference(banks["coarse"], question) for name, question in QUESTIONS.items()}
    estimators = _of("coarse", "latin_hypercube", "sobol")
    jobs = [(name, estimator, COARSE_SIZE) for name in QUESTIONS for estimator in estimators]
    truths = {name: reference.value for name, reference in references.items()}
    found = _carried_out(jobs, banks, truths, number, tell)
    yield f"| question | estimator, {COARSE_SIZE} realisations | bias / standard error | coverage | variance ratio |"
    yield "|---|---|---|---|---|"
    for name, by in found.items():
        plain = next(iter(by.values()))[COARSE_SIZE].root_mean_square_error
        for estimator, sizes in by.items():
            one = sizes[COARSE_SIZE]
            ratio = (plain / one.root_mean_square_error) ** 2
            yield f"| {name} | {estimator} | {_bias(one, references[name])} | {one.coverage:.3f} | {ratio:.2f} |"


def _small(small: rare.Small, number: int) -> str:
    return (
        f"P(run-out > {small.limit:g} m) on cells of 0.5 m is {small.probability:.2e} by the {number} independent "
        f"realisations (95 % interval {small.lower:.2e} to {small.upper:.2e})."
    )


def _subsets(found: list[rare.Found], small: rare.Small) -> Iterator[str]:
    yield "| seed | probability | 95 % interval | realisations |"
    yield "|---|---|---|---|"
    for seed, one in zip(rare.SEEDS, found, strict=False):
        yield f"| {seed} | {one.value:.2e} | {one.lower:.2e} to {one.upper:.2e} | {one.runs} |"
    values = np.array([one.value for one in found])
    error = np.sqrt(np.mean((values / small.probability - 1.0) ** 2))
    holds = sum(one.lower <= small.upper and small.lower <= one.upper for one in found)
    yield ""
    yield (
        f"Mean {values.mean():.2e}; relative root-mean-square error against the reference {error:.0%}, which has "
        f"one itself; {holds} of {len(found)} intervals meet the reference's."
    )
