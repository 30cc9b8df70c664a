"""Numbers as people read them: rounded to what the interval supports, with units."""

import math
import re


def number(value: float, digits: int = 3) -> str:
    """Write a number with so many significant digits, without exponent where it reads well.

    Args:
        value: any unit; NaN and infinity become words.
        digits: significant digits [-].

    Returns:
        Text such as "7.41", "0.0123", "12 300" or "2.1e-07".
    """
    if math.isnan(value):
        return "unknown"
    if math.isinf(value):
        return "unbounded"
    if value == 0.0:
        return "0"
    rounded = float(f"{value:.{digits}g}")
    magnitude = math.floor(math.log10(abs(rounded)))
    if magnitude < -4 or magnitude > 8:
        return f"{rounded:.{digits - 1}e}"
    return f"{rounded:,.{max(0, digits - 1 - magnitude)}f}".replace(",", "\N{NO-BREAK SPACE}")


def with_unit(value: float, unit: str) -> str:
    """Write a number and its unit, e.g. "7.41 m"; an unknown one without."""
    text = number(value)
    return text if math.isnan(value) or math.isinf(value) else f"{text} {unit}"


def share(value: float, width: float = math.nan) -> str:
    """Write a probability with two digits that count, without rounding it to a certainty.

    Args:
        value: probability [-].
        width: of its interval, to whose second digit it is written; NaN if there is none [-].

    Returns:
        Text such as "0.84", "0.012" or "0.9993", never "1.00".
    """
    if math.isnan(value):
        return number(value)
    if value in (0.0, 1.0):
        return f"{value:g}"
    rounded = f"{value:.{_places(width)}f}" if 0.0 < width < 1.0 else "0"
    if 0.0 < float(rounded) < 1.0:
        return rounded
    if value > 0.99:
        places = 1 - math.floor(math.log10(float(f"{1.0 - value:.2g}")))
        return f"{value:.{places}f}"
    return f"{value:.2f}" if value >= 0.1 else number(value, 2)


def interval(estimate, unit: str = "") -> str:
    """Write the confidence interval of a quantity, to two digits of its width; or that there is none.

    Args:
        estimate: an Estimate.
        unit: appended after the upper bound.

    Returns:
        Text such as "95 % interval 6.9 to 7.9 m".
    """
    if math.isinf(estimate.lower) and math.isinf(estimate.upper):
        return "no interval"
    if estimate.upper == estimate.lower:
        return "all equal, no interval"
    places = _places(estimate.upper - estimate.lower)
    bounds = [number(b) if math.isinf(b) else f"{b:.{places}f}" for b in (estimate.lower, estimate.upper)]
    return f"{_level(estimate)} interval {bounds[0]} to {bounds[1]}{' ' + unit if unit else ''}"


def share_interval(estimate) -> str:
    """Write the confidence interval of a probability, e.g. "95 % interval 0.73 to 0.92"."""
    width = estimate.upper - estimate.lower
    return f"{_level(estimate)} interval {share(estimate.lower, width)} to {share(estimate.upper, width)}"


def supported(value: float, width: float, unit: str = "") -> str:
    """Write a value to the second digit of the width of its interval; a probability if it has no unit.

    Args:
        value: in the unit; a probability if that is empty.
        width: of its interval; where there is none, not finite or 0.
        unit: appended.

    Returns:
        Text such as "10.5 m" or "0.84".
    """
    if not unit:
        return share(value, width)
    if not math.isfinite(value) or not 0.0 < width < math.inf:
        return with_unit(value, unit)
    return f"{value:,.{_places(width)}f} {unit}".replace(",", "\N{NO-BREAK SPACE}")


def _places(width: float) -> int:
    """Decimal places that show two digits of a width."""
    return max(0, 1 - math.floor(math.log10(width))) if 0.0 < width < math.inf else 2


def _level(estimate) -> str:
    return f"{100.0 * estimate.confidence:g} %"


def duration(seconds: float) -> str:
    """Write a time span in the unit that suits it.

    Args:
        seconds: time span [s].

    Returns:
        Text such as "14.2 s", "12.5 min" or "3.1 h".
    """
    if math.isnan(seconds) or seconds < 120.0:
        return with_unit(seconds, "s")
    if seconds < 2.0 * 3600.0:
        return f"{number(seconds / 60.0)} min"
    return f"{number(seconds / 3600.0)} h"


def energy(joules: float) -> str:
    """Write an energy in the unit that suits it, e.g. "0.22 Wh" or "1.5 kWh"."""
    hours = joules / 3600.0
    return f"{number(hours, 2)} Wh" if hours < 1000.0 else f"{number(hours / 1000.0, 2)} kWh"


def kept_together(text: str) -> str:
    """Keep numbers on one line with the unit that follows them."""
    return re.sub(r"(\d) (?=(?:m³/m|kPa|m|%)(?:\W|$))", "\\1\N{NO-BREAK SPACE}", text)


def count(n: int, noun: str) -> str:
    """Write "1 realisation" or "5 realisations"."""
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"
