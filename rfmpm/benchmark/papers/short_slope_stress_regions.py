"""Where the short slope is elastic, softens, is at its residual strength or unloads, at three times."""

from math import inf
from pathlib import Path

import numpy as np

from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers.case import Case, Figure, Finding, Reproduction
from rfmpm.benchmark.papers.short_slope import COARSE, FINER, STUDY, Run, run
from rfmpm.mpm.scene import outline
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, view
from rfmpm.report.style import BLUE, GREEN, ORANGE, VERMILION, drawing, new_figure, save

TIMES = (1.5, 2.5, 40.5)  # [s], of the paper
READING = 0.5  # [s]: to which the paper tells its times
REGIONS = ("elastic", "softening", "residual", "elastic unloading")
COLOURS = (BLUE, ORANGE, VERMILION, GREEN)
ELASTIC, SOFTENING, AT_RESIDUAL, UNLOADING = range(len(REGIONS))
AT_YIELD = 0.99  # of the strength: from 0.95 to 1 - 1e-9 no share changes by more than 2 % of the area
SMALLEST = 0.01  # share of the area that counts as a region


def regions(own: Run, points: dict[str, np.ndarray]) -> np.ndarray:
    """The region of each point, its place in REGIONS; shape (n,).

    elastic: has never yielded. residual: its strength has come down to the residual, whether it flows or stands.
    softening: has yielded, is not at the residual, and lies on the yield surface. elastic unloading: lies below it.
    """
    strain, limit, soil = points["plastic_strain"], own.residual_strain, own.study.material[0]
    lost = (1.0 - soil.residual_cohesion_kpa / soil.cohesion_kpa) * np.minimum(strain / limit, 1.0)
    yields = _shear(points) >= AT_YIELD * own.outcome.points["cohesion"] * (1.0 - lost)
    return np.select([strain == 0.0, strain >= limit, yields], [ELASTIC, AT_RESIDUAL, SOFTENING], UNLOADING)


def _shear(points: dict[str, np.ndarray]) -> np.ndarray:
    """sqrt(J2), shape (n,) [Pa]."""
    normal = np.array([points[f"stress_{axis}"] for axis in ("xx", "yy", "zz")])
    return np.sqrt(0.5 * ((normal - normal.mean(axis=0)) ** 2).sum(axis=0) + points["stress_xy"] ** 2)


def shares(own: Run, time: float) -> np.ndarray:
    """Share of the initial area in each region at a time, shape (4,) [-]."""
    volumes = own.outcome.frames[0][1]["volume"]
    return np.bincount(regions(own, own.at(time)), weights=volumes, minlength=len(REGIONS)) / volumes.sum()


def reproduce(coarse: bool) -> Reproduction:
    """Run the slope of 4 and 50 kPa on the cells of the paper and on finer ones."""
    cells = [COARSE, COARSE] if coarse else [{}, FINER]
    own, finer = (run(cell) for cell in cells)
    figures = [
        Figure(CAPTION.format(own.study.discretisation.cell_m), lambda path: _draw(own, path)),
        Figure(FINER_CAPTION.format(finer.study.discretisation.cell_m), lambda path: _draw(finer, path)),
    ]
    return Reproduction(_findings(own, finer), figures, _text(own, finer))


def _findings(own: Run, finer: Run) -> list[Finding]:
    first = own.cuts[0].time if own.cuts else inf
    second, finer_second = (_second(one) for one in (own, finer))
    forming = own.pieces(own.at(TIMES[0]))
    wedge = len(forming) > 2
    blocks = own.quantities["block_count"]
    at_first, at_second, _ = (shares(own, time) for time in TIMES)
    is_second_in_time = abs(second - TIMES[1]) <= READING
    return [
        Finding(
            "the first band reaches the surface at about 1.5 s",
            f"residual strength from the base to the crest at {TIMES[0]:g} s, within the {READING:g} s of the paper",
            f"{first:.1f} s",
            abs(first - TIMES[0]) <= READING,
        ),
        Finding(
            "at 1.5 s the second band is forming",
            "there are two lines in the crest along which the soil has softened, with a whole piece between them",
            f"{len(forming)} pieces, that between the bands of {forming[1].area:.1f} m2" if wedge else "one band",
            wedge,
            "" if wedge else MERGED,
        ),
        Finding(
            "at 2.5 s the second band is complete",
            f"a second line at residual strength parts the crest at {TIMES[1]:g} s, within {READING:g} s",
            f"{second:.1f} s; on cells of {finer.study.discretisation.cell_m:g} m {finer_second:.1f} s",
            is_second_in_time,
            "" if is_second_in_time else MERGED,
        ),
        Finding(
            "at 40.5 s there are at least three blocks",
            "three or more blocks of little plastic strain in what slid",
            f"{blocks} blocks, at rest since {own.outcome.history['time'][-1]:.1f} s",
            blocks >= 3,
        ),
        Finding(
            "the regions are elastic, softening, residual and elastic unloading",
            f"at 1.5 and 2.5 s each has more than {SMALLEST:.0%} of the area",
            "; ".join(f"{time:g} s: " + _listed(now) for time, now in zip(TIMES, (at_first, at_second), strict=False)),
            bool(min(at_first.min(), at_second.min()) > SMALLEST),
        ),
    ]


