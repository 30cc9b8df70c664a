"""The rows of a dataset that the page shows, and what each says of itself."""

import numpy as np

from rfmpm import estimators
from rfmpm.planning.records import BOUNDED_BY
from rfmpm.study.question_checks import saltelli_size


def usable(dataset, study=None):
    """Return the rows with indices 0, 1, 2, ... up to the first gap, in this order (xarray.Dataset).

    Only simulations on the study's own cells count. Those of a part of a study begin with its own first index. Where
    later ones are chosen by what came before, the first ones alone are a fair sample.

    Args:
        dataset: the ensemble.
        study: its Study; None: all rows are a fair sample.
    """
    if np.any(dataset["level"].values != 0):
        dataset = dataset.isel(realisation=dataset["level"].values == 0)
    indices = dataset["realisation"].values
    if np.any(np.diff(indices) < 0):
        dataset = dataset.sortby("realisation")
    count = estimators.contiguous_prefix(indices - first_index(dataset))
    design = None if study is None else study.estimator
    if design is not None and design.fair_size is not None:
        count = min(count, design.fair_size)
    return dataset.isel(realisation=slice(count))


def independent(rows, study):
    """Return the rows that do not repeat each other: of a saltelli design the first block of each base point.

    Args:
        rows: as `usable` gives them.
        study: their Study.
    """
    design = study.estimator
    if design is None or design.sampling != "saltelli":
        return rows
    blocks = saltelli_size(len(study.uncertain), bool(study.fields))
    return rows.isel(realisation=rows["realisation"].values % blocks == 0)


def first_index(dataset) -> int:
    """Return the index of the first realisation that the dataset is to hold: 0 but in a part of a study."""
    return int(dataset.attrs.get("first_realisation", 0))


def flagged(rows, *names: str) -> np.ndarray:
    """Return where one of the flags is set, shape (n,); a flag that the dataset lacks is set nowhere."""
    found = np.zeros(rows.sizes["realisation"], bool)
    for name in names:
        if name in rows:
            found |= np.nan_to_num(rows[name].values.astype(float)) > 0.0
    return found


def censored_members(rows, quantity: str = "run_out") -> np.ndarray:
    """Return where a value of a quantity is only a lower bound, shape (n,); nowhere if the dataset does not say."""
    return flagged(rows, *BOUNDED_BY[quantity])


def status_names(rows) -> list[str]:
    """Return the status of every row in words, read off the CF flags."""
    attributes = rows["status"].attrs
    names = dict(
        zip(np.atleast_1d(attributes["flag_values"]).tolist(), attributes["flag_meanings"].split(), strict=True)
    )
    return [names[int(code)] for code in rows["status"].values]


def statuses(rows) -> dict[str, int]:
    """Count the rows of each status, in the order of the table of statuses."""
    found = status_names(rows)
    order = rows["status"].attrs["flag_meanings"].split()
    return {name: found.count(name) for name in order if name in found}


def reasons(rows) -> list[tuple[int, str, str]]:
    """List realisation, status and reason of every row that did not come to rest."""
    texts = rows["status_reason"].values if "status_reason" in rows else [""] * rows.sizes["realisation"]
    members = zip(rows["realisation"].values, status_names(rows), texts, strict=True)
    return [(int(index), status, str(reason)) for index, status, reason in members if status != "ok"]
