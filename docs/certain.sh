#!/usr/bin/env bash
# What `render --max-error --certain` proves, whether 4096 samples contradict it, and what it costs: the table of
# docs/accuracy.md, printed in Markdown.
#
#     bash docs/certain.sh
#
# TABRAY names a program other than a new build, SHARED the folder of the course's scenes, SIZE the size of the pictures
# (40x30).
set -euo pipefail
cd "$(dirname "$0")/.."

shared=$(realpath "${SHARED:-../shared}")
if [ -z "${TABRAY:-}" ]; then
    cargo build --profile dist --locked --quiet
    TABRAY=$(realpath "${CARGO_TARGET_DIR:-target}/dist/tabray")
fi
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT

# A scene made at random from a seed: spheres and triangles on a floor, before a wall that is a mirror in every third one,
# and two lights, of which one has a size in every third one.
made() {
    awk -v seed="$1" '
    function number(from, to) { return from + (to - from) * rand() }
    function place() { return sprintf("%.3f %.3f %.3f", number(0, 8), number(0, 5), number(-7, -1)) }
    BEGIN {
        srand(seed)
        print "camera eye { pixeldim 160 120  worlddim 8 6  viewpoint 4 3 8 }"
        print "material floor { ambient 0.2 0.2 0.2  diffuse 3 3 3 }"
        printf "material wall { ambient 0.2 0.2 0.3  diffuse 2 2 2  specular %.2f }\n", seed % 3 ? 0 : 0.3
        for (i = 0; i < 4; i++)
            printf "material m%d { ambient %.2f %.2f %.2f  diffuse %.2f %.2f %.2f }\n", i,
                number(0, 0.5), number(0, 0.5), number(0, 0.5), number(0, 4), number(0, 4), number(0, 4)
        print "plane floor { material floor  normal 0 1 0  point 0 0 0 }"
        print "plane back { material wall  normal 0 0 1  point 0 0 -8 }"
        count = 2 + int(5 * rand())
        for (i = 0; i < count; i++) {
            printf "sphere s%d { material m%d  center %s  radius %.3f }\n", i, i % 4, place(), number(0.1, 1)
            printf "triangle t%d { material m%d  vertex1 %s  vertex2 %s  vertex3 %s }\n", i, i % 4, place(), place(),
                place()
        }
        for (i = 0; i < 2; i++)
            printf "light l%d { location %.2f %.2f %.2f  emissivity %.1f %.1f %.1f  size %.2f }\n", i, number(0, 8),
                number(5, 6), number(0, 2), number(3, 7), number(3, 7), number(3, 7), i == 0 && seed % 3 == 2 ? 0.2 : 0
    }'
}

for seed in {1..12}; do made "$seed" >"$out/random-$seed.ray"; done
"$TABRAY" bench --sampling certain --size "${SIZE:-40x30}" \
    "$shared"/conformance/fplane/fplane1.txt "$shared"/conformance/spec/spec1.txt \
    scenes/gallery/{three-lamps,marbles,stained-glass,hall-of-mirrors}.ray scenes/texplane/{fit,tiled}.ray \
    scenes/pplane/{tiles,rainbow,rainbow_tiles}.ray scenes/tiled_plane/floor.ray scenes/light/{shadow,size}.ray \
    scenes/spotlight/shadow.ray scenes/projector/fit.ray scenes/sphere/in-front.ray scenes/torus/shadow.ray \
    "$out"/random-*.ray 2>/dev/null | awk '
    BEGIN {
        FS = " *[|] *"
        print "| scene | pixels certified, % | worst of them | contradicted | mean bound of the others | footprints per pixel |"
        print "|---|---|---|---:|---|---|"
    }
    $3 > 0 {
        seconds[$3] += $10; without[$3] += $11; share[$3] += $4; scenes[$3] += 1
        if ($3 == 1) { a = b = c = d = between = ""; bad = 0 }
        a = a between ($4 + 0); b = b between $5; bad += $6; c = c between $7; d = d between $9; between = ", "
        if ($3 == 4) print "| " $2 " | " a " | " b " | " bad " | " c " | " d " |"
    }
    END {
        print "\n| levels | scenes | pixels certified, mean | CPU seconds | without `--certain` |\n|---:|---:|---:|---:|---:|"
        for (levels = 1; levels <= 4; levels *= 2)
            printf "| %d | %d | %.1f %% | %.1f | %.1f |\n", levels, scenes[levels], share[levels] / scenes[levels],
                seconds[levels], without[levels]
    }'
