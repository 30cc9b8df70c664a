"""The random field of a study by itself: a picture, and its sample statistics beside the asked ones."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

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


class View(NamedTuple):
    """How a random property is shown; its statistics are those of its field."""

    title: str
    label: str
    per_unit: float  # SI units of the property in one of the label
    field: str  # what the field is
    unit: str
    per_field_unit: float  # SI units of the field in one of that


VIEWS = {
    "cohesion": View("Peak cohesion", "cohesion [kPa]", 1e3, "cohesion", "kPa", 1e3),
    "residual_cohesion": View("Residual cohesion", "cohesion [kPa]", 1e3, "residual cohesion", "kPa", 1e3),
    "friction_angle": View(
        "Peak angle of friction", "angle [degrees]", np.pi / 180.0, "tangent of the angle of friction", "-", 1.0
    ),
}


def write_field(study, index: int, directory: Path) -> list[str]:
    """Draw one realisation of each random property and compare the statistics of many with the asked ones.

    The statistics are those of the uppermost soil, as if its distribution were everywhere that at the crest, so that
    layers and trends do not enter them.

    Args:
        study: the Study.
        index: of the realisation to draw.
        directory: gets field.png of the first random property, and field_<name>.png of every further one.

    Returns:
        For each property, lines of a table: asked and found mean, standard deviation and correlations [-], with
        standard errors; then the path of the picture. With data, the asked values are those of the conditional
        distribution, and the picture shows data, conditional mean, two realisations and conditional standard deviation.
        A study without a random field gives one line that says so, and no picture.
    """
    from rfmpm import realisation
    from rfmpm.random_fields import properties

    if not study.random_field:
        return ["no random field in this study: every realisation is the same"]
    prepared = realisation.prepare(study)
    xis = [realisation.draw_xi(prepared, i) for i in range(index, index + SAMPLE)]
    drawn = properties.realise(prepared.properties, xis[0])
    places = np.column_stack(prepared.scene.points.position)
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    lines, start = [], 0
    for number, (name, entry) in enumerate(prepared.fields.items()):
        path = directory / (f"field_{name}.png" if number else "field.png")
        own = [xi[start : start + entry.parts[0].field.n_variables] for xi in xis]
        is_mixed = number > 0 and prepared.properties.mixing is not None
        lines += _write_property(study, index, name, entry, own, (places, drawn[name], is_mixed), path)
        start += entry.n_variables
    return lines


def _write_property(study, index: int, name: str, entry, xis: Sequence, whole: tuple, path: Path) -> list[str]:
    from rfmpm.random_fields.field import realise
    from rfmpm.random_fields.statistics import statistics

    look, uppermost = VIEWS[name], entry.parts[0]
    field, points = uppermost.at_crest, uppermost.points
    records = statistics(field, study.random_field[name], uppermost.mean, points, xis)
    sample = np.array([realise(field, xi) for xi in xis]) / look.per_field_unit
    places, values, is_mixed = whole
    if field.conditioning is None:
        _draw(study, index, look, (places, values / look.per_unit, is_mixed), sample, field.marginal, records, path)
    else:
        trending = np.array([realise(uppermost.field, xi) for xi in xis[:2]]) / look.per_field_unit
        draw_conditional(study, index, look, points, uppermost.field, trending, records, path)
    of = f" of the uppermost of {len(entry.parts)} soils" if len(entry.parts) > 1 else ""
    return [
        f"{look.field}{of}: {method_line(field)}",
        *_notes(study.random_field[name], entry, is_mixed),
        *_table(records, look),
        *data_lines(uppermost.field, xis),
        str(path),
    ]


def _notes(settings, entry, is_mixed: bool) -> list[str]:
    """What the statistics leave out."""
    notes = {
        "those of the crest: a trend changes what the values stand for, not how they vary": (
            entry.parts[0].field is not entry.parts[0].at_crest
        ),
        "those of this soil alone; data in other soils are not counted": len(entry.parts) > 1,
        "those of the reference points: the mean over a material point's square varies less": (
            entry.taken is not None and entry.taken.shape[1] > 1
        ),
        "those of the field before it is correlated with the earlier one; the map is that after it": is_mixed,
        "those of the standard-normal field, whose correlation makes that of the values as asked": (
            settings.correlation_space == "physical"
        ),
    }
    return [f"the statistics are {note}" for note, applies in notes.items() if applies]


def method_line(field) -> str:
    """How the field is made, and what is known of its error before any sampling."""
    from rfmpm.random_fields.methods import METHODS

    error = METHODS[field.method].covariance_error(field.record)
    averaged = f"; averages over volumes keep {field.variance_factor:.3f} of the variance"
    return (
        f"method {field.method}, {field.n_variables} variables; largest error of its covariance {error:.1e}"
        f"{averaged if field.variance_factor < 1.0 else ''}"
    )


def _table(records: Sequence, look: View) -> list[str]:
    lines = [
        f"{SAMPLE} realisations on the material points; correlations of the standard-normal field below the marginal",
        f"{'':<26}{'lag [m]':>7}{'asked':>10}{'found':>10}{'std. error':>12}{'in std. errors':>18}",
    ]
    for record in records:
        is_of_values = record.name in ("mean", "standard_deviation")
        unit = look.per_field_unit if is_of_values else 1.0
        name = NAMES[record.name] + (f" [{look.unit}]" if is_of_values else "")
        lag = "" if is_of_values else f"{record.lag:.2f}"
        asked, found, error = (value / unit for value in (record.asked, record.found, record.standard_error))
        ratio = (found - asked) / error if error > 0.0 else float("nan")
        lines.append(f"{name:<26}{lag:>7}{asked:>10.4f}{found:>10.4f}{error:>12.4f}{ratio:>18.1f}")
    return lines


def _draw(study, index: int, look: View, whole: tuple, sample: np.ndarray, marginal, records, path: Path) -> None:
    """Draw the whole body, `whole` being places, values and whether mixed, and the statistics of the sample."""
    from rfmpm.mpm.scene import outline

    polygon = outline(study)
    frame = view([polygon[:, 0]], [polygon[:, 1]])
    height = panel_height(frame) + 0.35
    with drawing():
        figure = new_figure(WIDTH, height + 3.3)
        grid = figure.add_gridspec(2, 2, height_ratios=[height, 3.3])
        axes = figure.add_subplot(grid[0, :])
        axes.set_title(f"{look.title}, realisation {index}")
        (x, y), values = whole[0].T, whole[1]
        is_sample = len(values) == sample.shape[1] and not whole[2]  # the first of the sample is what is drawn
        ends = tuple(np.percentile(values, [1.0, 99.0]))
        draw_panel(figure, axes, {"x": x, "y": y}, values, polygon, frame, ends, look.label, STRENGTH_MAP)
        _histogram(figure.add_subplot(grid[1, 0]), index, look, sample, marginal, is_sample)
        draw_correlations(figure.add_subplot(grid[1, 1]), records)
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)


def _histogram(axes, index: int, look: View, sample: np.ndarray, marginal, is_sample: bool) -> None:
    # The asked density by change of variable from the standard normal: it needs no formula of each distribution.
    z = np.linspace(-4.0, 4.0, 801)
    value = marginal.transform(z) / look.per_field_unit
    density = np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi) / np.gradient(value, z)
    edges = np.linspace(*np.percentile(sample, [0.05, 99.95]), 41)
    axes.hist(sample.ravel(), bins=edges, density=True, color=BLUE, alpha=0.3, label=f"{len(sample)} realisations")
    if is_sample:
        axes.hist(sample[0], bins=edges, density=True, histtype="step", color=BLUE, label=f"realisation {index}")
    axes.plot(value, density, color=VERMILION, label="asked")
    axes.set(xlabel=f"{look.field} [{look.unit}]", ylabel="density", title="Distribution", xlim=edges[[0, -1]])
    axes.legend(loc="upper right")
