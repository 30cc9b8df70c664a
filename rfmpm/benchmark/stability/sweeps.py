"""The sweeps of the stress test."""

from collections.abc import Iterator
from functools import partial
from itertools import product

from rfmpm.benchmark.stability import arrangements
from rfmpm.benchmark.stability.case import CELL, ELASTIC, SLOPE, Case, Sweep, block, random_strength
from rfmpm.benchmark.stability.soils import random_soils
from rfmpm.mpm.boundary import WALLS
from rfmpm.mpm.shapes import SHAPES
from rfmpm.study import Study

SNAP_BACK = 325.573  # [kPa] softening modulus of the slope at which stress falls as fast as the soil can unload
LONG_STEPS = 1_000_000


def all_sweeps() -> list[Sweep]:
    """Every sweep, in the order of the report."""
    made = (
        *(time_step, shapes, points_per_cell, poissons_ratio, stiffness, softening, strength_contrast, variability),
        *(weak_soil, steep_and_flat, lone_point, separation, long_run, random_soils),
    )
    return [sweep() for sweep in made]


def few(sweeps: list[Sweep]) -> list[Sweep]:
    """The first and the last case of every sweep but the long runs: a look at the machinery."""
    return [
        Sweep(s.name, s.title, s.rows, s.columns, [s.cases[0], s.cases[-1]]) for s in sweeps if s.name != "long_run"
    ]


def _table(rows: dict, columns: dict) -> Iterator[tuple[str, str, dict]]:
    """Row, column and changes of every place of a table; rows and columns name their changes."""
    for (row, of_row), (column, of_column) in product(rows.items(), columns.items()):
        yield row, column, of_row | of_column


def _each(key: str, values, label: str = "{:g}") -> dict[str, dict]:
    return {label.format(value): {key: value} for value in values}


def _all_shapes() -> dict[str, dict]:
    return {name.replace("_", " "): {"discretisation.shape": name} for name in SHAPES}


def time_step() -> Sweep:
    """Time step from a tenth of the critical one to beyond it, where a study is refused and the engine must notice."""
    cases = [
        Case(row, column, changes, refusal="" if changes["time.step_fraction"] <= 1.0 else "time.step_fraction")
        for row, column, changes in _table(
            _all_shapes(),
            _each("time.step_fraction", (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2)),
        )
    ]
    for row, changes in _all_shapes().items():
        for fraction in (1.1, 1.2):
            beyond = partial(arrangements.beyond_the_critical_step, fraction)
            cases.append(Case(f"{row}, refusal lifted", f"{fraction:g}", changes, arrange=beyond, may_stop=True))
    return Sweep("time_step", "Time step", "shape function", "time step over the critical one", cases)


def shapes() -> Sweep:
    """Shape functions and rates of dissipation, as far as a study offers them."""
    rates = _each("discretisation.dissipation_time_s", (float("inf"), 50.0, 5.0, 0.5, 0.05, 1e-6), "{:g} s")
    strengths = {"c_r = 4": 4.0, "c_r = 12": 12.0}
    rows = {
        f"{name}, {label}": changes | {"material.0.residual_cohesion_kpa": value}
        for name, changes in _all_shapes().items()
        for label, value in strengths.items()
    }
    cases = [Case(*place) for place in _table(rows, rates)]
    return Sweep("shapes", "Shape function and transfer", "shape function", "dissipation time", cases)


def points_per_cell() -> Sweep:
    """Points per cell."""
    counts = _each("discretisation.points_per_cell", (1, 4, 9, 16)) | {"25": {"discretisation.points_per_cell": 25}}
    refused = [(shape, "25") for shape in _all_shapes()] + [("cubic bspline", "1")]
    cases = [
        Case(*place, refusal="points_per_cell" if place[:2] in refused else "")
        for place in _table(_all_shapes(), counts)
    ]
    return Sweep("points_per_cell", "Points per cell", "shape function", "points per cell", cases)


