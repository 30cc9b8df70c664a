"""The random field of a study by itself: a picture, and its sample statistics beside the asked ones."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from rfmpm.report.data_picture import draw_conditional
from rfmpm.report.field_picture import draw_field
from rfmpm.report.field_table import cross_lines, property_lines

SAMPLE = 200  # realisations behind the statistics; their standard error is then about 0.07 of one realisation's scatter


class View(NamedTuple):
    """How a random field is shown; its statistics are those of what varies."""

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


def view_of(field) -> View:
    """How a field of a study is shown; one in the table of a material says of which."""
    view, of = VIEWS[field.variable], field.name.removeprefix(field.variable)
    return view._replace(title=view.title + of, field=view.field + of)


def write_field(study, index: int, directory: Path) -> list[str]:
    """Draw one realisation of each random property and compare the statistics of many with the asked ones.

    The statistics are those of the fields as they enter the simulation, of every soil by its own settings, as if its
    distribution were everywhere that at the crest, so that trends do not enter them.

    Args:
        study: the Study.
        index: of the realisation to draw.
        directory: gets field.png of the first random field, and field_<name>.png of every further one.

    Returns:
        For each soil of each property, lines of a table: asked and found mean, standard deviation and correlations [-],
        with standard errors; then, where properties are correlated, asked and found correlation between them; then the
        path of the picture. With data, the asked values are those of the conditional distribution, and the picture
        shows data, conditional mean, two realisations and conditional standard deviation.
        A study without a random field gives one line that says so, and no picture.
    """
    from rfmpm import realisation
    from rfmpm.random_fields import properties
    from rfmpm.random_fields.comparison import compare_properties
    from rfmpm.random_fields.statistics import is_conditional

    if not study.fields:
        return ["no random field in this study: every realisation is the same"]
    prepared = realisation.prepare(study)
    pairs = [entry.between for entry in study.field_correlations]
    # Statistics are compared for one soil: that of the study's own values, whatever of it is uncertain.
    first = len(prepared.uncertain)
    xis = (realisation.draw_xi(prepared, i)[first:] for i in range(index, index + SAMPLE))
    found = compare_properties(prepared.properties, pairs, xis)
    drawn = properties.realise(prepared.properties, realisation.draw_xi(prepared, index)[first:])
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    looks = {field.name: view_of(field) for field in study.fields}
    lines, done = [], []
    for field in study.fields:
        name, entry = field.name, prepared.fields[field.name]
        path = directory / (f"field_{_file_name(field)}.png" if done else "field.png")
        look, soils = looks[name], found.soils[name]
        lines += property_lines(field, entry, look, soils, SAMPLE)
        done.append(name)
        lines += cross_lines([one for one in found.cross if name in one.between and set(one.between) <= {*done}], looks)
        if any(is_conditional(soil.shares) for soil in soils):
            draw_conditional(study, index, look, entry, soils, [fields[name] for fields in found.first_two], path)
        else:
            points = np.column_stack(prepared.scene.points.position)[entry.where]
            draw_field(study, index, look, (points, drawn[entry.name][entry.where] / look.per_unit), soils, path)
        lines.append(str(path))
    if share := realisation.residual_above_peak(prepared, drawn):
        lines.append(f"residual cohesion above the peak at {share:.1%} of the points: the law takes the peak there")
    return lines


def _file_name(field) -> str:
    """The variable, with the position of the material in whose table the field stands: names may hold anything."""
    own = f"_of_material_{field.materials[0]}"
    return field.variable + (own if field.name != field.variable else "")
