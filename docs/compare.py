"""Asks ray casters what rays of ten cases hit on meshes, and judges them by exact fractions.

pip install trimesh scipy rtree embreex mitsuba ./src/python && python docs/compare.py --rays 10000

Those that are not installed are left out, with a word. Prints a table in Markdown. Exits with status 1 if tabray is wrong.
"""

import argparse
import importlib
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np

import tabray

RANDOM = np.random.default_rng()
# Each case begins with this, so that its rays do not depend on those before.
SEED = 11
# Of so many rays that all casters agree about, fractions decide as well.
SAMPLE = 200
# Rays that are compared with all faces at one time.
TOGETHER = 256


def read_obj(path):
    """Return the vertices of an OBJ file, and its faces cut into triangles."""
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices = [[float(number) for number in line[1:4]] for line in lines if line[:1] == ["v"]]
    faces = [[int(word.split("/")[0]) - 1 for word in line[1:]] for line in lines if line[:1] == ["f"]]
    return np.array(vertices), np.array([[face[0], *pair] for face in faces for pair in zip(face[1:], face[2:])])


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def knot():
    return read_obj(Path(__file__).parents[1] / "scenes/models/knot.obj")


def corners_of(vertices, faces, count):
    return vertices[faces[RANDOM.integers(len(faces), size=count)]]


def in_triangles(corners):
    return (RANDOM.dirichlet([1, 1, 1], len(corners))[:, :, None] * corners).sum(1)


def through_box(vertices, count, away=1.0):
    """Rays through the box of a mesh, from a ball around it that is so many times as large."""
    low, high = vertices.min(0), vertices.max(0)
    size = np.linalg.norm(high - low)
    origins = (low + high) / 2 + away * size * unit(RANDOM.normal(size=(count, 3)))
    return origins, RANDOM.uniform(low, high, (count, 3)) - origins


def anywhere(count):
    """From around the mesh through its box"""
    vertices, faces = knot()
    return vertices, faces, *through_box(vertices, count)


def at_edges(count):
    """To vertices and to the middles of edges"""
    vertices, faces = knot()
    corners = corners_of(vertices, faces, count)
    aims = np.where(np.arange(count)[:, None] % 2, corners[:, 0], (corners[:, 0] + corners[:, 1]) / 2)
    origins = aims + RANDOM.normal(size=(count, 3))
    return vertices, faces, origins, aims - origins


def in_planes(count):
    """Within 1e-9 of the planes of triangles"""
    vertices, faces = knot()
    corners = corners_of(vertices, faces, count)
    aims, along = in_triangles(corners), unit(corners[:, 1] - corners[:, 0])
    origins = aims + 2 * along + 1e-9 * RANDOM.normal(size=(count, 3))
    return vertices, faces, origins, aims - origins


def from_surface(count):
    """From 1e-7 beside the surface, to all sides"""
    vertices, faces = knot()
    corners = corners_of(vertices, faces, count)
    normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    origins = in_triangles(corners) + 1e-7 * RANDOM.choice([-1, 1], (count, 1)) * normals
    return vertices, faces, origins, unit(RANDOM.normal(size=(count, 3)))


def far_from_zero(count):
    """On a mesh a million of its sizes away from the origin"""
    vertices, faces = knot()
    vertices = vertices + 1e6 * np.ptp(vertices, axis=0).max()
    return vertices, faces, *through_box(vertices, count)


def from_afar(count):
    """From a million sizes of the mesh away"""
    vertices, faces = knot()
    return vertices, faces, *through_box(vertices, count, 1e6)


def tiny(count):
    """On a mesh of the size 1e-7, with directions of any length"""
    vertices, faces = knot()
    vertices = 1e-7 / np.ptp(vertices, axis=0).max() * vertices
    origins, directions = through_box(vertices, count)
    return vertices, faces, origins, directions * 10.0 ** RANDOM.uniform(-6, 12, (count, 1))


def slivers(count):
    """On a fan of slivers, a ten-thousandth as wide as long"""
    turns = np.linspace(0, 0.1, 1001)
    rim = np.stack([np.cos(turns), np.sin(turns), 0.01 * np.cos(40 * turns)], 1)
    vertices = np.concatenate([[[0, 0, 0]], rim])
    faces = np.stack([np.zeros(1000, int), np.arange(1, 1001), np.arange(2, 1002)], 1)
    aims = in_triangles(corners_of(vertices, faces, count))
    origins = aims + unit(RANDOM.normal(size=(count, 3)))
    return vertices, faces, origins, aims - origins


def along_axes(count):
    """Along an axis, on a grid, one in 5 through its lines"""
    side = np.arange(25)
    x, y = (part.ravel() for part in np.meshgrid(side, side))
    vertices = np.stack([x, y, 0.25 * ((3 * x + 5 * y) % 7)], 1).astype(float)
    corner = (25 * side[:-1, None] + side[None, :-1]).ravel()
    halves = [[corner, corner + 1, corner + 26], [corner, corner + 26, corner + 25]]
    faces = np.concatenate([np.stack(half, 1) for half in halves])
    aims = RANDOM.uniform(0, 24, (count, 2))
    aims[::5] = np.round(aims[::5])
    return vertices, faces, np.c_[aims, np.full(count, 9.0)], np.tile([0.0, 0.0, -1.0], (count, 1))


