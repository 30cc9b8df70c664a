"""Names beside markers, where they cover neither each other nor a marker."""

from collections.abc import Sequence

SIDES = (  # of a marker, the liked ones first: shift in points, and which end of the name lies there
    ((5, 4), "left", "bottom"),
    ((5, -4), "left", "top"),
    ((-5, 4), "right", "bottom"),
    ((-5, -4), "right", "top"),
    ((0, 7), "center", "bottom"),
    ((0, -7), "center", "top"),
)
FARTHER = (1.0, 2.5, 4.0)  # times the shift, where nothing closer is free
MARKER = 7.0  # size of a marker [points]
AROUND = 2.0  # kept free around a name [pixels]


def place_names(axes, places: Sequence[tuple[float, float]], names: Sequence[str], **look) -> list:
    """Write a name beside each marker.

    Args:
        axes: with their final limits, layout and resolution.
        places: of the markers, in data.
        names: one each.
        look: of the texts, as matplotlib names it.

    Returns:
        the texts; each on the first side on which it is free and inside the axes, or on the last one tried.
    """
    from matplotlib.transforms import Bbox

    renderer, half = axes.figure.canvas.get_renderer(), 0.5 * MARKER * axes.figure.dpi / 72.0
    middles = axes.transData.transform(places)
    taken = [Bbox.from_extents(*(middle - half), *(middle + half)) for middle in middles]
    texts = []
    for place, name in zip(places, names, strict=True):
        text = axes.annotate(name, place, xytext=(0, 0), textcoords="offset points", **look)
        for farther, (shift, horizontal, vertical) in ((f, side) for f in FARTHER for side in SIDES):
            text.xyann = (farther * shift[0], farther * shift[1])
            text.set(ha=horizontal, va=vertical)
            box = text.get_window_extent(renderer).padded(AROUND)
            inside = axes.bbox.containsx(box.x0) and axes.bbox.containsx(box.x1) and axes.bbox.containsy(box.y1)
            if inside and axes.bbox.containsy(box.y0) and not box.count_overlaps(taken):
                break
        taken.append(box)
        texts.append(text)
    return texts
