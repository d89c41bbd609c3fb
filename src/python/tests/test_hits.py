"""What rays hit is an array for each thing that is known, the same for any layout, precision and number of threads."""

import copy
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from fractions import Fraction

import numpy as np
import pytest

import tabray

BALLS = """material red { }
sphere near { material red  center 0 0 0  radius 2 }
sphere far  { material red  center 0 0 -9  radius 3 }
"""


@pytest.fixture
def balls():
    return tabray.parse(BALLS)


def rays(count, seed=1):
    random = np.random.default_rng(seed)
    origins = random.normal(size=(count, 3)) * 8
    return origins, random.normal(size=(count, 3)) * 3 - origins


def test_hits_are_enclosed():
    hits = tabray.parse(BALLS).hits([[0, 0, 9], [0, 9, 9]], [[0, 0, -2], [0, 0, -2]])
    assert hits.verdict.tolist() == [tabray.Verdict.HIT, tabray.Verdict.MISS]
    assert hits.object.tolist() == [0, -1] and hits.object.dtype == np.int32
    assert hits.t[0] == 3.5 and hits.t_low[0] <= 3.5 <= hits.t_high[0] and hits.distance[0] == 7
    assert hits.point[0].tolist() == [0, 0, 2] and hits.normal[0].tolist() == [0, 0, 1]
    assert np.isnan(hits.t[1]) and np.isnan(hits.point[1]).all()
    assert len(hits) == 2 and repr(hits) == "<tabray.Hits of 2 rays: 1 miss, 1 hit>"


def test_bounds_hold_the_root_by_exact_fractions(balls):
    origins, directions = rays(300)
    hits = balls.hits(origins, directions)
    assert (hits.verdict == 1).sum() > 20
    centres, squares = [[0, 0, 0], [0, 0, -9]], [4, 9]

    def value(ray, t):
        """The equation of the object that is hit, at a t of the ray, in fractions."""
        o, d, t = [[Fraction(x) for x in row] for row in (origins[ray], directions[ray])] + [Fraction(t)]
        index = hits.object[ray]
        at = [a + t * b - c for a, b, c in zip(o, d, centres[index])]
        return sum(x * x for x in at) - squares[index]

    for ray in np.flatnonzero(hits.verdict == 1):
        assert value(ray, hits.t_low[ray]) * value(ray, hits.t_high[ray]) <= 0
        assert hits.t_low[ray] <= hits.t[ray] <= hits.t_high[ray]


def test_layouts_and_precisions_are_taken_as_they_are(balls):
    origins, directions = rays(1000)
    hits = balls.hits(origins, directions)
    wide = np.zeros((1000, 8))
    wide[:, ::2][:, :3] = origins
    for layout in [np.asfortranarray(origins), wide[:, ::2][:, :3], origins[::-1][::-1], origins.astype(">f8")]:
        other = balls.hits(layout, directions)
        assert np.array_equal(hits.t, other.t, equal_nan=True) and np.array_equal(hits.verdict, other.verdict)
    single = [origins.astype(np.float32), directions.astype(np.float32)]
    of_single, of_double = balls.hits(*single), balls.hits(*[array.astype(np.float64) for array in single])
    assert np.array_equal(of_single.t, of_double.t, equal_nan=True)
    packed = np.zeros(10, dtype=[("tag", "u1"), ("origin", "f8", 3)])
    assert len(balls.hits(packed["origin"], [0, 0, 1])) == 10


def test_one_row_stands_for_all(balls):
    _, directions = rays(50)
    hits = balls.hits([0, 0, 20], directions)
    repeated = balls.hits(np.tile([0.0, 0, 20], (50, 1)), directions)
    assert np.array_equal(hits.t, repeated.t, equal_nan=True)
    assert len(balls.hits([0, 0, 9], [0, 0, -1])) == 1
    assert len(balls.hits(np.zeros((0, 3)), np.zeros((0, 3)))) == 0


