"""Meshes are arrays of vertices and faces, without a file."""

import copy
import pickle
from types import SimpleNamespace

import numpy as np
import pytest

import tabray

CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
CUBE = np.array(
    [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4]]
    + [[2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]
)


@pytest.mark.parametrize("integer", ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", ">i4"])
@pytest.mark.parametrize("number", ["f4", "f8", "i8"])
def test_arrays_are_taken_in_each_type(integer, number):
    cube = tabray.mesh(CORNERS.astype(number), CUBE.astype(integer))
    hits = cube.hits([[0.3, 0.2, 5], [0.3, 0.7, -5], [9, 9, 9]], [[0, 0, -1], [0, 0, 2], [0, 0, 1]])
    assert hits.face.tolist() == [2, 0, -1] and hits.t[:2].tolist() == [4, 2.5]
    assert cube.is_closed and cube.bounds == [[0, 0, 0], [1, 1, 1]]
    assert repr(cube) == "<tabray.Mesh of 12 triangles, closed>"


def test_an_object_with_vertices_and_faces_is_a_mesh():
    solid = SimpleNamespace(vertices=CORNERS, faces=CUBE)
    assert repr(tabray.mesh(solid)) == "<tabray.Mesh of 12 triangles, closed>"
    for wrong in [SimpleNamespace(vertices=CORNERS), CORNERS, None]:
        with pytest.raises(TypeError, match="is no mesh: give vertices and faces, or an object that has"):
            tabray.mesh(wrong)


def test_a_mesh_is_pickled_with_the_indices_of_its_faces():
    flat = np.concatenate([CUBE[:3], [[1, 1, 2]], CUBE[3:]])
    cube = tabray.mesh(CORNERS, flat)
    origins, directions = np.random.default_rng(2).normal(size=(2, 50, 3))
    hits = cube.hits(9 * origins, 0.5 - 9 * origins)
    assert (hits.face > 3).any()
    for other in [pickle.loads(pickle.dumps(cube)), copy.copy(cube), copy.deepcopy(cube)]:
        again = other.hits(9 * origins, 0.5 - 9 * origins)
        for name in ["verdict", "t", "t_low", "t_high", "face"]:
            assert np.array_equal(getattr(hits, name), getattr(again, name), equal_nan=True), name
        assert other.bounds == cube.bounds and other.is_closed


def test_indices_are_checked():
    for face, told in [(8, "corner 1 of face 3 is 8, which is not the index of a vertex: there are 8, 0 to 7"), (-1, "is -1, which")]:
        wrong = CUBE.copy()
        wrong[3, 1], wrong[5, 0] = face, 99
        with pytest.raises(IndexError, match=told):
            tabray.mesh(CORNERS, wrong)
    with pytest.raises(TypeError, match="`faces` has the type float64: give integers"):
        tabray.mesh(CORNERS, CUBE.astype(float))
    for vertices, faces in [(CORNERS[:, :2], CUBE), (CORNERS, CUBE[:, :2]), (CORNERS, CUBE[0])]:
        with pytest.raises(ValueError, match="has the shape"):
            tabray.mesh(vertices, faces)
    with pytest.raises(ValueError, match="vertex 3 is not finite"):
        tabray.mesh(np.where(np.arange(8)[:, None] == 3, np.nan, CORNERS), CUBE)
    for faces in [np.zeros((0, 3), int), [[0, 1, 1]]]:
        with pytest.raises(ValueError, match="no face with an area"):
            tabray.mesh(CORNERS, faces)


def ball(count):
    """Return the vertices and the faces of a ball, closed at its poles."""
    turns = np.linspace(0, 2 * np.pi, count, endpoint=False)
    heights = np.linspace(0, np.pi, count + 1)[1:-1]
    rings = [np.stack([np.cos(turns), np.sin(turns), 0 * turns], 1) * np.sin(height) for height in heights]
    rings = [ring + [0, 0, np.cos(height)] for ring, height in zip(rings, heights)]
    vertices = np.concatenate([[[0, 0, 1]], *rings, [[0, 0, -1]]])
    one, other = np.arange(count), (np.arange(count) + 1) % count
    faces = [np.stack([0 * one, 1 + one, 1 + other], 1)]
    for ring in range(len(rings) - 1):
        up, down = 1 + ring * count, 1 + (ring + 1) * count
        faces.append(np.stack([up + one, down + one, down + other], 1))
        faces.append(np.stack([up + one, down + other, up + other], 1))
    last = 1 + (len(rings) - 1) * count
    faces.append(np.stack([last + one, 0 * one + len(vertices) - 1, last + other], 1))
    return vertices, np.concatenate(faces)


def test_a_mesh_of_arrays_is_that_of_a_file(tmp_path):
    vertices, faces = ball(24)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()] + [f"f {a} {b} {c}" for a, b, c in 1 + faces]
    (tmp_path / "ball.obj").write_text("\n".join(lines))
    random = np.random.default_rng(3)
    origins = random.normal(size=(500, 3)) * 3
    directions = random.normal(size=(500, 3)) / 2 - origins
    ours = tabray.mesh(vertices, faces).hits(origins, directions)
    of_file = tabray.load(tmp_path / "ball.obj").hits(origins, directions)
    for name in ["verdict", "t", "t_low", "t_high", "face"]:
        assert np.array_equal(getattr(ours, name), getattr(of_file, name), equal_nan=True), name
    assert (ours.verdict == 1).sum() > 50


