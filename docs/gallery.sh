#!/usr/bin/env bash
# The pictures of docs/gallery.md, one for each shape, shader, material and background that it shows: 320 x 240 pixels, 16 samples in each.
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
for shape in implicit lathe box cylinder capsule disc polygon prism tiles rainbow checker formula bumps glass background \
    sky environment; do
    "$TABRAY" render "scenes/entities/$shape.ray" --size 320x240 --samples 16 -o "docs/gallery/$shape.png"
done