def poissons_ratio() -> Sweep:
    """Poisson's ratio up to incompressible."""
    rows = {
        "elastic": {"material.0": ELASTIC},
        "perfectly plastic, c = 10": _strength(10.0, 10.0, 0.0),
        "softening, 20 to 4": {},
    }
    ratios = _each("material.0.poissons_ratio", (0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.48, 0.49, 0.495, 0.5))
    cases = [Case(*place, refusal="poissons_ratio" if float(place[1]) > 0.49 else "") for place in _table(rows, ratios)]
    return Sweep("poissons_ratio", "Poisson's ratio", "soil", "Poisson's ratio", cases)


def stiffness() -> Sweep:
    """Young's modulus over more than six decades; where the soil is too soft for its own weight it is refused."""
    rows = {
        "elastic": {"material.0": ELASTIC},
        "perfectly plastic, c = 8": _strength(8.0, 8.0, 0.0),
        "softening, 20 to 4": {},
    }
    moduli = _each("material.0.youngs_modulus_kpa", (1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e300), "{:.0e} kPa")
    cases = []
    for row, column, changes in _table(rows, moduli):
        modulus = changes["material.0.youngs_modulus_kpa"]
        seconds = 5.0 if modulus < 1e6 else 1.0
        refusal = "" if 100.0 < modulus < 1e8 else "modulus_kpa" if modulus < 1e8 else "time.end_s"
        cases.append(Case(row, column, changes | {"time.end_s": seconds}, refusal=refusal))
    return Sweep("stiffness", "Stiffness", "soil", "Young's modulus", cases)


def softening() -> Sweep:
    """Softening modulus up to snap-back and past it, which only softening over a length may go."""
    local = {
        "material.0.softening_length_m": None,
        "material.0.softening_reference_cell_m": 0.25,
        "material.0.viscosity_kpa_s": 0.0,
    }
    residuals = {
        f"residual {residual:g} kPa": {"material.0.residual_cohesion_kpa": residual}
        for residual in (12.0, 4.0, 1.0, 0.01)
    }
    rows = residuals | {f"{name}, by the cell": changes | local for name, changes in residuals.items()}
    shares = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.999999, 1.01, 10.0)
    columns = {f"{share:.7g}": {"material.0.softening_modulus_kpa": share * SNAP_BACK} for share in shares}
    cases = [
        Case(*place, refusal="softening_modulus_kpa" if float(place[1]) > 1.0 and "by the cell" in place[0] else "")
        for place in _table(rows, columns)
    ]
    return Sweep("softening", "Softening", "residual cohesion", "softening modulus over that of snap-back", cases)


def strength_contrast() -> Sweep:
    """Neighbouring points of very different strength."""
    patterns = ("every other point", "every other layer", "one weak point", "all weak but one")
    cases = [
        Case(
            pattern,
            f"{ratio:g}",
            {"random_field.cohesion": random_strength(0.5, 6.0, 1.0)},
            arrange=partial(arrangements.contrast, pattern, ratio),
        )
        for pattern, ratio in product(patterns, (1.0, 10.0, 100.0, 1e3, 1e4, 1e6))
    ]
    return Sweep("strength_contrast", "Strength contrast", "pattern", "strong over weak", cases)


def variability() -> Sweep:
    """Coefficient of variation against the scale of fluctuation, down to far below a cell; two realisations each."""
    scales = {f"{in_cells:g}": in_cells * CELL for in_cells in (0.01, 0.2, 0.5, 1.0, 4.0, 20.0, 1000.0)}
    cases = [
        Case(f"{cov:g}", column, {"random_field.cohesion": random_strength(cov, scale, scale)}, index)
        for cov, (column, scale), index in product((0.1, 0.25, 0.5, 0.75, 1.0, 2.0), scales.items(), range(2))
    ]
    return Sweep("variability", "Random strength", "coefficient of variation", "scale of fluctuation over cell", cases)


