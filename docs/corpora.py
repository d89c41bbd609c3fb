#!/usr/bin/env python3
"""Tries the images and models of public corpora: python3 docs/corpora.py PROGRAM FOLDER...

For each folder and each kind of file, prints how many load, are refused and for which reason, and how many end the
program otherwise: by an internal error, a signal, or not within a minute. Nothing is fetched, and nothing is kept.
"""

import collections
import pathlib
import re
import subprocess
import sys
import tempfile

IMAGES = "png jpg jpeg webp tif tiff bmp tga hdr exr ppm pgm pbm pnm gif".split()
MODELS = "obj ply stl gltf glb".split()
SCENE = """camera eye {{ pixeldim 8 6  worlddim 8 6  viewpoint 4 3 6 }}
material m {{ ambient 1 1 1 }}
{entity}
"""
TEXTURE = 'texture t {{ filename "{path}" }}\nimage i {{ texture t }}\nsphere s {{ material m  center 4 3 -4  radius 2  shader i }}'
MESH = 'mesh s {{ material m  file "{path}"  materials file  normals file }}'


def outcome(program, scene, path):
    """Returns whether a file loads, or the reason why it does not."""
    entity = (TEXTURE if path.suffix[1:].lower() in IMAGES else MESH).format(path=path)
    scene.write_text(SCENE.format(entity=entity))
    try:
        run = subprocess.run(
            [program, "check", "--message-format", "short", str(scene)], capture_output=True, text=True, timeout=60
        )
    except subprocess.TimeoutExpired:
        return "CRASH: no answer within a minute"
    errors = [line for line in run.stderr.splitlines() if "error: " in line]
    if run.returncode not in (0, 2) or any("internal error" in line for line in errors):
        return "CRASH: " + (errors[0] if errors else f"status {run.returncode}")
    if run.returncode == 0:
        return "loads"
    reason = re.sub(r".*cannot be read[^:]*: ", "", errors[0])
    return re.sub(r"`[^`]*`|\d[\d.]*", "N", reason)


def main():
    program, *folders = sys.argv[1:]
    crashes = 0
    with tempfile.TemporaryDirectory() as work:
        scene = pathlib.Path(work, "scene.ray")
        for folder in folders:
            found = collections.defaultdict(collections.Counter)
            for path in sorted(pathlib.Path(folder).resolve().rglob("*")):
                kind = path.suffix[1:].lower()
                if kind in IMAGES + MODELS and path.is_file() and '"' not in str(path):
                    found[kind][outcome(program, scene, path)] += 1
            for kind, reasons in sorted(found.items()):
                for reason, count in reasons.most_common():
                    print(f"{pathlib.Path(folder).name}\t{kind}\t{count}\t{reason}")
                    crashes += count if reason.startswith("CRASH") else 0
    sys.exit(crashes > 0)


main()
