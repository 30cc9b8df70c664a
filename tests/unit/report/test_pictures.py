"""Picture and animation of one realisation; the drawing helpers."""

import numpy as np
import pytest
from PIL import Image
from synthetic import make_outcome, make_study

from rfmpm.mpm.scene import outline
from rfmpm.report import write_animation, write_simulation_picture
from rfmpm.report.simulation_picture import _title
from rfmpm.report.slope_figures import draw_panel, strain_limit, view
from rfmpm.report.style import drawing, new_figure


@pytest.fixture(scope="module")
def study():
    return make_study()


def size_of(path):
    with Image.open(path) as image:
        image.load()
        return image.size


def test_a_random_cohesion_gets_a_panel_of_its_own(tmp_path, study):
    outcome = make_outcome(study)
    write_simulation_picture(outcome, study, tmp_path / "two.png")
    outcome.points["cohesion"] = np.full(outcome.points["x"].size, 20e3)
    write_simulation_picture(outcome, study, tmp_path / "one.png")
    assert size_of(tmp_path / "two.png")[1] == pytest.approx(2 * size_of(tmp_path / "one.png")[1], abs=2)  # pixels


def test_a_diverged_outcome_can_be_pictured(tmp_path, study):
    outcome = make_outcome(study, run_out=np.nan, status="diverged", reason="energy grew")
    for name in ("x", "y", "plastic_strain"):
        outcome.points[name] = np.full_like(outcome.points["x"], np.nan)
    write_simulation_picture(outcome, study, tmp_path / "diverged.png")
    assert size_of(tmp_path / "diverged.png")[0] > 500
    assert _title(outcome) == "Plastic strain at the end — diverged (energy grew), run-out unknown"


def test_animation_has_every_frame_and_a_simulation_without_frames_is_an_error(tmp_path, study):
    write_animation(make_outcome(study, frames=4), study, tmp_path / "slide.gif")
    with Image.open(tmp_path / "slide.gif") as image:
        assert image.n_frames == 4
    with pytest.raises(ValueError, match="no frames"):
        write_animation(make_outcome(study), study, tmp_path / "none.gif")


def test_colours_end_at_a_high_percentile_of_the_yielded_points():
    assert strain_limit([np.zeros(10), np.array([np.nan])]) == 1.0
    strain = np.concatenate([np.zeros(1000), np.linspace(0.01, 1.0, 100), [50.0]])
    assert 0.75 < strain_limit([strain]) <= 0.85  # 80 % of the yielded points


def test_markers_fill_the_body_and_points_beyond_the_colours_are_announced(study):
    points = make_outcome(study).points
    polygon = outline(study)
    frame = view([polygon[:, 0]], [polygon[:, 1]])
    with drawing():
        figure = new_figure(8.6, 4.0)
        axes = figure.add_subplot()
        cloud = draw_panel(figure, axes, points, points["plastic_strain"], polygon, frame, (0.0, 1.0), "strain [-]")
    metre = np.diff(axes.transData.transform([(0.0, 0.0), (1.0, 0.0)])[:, 0])[0] * 72.0 / figure.dpi
    spacing = 0.125  # of the made-up points
    # Touching diagonally needs a diameter of sqrt(2) spacings; 5 % for the ragged edge of the slope face.
    assert np.sqrt(cloud.get_sizes()[0]) / metre == pytest.approx(1.45 * spacing, rel=0.05)
    assert cloud.colorbar.extend == "max"
    bar, panel = cloud.colorbar.ax.get_window_extent(), axes.get_window_extent()
    assert panel.y0 - 1.0 <= bar.y0 < bar.y1 <= panel.y1 + 1.0  # pixels