def test_wrong_arrays_are_told_with_what_would_be_right(balls):
    for origins, directions, told in [
        (np.zeros((5, 2)), np.ones((5, 3)), r"`origins` has the shape \(5, 2\): give \(n, 3\)"),
        (np.zeros((5, 3)), np.ones(4), r"`directions` has the shape \(4,\)"),
        (np.zeros((5, 3)), np.ones((4, 3)), "5 origins and 4 directions"),
        (np.zeros((5, 3)), np.eye(5, 3), "the direction of ray 3 is 0"),
        (np.full((5, 3), np.nan), np.ones((5, 3)), "ray 0 is not finite"),
    ]:
        with pytest.raises(ValueError, match=told):
            balls.hits(origins, directions)
    with pytest.raises(ValueError, match="`t_max` has the shape"):
        balls.hits(np.zeros((5, 3)), np.ones((5, 3)), np.ones(4))
    for end in [0, -1, np.nan]:
        with pytest.raises(ValueError, match="`t_max` of ray 0 is"):
            balls.hits([0, 0, 9], [0, 0, -1], end)


def test_rays_end(balls):
    hits = balls.hits([0, 0, 9], np.tile([0.0, 0, -1], (3, 1)), t_max=[6.5, 7.5, np.inf])
    assert hits.verdict.tolist() == [0, 1, 1]
    occluded = balls.occluded([0, 0, 9], np.tile([0.0, 0, -1], (3, 1)), t_max=[6.5, 7.5, np.inf])
    assert occluded.dtype == bool and occluded.tolist() == [False, True, True]
    assert balls.occluded([0, 0, 9], [[0, 0, -1], [0, 0, 1]], 8.0, fast=True).tolist() == [True, False]


def test_answers_do_not_depend_on_threads(balls):
    origins, directions = rays(3000)
    for how in [{}, {"fast": True}]:
        one, two = [balls.hits(origins, directions, threads=threads, **how) for threads in (1, 2)]
        for name in ["t", "t_low", "t_high", "object", "verdict", "point", "normal"]:
            assert getattr(one, name).tobytes() == getattr(two, name).tobytes(), name


def test_fast_and_tight_answers_agree(balls):
    origins, directions = rays(300)
    proven = balls.hits(origins, directions)
    fast = balls.hits(origins, directions, fast=True)
    tight = balls.hits(origins, directions, tight=True)
    assert np.array_equal(fast.object, proven.object) and (fast.proof == 0).all()
    found = proven.verdict == 1
    assert (tight.t_low[found] >= proven.t_low[found]).all() and (tight.t_high[found] <= proven.t_high[found]).all()
    assert set(tight.proof[found]) == {237} and np.isneginf(fast.t_low[found]).all()


def test_progress_is_told(balls):
    told = []
    balls.hits(*rays(2000), progress=lambda done, all: told.append((done, all)))
    assert told[-1] == (2000, 2000) and all(done <= 2000 for done, _ in told)

    def fails(done, all):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        balls.hits(*rays(2000), progress=fails)


def test_other_threads_of_python_go_on(balls):
    origins, directions = rays(200_000)
    worker = threading.Thread(target=lambda: balls.hits(origins, directions, threads=1))
    worker.start()
    steps = 0
    while worker.is_alive():
        time.sleep(0.001)
        steps += 1
    assert steps > 10


