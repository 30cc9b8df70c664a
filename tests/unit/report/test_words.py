"""Numbers in words."""

from math import inf, nan

import pytest

from rfmpm.estimators import Estimate
from rfmpm.report import words


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (7.4149, "7.41"),
        (0.0, "0"),
        (-0.01234, "-0.0123"),
        (99.96, "100"),
        (9.996, "10.0"),
        (12345.0, "12\N{NO-BREAK SPACE}300"),
        (2.1e-7, "2.10e-07"),
        (nan, "unknown"),
        (inf, "unbounded"),
    ],
)
def test_number(value, text):
    assert words.number(value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.8437, "0.84"), (0.0123, "0.012"), (0.999, "0.9990"), (0.99996, "0.999960"), (1.0, "1"), (0.0, "0")],
)
def test_share_never_rounds_to_a_certainty(value, text):
    assert words.share(value) == text


def estimate(value, lower, upper, confidence=0.95):
    return Estimate(value, lower, upper, confidence, 10, "")


def test_interval_shows_two_digits_of_its_width():
    assert words.interval(estimate(7.4, 6.912, 7.876), "m") == "95 % interval 6.91 to 7.88 m"
    assert words.interval(estimate(7.4, 6.412, 8.476), "m") == "95 % interval 6.4 to 8.5 m"
    assert words.interval(estimate(100.0, 41.2, 180.1, 0.9)) == "90 % interval 41 to 180"
    assert words.interval(estimate(1.0, -inf, inf)) == "no interval"
    assert words.interval(estimate(1.0, 0.5, inf)) == "95 % interval 0.50 to unbounded"
    assert words.interval(estimate(0.0, 0.0, 0.0)) == "all equal, no interval"


def test_share_interval():
    assert words.share_interval(estimate(0.0, 0.0, 0.0573)) == "95 % interval 0 to 0.057"


@pytest.mark.parametrize(
    ("seconds", "text"), [(14.23, "14.2 s"), (750.0, "12.5 min"), (11160.0, "3.10 h"), (nan, "unknown")]
)
def test_duration(seconds, text):
    assert words.duration(seconds) == text


def test_count():
    assert (words.count(1, "realisation"), words.count(2, "realisation")) == ("1 realisation", "2 realisations")
