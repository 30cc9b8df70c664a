"""Shape functions by name."""

from rfmpm.mpm.shapes.linear import Linear
from rfmpm.mpm.shapes.quadratic_bspline import QuadraticBSpline

SHAPES = {"linear": Linear, "quadratic_bspline": QuadraticBSpline}
