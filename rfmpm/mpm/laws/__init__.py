"""Constitutive laws by name."""

from rfmpm.mpm.laws.drucker_prager import DruckerPrager
from rfmpm.mpm.laws.elastic import Elastic
from rfmpm.mpm.laws.mohr_coulomb import MohrCoulomb
from rfmpm.mpm.laws.von_mises import VonMises

LAWS = {"elastic": Elastic, "von_mises": VonMises, "mohr_coulomb": MohrCoulomb, "drucker_prager": DruckerPrager}
