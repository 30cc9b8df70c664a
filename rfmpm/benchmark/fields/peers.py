"""Other packages that make Gaussian fields, each set to the same covariance; none is needed to run this program.

Their lengths are not theta: gstools counts theta / 2 for an exponential, geone three halves of theta.
"""

from collections.abc import Callable
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np

from rfmpm.benchmark.fields.cases import Case

Draw = Callable[[int], np.ndarray]  # seed -> field at the points of the case, shape (n,)
GSTOOLS_MODES = 1000  # its default


def _gstools(case: Case) -> Draw:
    import gstools

    model = gstools.Exponential(dim=2, var=1.0, len_scale=[case.theta_h / 2.0, case.theta_v / 2.0])
    points, data = case.points, case.data
    if case.data_count:
        kriging = gstools.krige.Simple(model, cond_pos=data.places.T, cond_val=data.values)
        field = gstools.CondSRF(kriging, mode_no=GSTOOLS_MODES)
    else:
        field = gstools.SRF(model, mode_no=GSTOOLS_MODES, seed=0)
    return lambda seed: np.asarray(field((points[:, 0], points[:, 1]), seed=seed, mesh_type="unstructured"))


def _geone(case: Case) -> Draw:
    from geone import covModel, grf

    model = covModel.CovModel2D(
        elem=[("exponential", {"w": 1.0, "r": [1.5 * case.theta_h, 1.5 * case.theta_v]})], alpha=0.0
    )

    def draw(seed: int) -> np.ndarray:
        np.random.seed(seed)  # noqa: NPY002 - the only stream that it knows
        size, spacing = (case.columns, case.rows), (case.spacing, case.spacing)
        return grf.grf2D(model, size, spacing, nreal=1, verbose=0)[0].ravel()

    return draw


def _gaussianfft(case: Case) -> Draw:
    import gaussianfft

    model = gaussianfft.variogram("exponential", 1.5 * case.theta_h, 1.5 * case.theta_v)

    def draw(seed: int) -> np.ndarray:
        gaussianfft.seed(seed)
        field = gaussianfft.simulate(model, case.columns, case.spacing, case.rows, case.spacing)
        return np.asarray(field).reshape((case.columns, case.rows), order="F").T.ravel()

    return draw


class Peer(NamedTuple):
    """What makes the draw, whether it needs a lattice, and whether its fields can be conditioned here."""

    make: Callable[[Case], Draw]
    needs_lattice: bool
    conditions: bool = False


PEERS = {
    "gstools": Peer(_gstools, needs_lattice=False, conditions=True),
    "geone": Peer(_geone, needs_lattice=True),
    "gaussianfft": Peer(_gaussianfft, needs_lattice=True),
}


def installed() -> list[str]:
    """Names of the peers that can be imported."""
    return [name for name in PEERS if find_spec(name) is not None]
