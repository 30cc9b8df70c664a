"""Correlations of a field over the lag: asked and found."""

from collections.abc import Sequence

from rfmpm.report.style import BLUE, ORANGE


def draw_correlations(axes, records: Sequence, of: str = "") -> None:
    """Draw asked correlations as lines and found ones as points with two standard errors.

    Args:
        axes: the axes to draw in.
        records: statistics; those named correlation_h, correlation_v, covariance_h and covariance_v are drawn.
        of: what they belong to, for the title.
    """
    kind = "Covariance" if any(record.name.startswith("covariance") for record in records) else "Correlation"
    for direction, colour, marker in (("h", BLUE, "o"), ("v", ORANGE, "s")):
        chosen = [record for record in records if record.name == f"{kind.lower()}_{direction}"]
        if not chosen:
            continue
        lag = [record.lag for record in chosen]
        found, errors = [r.found for r in chosen], [2.0 * r.standard_error for r in chosen]
        axes.plot(lag, [record.asked for record in chosen], color=colour, lw=1.2)
        axes.errorbar(lag, found, errors, color=colour, marker=marker, ms=4, ls="", lw=1.2)
        axes.plot([], [], color=colour, marker=marker, ms=4, lw=1.2, label=f"along {direction}")
    axes.axhline(0.0, color="black", lw=0.6)
    axes.set(xlabel="lag [m]", ylabel=f"{kind.lower()} [-]", title=f"{kind}{of}")
    if axes.get_legend_handles_labels()[0]:  # none where no points are a lag apart
        axes.legend(loc="upper right", title="asked (line), found ± 2 std. errors", title_fontsize=8.5)
