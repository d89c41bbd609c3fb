"""What type checkers are asked about: `mypy --strict`."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import tabray


def nearest(path: Path, origins: NDArray[np.float64], directions: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return how far away what rays hit is."""
    scene: tabray.Scene = tabray.load(path, set={"ball.radius": 3})
    hits = scene.hits(origins, directions, fast=True)
    return np.where(hits.verdict == tabray.Verdict.HIT, hits.t, np.inf)


def picture(formula: str) -> NDArray[np.float64]:
    """Return the light of a surface, and write it."""
    image = tabray.surface(formula, box=1.5, a=0.5).render(samples=4, depth=True)
    image.save("surface.png")
    return image.array


def faults(text: str) -> list[tuple[int | None, str]]:
    """Return what is wrong with a scene."""
    try:
        tabray.parse(text)
    except tabray.SceneError as error:
        return [(fault.line, fault.message) for fault in error.faults]
    return []


def inside(points: list[list[float]]) -> list[int]:
    """Return which points are in a tetrahedron."""
    mesh = tabray.mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    found: list[int] = mesh.inside(points).tolist()
    return found


class Solid:
    """A mesh of another library."""

    vertices: NDArray[np.float64] = np.eye(3)
    faces: NDArray[np.int64] = np.arange(3).reshape(1, 3)


triangle: tabray.Mesh = tabray.mesh(Solid())
version: str = tabray.__version__
# A name that no sphere has is an error; without one, this comment is.
tabray.entities.sphere("ball", raduis=2)  # type: ignore[call-arg]
ball = tabray.scene([tabray.entities.material("red"), tabray.entities.sphere("ball", material="red", radius=2)])
proven: NDArray[np.bool_] = ball.verify(threads=2).proven
