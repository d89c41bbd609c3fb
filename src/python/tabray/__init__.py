"""A ray tracer in which a scene is data, and whose first hits can be proven.

>>> import tabray
>>> ball = tabray.parse("material red { }  sphere ball { material red  center 0 0 0  radius 2 }")
>>> hits = ball.hits([[0, 0, 9]], [[0, 0, -1]])
>>> hits.t[0], hits.verdict[0] == tabray.Verdict.HIT
(np.float64(7.0), np.True_)
"""

from __future__ import annotations

import math
from enum import IntEnum
from os import PathLike
from pathlib import Path
from typing import Mapping, Sequence

from . import entities
from ._errors import Fault, SceneError, SceneWarning
from ._native import Crossings, Hits, Image, Mesh, Proof, Scene, __version__, mesh
from ._native import read as _read
from ._native import read_mesh as _read_mesh
from ._places import NAME, Path as _Path, told_by
from ._text import Entities, Value, as_sets, as_toml

__all__ = [
    "Crossings",
    "Fault",
    "Hits",
    "Image",
    "Mesh",
    "Proof",
    "Scene",
    "SceneError",
    "SceneWarning",
    "Verdict",
    "__version__",
    "entities",
    "load",
    "mesh",
    "parse",
    "scene",
    "surface",
]

_MESHES = {".glb", ".gltf", ".obj", ".ply", ".stl"}


class Verdict(IntEnum):
    """What is known of the first hit of a ray."""

    MISS = 0
    """The ray hits nothing."""
    HIT = 1
    """The ray hits this object first."""
    EDGE = 2
    """The ray passes through the edge of this object, as far as 237 bits tell, and hits nothing else before it."""
    TIE = 3
    """The ray hits several objects first at once, as far as 237 bits tell."""
    UNDECIDED = 4
    """Neither is known, as where a ray touches a surface and does not cross it."""


def load(path: str | PathLike[str], *, set: Mapping[str, Value] | None = None) -> Scene:
    """Read a scene from a file. The file of a mesh becomes a scene without a camera, which can be asked about rays.

    `set` changes attributes and the values of `let`: `set={"ball.radius": 3, "n": 5}`.

    Raises SceneError with all faults of the scene, and FileNotFoundError if the file does not exist.
    """
    path = Path(path)
    if path.suffix.lower() in _MESHES:
        path.stat()
        if set:
            raise ValueError("the file of a mesh has no values to set")
        return _read_mesh(path)
    return _read(str(path), path.parent, path.read_bytes(), as_sets(set), True)


def parse(
    text: str,
    *,
    syntax: str | None = None,
    folder: str | PathLike[str] = "",
    set: Mapping[str, Value] | None = None,
) -> Scene:
    """Read a scene from its text, in the syntax of `.ray` files or in TOML; by default, its first line tells which.

    File names in the text are relative to `folder`. `syntax` is "ray" or "toml".
    """
    if syntax not in (None, "ray", "toml"):
        raise ValueError(f'there is no syntax "{syntax}": give "ray" or "toml"')
    name = "<text>" if syntax is None else f"<text>.{syntax}"
    return _read(name, Path(folder), text.encode(), as_sets(set), True)


def scene(entities: Entities, *, folder: str | PathLike[str] = "", set: Mapping[str, Value] | None = None) -> Scene:
    """Make a scene from dicts, laid out as in TOML: `{"sphere": {"ball": {"radius": 2, ...}}}`; or of a list of such dicts.

    `tabray.entities.sphere("ball", radius=2, ...)` makes a dict of one entity. The same tables check entities in dicts
    and in text, and messages name the faulty part of the dicts: `scene["sphere"]["ball"]["radius"]`.
    """
    return _of_dicts(entities, {}, Path(folder), set)


def _of_dicts(entities: Entities, names: Mapping[_Path, str], folder: Path, set: Mapping[str, Value] | None) -> Scene:
    places = as_toml(entities, names)
    with told_by(places):
        return _read(NAME, folder, bytes(places.text), as_sets(set), False)


def surface(
    formula: str,
    *,
    box: float | Sequence[float] = 2.0,
    colour: Sequence[float] = (0.85, 0.45, 0.2),
    width: int = 480,
    height: int = 360,
    **parameters: float,
) -> Scene:
    """Make a scene that shows the surface where a formula in x, y and z is 0, with a camera and lights that fit its box.

    `box` clips the surface: half the side of a cube around the origin, or six numbers, the low and the high corner. Other
    names are parameters of the formula: `surface("x^2 + y^2 + z^2 - r^2", r=1.5)`.
    """
    low_high = [-float(box)] * 3 + [float(box)] * 3 if isinstance(box, (int, float)) else [float(side) for side in box]
    if len(low_high) != 6:
        raise ValueError("`box` is half the side of a cube, or six numbers: the low and the high corner")
    low, high = low_high[:3], low_high[3:]
    middle = [(one + other) / 2 for one, other in zip(low, high)]
    radius = sum((other - one) ** 2 for one, other in zip(low, high)) ** 0.5 / 2

    # So far away that a ball around the box fits into the image, the lesser side of which is seen at this angle.
    angle = math.radians(38)
    lesser = math.atan(math.tan(angle / 2) * min(1, height / width))
    toward = (0.5, 0.41, 0.76)
    position = [centre + along * radius / math.sin(lesser) for centre, along in zip(middle, toward)]
    names: dict[_Path, str] = {
        **{(0, "let", name): name for name in parameters},
        (1, "look_at", "eye", "pixeldim"): "width and height",
        (1, "look_at", "eye", "pixeldim", 0): "width",
        (1, "look_at", "eye", "pixeldim", 1): "height",
        (3, "material", "paint"): "colour",
        (4, "implicit", "surface", "formula"): "formula",
        (4, "implicit", "surface", "box"): "box",
    }
    return _of_dicts(
        [
            {"let": dict(parameters)} if parameters else {},
            entities.look_at(
                "eye",
                pixeldim=[width, height],
                position=position,
                target=middle,
                angle=math.degrees(angle),
                samples=4,
                tone="neutral",
            ),
            entities.sky("sky", horizon=[0.75, 0.8, 0.85], zenith=[0.35, 0.45, 0.6]),
            entities.material("paint", ambient=[0.12 * part for part in colour], diffuse=list(colour)),
            entities.implicit("surface", material="paint", formula=formula, box=low_high),
            entities.sun("key", direction=[0.2, 1.0, 0.6], emissivity=[0.85, 0.83, 0.8]),
            entities.sun("fill", direction=[1.0, 0.1, 0.7], emissivity=[0.25, 0.27, 0.3]),
        ],
        names,
        Path(),
        None,
    )
