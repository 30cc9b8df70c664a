"""The report of the estimators: probabilities.md and its picture."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from rfmpm.benchmark.probabilities import rare, slope
from rfmpm.benchmark.probabilities.bank import columns
from rfmpm.benchmark.probabilities.cases import COMPONENTS, NUMBERS, REPLICATE, studies
from rfmpm.benchmark.probabilities.picture import draw
from rfmpm.benchmark.probabilities.repeats import Bank, Judged, judge, repeats
from rfmpm.benchmark.probabilities.slope import QUESTIONS, Reference, makers
from rfmpm.benchmark.probabilities.text import TEXT

SIZES = (32, 64, 128)  # realisations on 0.25 m cells
COVERED = 128  # of them for the table of coverage
COARSE_SIZE = 256
REPEATS = 500
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
        gains="\n".join(_gains(fine, references)),
        coverage="\n".join(_coverage(fine, references, SIZES[0] if quick else COVERED)),
        coarse_rows=len(found["coarse"].run_out),
        replicate=REPLICATE,
        components=COMPONENTS,
        coarse="\n".join(coarse),
        small=_small(small, len(found["coarse"].run_out)),
        subsets="\n".join(_subsets(subsets, small)),
        plain=round((1.0 - small.probability) / small.probability / 0.3**2),
    )
    path.write_text(text, encoding="utf-8")
    return path


Found = dict[str, dict[str, dict[int, Judged]]]  # by question, estimator and number of realisations


def _fine(banks: dict[str, Bank], number: int, sizes: tuple[int, ...], tell: Callable[[str], None]) -> Found:
    bank, found = banks["pair"], {}
    for name, question in QUESTIONS.items():
        truth = slope.reference(bank, question).value
        found[name] = {}
        for size in sizes:
            for estimator, (where, make) in makers(question, size).items():
                if where == "pair":
                    judged = judge(list(repeats(make, bank, number, SEED)), truth)
                    found[name].setdefault(estimator, {})[size] = judged
                    tell(f"{name}, {estimator}, {size}: error {judged.root_mean_square_error:.4g}")
    return found


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
    yield "| question | estimator, 256 realisations | bias / standard error | coverage | variance ratio |"
    yield "|---|---|---|---|---|"
    for name, question in QUESTIONS.items():
        reference, plain = slope.reference(banks["coarse"], question), None
        for estimator, (where, make) in makers(question, COARSE_SIZE).items():
            if where == "pair":
                continue
            one = judge(list(repeats(make, banks[where], number, SEED)), reference.value)
            plain = plain or one.root_mean_square_error
            tell(f"0.5 m: {name}, {estimator}: coverage {one.coverage:.3f}")
            ratio = (plain / one.root_mean_square_error) ** 2
            yield f"| {name} | {estimator} | {_bias(one, reference)} | {one.coverage:.3f} | {ratio:.2f} |"


def _small(small: rare.Small, number: int) -> str:
    return (
        f"P(run-out > {small.limit:g} m) on cells of 0.5 m is {small.probability:.2e} by the {number} independent "
        f"realisations (95 % interval {small.lower:.2e} to {small.upper:.2e}). Subset simulation, levels of "
        f"{rare.SIZES['level_size']} realisations, of which {rare.SIZES['level_probability']:.0%} start the next one, "
        f"at most {rare.AT_MOST} in all:"
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
