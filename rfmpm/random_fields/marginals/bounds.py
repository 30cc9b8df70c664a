"""What the distributions between two bounds share: the bounds, and the spread that fits between them."""

from math import inf

from rfmpm.random_fields.marginals.protocol import check_moments


def relative_moments(
    mean: float, coefficient_of_variation: float, lower_over_mean: float, upper_over_mean: float
) -> tuple[float, float]:
    """Place of the mean between the bounds, and the variance over the largest one that a mean there allows.

    Args:
        mean: greater than 0 [unit of the field].
        coefficient_of_variation: greater than 0 [-].
        lower_over_mean: lower bound over the mean, at least 0 and below 1 [-].
        upper_over_mean: upper bound over the mean, above 1 [-].

    Returns:
        (mean - lower) / (upper - lower), and variance / ((mean - lower) (upper - mean)), both between 0 and 1 [-].

    Raises:
        ValueError: bounds out of range; a spread that no variable between these bounds has.
    """
    check_moments(mean, coefficient_of_variation)
    if not 0.0 <= lower_over_mean < 1.0:
        raise ValueError(f"lower_over_mean = {lower_over_mean}: must be at least 0 and less than 1")
    if not 1.0 < upper_over_mean < inf:
        raise ValueError(f"upper_over_mean = {upper_over_mean}: must be greater than 1 and finite")
    return (
        (1.0 - lower_over_mean) / (upper_over_mean - lower_over_mean),
        coefficient_of_variation**2 / ((1.0 - lower_over_mean) * (upper_over_mean - 1.0)),
    )


def check_spread(share: float, highest: float, coefficient_of_variation: float) -> None:
    """Refuse a share of the largest variance of `highest` or more, with the coefficient of variation that fits."""
    if share >= highest:
        fits = coefficient_of_variation * (highest / share) ** 0.5
        raise ValueError(
            f"coefficient_of_variation = {coefficient_of_variation:g}: must be less than {fits:.4g} between these "
            "bounds, or take a lower lower_over_mean or a higher upper_over_mean"
        )
