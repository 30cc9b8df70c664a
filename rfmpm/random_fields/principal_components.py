"""The few directions of `xi` that move the random fields most: principal components, whatever the field method.

The standard-normal fields of a study, as one vector z over all properties and the points that carry them, are affine in
`xi`: z = z(0) + A xi. The right singular vectors of A, by falling singular value, are orthonormal directions in `xi`;
the squares of the singular values are the parts of the variance, summed over points, that they carry. A field by local
average subdivision is affine but for two variables, its window: these get no part, the window being in the middle.
"""

import hashlib
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools.threads import single_blas_thread
from rfmpm.random_fields import store
from rfmpm.random_fields.properties import standard_normal
from rfmpm.random_fields.property import Properties

MOST_ENTRIES = 60_000_000  # of A: 0.5 GB
PROBES = 3  # vectors of which the fields tell studies apart in the store
FEWEST_FOR_LANCZOS = 400  # variables or points from which finding a few directions is quicker than finding all
SHARE_OF_LANCZOS = 4  # as long as these are fewer than one in so many
ORTHONORMAL = 1e-10  # products of unlike directions, from rounding


class PrincipalComponents(NamedTuple):
    """Directions and what they carry.

    Attributes:
        directions: V, orthonormal rows, shape (d, n_variables) [-].
        shares: of the variance of the fields, summed over their points, that each carries, shape (d,) [-].
    """

    directions: np.ndarray
    shares: np.ndarray


def principal_components(properties: Properties, count: int, folder: Path | None = None) -> PrincipalComponents:
    """Find the first principal components of all random fields of a study together.

    Every point of every property has the same weight. The sign of a direction is such that the fields' mean rises with
    it, or, where it leaves the mean alone, its largest entry is positive. Deterministic, on one BLAS thread.

    Args:
        properties: the prepared random properties.
        count: number wanted, d; fewer come back where the fields have fewer variables or points.
        folder: in which the result is kept and found again, as the records of field methods are; None: not kept.

    Returns:
        The components, by falling share.

    Raises:
        ValueError: too many variables times points to form the map.
        OSError: the folder cannot be written.
    """
    if folder is None:
        return _components(properties, count)
    folder = Path(folder)
    stem = f"principal_components-{_fingerprint(properties, count)}"
    files = {name: folder / f"{stem}.{name}.npy" for name in PrincipalComponents._fields}
    found = store.read(PrincipalComponents, files)
    if found is not None and _is_intact(found, properties, count):
        return found
    folder.mkdir(parents=True, exist_ok=True)
    fresh = _components(properties, count)
    for name, path in files.items():
        store.write(path, getattr(fresh, name))
    return fresh


def linear_map(properties: Properties) -> np.ndarray:
    """Form A: the fields of unit vectors less those of zero, shape (n_variables, points of all properties) [-].

    Raises:
        ValueError: it would have more than MOST_ENTRIES.
    """
    n = properties.n_variables
    points = sum(entry.count for entry in properties.entries.values())
    if n * points > MOST_ENTRIES:
        raise ValueError(
            f"principal components of {n} variables x {points} points: at most {MOST_ENTRIES:,} in all; take a coarser "
            'random_field.*.reference_cell_m or method = "karhunen_loeve" with a smaller '
            'karhunen_loeve_variance_share, or estimator.sampling = "random"'
        )
    at_zero = _field(properties, np.zeros(n))
    columns, unit = np.empty((n, points)), np.zeros(n)
    for k in range(n):
        unit[k] = 1.0
        columns[k] = _field(properties, unit) - at_zero
        unit[k] = 0.0
    return columns


def _field(properties: Properties, xi: np.ndarray) -> np.ndarray:
    return np.concatenate(list(standard_normal(properties, xi).values()))


def _components(properties: Properties, count: int) -> PrincipalComponents:
    transposed = linear_map(properties)
    with single_blas_thread():
        left, values = _largest(transposed, min(count, *transposed.shape))
        mean = np.sum(transposed, axis=1) @ left
    largest = left[np.argmax(np.abs(left), axis=0), np.arange(left.shape[1])]
    rises = np.where(np.abs(mean) > 1e-9 * np.abs(mean).max(initial=0.0), mean, largest)
    total = float(np.sum(transposed**2))
    directions = np.ascontiguousarray((left * np.where(rises < 0.0, -1.0, 1.0)).T)
    return PrincipalComponents(directions, values**2 / total)


def _largest(matrix: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Left singular vectors, as columns, of the largest singular values, and these, by falling value."""
    smaller = min(matrix.shape)
    if SHARE_OF_LANCZOS * count >= smaller or smaller < FEWEST_FOR_LANCZOS:
        left, values, _ = np.linalg.svd(matrix, full_matrices=False)
        return left[:, :count], values[:count]
    from scipy.sparse.linalg import svds  # late: commands that need no components do not pay for it

    with single_blas_thread():  # again: scipy brings a BLAS of its own
        left, values, _ = svds(matrix, k=count, v0=np.ones(smaller), solver="arpack")
        order = np.argsort(-values, kind="stable")
        orthonormal, _ = np.linalg.qr(left[:, order])
    return orthonormal, values[order]


def _fingerprint(properties: Properties, count: int) -> str:
    # Fields of a few vectors stand for the map: equal ones to the last bit come from equal maps, but for a conspiracy.
    probes = np.random.Generator(np.random.PCG64(PROBES)).standard_normal((PROBES, properties.n_variables))
    versions = [version(package) for package in ("rfmpm", "numpy", "scipy")]
    digest = hashlib.sha256(repr((count, properties.n_variables, versions)).encode())
    for probe in probes:
        digest.update(_field(properties, probe).tobytes())
    return digest.hexdigest()[:32]


def _is_intact(found: PrincipalComponents, properties: Properties, count: int) -> bool:
    directions, shares = found
    if directions.ndim != 2 or directions.shape[1] != properties.n_variables or not 0 < len(directions) <= count:
        return False
    if shares.shape != (len(directions),):
        return False
    with single_blas_thread():
        product = directions @ directions.T
    return bool(np.abs(product - np.eye(len(directions))).max() < ORTHONORMAL)
