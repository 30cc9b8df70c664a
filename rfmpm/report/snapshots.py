"""The realisations that the report pictures: simulated again, checked against the record, kept for the next report."""

import io
import os
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

KEPT = ("x", "y", "plastic_strain")
Simulate = Callable[[int], Mapping[str, np.ndarray]]


@dataclass(frozen=True)
class Snapshot:
    """The final state of one realisation."""

    name: str  # which one, e.g. "median"
    index: int
    recorded: float  # run-out in the dataset [m]
    found: float  # run-out of the repetition [m]
    points: Mapping[str, np.ndarray]  # x, y [m], plastic_strain [-], each of shape (n,)

    @property
    def is_same(self) -> bool:
        """Whether the repetition has the recorded run-out, bit for bit."""
        return self.found == self.recorded


def simulator(replay) -> Simulate:
    """Make the function that simulates a realisation of a campaign again.

    Args:
        replay: of the campaign.

    Returns:
        Function of the index -> x, y, plastic_strain (each of shape (n,)) and run_out (a number).
    """

    def simulate(index: int) -> dict[str, np.ndarray]:
        outcome = replay.simulate(index)
        return {name: outcome.points[name] for name in KEPT} | {"run_out": outcome.quantities["run_out"]}

    return simulate


def take(chosen: list[tuple[str, int, float]], folder: Path, physics_hash: str, simulate: Simulate) -> list[Snapshot]:
    """Find or make the snapshots of some realisations.

    Args:
        chosen: name, index and recorded run-out [m] of each.
        folder: where they are kept, one file each.
        physics_hash: of the study; a file of another study is not used.
        simulate: function of the index -> x, y, plastic_strain and run_out.

    Returns:
        One snapshot for each; those whose run-out is the recorded one are kept in the folder.
    """
    snapshots = []
    for name, index, recorded in chosen:
        path = folder / f"{index}.npz"
        state = _read(path, recorded, physics_hash)
        if state is None:
            state = simulate(index)
            if float(state["run_out"]) == recorded:
                _keep(path, state, physics_hash)
        points = _finite({key: np.asarray(state[key], float) for key in KEPT})
        snapshots.append(Snapshot(name, index, recorded, float(state["run_out"]), points))
    return snapshots


def _read(path: Path, recorded: float, physics_hash: str) -> dict[str, np.ndarray] | None:
    """What the file holds, or None if there is no such file, it cannot be read, or it belongs to something else."""
    try:
        with np.load(path, allow_pickle=False) as file:
            state = {key: file[key] for key in (*KEPT, "run_out", "physics_hash")}
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None
    is_ours = state["run_out"].shape == () and float(state["run_out"]) == recorded
    return state if is_ours and str(state["physics_hash"]) == physics_hash else None


def _keep(path: Path, state: Mapping[str, np.ndarray], physics_hash: str) -> None:
    buffer = io.BytesIO()
    np.savez_compressed(
        buffer, **{key: state[key] for key in KEPT}, run_out=np.float64(state["run_out"]), physics_hash=physics_hash
    )
    write_atomically(path, buffer.getvalue())


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file such that readers see the old one or the whole new one.

    Args:
        path: the file; its folder is made if need be.
        data: what it shall hold.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        temporary.write_bytes(data)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def _finite(points: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    kept = np.isfinite(points["x"]) & np.isfinite(points["y"])
    return {name: values[kept] for name, values in points.items()}