def sheets(count):
    """On two sheets 1e-8 of their size apart"""
    vertices, faces = knot()
    corners = vertices[faces]
    normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    doubled = np.concatenate([corners, corners + 1e-8 * size * normals[:, None]]).reshape(-1, 3)
    return doubled, np.arange(len(doubled)).reshape(-1, 3), *through_box(vertices, count)


CASES = [
    anywhere, at_edges, in_planes, from_surface, far_from_zero, from_afar, tiny, slivers, along_axes, sheets,
]


class OfTrimesh:
    name, module = "trimesh", "trimesh"

    def ask(self, vertices, faces, origins, directions):
        from trimesh import Trimesh
        from trimesh.ray.ray_triangle import RayMeshIntersector

        caster = RayMeshIntersector(Trimesh(vertices, faces, process=False))
        face, t = np.full(len(origins), -1), np.full(len(origins), np.nan)
        # It keeps all pairs of a ray and a face that it may hit.
        for start in range(0, len(origins), 1000):
            some = slice(start, start + 1000)
            at, rays, hit = caster.intersects_location(origins[some], directions[some], multiple_hits=False)
            if len(rays):
                rays += start
                face[rays] = hit
                t[rays] = ((at - origins[rays]) * directions[rays]).sum(1) / (directions[rays] ** 2).sum(1)
        return face, t


class OfEmbree:
    name, module = "Embree", "embreex"

    def ask(self, vertices, faces, origins, directions):
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        scene = EmbreeScene(robust=True)
        TriangleMesh(scene, vertices.astype("f4"), faces.astype("i4"))
        lengths = np.linalg.norm(directions, axis=1)
        found = scene.run(origins.astype("f4"), (directions / lengths[:, None]).astype("f4"), query="INTERSECT", output=True)
        face = found["primID"].astype(int)
        return face, np.where(face >= 0, found["tfar"] / lengths, np.nan)


class OfOpen3d:
    name, module = "Open3D", "open3d"

    def ask(self, vertices, faces, origins, directions):
        import open3d

        scene = open3d.t.geometry.RaycastingScene()
        scene.add_triangles(vertices.astype("f4"), faces.astype("u4"))
        lengths = np.linalg.norm(directions, axis=1)
        rays = np.c_[origins, directions / lengths[:, None]].astype("f4")
        found = scene.cast_rays(open3d.core.Tensor(rays))
        face = found["primitive_ids"].numpy().astype("i8")
        face[face == scene.INVALID_ID] = -1
        return face, np.where(face >= 0, found["t_hit"].numpy() / lengths, np.nan)


class OfMitsuba:
    name, module = "Mitsuba", "mitsuba"

    def ask(self, vertices, faces, origins, directions):
        import mitsuba

        mitsuba.set_variant("scalar_rgb")
        mesh = mitsuba.Mesh("mesh", len(vertices), len(faces))
        values = mitsuba.traverse(mesh)
        values["vertex_positions"] = vertices.astype("f4").ravel()
        values["faces"] = faces.astype("u4").ravel()
        values.update()
        scene = mitsuba.load_dict({"type": "scene", "mesh": mesh})
        face, t = np.full(len(origins), -1), np.full(len(origins), np.nan)
        for ray, (origin, direction) in enumerate(zip(origins, directions)):
            length = float(np.linalg.norm(direction))
            found = scene.ray_intersect_preliminary(
                mitsuba.Ray3f(mitsuba.Point3f(*origin.tolist()), mitsuba.Vector3f(*(direction / length).tolist()))
            )
            if found.is_valid():
                face[ray], t[ray] = found.prim_index, found.t / length
        return face, t


class Ours:
    name, module = "tabray", "tabray"

    def ask(self, vertices, faces, origins, directions):
        hits = tabray.mesh(vertices, faces).hits(origins, directions)
        self.decided = np.isin(hits.verdict, [tabray.Verdict.HIT, tabray.Verdict.MISS])
        return hits.face, hits.t


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def may_hit(vertices, faces, origins, directions):
    """Return for each ray the faces that plain numbers do not exclude, with room for all of their errors."""
    first, one, other = vertices[faces[:, 0]], *(vertices[faces[:, side]] - vertices[faces[:, 0]] for side in (1, 2))
    directions = unit(directions)[:, None]
    normal = np.cross(directions, other)
    size, from_first = (one * normal).sum(2), origins[:, None] - first
    room = 1e-3 + 1e-12 * np.linalg.norm(from_first, axis=2) / np.sqrt(np.linalg.norm(np.cross(one, other), axis=1))
    with np.errstate(all="ignore"):
        u, v = (from_first * normal).sum(2) / size, (np.cross(from_first, one) * directions).sum(2) / size
    area = np.linalg.norm(one, axis=1) * np.linalg.norm(other, axis=1)
    return (np.abs(size) < 1e-6 * area) | ((u > -room) & (v > -room) & (u + v < 1 + room))


