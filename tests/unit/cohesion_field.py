"""Changes to the random field of the cohesion of a study, and what is wrong with them."""

import pytest

from rfmpm.study import StudyError

FIELD = "random_field.cohesion"


def changed(study, keys):
    return study.with_changes({f"{FIELD}.{key}": value for key, value in keys.items()})


def problems_of(study, keys):
    with pytest.raises(StudyError) as refusal:
        changed(study, keys)
    return refusal.value.problems
