"""How every figure looks, and how it becomes text inside the page."""

import base64
import io
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

# Okabe and Ito's colours, told apart by colour-blind readers too.
BLUE, ORANGE, VERMILION, GREEN, GREY = "#0072B2", "#E69F00", "#D55E00", "#009E73", "#595959"
STRAIN_MAP, STRENGTH_MAP = "viridis", "cividis"
CHART = (4.6, 3.2)  # inches; small, so that its letters are still large on a phone
DOTS_PER_INCH = 130
CHART_DOTS_PER_INCH = 165
LAYOUT_PASSES = 2  # before the one of the writing itself
COLOURS = 256  # in a figure of the page; thousands of smooth-edged points would otherwise make it three times as large

SETTINGS = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9.5,
    "axes.titlesize": 10.5,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": GREY,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "lines.linewidth": 1.8,
    "xtick.color": "#333333",
    "ytick.color": "#333333",
}


@dataclass(frozen=True)
class Picture:
    """A figure ready for the page: its data as text, what it shows for those who cannot see it, and a caption."""

    title: str
    source: str  # data URI
    alt: str
    caption: str


@contextmanager
def drawing() -> Iterator[None]:
    """Apply the look of the report to every figure made inside."""
    import matplotlib

    with matplotlib.rc_context(SETTINGS):
        yield


def new_figure(width: float, height: float):
    """Make an empty figure of so many inches whose parts never overlap, without a window system."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def save(figure, path) -> None:
    """Write a figure of panels of equal aspect; their layout takes several passes to settle, else a title is cut."""
    for _ in range(LAYOUT_PASSES):
        figure.get_layout_engine().execute(figure)
    figure.savefig(path, format="png", dpi=DOTS_PER_INCH)


def encode(figure, dots_per_inch: float = DOTS_PER_INCH) -> str:
    """Turn a figure into a data URI that a page can hold."""
    from PIL import Image

    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dots_per_inch)
    picture = Image.open(buffer).convert("RGB").quantize(COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    buffer = io.BytesIO()
    picture.save(buffer, format="png", optimize=True)
    return "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode("ascii")
