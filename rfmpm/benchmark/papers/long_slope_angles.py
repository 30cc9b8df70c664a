"""The long slope at four inclinations: from a spread that starts at the toe to one slide of the whole layer."""

from math import inf

import numpy as np

from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers.case import Case, Figure, Finding, Reproduction
from rfmpm.benchmark.papers.long_slopes import (
    ALONG,
    COARSE,
    MOVED,
    STRETCH,
    STUDY,
    TOP,
    Slide,
    draw,
    fifths_fail_at,
    geometry,
    goes_up,
    slide,
    turn_of,
)
from rfmpm.quantities.failure_mode import Shape, shape

ANGLES = (5.0, 10.0, 15.0, 20.0)  # [degrees]
DEPTH = 5.0  # [m]
FAR = 5.0  # displacement halfway up at which a slide is looked at: the depth of the layer [m]
SAME_TIME = 0.05  # a tenth of what a pressure wave takes from the toe to halfway up [s]
TURNED, UNTURNED = 10.0, 5.0  # [degrees]
Slides = dict[float, Slide]  # by inclination [degrees]


def reproduce(coarse: bool) -> Reproduction:
    """Run the four slopes and look at them as they slide and at rest."""
    cell = {"discretisation.cell_m": COARSE} if coarse else {}
    slides = {angle: slide(geometry(angle, DEPTH) | cell) for angle in ANGLES}
    findings = _spread(slides[5.0])
    for angle in (10.0, 15.0):
        findings += _toe_first(slides[angle], angle)
    return Reproduction(findings + _all_at_once(slides[20.0]), _figures(slides), _numbers(slides))


def _spread(run: Slide) -> list[Finding]:
    found, times = shape(run.state_at(inf)), fifths_fail_at(run, 5.0)
    last = max((time for time in times if time < inf), default=0.0)
    return [
        Finding(
            "5 degrees: a spread, with horsts and grabens",
            "kind of failure at rest",
            f"{run.kind_at(inf)}: {found.blocks} blocks, {found.ridges} ridges",
            run.kind_at(inf) == "spread",
        ),
        Finding(
            "5 degrees: triggered from the toe and moving up the slope",
            "the ground fails fifth by fifth from the toe upwards, over 3 s or more",
            ", ".join(f"{time:.1f}" for time in times) + " s",
            goes_up(times) and last - times[0] >= 3.0,
        ),
    ]


def _toe_first(run: Slide, angle: float) -> list[Finding]:
    toe, slope = run.passes("toe"), run.passes("slope")
    far = run.passes("slope", FAR)
    found = shape(run.state_at(far))
    return [
        Finding(
            f"{angle:g} degrees: a rotation at the toe first",
            f"the edge of the cut moves {MOVED:g} m before the slope halfway up does; {_TURNS}",
            f"{toe:.2f} s before {slope:.2f} s; {_turns(run, far, angle)}",
            toe < slope - SAME_TIME and _has_turned(run, far, angle),
        ),
        Finding(
            f"{angle:g} degrees: then a translational slide",
            f"kind of failure as the slope has moved {FAR:g} m, along the bed within 3 degrees",
            f"{run.kind_at(far)}, {found.slope:.0f} degrees",
            run.kind_at(far) == "translational" and abs(found.slope - angle) < 3.0,
        ),
        Finding(
            f"{angle:g} degrees: with secondary failures",
            f"three or more blocks as the slope has moved {FAR:g} m",
            f"{found.blocks} blocks",
            found.blocks >= 3,
        ),
    ]


def _all_at_once(run: Slide) -> list[Finding]:
    toe, slope, far = run.passes("toe"), run.passes("slope"), run.passes("slope", FAR)
    found, end = shape(run.state_at(far)), shape(run.state_at(inf))
    return [
        Finding(
            "20 degrees: a small rotation at the toe and a large translational slide at the same time",
            f"toe and slope move {MOVED:g} m within {SAME_TIME:g} s of each other; {_TURNS}; translational as the "
            f"slope has moved {FAR:g} m",
            f"{toe:.2f} and {slope:.2f} s; {_turns(run, far, 20.0)}; {run.kind_at(far)}, "
            f"{100.0 * run.failed_share_at(far):.0f} % of the layer",
            abs(toe - slope) <= SAME_TIME and _has_turned(run, far, 20.0) and run.kind_at(far) == "translational",
        ),
        Finding(
            "20 degrees: it breaks up",
            "the largest block has most of the area of all as it slides, and less than half at rest",
            f"{100.0 * found.main_block:.0f} % of {found.blocks} blocks, then {100.0 * end.main_block:.0f} % of "
            f"{end.blocks}",
            found.main_block > 0.5 > end.main_block,
        ),
    ]


