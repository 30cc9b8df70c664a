"""The short slope with random peak cohesion, of two scales of fluctuation, in three stages."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rfmpm import realisation
from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers.case import Case, Figure, Finding, Reproduction, study
from rfmpm.benchmark.papers.short_slope import COARSE, EVERY, Cut, Run
from rfmpm.mpm.scene import outline
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, strain_limit, view
from rfmpm.report.style import STRENGTH_MAP, drawing, new_figure, save

STUDY = "vardon_2016_random_slope"
SCALES = (1.0, 2.5)  # [m], in both directions
FEW = 4
STAGES = ("initial failure", "first block", "final")
SHOWN = ("x", "y", "x_initial", "y_initial", "plastic_strain")


@dataclass(frozen=True)
class Member:
    """A realisation: the stages that it came through, and what it came to."""

    index: int
    cohesion: np.ndarray  # peak, shape (n,) [Pa]
    stages: dict[str, tuple[float, dict[str, np.ndarray]]]  # time [s] and points by stage; those that it reached
    cuts: list[Cut]
    in_band: float  # mean peak cohesion of the first band over that of the body [-]; NaN without a band
    run_out: float  # [m]
    retrogression: float  # [m]
    is_stopped: bool  # by the boundary


def reproduce(coarse: bool) -> Reproduction:
    """Run realisations of both scales of fluctuation."""
    cells, count = (COARSE, FEW) if coarse else ({}, study(STUDY).study.realisations)
    members = {scale: realise(scale, cells, count) for scale in SCALES}
    figures = [
        Figure(CAPTION.format(scale=scale, index=typical(own).index, count=count), _drawer(own, scale))
        for scale, own in members.items()
    ]
    return Reproduction([_finding(scale, own) for scale, own in members.items()], figures, _text(members))


def realise(scale: float, cells: dict, count: int) -> list[Member]:
    """Run so many realisations with this scale of fluctuation [m] and some keys for the cells."""
    scales = {f"random_field.cohesion.scale_of_fluctuation_{axis}_m": scale for axis in "hv"}
    asked = study(STUDY, cells | scales)
    prepared = realisation.prepare(asked)  # the factor of the field is worth several runs
    runs = (Run(asked, realisation.simulate(prepared, index, frames=EVERY)) for index in range(count))
    return [member(own, index) for index, own in enumerate(runs)]


def member(own: Run, index: int) -> Member:
    """Find the stages of a run.

    initial failure: a band at residual strength leads from the base to the crest. first block: what it cut off has sunk
    by half of the height, in the mean over its crest. final: the end.
    """
    frames, q = own.outcome.frames, own.quantities
    cohesion = own.outcome.points["cohesion"]
    stages, in_band = {STAGES[2]: frames[-1]}, np.nan
    if own.cuts:
        stages[STAGES[0]] = failed = next(frame for frame in frames if frame[0] >= own.cuts[0].time)
        in_band = cohesion[failed[1]["plastic_strain"] >= own.residual_strain].mean() / cohesion.mean()
        crest = own.study.geometry.crest_m
        slid = (failed[1]["y_initial"] > own.study.geometry.height_m - own.spacing) & (
            failed[1]["x_initial"] > crest - own.cuts[0].distance
        )
        sunk = (f for f in frames if -f[1]["displacement_y"][slid].mean() > 0.5 * own.study.geometry.height_m)
        if block := next(sunk, None):
            stages[STAGES[1]] = block
    return Member(
        index,
        cohesion,
        {name: (time, {key: points[key] for key in SHOWN}) for name, (time, points) in stages.items()},
        own.cuts,
        float(in_band),
        q["run_out"],
        q["retrogression_distance"],
        bool(q["retrogression_censored"]),
    )


def is_staged(own: Member) -> bool:
    """Whether it comes through the three stages: a band, then its block apart, then another band behind it."""
    return set(STAGES) <= set(own.stages) and any(cut.time > own.stages[STAGES[1]][0] for cut in own.cuts)


def typical(members: Sequence[Member]) -> Member:
    """Of those that come through the three stages, the one with the median run-out; of all if there are none."""
    chosen = [one for one in members if is_staged(one)] or list(members)
    return sorted(chosen, key=lambda one: one.run_out)[(len(chosen) - 1) // 2]


def _finding(scale: float, members: Sequence[Member]) -> Finding:
    staged = sum(is_staged(one) for one in members)
    agrees = 2 * staged > len(members)
    return Finding(
        f"scale of fluctuation {scale:g} m: initial failure, first block, final failure",
        "in most realisations a band cuts the crest, its block sinks by half of the height, and then a band cuts the "
        "crest behind",
        f"{staged} of {len(members)}",
        agrees,
        "" if agrees else FEWER,
    )


def _text(members: dict[float, list[Member]]) -> str:
    rows = []
    for scale, every in members.items():
        starts = [one.cuts[0].time for one in every if one.cuts]
        blocks = sum(STAGES[1] in one.stages for one in every)
        rows.append(
            f"{scale:g} | {len(starts)} of {len(every)} | {blocks} | {sum(len(one.cuts) > 1 for one in every)} "
            f"| {sum(one.is_stopped for one in every)} | {_spread(starts)} | {_spread([one.run_out for one in every])} "
            f"| {_spread([one.retrogression for one in every])} | {_spread([one.in_band for one in every])}"
        )
    return f"{WHY}\n\n{table(HEAD, rows)}\n"


def _spread(values: Sequence[float]) -> str:
    return f"{np.nanmean(values):.2f} ± {np.nanstd(values, ddof=1):.2f}"


def _drawer(members: Sequence[Member], scale: float):
    return lambda path: _draw(typical(members), scale, path)


def _draw(own: Member, scale: float, path: Path) -> None:
    """Draw the field of peak cohesion, and below it the plastic strain of each stage."""
    polygon = outline(study(STUDY))
    stages = [(name, *own.stages[name]) for name in STAGES if name in own.stages]
    last = stages[-1][-1]
    frame = view([polygon[:, 0], last["x"]], [polygon[:, 1], last["y"]])
    top = strain_limit([last["plastic_strain"]])
    with drawing():
        figure = new_figure(WIDTH, (1 + len(stages)) * (panel_height(frame) + 0.35))
        field, *panels = figure.subplots(1 + len(stages), 1)
        field.set_title(f"peak cohesion, scale of fluctuation {scale:g} m, realisation {own.index}")
        start = {"x": last["x_initial"], "y": last["y_initial"]}
        ends = tuple(np.percentile(own.cohesion / 1e3, [1.0, 99.0]))
        draw_panel(figure, field, start, own.cohesion / 1e3, polygon, frame, ends, "cohesion [kPa]", STRENGTH_MAP)
        for axes, (name, time, points) in zip(panels, stages, strict=True):
            axes.set_title(f"{name}, {time:.1f} s")
            strain = points["plastic_strain"]
            draw_panel(figure, axes, points, strain, polygon, frame, (0.0, top), "plastic strain [-]")
        save(figure, path)


CAPTION = (
    "Peak cohesion with a scale of fluctuation of {scale:g} m, and the plastic strain of the three stages: realisation "
    "{index}, of the {count} that were run the one with the median run-out among those that come through all three."
)
HEAD = (
    "scale [m] | a band cuts the crest | block sinks half the height | second band | to the boundary | first band [s] "
    "| run-out [m] | retrogression [m] | cohesion of the first band over that of the body"
)
WHY = """The initial failure is a band from the toe to the crest as in the slope without variation, but not the same
arc: it bends through weak soil (blue in the field) and around strong soil, and what it passes through is on the average
an eighth weaker than the body. It is complete sooner, and where two weak ways compete there are two bands. The first
block then leaves a face that stands alone, and further bands cut the crest behind, often up to the boundary. With the
larger scale a weak or a strong zone is as large as a block, so that realisations differ more, in how far they run out
and in how far back they fail: some end with their first block, and in some a second band is there before the first
block has sunk, which is not counted as the three stages."""
FEWER = "in the others the soil behind the first block is strong enough to stand, or it all goes at once."

CASE = Case(
    title="The short slope: random cohesion",
    document="Vardon (2016), The Material Point Method, lecture, TU Delft",
    says=(
        "With random peak cohesion, of a scale of fluctuation of 1.0 and of 2.5 m, the slope fails in three stages: "
        "initial failure, first block, final failure."
    ),
    studies=(STUDY,),
    left_open=(
        "Mean and variation (taken from the long slope of 2017: 20 kPa, 0.25), distribution (lognormal), residual (a "
        "fifth of the peak) and softening modulus (50 kPa, as in the short slope that retrogresses), correlation "
        "(Markov, isotropic), what a value of the field stands for (the mean over a point's volume), how many "
        "realisations were run and which is shown. No times are given for the stages: their definitions are ours."
    ),
    reproduce=reproduce,
)
