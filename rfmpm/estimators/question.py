"""What a study asks of its ensemble, and the functions of a quantity whose expectations answer it."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from rfmpm.estimators.rows import Rows

KINDS = ("mean", "exceedance", "quantile")


class Functions(Protocol):
    """k functions of a simulation's outcome; their expectations are wanted."""

    is_probability: bool  # whether every function is 0 or 1

    def __call__(self, rows: Rows) -> np.ndarray:
        """Evaluate them for every row: shape (n, k), NaN where the row failed."""
        ...


@dataclass(frozen=True)
class Value:
    """The quantity itself: its expectation is the mean. A censored one is taken at its value, a lower bound."""

    is_probability = False

    def __call__(self, rows: Rows) -> np.ndarray:
        """Return the quantity, shape (n, 1); NaN where the row failed."""
        return rows.value[:, None]


@dataclass(frozen=True)
class Exceedances:
    """Whether the quantity exceeds each of k limits: the expectations are probabilities. Censored ones exceed all."""

    limits: np.ndarray  # shape (k,), unit of the quantity
    is_probability = True

    def __call__(self, rows: Rows) -> np.ndarray:
        """Return 1 where it exceeds the limit, 0 where not, shape (n, k); NaN where the row failed."""
        exceeds = (rows.value[:, None] > np.atleast_1d(self.limits)) | rows.is_censored[:, None]
        return np.where(rows.is_failed[:, None], np.nan, exceeds.astype(float))


@dataclass(frozen=True)
class Question:
    """A mean, a probability of exceeding a limit or a quantile of one quantity, and how well it is to be known.

    Attributes:
        quantity: name of the variable, e.g. "run_out".
        kind: "mean", "exceedance" or "quantile".
        limit: of an exceedance, unit of the quantity.
        probability: of a quantile, between 0 and 1 [-].
        half_width: of the confidence interval that is wanted; unit of the quantity, or [-] for a probability; None
            where a fixed number of realisations is run instead.
        relative_half_width: the same as a share of the estimate [-].
        at_most: realisations on the study's own cells after which the campaign ends unanswered; None: no end.
        confidence: of the interval [-].
    """

    quantity: str
    kind: str = "mean"
    limit: float | None = None
    probability: float | None = None
    half_width: float | None = None
    relative_half_width: float | None = None
    at_most: int | None = None
    confidence: float = 0.95

    def __post_init__(self):
        """Refuse a question that cannot be asked; raises ValueError."""
        if self.kind not in KINDS:
            raise ValueError(f"kind of question = {self.kind}: allowed are {', '.join(KINDS)}")
        if self.kind == "exceedance" and self.limit is None:
            raise ValueError("a probability of exceeding needs the limit that is exceeded")
        if self.kind == "quantile" and not (self.probability is not None and 0.0 < self.probability < 1.0):
            raise ValueError(f"probability of the quantile = {self.probability}: it has to lie between 0 and 1")
        if not 0.0 < self.confidence < 1.0:
            raise ValueError(f"confidence = {self.confidence}: it has to lie between 0 and 1")
        for name in ("half_width", "relative_half_width", "at_most"):
            given = getattr(self, name)
            if given is not None and not given > 0:
                raise ValueError(f"{name} = {given}: it has to be greater than 0")

    @property
    def is_open_ended(self) -> bool:
        """Whether a width is wanted, so that the number of realisations follows from what they give."""
        return self.half_width is not None or self.relative_half_width is not None

    def wanted_half_width(self, value: float) -> float:
        """Return the half width at which the question is answered, given the estimate; infinite if none is wanted."""
        wanted = np.inf if self.half_width is None else self.half_width
        if self.relative_half_width is not None:
            wanted = min(wanted, 0.0 if np.isnan(value) else self.relative_half_width * abs(value))
        return float(wanted)

    def excess(self, estimate) -> float:
        """Return the half width of an estimate over the one that is wanted [-]; 1 or less: the question is answered."""
        half = 0.5 * (estimate.upper - estimate.lower)
        wanted = self.wanted_half_width(estimate.value)
        if np.isinf(wanted):
            return 0.0
        return half / wanted if wanted > 0.0 else np.inf