_TURNS = (
    f"its soil has turned by {TURNED:g} degrees, the slope's by less than {UNTURNED:g}, as that has moved {FAR:g} m"
)


def _turned(run: Slide, time: float, angle: float) -> tuple[float, float]:
    """Mean rotations of what stayed whole at the toe and on the slope [degrees]."""
    state, knee = run.state_at(time), geometry(angle, DEPTH)["geometry.crest_edge_m"] - STRETCH
    whole = state.failed & (state.plastic_strain < state.block_plastic_strain)
    at_toe = state.x_initial > knee
    on_slope = (state.x_initial > TOP) & ~at_toe
    return tuple(turn_of(state, whole & part) if np.any(whole & part) else 0.0 for part in (at_toe, on_slope))


def _turns(run: Slide, time: float, angle: float) -> str:
    toe, slope = _turned(run, time, angle)
    return f"{toe:.0f} and {slope:.0f} degrees"


def _has_turned(run: Slide, time: float, angle: float) -> bool:
    toe, slope = _turned(run, time, angle)
    return toe >= TURNED and abs(slope) < UNTURNED


def _figures(slides: Slides) -> list[Figure]:
    def pictures(when):
        return [(f"{angle:g} degrees, {when(run):.1f} s", run, when(run)) for angle, run in slides.items()]

    moments = (
        ("The toe has moved 1 m", lambda run: run.passes("toe", 1.0)),
        (f"The slope halfway up has moved {FAR:g} m", lambda run: run.passes("slope", FAR)),
        ("At rest", lambda run: float(run.outcome.history["time"][-1])),
    )
    return [
        Figure(f"{title}: plastic strain over the initial outline.", lambda path, when=when: draw(pictures(when), path))
        for title, when in moments
    ]


def _numbers(slides: Slides) -> str:
    rows = []
    for angle, run in slides.items():
        far = run.passes("slope", FAR)
        for moment, time in ((f"slope moved {FAR:g} m", far), ("rest", float(run.outcome.history["time"][-1]))):
            found: Shape = shape(run.state_at(time))
            rows.append(
                f"{angle:g} | {moment} | {time:.1f} | {run.kind_at(time)} | {100 * run.failed_share_at(time):.0f} % "
                f"| {found.blocks} | {found.main_block:.2f} | {found.straight:.2f} | {found.slope:.0f} "
                f"| {found.depth / found.length:.2f} | {found.flowed:.2f} | {found.ridges}"
            )
    return f"{table(HEAD, rows)}\n\n{WHY}"


HEAD = (
    "inclination [degrees] | moment | time [s] | kind of failure | failed of the layer | blocks | main block "
    "| straight share | slope [degrees] | depth over length | flowed share | ridges"
)
WHY = """The measures are those of [the kind of failure](../../docs/quantities/failure_mode.md).

Why they differ: the peak strength over the shear stress on the bed of a layer without ends, c / (gamma d sin b cos b),
is 2.3, 1.2, 0.8 and 0.6. At 5 and 10 degrees the bed bears the layer, and only what the cut takes away sets it off: at
5 degrees each slide bares the next scarp, at 10 degrees the toe's slide takes so much support away that the band runs
up the bed within a second. At 15 and 20 degrees the bed is overstressed along its whole length: the band is there at
once, and only the toe, which the cut has freed, is as quick.
"""

CASE = Case(
    title="The long slope at 5, 10, 15 and 20 degrees",
    document="Vardon, Wang and Hicks (2017), Slope failure simulations with MPM, case 1",
    says="The same layer spreads piece by piece where it is gentle, and slides as a whole where it is steep.",
    studies=(STUDY,),
    left_open=(
        f"Depth and lengths of the layer: here {DEPTH:g} m upright, {ALONG:g} m down the slope (as in Wang et al., "
        f"2016), {TOP:g} m of level ground at the top and {STRETCH:g} m before the cut. Of 4, 4.5, 5 and 6 m (tried "
        "with 4 m of level ground before the cut) 5 m alone gives all four descriptions: with 4 m nothing fails at 5 "
        "and 10 degrees, with 4.5 m the slope of 10 degrees fails piece by piece, with 6 m most of that of 5 degrees "
        "slides within 3 s. The base is fixed: the layer lies on an elastic bed of four times its stiffness, "
        "to which it sticks. Before the toe the base is bare and rough, and the slides of 10 to 20 degrees run on for "
        "40 to 60 m; the paper does not say how far it followed them, so they are judged as the slope has moved "
        f"{FAR:g} m, and at rest."
    ),
    reproduce=reproduce,
)
