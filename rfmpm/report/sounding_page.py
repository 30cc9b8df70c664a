"""What a sounding says of a variable: a table, a ready table for a study, and a picture."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm.report.style import BLUE, DOTS_PER_INCH, GREY, ORANGE, VERMILION, drawing, new_figure

SHORT = 10.0  # theta in the length; below, estimates are marked


def write_sounding(path: Path, directory: Path, factor: float = 1.0) -> list[str]:
    """Estimate trend, variation and vertical scale of fluctuation of a sounding, and draw them.

    Args:
        path: file of the sounding; see `read_sounding`.
        directory: gets sounding.png.
        factor: value of the variable per value of the file.

    Returns:
        Lines of a table and of a ready table for a study.

    Raises:
        ColumnsError, ModuleNotFoundError, OSError: the file cannot be read as a sounding.
    """
    from rfmpm.random_fields.estimation import choose_trend, distinct_correlations, rank_correlations
    from rfmpm.random_fields.sounding import read_sounding
    from rfmpm.random_fields.variance_function import fit_variance_function

    sounding = read_sounding(path, factor)
    names = distinct_correlations()
    trend, bic = choose_trend(sounding, names[0])
    ranked = rank_correlations(sounding, trend, names)
    fit = fit_variance_function(sounding, ranked[0].correlation, trend)
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    _draw(sounding, ranked[0], fit, Path(path).name, directory / "sounding.png")
    return [*_table(sounding, bic, ranked, fit), "", *study_table(ranked[0], sounding)]


def _table(sounding, bic: dict[str, float], ranked: Sequence[Any], fit) -> list[str]:
    best = ranked[0]
    length, spacing = np.ptp(sounding.depth), np.median(np.diff(sounding.depth))
    lines = [
        f"{len(sounding.value)} values over {length:.4g} m, spacing {spacing:.3g} m; lognormal about the trend",
        f"trend: {best.trend}; BIC " + ", ".join(f"{name} {value:.1f}" for name, value in bic.items()),
        f"mean in the middle: {best.mean:.4g}, gain {best.gain:.3g} per m of depth",
        f"coefficient of variation: {_words(best.coefficient_of_variation)}",
        f"{'vertical theta [m], 95 % interval':<36}{'value':>9}{'from':>9}{'to':>9}{'log-likelihood':>17}",
    ]
    for entry in ranked:
        numbers = "".join(f"{value:>9.3g}" for value in entry.theta)
        below = entry.log_likelihood - best.log_likelihood
        lines.append(f"{'likelihood, ' + entry.correlation:<36}{numbers}{below:>17.2f}")
    numbers = "".join(f"{value:>9.3g}" for value in fit.theta)
    lines.append(f"{'variance function, ' + best.correlation:<36}{numbers}")
    ratio = length / best.theta.value
    if ratio < SHORT:
        lines.append(
            f"the sounding is {ratio:.2g} theta long, less than {SHORT:g}: theta and variation may be far too low"
        )
    return lines


def _words(interval) -> str:
    return f"{interval.value:.3g}, 95 % interval {interval.low:.3g} to {interval.high:.3g}"


def study_table(best, sounding) -> list[str]:
    """The estimate as a table of a study file, ready but for the horizontal scale, which a sounding cannot tell."""
    lines = [
        "[random_field.cohesion]",
        'material = "clay"                 # the name of yours, whose mean is '
        f"{best.mean - best.gain * np.mean(sounding.depth[[0, -1]]):.4g} at depth 0",
        'distribution = "lognormal"',
        f"coefficient_of_variation = {best.coefficient_of_variation.value:.3g}",
        f'correlation = "{best.correlation}"',
        f"scale_of_fluctuation_v_m = {best.theta.value:.3g}",
        "# scale_of_fluctuation_h_m =       # yours: one sounding tells nothing of it; 20 to 80 m are usual",
    ]
    if best.trend == "linear":
        lines.append(f"trend_kpa_per_m = {best.gain:.3g}")
    return lines


def _draw(sounding, best, fit, title: str, path: Path) -> None:
    with drawing():
        figure = new_figure(9.0, 4.6)
        grid = figure.add_gridspec(1, 3, width_ratios=[1.0, 1.2, 1.2])
        _draw_values(figure.add_subplot(grid[0, 0]), sounding, best, title)
        _draw_correlation(figure.add_subplot(grid[0, 1]), best, fit)
        _draw_windows(figure.add_subplot(grid[0, 2]), fit)
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)


def _draw_values(axes, sounding, best, title: str) -> None:
    depth = sounding.depth
    shape = np.vander(depth - np.mean(depth[[0, -1]]), len(best.coefficients), increasing=True)
    middle = shape @ best.coefficients
    spread = 2.0 * np.sqrt(np.log1p(best.coefficient_of_variation.value**2))
    axes.plot(sounding.value, depth, color=BLUE, lw=1.0, label="values")
    axes.plot(np.exp(middle), depth, color=VERMILION, label=f"trend (median), {best.trend}")
    axes.fill_betweenx(
        depth, np.exp(middle - spread), np.exp(middle + spread), color=VERMILION, alpha=0.12, lw=0, label="95 %"
    )
    axes.invert_yaxis()
    axes.set(xlabel="value", ylabel="depth [m]", title=title)
    axes.legend(loc="best")


def _draw_correlation(axes, best, fit) -> None:
    from rfmpm.random_fields.estimation import vertical_correlation

    lag = np.linspace(0.0, fit.lags[-1], 400)
    axes.plot(fit.lags, fit.autocorrelation, "o", ms=3, color=GREY, label="found")
    axes.plot(lag, vertical_correlation(best.correlation, best.theta.value, lag), color=BLUE, label="likelihood")
    for end in best.theta[1:]:
        if 0.0 < end < np.inf:
            axes.plot(lag, vertical_correlation(best.correlation, end, lag), color=BLUE, lw=0.8, ls="--")
    fitted = vertical_correlation(best.correlation, fit.theta.value, lag)
    axes.plot(lag, fitted, color=ORANGE, label="variance function")
    axes.axhline(0.0, color="black", lw=0.6)
    low, high = best.theta[1:]
    axes.set(
        xlabel="lag [m]", ylabel="correlation [-]", ylim=(-0.6, 1.05), title=f"Autocorrelation, {best.correlation}"
    )
    axes.legend(loc="upper right", title=f"theta {best.theta.value:.3g} m ({low:.3g} to {high:.3g})")


def _draw_windows(axes, fit) -> None:
    axes.loglog(fit.windows, fit.found, "o", ms=4, color=GREY, label="found")
    axes.loglog(fit.windows, fit.fitted, color=ORANGE, label=f"fitted, theta {fit.theta.value:.3g} m")
    axes.set(xlabel="window [m]", ylabel="variance of the average [-]", title="Variance function")
    axes.legend(loc="lower left")
