#!/usr/bin/env python3
"""Compares light and noise with Mitsuba 3: python3 docs/mitsuba3.py PROGRAM [SCENE...]

pip install mitsuba, and set DRJIT_LIBLLVM_PATH to a libLLVM of version 16 or later for its second variant. Each scene
is written for Mitsuba by hand, below. Prints for each, at few pixels:

- Of blocks of 16 x 16 pixels, by 1024 samples of each program: how many have means within 1 % of each other, the median
  and the largest difference, and the median by noise: that of two halves of Mitsuba's samples, over the root of 2.
- The root of the mean square of the error of tabray with the scene's samples, in levels of an sRGB byte after the
  scene's exposure, against its 1024, and the CPU time of the whole program on one thread.
- The CPU time of Mitsuba's variants on one thread, compiled, to the same error against its 1024, as far as 64 samples
  tell by 1 / sqrt(samples).
"""

import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

import drjit
import mitsuba as mi
import numpy as np

ROOT = pathlib.Path(__file__).parents[1]
VARIANTS = ["scalar_rgb"] + ["llvm_ad_rgb"] * ("DRJIT_LIBLLVM_PATH" in os.environ)
# Samples of a pixel: of what is compared with, and of what Mitsuba's time is measured of.
MANY, FEW = 1024, 64
WORK = tempfile.TemporaryDirectory()

# Scenes that are not in the gallery.
FIREFLIES = """
look_at eye { pixeldim 112 112  position 0 1.2 6  target 0 0.7 0  angle 20  samples 64 }
background grey { colour 0.3 0.3 0.3 }
area_light key { location 3 3 2  target 0 0.8 0  dimensions 0.5 0.5  emissivity 60 60 60 }
metal steel { colour 0.75 0.76 0.78  roughness 0.3 }
cylinder can { material steel  base 0 0 0  height 1.4  radius 0.6 }
"""
ROOM = """
look_at eye { pixeldim 240 160  position 0 1.6 4.6  target 0.2 1.3 0  angle 62  samples 64  bounces 6 }
sky day { horizon 0.9 0.95 1  zenith 0.35 0.55 0.9  ground 0.3 0.28 0.25  lights yes }
sun s { direction -2 1.6 0.9  angle 0.53  emissivity 4 3.7 3.2 }
material white { diffuse 0.75 0.75 0.72 }
material wood  { diffuse 0.45 0.28 0.15 }
material red   { diffuse 0.6 0.08 0.06 }
metal chrome   { colour 0.9 0.9 0.9 }
box outer { material white  center 0 1.5 0  size 6.4 3.4 10.4 }
box inner { material white  center 0 1.5 0  size 6 3 10 }
box window { material white  center -3 1.6 -0.6  size 1 1.6 2.2 }
difference room { objects outer inner window }
box floor { material wood  center 0 0.01 0  size 6 0.02 10 }
box table { material wood  center 0.6 0.5 -0.8  size 1.6 0.9 1 }
sphere ball { material red  center 0.5 1.25 -0.7  radius 0.3 }
sphere mirror { material chrome  center 1.1 1.2 -0.9  radius 0.25 }
"""
SHOT = """
look_at eye { pixeldim 240 160  position 0 2.2 7.5  target 0 0.9 0  angle 34  samples 64 }
sky studio { horizon 0.35 0.36 0.38  zenith 0.2 0.21 0.22  ground 0.1 0.1 0.1  lights yes }
area_light key  { location -4 4 3  target 0 0.8 0  dimensions 2.5 2.5  emissivity 8 7.6 7 }
area_light rim  { location 4.5 3 -2  target 0 0.8 0  dimensions 1 3  emissivity 7 7.5 8.5 }
material paper { diffuse 0.7 0.7 0.7 }
metal gold  { colour 1 0.72 0.3  roughness 0.15 }
metal steel { colour 0.75 0.76 0.78  roughness 0.3 }
glass clear { index 1.5 }
plane table { material paper  normal 0 1 0  point 0 0 0 }
plane back  { material paper  normal 0 0 1  point 0 0 -4 }
mesh knot { material gold  file KNOT  smooth 1  scale 0.3 0.3 0.3  rotation 0 20 0  translation 0 1.065 0 }
sphere ball { material clear  center 1.7 0.6 0.9  radius 0.6 }
cylinder can { material steel  base -1.8 0 0.4  height 1.3  radius 0.5 }
"""


