"""Soundings: values of a variable down one vertical line, read from a text file of columns or a GEF file."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from rfmpm.columns import ColumnsError, read_columns

HEADERS = {"depth": ("depth_m", "depth"), "value": ("value", "value_kpa", "value_deg")}
FEWEST = 10  # values; below that no scale of fluctuation is told from another
MOST = 2000  # values: the likelihood factors their covariance some forty times


class Sounding(NamedTuple):
    """Values, shape (n,), at increasing depths, shape (n,) [m, positive downwards]."""

    depth: np.ndarray
    value: np.ndarray


def read_sounding(path: Path, factor: float = 1.0) -> Sounding:
    """Read a sounding.

    Args:
        path: a file of columns with the headers depth_m (or depth) and value (or value_kpa), or a GEF file of a cone
            penetration test, of which the cone resistance is read, in kPa; lines without one are left out.
        factor: value of the variable per value of the file, such as one over a cone factor.

    Returns:
        the sounding, by increasing depth.

    Raises:
        ColumnsError: what is wrong with the file, by line.
        ModuleNotFoundError: a GEF file, and no reader for it is installed.
        OSError: the file cannot be read.
    """
    path = Path(path)
    if path.suffix.lower() == ".gef":
        depth, value = _read_gef(path)
        labels = [f"depth {d:g} m" for d in depth]
    else:
        columns = read_columns(path, HEADERS)
        depth, value = np.array(columns["depth"]), np.array(columns["value"])
        labels = [f"line {line}" for line in columns.lines]
    order = np.argsort(depth, kind="stable")
    depth, value, labels = depth[order], value[order] * factor, [labels[k] for k in order]
    problems = [
        f"{label}: value {v:g}: must be greater than 0" for label, v in zip(labels, value, strict=True) if v <= 0
    ]
    problems += [
        f"{labels[k]} and {labels[k + 1]}: both at a depth of {depth[k]:g} m; keep one, or their mean"
        for k in np.flatnonzero(np.diff(depth) <= 0.0)
    ]
    if len(depth) < FEWEST:
        problems.append(f"holds {len(depth)} values: must be at least {FEWEST}")
    if len(depth) > MOST:
        problems.append(f"holds {len(depth)} values: must be at most {MOST}; take one in {-(-len(depth) // MOST)}")
    if len(depth) and np.ptp(value) <= 1e-9 * np.abs(value).max():
        problems.append("holds one and the same value at all depths: nothing varies")
    if problems:
        raise ColumnsError(path, problems[:FEWEST])
    return Sounding(depth, value)


def _read_gef(path: Path) -> tuple[np.ndarray, np.ndarray]:
    path.open("rb").close()  # a missing file in the words of the system, whichever reader there is
    try:
        import pygef
    except ModuleNotFoundError:
        raise ModuleNotFoundError(
            f"{path}: reading GEF files needs pygef: pip install 'rfmpm[gef]', or write the columns depth_m and value "
            "to a CSV file"
        ) from None
    table = pygef.read_cpt(path).data
    depth = table["depth" if "depth" in table.columns else "penetrationLength"].to_numpy()
    resistance = table["coneResistance"].to_numpy()
    is_kept = np.isfinite(depth) & np.isfinite(resistance) & (resistance > 0.0)
    return depth[is_kept], resistance[is_kept] * 1000.0  # MPa
