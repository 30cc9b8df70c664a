"""What the slope of Toro Rojas et al. came to, in tables."""

import os

from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers import toro_rojas_runs as slope
from rfmpm.benchmark.papers.toro_rojas_runs import Cost, Studies, Travel


def text(found: Studies) -> str:
    """The tables, and what they mean."""
    limits = [
        f"{cell:.3g} | " + " | ".join(f"{held[shape]:.2f}" for shape in slope.SHAPES)
        for cell, held in found.held.items()
    ]
    rows = [
        *(_row(f"E = {1e-3 * E:g} MPa", one) for E, one in zip(slope.STIFFNESSES, found.softer, strict=True)),
        *(_row(f"c = {cohesion:g} kPa", one) for cohesion, one in found.stronger.items()),
        *(_row(f"cells of {cell:.3g} m", one) for cell, one in found.finer.items()),
        *(_row(f"cells of {cell:.3g} m, {count} points", one) for (cell, count), one in found.packed.items()),
        *(
            _row(f"c = {slope.STANDS:g} kPa, cells of 0.4 m, E = {1e-3 * E:g} MPa", one)
            for E, one in found.standing.items()
        ),
    ]
    soft = found.histories[slope.STIFFNESSES[0]]
    fastest = {place: (soft[place][1].max(), soft["time"][soft[place][1].argmax()]) for place in slope.PLACES}
    places = " | ".join(f"{place} [m]" for place in slope.PLACES)
    return TEXT.format(
        held=slope.HELD,
        end=slope.FULL_RUN,
        limits=table("cell [m] | quadratic B-splines [kPa] | 4-node squares [kPa]", limits),
        travel=table(f"| {places} | mean of all soil [m] | run-out [m]", rows),
        peaks="; ".join(f"{place} {speed:.2f} m/s at {time:.1f} s" for place, (speed, time) in fastest.items()),
        costs=table(
            "cell [m] | cells with soil | points | steps | processor time [s]",
            [
                *(_cost(cell, one) for cell, one in zip(found.finer, found.costs, strict=True)),
                f"{found.many.cell:.3g} | {found.many.cells} | {found.many.points} | {_steps(found):.0f} "
                f"| {_whole(found):.0f}, reckoned",
            ],
        ),
        ratio=slope.THEIR_TIME / _whole(found),
        theirs=slope.THEIR_ELEMENTS,
        short=found.many.steps,
        load=os.getloadavg()[0],
    )


def _row(label: str, one: Travel) -> str:
    if one.status not in ("ok", "not_at_rest"):
        return f"{label} | refused: {one.status.replace('_', ' ')} |  |  |  | "
    at = " | ".join(f"{one.at[place]:.3g}" for place in slope.PLACES)
    return f"{label} | {at} | {one.mean:.3g} | {one.run_out:.2f}"


def _cost(cell: float, one: Cost) -> str:
    return f"{cell:.3g} | {one.cells} | {one.points} | {one.steps} | {one.total:.2g}"


def _steps(found: Studies) -> float:
    """Steps of a whole run on many cells: in inverse proportion to the cell."""
    return found.costs[-1].steps * found.costs[-1].cell / found.many.cell


def _whole(found: Studies) -> float:
    """Time of a whole run on many cells [s], each step as long as those of the short one."""
    return found.many.preparing + found.many.stepping * _steps(found) / found.many.steps


TEXT = """Cohesion from which no point moves by {held:g} m in {end:g} s:

{limits}

Displacement within a cell of crown, centre and foot of the face, and of all soil:

{travel}

Largest speeds at 30 MPa: {peaks}.
Crown and centre speed up, and slow down, once; the foot, on the rough base, moves little and is flowed over. Stiffness
sets how far the slope gives before it yields, here by millimetres; what moves it afterwards is the part of its weight
that friction and cohesion do not carry, in which stiffness has no part. Cohesion is little beside the stresses deep
below and much beside those in the shallow soil near the face, which is what slides: hence the steep fall of the travel.
One point per cell spreads yielded soil more widely, which is seen in the mean of all soil and not at the crown.

{costs}

Their longest run, on {theirs} elements, took two days: {ratio:.0f} times as long as ours on about as many
cells, which is reckoned from {short} steps. One core, load of the machine {load:.1f}.
"""
