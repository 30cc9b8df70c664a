"""The page's section on the pile of aluminium bars."""

from pathlib import Path

import numpy as np

from rfmpm.benchmark.frictional import bars
from rfmpm.benchmark.frictional.cases import CELL, Section, collapse, finding
from rfmpm.benchmark.frictional.rates import SLOPE, inertial_number
from rfmpm.benchmark.markdown import table
from rfmpm.report.slope_figures import WIDTH
from rfmpm.report.style import BLUE, GREY, ORANGE, drawing, new_figure, save

CELLS, MIDDLE = (0.01, 0.005, 0.0025), 0.005  # [m]
GIVEN = 19.8  # angle of friction [degrees]
SHEAR_BOX = float(np.degrees(np.arcsin(np.tan(np.radians(GIVEN)))))  # if that is the ratio of stresses in a shear box
LAW, FRICTION = "material.0.law", "material.0.friction_angle_deg"
RATIO = float(np.tan(np.radians(GIVEN)))
CONE = float(np.degrees(np.arcsin(3.0 * RATIO / np.sqrt(9.0 + 12.0 * RATIO**2))))  # of the same slope at no dilation
SERIES = (("mohr_coulomb", GIVEN), ("drucker_prager", GIVEN), ("mohr_coulomb", SHEAR_BOX))
SOFT = {"material.0.poissons_ratio": 0.4, "material.0.youngs_modulus_kpa": 420.0}  # of the same bulk modulus
VARIATIONS = {
    "as given": {},
    "Drucker-Prager": {LAW: "drucker_prager"},
    "Poisson's ratio 0.4: at rest within yield": SOFT,
    "ten times as stiff": {"material.0.youngs_modulus_kpa": 8400.0},
    "the cone of Bui et al., matched for dilation as of friction": {LAW: "drucker_prager", FRICTION: CONE},
    "wall with the friction of the soil": {"boundary.sides": {"kind": "friction", "coefficient": RATIO}},
    "base with the friction of the soil": {"boundary.base": {"kind": "friction", "coefficient": RATIO}},
    "no numerical dissipation asked for": {"discretisation.dissipation_time_s": float("inf")},
    "rough wall": {"boundary.sides": {"kind": "fixed"}},
    "dilation 2 degrees": {"material.0.dilation_angle_deg": 2.0},
    "GIMP": {"discretisation.shape": "gimp"},
    "4-node squares": {"discretisation.shape": "linear"},
    "nine points per cell": {"discretisation.points_per_cell": 9},
    "a quarter of the time step": {"time.step_fraction": 0.2},
    "dissipation in 0.1 s": {"discretisation.dissipation_time_s": 0.1},
    "friction 21.1 degrees": {FRICTION: SHEAR_BOX},
    "friction 22.5 degrees": {FRICTION: 22.5},
}
LIMIT, FRONT, NEAR = 1.7, 0.44, 0.015  # [mm], [m], [m]: what is asked


def section(folder: Path) -> Section:
    """Run the pile on every cell size and with one thing changed at a time; draw its surface."""
    rows, points, errors, fronts = [], {}, {}, {}
    for law, friction in SERIES:
        for cell in CELLS:
            case = law, friction, cell
            outcome = collapse(bars.NAME, {CELL: cell, LAW: law, FRICTION: friction})
            points[case], errors[case], fronts[case] = outcome.points, _errors(outcome, cell), _fronts(outcome, cell)
            values = " | ".join([*(f"{e:.1f}" for e in errors[case]), *(f"{f:.3f}" for f in fronts[case])])
            share = 100.0 * outcome.quantities["numerical_dissipation_share"]
            rows.append(f"{law.replace('_', ' ')} | {friction:.1f} | {1e3 * cell:g} | {values} | {share:.0f} %")
    varied = []
    for name, changes in VARIATIONS.items():
        outcome = collapse(bars.NAME, {CELL: MIDDLE, **changes})
        values = [*(f"{e:.1f}" for e in _errors(outcome, MIDDLE)), *(f"{f:.3f}" for f in _fronts(outcome, MIDDLE))]
        varied.append(f"{name} | {' | '.join(values)}")
    _draw(points, folder / "frictional_bars.png")
    number = inertial_number(bars.NAME, MIDDLE)
    ours, other = (("mohr_coulomb", friction, CELLS[-1]) for friction in (GIVEN, SHEAR_BOX))
    read = " | ".join([*(f"{name} [mm]" for name in bars.READINGS), "front, a bar thick [m]", "front of 99.5 % [m]"])
    return Section(
        TEXT.format(
            rows=table(f"law | friction [degrees] | cell [mm] | {read} | numerical dissipation", rows),
            varied=table(f"cells of 5 mm | {read}", varied),
            number=f"{number:.3f}",
            angle=f"{np.degrees(np.arcsin(np.sin(np.radians(GIVEN)) + SLOPE * number)):.1f}",
        ),
        _findings(errors[ours], errors[other], fronts[ours], fronts[other]),
    )


