#!/usr/bin/env bash
# The pictures of docs/gallery.md, one for each type of object, shader, material, background and camera that it shows:
# 192 x 144 pixels in 96 colours, for which it takes pngquant (apt-get install pngquant).
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

# draw SAMPLES SCENE...
draw() {
    local samples=$1 scene image
    shift
    for scene; do
        image=docs/gallery/$(basename "$scene" .ray).png
        "$TABRAY" render "$scene" --size 192x144 --samples "$samples" --force -o "$image"
        pngquant --nofs --strip --force --output "$image" 96 "$image"
    done
}
draw 64..256 scenes/entities/{lathe,prism,faces,box,cylinder,capsule,disc,polygon,tiles,rainbow,checker,image,formula}.ray \
    scenes/entities/{bumps,metal,plastic,background,sky,environment,look_at,orthographic,fisheye,thin_lens}.ray
# What takes long, is in the light of the notes, or is of glass, where a pixel has a limited number of rays for all of its
# samples together.
draw 64 scenes/entities/{implicit,union,intersection,difference,glass}.ray scenes/glass/bubbles.ray
