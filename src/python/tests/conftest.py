"""Tests of the installed package, on the scenes of the repository."""

from pathlib import Path

import pytest

SCENES = Path(__file__).parents[3] / "scenes"


@pytest.fixture
def scenes() -> Path:
    """The folder of the scenes."""
    return SCENES
