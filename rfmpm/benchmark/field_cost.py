"""What the parts of a random field cost, timed by themselves."""

import time

import numpy as np

from rfmpm.random_fields import field as random_field
from rfmpm.realisation import Prepared


def factor_seconds(prepared: Prepared) -> float:
    """Time to prepare the cohesion field of a study, its factor above all [s]."""
    settings, mean = prepared.study.random_field["cohesion"], prepared.study.material[0].cohesion_kpa * 1e3
    position = np.column_stack(prepared.scene.points.position)
    started = time.perf_counter()
    random_field.prepare(settings, mean, position)
    return time.perf_counter() - started


def realise_seconds(prepared: Prepared) -> float:
    """Time to realise the cohesion field of a study once it is prepared [s]."""
    field = prepared.fields["cohesion"]
    xi = np.zeros(field.n_variables)
    started = time.perf_counter()
    random_field.realise(field, xi)
    return time.perf_counter() - started
