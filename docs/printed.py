"""The mesh of a ring, as trimesh reads it: closed, and nowhere farther from the ring than it says, nor the ring from it.

    python3 docs/printed.py TABRAY

TABRAY is the program. Needs NumPy, trimesh, SciPy and rtree.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
import trimesh

RADIUS, TUBE, ERROR, POINTS = 0.6, 0.2, 0.005, 100_000
# A copy that is turned and moved. Its points are taken back before they are compared.
SCENE = f"""orthographic eye {{ pixeldim 4 4  position 0 0 9  target 0 0 0  width 4 }}
material m {{ ambient 1 1 1 }}
torus ring {{ material m  center 0 0 0  direction 0 1 0  radius {RADIUS}  tube {TUBE} }}
place copy {{ object ring  rotation 0 0 1 30  translation 3 1 0 }}
"""

with tempfile.TemporaryDirectory() as folder:
    scene, file = Path(folder, "ring.ray"), Path(folder, "ring.stl")
    scene.write_text(SCENE)
    subprocess.run([sys.argv[1], "mesh", scene, "copy", "-o", file, "--error", str(ERROR)], check=True)
    mesh = trimesh.load(file)

assert mesh.is_watertight and mesh.is_winding_consistent and mesh.body_count == 1 and mesh.euler_number == 0
turned = trimesh.transformations.rotation_matrix(numpy.radians(30), [0, 0, 1])
placed = trimesh.transformations.translation_matrix([3, 1, 0]) @ turned

back = trimesh.transform_points(mesh.sample(POINTS), numpy.linalg.inv(placed))
out = numpy.hypot(numpy.hypot(back[:, 0], back[:, 2]) - RADIUS, back[:, 1]) - TUBE
u, v = numpy.random.default_rng(1).uniform(0, 2 * numpy.pi, (2, POINTS))
ring = RADIUS + TUBE * numpy.cos(v)
points = numpy.column_stack([ring * numpy.cos(u), TUBE * numpy.sin(v), ring * numpy.sin(u)])
_, there, _ = trimesh.proximity.closest_point(mesh, trimesh.transform_points(points, placed))
print(f"{len(mesh.faces)} triangles: at most {abs(out).max():.1e} from the ring, and the ring {there.max():.1e} from them")
assert abs(out).max() <= ERROR and there.max() <= ERROR
