"""[[uncertain]]: a number of the study that is not known exactly, with one value for all of a realisation."""

from math import exp, log1p, sqrt
from typing import Annotated, Literal

from pydantic import Field

from rfmpm.study.kinds import Number, Table, Text


class Uncertain(Table):
    """[[uncertain]]"""

    key: Text = Field(description="Dotted path of the number, lists by position, such as material.0.cohesion_kpa")
    distribution: Literal["lognormal", "normal_truncated", "uniform"] = Field(
        description="Its distribution; normal_truncated: a normal kept where it is positive, with this mean and spread"
    )
    mean: Number | None = Field(None, description="Mean [unit of the key]")
    coefficient_of_variation: Annotated[Number, Field(gt=0, le=2)] | None = Field(
        None, description="Standard deviation over mean [1]"
    )
    low: Number | None = Field(None, description="Lowest value of a uniform distribution [unit of the key]")
    high: Number | None = Field(None, description="Highest value of a uniform distribution [unit of the key]")

    @property
    def limits(self) -> tuple[float, float]:
        """Lowest and highest value of a uniform distribution, however it is given [unit of the key]."""
        return uniform_limits(self.mean, self.coefficient_of_variation, self.low, self.high)


def uniform_limits(
    mean: float | None, variation: float | None, low: float | None, high: float | None
) -> tuple[float, float]:
    """Lowest and highest value of a uniform distribution, from these or from its mean and coefficient of variation."""
    if low is not None and high is not None:
        return low, high
    return mean * (1.0 - sqrt(3.0) * variation), mean * (1.0 + sqrt(3.0) * variation)


def value_at(distribution: str, mean: float, variation: float, deviations: float) -> float:
    """Value so many standard deviations from the middle, of the normal below it [unit of the mean].

    For normal_truncated that of the normal that is not truncated: a little lower than its own where it varies much.
    """
    if distribution == "lognormal":
        log_variance = log1p(variation**2)
        return mean * exp(deviations * sqrt(log_variance) - 0.5 * log_variance)
    return max(0.0, mean * (1.0 + deviations * variation))
