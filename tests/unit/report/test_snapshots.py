"""States of pictured realisations: simulated once, checked, kept, and not trusted if they do not fit."""

import numpy as np
import pytest

from rfmpm.report.snapshots import take

RUN_OUT = 6.123456789012345
STATE = {"x": np.array([1.0, 2.0, np.nan]), "y": np.array([0.5, 0.5, 0.5]), "plastic_strain": np.array([0.0, 0.3, 0.1])}


class Simulation:
    """Stands in for a simulation and counts its calls."""

    def __init__(self, run_out=RUN_OUT):
        self.run_out, self.calls = run_out, []

    def __call__(self, index):
        self.calls.append(index)
        return STATE | {"run_out": self.run_out}


def test_a_state_is_simulated_once_and_kept(tmp_path):
    simulation, chosen = Simulation(), [("median", 3, RUN_OUT), ("worst", 11, RUN_OUT)]
    first = take(chosen, tmp_path / "snapshots", "abc", simulation)
    second = take(chosen, tmp_path / "snapshots", "abc", simulation)
    assert simulation.calls == [3, 11]
    assert [path.name for path in sorted((tmp_path / "snapshots").iterdir())] == ["11.npz", "3.npz"]
    assert all(snapshot.is_same for snapshot in first + second)
    for snapshot in first + second:
        np.testing.assert_array_equal(snapshot.points["x"], [1.0, 2.0])  # the point that is nowhere is left out
        np.testing.assert_array_equal(snapshot.points["plastic_strain"], [0.0, 0.3])


@pytest.mark.parametrize("run_out", [np.nextafter(RUN_OUT, 99.0), np.nan])
def test_a_repetition_that_differs_in_the_last_bit_is_known_and_not_kept(tmp_path, run_out):
    (snapshot,) = take([("worst", 0, RUN_OUT)], tmp_path, "abc", Simulation(run_out))
    assert not snapshot.is_same
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("damage", ["cut", "empty", "text", "other run-out", "other study", "name missing"])
def test_a_kept_state_that_does_not_fit_is_made_anew(tmp_path, damage):
    simulation, chosen = Simulation(), [("worst", 0, RUN_OUT)]
    take(chosen, tmp_path, "abc", simulation)
    path = tmp_path / "0.npz"
    with np.load(path) as file:
        state = dict(file)
    if damage in ("cut", "empty", "text"):
        path.write_bytes({"cut": path.read_bytes()[:200], "empty": b"", "text": b"not an archive"}[damage])
    elif damage == "name missing":
        np.savez(path, x=state["x"])
    else:
        changed = {"run_out": np.nextafter(RUN_OUT, 99.0)} if damage == "other run-out" else {"physics_hash": "xyz"}
        np.savez(path, **(state | changed))
    (snapshot,) = take(chosen, tmp_path, "abc", simulation)
    assert snapshot.is_same
    assert simulation.calls == [0, 0]
    take(chosen, tmp_path, "abc", simulation)
    assert simulation.calls == [0, 0]
