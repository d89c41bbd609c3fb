#!/usr/bin/env bash
# Surfaces by their formula beside POV-Ray's isosurface: a table in Markdown of the CPU seconds for an image of 640 x 480
# pixels on one thread, the least of some rounds, and of the pixels that POV-Ray loses or invents with a `max_gradient`
# that is right and one that is too low.
#
#     bash docs/isosurface.sh [ROUNDS]
#
# TABRAY names a program other than a new build.
set -euo pipefail
cd "$(dirname "$0")/.."

rounds=${1:-5}
if [ -z "${TABRAY:-}" ]; then
    cargo build --profile dist --locked --quiet
    TABRAY=$(realpath "${CARGO_TARGET_DIR:-target}/dist/tabray")
fi
if ! command -v povray >/dev/null; then
    echo "SKIPPED: POV-Ray is not installed"
    exit
fi
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT

# The least CPU seconds of a command in some rounds.
least() {
    local TIMEFORMAT='%U %S'
    for ((round = 0; round < rounds; round++)); do
        { time "$@" >"$out/told" 2>&1 || { cat "$out/told" >&2; exit 1; }; } 2>&1
    done | awk '{ print $1 + $2 }' | sort -g | head -1
}

# One row: a formula, its box, a `max_gradient` that is right and one that is too low. Both programs show the surface
# in one colour on black, from the same place through the same pixels.
row() {
    local name=$1 formula=$2 box=$3 right=$4 low=$5 half ours
    half=${box##* }
    cat >"$out/ours.ray" <<SCENE
camera eye { pixeldim 640 480  worlddim 8 6  viewpoint 4 3 7 }
material white { ambient 1 1 1 }
implicit surface { material white  formula "$formula"  center 4 3 -2  box $box }
SCENE
    # POV-Ray's powers are functions, and its pixels have their places in their middles.
    cat >"$out/pov.pov" <<SCENE
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <4,3,7> direction <0,0,-7> up <0,6*480/479,0> right <8*640/639,0,0> look_at <4,3,0> }
isosurface {
  function { $(sed -E 's/(\([^()]*\)|[xyz])\^([0-9])/pow(\1,\2)/g' <<<"$formula") }
  contained_by { box { -$half, $half } } accuracy 1e-9 max_gradient MG open
  translate <4,3,-2> pigment { rgb 1 } finish { ambient 1 diffuse 0 }
}
SCENE
    ours=$(least "$TABRAY" render "$out/ours.ray" --threads 1 -o "$out/ours.ppm")
    printf '| %s | %s ' "$name" "$ours"
    for gradient in "$right" "$low"; do
        sed "s/MG/$gradient/" "$out/pov.pov" >"$out/$gradient.pov"
        printf '| %s | %s ' "$gradient" "$(least povray "+I$out/$gradient.pov" +W640 +H480 -A +WT1 +FP "+O$out/pov.ppm" -D -P -V -GA)"
        # The pixels of each image that are not black, one number in a line.
        for image in ours pov; do
            tail -c $((640 * 480 * 3)) "$out/$image.ppm" | od -An -v -tu1 -w3 |
                awk '$1 + $2 + $3 { print NR }' >"$out/$image.hits"
        done
        printf '| %d of %d ' "$(diff "$out/ours.hits" "$out/pov.hits" | grep -c '^[<>]' || true)" \
            "$(wc -l <"$out/ours.hits")"
    done
    echo '|'
}

echo '| surface | tabray (s) | `max_gradient` | POV-Ray (s) | wrong pixels | too low | POV-Ray (s) | wrong pixels |'
echo '|---|--:|--:|--:|--:|--:|--:|--:|'
row egg '(x^2 + z^2)*(1 + y/4) + y^2/2 - 1' '-1.5 -1.5 -1.5 1.5 1.5 1.5' 7 2
row torus '(x*x + y*y + z*z + 0.75)^2 - 4*(x*x + z*z)' '-1.6 -1.6 -1.6 1.6 1.6 1.6' 95 6
row 'cube of tubes' 'x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8' '-2.5 -2.5 -2.5 2.5 2.5 2.5' 65 8
row gyroid 'sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x)' '-1.2 -1.2 -1.2 1.2 1.2 1.2' 7 2
