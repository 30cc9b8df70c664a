"""Picture and animation of one realisation."""

from pathlib import Path

import numpy as np

from rfmpm.report import words
from rfmpm.report.question import NAMES
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, strain_limit, view
from rfmpm.report.style import DOTS_PER_INCH, STRENGTH_MAP, drawing, new_figure

FRAMES_PER_SECOND = 10
MOTION = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s²"}
MOTION_HEIGHT = 2.4  # inches


def write_simulation_picture(outcome, study, path: Path) -> None:
    """Picture the end of a simulation: plastic strain, the peak cohesion at the start where it varies, named points.

    Args:
        outcome: the Outcome of a simulation.
        study: its Study.
        path: PNG file to write.
    """
    from rfmpm.mpm.scene import outline

    polygon, points = outline(study), _known(outcome.points)
    frame = view([polygon[:, 0], points["x"]], [polygon[:, 1], points["y"]])
    is_random = "cohesion" in points and points["cohesion"].size > 0 and np.ptp(points["cohesion"]) > 0.0
    with drawing():
        heights = (1 + is_random) * [panel_height(frame) + 0.35] + bool(outcome.motion) * [MOTION_HEIGHT]
        figure = new_figure(WIDTH, sum(heights))
        grid = figure.add_gridspec(len(heights), len(MOTION), height_ratios=heights)
        panels = [figure.add_subplot(grid[row, :]) for row in range(1 + is_random)]
        top = strain_limit([points["plastic_strain"]])
        panels[0].set_title(_title(outcome))
        strain = points["plastic_strain"]
        draw_panel(figure, panels[0], points, strain, polygon, frame, (0.0, top), "plastic strain [-]")
        if is_random:
            start = {"x": points["x_initial"], "y": points["y_initial"]}
            cohesion = points["cohesion"] / 1000.0
            ends = tuple(np.percentile(cohesion, [1.0, 99.0]))
            panels[1].set_title("Peak cohesion at the start")
            draw_panel(figure, panels[1], start, cohesion, polygon, frame, ends, "cohesion [kPa]", STRENGTH_MAP)
        if outcome.motion:
            draw_motion([figure.add_subplot(grid[-1, column]) for column in range(len(MOTION))], outcome.motion)
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)


def draw_motion(panels, motion) -> None:
    """Draw the motion of named points over time: size of displacement, velocity and acceleration.

    Args:
        panels: one for each of `MOTION`.
        motion: as an Outcome holds it.
    """
    for axes, (name, unit) in zip(panels, MOTION.items(), strict=True):
        size = np.hypot(motion[f"history_{name}_x"], motion[f"history_{name}_y"])
        for point, values in zip(motion["history_point"], size.T, strict=True):
            axes.plot(motion["motion_time"], values, label=point, linewidth=1.1)
        axes.set_title(f"{name} [{unit}]")
        axes.set_xlabel("time [s]")
    panels[0].legend()


def write_animation(outcome, study, path: Path) -> None:
    """Animate a simulation: plastic strain on the moving points, frame by frame.

    Args:
        outcome: the Outcome of a simulation with frames.
        study: its Study.
        path: GIF file to write.

    Raises:
        ValueError: if the simulation kept no frames.
    """
    from matplotlib.animation import PillowWriter

    from rfmpm.mpm.scene import outline

    if not outcome.frames:
        raise ValueError("the simulation kept no frames: ask for at least one")
    frames, polygon = [(time, _known(points)) for time, points in outcome.frames], outline(study)
    frame = view([polygon[:, 0], *(p["x"] for _, p in frames)], [polygon[:, 1], *(p["y"] for _, p in frames)])
    top = strain_limit(points["plastic_strain"] for _, points in frames)
    with drawing():
        figure = new_figure(WIDTH, panel_height(frame) + 0.35)
        axes = figure.add_subplot()
        title = axes.set_title("t = 0.00 s")
        points = frames[0][1]
        label = "plastic strain [-]"
        cloud = draw_panel(figure, axes, points, points["plastic_strain"], polygon, frame, (0.0, top), label)
        figure.set_layout_engine("none")  # the layout is settled; it must not move from frame to frame
        writer = PillowWriter(fps=FRAMES_PER_SECOND)
        with writer.saving(figure, str(path), dpi=100):
            for time, points in frames:
                title.set_text(f"t = {time:.2f} s")
                cloud.set_offsets(np.column_stack([points["x"], points["y"]]))
                cloud.set_array(points["plastic_strain"])
                writer.grab_frame()


def _title(outcome) -> str:
    distance = words.with_unit(float(outcome.quantities["run_out"]), "m")
    reason = f" ({outcome.reason})" if outcome.reason else ""
    return f"Plastic strain at the end — {NAMES.get(outcome.status, outcome.status)}{reason}, run-out {distance}"


def _known(points) -> dict[str, np.ndarray]:
    """The points whose position is a number; a simulation that diverged has others too."""
    kept = np.isfinite(points["x"]) & np.isfinite(points["y"])
    return {name: np.asarray(values)[kept] for name, values in points.items()}
