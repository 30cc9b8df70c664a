"""The run-out of a collapse does not depend on the time step: dissipation acts at a rate, not per step."""

from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.variables import STATUS

SHORT_SLOPE = Path(__file__).parents[2] / "configs" / "short_slope.toml"
FRACTIONS = (0.1, 0.2, 0.4, 0.8)


@pytest.mark.slow
@pytest.mark.parametrize("residual", [4.0, 8.0, 12.0])
def test_run_out_is_the_same_for_steps_eight_times_as_long(residual):
    study = rfmpm.load_study(SHORT_SLOPE).with_changes(
        {"material.0.residual_cohesion_kpa": residual, "time.end_s": 25.0}
    )
    run_outs = []
    for fraction in FRACTIONS:
        row = realisation.run(realisation.prepare(study.with_changes({"time.step_fraction": fraction})), 0)
        assert row["status"] in (STATUS["ok"], STATUS["not_at_rest"])
        assert not row["run_out_censored"]
        run_outs.append(row["run_out"])
    # Measured within 1.2 % at 4 kPa, where blocks break up and small differences grow, 0.4 % at 8 and 12 kPa; a
    # dissipation per step would spread them over a factor of two.
    np.testing.assert_allclose(run_outs, np.mean(run_outs), rtol=0.02)
