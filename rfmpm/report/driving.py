"""What drives the quantity in question: uncertain numbers of the study, and places of its random fields."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rfmpm import planning
from rfmpm.estimators.sensitivity import FEWEST, arrange, given_data_indices, sobol_indices
from rfmpm.planning.questions import NOUNS
from rfmpm.report.answering import Answers
from rfmpm.report.members import independent, usable
from rfmpm.report.style import Picture

MOST_FIELDS = 500  # that are made again; a correlation then has a noise of 0.05


@dataclass(frozen=True)
class Drivers:
    """Pictures of what drives the quantity, and their numbers by name."""

    charts: list[Picture] = field(default_factory=list)
    maps: list[Picture] = field(default_factory=list)
    numbers: dict[str, Any] = field(default_factory=dict)


def drivers(dataset, study, answers: Answers, replay: "planning.Replay | None") -> Drivers:
    """Find what drives the quantity in question.

    Args:
        dataset: the ensemble.
        study: its Study.
        answers: of its estimator.
        replay: makes the fields of its realisations again; None leaves them out.

    Returns:
        Drivers; empty where the study or its number of realisations allows nothing.
    """
    quantity = answers.question.quantity
    found = Drivers()
    if study.uncertain:
        _of_numbers(found, dataset, study, answers, NOUNS[quantity])
    if replay is not None and study.fields:
        _of_fields(found, dataset, study, quantity, replay)
    return found


def _of_numbers(found: Drivers, dataset, study, answers: Answers, noun: str) -> None:
    """Sobol indices of a design for them, or first-order ones from independent realisations."""
    from rfmpm.report.sensitivity_figures import given_data_chart, group_labels, sobol_chart

    keys, has_fields = [entry.key for entry in study.uncertain], bool(study.fields)
    if _is_design(study):
        labels = group_labels(keys, has_fields)
        blocks = len(labels) + 2
        whole = usable(dataset, study).sizes["realisation"] // blocks * blocks  # later ones may be the quick ones
        indices = sobol_indices(arrange(answers.rows.first([whole]), len(labels)), answers.confidence)
        if np.isfinite(indices.total).any():
            found.charts.append(sobol_chart(labels, indices, noun))
            found.numbers["sobol_indices"] = {"groups": labels, "indices": indices}
    elif answers.is_plain:
        rows = usable(dataset, study)
        labels, own = group_labels(keys, False), answers.rows.first([rows.sizes["realisation"]])
        indices = given_data_indices(rows["uncertain_value"].values, own, confidence=answers.confidence)
        if np.isfinite(indices.first).any():
            found.charts.append(given_data_chart(labels, indices, noun))
            found.numbers["first_order_indices"] = {"numbers": labels, "indices": indices}


def _is_design(study) -> bool:
    return study.estimator is not None and study.estimator.sampling == "saltelli"


def _of_fields(found: Drivers, dataset, study, quantity: str, replay: "planning.Replay") -> None:
    """Correlation of each field with the quantity at every place, from realisations with fields of their own."""
    from rfmpm.field_influence import field_influence
    from rfmpm.mpm.scene import outline
    from rfmpm.report.sensitivity_figures import influence_map

    rows = independent(usable(dataset, study), study)
    index, values = rows["realisation"].values, rows[quantity].values
    if np.sum(~np.isnan(values)) < FEWEST or np.nanmax(values) == np.nanmin(values):
        return
    prepared = replay.prepared
    vector = None if planning.is_random(study) else lambda i: replay.options(i)["xi"]
    at = prepared.scene.points.position
    places = np.column_stack([at.x, at.y])
    for name, influence in field_influence(prepared, index, values, vector, MOST_FIELDS).items():
        label = name.replace("_", " ")
        found.maps.append(
            influence_map(places[prepared.fields[name].where], influence, outline(study), label, NOUNS[quantity])
        )
        found.numbers[f"influence_of_{name.replace(' ', '_')}"] = influence
