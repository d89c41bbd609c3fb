"""The entity types of the scene language: a function for each, which makes the dict of one entity."""

from typing import Any, Callable, Sequence, Union

import numpy as np
from numpy.typing import NDArray

Entity = dict[str, dict[str, dict[str, Any]]]

_Numbers = Union[float, str, np.number[Any], Sequence[Any], NDArray[Any], None]
_Words = Union[str, Sequence[str], None]
_Word = Union[str, int, None]
_Formula = Union[str, float, None]
_Truth = Union[bool, str, None]

__all__: list[str]

# The entity types of plugins that this file does not know.
def __getattr__(name: str) -> Callable[..., Entity]: ...

def angular(
    name: str,
    /,
    *,
    frequency: _Numbers = None,
    phase: _Numbers = None,
    brightness: _Numbers = None,
) -> Entity: ...

def area_light(
    name: str,
    /,
    *,
    location: _Numbers = None,
    emissivity: _Numbers = None,
    target: _Numbers = None,
    dimensions: _Numbers = None,
    radius: _Numbers = None,
    up: _Numbers = None,
    visible: _Truth = None,
) -> Entity: ...

def axes(
    name: str,
    /,
    *,
    material: _Words = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    to: _Numbers = None,
    from_: _Numbers = None,
    ticks: _Numbers = None,
    radius: _Numbers = None,
    numbers: _Numbers = None,
    xcolour: _Numbers = None,
    xcolor: _Numbers = None,
    ycolour: _Numbers = None,
    ycolor: _Numbers = None,
    zcolour: _Numbers = None,
    zcolor: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def background(
    name: str,
    /,
    *,
    colour: _Numbers = None,
    color: _Numbers = None,
    lights: _Truth = None,
) -> Entity: ...

def blend(
    name: str,
    /,
    *,
    by: _Formula = None,
    altmaterial: _Words = None,
) -> Entity: ...

def box(
    name: str,
    /,
    *,
    material: _Words = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    size: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def bumps(
    name: str,
    /,
    *,
    height: _Formula = None,
    shader: _Words = None,
) -> Entity: ...

def camera(
    name: str,
    /,
    *,
    pixeldim: _Numbers = None,
    pixel_dim: _Numbers = None,
    worlddim: _Numbers = None,
    world_dim: _Numbers = None,
    viewpoint: _Numbers = None,
    view_point: _Numbers = None,
    samples: _Numbers = None,
    accuracy: _Word = None,
    rules: _Word = None,
    exposure: _Numbers = None,
    tone: _Word = None,
    transfer: _Word = None,
    bounces: _Numbers = None,
    alpha: _Truth = None,
) -> Entity: ...

def capsule(
    name: str,
    /,
    *,
    material: _Words = None,
    base: _Numbers = None,
    direction: _Numbers = None,
    height: _Numbers = None,
    radius: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def checker(
    name: str,
    /,
    *,
    squares: _Numbers = None,
    altmaterial: _Words = None,
) -> Entity: ...

def cylinder(
    name: str,
    /,
    *,
    material: _Words = None,
    base: _Numbers = None,
    direction: _Numbers = None,
    height: _Numbers = None,
    radius: _Numbers = None,
    open: _Truth = None,
    shader: _Words = None,
) -> Entity: ...

def difference(
    name: str,
    /,
    *,
    material: _Words = None,
    objects: _Words = None,
) -> Entity: ...

def disc(
    name: str,
    /,
    *,
    material: _Words = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    normal: _Numbers = None,
    radius: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def ellipsoid(
    name: str,
    /,
    *,
    material: _Words = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    radius: _Numbers = None,
    scale: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def environment(
    name: str,
    /,
    *,
    texture: _Words = None,
    brightness: _Numbers = None,
    lights: _Truth = None,
) -> Entity: ...

def faces(
    name: str,
    /,
    *,
    colours: _Numbers = None,
    colors: _Numbers = None,
) -> Entity: ...

def fisheye(
    name: str,
    /,
    *,
    pixeldim: _Numbers = None,
    pixel_dim: _Numbers = None,
    position: _Numbers = None,
    target: _Numbers = None,
    up: _Numbers = None,
    angle: _Numbers = None,
    samples: _Numbers = None,
    accuracy: _Word = None,
    rules: _Word = None,
    exposure: _Numbers = None,
    tone: _Word = None,
    transfer: _Word = None,
    bounces: _Numbers = None,
    alpha: _Truth = None,
) -> Entity: ...

def formula(
    name: str,
    /,
    *,
    ambient: _Formula = None,
    diffuse: _Formula = None,
    specular: _Formula = None,
) -> Entity: ...

def fplane(
    name: str,
    /,
    *,
    material: _Words = None,
    normal: _Numbers = None,
    point: _Numbers = None,
    dimensions: _Numbers = None,
    xdir: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def glass(
    name: str,
    /,
    *,
    index: _Numbers = None,
    colour: _Numbers = None,
    color: _Numbers = None,
    transparency: _Numbers = None,
    attenuation: _Numbers = None,
    at: _Numbers = None,
    shininess: _Numbers = None,
    roughness: _Numbers = None,
) -> Entity: ...

def heart(
    name: str,
    /,
    *,
    material: _Words = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    size: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def image(
    name: str,
    /,
    *,
    texture: _Words = None,
    repeat: _Numbers = None,
    smooth: _Truth = None,
) -> Entity: ...

def implicit(
    name: str,
    /,
    *,
    material: _Words = None,
    formula: _Formula = None,
    where: _Formula = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    box: _Numbers = None,
    clip: _Words = None,
    capped: _Truth = None,
    shader: _Words = None,
) -> Entity: ...

def intersection(
    name: str,
    /,
    *,
    material: _Words = None,
    objects: _Words = None,
) -> Entity: ...

def lathe(
    name: str,
    /,
    *,
    material: _Words = None,
    points: _Numbers = None,
    direction: _Numbers = None,
    base: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def light(
    name: str,
    /,
    *,
    location: _Numbers = None,
    emissivity: _Numbers = None,
    size: _Numbers = None,
    falloff: _Word = None,
    at: _Numbers = None,
) -> Entity: ...

def lines(
    name: str,
    /,
    *,
    formula: _Formula = None,
    spacing: _Numbers = None,
    width: _Numbers = None,
    pixels: _Numbers = None,
    altmaterial: _Words = None,
    shader: _Words = None,
) -> Entity: ...

def look_at(
    name: str,
    /,
    *,
    pixeldim: _Numbers = None,
    pixel_dim: _Numbers = None,
    position: _Numbers = None,
    target: _Numbers = None,
    up: _Numbers = None,
    angle: _Numbers = None,
    samples: _Numbers = None,
    accuracy: _Word = None,
    rules: _Word = None,
    exposure: _Numbers = None,
    tone: _Word = None,
    transfer: _Word = None,
    bounces: _Numbers = None,
    alpha: _Truth = None,
) -> Entity: ...

def material(
    name: str,
    /,
    *,
    ambient: _Numbers = None,
    diffuse: _Numbers = None,
    specular: _Numbers = None,
    shininess: _Numbers = None,
    transparency: _Numbers = None,
    emission: _Numbers = None,
    highlight: _Numbers = None,
) -> Entity: ...

def mesh(
    name: str,
    /,
    *,
    material: _Words = None,
    file: _Words = None,
    scale: _Numbers = None,
    rotation: _Numbers = None,
    translation: _Numbers = None,
    smooth: _Numbers = None,
    crease: _Numbers = None,
    normals: _Word = None,
    materials: _Word = None,
    sides: _Word = None,
    shader: _Words = None,
) -> Entity: ...

def metal(
    name: str,
    /,
    *,
    colour: _Numbers = None,
    color: _Numbers = None,
    shininess: _Numbers = None,
    roughness: _Numbers = None,
    emission: _Numbers = None,
) -> Entity: ...

def normals(
    name: str,
    /,
    *,
    texture: _Words = None,
    repeat: _Numbers = None,
    strength: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def orthographic(
    name: str,
    /,
    *,
    pixeldim: _Numbers = None,
    pixel_dim: _Numbers = None,
    position: _Numbers = None,
    target: _Numbers = None,
    up: _Numbers = None,
    width: _Numbers = None,
    samples: _Numbers = None,
    accuracy: _Word = None,
    rules: _Word = None,
    exposure: _Numbers = None,
    tone: _Word = None,
    transfer: _Word = None,
    bounces: _Numbers = None,
    alpha: _Truth = None,
) -> Entity: ...

def parametric(
    name: str,
    /,
    *,
    material: _Words = None,
    x: _Formula = None,
    y: _Formula = None,
    z: _Formula = None,
    u: _Numbers = None,
    v: _Numbers = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def pfplane(
    name: str,
    /,
    *,
    material: _Words = None,
    normal: _Numbers = None,
    point: _Numbers = None,
    shader: _Word = None,
    dimensions: _Numbers = None,
    xdir: _Numbers = None,
) -> Entity: ...

def place(
    name: str,
    /,
    *,
    material: _Words = None,
    object: _Words = None,
    scale: _Numbers = None,
    rotation: _Numbers = None,
    translation: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def plane(
    name: str,
    /,
    *,
    material: _Words = None,
    normal: _Numbers = None,
    point: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def plastic(
    name: str,
    /,
    *,
    colour: _Numbers = None,
    color: _Numbers = None,
    index: _Numbers = None,
    roughness: _Numbers = None,
    shininess: _Numbers = None,
    emission: _Numbers = None,
) -> Entity: ...

def polygon(
    name: str,
    /,
    *,
    material: _Words = None,
    points: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def pplane(
    name: str,
    /,
    *,
    material: _Words = None,
    normal: _Numbers = None,
    point: _Numbers = None,
    shader: _Word = None,
) -> Entity: ...

def prism(
    name: str,
    /,
    *,
    material: _Words = None,
    points: _Numbers = None,
    base: _Numbers = None,
    height: _Numbers = None,
    open: _Truth = None,
    shader: _Words = None,
) -> Entity: ...

def projector(
    name: str,
    /,
    *,
    location: _Numbers = None,
    emissivity: _Numbers = None,
    size: _Numbers = None,
    normal: _Numbers = None,
    point: _Numbers = None,
    dimensions: _Numbers = None,
    xdir: _Numbers = None,
    texname: _Words = None,
    mode: _Numbers = None,
    falloff: _Word = None,
    at: _Numbers = None,
) -> Entity: ...

def psphere(
    name: str,
    /,
    *,
    material: _Words = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    radius: _Numbers = None,
    shader: _Word = None,
) -> Entity: ...

def quadric(
    name: str,
    /,
    *,
    material: _Words = None,
    coefficients: _Numbers = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    box: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def rainbow(
    name: str,
    /,
    *,
    frequency: _Numbers = None,
    phase: _Numbers = None,
    brightness: _Numbers = None,
    on: _Word = None,
) -> Entity: ...

def rainbow_tiles(
    name: str,
    /,
    *,
    width: _Numbers = None,
    frequency: _Numbers = None,
    phase: _Numbers = None,
    brightness: _Numbers = None,
) -> Entity: ...

def ramp(
    name: str,
    /,
    *,
    by: _Formula = None,
    from_: _Numbers = None,
    to: _Numbers = None,
    colours: _Numbers = None,
    colors: _Numbers = None,
) -> Entity: ...

def revsurf(
    name: str,
    /,
    *,
    material: _Words = None,
    surfer: _Word = None,
    profile: _Formula = None,
    direction: _Numbers = None,
    base: _Numbers = None,
    height: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def sides(
    name: str,
    /,
    *,
    back: _Words = None,
) -> Entity: ...

def sky(
    name: str,
    /,
    *,
    horizon: _Numbers = None,
    zenith: _Numbers = None,
    ground: _Numbers = None,
    up: _Numbers = None,
    lights: _Truth = None,
) -> Entity: ...

def sphere(
    name: str,
    /,
    *,
    material: _Words = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    radius: _Numbers = None,
    scale: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def sphere_light(
    name: str,
    /,
    *,
    location: _Numbers = None,
    emissivity: _Numbers = None,
    radius: _Numbers = None,
    visible: _Truth = None,
) -> Entity: ...

def spotlight(
    name: str,
    /,
    *,
    location: _Numbers = None,
    emissivity: _Numbers = None,
    size: _Numbers = None,
    point: _Numbers = None,
    theta: _Numbers = None,
    falloff: _Word = None,
    at: _Numbers = None,
) -> Entity: ...

def sun(
    name: str,
    /,
    *,
    direction: _Numbers = None,
    emissivity: _Numbers = None,
    angle: _Numbers = None,
) -> Entity: ...

def texplane(
    name: str,
    /,
    *,
    material: _Words = None,
    normal: _Numbers = None,
    point: _Numbers = None,
    dimensions: _Numbers = None,
    xdir: _Numbers = None,
    texname: _Words = None,
    mode: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def texture(
    name: str,
    /,
    *,
    filename: _Words = None,
    cutout: _Truth = None,
    coverage: _Truth = None,
) -> Entity: ...

def thin_lens(
    name: str,
    /,
    *,
    pixeldim: _Numbers = None,
    pixel_dim: _Numbers = None,
    position: _Numbers = None,
    target: _Numbers = None,
    up: _Numbers = None,
    angle: _Numbers = None,
    aperture: _Numbers = None,
    focus: _Numbers = None,
    samples: _Numbers = None,
    accuracy: _Word = None,
    rules: _Word = None,
    exposure: _Numbers = None,
    tone: _Word = None,
    transfer: _Word = None,
    bounces: _Numbers = None,
    alpha: _Truth = None,
) -> Entity: ...

def tiled_plane(
    name: str,
    /,
    *,
    material: _Words = None,
    normal: _Numbers = None,
    point: _Numbers = None,
    dimensions: _Numbers = None,
    xdir: _Numbers = None,
    altmaterial: _Words = None,
    origin: _Numbers = None,
    altmirror: _Truth = None,
    shader: _Words = None,
) -> Entity: ...

def tiles(
    name: str,
    /,
    *,
    width: _Numbers = None,
    on: _Word = None,
) -> Entity: ...

def torus(
    name: str,
    /,
    *,
    material: _Words = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    direction: _Numbers = None,
    radius: _Numbers = None,
    tube: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def triangle(
    name: str,
    /,
    *,
    material: _Words = None,
    vertex1: _Numbers = None,
    vertex2: _Numbers = None,
    vertex3: _Numbers = None,
    normal: _Numbers = None,
    point: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def tube(
    name: str,
    /,
    *,
    material: _Words = None,
    x: _Formula = None,
    y: _Formula = None,
    z: _Formula = None,
    t: _Numbers = None,
    radius: _Numbers = None,
    center: _Numbers = None,
    centre: _Numbers = None,
    shader: _Words = None,
) -> Entity: ...

def union(
    name: str,
    /,
    *,
    material: _Words = None,
    objects: _Words = None,
) -> Entity: ...
