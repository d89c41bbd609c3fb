#!/usr/bin/env bash
# What `tabray choose` promises, and what it costs: chooses for two errors in scenes of this folder and in scenes made at
# random, renders the choices, and measures their errors against 4096 samples per pixel. Prints a table in Markdown. What
# is measured includes the rounding to bytes of both images, 0.41 levels at most, which no choice promises. Times are CPU times
# of choosing and of rendering the choice.
#
#     bash docs/choose.sh target/release/tabray
set -euo pipefail
cd "$(dirname "$0")/.."
tabray=$(realpath "$1")
out=$(mktemp -d)
trap 'rm -r "$out"; rm -f scenes/*/*.small.ray' EXIT

# A scene made at random, from a seed.
random() {
    awk -v seed="$1" 'function r(a, b) { return a + (b - a) * rand() }
    BEGIN {
        srand(seed)
        print "camera eye { pixeldim 100 75  worlddim 8 6  viewpoint 4 3 7 }"
        for (i = 0; i < 4; i++)
            printf "material m%d { ambient %f %f %f  diffuse %f %f %f  specular %f  shininess %d }\n", i, r(0, 2),
                r(0, 2), r(0, 2), r(0, 6), r(0, 6), r(0, 6), i == 1 ? r(0.1, 0.6) : 0, i == 2 ? 20 : 0
        print "tiled_plane floor { material m0 altmaterial m2  normal 0 1 0  point 0 0 0  xdir 1 0 0  dimensions 1 1 }"
        if (rand() < 0.5) print "plane back { material m3  normal 0 0 1  point 0 0 -9 }"
        for (i = 0; i < 4 + seed % 9; i++)
            printf "sphere s%d { material m%d  center %f %f %f  radius %f }\n", i, int(r(0, 4)), r(0, 8), r(0.2, 5),
                r(-8, -1), r(0.1, 1.1)
        for (i = 0; i < 1 + seed % 3; i++)
            printf "light l%d { location %f %f %f  emissivity %f %f %f  size %f }\n", i, r(-2, 10), r(4, 9), r(-3, 5),
                r(1, 6), r(1, 6), r(1, 6), rand() < 0.4 ? r(0.1, 1) : 0
    }'
}

# The CPU time of a command in seconds, in the variable `spent`.
timed() {
    local TIMEFORMAT='%U %S'
    spent=$({ time "$@" >"$out/said" 2>"$out/error"; } 2>&1 | awk '{ print $1 + $2 }')
}

echo "| scene | asked | samples | promised | measured | kept | choosing / rendering |"
echo "|---|---|---|---|---|---|---|"
scenes=(gallery/hall-of-mirrors gallery/marbles gallery/stained-glass gallery/three-lamps notes/three-planes
    hard/ripples hard/globe hard/rug hard/lantern hard/glass-balls entities/revsurf entities/torus material/mirror
    material/transparent texplane/fit light/size projector/shadow light/distance)
count=0
rows() {
    local name=$1 scene=$2
    "$tabray" render "$scene" -o "$out/true.png" --samples 4096 2>"$out/error"
    for error in 1% 0.4%; do
        timed "$tabray" choose "$scene" --max-error "$error"
        local choosing=$spent
        if ! grep -q '^>' "$out/said"; then
            echo "| $name | $error | none: $(sed 's/^error: //' "$out/error") | | | | |"
            continue
        fi
        read -r _ _ samples _ promised _ <<<"$(grep '^>' "$out/said")"
        # The last line is the command to use.
        read -r _ _ _ options <<<"$(tail -n 1 "$out/said")"
        # shellcheck disable=SC2086
        timed "$tabray" render "$scene" -o "$out/chosen.png" $options
        local rendering=$spent
        "$tabray" diff "$out/true.png" "$out/chosen.png" >"$out/diff" || true
        awk -v name="$name" -v error="$error" -v samples="$samples" -v promised="$promised" -v choosing="$choosing" \
            -v rendering="$rendering" '
            { if (match($0, /RMS[^0-9]*[0-9.]+/)) { text = substr($0, RSTART, RLENGTH); sub(/^[^0-9]*/, "", text); rms = text } }
            END {
                printf "| %s | %s | %s | %s | %.3f | %s | %.2f s / %.2f s |\n", name, error, samples, promised, rms,
                    rms <= 2.55 * error ? rms <= sqrt(promised * promised + 0.17) ? "yes" : "the error asked for" : "no",
                    choosing, rendering
            }' "$out/diff"
    done
}
for name in "${scenes[@]}"; do
    [ -f "scenes/$name.ray" ] || continue
    # Next to the scene, whose files are relative to its folder.
    small=scenes/$name.small.ray
    sed -E 's/pixeldim +[0-9]+ +[0-9]+/pixeldim 100 75/' "scenes/$name.ray" >"$small"
    rows "$name" "$small" || true
    rm "$small"
    count=$((count + 1))
done
for seed in $(seq 1 $((30 - count))); do
    random "$seed" >"$out/random.ray"
    rows "random $seed" "$out/random.ray"
done
