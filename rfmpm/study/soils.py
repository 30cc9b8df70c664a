"""The soils of a random field as a study describes them: their moments at a depth, and where in the body they lie."""

from collections.abc import Iterator, Sequence
from math import cos, hypot, radians, sin, sqrt, tan
from typing import NamedTuple

from rfmpm.study.bodies import Place, hull_of, is_plain_body
from rfmpm.study.known import Known, Unknown

FRICTIONAL = ("mohr_coulomb", "drucker_prager")
LAWS_WITH = {
    "cohesion": ("von_mises", *FRICTIONAL),
    "residual_cohesion": ("von_mises", *FRICTIONAL),
    "friction_angle": FRICTIONAL,
}
MEAN_KEY = {
    "cohesion": "cohesion_kpa",
    "residual_cohesion": "residual_cohesion_kpa",
    "friction_angle": "friction_angle_deg",
}
LAYER_MEAN_KEY = {"cohesion": "mean_kpa", "residual_cohesion": "mean_kpa", "friction_angle": "mean_deg"}
BORDER = 1e-9  # [m]; a point that near to a line is on it, and belongs to the soil above

Line = tuple[float, float]  # height at x = 0 [m], slope [-]


class Soil(NamedTuple):
    """The soil above all layers, or a layer, of one random field.

    Attributes:
        path: of the table that describes it.
        mean: at the crest [kPa]; of a friction angle its tangent [-].
        variation: coefficient of variation at the crest [-].
        mean_gain: of the mean per metre of depth [kPa/m].
        deviation_gain: of the standard deviation per metre of depth [kPa/m]; None: proportional to the mean.
    """

    path: str
    mean: float
    variation: float
    mean_gain: float
    deviation_gain: float | None

    def mean_at(self, depth: float) -> float:
        """Mean at a depth [m] below the crest [kPa or -]."""
        return self.mean + self.mean_gain * depth

    def variation_at(self, depth: float) -> float:
        """Coefficient of variation at a depth [m] below the crest, where the mean is greater than 0 [-]."""
        if self.deviation_gain is None:
            return self.variation
        return (self.mean * self.variation + self.deviation_gain * depth) / self.mean_at(depth)


def tables_of_fields(known: Known) -> Iterator[str]:
    """Paths of the tables that hold random fields: that of the study, then those of its materials."""
    yield "random_field"
    for index in range(len(known["material"])):
        if _is_there(known, table := f"material.{index}.random_field"):
            yield table


def paths_of_fields(known: Known) -> Iterator[tuple[str, str]]:
    """Variable and path of all random fields."""
    for table in tables_of_fields(known):
        for variable in known[table]:
            if _is_there(known, field := f"{table}.{variable}"):
                yield variable, field


def has_fields(known: Known) -> bool:
    """Whether anything varies from place to place."""
    return any(True for _ in paths_of_fields(known))


def _is_there(known: Known, path: str) -> bool:
    """Whether there is something at a path that is no wrong key itself."""
    try:
        return known[path] is not None
    except Unknown:
        return False


def material_above(field: str) -> str | None:
    """Path of the material in whose table a field stands; None for a field of the study."""
    return field.partition(".random_field.")[0] if field.startswith("material.") else None


def materials_of(known: Known, field: str) -> list[str]:
    """Paths of the materials that have a field, as far as there are such; first the one whose mean is the field's."""
    if material := material_above(field):
        return [material]
    paths = {known[f"material.{index}.name"]: f"material.{index}" for index in range(len(known["material"]))}
    names = [known[f"{field}.material"], *(known[f"{field}.shared_with"] or ())]
    return [paths[name] for name in names if name in paths]


def fields_of(known: Known) -> Iterator[tuple[str, str, str]]:
    """Variable, path of its field and path of the material whose mean it has, for the fields that have one."""
    for variable, field in paths_of_fields(known):
        for material in materials_of(known, field)[:1]:
            if known[f"{material}.law"] in LAWS_WITH[variable]:
                yield variable, field, material


def means_of_fields(known: Known) -> Iterator[tuple[str, str, str]]:
    """As `fields_of`, for every material that has the field."""
    for variable, field in paths_of_fields(known):
        for material in materials_of(known, field):
            if known[f"{material}.law"] in LAWS_WITH[variable]:
                yield variable, field, material


def layers_of(known: Known, field: str) -> list[str]:
    """Paths of the layers of a field."""
    return [f"{field}.layer.{number}" for number in range(len(known[f"{field}.layer"] or ()))]


