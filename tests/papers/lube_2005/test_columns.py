"""Collapse of planar granular columns on a rough base: Lube et al. (2005), Phys. Rev. E 72, 041301.

Run-out over half width, (L - L0) / L0, of columns of aspect ratio a: 1.2 a for a < 1.8 and 1.9 a^(2/3) above 2.8.
The friction angle is the sand's angle of repose, nothing is fitted. Found with cells of a tenth of the half width:
0.85, 0.97, 1.11, 0.98, 1.02, 1.10, 1.13 of that law for a = 0.5, 1, 1.5, 3, 4, 6, 8.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import rfmpm

STUDY = Path(__file__).parents[3] / "configs" / "papers" / "lube_2005_columns.toml"
HALF_WIDTH = 0.1  # [m]
LOW, TALL = (0.5, 1.0, 1.5), (3.0, 4.0, 6.0, 8.0)
# Experiments scatter about the law by a few per cent; with another sand, channel and reading of the front Lajeunesse et
# al. (2005) find up to 1.5 times as much. Ours is the front of 99.5 % of the mass, which leaves a thin toe out.
TOLERANCE = 0.2

pytestmark = pytest.mark.slow


def law_of_the_experiments(aspect):
    return 1.2 * aspect if aspect < 1.8 else 1.9 * aspect ** (2.0 / 3.0)


@cache
def run_out(aspect):
    """Run-out over half width."""
    changes = {
        "geometry.height_m": HALF_WIDTH * aspect,
        "geometry.foreland_m": HALF_WIDTH * round(2.0 * law_of_the_experiments(aspect) + 1.0),
    }
    outcome = rfmpm.simulate(rfmpm.load_study(STUDY).with_changes(changes))
    assert outcome.status in ("ok", "not_at_rest")
    assert not outcome.quantities["run_out_censored"]
    return outcome.quantities["run_out"] / HALF_WIDTH


@pytest.mark.parametrize("aspect", LOW + TALL)
def test_run_out_follows_the_law_of_the_experiments(aspect):
    assert run_out(aspect) == pytest.approx(law_of_the_experiments(aspect), rel=TOLERANCE)


def test_tall_columns_run_out_with_a_power_of_about_two_thirds():
    exponent = np.polyfit(np.log(TALL), np.log([run_out(aspect) for aspect in TALL]), 1)[0]
    # Experiments give 0.66 to 0.7, simulations of grains 0.7 (Staron and Hinch 2005).
    assert 0.55 < exponent < 0.9
