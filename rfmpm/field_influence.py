"""Where in the slope the random fields drive a quantity: fields of finished rows, made again, against the quantity."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from rfmpm.estimators.influence import Influence, influence
from rfmpm.preparation import Prepared, draw_xi, drawn
from rfmpm.random_fields import properties as random_properties
from rfmpm.random_fields.common import take

MOST_ROWS = 2000  # whose fields are made again; a correlation then has a noise of 0.02
AT_ONCE = 100  # fields in memory


def field_influence(
    prepared: Prepared,
    indices: Sequence[int],
    quantity: np.ndarray,
    xi_of: Callable[[int], np.ndarray] | None = None,
    most: int = MOST_ROWS,
) -> dict[str, Influence]:
    """Correlate the standard-normal field of each random property with a quantity, at every material point.

    Args:
        prepared: the prepared study.
        indices: of independent realisations, n; of a design that uses a field several times, those with different ones.
        quantity: of each, shape (n,); NaN where it failed, which leaves that one out.
        xi_of: vector of a realisation, shape (n_variables,); None for the stream of its index.
        most: rows that are used, the first ones.

    Returns:
        Influence by name of the property, at the material points.

    Raises:
        ValueError: as for `influence`.
    """
    quantity = np.asarray(quantity, float)
    is_finished = ~np.isnan(quantity)
    kept, values = np.asarray(indices)[is_finished][:most], quantity[is_finished][:most]
    vector = xi_of or (lambda index: draw_xi(prepared, index))
    return {name: influence(_blocks(prepared, name, kept, vector), values) for name in prepared.fields}


def _blocks(prepared: Prepared, name: str, indices: np.ndarray, xi_of) -> Iterator[np.ndarray]:
    for start in range(0, len(indices), AT_ONCE):
        vectors = (xi_of(int(index)) for index in indices[start : start + AT_ONCE])
        yield np.array([_standard_normal(prepared, name, xi) for xi in vectors])


def _standard_normal(prepared: Prepared, name: str, xi: np.ndarray) -> np.ndarray:
    """Standard-normal field at the material points, or its mean over what each takes of a lattice, shape (n,) [-]."""
    own, of_fields = drawn(prepared, xi)
    field, taken = random_properties.standard_normal(own.properties, of_fields)[name], own.fields[name].taken
    return field if taken is None else take(field, taken)
