"""The parts of a random field by themselves, to be timed."""

from dataclasses import replace

import numpy as np

from rfmpm.random_fields import field as random_field
from rfmpm.random_fields.property import Properties
from rfmpm.realisation import Prepared


def prepare_field(prepared: Prepared) -> None:
    """Prepare the cohesion field of a study once more: above all its factor."""
    for part in prepared.fields["cohesion"].parts:
        random_field.prepare(part.settings, part.mean, part.points)


def realise_field(prepared: Prepared) -> None:
    """Realise the cohesion field of a study."""
    for part in prepared.fields["cohesion"].parts:
        random_field.realise(part.field, np.zeros(part.field.n_variables))


def without_fields(prepared: Prepared) -> Prepared:
    """The study with the mean strength everywhere."""
    return replace(prepared, properties=Properties({}, None))
