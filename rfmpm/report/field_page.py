"""The random field of a study by itself: a picture, and its sample statistics beside the asked ones."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rfmpm.report.correlation_figure import draw_correlations
from rfmpm.report.data_picture import data_lines, draw_conditional
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, view
from rfmpm.report.style import BLUE, DOTS_PER_INCH, STRENGTH_MAP, VERMILION, drawing, new_figure

SAMPLE = 200  # realisations behind the statistics; their standard error is then about 0.07 of one realisation's scatter
NAMES = {
    "mean": "mean",
    "standard_deviation": "standard deviation",
    "correlation_h": "correlation along h",
    "correlation_v": "correlation along v",
    "covariance_h": "conditional cov. along h",
    "covariance_v": "conditional cov. along v",
}


def write_field(study, index: int, directory: Path) -> list[str]:
    """Draw one realisation of the cohesion field and compare the statistics of many with the asked ones.

    Both are those of the uppermost soil; the statistics are taken as if its distribution were everywhere that at the
    crest, so that a trend does not enter them.

    Args:
        study: the Study.
        index: of the realisation to draw.
        directory: gets field.png.

    Returns:
        Lines of a table: asked and found mean, standard deviation [kPa] and correlations [-], with standard errors.
        With data, the asked values are those of the conditional distribution, and the picture shows data, conditional
        mean, two realisations and conditional standard deviation.
        A study without a random field gives one line that says so, and no picture.
    """
    from rfmpm import realisation
    from rfmpm.random_fields.field import realise
    from rfmpm.random_fields.statistics import statistics
    from rfmpm.seeds import standard_normal

    if "cohesion" not in study.random_field:
        return ["no random field in this study: every realisation is the same"]
    settings = study.random_field["cohesion"]
    prepared = realisation.prepare(study)
    uppermost = prepared.fields["cohesion"].parts[0]
    field, points, mean = uppermost.at_crest, uppermost.points, uppermost.mean
    xis = [standard_normal(study.study.seed, 0, i, field.n_variables) for i in range(index, index + SAMPLE)]
    records = statistics(field, settings, mean, points, xis)
    sample = np.array([realise(field, xi) for xi in xis]) / 1000.0
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    path = directory / "field.png"
    if field.conditioning is None:
        drawn = realise(uppermost.field, xis[0]) / 1000.0
        _draw(study, index, points, drawn, sample, field.marginal, records, path)
    else:
        draw_conditional(study, index, points, field, sample, records, path)
    return [*method_lines(field), *_table(records), *data_lines(field, xis)]


def method_lines(field) -> list[str]:
    """How the field is made, and what is known of its error before any sampling."""
    from rfmpm.random_fields.methods import METHODS

    error = METHODS[field.method].covariance_error(field.record)
    return [f"method {field.method}, {field.n_variables} variables; largest error of its covariance {error:.1e}"]


def _table(records: Sequence) -> list[str]:
    lines = [
        f"{SAMPLE} realisations on the material points; correlations of the standard-normal field below the marginal",
        f"{'':<26}{'lag [m]':>7}{'asked':>10}{'found':>10}{'std. error':>12}{'in std. errors':>18}",
    ]
    for record in records:
        unit = 1000.0 if record.name in ("mean", "standard_deviation") else 1.0
        name = NAMES[record.name] + (" [kPa]" if unit > 1.0 else "")
        lag = f"{record.lag:.2f}" if unit == 1.0 else ""
        asked, found, error = (value / unit for value in (record.asked, record.found, record.standard_error))
        ratio = (found - asked) / error if error > 0.0 else float("nan")
        lines.append(f"{name:<26}{lag:>7}{asked:>10.4f}{found:>10.4f}{error:>12.4f}{ratio:>18.1f}")
    return lines


def _draw(
    study,
    index: int,
    points: np.ndarray,
    drawn: np.ndarray,
    sample: np.ndarray,
    marginal,
    records: Sequence,
    path: Path,
) -> None:
    from rfmpm.mpm.scene import outline

    polygon = outline(study)
    frame = view([polygon[:, 0]], [polygon[:, 1]])
    height = panel_height(frame) + 0.35
    with drawing():
        figure = new_figure(WIDTH, height + 3.3)
        grid = figure.add_gridspec(2, 2, height_ratios=[height, 3.3])
        axes = figure.add_subplot(grid[0, :])
        axes.set_title(f"Peak cohesion, realisation {index}")
        places = {"x": points[:, 0], "y": points[:, 1]}
        ends = tuple(np.percentile(drawn, [1.0, 99.0]))
        draw_panel(figure, axes, places, drawn, polygon, frame, ends, "cohesion [kPa]", STRENGTH_MAP)
        _histogram(figure.add_subplot(grid[1, 0]), index, sample, marginal)
        draw_correlations(figure.add_subplot(grid[1, 1]), records)
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)


def _histogram(axes, index: int, sample: np.ndarray, marginal) -> None:
    # The asked density by change of variable from the standard normal: it needs no formula of each distribution.
    z = np.linspace(-4.0, 4.0, 801)
    value = marginal.transform(z) / 1000.0
    density = np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi) / np.gradient(value, z)
    edges = np.linspace(*np.percentile(sample, [0.05, 99.95]), 41)
    axes.hist(sample.ravel(), bins=edges, density=True, color=BLUE, alpha=0.3, label=f"{len(sample)} realisations")
    axes.hist(sample[0], bins=edges, density=True, histtype="step", color=BLUE, label=f"realisation {index}")
    axes.plot(value, density, color=VERMILION, label="asked")
    axes.set(xlabel="cohesion [kPa]", ylabel="density [1/kPa]", title="Distribution", xlim=edges[[0, -1]])
    axes.legend(loc="upper right")
