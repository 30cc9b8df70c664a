"""What realisations of one study share, and what one of them draws: fields, and values of what is uncertain."""

from dataclasses import dataclass
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm import seeds
from rfmpm.mpm import geometry
from rfmpm.mpm import scene as scenes
from rfmpm.random_fields import properties as random_properties
from rfmpm.random_fields.marginals import Marginal
from rfmpm.random_fields.property import Properties, Property
from rfmpm.random_fields.site import Site
from rfmpm.stability import ASSUMPTIONS, Side, lay
from rfmpm.study import StudyError
from rfmpm.uncertainty import fitted, marginals, values


@dataclass(frozen=True)
class Prepared:
    """What realisations of one study share."""

    study: Any
    scene: scenes.Scene
    properties: Properties
    uncertain: tuple[Marginal, ...] = ()  # distributions of the study's uncertain numbers
    sides: tuple[Side, ...] | None = None  # for the factor of safety, where the study asks for it

    @property
    def n_variables(self) -> int:
        """Length of the vector `xi`: one value for each uncertain number, then what the fields take."""
        return len(self.uncertain) + self.properties.n_variables

    @property
    def fields(self) -> dict[str, Property]:
        """The random properties by name."""
        return self.properties.entries


def prepare(study, store: Path | None = None) -> Prepared:
    """Make what all realisations of a study share: the scene, its initial stresses, the factor of its fields.

    Args:
        study: the study.
        store: folder in which the factor is kept for other processes; None keeps it in memory.

    Returns:
        The prepared study.

    Raises:
        OSError: if the store cannot be written.
        StudyError: if a field cannot be made as asked, or its data contradict what is asked.
    """
    scene = scenes.build(study)
    points = np.column_stack(scene.points.position)
    properties = _properties(study, scene.body, points, scene.soils.counts, store)
    return Prepared(study, scene, properties, marginals(study), _sides(study, scene))


def _sides(study, scene: scenes.Scene) -> tuple[Side, ...] | None:
    if study.quantities.safety_method not in ASSUMPTIONS:
        return None
    try:
        return lay(scene, study.discretisation.points_per_cell)
    except ValueError as error:
        raise StudyError([f"quantities.factor_of_safety: {error}"]) from None


def prepare_fields(study) -> Properties:
    """Prepare the random fields of a study alone, without the scene in which they vary.

    Raises:
        StudyError: as for `prepare`.
    """
    shape = geometry.body(study)
    filling, _ = geometry.fill_body(study, shape)
    return _properties(study, shape, filling.position, filling.counts, None)


def _properties(
    study,
    shape: geometry.Body,
    points: np.ndarray,
    counts: tuple[int, ...],
    store: Path | None,
    known: Properties | None = None,
) -> Properties:
    try:
        return random_properties.prepare(study, _site(study, shape, points, counts), store, known)
    except ValueError as error:
        raise StudyError([str(error)]) from None


def draw_xi(prepared: Prepared, index: int, level: int = 0) -> np.ndarray:
    """Draw the vector `xi` of one realisation from the stream of (seed, level, index), shape (n_variables,) [-]."""
    return seeds.standard_normal(prepared.study.study.seed, level, index, prepared.n_variables)


def drawn(prepared: Prepared, xi: np.ndarray) -> tuple[Prepared, np.ndarray]:
    """Give the uncertain numbers of a study the values of one realisation, and prepare anew what depends on them.

    Args:
        prepared: the prepared study.
        xi: of the realisation, shape (n_variables,) [-].

    Returns:
        The prepared study at these values, in which nothing is uncertain, and what its fields take of `xi`.

    Raises:
        ValueError: if `xi` has another length than the study takes.
        StudyError: if the study is wrong at these values.
    """
    xi = np.asarray(xi, dtype=float)
    if xi.shape != (prepared.n_variables,):
        raise ValueError(f"xi of shape {xi.shape}: must be ({prepared.n_variables},), as this study's fields take")
    if not prepared.uncertain:
        return prepared, xi
    study = prepared.study.with_values(values(prepared.uncertain, xi))
    scene = scenes.with_parameters(prepared.scene, study)
    points = np.column_stack(scene.points.position)
    properties = _properties(study, scene.body, points, scene.soils.counts, None, prepared.properties)
    own = Prepared(study, scene, properties, sides=prepared.sides)
    return own, fitted(xi[len(prepared.uncertain) :], properties.n_variables)


def realise_fields(study, index: int, level: int = 0, xi: np.ndarray | None = None) -> dict[str, np.ndarray]:
    """Make the random fields of one realisation alone.

    Args:
        study: the study.
        index: of the realisation.
        level: of the plan.
        xi: standard-normal vector, shape (n_variables,); None draws it from the stream of (seed, level, index).

    Returns:
        Field by name, shape (n,) each, in SI units; empty for a homogeneous study.

    Raises:
        ValueError: if `xi` has another length than the study takes.
        StudyError: if the study is wrong at the values of its uncertain numbers.
    """
    prepared = prepare(study)
    own, of_fields = drawn(prepared, draw_xi(prepared, index, level) if xi is None else xi)
    return random_properties.realise(own.properties, of_fields)


def _site(study, body: geometry.Body, points: np.ndarray, counts: tuple[int, ...]) -> Site:
    """Where the fields of a study are needed."""
    cell = study.discretisation.cell_m
    square = cell / sqrt(study.discretisation.points_per_cell)
    return Site(points, cell, square, body.height, body.reach, counts)
