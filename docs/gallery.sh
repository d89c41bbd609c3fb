#!/usr/bin/env bash
# The pictures of docs/gallery.md, one for each type of object, shader, material, background and camera that it shows:
# 320 x 240 pixels, 16 samples in each, and 256 through a lens and under a lamp with a size.
#
#     bash docs/gallery.sh
#
# TABRAY names a program other than a new build.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ -z "${TABRAY:-}" ]; then
    cargo build --release --locked --quiet
    TABRAY=$(realpath "${CARGO_TARGET_DIR:-target}/release/tabray")
fi
for shape in implicit lathe box cylinder capsule disc polygon prism union intersection difference \
    tiles rainbow checker image faces formula bumps glass metal plastic background sky environment \
    look_at orthographic fisheye thin_lens; do
    samples=16
    case $shape in thin_lens | plastic) samples=256 ;; esac
    "$TABRAY" render "scenes/entities/$shape.ray" --size 320x240 --samples "$samples" -o "docs/gallery/$shape.png"
done
"$TABRAY" render scenes/glass/bubbles.ray --size 320x240 --samples 16 -o docs/gallery/bubbles.png
