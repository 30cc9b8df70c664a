"""The long slope that an excavation at its toe sets off."""

from math import inf

from rfmpm.benchmark.papers.case import Case, Figure, Finding, Reproduction
from rfmpm.benchmark.papers.long_slopes import (
    ALONG,
    COARSE,
    STRETCH,
    STUDY,
    TOP,
    Slide,
    draw,
    fifths_fail_at,
    geometry,
    goes_up,
    slide,
)
from rfmpm.quantities.failure_mode import shape

ANGLE, DEPTH = 5.0, 5.0  # [degrees], [m]
WALL = 80.0  # to which the layer reaches before it is excavated [m]
STANDS = 5.0  # the slope that is not excavated is followed for so long [s]
SEEN = (1.5, 4.0, 8.0, inf)  # [s]


def reproduce(coarse: bool) -> Reproduction:
    """Run the slope with and without its excavation."""
    cell = {"discretisation.cell_m": COARSE} if coarse else {}
    whole, cut = changes()
    standing, run = slide(whole | cell | {"time.end_s": STANDS}), slide(cut | cell)
    last = float(run.outcome.history["time"][-1])
    pictures = [(f"{min(time, last):.1f} s after the excavation", run, time) for time in SEEN]
    figure = Figure(
        "Plastic strain after the excavation, over the outline that it leaves.", lambda path: draw(pictures, path)
    )
    return Reproduction(_findings(standing, run), [figure], WHY)


def changes() -> tuple[dict, dict]:
    """Changes to the study: the layer goes on to a wall; the same, excavated 1:1 at the toe."""
    plain = geometry(ANGLE, DEPTH)
    corners = plain["geometry.region.0.corners_m"]
    whole = plain | {
        "geometry.region.0.corners_m": [*corners[:3], [WALL, 0.0], [WALL, DEPTH], *corners[5:]],
        "geometry.foreland_m": 0.0,
    }
    pit = {"corners_m": [corners[4], corners[3], [WALL, 0.0], [WALL, DEPTH]]}
    return whole, whole | {"geometry.foreland_m": WALL - corners[3][0], "geometry.cut": [pit]}


def _findings(standing: Slide, run: Slide) -> list[Finding]:
    times, found = fifths_fail_at(run, ANGLE), shape(run.state_at(inf))
    return [
        Finding(
            "an initial perturbation, such as an excavation, triggers the failure",
            f"without the excavation nothing has failed after {STANDS:g} s; with it the toe has within 3 s",
            f"{standing.kind_at(inf)}; the toe at {run.passes('toe'):.1f} s",
            standing.kind_at(inf) == "no_failure" and run.passes("toe") < 3.0,
        ),
        Finding(
            "a series of failures",
            "three or more blocks, and the kind of failure is retrogressive or spread",
            f"{found.blocks} blocks, {run.kind_at(inf)}",
            found.blocks >= 3 and run.kind_at(inf) in ("retrogressive", "spread"),
        ),
        Finding(
            "that retrogressively move up the slope",
            "the ground fails fifth by fifth from the toe upwards, none before the one below, at three moments or more",
            ", ".join(f"{time:.1f}" for time in times) + " s",
            goes_up(times),
        ),
    ]


WHY = """Why it looks as it does: on a slope of 5 degrees the peak strength is 2.3 times the shear stress on the bed, so
the layer stands for as long as its toe is held. The excavation leaves a face of 45 degrees and 5 m, as high as the
short slope's; it fails on a circle, and each slide leaves a scarp that is as high and steeper. Between the blocks,
which keep their tops, lies soil that was sheared to its residual strength: ridges with subsided ground between them.
"""

CASE = Case(
    title="The long slope that is excavated",
    document="Wang, Vardon and Hicks (2016), Computers and Geotechnics 78",
    says=(
        "A long slope, where an initial perturbation (e.g. an excavation) triggers a series of failures that can "
        "retrogressively move up-slope."
    ),
    studies=(STUDY,),
    left_open=(
        f"All but the length of about {ALONG:g} m down the slope was not at hand: here a layer of {DEPTH:g} m on a bed "
        f"of {ANGLE:g} degrees with level ground of {TOP:g} m at its top, in the soil of Vardon, Wang and Hicks "
        f"(2017). It goes on to a wall before the toe, and is excavated 1:1 from {STRETCH:g} m in front of the slope. "
        "The initial stresses are those before the excavation. The paper's short slope is that of "
        "[the five runs](short_slope_five_runs.md)."
    ),
    reproduce=reproduce,
)
