"""Vectors and tensors of plane strain: scalars at one point, or arrays over all points."""

from typing import NamedTuple


class Vector(NamedTuple):
    """Components along x (right) and y (up)."""

    x: float
    y: float


class Tensor(NamedTuple):
    """Symmetric tensor of plane strain; tension positive."""

    xx: float
    yy: float
    zz: float
    xy: float
