"""Where a result comes from: versions, the hash of the sources that decide it, and the global attributes of a file."""

import hashlib
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

# Sources a row depends on; a change in any of them may change its bits.
PHYSICS = (
    *("ground", "kernel_tools", "mpm", "random_fields", "quantities", "stability", "observer.py"),
    *("initial_state.py", "preparation.py", "realisation.py", "seeds.py", "uncertainty.py"),
    *("sampling", "estimators/chains.py", "estimators/subset_simulation.py"),  # which random vector is whose
    *("estimators/rounds.py", "estimators/stratified.py", "estimators/regression.py", "estimators/surrogate.py"),
)
LIBRARIES = ("numpy", "scipy", "numba", "llvmlite", "xarray", "netCDF4")


@cache
def source_hash() -> str:
    """Hash the sources that decide what a row holds.

    Returns:
        sha256 over the relative paths and contents of the files of PHYSICS, hexadecimal; read once per process.
    """
    package = Path(__file__).parents[1]
    files = [path for room in PHYSICS for path in [package / room, *(package / room).rglob("*.py")] if path.is_file()]
    state = hashlib.sha256()
    for path in sorted(files):
        state.update(path.relative_to(package).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return state.hexdigest()


def versions() -> dict[str, str]:
    """Name the versions of this package, of Python and of the libraries that computed a result.

    Returns:
        Name -> version.
    """
    import platform

    found = {"rfmpm": metadata.version("rfmpm"), "python": platform.python_version()}
    return found | {name: metadata.version(name) for name in LIBRARIES}


def row_attributes(study) -> dict[str, Any]:
    """Make what files of rows say about all their rows: whose they are, and what computed them where.

    Args:
        study: the study.

    Returns:
        Attribute name -> text or number; "surface_bin_m" only where the study keeps a surface.
    """
    import platform

    found = versions()
    own = found.pop("rfmpm")
    attributes = {
        "physics_hash": study.physics_hash,
        "source_hash": source_hash(),
        "rfmpm_version": own,
        "library_versions": _listed(found),
        "host": platform.node(),
    }
    width = study.output.surface_bin_m
    return attributes if width is None else {**attributes, "surface_bin_m": width}


def _listed(found: dict[str, str]) -> str:
    return ", ".join(f"{name} {version}" for name, version in found.items())


def global_attributes(study, title: str = "") -> dict[str, Any]:
    """Make the global attributes that every result file carries.

    Args:
        study: the study.
        title: of the file; the study's name if empty.

    Returns:
        Attribute name -> text or number, CF and ACDD names where they exist.
    """
    found = versions()
    own = found.pop("rfmpm")
    return {
        "Conventions": "CF-1.11",
        "title": title or study.study.name,
        "source": f"rfmpm {own}",
        "history": f"written by rfmpm {own}",
        "study": study.to_toml(),
        "study_name": study.study.name,
        "seed": study.study.seed,
        "physics_hash": study.physics_hash,
        "source_hash": source_hash(),
        "rfmpm_version": own,
        "library_versions": _listed(found),
    }
