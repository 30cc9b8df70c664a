"""Names in figures cover neither each other nor the markers."""

from itertools import combinations

import numpy as np
import pytest

from rfmpm.benchmark.fields.labels import place_names
from rfmpm.report.style import new_figure

CROWDED = [(1.0, 1.0), (1.2, 1.0), (1.4, 1.05), (1.6, 0.95), (5.0, 1.0), (9.9, 9.9), (0.1, 5.0)]


def axes_of(places):
    figure = new_figure(6.0, 4.0)
    axes = figure.add_subplot()
    axes.plot(*np.transpose(places), "o", ms=7)
    axes.set(xlim=(0, 10), ylim=(0, 10))
    figure.draw_without_rendering()
    return axes


@pytest.mark.parametrize("places", [CROWDED, [(4.0, 4.0)] * 3])
def test_no_name_covers_another_one_or_a_marker_or_leaves_the_axes(places):
    axes = axes_of(places)
    texts = place_names(axes, places, [f"method {k}" for k in range(len(places))], fontsize=7.5)
    boxes = [text.get_window_extent() for text in texts]
    assert not any(a.overlaps(b) for a, b in combinations(boxes, 2))
    for x, y in axes.transData.transform(places):
        assert not any(box.contains(x, y) for box in boxes)
    assert all(axes.bbox.containsx(end) for box in boxes for end in (box.x0, box.x1))


def test_a_lone_name_stands_above_to_the_right():
    axes = axes_of([(5.0, 5.0)])
    (text,) = place_names(axes, [(5.0, 5.0)], ["alone"], fontsize=8)
    x, y = axes.transData.transform((5.0, 5.0))
    box = text.get_window_extent()
    assert (box.x0 > x, box.y0 > y) == (True, True)
