"""The configuration: what a study file may say, and what is wrong with one that says something else."""

from rfmpm.study.errors import StudyError
from rfmpm.study.field_models import RandomField
from rfmpm.study.geometry_models import BlockGeometry, SlopeGeometry
from rfmpm.study.load import load_study
from rfmpm.study.making import fields_need_making, with_fastest_methods
from rfmpm.study.models import ElasticMaterial, VonMisesMaterial
from rfmpm.study.study import NOT_PHYSICS, Study

__all__ = [
    "NOT_PHYSICS",
    "BlockGeometry",
    "ElasticMaterial",
    "RandomField",
    "SlopeGeometry",
    "Study",
    "StudyError",
    "VonMisesMaterial",
    "fields_need_making",
    "load_study",
    "with_fastest_methods",
]
