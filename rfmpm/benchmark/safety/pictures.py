"""Pictures of the fields judged twice: factor against displacement, and examples of those judged differently."""

from pathlib import Path

import numpy as np

from rfmpm.benchmark.safety.fields import DISPLACEMENTS, SCENES, Row, study_of
from rfmpm.realisation import prepare, simulate, stability
from rfmpm.report.slope_figures import draw_panel, strain_limit, view
from rfmpm.report.style import BLUE, GREY, STRENGTH_MAP, VERMILION, drawing, new_figure, save

PANEL = (4.6, 3.4)  # inches
EXAMPLES = 3  # of each way of disagreeing
SCENE = "as it is"


def draw_fields(rows: list[Row], scatter: Path, examples: Path) -> str:
    """Draw the factor against the displacement, and the fields that disagree most.

    Args:
        rows: of all scenes.
        scatter: PNG file of the first picture.
        examples: PNG file of the second.

    Returns:
        What the second picture shows, in words.
    """
    with drawing():
        figure = new_figure(2 * PANEL[0], 2 * PANEL[1])
        for axes, scene in zip(figure.subplots(2, 2, sharex=True, sharey=True).flat, SCENES, strict=True):
            _scatter(axes, [row for row in rows if row.scene == scene], scene)
        figure.savefig(scatter, format="png", dpi=130)
    chosen = _chosen(rows)
    _draw_examples(chosen, examples)
    return "; ".join(f"realisation {row.index}: factor {row.factor:.2f}, {row.displacement:.2g} m" for row in chosen)


def _scatter(axes, rows: list[Row], scene: str) -> None:
    limit = DISPLACEMENTS[0]
    factor, moved = np.array([row.factor for row in rows]), np.array([row.displacement for row in rows])
    agree = (factor < 1.0) == (moved > limit)
    axes.scatter(factor[agree], moved[agree], s=10, color=BLUE, alpha=0.6, label="agree")
    axes.scatter(factor[~agree], moved[~agree], s=10, color=VERMILION, alpha=0.6, label="disagree")
    axes.axvline(1.0, color=GREY, linewidth=1.0)
    axes.axhline(limit, color=GREY, linewidth=1.0)
    axes.set(yscale="log", title=f"{scene}: {len(rows)} fields, {np.mean(~agree):.0%} disagree")
    axes.set(xlabel="factor of safety, peak strength [-]", ylabel="largest displacement [m]")
    axes.legend(loc="best")


def _chosen(rows: list[Row]) -> list[Row]:
    """The safest fields that moved and the weakest that stood; where none disagrees, the safest of all."""
    own = [row for row in rows if row.scene == SCENE]
    moved = [row for row in own if row.displacement > DISPLACEMENTS[0] and row.factor >= 1.0]
    still = [row for row in own if row.displacement <= DISPLACEMENTS[0] and row.factor < 1.0]
    safest = sorted(moved, key=lambda row: -row.factor)[:EXAMPLES]
    weakest = sorted(still, key=lambda row: row.factor)[:EXAMPLES]
    return [*safest, *weakest] or sorted(own, key=lambda row: -row.factor)[:EXAMPLES]


def _draw_examples(chosen: list[Row], path: Path) -> None:
    prepared = prepare(study_of(SCENE))
    outline = prepared.scene.body.outline
    with drawing():
        figure = new_figure(2 * PANEL[0], 2.1 * len(chosen))
        for (before, after), row in zip(figure.subplots(len(chosen), 2, squeeze=False), chosen, strict=True):
            found, strength = stability(prepared, "bishop", row.index)
            outcome = simulate(prepared, row.index)
            start = {"x": outcome.points["x_initial"], "y": outcome.points["y_initial"]}
            cohesion = strength.cohesion / 1e3
            ends = tuple(np.percentile(cohesion, [1.0, 99.0]))
            frame = view([outline[:, 0]], [outline[:, 1]])
            draw_panel(figure, before, start, cohesion, outline, frame, ends, "cohesion [kPa]", STRENGTH_MAP)
            before.plot(*found.surface.T, color=VERMILION)
            before.set_title(f"{row.index}: factor {row.factor:.2f}")
            strain = outcome.points["plastic_strain"]
            frame = view([outline[:, 0], outcome.points["x"]], [outline[:, 1], outcome.points["y"]])
            ends = (0.0, strain_limit([strain]))
            draw_panel(figure, after, outcome.points, strain, outline, frame, ends, "plastic strain [-]")
            after.set_title(f"moved {row.displacement:.3g} m")
        save(figure, path)
