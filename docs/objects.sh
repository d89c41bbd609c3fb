#!/usr/bin/env bash
# What many objects cost, beside Embree, which takes turns with tabray on one core. Prints a table in Markdown, in
# milliseconds of CPU time. Without a compiler of C++ and libembree-dev (version 3), Embree's columns stay empty.
#
#     bash docs/objects.sh [MOST]
#
# MOST is the greatest power of ten of objects, 6 by default.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
cargo build --profile dist --locked --quiet
tabray=$(realpath "${CARGO_TARGET_DIR:-target}/dist/tabray")
c++ -O3 -march=native docs/embree.cpp -o "$out/embree" -lembree3 2>/dev/null ||
    echo "SKIPPED: docs/embree.cpp does not compile"

write() { awk -v name="$1" -v count="$2" -v ply="$out/scene.ply" -f docs/objects.awk >"$out/scene.ray"; }

echo "| objects | frame, ms | tests per ray | Embree, ms | ratio | Embree builds, ms |"
echo "|---|---:|---:|---:|---:|---:|"
for name in sphere triangle mesh; do
    for exponent in $(seq 3 "${1:-6}"); do
        write "$name" "$((10 ** exponent))"
        "$tabray" bench "$out/scene.ray" >"$out/ours"
        objects=${name/mesh/triangle}s
        rival=$([ ! -x "$out/embree" ] || "$out/embree" "$objects" "$exponent")
        [ "$name" != mesh ] || objects="triangles, a mesh"
        awk -v name="$name" -v objects="$objects" -v exponent="$exponent" -v rival="$rival" '
            $1 == "all" { rays = $2; frame = $3 }
            $1 == name { tests = $2 }
            END {
                printf "| 10^%d %s | %.1f | ", exponent, objects, frame
                # A mesh is one object.
                if (name == "mesh") printf "- |"
                else printf "%.2f |", tests / rays
                if (split(rival, of, " ")) printf " %.1f | %.2f | %.1f |\n", of[1], of[1] / frame, of[2]
                else print " | | |"
            }' "$out/ours"
    done
done
