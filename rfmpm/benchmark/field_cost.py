"""The parts of a random field by themselves, to be timed."""

import numpy as np

from rfmpm.random_fields import field as random_field
from rfmpm.realisation import Prepared


def prepare_field(prepared: Prepared) -> None:
    """Prepare the cohesion field of a study once more: above all its factor."""
    settings, mean = prepared.study.random_field["cohesion"], prepared.study.material[0].cohesion_kpa * 1e3
    random_field.prepare(settings, mean, np.column_stack(prepared.scene.points.position))


def realise_field(prepared: Prepared) -> None:
    """Realise the cohesion field of a study."""
    field = prepared.fields["cohesion"]
    random_field.realise(field, np.zeros(field.n_variables))
