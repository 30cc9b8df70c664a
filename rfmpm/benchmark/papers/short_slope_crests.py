"""How far back the short slope fails with each softening modulus, over the length of its crest: chance or order."""

from collections.abc import Sequence
from itertools import pairwise
from math import nan
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers.case import Finding
from rfmpm.benchmark.papers.short_slope import CREST, MODULUS, RESIDUAL, Cut, run
from rfmpm.report.style import BLUE, GREEN, GREY, VERMILION, drawing, new_figure

OF_PAPER = 10.0  # [m]
CRESTS = (9.5, OF_PAPER, 10.5, 11.0, 12.0, 14.0, 16.0, 18.0, 20.0)  # [m]
FEW = (OF_PAPER, 16.0)
OPEN = 16.0  # [m]: crests from here on are longer than any of these slides
SETTLED = 2.5  # [s] after the second band: its slide has left the face, and the third has not begun
COLOURS = (BLUE, GREEN, VERMILION)


class Reach(NamedTuple):
    """How far back the failure went."""

    end: float  # [m]
    is_stopped: bool  # by the boundary
    second: Cut  # the band behind that of the first slide
    left: float  # of the crest by that band, up to the boundary [m]
    ground: float  # lowest ground 3 to 5 m in front of the face that it leaves, once its slide is out of the way [m]


Reaches = dict[float, dict[float, Reach]]  # by softening modulus [kPa] and length of the crest [m]


def reaches(moduli: Sequence[float], cells: dict[str, Any], lengths: Sequence[float]) -> Reaches:
    """Run the slope of 4 kPa with each modulus and each crest."""
    return {modulus: {crest: _reach(modulus, crest, cells) for crest in lengths} for modulus in moduli}


def _reach(modulus: float, crest: float, cells: dict[str, Any]) -> Reach:
    own = run(cells | {RESIDUAL: 4.0, MODULUS: modulus, CREST: crest})
    ends, stopped = own.quantities["retrogression_distance"], bool(own.quantities["retrogression_censored"])
    if len(own.cuts) < 2:
        return Reach(ends, stopped, Cut(nan, nan), nan, nan)
    second = own.cuts[1]
    left, points = crest - second.distance, own.at(second.time + SETTLED)
    ground = min(points["y"][np.abs(points["x"] - left - ahead) < 0.5].max() for ahead in (3.5, 4.5))
    return Reach(ends, stopped, second, left, float(ground))


def findings(found: Reaches, half_step: Reaches, finer: Sequence[float]) -> list[Finding]:
    """Whether retrogression grows with the modulus: as in the paper, and with no boundary in the way."""
    own = [crests[OF_PAPER] for crests in found.values()]
    grows = _rises(one.end for one in own)
    seconds = (
        f"{_metres(one.second.distance for one in own)}, at "
        + ", ".join(f"{one.second.time:.1f}" for one in own)
        + " s"
    )
    free = sorted(crest for crest in next(iter(found.values())) if crest >= OPEN)
    ends = {crest: [crests[crest].end for crests in found.values()] for crest in free}
    stopped = any(crests[crest].is_stopped for crests in found.values() for crest in free)
    return [
        Finding(
            "4 kPa: retrogression grows with the softening modulus",
            "grows from 25 to 50 to 75 kPa with the crest of the paper, 10 m long",
            f"{_metres(one.end for one in own)}; second band {seconds}; with half the time step "
            f"{_metres(crests[OF_PAPER].end for crests in half_step.values())}; on finer cells {_metres(finer)}",
            grows,
            "" if grows else STRIP,
        ),
        Finding(
            "the same, with the boundary out of reach",
            f"grows from 25 to 50 to 75 kPa with every crest of {OPEN:g} m or more",
            "; ".join(f"{crest:g} m: {_metres(values)}" for crest, values in ends.items()),
            not stopped and all(_rises(values) for values in ends.values()),
        ),
    ]


def _rises(values) -> bool:
    return all(less < more for less, more in pairwise(values))


def _metres(values) -> str:
    return ", ".join(f"{value:.1f}" for value in values) + " m"


def numbers(found: Reaches) -> str:
    """A table of how far back each crest failed, and what the second slide left."""
    moduli, lengths = list(found), list(next(iter(found.values())))
    rows = []
    for crest in lengths:
        row = [found[modulus][crest] for modulus in moduli]
        ends = [f"{one.end:.1f}" + (" (boundary)" if one.is_stopped else "") for one in row]
        rows.append(" | ".join([f"{crest:g}", *ends, *(f"{one.left:.1f}, {one.ground:.1f}" for one in row)]))
    ends = [f"{modulus:g} kPa: retrogression [m]" for modulus in moduli]
    leaves = [f"{modulus:g} kPa: second slide leaves crest, ground [m]" for modulus in moduli]
    return table(" | ".join(["crest [m]", *ends, *leaves]), rows)


def draw(found: Reaches, path: Path) -> None:
    """Draw how far back the failure went, and the second band, over the length of the crest."""
    with drawing():
        figure = new_figure(7.2, 3.6)
        axes = figure.add_subplot()
        for (modulus, crests), colour in zip(found.items(), COLOURS, strict=True):
            lengths = list(crests)
            ends = [one.end for one in crests.values()]
            axes.plot(lengths, ends, color=colour, marker="o", label=f"{modulus:g} kPa")
            axes.plot(lengths, [one.second.distance for one in crests.values()], color=colour, lw=1.0, ls=":")
        axes.plot(lengths, lengths, color=GREY, lw=1.0, ls="--", label="boundary")
        axes.set(xlabel="length of the crest [m]", ylabel="behind the edge [m]", ylim=(0.0, None))
        axes.legend(title="softening modulus", loc="lower right", ncols=2)
        figure.savefig(path, format="png", dpi=130)


CAPTION = (
    "How far back the slope of 4 kPa fails with each softening modulus, over the length of the crest; dotted: its "
    "second band, which lies further back, the larger the modulus."
)
STRIP = (
    "its second band does lie further back, the larger the modulus, but whether a third slide follows is a close "
    "thing. With 75 kPa the second leaves hardly more than a metre of crest before the boundary, a smooth wall that "
    "the soil cannot leave, and more debris in front of it: this strip stands. With half a metre of crest more a "
    "third slide goes to the boundary with 75 kPa as with 50 kPa, and with no boundary near retrogression grows with "
    "the modulus; on cells of half the size, where no third slide follows with any modulus, it does so with the "
    "paper's crest. It is the length of the crest that decides, not chance: half the time step gives the same."
)
