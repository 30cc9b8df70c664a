"""The cases: points, correlation, and what was asked of the ratio to a peer."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rfmpm.random_fields.correlation import CORRELATIONS, Anisotropy

SPACING = 0.125  # [m]


@dataclass(frozen=True)
class Case:
    """A set of points and a correlation with scales of 6 m and 0.5 m.

    Attributes:
        name: of the case, and heading of its section.
        correlation: name in `CORRELATIONS`.
        columns, rows: of the lattice 0.125 m wide; scattered points are as many, in the same rectangle.
        is_scattered: whether the points are uniformly scattered.
        methods: method names, with the options of their `prepare`.
        targets: CPU time of the peer over ours, asked; under "ms" our time, asked [ms].
    """

    name: str
    correlation: str
    columns: int
    rows: int
    methods: tuple[tuple[str, dict], ...]
    targets: dict[str, float]
    is_scattered: bool = False
    spacing: float = SPACING
    theta_h: float = 6.0
    theta_v: float = 0.5

    @property
    def kernel(self) -> Anisotropy:
        """The correlation."""
        return CORRELATIONS[self.correlation](self.theta_h, self.theta_v)

    @cached_property
    def points(self) -> np.ndarray:
        """Positions, shape (n, 2) [m]."""
        if self.is_scattered:
            size = self.columns * self.spacing, self.rows * self.spacing
            return np.random.default_rng(1).uniform((0.0, 0.0), size, (self.columns * self.rows, 2))
        x, y = np.meshgrid(self.spacing * np.arange(self.columns), self.spacing * np.arange(self.rows))
        return np.column_stack([x.ravel(), y.ravel()])


DEFAULT, EXACT = ("circulant", {}), ("circulant", {"accuracy": 1e-10})
LAS = ("local_average_subdivision", {}), ("local_average_subdivision", {"is_stretched": False})
SERIES = tuple(("nufft", {"most_terms": 2**k}) for k in (20, 22))
CASES = (
    Case(
        "ellipsoidal, 4 800 points", "markov_ellipsoidal", 120, 40,
        (DEFAULT, EXACT, ("cholesky", {}), *LAS), {"gstools": 1000.0, "geone": 3.0},
    ),
    Case(
        "ellipsoidal, 400 000 points", "markov_ellipsoidal", 1000, 400, (DEFAULT, EXACT),
        {"gstools": 1500.0, "gaussianfft": 5.0},
    ),
    Case("ellipsoidal, 4 000 000 points", "markov_ellipsoidal", 4000, 1000, (DEFAULT, EXACT), {"ms": 60.0}),
    Case("separable, 4 000 000 points", "markov_separable", 4000, 1000, (("ar1", {}), DEFAULT), {"ms": 30.0}),
    Case(
        "scattered, 19 000 points", "markov_ellipsoidal", 190, 100, SERIES, {"gstools": 400.0}, is_scattered=True
    ),
)  # fmt: skip
QUICK_CASES = (
    Case("ellipsoidal, 600 points", "markov_ellipsoidal", 40, 15, (DEFAULT, ("cholesky", {})), {"geone": 3.0}),
    Case("separable, 600 points", "markov_separable", 40, 15, (("ar1", {}),), {"ms": 30.0}),
)