ENDLESS = """
import signal, numpy as np, tabray
# What runs in the background may have been told to ignore it.
signal.signal(signal.SIGINT, signal.default_int_handler)
scene = tabray.surface("x^6 + y^6 + z^6 - 1 + 0.3*sin(5*x)*sin(5*y)*sin(5*z)")
o = np.tile([0.0, 0, 5], (2_000_000, 1)); d = np.random.default_rng(1).normal(size=o.shape) * 0.3 + [0, 0, -5]
print("ready", flush=True)
CALL
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent in another way there")
@pytest.mark.parametrize("call", ["scene.hits(o, d, tight=True)", "scene.render(width=4000, samples=256)"])
def test_an_interrupt_ends_long_work(call):
    command = [sys.executable, "-c", ENDLESS.replace("CALL", call)]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert child.stdout.readline() == "ready\n"
        time.sleep(1)
        child.send_signal(signal.SIGINT)
        _, error = child.communicate(timeout=60)
    finally:
        child.kill()
    assert "KeyboardInterrupt" in error and child.returncode != 0


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_process_that_was_forked_asks_as_well(balls):
    balls.hits(*rays(1000))
    child = os.fork()
    if child == 0:
        os._exit(0 if len(balls.hits(*rays(1000))) == 1000 else 1)
    assert os.waitpid(child, 0)[1] == 0


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_rays_that_start_at_hits_do_not_hit_them(scale):
    phi = (1 + 5**0.5) / 2
    corners = np.array([[x, y * phi, 0] for x in (-1, 1) for y in (-1, 1)])
    corners = scale * (np.vstack([np.roll(corners, turn, axis=1) for turn in range(3)]) + [3.1, -2.3, 5.7])
    near = np.linalg.norm(corners[:, None] - corners, axis=2) < 2.1 * scale
    faces = [
        (a, b, c) for a in range(12) for b in range(a) for c in range(b) if near[a, b] and near[b, c] and near[a, c]
    ]
    mesh = tabray.mesh(corners, faces)
    origins, directions = rays(4000)
    hits = mesh.hits(scale * (origins + [3.1, -2.3, 5.7]), directions)
    hits = hits[hits.verdict == tabray.Verdict.HIT]
    assert len(hits) > 300
    middle = corners.mean(axis=0)
    outward = hits.normal * np.sign(np.sum(hits.normal * (hits.point - middle), axis=1))[:, None]
    slant = outward + 0.9 * outward[:, [1, 2, 0]] / 2
    slant[np.sum(slant * outward, axis=1) < 0.1] *= -1
    slant = np.where(np.sum(slant * outward, axis=1)[:, None] < 0.1, outward, slant)
    assert not mesh.occluded(hits.point, slant, leaves=hits).any()
    assert mesh.occluded(hits.point, -slant, leaves=hits).all()
    with pytest.warns(UserWarning, match="start within rounding of a surface"):
        mesh.occluded(hits.point, slant)


def test_starts_that_are_no_hits_are_refused(balls):
    hits = balls.hits([[0, 0, 9], [0, 9, 9]], [[0, 0, -1], [0, 0, -1]])
    with pytest.raises(ValueError, match="no proven hit for ray 1"):
        balls.hits(hits.point[0], [[0, 0, 1]] * 2, leaves=hits)
    with pytest.raises(ValueError, match="2 hits for 1 rays"):
        balls.hits(hits.point[:1], [[0, 0, 1]], leaves=hits)
    assert hits[0].t.tolist() == hits[:1].t.tolist() == hits[hits.verdict == 1].t.tolist() == [7]


def test_answers_are_pickled_and_copied_with_all_of_their_arrays(balls):
    hits, crossings = balls.hits(*rays(50)), balls.crossings(*rays(50))
    for one in [hits, hits[hits.verdict == 1], crossings]:
        names = [name for name in dir(one) if isinstance(getattr(one, name), np.ndarray)]
        assert len(names) == (15 if one is crossings else 13)
        for other in [pickle.loads(pickle.dumps(one)), copy.copy(one), copy.deepcopy(one)]:
            assert type(other) is type(one) and repr(other) == repr(one)
            for name in names:
                assert np.array_equal(getattr(one, name), getattr(other, name), equal_nan=True), name
                assert getattr(one, name).dtype == getattr(other, name).dtype
    kept = copy.deepcopy(hits)
    hits.t[:] = 0
    assert not np.array_equal(kept.t, hits.t)
    start = pickle.loads(pickle.dumps(kept[kept.verdict == 1]))
    assert len(balls.hits(start.point, start.normal, leaves=start)) == len(start)
