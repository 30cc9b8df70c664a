"""The short slope of Vardon, Wang and Hicks (2017), 15th IACMAG: which failure comes out of which softening.

The paper shows fields and says in words what they are; the words are compared here, on 0.5 m cells with the softening
modulus scaled to them. No tolerance: an order or a kind comes out or it does not.
"""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from rfmpm.benchmark.papers.short_slope import CELL, MODULUS, RESIDUAL, run
from rfmpm.benchmark.papers.short_slope_five_runs import ridge_count, scarp_angle
from rfmpm.failure_modes import MODES

CREST, HEIGHT, VOLUME = 10.0, 5.0, 62.5  # [m], [m], [m3/m]
RESIDUALS = (12.0, 8.0, 4.0)  # [kPa]
MODULI = (25.0, 50.0, 75.0)  # [kPa]
FIRST_SLIDE = 2.5  # [s]: its band is complete by then


@cache
def slope(residual=4.0, modulus=50.0, cell=0.5, end=40.5):
    return run({CELL: cell, RESIDUAL: residual, MODULUS: modulus, "time.end_s": end})


def outcome(residual=4.0, modulus=50.0):
    return slope(residual, modulus).outcome


def over_residuals(name):
    return [outcome(residual).quantities[name] for residual in RESIDUALS]


def boundary_reached(history):
    """Time at which the failure has got to the boundary behind the crest [s]; infinite where it does not."""
    reached = history["crest"] < 0.5
    return history["time"][np.argmax(reached)] if reached.any() else np.inf


@pytest.mark.parametrize("residual", RESIDUALS)
def test_every_run_has_a_complete_shear_band_and_ends_at_rest_or_nearly(residual):
    assert slope(residual).cuts[0].time < FIRST_SLIDE
    energy = outcome(residual).history["kinetic_energy"]
    assert energy[-1] < 0.01 * energy.max()


@pytest.mark.parametrize("name", ["run_out", "failure_volume", "retrogression_distance", "influence_distance"])
def test_lower_residual_fails_further_in_every_measure(name):
    for stiffer, softer in pairwise(over_residuals(name)):
        assert softer > 1.1 * stiffer  # more than the run-out scatters with the time step


def test_residual_12_slumps_a_little_behind_one_band():
    found = outcome(12.0).quantities
    assert len(slope(12.0).cuts) == 1
    assert found["block_count"] == 1
    assert found["run_out"] < 0.6 * HEIGHT
    assert found["retrogression_distance"] < 0.5 * CREST
    assert found["failure_volume"] < 0.5 * VOLUME


def test_residual_8_fails_at_the_back_after_its_slip_circle_but_not_to_the_boundary():
    first, *behind = slope(8.0).cuts
    found = outcome(8.0).quantities
    # The circle cuts the crest as with 12 kPa, less than half way back; what follows is behind it, and not at once.
    assert 0.35 * CREST < first.distance < 0.5 * CREST
    assert all(cut.time > first.time + 1.0 for cut in behind)
    assert not found["retrogression_censored"]
    assert found["failure_volume"] < 0.7 * VOLUME


def test_residual_4_retrogresses_until_the_boundary_stops_it_and_leaves_at_least_three_blocks():
    found = outcome(4.0).quantities
    assert found["retrogression_censored"]
    assert found["block_count"] >= 3
    assert [bool(value) for value in over_residuals("retrogression_censored")] == [False, False, True]


def test_kinds_of_failure_by_residual():
    kinds = [MODES[run.quantities["failure_mode"]] for run in map(outcome, RESIDUALS)]
    assert kinds[0] == "rotational"
    # The paper has one circle and small failures at the back scarp; here the second slide is as large as the first.
    assert kinds[1] == "retrogressive"
    assert kinds[2] in ("retrogressive", "spread")  # ten cells over the height hardly resolve horsts


def test_retrogression_grows_with_the_softening_modulus():
    runs = [outcome(modulus=modulus) for modulus in MODULI]
    # At the end; 50 and 75 kPa are both stopped by the boundary, so only the time to it goes on.
    distances = [run.quantities["retrogression_distance"] for run in runs]
    assert distances[0] < 0.6 * distances[1]
    assert distances[1] <= distances[2]
    assert [bool(run.quantities["retrogression_censored"]) for run in runs] == [False, True, True]
    volumes = [run.quantities["failure_volume"] for run in runs]
    assert volumes[0] < 0.6 * volumes[1]
    assert volumes[0] < 0.6 * volumes[2]
    times = [boundary_reached(run.history) for run in runs]
    assert times[2] < 0.9 * times[1] < times[0]
    run_outs = [run.quantities["run_out"] for run in runs]
    assert run_outs[0] < run_outs[1] < run_outs[2]


def test_face_behind_the_first_slide_is_steeper_than_the_slope_was_and_fails_in_its_turn():
    assert scarp_angle(slope()) > 45.0
    assert len(slope().cuts) > 1


@pytest.mark.parametrize("modulus", MODULI)
def test_what_slid_has_horsts_and_grabens_with_every_modulus(modulus):
    assert ridge_count(slope(modulus=modulus)) >= 2


@pytest.mark.slow
def test_first_band_reaches_the_surface_at_about_one_and_a_half_seconds():
    # The paper tells its times to half a second; found 1.4 s.
    assert slope(cell=0.25, end=3.0).cuts[0].time == pytest.approx(1.5, abs=0.25)
