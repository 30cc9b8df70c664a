"""Every listed quantity: defined in the table of variables, and a finite value of that kind, failure or not."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from rfmpm.quantities import QUANTITIES, FinalState
from rfmpm.variables import VARIABLES

KINDS = {"float64": float, "int8": int, "int32": int}
every_quantity = pytest.mark.parametrize("name", QUANTITIES)


def standing() -> FinalState:
    """Four rows of ten points, none of which has moved."""
    x, y = (places.ravel() for places in np.meshgrid(np.arange(0.25, 5.0, 0.5), np.arange(0.25, 2.0, 0.5)))
    quarter = np.full(len(x), 0.25)
    return FinalState(
        x, y, x, y, quarter, quarter, np.zeros(len(x)),
        cell=1.0, spacing=0.5, toe=5.0, crest_edge=4.0, crest_height=2.0, length=20.0, displacement_threshold=0.5,
        front_quantile=0.995, block_plastic_strain=0.2, block_minimum_area=0.5, surface_bin=0.5,
    )  # fmt: skip


def slid() -> FinalState:
    """The right half has slid 3 m, sheared at its base; one point flew on alone to the far wall."""
    still = standing()
    x = still.x + 3.0 * (still.x > 2.5)
    x[-1] = 19.9
    return replace(still, x=x, plastic_strain=np.where(still.y < 0.5, 0.5, 0.0))


def fallen() -> FinalState:
    """Everything has failed."""
    return replace(standing(), x=standing().x + 15.0)


@every_quantity
def test_is_defined_in_the_table_of_variables(name):
    variable = VARIABLES[name]
    study = SimpleNamespace(output=SimpleNamespace(surface_bin_m=0.5))
    assert variable.is_active(study)
    assert variable.dims[0] == "realisation"
    assert variable.attributes["comment"]


@pytest.mark.parametrize("make", [standing, slid, fallen])
@every_quantity
def test_is_finite_and_of_its_kind(name, make):
    variable, state = VARIABLES[name], make()
    value = QUANTITIES[name](state)
    if variable.dims == ("realisation", "x"):
        assert value.dtype == variable.dtype
        assert value.shape == (40,)
    else:
        assert type(value) is KINDS[variable.dtype]
    assert np.all(np.isfinite(value))
    assert np.all(value >= 0)
    if "flag_values" in variable.attributes:
        assert value in variable.attributes["flag_values"]


@every_quantity
def test_does_not_change_the_state(name):
    state, before = slid(), slid()
    QUANTITIES[name](state)
    for field in ("x", "y", "x_initial", "y_initial", "volume", "volume_initial", "plastic_strain"):
        np.testing.assert_array_equal(getattr(state, field), getattr(before, field))


def test_the_states_differ_in_every_quantity():
    # Otherwise the tests above would look at one case only.
    for name in QUANTITIES:
        assert any(np.any(QUANTITIES[name](make()) != QUANTITIES[name](standing())) for make in (slid, fallen)), name