def _findings(errors, other_errors, fronts, other_fronts) -> list[str]:
    def by_reading(values):
        return f"{min(values):.1f} to {max(values):.1f} mm"

    own = bars.measured_front_of_share()
    return [
        finding(
            "bars, cells of 2.5 mm: surface, root mean square",
            f"under {LIMIT} mm",
            f"{by_reading(errors)}, by reading; with 21.1 degrees {by_reading(other_errors)}",
            max(errors) < LIMIT,
        ),
        *(
            finding(
                f"bars, cells of 2.5 mm: {name}",
                f"{FRONT} +- {NEAR} m{note}",
                f"{front:.3f} m; with 21.1 degrees {other:.3f} m",
                abs(front - FRONT) <= NEAR,
            )
            for name, note, front, other in (
                ("front, a bar thick", "", fronts[0], other_fronts[0]),
                ("front of 99.5 %", f" (the measured pile's own: {own:.3f} m)", fronts[1], other_fronts[1]),
            )
        ),
    ]


def _errors(outcome, cell: float) -> list[float]:
    return [1e3 * bars.error(reading, outcome.points, cell) for reading in bars.READINGS.values()]


def _fronts(outcome, cell: float) -> tuple[float, float]:
    x = outcome.points["x"]
    return bars.front(outcome.points, cell), bars.front_of_share(x, np.ones_like(x))


def _draw(points, path: Path) -> None:
    """Draw the surfaces on the finest cells over the measured one."""
    at, cell = np.linspace(0.0, 0.5, 501), CELLS[-1]
    with drawing():
        figure = new_figure(WIDTH, 3.2)
        axes = figure.add_subplot()
        for friction, colour in ((GIVEN, BLUE), (SHEAR_BOX, ORANGE)):
            height = bars.by_mass(points["mohr_coulomb", friction, cell], cell, at)
            axes.plot(1e3 * at, 1e3 * height, color=colour, label=f"{friction:.1f} degrees, cells of 2.5 mm")
        axes.plot(*(1e3 * values for values in bars.measured()), "o", ms=3.5, color="black", label="measured")
        axes.plot([0, 200, 200], [100, 100, 0], color=GREY, lw=1.0, ls="--", label="before")
        axes.set(xlabel="x [mm]", ylabel="height [mm]", xlim=(0, 500), ylim=(0, 105))
        axes.legend()
        save(figure, path)


TEXT = """## The pile of aluminium bars

`configs/papers/bui_2008_aluminium_bars.toml`: Bui et al. (2008), measured surface read to about 1 mm
(`tests/papers/bui_2008/surface.csv`). Soil as given, none fitted. Root mean square of the surface less the measured
one, by three readings of a surface from points: the height of the soil at its first density, spread over a cell; the
same with its present volume; the top of the highest point in a cell's width. Fronts: where the soil is still as thick
as a bar, 1.5 mm, as the measured pile is at its last place, 0.442 m; and the quantile that a campaign takes.

{rows}

![Surfaces on cells of 2.5 mm](frictional_bars.png)

What governs it:

{varied}

- The pile is too flat: low from 40 to 200 mm, high from 340 to 420 mm, the crest right to 1 mm. The area below the
  measured curve is 1.5 % more than the column's; by present volumes ours is too.
- Finer cells dissipate less and flow further. They do not settle on the measured curve, so that a small figure on
  cells of 10 mm is that of two errors.
- The stress at the start, stiffness, wall, law, points per cell and time step matter less than friction. GIMP and
  4-node squares come closer on these cells, with a shorter front; no shape comes within 1.7 mm. Were 19.8 degrees the
  ratio of stresses in a shear box, in which soil without dilation shows tan = sin(phi), phi would be 21.1 degrees.
  Friction that rises with the rate of shear would add some more; the published law has none, nor has ours.
- Of what the experiment leaves open, a base or a wall that slips, and the cone of Bui et al., take the pile further
  off; the gate is not modelled. Bars that are sheared fast show more friction, which the law leaves out: the inertial
  number of our collapse is {number} in the mean over the work of shear, and discs gain about as much in the ratio of
  shear to normal stress (da Cruz et al. 2005), which makes 19.8 degrees {angle}: near the 22.5 degrees that come
  closest. That is an estimate, and as good an explanation as was found.
- So the surface is missed, by every reading. The study keeps 19.8 degrees.
"""
