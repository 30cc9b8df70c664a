"""The kind of failure, told from the quantities of a realisation."""

import numpy as np

from rfmpm.quantities.failure_mode import MODES, UNKNOWN, failure_modes


def mode(volume, first, blocks, censored=False):
    """Name of the mode of one realisation."""
    (code,) = failure_modes([volume], [first], [blocks], [censored])
    return None if code == UNKNOWN else MODES[code]


def test_each_mode_by_its_definition():
    assert mode(0.0, 0.0, 0) == "no_failure"
    assert mode(30.0, 30.0, 1) == "single_slide"
    assert mode(33.0, 30.0, 1) == "single_slide"  # a tenth more is not yet a second slide
    assert mode(33.1, 30.0, 1) == "retrogressive"
    assert mode(30.0, 30.0, 2) == "retrogressive"
    assert mode(np.nan, np.nan, np.nan) is None


def test_the_edge_of_the_model_counts_before_everything_else():
    assert mode(50.0, 30.0, 3, censored=True) == "reaches_boundary"
    assert mode(np.nan, np.nan, np.nan, censored=True) is None
