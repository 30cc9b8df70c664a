"""A toy slope: 2 m high, 4 m of crest, 1:1 down to the toe at 6 m, in a domain of 20 m with cells of 1 m."""

import numpy as np
import pytest

from rfmpm.quantities import FinalState

POINT_VOLUME = 0.25  # [m3/m]; four points to a cell
TOY = {
    "cell": 1.0,
    "spacing": 0.5,
    "toe": 6.0,
    "crest_edge": 4.0,
    "crest_height": 2.0,
    "length": 20.0,
    "displacement_threshold": 0.5,
    "front_quantile": 1.0,
    "block_plastic_strain": 0.2,
    "block_minimum_area": 0.5,
    "surface_bin": 1.0,
}


def toy_state(before, after, volume=POINT_VOLUME, volume_initial=POINT_VOLUME, plastic_strain=0.0, **changes):
    """State of points that were at `before` and are at `after`, lists of (x, y) [m]; volumes and strains broadcast."""
    before, after = (np.array(places, dtype=float).reshape(-1, 2) for places in (before, after))
    per_point = {"volume": volume, "volume_initial": volume_initial, "plastic_strain": plastic_strain}
    return FinalState(
        x=after[:, 0],
        y=after[:, 1],
        x_initial=before[:, 0],
        y_initial=before[:, 1],
        **{name: np.zeros(len(after)) + values for name, values in per_point.items()},
        **TOY | changes,
    )


def toy_came_to(*places, **options):
    """State of failed points that lie at these places; all started at (2, 1), and none came back to there."""
    return toy_state([(2.0, 1.0)] * len(places), places, **options)


def toy_body(after=lambda x, y: (x, y), **options):
    """State of a body of 40 points, filled as the engine does it (whole squares only), moved by `after(x, y)`."""
    rows = [(y, 4.0 + 2.0 - y - 0.25) for y in (0.25, 0.75, 1.25, 1.75)]
    before = [(x, y) for y, end in rows for x in np.arange(0.25, end, 0.5)]
    return toy_state(before, [after(x, y) for x, y in before], **options)


@pytest.fixture
def state():
    return toy_state


@pytest.fixture
def came_to():
    return toy_came_to


@pytest.fixture
def body():
    return toy_body