def _second(own: Run) -> float:
    """When the crest is first in three pieces, parted by two bands [s]."""
    return next((time for time, points in own.outcome.frames if len(own.pieces(points)) > 2), inf)


def _listed(found: np.ndarray) -> str:
    return ", ".join(f"{100 * share:.0f} % {name}" for name, share in zip(REGIONS, found, strict=True))


def _text(own: Run, finer: Run) -> str:
    rows = [
        f"{one.study.discretisation.cell_m:g} | {time:g} | " + " | ".join(f"{100 * share:.0f} %" for share in found)
        for one in (own, finer)
        for time in TIMES
        for found in [shares(one, time)]
    ]
    cuts = [
        f"- cells of {one.study.discretisation.cell_m:g} m: "
        + ", ".join(f"{cut.distance:.1f} m behind the edge at {cut.time:.1f} s" for cut in one.cuts)
        for one in (own, finer)
    ]
    return f"{WHY}\n\n{table(HEAD, rows)}\n\nBands that cut the crest off:\n\n" + "\n".join(cuts) + "\n"


def _draw(own: Run, path: Path) -> None:
    """Draw the regions at the three times, one below the other, in one frame."""
    from matplotlib.colors import ListedColormap

    polygon, stages = outline(own.study), [own.at(time) for time in TIMES]
    frame = view([polygon[:, 0], *(p["x"] for p in stages)], [polygon[:, 1], *(p["y"] for p in stages)])
    ends = (-0.5, len(REGIONS) - 0.5)
    with drawing():
        figure = new_figure(WIDTH, len(TIMES) * (panel_height(frame) + 0.35))
        for axes, time, points in zip(figure.subplots(len(TIMES), 1), TIMES, stages, strict=True):
            axes.set_title(f"{time:g} s")
            where = regions(own, points)
            cloud = draw_panel(figure, axes, points, where, polygon, frame, ends, "", ListedColormap(COLOURS))
            cloud.colorbar.set_ticks(range(len(REGIONS)), labels=REGIONS)
        save(figure, path)


CAPTION = (
    "Cells of {:g} m, as in the paper: where the soil has never yielded, softens, has come down to its residual "
    "strength, and has yielded but unloads."
)
FINER_CAPTION = (
    "The same on cells of {:g} m: at 1.5 s the second band is forming behind the first, at 2.5 s it is complete."
)
HEAD = "cell [m] | time [s] | elastic | softening | residual | elastic unloading"
WHY = """The elastic stresses of a layer of this stiffness lie beyond the strength below a depth of about 3.4 m (weight
times depth times (1 - 2 nu) / (1 - nu), over the square root of 3, against 20 kPa). So the lower soil yields a little
as soon as it is let go, and then stands below its yield surface: most of what is called unloading behind the slide, at
all times. The rest of the crest has never yielded. The slide has its shearing in a band that starts at the toe, where
it has come down to the residual strength first; soil softens where the band bends up to the crest, along its borders,
and in the toe of the slide, which is pressed flat. As the slide leaves, the face behind it is steeper than before and
has lost its support: the soil behind and below it yields again, along the next band. At rest nothing flows: blocks that
have hardly been sheared lie in soil at its residual strength, and what remains elastic are the cores of blocks."""
MERGED = (
    "the two bands are hardly more than a metre, four or five cells, apart, and part the crest together; on cells half "
    "as large they do so one after the other, as in the paper. The next slide comes behind both of them, and later: "
    "its band is not the one that the paper calls the second."
)

CASE = Case(
    title="The short slope: stress regions",
    document="Vardon, Wang and Hicks (2017), 15th IACMAG, Wuhan",
    says=(
        "With a residual cohesion of 4 kPa and a softening modulus of 50 kPa a first band reaches the surface at about "
        "1.5 s while the second is forming, which is complete at 2.5 s; at 40.5 s there are at least three blocks."
    ),
    studies=(STUDY,),
    left_open=(
        "How the regions are told from each other. Here a point is at its residual strength from when it has come down "
        "to it, whether it flows or stands, and unloads where it has yielded, is above its residual strength and lies "
        "1 % or more below its yield surface at that moment. The last picture is that of rest, which comes before "
        "40.5 s. The grid is 40 m long instead of 20 m, which the run-out passes."
    ),
    reproduce=reproduce,
)
