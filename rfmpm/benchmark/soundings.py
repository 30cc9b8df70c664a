"""The report of how well soundings of known scale of fluctuation give it back: soundings.md."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rfmpm.random_fields.estimation import NUGGET, Interval, estimate, profile_interval, vertical_correlation
from rfmpm.random_fields.sounding import Sounding
from rfmpm.random_fields.variance_function import fit_variance_function

THETA, SPREAD, MEDIAN = 0.5, 0.25, 20.0  # m, coefficient of variation, kPa
RATIOS = (5, 10, 20, 50)  # length over theta
PER_THETA = 5  # values
SOUNDINGS = 200
CASES = (("markov_separable", "constant"), ("markov_separable", "linear"), ("gaussian", "constant"))


class Found(NamedTuple):
    """What one sounding gave: theta three ways, and the coefficient of variation."""

    restricted: Interval
    plain: Interval
    windows: Interval
    spread: Interval


def run(folder: Path, quick: bool, tell: Callable[[str], None]) -> Path:
    """Estimate from many soundings and write the report.

    Args:
        folder: where soundings.md goes; made if missing.
        quick: twenty soundings of each kind, and short ones only.
        tell: is told the progress, line by line.

    Returns:
        The report's path.
    """
    folder.mkdir(parents=True, exist_ok=True)
    count = 20 if quick else SOUNDINGS
    lines = []
    for correlation, trend in CASES:
        for ratio in RATIOS[:2] if quick else RATIOS:
            found = [one(seed, ratio, correlation, trend) for seed in range(count)]
            lines += _rows(correlation, trend, ratio, found)
            tell(f"{correlation}, trend {trend}, length {ratio} theta: done")
    path = folder / "soundings.md"
    text = REPORT.format(
        count=count,
        theta=THETA,
        spacing=THETA / PER_THETA,
        spread=SPREAD,
        rows="\n".join(lines),
        error=100.0 * np.sqrt(0.05 * 0.95 / count),
    )
    path.write_text(text, encoding="utf-8")
    return path


def one(seed: int, ratio: int, correlation: str, trend: str) -> Found:
    """Make a sounding without trend, of a length of `ratio` theta, and estimate from it with the true correlation."""
    depth = THETA / PER_THETA * (0.5 + np.arange(ratio * PER_THETA))
    matrix = vertical_correlation(correlation, THETA, depth[:, None] - depth[None, :])
    lower = np.linalg.cholesky(matrix + NUGGET * np.eye(len(depth)))
    z = lower @ np.random.default_rng([seed, ratio]).standard_normal(len(depth))
    sounding = Sounding(depth, MEDIAN * np.exp(np.sqrt(np.log1p(SPREAD**2)) * z))
    best = estimate(sounding, correlation, trend)
    windows = fit_variance_function(sounding, correlation, trend).theta
    return Found(
        best.theta, profile_interval(best.profile.theta, best.profile.plain), windows, best.coefficient_of_variation
    )


def _rows(correlation: str, trend: str, ratio: int, found: list[Found]) -> list[str]:
    names = {
        "restricted": "theta, restricted likelihood",
        "plain": "theta, plain likelihood",
        "windows": "theta, variance function",
        "spread": "variation, restricted likelihood",
    }
    rows = []
    for key, name in names.items():
        true = SPREAD if key == "spread" else THETA
        intervals = np.array([getattr(entry, key) for entry in found]) / true
        value, low, high = intervals.T
        quarter, middle, other = np.quantile(value, [0.25, 0.5, 0.75])
        covered = np.mean((low <= 1.0) & (high >= 1.0))
        is_open = np.mean(np.isinf(high))
        ends = f"{np.median(low):.2f} to {np.median(high):.2f}"
        rows.append(
            f"| {correlation} | {trend} | {ratio} | {name} | {middle:.2f} | {quarter:.2f} to {other:.2f} | {ends} "
            f"| {100.0 * covered:.1f} | {100.0 * is_open:.0f} |"
        )
    return rows


REPORT = """\
# What soundings tell of the scale of fluctuation

Made by `rfmpm benchmark soundings`. {count} synthetic soundings of each kind: a lognormal variable without trend, of
coefficient of variation {spread:g} and vertical scale of fluctuation theta = {theta:g} m, a value every {spacing:g} m.
Each is estimated with the correlation that made it, and with the trend named: a constant, or a line that is not there.

All values are in units of the true one: 1.00 is right. Coverage: share of the 95 % intervals that hold the true value;
its standard error is {error:.1f} % where it is 95 %. Open: intervals without an upper end, because the sounding cannot
exclude any long theta; they count as covering if their lower end is below the true value. Interval: medians of ends.

| correlation | trend fitted | length / theta | estimate | median | quartiles | interval | coverage [%] | open [%] |
|---|---|---|---|---|---|---|---|---|
{rows}

`rfmpm sounding` prints the restricted likelihood and the variance function. The restricted likelihood is the one to
use; the plain one and the variance function find theta and variation too small in short soundings, because the fitted
trend takes the long waves out of them. A Gaussian field is so smooth that its values at close spacing determine theta
sharply; a measurement error, which no sounding lacks, would blur that, and it is not part of the model.
"""
