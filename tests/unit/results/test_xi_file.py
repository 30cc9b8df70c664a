"""A vector xi as a file: every bit comes back, and what is no such file is refused in words."""

import numpy as np
import pytest

from rfmpm.results import read_xi, write_xi


def test_every_bit_comes_back(tmp_path):
    xi = np.random.default_rng(0).standard_normal(1000)
    write_xi(tmp_path / "a.file", xi)
    assert read_xi(tmp_path / "a.file", 1000).tobytes() == xi.tobytes()


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (np.zeros(9), r"holds float64 of shape \(9,\); this study's fields take 10 numbers"),
        (np.zeros((10, 1)), r"shape \(10, 1\)"),
        (np.zeros(10, dtype=np.float32), "holds float32"),
        (np.full(10, np.nan), "not finite"),
    ],
)
def test_another_vector_is_refused(tmp_path, content, sentence):
    np.save(tmp_path / "xi.npy", content)
    with pytest.raises(ValueError, match=sentence):
        read_xi(tmp_path / "xi.npy", 10)


def test_what_is_no_vector_is_refused(tmp_path):
    (tmp_path / "xi.npy").write_text("0.1 0.2")
    with pytest.raises(ValueError, match="is not a NumPy file"):
        read_xi(tmp_path / "xi.npy", 2)
    np.savez(tmp_path / "xi.npz", np.zeros(2))
    with pytest.raises(ValueError, match="holds several arrays"):
        read_xi(tmp_path / "xi.npz", 2)
    np.save(tmp_path / "pickled.npy", np.array([None, None]))
    with pytest.raises(ValueError, match="is not a NumPy file"):
        read_xi(tmp_path / "pickled.npy", 2)
    with pytest.raises(FileNotFoundError):
        read_xi(tmp_path / "none.npy", 2)
