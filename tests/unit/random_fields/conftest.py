from types import SimpleNamespace

import numpy as np
import pytest

from rfmpm.random_fields.measurements import Measurements


@pytest.fixture
def settings() -> SimpleNamespace:
    return SimpleNamespace(
        distribution="lognormal",
        coefficient_of_variation=0.25,
        correlation="markov_ellipsoidal",
        scale_of_fluctuation_h_m=6.0,
        scale_of_fluctuation_v_m=1.0,
        rotation_deg=0.0,
        method="cholesky",
        averaging="point",
    )


@pytest.fixture
def points() -> np.ndarray:
    return np.random.default_rng(3).uniform([0.0, 0.0], [15.0, 5.0], (150, 2))


@pytest.fixture
def measured():
    """Measurements [Pa] at places, shape (d, 2) [m], with the coefficients of variation of their errors."""

    def make(places, values, errors=0.0) -> Measurements:
        labels = np.array([f"data.{k}" for k in range(len(values))], dtype=object)
        errors = np.broadcast_to(errors, len(values)).copy()
        return Measurements(places, np.asarray(values), errors, labels, lambda value: f"{value / 1e3:.4g} kPa")

    return make