def soils_of(known: Known, variable: str, field: str, material: str) -> list[Soil]:
    """The soils of a field, from above all layers down; a mean that is not given is 0."""
    own = known[f"{material}.{MEAN_KEY[variable]}"] or 0.0
    variation, gain = known[f"{field}.coefficient_of_variation"], known[f"{field}.trend_kpa_per_m"] or 0.0
    deviation = known[f"{field}.standard_deviation_trend_kpa_per_m"]
    moments = [(field, own, variation)]
    for layer in layers_of(known, field):
        mean = known[f"{layer}.{LAYER_MEAN_KEY[variable]}"] or own
        moments.append((layer, mean, known[f"{layer}.coefficient_of_variation"] or variation))
    return [Soil(path, of_field(variable, mean), own, gain, deviation) for path, mean, own in moments]


def of_field(variable: str, value: float) -> float:
    """What a value of a study, in kPa or degrees, is in the field: the tangent of a friction angle."""
    return tan(radians(value)) if variable == "friction_angle" else value


def outline_of_body(known: Known, field: str) -> list[Place]:
    """Corners of the body, anticlockwise from the lower left [m]; of several soils the hull of the field's own."""
    if not is_plain_body(known):
        return hull_of(known, known[f"{materials_of(known, field)[0]}.name"])
    height = known["geometry.height_m"]
    if known["geometry.kind"] == "slope":
        crest = known["geometry.crest_m"]
        toe = crest + height / tan(radians(known["geometry.angle_deg"]))
    else:
        crest = toe = known["geometry.width_m"]
    return [(0.0, 0.0), (toe, 0.0), (crest, height), (0.0, height)]


def outline_of_points(known: Known, field: str) -> list[Place]:
    """Corners of the part of the body in which the points of a field lie; half a square from its straight sides."""
    half = 0.5 * (known[f"{field}.reference_cell_m"] or known["discretisation.cell_m"])
    half /= sqrt(known["discretisation.points_per_cell"])
    outline = outline_of_body(known, field)
    if not is_plain_body(known):
        return outline
    (_, _), (length, _), _, (_, height) = outline
    half = min(half, 0.5 * length, 0.5 * height)
    outline = clip(clip(outline, (-1.0, 0.0), -half), (0.0, 1.0), height - half)
    if known["geometry.kind"] == "block":
        return clip(clip(outline, (0.0, -1.0), -half), (1.0, 0.0), length - half)
    return outline


def lines_of(known: Known, field: str) -> list[Line]:
    """Upper borders of the layers of a field."""
    return [(known[f"{layer}.top_m"], tan(radians(known[f"{layer}.dip_deg"]))) for layer in layers_of(known, field)]


def soil_at(lines: Sequence[Line], place: Place) -> int:
    """Number of the soil at a place: 0 above all lines, else that of the last line it lies below, from 1."""
    x, y = place
    below = [number for number, (top, slope) in enumerate(lines, 1) if y < top + slope * x - BORDER]
    return below[-1] if below else 0


def outline_of_soil(outline: list[Place], lines: Sequence[Line], number: int) -> list[Place]:
    """Corners of what a convex outline holds of a soil; none if it holds nothing of it."""
    if number > 0:
        top, slope = lines[number - 1]
        outline = clip(outline, (-slope, 1.0), top - 2.0 * BORDER)
    for top, slope in lines[number:]:
        outline = clip(outline, (slope, -1.0), BORDER - top)
    return outline


def clip(outline: list[Place], normal: Place, most: float) -> list[Place]:
    """The part of a convex outline where normal . place <= most (Sutherland and Hodgman 1974)."""
    kept: list[Place] = []
    for start, end in zip(outline, [*outline[1:], *outline[:1]], strict=True):
        before, after = (normal[0] * x + normal[1] * y - most for x, y in (start, end))
        if before <= 0.0:
            kept.append(start)
        if before * after < 0.0:
            share = before / (before - after)
            kept.append((start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])))
    return kept


def distance(place: Place, outline: list[Place]) -> float:
    """Distance of a place from a convex outline, anticlockwise; 0 inside."""
    x, y = place
    edges = list(zip(outline, [*outline[1:], *outline[:1]], strict=True))
    if len(outline) > 2 and all((c - a) * (y - b) >= (d - b) * (x - a) for (a, b), (c, d) in edges):
        return 0.0
    found = []
    for (a, b), (c, d) in edges:
        length = (c - a) * (c - a) + (d - b) * (d - b)
        along = 0.0 if length == 0.0 else min(max(((x - a) * (c - a) + (y - b) * (d - b)) / length, 0.0), 1.0)
        found.append(hypot(x - a - along * (c - a), y - b - along * (d - b)))
    return min(found)


def over_scales(places: Sequence[Place], scales: tuple[float, float], rotation: float) -> list[Place]:
    """Places along and across the axes of a correlation, rotated [degrees], each over its scale of fluctuation [-]."""
    cosine, sine = cos(radians(rotation)), sin(radians(rotation))
    return [((cosine * x + sine * y) / scales[0], (cosine * y - sine * x) / scales[1]) for x, y in places]
