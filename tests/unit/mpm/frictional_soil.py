"""A soil with friction for the tests of the laws, and paths to take it along."""

from math import cos, radians, sin, sqrt

from scipy.optimize import brentq

from rfmpm.kernel_tools import Tensor, at, kernel
from rfmpm.mpm.laws import LAWS
from rfmpm.mpm.laws.elastic import lame_constants
from rfmpm.mpm.protocols import update_stress
from rfmpm.study.models import DruckerPragerMaterial, MohrCoulombMaterial

COHESION, FRICTION, DILATION = 5e3, 30.0, 10.0  # [Pa], [degrees]
LAME, SHEAR = lame_constants(1e6, 0.3)
BULK = LAME + 2.0 / 3.0 * SHEAR
SIN, COS = sin(radians(FRICTION)), cos(radians(FRICTION))
APEX = COHESION * COS / SIN
CELL = 0.25
IDENTITY = 1e-12
SOIL = {
    "name": "soil",
    "unit_weight_kn_m3": 20.0,
    "youngs_modulus_kpa": 1000.0,
    "poissons_ratio": 0.3,
    "cohesion_kpa": COHESION / 1e3,
    "friction_angle_deg": FRICTION,
}
MODELS = {"mohr_coulomb": MohrCoulombMaterial, "drucker_prager": DruckerPragerMaterial}


def build(law, cell=CELL, count=1, strengths=None, **changes):
    """Law and history of `count` points."""
    return LAWS[law].build(MODELS[law](law=law, **SOIL | changes), cell, count, strengths or {})


def one_point(law, **changes):
    """Law and history of one point, as records of scalars."""
    return tuple(at(record, 0) for record in build(law, **changes))


def isotropic(stress):
    return Tensor(stress, stress, stress, 0.0)


@kernel
def _strain(law, stress, history, increment, steps):
    for _ in range(steps):
        stress, history = update_stress(law, stress, increment, history, 1e-3)
    return stress, history


def strained(law, history, stress, strain, steps=1):
    """Stress and history after a strain (xx, yy, xy), in equal steps."""
    increment = Tensor(strain[0] / steps, strain[1] / steps, 0.0, strain[2] / steps)
    return _strain(law, stress, history, increment, steps)


def sheared(law, history, pressure, amount, steps=1):
    """After an engineering shear strain, from an isotropic pressure."""
    return strained(law, history, isotropic(-pressure), (0.0, 0.0, 0.5 * amount), steps)


def compressed(law, history, pressure, amount, steps):
    """Biaxial compression along y at constant lateral pressure: stress, history and lateral strain, step by step."""
    stress, step = isotropic(-pressure), amount / steps
    path = []
    for _ in range(steps):

        def beyond(lateral, stress=stress, history=history):
            return strained(law, history, stress, (lateral, -step, 0.0))[0].xx + pressure

        lateral = brentq(beyond, -step, 5.0 * step, xtol=1e-18, rtol=1e-14)
        stress, history = strained(law, history, stress, (lateral, -step, 0.0))
        path.append((stress, history, lateral))
    return path


def octahedral(growth):
    """Plastic strain invariant of a slip e1 = -e3 = growth."""
    return 2.0 / sqrt(3.0) * growth
