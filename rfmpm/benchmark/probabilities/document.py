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
from rfmpm.benchmark.probabilities.slope import QUESTIONS, makers, truth
from rfmpm.benchmark.probabilities.text import RARE, TEXT
from rfmpm.estimators.strata import natural_breaks
from rfmpm.study import Study

SIZES = (32, 64, 128)  # realisations on 0.25 m cells
PLAIN_SIZES = (128, 256, 512, 1024)  # of plain Monte Carlo
COARSE_SIZE = 256
REPEATS = 500  # that measure a coverage
FEWER, QUANTILES = 5, 10  # repeats are divided by: for an error alone; for a quantile, which takes much longer
SEED = 2026
ASKED = {"mean": 5.0, "P(> 5 m)": 3.0}  # gains over plain Monte Carlo
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
    fine = _fine(banks, number, quick, tell)
    coarse = list(_coarse(banks, number, tell))
    curves = {name: {one: list(sizes.values()) for one, sizes in by.items()} for name, by in fine.items()}
    draw(curves, folder / "probabilities.png")
    small = rare.limit_of(found["coarse"].run_out)
    seeds = rare.SEEDS[:1] if quick else rare.SEEDS
    subsets = list(rare.subset_simulations(cases["coarse"], small.limit, seeds, rare.SIZES, tell))
    path = folder / "probabilities.md"
    text = TEXT.format(
        rows=", ".join(f"{len(column.run_out)} ({name.replace('_', ' ')})" for name, column in found.items()),
        ratio=banks["pair"].cost[1],
        repeats=number,
        fewer=number // FEWER,
        quantiles=number // QUANTILES,
        population=len(banks["pair"].features),
        difference=_difference(banks["pair"]),
        gains="\n".join(_gains(fine, banks["pair"].value[0])),
        reached="\n".join(_reached(fine, banks["pair"].value[0])),
        coverage="\n".join(_coverage(fine)),
        missed="; ".join(_missed(fine)) or "None",
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


def _fine(banks: dict[str, Bank], number: int, quick: bool, tell: Callable[[str], None]) -> Found:
    jobs = [
        (name, estimator, size)
        for name in QUESTIONS
        for estimator in _of("pair")
        for size in _sizes(estimator)[: 1 if quick else None]
    ]
    return _carried_out(jobs, banks, number, tell)


def _sizes(estimator: str) -> tuple[int, ...]:
    return PLAIN_SIZES if estimator.startswith("plain") else SIZES


def _covered(sizes: dict[int, Judged]) -> int:
    """The size whose coverage is measured: the second one."""
    return list(sizes)[min(1, len(sizes) - 1)]


def _of(*where: str) -> list[str]:
    """The estimators that draw from some of the banks."""
    return [name for name, (bank, _) in makers(QUESTIONS["mean"], 1).items() if bank in where]


def _carried_out(
    jobs: list[tuple[str, str, int]], banks: dict[str, Bank], number: int, tell: Callable[[str], None]
) -> Found:
    """Judge question, estimator and number of realisations of each job, as many at once as there are processors."""
    found: Found = {}
    with multiprocessing.get_context("fork").Pool() as pool:
        judged = pool.imap(partial(_judged, banks, number), jobs)
        for (name, estimator, size), one in zip(jobs, judged, strict=True):
            found.setdefault(name, {}).setdefault(estimator, {})[size] = one
            tell(
                f"{name}, {estimator}, {size}: cost {one.cost:.0f}, error {one.root_mean_square_error:.4g}, "
                f"bias {one.bias / one.bias_error:+.1f}, coverage {one.coverage:.3f}"
            )
    return found


def _judged(banks: dict[str, Bank], number: int, job: tuple[str, str, int]) -> Judged:
    name, estimator, size = job
    question, (where, make) = QUESTIONS[name], makers(QUESTIONS[name], size)[estimator]
    if question.kind == "quantile":
        number //= QUANTILES
    elif size not in (SIZES[1], PLAIN_SIZES[1], COARSE_SIZE):
        number //= FEWER
    values = banks["coarse" if where != "pair" else where].value[0]
    return judge(list(repeats(make, banks[where], max(number, 2), SEED)), truth(values, question))


def _of_plain(name: str, by: dict[str, dict[int, Judged]], values: np.ndarray) -> float:
    """Square of the root-mean-square error of plain Monte Carlo times its cost."""
    question = QUESTIONS[name]
    if question.kind == "quantile":
        return float(
            np.mean([judged.root_mean_square_error**2 * judged.cost for judged in by[_of("pair")[0]].values()])
        )
    return float(np.var(values if question.kind == "mean" else values > question.limit))


def _gains(found: Found, values: np.ndarray) -> Iterator[str]:
    yield "| question | truth | estimator | realisations: cost, error, gain |"
    yield "|---|---|---|---|"
    for name, by in found.items():
        plain = _of_plain(name, by, values)
        for estimator, sizes in by.items():
            cells = [
                f"{size}: {one.cost:.0f}, {one.root_mean_square_error:.3g}, "
                f"**{plain / one.cost / one.root_mean_square_error**2:.1f}**"
                for size, one in sizes.items()
            ]
            yield f"| {name} | {truth(values, QUESTIONS[name]):.4g} | {estimator} | {'; '.join(cells)} |"


def _difference(bank: Bank) -> str:
    """What makes the difference of the cell sizes."""
    own, coarse = bank.value
    stands = coarse < natural_breaks(coarse)[0]
    far = stands & (own > slope.LIMIT)
    close, rest = (_about_line(coarse[part], own[part]) for part in (~stands, slice(None)))
    share = np.sum(rest[far] ** 2) / np.sum(rest**2)
    return (
        f"{np.mean(~stands):.0%} of the slopes fail on coarse cells, and end on fine ones {np.std(close):.2f} m "
        f"(standard deviation)\nfrom a line in the coarse run-out. Of the {stands.sum()} that stand there, "
        f"{far.sum()} fail on fine cells and run {own[far].mean():.0f} m on average:\n"
        f"they make {share:.0%} of the variance that a line in the coarse run-out leaves."
    )


def _about_line(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return y - np.polyval(np.polyfit(x, y, 1), x)


def _reached(found: Found, values: np.ndarray) -> Iterator[str]:
    """From which cost on the best estimator has the gain that is asked of it."""
    for name, asked in ASKED.items():
        plain, sizes = _of_plain(name, found[name], values), list(found[name].values())[-1]
        good = [one for one in sizes.values() if plain / one.cost / one.root_mean_square_error**2 >= asked]
        words = "is not reached with these numbers"
        if good:
            least = min(good, key=lambda one: one.cost)
            equal = plain / least.root_mean_square_error**2
            words = f"is reached at a cost of {least.cost:.0f}, where plain Monte Carlo takes {equal:.0f} realisations"
        yield f"- {name}: {asked:g} times cheaper than plain Monte Carlo {words}."


def _coverage(found: Found) -> Iterator[str]:
    yield "| question | estimator | realisations | bias / standard error | coverage |"
    yield "|---|---|---|---|---|"
    for name, by in found.items():
        for estimator, sizes in by.items():
            size = _covered(sizes)
            one = sizes[size]
            yield f"| {name} | {estimator} | {size} | {one.bias / one.bias_error:+.1f} | {one.coverage:.3f} |"


def _missed(found: Found) -> Iterator[str]:
    """What is outside of the coverage or the bias that is asked, with its numbers."""
    for name, by in found.items():
        for estimator, sizes in by.items():
            one = sizes[_covered(sizes)]
            if not 0.93 <= one.coverage <= 0.97 or abs(one.bias) > 2.0 * one.bias_error:
                yield f"{estimator} ({name})"


def _coarse(banks: dict[str, Bank], number: int, tell: Callable[[str], None]) -> Iterator[str]:
    estimators = _of("coarse", "latin_hypercube", "sobol")
    jobs = [(name, estimator, COARSE_SIZE) for name in QUESTIONS for estimator in estimators]
    found = _carried_out(jobs, banks, number, tell)
    yield f"| question | estimator, {COARSE_SIZE} realisations | bias / standard error | coverage | variance ratio |"
    yield "|---|---|---|---|---|"
    for name, by in found.items():
        plain = next(iter(by.values()))[COARSE_SIZE].root_mean_square_error
        for estimator, sizes in by.items():
            one, where = sizes[COARSE_SIZE], makers(QUESTIONS[name], 1)[estimator][0]
            ratio = (plain / one.root_mean_square_error) ** 2
            error = one.bias_error
            if where != "coarse":  # all rows of the design together, and those of the truth, err too
                parts = (one.root_mean_square_error, banks[where]), (plain, banks["coarse"])
                error = np.hypot(error, np.hypot(*(e * np.sqrt(COARSE_SIZE / len(b.value[0])) for e, b in parts)))
            yield f"| {name} | {estimator} | {one.bias / error:+.1f} | {one.coverage:.3f} | {ratio:.2f} |"


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
