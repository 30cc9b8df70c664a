"""Constitutive laws by name."""

from rfmpm.mpm.laws.elastic import Elastic
from rfmpm.mpm.laws.von_mises import VonMises

LAWS = {"elastic": Elastic, "von_mises": VonMises}