def weak_soil() -> Sweep:
    """Cohesion down to next to nothing."""
    walls = {
        f"{kind} base": {"boundary.base": {"kind": kind} | ({"coefficient": 0.3} if kind == "friction" else {})}
        for kind in WALLS
    }
    columns = {f"{c:g} kPa": _strength(c, 0.2 * c, 0.0) for c in (10.0, 5.0, 2.0, 1.0, 0.1, 1e-2, 1e-4, 1e-8, 1e-12)}
    return Sweep(
        "weak_soil", "Next to no cohesion", "base", "cohesion", [Case(*place) for place in _table(walls, columns)]
    )


def steep_and_flat() -> Sweep:
    """From a vertical cut to a slope that hardly is one."""
    rows = {f"{c:g} kPa": _strength(c, 0.2 * c, 50.0) for c in (5.0, 10.0, 20.0, 40.0)}
    angles = _each("geometry.angle_deg", (90.0, 89.0, 75.0, 60.0, 45.0, 30.0, 15.0, 5.0, 2.0), "{:g}°")
    cases = [Case(row, column, changes | {"time.end_s": 10.0}) for row, column, changes in _table(rows, angles)]
    return Sweep("steep_and_flat", "Inclination", "peak cohesion", "inclination", cases)


def lone_point() -> Sweep:
    """One point in an empty grid, dropped from every kind of place in a cell."""
    near = 1e-12
    places = {"0": 0.0, "0 + 1e-12": near, "0.1": 0.1, "0.25": 0.25, "½ - 1e-12": 0.5 - near, "0.5": 0.5, "0.75": 0.75,
              "0.9": 0.9, "1 - 1e-12": 1.0 - near}  # fmt: skip
    heights = (1e-12, 0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.7)
    base = {"geometry": block(2.0, 2.0, 2.0), "time.end_s": 5.0}
    cases = [
        Case(
            f"{name}, {height:g} up",
            label,
            base | changes,
            arrange=partial(arrangements.lone_point, 2.0 + place, height),
        )
        for (name, changes), height, (label, place) in product(_all_shapes().items(), heights, places.items())
    ]
    return Sweep("lone_point", "One point in an empty cell", "shape, height [cells]", "place in its cell", cases)


def separation() -> Sweep:
    """Two halves of a block that fall onto each other."""
    soils = {
        "elastic": {"material.0": ELASTIC},
        "perfectly plastic, c = 10": _strength(10.0, 10.0, 0.0),
        "softening, 20 to 4": {},
        "c = 0.1": _strength(0.1, 0.1, 0.0),
    }
    rows = {
        f"{name}, {soil}": shape | changes for name, shape in _all_shapes().items() for soil, changes in soils.items()
    }
    base = {"geometry": block(2.0, 2.0, 8.0), "time.end_s": 10.0}
    cases = [
        Case(row, f"{gap:g}", base | changes, arrange=partial(arrangements.parted, gap))
        for (row, changes), gap in product(rows.items(), (0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 3.7))
    ]
    return Sweep("separation", "Separation and renewed contact", "shape, soil", "gap [cells]", cases)


def long_run() -> Sweep:
    """A million steps of a small block released without stress, the clock of rest switched off."""
    soils = {"elastic": {"material.0": ELASTIC}, "plastic, c = 4": _strength(4.0, 4.0, 0.0)}
    rates = _each("discretisation.dissipation_time_s", (float("inf"), 5.0), "{:g} s")
    rows = {f"{name}, {soil}": shape | soils[soil] for name, shape in _all_shapes().items() for soil in soils}
    base = {"geometry": block(1.5, 1.0, 1.0)}
    cases, fraction = [], Study(**SLOPE).time.step_fraction
    for row, column, changes in _table(rows, rates):
        wave_speed = 27.0  # [m/s], rounded down so that the steps are more than asked
        end = 1.03 * LONG_STEPS * fraction * CELL / wave_speed
        cases.append(Case(row, column, base | changes | {"time.end_s": end}, arrange=arrangements.never_at_rest))
    return Sweep("long_run", "A million steps", "shape, soil", "dissipation time", cases)


def _strength(peak: float, residual: float, softening: float) -> dict:
    return {
        "material.0.cohesion_kpa": peak,
        "material.0.residual_cohesion_kpa": residual,
        "material.0.softening_modulus_kpa": softening,
    }
