"""The short slope with random cohesion of Vardon (2016), lecture, TU Delft: three stages, on coarse cells."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from rfmpm.benchmark.papers.short_slope import COARSE
from rfmpm.benchmark.papers.short_slope_random import FEW, SCALES, STAGES, is_staged, realise, typical


@cache
def members(scale):
    return realise(scale, COARSE, FEW)


@pytest.mark.parametrize("scale", SCALES)
def test_stages_follow_each_other_in_most_realisations(scale):
    for own in members(scale):
        times = [own.stages[name][0] for name in STAGES if name in own.stages]
        assert times == sorted(times)
    assert sum(is_staged(own) for own in members(scale)) > FEW / 2
    assert is_staged(typical(members(scale)))


@pytest.mark.parametrize("scale", SCALES)
def test_plastic_strain_grows_from_stage_to_stage(scale):
    own = typical(members(scale))
    strains = [own.stages[name][1]["plastic_strain"] for name in STAGES]
    assert all(np.all(after >= before) for before, after in pairwise(strains))


@pytest.mark.parametrize("scale", SCALES)
def test_first_band_seeks_weak_soil(scale):
    assert np.mean([own.in_band for own in members(scale)]) < 1.0
