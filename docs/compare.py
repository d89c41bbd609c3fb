"""Asks trimesh, Embree (embreex) and tabray what 1,000 rays of each of three kinds hit, and judges them by exact fractions.

pip install trimesh scipy rtree embreex ./src/python && python docs/compare.py
"""

from fractions import Fraction
from pathlib import Path

import numpy as np
import trimesh
from trimesh.ray.ray_pyembree import RayMeshIntersector as Embree
from trimesh.ray.ray_triangle import RayMeshIntersector as Trimesh

import tabray

COUNT = 1000
MESH = trimesh.load_mesh(Path(__file__).parents[1] / "scenes/models/knot.obj", process=False)
VERTICES, FACES = np.asarray(MESH.vertices), np.asarray(MESH.faces)
RANDOM = np.random.default_rng(11)


def anywhere():
    """Rays from a ball around the mesh through its box."""
    low, high = VERTICES.min(0), VERTICES.max(0)
    away = RANDOM.normal(size=(COUNT, 3))
    origins = (low + high) / 2 + away / np.linalg.norm(away, axis=1, keepdims=True) * np.linalg.norm(high - low)
    return origins, RANDOM.uniform(low, high, (COUNT, 3)) - origins


def at_edges():
    """Rays to vertices and to the middles of edges."""
    corners = VERTICES[FACES[RANDOM.integers(len(FACES), size=COUNT)]]
    aims = np.where(np.arange(COUNT)[:, None] % 2, corners[:, 0], (corners[:, 0] + corners[:, 1]) / 2)
    origins = aims + RANDOM.normal(size=(COUNT, 3))
    return origins, aims - origins


def in_planes():
    """Rays within about 1e-9 of the planes of triangles, to points of these."""
    corners = VERTICES[FACES[RANDOM.integers(len(FACES), size=COUNT)]]
    aims = (RANDOM.dirichlet([1, 1, 1], COUNT)[:, :, None] * corners).sum(1)
    along = corners[:, 1] - corners[:, 0]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    origins = aims + 2 * along + 1e-9 * RANDOM.normal(size=(COUNT, 3))
    return origins, aims - origins


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def may_hit(origin, direction):
    """Return the faces that plain numbers do not exclude, with room for all of their errors."""
    first, one, other = VERTICES[FACES[:, 0]], *(VERTICES[FACES[:, side]] - VERTICES[FACES[:, 0]] for side in (1, 2))
    normal = np.cross(direction, other)
    size, from_first = (one * normal).sum(1), origin - first
    with np.errstate(all="ignore"):
        u, v = (from_first * normal).sum(1) / size, (np.cross(from_first, one) @ direction) / size
    return np.flatnonzero((np.abs(size) < 1e-6) | ((u > -1e-3) & (v > -1e-3) & (u + v < 1 + 1e-3)))


def truth(origin, direction):
    """Return the faces that are hit first, and whether that is at an edge."""
    o, d = ([Fraction(x) for x in row] for row in (origin, direction))
    found = []
    for face in may_hit(origin, direction):
        a, b, c = ([Fraction(x) for x in VERTICES[corner]] for corner in FACES[face])
        normal = cross(minus(b, a), minus(c, a))
        slope = dot(normal, d)
        t = dot(normal, minus(a, o)) / slope if slope else 0
        if t > 0:
            at = [x + t * y for x, y in zip(o, d)]
            sides = [dot(normal, cross(minus(q, p), minus(at, p))) for p, q in ((a, b), (b, c), (c, a))]
            if min(sides) >= 0:
                found.append((t, int(face), min(sides) == 0))
    first = [hit for hit in found if hit[0] == min(found)[0]]
    return [face for _, face, _ in first], any(is_edge for _, _, is_edge in first)


def of_trimesh(origins, directions):
    _, rays, faces = Trimesh(MESH).intersects_location(origins, directions, multiple_hits=False)
    found = np.full(len(origins), -1)
    found[rays] = faces
    return found


for make in (anywhere, at_edges, in_planes):
    origins, directions = make()
    right = [truth(*ray) for ray in zip(origins, directions)]
    ours = tabray.mesh(VERTICES, FACES).hits(origins, directions)
    decided = np.isin(ours.verdict, [tabray.Verdict.HIT, tabray.Verdict.MISS])
    print(f"{make.__name__}: {sum(is_edge for _, is_edge in right)} rays hit an edge and are not judged; {ours}")
    answers = {
        "trimesh": of_trimesh(origins, directions),
        "Embree": Embree(MESH).intersects_first(origins, directions),
        "tabray": ours.face,
    }
    for name, found in answers.items():
        judged = [
            (faces, face)
            for (faces, is_edge), face, is_decided in zip(right, found, decided)
            if not is_edge and (name != "tabray" or is_decided)
        ]
        missed = sum(bool(faces) and face < 0 for faces, face in judged)
        invented = sum(not faces and face >= 0 for faces, face in judged)
        other = sum(bool(faces) and face >= 0 and face not in faces for faces, face in judged)
        print(f"  {name:8} of {len(judged)}: {missed} missed, {invented} invented, {other} another face")
