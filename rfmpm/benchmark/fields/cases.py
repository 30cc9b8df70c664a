"""The cases: points, correlation, and what was asked of the ratio to a peer."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rfmpm.random_fields.correlation import CORRELATIONS, Anisotropy
from rfmpm.random_fields.measurements import StandardNormalData

SPACING = 0.125  # [m]


@dataclass(frozen=True)
class Case:
    """A set of points and a correlation with scales of 6 m and 0.5 m.

    Attributes:
        name: of the case, and heading of its section.
        correlation: name in `CORRELATIONS`.
        columns, rows: of the lattice 0.125 m wide; scattered points are as many, in the same rectangle.
        is_scattered: whether the points are uniformly scattered.
        data_count: exact data, scattered between the points, that realisations are conditioned on; 0 for none.
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
    data_count: int = 0
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
            return self._scattered(self.columns * self.rows)
        x, y = np.meshgrid(self.spacing * np.arange(self.columns), self.spacing * np.arange(self.rows))
        return np.column_stack([x.ravel(), y.ravel()])

    @cached_property
    def data(self) -> StandardNormalData:
        """The data, of standard-normal values."""
        values = np.random.default_rng(2).standard_normal(self.data_count)
        return StandardNormalData(self._scattered(self.data_count), values, np.zeros(self.data_count))

    def _scattered(self, count: int) -> np.ndarray:
        size = self.columns * self.spacing, self.rows * self.spacing
        return np.random.default_rng(1).uniform((0.0, 0.0), size, (count, 2))


DEFAULT, EXACT = ("circulant", {}), ("circulant", {"accuracy": 1e-10})
LAS = ("local_average_subdivision", {}), ("local_average_subdivision", {"is_stretched": False})
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
        "conditional on 50 data, 4 800 points", "markov_ellipsoidal", 120, 40, (DEFAULT,), {"gstools": 150.0},
        data_count=50,
    ),
    Case(
        "scattered, 19 000 points", "markov_ellipsoidal", 190, 100, (("local_kriging", {}),), {"gstools": 400.0},
        is_scattered=True,
    ),
)  # fmt: skip
QUICK_CASES = (
    Case("ellipsoidal, 600 points", "markov_ellipsoidal", 40, 15, (DEFAULT, ("cholesky", {})), {"geone": 3.0}),
    Case(
        "conditional on 8 data, 600 points", "markov_ellipsoidal", 40, 15, (DEFAULT,), {"gstools": 150.0}, data_count=8
    ),
    Case("separable, 600 points", "markov_separable", 40, 15, (("ar1", {}),), {"ms": 30.0}),
)
