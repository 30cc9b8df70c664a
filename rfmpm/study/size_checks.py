"""What the size of a study's body asks of its cells, its stiffness and its time."""

from collections.abc import Callable, Iterator
from math import floor, isclose, sqrt

from rfmpm.ground import height_at
from rfmpm.study.bodies import ground_of, height_of, is_plain_body, size_of
from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, problem
from rfmpm.study.soils import paths_of_fields

LARGEST_POINT_COUNT = 5_000_000
LARGEST_CELL_COUNT = 20_000_000
LARGEST_BIN_COUNT = 100_000
LARGEST_STEP_COUNT = 1_000_000_000
HIGHEST_SELF_COMPRESSION = 0.5  # of the lowest soil under the weight above, by small-strain elasticity
GRAVITY = 9.81  # [m/s2]
LARGEST_CHOLESKY_COUNT = 20_000
BYTES_PER_LATTICE_POINT = 150  # found at 2 million: position, members, spectrum and random vector of an embedding
SMALLEST_CELLS = {("slope", "height_m"): 4, ("slope", "crest_m"): 2, ("block", "width_m"): 2, ("block", "height_m"): 1}
WIDEST_SPLINE_CELLS = 3  # cells that the four nodes of a cubic B-spline span


def _lengths_fit_the_cells(known: Known, name: str) -> Iterator[Problem]:
    kind, cell, length = known["geometry.kind"], known["discretisation.cell_m"], known[f"geometry.{name}"]
    least, cells = SMALLEST_CELLS[kind, name], length / cell
    if kind == "block" and name == "width_m" and known["discretisation.shape"] == "cubic_bspline":
        least = WIDEST_SPLINE_CELLS
    if isclose(cells, round(cells), rel_tol=1e-9) and round(cells) >= least:
        return
    nearest = [cell * count for count in (floor(cells), floor(cells) + 1) if count >= least] or [cell * least]
    text = (
        f"must be a whole number of cells of {cell:.10g} m, at least {least}; "
        f"nearest: {' or '.join(f'{value:.10g}' for value in nearest)}"
    )
    yield problem(known, f"geometry.{name}", text)


def _height_fits(known: Known) -> Iterator[Problem]:
    yield from _lengths_fit_the_cells(known, "height_m")


def _width_fits(known: Known) -> Iterator[Problem]:
    yield from _lengths_fit_the_cells(known, "crest_m" if known["geometry.kind"] == "slope" else "width_m")


def _points_resist_every_motion(known: Known) -> Iterator[Problem]:
    """With one point per cell a cubic spline has motions that strain no point; the initial stresses are then noise."""
    if known["discretisation.shape"] == "cubic_bspline" and known["discretisation.points_per_cell"] == 1:
        text = 'must be at least 4 where shape = "cubic_bspline", else some motions strain no point'
        yield problem(known, "discretisation.points_per_cell", text)


def _histories_are_of_the_body(known: Known) -> Iterator[Problem]:
    """A place may lie outside by a cell: what counts is the nearest material point."""
    if not known["history"]:
        return
    size, cell = size_of(known), known["discretisation.cell_m"]
    ground = ground_of(known)
    for index in range(len(known["history"])):
        x, y = known[f"history.{index}.x_m"], known[f"history.{index}.y_m"]
        height = float(height_at(ground, x))
        if x > size.length + cell or y > height + cell:
            text = f"there is no soil within a cell of x_m = {x:.10g}, y_m = {y:.10g}"
            if x <= size.length:
                text += f"; the ground is at y_m = {height:.6g} there"
            yield problem(known, f"history.{index}.y_m", text)


def _points_are_affordable(known: Known) -> Iterator[Problem]:
    cell, per_cell = known["discretisation.cell_m"], known["discretisation.points_per_cell"]
    count = size_of(known).area / cell**2 * per_cell
    if count > LARGEST_POINT_COUNT:
        yield problem(known, "discretisation.cell_m", _too_many("material points", count, LARGEST_POINT_COUNT, cell))
        return
    for _, field in paths_of_fields(known):
        method, reference = f"{field}.method", known[f"{field}.reference_cell_m"]
        carriers = count if reference is None else _lattice_points(known, field)
        if carriers > LARGEST_POINT_COUNT:
            yield problem(known, f"{field}.reference_cell_m", _too_fine(cell, reference, carriers))
            continue
        if known[method] == "cholesky" and carriers > LARGEST_CHOLESKY_COUNT:
            what, key = ("material", "discretisation.cell_m") if reference is None else ("lattice", "reference_cell_m")
            text = (
                f"{carriers:,.0f} {what} points need a dense factor of {carriers**2 * 8 / 1e9:,.1f} GB; at most "
                f"{LARGEST_CHOLESKY_COUNT:,} points: take {key} of at least "
                f"{(reference or cell) * sqrt(carriers / LARGEST_CHOLESKY_COUNT):.3g}, or fewer "
                "discretisation.points_per_cell"
            )
            yield problem(known, method, text)


