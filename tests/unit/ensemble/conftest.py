from pathlib import Path

import pytest

from rfmpm.study import load_study

COARSE = Path(__file__).parents[2] / "robustness" / "coarse.toml"


@pytest.fixture(scope="session")
def study():
    """The smallest random slope; a realisation takes milliseconds."""
    return load_study(COARSE)