# Materials, lights and shapes of Mitsuba, from the numbers of a scene.


def T():
    return mi.ScalarTransform4f()


def rgb(*colour):
    return {"type": "rgb", "value": list(colour)}


def texture(values):
    texels = mi.Bitmap(values[::-1].astype(np.float32))
    return {"type": "bitmap", "raw": True, "wrap_mode": "clamp", "bitmap": texels}


def both(bsdf):
    return {"type": "twosided", "bsdf": bsdf}


def matt(*colour):
    return both({"type": "diffuse", "reflectance": rgb(*colour)})


def metal(*colour, roughness=0.01):
    """Without the light that facets mirror to each other, which tabray keeps."""
    return both({"type": "principled", "metallic": 1.0, "roughness": roughness, "base_color": rgb(*colour)})


def plastic(*colour):
    """Smooth: `roughplastic` loses light."""
    body = {"nonlinear": True, "int_ior": 1.5, "ext_ior": 1.0, "diffuse_reflectance": rgb(*colour)}
    return both({"type": "plastic", **body})


def passing(colour, tint, part):
    """A matt surface that lets a part through, tinted."""
    through = {"type": "thindielectric", "int_ior": 1.0, "ext_ior": 1.0, "specular_transmittance": tint}
    return {"type": "blendbsdf", "weight": part, "own": both({"type": "diffuse", "reflectance": colour}), "on": through}


def glass(index, left=None):
    """Glass with the fraction of light that is left after a length of 1."""
    medium = {}
    if left:
        medium = {"type": "homogeneous", "albedo": 0.0, "sigma_t": rgb(*(-np.log(left)))}
    return {"bsdf": {"type": "dielectric", "int_ior": index, "ext_ior": 1.0}} | ({"interior": medium} if medium else {})


def shape(kind, bsdf, to_world=None, **rest):
    look = bsdf if "bsdf" in bsdf and "type" not in bsdf else {"bsdf": bsdf}
    return {"type": kind, **look, **({"to_world": to_world} if to_world else {}), **rest}


def sphere(bsdf, center, radius):
    return shape("sphere", bsdf, center=center, radius=radius)


def rectangle(bsdf, point, across, up):
    """From a corner along two vectors."""
    point, across, up = (np.array(vector, float) for vector in (point, across, up))
    columns = [across / 2, up / 2, np.cross(across, up), point + (across + up) / 2]
    return shape("rectangle", bsdf, mi.ScalarTransform4f(np.vstack([np.array(columns).T, [0, 0, 0, 1]])))


def plane(bsdf, point, normal):
    return shape("rectangle", bsdf, T().look_at(point, np.add(point, normal), [0.3, 0.5, 0.7]).scale(1000))


def box(bsdf, center, size, turn=T):
    return shape("cube", bsdf, turn().translate(center).scale(np.array(size) / 2))


def cylinder(bsdf, base, height, radius):
    top = np.add(base, [0, height, 0])
    side = shape("cylinder", bsdf, p0=base, p1=list(top), radius=radius)
    ends = [shape("disk", bsdf, T().translate(end).rotate([1, 0, 0], -90).scale(radius)) for end in (base, list(top))]
    return [side, *ends]


def panel(location, target, size, light):
    """An area light, which shines on both sides."""
    # Along x where it faces up or down.
    up = [0, 1, 0] if abs(location[0] - target[0]) + abs(location[2] - target[2]) > 0 else [0, 0, -1]
    at = T().look_at(location, target, up)
    half = [size[0] / 2, size[1] / 2, 1]
    lamp = {"type": "area", "radiance": rgb(*light)}
    sides = [at.translate([0, 0, 1e-5]).scale(half), at.translate([0, 0, -1e-5]).rotate([0, 1, 0], 180).scale(half)]
    return [shape("rectangle", matt(0, 0, 0), side, emitter=lamp) for side in sides]


def sky(horizon, zenith, ground):
    height = np.sin(np.pi * (0.5 - (np.arange(1024) + 0.5) / 1024))[:, None]
    air = np.array(horizon) + height * np.subtract(zenith, horizon)
    rows = np.where(height < 0, ground, air)
    return {"type": "envmap", "bitmap": mi.Bitmap(np.repeat(rows[:, None, :], 16, 1).astype(np.float32))}