def _too_fine(cell: float, reference: float, count: float) -> str:
    """What a reference lattice of so many points takes, and the finest one of cells that fit in those of the study."""
    parts = floor(cell / reference * sqrt(LARGEST_POINT_COUNT / count) + 1e-9)
    remedy = f"take {cell / parts:.10g} or more" if parts else "leave it out"
    return (
        f"gives {_rounded(count)} points of a lattice around the body, at most {LARGEST_POINT_COUNT:,}, and the field "
        f"would need about {count * BYTES_PER_LATTICE_POINT / 1e9:,.3g} GB: {remedy}"
    )


def _lattice_points(known: Known, field: str) -> float:
    """Points of the reference lattice that carries a field."""
    _, length, height = size_of(known)
    beyond = 0.25 * height if known["geometry.kind"] != "block" else 0.0
    above = 0.0 if is_plain_body(known) else beyond
    cell = known[f"{field}.reference_cell_m"]
    count = (length + beyond) / cell * (height + above) / cell
    per_square = 4 if known[f"{field}.reference_value"] == "point" else 1
    return count * known["discretisation.points_per_cell"] * per_square


def _cells_are_affordable(known: Known) -> Iterator[Problem]:
    cell = known["discretisation.cell_m"]
    _, length, height = size_of(known)
    count = (length + known["geometry.foreland_m"]) * height / cell**2
    if count > LARGEST_CELL_COUNT:
        yield problem(known, "discretisation.cell_m", _too_many("cells", count, LARGEST_CELL_COUNT, cell))


def _too_many(what: str, count: float, most: int, cell: float) -> str:
    larger = cell * sqrt(count / most)
    return f"gives {_rounded(count)} {what} in this geometry, at most {most:,}: take cells of at least {larger:.3g} m"


def _rounded(count: float) -> str:
    return f"{count:,.0f}" if count < 1e12 else f"{count:.3g}"


def _surface_bins_are_affordable(known: Known) -> Iterator[Problem]:
    width = known["output.surface_bin_m"]
    length = size_of(known).length + known["geometry.foreland_m"]
    if width and length / width > LARGEST_BIN_COUNT:
        least = length / LARGEST_BIN_COUNT
        text = f"gives {_rounded(length / width)} bins, at most {LARGEST_BIN_COUNT:,}: take {least:.3g} or more"
        yield problem(known, "output.surface_bin_m", text)


def _constrained_modulus(known: Known, index: int) -> float:
    """Constrained modulus of a material [kPa]."""
    modulus, ratio = known[f"material.{index}.youngs_modulus_kpa"], known[f"material.{index}.poissons_ratio"]
    return modulus * (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio))


def _stiffness_carries_the_weight(known: Known) -> Iterator[Problem]:
    """The soil must bear its own weight at strains for which the law and the initial stresses have a meaning."""
    height = height_of(known)
    for index in range(len(known["material"])):
        weight = known[f"material.{index}.unit_weight_kn_m3"] * height
        limit = weight / HIGHEST_SELF_COMPRESSION
        modulus = _constrained_modulus(known, index)
        if modulus < limit:
            key = f"material.{index}.youngs_modulus_kpa"
            text = (
                f"must be at least {known[key] * limit / modulus:.4g}: under its own weight of {weight:.4g} kPa "
                f"softer soil is compressed by more than {100 * HIGHEST_SELF_COMPRESSION:g} %"
            )
            yield problem(known, key, text)


def _steps_are_affordable(known: Known) -> Iterator[Problem]:
    cell, fraction, end = known["discretisation.cell_m"], known["time.step_fraction"], known["time.end_s"]
    for index in range(len(known["material"])):
        modulus, weight = _constrained_modulus(known, index), known[f"material.{index}.unit_weight_kn_m3"]
        steps = end / fraction * sqrt(modulus / weight) * sqrt(GRAVITY) / cell
        if steps > LARGEST_STEP_COUNT:
            text = (
                f"takes about {_rounded(steps)} time steps with these cells and this stiffness, at most "
                f"{LARGEST_STEP_COUNT:,}: end by {end * LARGEST_STEP_COUNT / steps:.3g} s, or take larger cells"
            )
            yield problem(known, "time.end_s", text)


SIZE_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _height_fits,
    _width_fits,
    _points_resist_every_motion,
    _points_are_affordable,
    _cells_are_affordable,
    _surface_bins_are_affordable,
    _histories_are_of_the_body,
    _stiffness_carries_the_weight,
    _steps_are_affordable,
]