def test_points_are_inside_by_proven_crossings():
    cube = tabray.mesh(CORNERS, CUBE)
    points = [[0.5, 0.5, 0.5], [1e-15, 0.5, 0.5], [-1e-15, 0.5, 0.5], [1, 0.5, 0.25], [0, 0, 0], [3, 0.5, 0.5]]
    assert cube.inside(points).tolist() == [1, 1, 0, -1, -1, 0]
    turned = CUBE.copy()
    turned[::3] = turned[::3, ::-1]
    assert tabray.mesh(CORNERS, turned).inside(points).tolist() == [1, 1, 0, -1, -1, 0]
    with pytest.raises(ValueError, match="the mesh is open at 3 edges"):
        tabray.mesh(CORNERS, CUBE[1:]).inside(points)
    with pytest.raises(ValueError, match="point 1 is not finite"):
        cube.inside([[0, 0, 0], [np.inf, 0, 0]])


def test_each_crossing_of_a_ray_has_its_face_and_its_side():
    cube = tabray.mesh(CORNERS, CUBE)
    crossings = cube.crossings([[0.3, 0.2, 5], [9, 9, 9], [0.3, 0.2, 0.5]], [0, 0, -2])
    assert crossings.ray.tolist() == [0, 0, 0, 1, 2, 2]
    miss, hit = tabray.Verdict.MISS, tabray.Verdict.HIT
    assert crossings.verdict.tolist() == [hit, hit, miss, miss, hit, miss]
    assert crossings.enters.tolist() == [1, 0, -1, -1, 0, -1]
    assert crossings.face.tolist() == [2, 0, -1, -1, 0, -1]
    assert crossings.t[crossings.verdict == hit].tolist() == [2, 2.5, 0.25]
    assert isinstance(crossings, tabray.Hits) and repr(crossings) == "<tabray.Crossings of 3 rays: 3 crossings>"
    before = cube.crossings([0.3, 0.2, 5], [0, 0, -2], 2.25)
    assert before.verdict.tolist() == [hit, miss]
    through_an_edge = cube.crossings([0.5, 5, 1], [0, -1, 0])
    assert through_an_edge.verdict[-1] in (miss, tabray.Verdict.UNDECIDED) and (through_an_edge.ray == 0).all()


def two_cubes(low, side, inward):
    """Return a cube of side 3, and another one, turned inward or not."""
    other = CUBE[:, ::-1] if inward else CUBE
    return tabray.mesh(np.concatenate([3 * CORNERS, low + side * CORNERS]), np.concatenate([CUBE, 8 + other]))


def test_bodies_that_overlap_are_one_and_a_body_turned_inward_is_a_cavity():
    assert two_cubes(2, 3, False).inside([[1, 1, 1], [2.5, 2.5, 2.5], [4, 4, 4], [5.5, 5, 5]]).tolist() == [1, 1, 1, 0]
    for inward in [False, True]:
        assert two_cubes(1, 1, inward).inside([[1.5, 1.5, 1.5], [0.5, 0.5, 0.5]]).tolist() == [not inward, 1]


def test_faults_of_the_file_of_a_mesh_show_no_scene(tmp_path):
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
    with pytest.raises(tabray.SceneError) as raised:
        tabray.load(broken)
    told = str(raised.value)
    assert "`broken.obj`, line 4: there is no vertex 9" in told
    assert "material" not in told and "pixeldim" not in told, told
    assert all(fault.line is None and fault.span is None for fault in raised.value.faults)
    flat = tmp_path / "flat.obj"
    flat.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n")
    with pytest.warns(tabray.SceneWarning) as warned:
        tabray.load(flat)
    for warning in warned:
        assert "material" not in str(warning.message)


def test_rays_in_the_planes_of_thin_triangles_miss_nothing():
    # Two triangles that share a diagonal, a millionth wide: a ray through the diagonal hits, through whichever.
    width = 1e-6
    vertices = [[0, 0, 0], [1, 0, 0], [1, width, 0], [0, width, 0]]
    sheet = tabray.mesh(vertices, [[0, 1, 2], [0, 2, 3]])
    along = np.linspace(0.01, 0.99, 99)
    at = np.stack([along, along * width, np.zeros(99)], 1)
    hits = sheet.hits(at + [0.3, 0.2, 5], np.array([-0.3, -0.2, -5]))
    assert np.isin(hits.verdict, [tabray.Verdict.HIT, tabray.Verdict.EDGE, tabray.Verdict.UNDECIDED]).all()
    assert sheet.occluded(at + [0.3, 0.2, 5], np.array([-0.3, -0.2, -5])).all()