def sun(direction, angle, light):
    """A disc of the sun's angle, far away."""
    direction = np.array(direction) / np.linalg.norm(direction)
    half = np.radians(angle / 2)
    disc = T().look_at(list(1e4 * direction), [0, 0, 0], [0, 1, 0]).scale([1e4 * np.tan(half)] * 2 + [1])
    lamp = {"type": "area", "radiance": rgb(*(np.array(light) / np.sin(half) ** 2))}
    return shape("disk", matt(0, 0, 0), disc, emitter=lamp)


def surface(name, bsdf, place, us, vs, turn=T):
    """A surface by its points at u and v, with normals between them."""
    points = np.array([[place(u, v) for v in vs] for u in us])
    rows, columns = points.shape[:2]
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    halves = [[0, columns, columns + 1], [0, columns + 1, 1]]
    faces = np.concatenate([first[:, None] + np.array(half) for half in halves])
    path = pathlib.Path(WORK.name, f"{name}.ply")
    with path.open("w") as file:
        file.write(f"ply\nformat ascii 1.0\nelement vertex {rows * columns}\n")
        file.write("property float x\nproperty float y\nproperty float z\n")
        file.write(f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
        np.savetxt(file, points.reshape(-1, 3), "%.9g")
        np.savetxt(file, np.insert(faces, 0, 3, 1), "%d")
    return shape("ply", bsdf, turn(), filename=str(path))


def lathe(name, bsdf, points, base):
    """The natural spline through heights and radii, turned."""
    heights, radii = np.array(points, float).T
    widths, slopes = np.diff(heights), np.diff(radii) / np.diff(heights)
    count = len(heights)
    matrix, right = np.eye(count), np.zeros(count)
    for at in range(1, count - 1):
        matrix[at, at - 1 : at + 2] = [widths[at - 1], 2 * (widths[at - 1] + widths[at]), widths[at]]
        right[at] = 6 * (slopes[at] - slopes[at - 1])
    bends = np.linalg.solve(matrix, right)

    def radius(height):
        at = min(max(np.searchsorted(heights, height) - 1, 0), count - 2)
        width, (a, b) = widths[at], (heights[at + 1] - height, height - heights[at])
        cubic = (bends[at] * a**3 + bends[at + 1] * b**3) / (6 * width)
        low, high = [radii[end] / width - bends[end] * width / 6 for end in (at, at + 1)]
        return cubic + low * a + high * b

    def place(turn, height):
        return np.add(base, [radius(height) * np.cos(turn), height, radius(height) * np.sin(turn)])

    return surface(name, bsdf, place, np.linspace(0, 2 * np.pi, 361), np.linspace(0, heights[-1], 201))


def eye(position, target, angle):
    return {"type": "perspective", "fov": angle, "to_world": T().look_at(position, target, [0, 1, 0])}


def turned(translation, *angles):
    """A place of an object: turned about x, then y, then z, and moved."""

    def turn():
        at = T().translate(translation)
        for axis in (2, 1, 0):
            at = at.rotate(np.eye(3)[axis].tolist(), angles[axis])
        return at

    return turn


# The scenes. Each returns the camera and what it sees.


def coloured_walls(_):
    white, red, green = matt(0.75, 0.75, 0.73), matt(0.63, 0.06, 0.05), matt(0.13, 0.45, 0.10)
    return eye([0.013, 1.007, 3.85], [0, 1, 0], 39), [
        panel([0, 2.02, 0], [0, 0, 0], [0.6, 0.5], [17, 13, 8]),
        rectangle(white, [-1, 0, 1], [2, 0, 0], [0, 0, -2]),
        rectangle(white, [-1, 2, 0.25], [2, 0, 0], [0, 0, 0.75]),
        rectangle(white, [-1, 2, -1], [2, 0, 0], [0, 0, 0.75]),
        rectangle(white, [-1, 2, -0.25], [0.7, 0, 0], [0, 0, 0.5]),
        rectangle(white, [0.3, 2, -0.25], [0.7, 0, 0], [0, 0, 0.5]),
        rectangle(white, [-1, 0, -1], [2, 0, 0], [0, 2, 0]),
        rectangle(red, [-1, 0, 1], [0, 0, -2], [0, 2, 0]),
        rectangle(green, [1, 0, 1], [0, 0, -2], [0, 2, 0]),
        box(white, [0, 0, 0], [0.6, 1.2, 0.6], turned([-0.35, 0.6, -0.3], 0, 18, 0)),
        box(white, [0, 0, 0], [0.6, 0.6, 0.6], turned([0.34, 0.3, 0.36], 0, -17, 0)),
    ]


def window(program):
    plaster, clay = matt(0.8, 0.78, 0.74), matt(0.75, 0.4, 0.25)
    # The boards, as an image of the floor in even light.
    scene = (ROOT / "scenes/gallery/window.ray").read_text()
    blend = re.search("blend grain.*", scene)[0]
    boards = pathlib.Path(WORK.name, "boards")
    boards.with_suffix(".ray").write_text(
        f"""orthographic eye {{ pixeldim 1800 2100  position 0 5 0.5  target 0 0 0.5  up 0 0 -1  width 6  samples 4 }}
material wood {{ ambient 0.52 0.31 0.15 }}\nmaterial dark {{ ambient 0.30 0.16 0.07 }}\n{blend}
fplane floor {{ material wood  normal 0 1 0  point -3 0 4  xdir 1 0 0  dimensions 6 7  shader grain }}"""
    )
    subprocess.run([program, "render", "-q", boards.with_suffix(".ray"), "-o", boards.with_suffix(".exr")], check=True)
    texels = np.array(mi.Bitmap(str(boards.with_suffix(".exr"))))[:, :, :3]
    wood = both({"type": "diffuse", "reflectance": texture(texels)})
    return eye([2.2, 1.5, 3.4], [-0.35, 0.95, -0.6], 48), [
        panel([-3.3, 1.55, -0.6], [0, 1.55, -0.6], [2.6, 1.9], [5.2, 6, 7.2]),
        rectangle(wood, [-3, 0, 4], [6, 0, 0], [0, 0, -7]),
        rectangle(plaster, [-3, 2.6, -3], [6, 0, 0], [0, 0, 7]),
        rectangle(plaster, [-3, 0, -3], [6, 0, 0], [0, 2.6, 0]),
        rectangle(plaster, [-3, 0, 4], [6, 0, 0], [0, 2.6, 0]),
        rectangle(plaster, [3, 0, -3], [0, 0, 7], [0, 2.6, 0]),
        rectangle(plaster, [-3, 0, 4], [0, 0, -7], [0, 0.9, 0]),
        rectangle(plaster, [-3, 2.2, 4], [0, 0, -7], [0, 0.4, 0]),
        rectangle(plaster, [-3, 0.9, 4], [0, 0, -3.6], [0, 1.3, 0]),
        rectangle(plaster, [-3, 0.9, -1.6], [0, 0, -1.4], [0, 1.3, 0]),
        box(plaster, [-3, 1.55, -0.6], [0.06, 1.3, 0.06]),
        box(plaster, [-3, 1.55, -0.6], [0.06, 0.06, 2]),
        box(matt(0.2, 0.35, 0.5), [-0.9, 0.22, -2.2], [1.8, 0.44, 0.7]),
        lathe("jar", clay, [(0, 0.16), (0.2, 0.25), (0.4, 0.2), (0.55, 0.1), (0.62, 0.14)], [0.5, 0, -1.9]),
        sphere(clay, [-1.3, 0.62, -2.2], 0.18),
    ]


def studio(_):
    def ring(u, v):
        return [(0.52 + 0.2 * np.cos(v)) * np.cos(u), 0.2 * np.sin(v), (0.52 + 0.2 * np.cos(v)) * np.sin(u)]

    circle, brass = np.linspace(0, 2 * np.pi, 361), metal(0.95, 0.75, 0.38, roughness=0.18)
    return eye([2.6, 2.2, 5.2], [0, 0.72, 0], 30), [
        sky([0.12, 0.12, 0.14], [0.2, 0.2, 0.22], [0.1, 0.1, 0.1]),
        panel([-3, 4, 2], [0, 0.5, 0], [2, 2], [9, 8.8, 8.4]),
        panel([3.6, 2.2, -2], [0, 0.6, 0], [0.6, 3], [6, 6.5, 7.5]),
        plane(matt(0.72, 0.68, 0.6), [0, 0, 0], [0, 1, 0]),
        plane(matt(0.32, 0.36, 0.42), [0, 0, -3.4], [0, 0, 1]),
        sphere(glass(1.5, [0.75, 0.92, 0.85]), [-0.85, 0.62, 0.35], 0.62),
        surface("ring", brass, ring, circle, circle, turned([0.62, 0.66, -0.35], 62, 0, 24)),
        sphere(plastic(0.6, 0.06, 0.05), [0.55, 0.24, 0.85], 0.24),
    ]


def leaf(_):
    path = ROOT / "scenes/textures/leaf.png"
    picture = mi.Bitmap(str(path))
    encoded = np.array(picture) / 255
    light = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    colour = light[:, :, :3] * [0.9, 0.95, 0.8]

    tint = colour / np.maximum(colour.max(-1, keepdims=True), 1e-9)
    green = passing(texture(colour), texture(tint), 0.25)
    blade = {"type": "mask", "opacity": texture(encoded[:, :, 3:]), "bsdf": green}

    def card(place, scale):
        return shape("rectangle", blade, place().scale(scale).translate([0, 0.6, 0]).scale([0.5, 0.6, 1]))

    def stalk(turn, t):
        along = np.array([0.18 * np.cos(3 * t), 1.45, 0])
        along /= np.linalg.norm(along)
        side = np.array([along[1], -along[0], 0])
        middle = np.array([0.06 * np.sin(3 * t), 1.45 * t, -0.08])
        return middle + 0.022 * (np.cos(turn) * side + np.sin(turn) * np.array([0, 0, 1]))

    return eye([0, 1.1, 3.6], [0, 1.05, 0], 36), [
        sky([0.95, 0.9, 0.82], [0.25, 0.45, 0.85], [0.25, 0.3, 0.15]),
        sun([0.6, 0.9, 0.8], 0.53, [1.6, 1.5, 1.3]),
        plane(matt(0.3, 0.2, 0.12), [0, 0, 0], [0, 1, 0]),
        card(turned([-0.35, 0.75, 0], -12, 10, -28), 1),
        card(turned([0.3, 0.95, -0.2], 18, -25, 40), 0.8),
        card(turned([0.05, 1.35, -0.1], -30, 35, 10), 0.6),
        surface("stalk", matt(0.35, 0.3, 0.12), stalk, np.linspace(0, 2 * np.pi, 61), np.linspace(0, 1, 101)),
    ]


def lampshade(_):
    clay = matt(0.6, 0.3, 0.2)
    glow = {"type": "area", "radiance": rgb(26, 18, 9.5)}
    # tabray makes the brightest channel of a tint 1.
    cloth = passing(rgb(0.85, 0.72, 0.5), rgb(1, 0.72 / 0.85, 0.5 / 0.85), 0.35)
    return eye([0.9, 1.35, 4.4], [0.15, 0.85, 0], 32), [
        plane(matt(0.36, 0.2, 0.1), [0, 0, 0], [0, 1, 0]),
        plane(matt(0.45, 0.36, 0.3), [0, 0, -0.9], [0, 0, 1]),
        {**sphere(matt(0, 0, 0), [-0.35, 1.25, 0], 0.14), "emitter": glow},
        lathe("foot", clay, [(0, 0.28), (0.05, 0.25), (0.12, 0.1), (0.16, 0.04)], [-0.35, 0, 0]),
        cylinder(clay, [-0.35, 0.1, 0], 1.05, 0.035),
        lathe("shade", cloth, [(0, 0.52), (0.3, 0.42), (0.6, 0.3)], [-0.35, 0.95, 0]),
        lathe("cup", matt(0.82, 0.82, 0.8), [(0, 0.14), (0.06, 0.2), (0.2, 0.25), (0.34, 0.27)], [0.75, 0, 0.35]),
    ]


def three_rings(program):
    path = pathlib.Path(WORK.name, "rings.ply")
    scene = ROOT / "scenes/gallery/three-rings.ray"
    if not path.exists():
        subprocess.run([program, "mesh", "-q", scene, "rings", "-o", path, "--error", "0.003"], check=True)
    return eye([3.2, 3.0, 5.4], [0, 1.05, 0], 28), [
        sky([0.75, 0.77, 0.8], [0.85, 0.9, 1], [0.5, 0.48, 0.45]),
        panel([-3.5, 4.5, 3], [0, 1, 0], [2.5, 2.5], [4, 3.8, 3.5]),
        plane(matt(0.82, 0.82, 0.84), [0, 0, 0], [0, 1, 0]),
        shape("ply", plastic(0.85, 0.22, 0.16), filename=str(path)),
    ]


def fireflies(_):
    return eye([0, 1.2, 6], [0, 0.7, 0], 20), [
        {"type": "constant", "radiance": rgb(0.3, 0.3, 0.3)},
        panel([3, 3, 2], [0, 0.8, 0], [0.5, 0.5], [60, 60, 60]),
        cylinder(metal(0.75, 0.76, 0.78, roughness=0.3), [0, 0, 0], 1.4, 0.6),
    ]


def room(_):
    white, wood = matt(0.75, 0.75, 0.72), matt(0.45, 0.28, 0.15)
    # The wall of the window, in four parts; the others as slabs of 0.2.
    walls = [
        ([3.1, 1.5, 0], [0.2, 3.4, 10.4]),
        ([0, -0.1, 0], [6, 0.2, 10.4]),
        ([0, 3.1, 0], [6, 0.2, 10.4]),
        ([0, 1.5, 5.1], [6, 3, 0.2]),
        ([0, 1.5, -5.1], [6, 3, 0.2]),
        ([-3.1, 0.3, 0], [0.2, 1, 10.4]),
        ([-3.1, 2.8, 0], [0.2, 0.8, 10.4]),
        ([-3.1, 1.6, 2.85], [0.2, 1.6, 4.7]),
        ([-3.1, 1.6, -3.45], [0.2, 1.6, 3.5]),
    ]
    return eye([0, 1.6, 4.6], [0.2, 1.3, 0], 62), [
        sky([0.9, 0.95, 1], [0.35, 0.55, 0.9], [0.3, 0.28, 0.25]),
        sun([-2, 1.6, 0.9], 0.53, [4, 3.7, 3.2]),
        *(box(white, center, size) for center, size in walls),
        box(wood, [0, 0.01, 0], [6, 0.02, 10]),
        box(wood, [0.6, 0.5, -0.8], [1.6, 0.9, 1]),
        sphere(matt(0.6, 0.08, 0.06), [0.5, 1.25, -0.7], 0.3),
        sphere(metal(0.9, 0.9, 0.9), [1.1, 1.2, -0.9], 0.25),
    ]


def shot(_):
    knot = turned([0, 1.065, 0], 0, 20, 0)().scale(0.3)
    paper = matt(0.7, 0.7, 0.7)
    return eye([0, 2.2, 7.5], [0, 0.9, 0], 34), [
        sky([0.35, 0.36, 0.38], [0.2, 0.21, 0.22], [0.1, 0.1, 0.1]),
        panel([-4, 4, 3], [0, 0.8, 0], [2.5, 2.5], [8, 7.6, 7]),
        panel([4.5, 3, -2], [0, 0.8, 0], [1, 3], [7, 7.5, 8.5]),
        plane(paper, [0, 0, 0], [0, 1, 0]),
        plane(paper, [0, 0, -4], [0, 0, 1]),
        shape("obj", metal(1, 0.72, 0.3, roughness=0.15), knot, filename=str(ROOT / "scenes/models/knot.obj")),
        sphere(glass(1.5), [1.7, 0.6, 0.9], 0.6),
        cylinder(metal(0.75, 0.76, 0.78, roughness=0.3), [-1.8, 0, 0.4], 1.3, 0.5),
    ]


# The scene for Mitsuba, the text for tabray or None for that of the gallery, the size, `max_depth`, and what is set for
# tabray so that both have one model.
SCENES = {
    "coloured-walls": (coloured_walls, None, (64, 64), 8, []),
    "window": (window, None, (96, 64), 7, []),
    "studio": (studio, None, (96, 64), -1, ["eye.bounces=8"]),
    "leaf": (leaf, None, (64, 64), 5, []),
    "lampshade": (lampshade, None, (64, 64), 6, ["night.colour=0 0 0", "china.highlight=0"]),
    "three-rings": (three_rings, None, (64, 64), -1, ["eye.bounces=8", "coral.roughness=0"]),
    "fireflies": (fireflies, FIREFLIES, (64, 64), -1, []),
    "room": (room, ROOM, (96, 64), -1, ["eye.bounces=16"]),
    "shot": (shot, SHOT, (96, 64), -1, ["eye.bounces=8"]),
}


def read_pfm(path):
    with open(path, "rb") as file:
        assert file.readline() == b"PF\n"
        width, height = map(int, file.readline().split())
        kind = "<f4" if float(file.readline()) < 0 else ">f4"
        return np.frombuffer(file.read(), kind).reshape(height, width, 3)[::-1].astype(float)


def by_tabray(program, scene, size, sets, samples=None, threads=1):
    """Returns the picture, and the CPU time of the whole program."""
    picture = pathlib.Path(WORK.name, "picture.pfm")
    command = [program, "render", "-q", scene, "-o", picture, "--threads", str(threads)]
    command += ["--size", "{}x{}".format(*size)] + [word for setting in sets for word in ("--set", setting)]
    command += ["--samples", str(samples)] if samples else []
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run(command, check=True, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if run.stderr:
        print(run.stderr, file=sys.stderr)
    return read_pfm(picture), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def flat(parts):
    return [part for entry in parts for part in (entry if isinstance(entry, list) else [entry])]


def for_mitsuba(program, make, size, depth):
    camera, parts = make(program)
    film = {"type": "hdrfilm", "width": size[0], "height": size[1], "rfilter": {"type": "box"}, "pixel_format": "rgb"}
    has_media = any("interior" in part for part in flat(parts))
    kind = "volpath" if has_media or any("thindielectric" in str(part) for part in flat(parts)) else "path"
    scene = {"type": "scene", "integrator": {"type": kind, "max_depth": depth}, "sensor": {**camera, "film": film}}
    return mi.load_dict(scene | {f"part{number}": part for number, part in enumerate(flat(parts))})


def by_mitsuba(scene, samples, seed=0):
    """Returns the picture and the CPU time."""
    begin = time.process_time()
    picture = np.array(mi.render(scene, spp=samples, seed=seed), float)
    return picture, time.process_time() - begin


def blocks(picture):
    rows, columns = (side // 16 for side in picture.shape[:2])
    return picture[: 16 * rows, : 16 * columns].reshape(rows, 16, columns, 16, 3).mean((1, 3))


def apart(one, other):
    """Returns the differences of the means of blocks, relative to the channels' mean."""
    one, other = blocks(one), blocks(other)
    return np.abs(one - other).max(-1) / other.mean(-1)


def rms(picture, right, exposure):
    def levels(light):
        light = np.clip(2.0**exposure * light, 0, 1)
        return 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)

    return np.sqrt(np.mean((levels(picture) - levels(right)) ** 2))


def main():
    program, *names = sys.argv[1:]
    program = str(pathlib.Path(program).resolve())
    columns = ["scene", "within 1 %", "median", "largest", "noise", "levels", "tabray, s"]
    print("\t".join(columns + [f"{variant}, s" for variant in VARIANTS]))
    for name in names or SCENES:
        make, text, size, depth, sets = SCENES[name]
        path = ROOT / f"scenes/gallery/{name}.ray"
        if text:
            path = pathlib.Path(WORK.name, f"{name}.ray")
            path.write_text(text.replace("KNOT", str(ROOT / "scenes/models/knot.obj")))
        exposure = float((re.search(r"exposure +([\d.]+)", path.read_text()) or [0, 0])[1])
        many, _ = by_tabray(program, path, size, sets, MANY, os.cpu_count())
        few, seconds = by_tabray(program, path, size, sets)
        error = rms(few, many, exposure)
        times, references = [], []
        for variant in VARIANTS:
            mi.set_variant(variant)
            mi.set_log_level(mi.LogLevel.Error)
            drjit.set_thread_count(1)
            scene = for_mitsuba(program, make, size, depth)
            if variant.startswith("llvm"):
                # Compiles.
                by_mitsuba(scene, FEW)
            theirs, took = by_mitsuba(scene, FEW, 1)
            times.append((theirs, took))
        drjit.set_thread_count(os.cpu_count())
        references = [by_mitsuba(scene, FEW, seed)[0] for seed in range(2, 2 + MANY // FEW)]
        right = np.mean(references, 0)
        off = apart(many, right)
        noise = apart(np.mean(references[::2], 0), np.mean(references[1::2], 0)) / np.sqrt(2)
        needed = [took * (rms(theirs, right, exposure) / error) ** 2 for theirs, took in times]
        shares = [np.median(off), off.max(), np.median(noise)]
        row = [name, f"{100 * np.mean(off <= 0.01):.0f} %", *(f"{100 * share:.2f} %" for share in shares)]
        print("\t".join(row + [f"{number:.2f}" for number in (error, seconds, *needed)]), flush=True)


if __name__ == "__main__":
    main()
