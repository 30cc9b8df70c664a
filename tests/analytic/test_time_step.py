"""The run-out does not depend on the time step."""

from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation

SHORT_SLOPE = Path(__file__).parents[2] / "configs" / "short_slope.toml"
FRACTIONS = (0.1, 0.2, 0.4, 0.8)


@pytest.mark.slow
@pytest.mark.parametrize("residual", [4.0, 8.0, 12.0])
def test_run_out_is_the_same_for_any_time_step(residual):
    study = rfmpm.load_study(SHORT_SLOPE).with_changes(
        {"discretisation.cell_m": 0.25, "material.0.residual_cohesion_kpa": residual}
    )
    run_outs = []
    for fraction in FRACTIONS:
        outcome = realisation.simulate(realisation.prepare(study.with_changes({"time.step_fraction": fraction})))
        assert outcome.status in ("ok", "not_at_rest")
        assert not outcome.quantities["run_out_censored"]
        run_outs.append(outcome.quantities["run_out"])
    # 2 % of the mean: what two grids that differ by a few centimetres in the front show for an eightfold step.
    np.testing.assert_allclose(run_outs, np.mean(run_outs), rtol=0.02, err_msg=f"at {FRACTIONS}")