def whole(rows):
    """Return the numbers of rows as whole numbers, and the power of two by which they are multiplied."""
    ratios = [[float(number).as_integer_ratio() for number in row] for row in rows]
    scale = max(below for row in ratios for _, below in row)
    return [[above * (scale // below) for above, below in row] for row in ratios], scale


def truth(vertices, faces, origin, direction, near):
    """Return the faces that are hit first, the t, and whether that is at an edge."""
    near = np.flatnonzero(near)
    (o, *corners), scale = whole([origin, *vertices[faces[near]].reshape(-1, 3)])
    (d,), times = whole([direction])
    found = []
    for face, a, b, c in zip(near, corners[::3], corners[1::3], corners[2::3]):
        normal = cross(minus(b, a), minus(c, a))
        slope, height = dot(normal, d), dot(normal, minus(a, o))
        if slope < 0:
            slope, height = -slope, -height
        if slope and height > 0:
            # The vectors to the hit are multiplied by the slope, which is positive: only the signs count.
            to_hit = ([slope * x + height * y for x, y in zip(minus(o, p), d)] for p in (a, b, c))
            sides = [dot(normal, cross(minus(q, p), to)) for p, q, to in zip((a, b, c), (b, c, a), to_hit)]
            if min(sides) >= 0:
                found.append((Fraction(height * times, slope * scale), int(face), 0 in sides))
    first = [hit for hit in found if hit[0] == min(found)[0]]
    return [face for _, face, _ in first], first[0][0] if first else None, any(is_edge for _, _, is_edge in first)


def compare(case, casters, count):
    """Print the row of a case, and return the number of wrong answers of tabray."""
    global RANDOM
    RANDOM = np.random.default_rng(SEED)
    vertices, faces, origins, directions = case(count)
    answers = {caster.name: caster.ask(vertices, faces, origins, directions) for caster in casters}
    ours = next(caster for caster in casters if caster.name == "tabray")
    found = np.stack([face for face, _ in answers.values()])
    disputed = (found != found[0]).any(0) | ~ours.decided
    sample = RANDOM.permutation(np.flatnonzero(~disputed))[:SAMPLE]
    judged = np.concatenate([np.flatnonzero(disputed), sample])
    tally = {name: dict(missed=0, invented=0, later=0) for name in answers}
    at_edge = 0
    for start in range(0, len(judged), TOGETHER):
        rays = judged[start : start + TOGETHER]
        near = may_hit(vertices, faces, origins[rays], directions[rays])
        for ray, near in zip(rays, near):
            right, _, is_edge = truth(vertices, faces, origins[ray], directions[ray], near)
            if is_edge:
                at_edge += 1
                continue
            for name, (face, _) in answers.items():
                if name == "tabray" and not ours.decided[ray]:
                    continue
                kind = None
                if right and face[ray] < 0:
                    kind = "missed"
                elif not right and face[ray] >= 0:
                    kind = "invented"
                elif right and face[ray] not in right:
                    kind = "later"
                if kind:
                    tally[name][kind] += 1
    cells = []
    for name, (face, t) in answers.items():
        # Those of tabray lie between its bounds, which are some units in the last place wide.
        known = ours.decided & (face >= 0) & (face == answers["tabray"][0])
        error = np.abs(t - answers["tabray"][1])[known] / np.abs(answers["tabray"][1][known])
        worst = f"{error.max():.0e}" if len(error) and name != "tabray" else "-"
        cells.append(f"{tally[name]['missed']}, {tally[name]['invented']}, {tally[name]['later']}, {worst}")
    open_rays = int((~ours.decided).sum())
    print(f"| {case.__doc__} | {at_edge} | {open_rays} | {' | '.join(cells)} |", flush=True)
    return sum(tally["tabray"].values())


def main():
    parser = argparse.ArgumentParser(description="Asks ray casters what rays of ten cases hit, and judges them by fractions.")
    parser.add_argument("--rays", type=int, default=1000, help="the number of rays of each case")
    count = parser.parse_args().rays
    casters = []
    for caster in (OfTrimesh(), OfEmbree(), OfOpen3d(), OfMitsuba(), Ours()):
        try:
            importlib.import_module(caster.module)
            casters.append(caster)
        except ImportError:
            print(f"SKIPPED: {caster.name} is not installed", file=sys.stderr)
    print(f"| {count:,} rays a case | at an edge | undecided | {' | '.join(caster.name for caster in casters)} |")
    print("|---|---:|---:|" + "---:|" * len(casters))
    wrong = sum(compare(case, casters, count) for case in CASES)
    if wrong:
        sys.exit(f"tabray is wrong about {wrong} rays")


if __name__ == "__main__":
    main()
