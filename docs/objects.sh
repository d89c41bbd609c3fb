#!/usr/bin/env bash
# What many objects cost, beside Embree, which takes turns with tabray on one core, and POV-Ray. Prints the processor and a
# table in Markdown, in milliseconds of CPU time, and draws a chart, docs/charts/objects.svg. Without a compiler of C++ and
# libembree-dev (version 3), Embree's columns stay empty, and without POV-Ray or its scenes (SHARED) POV-Ray's.
#
#     bash docs/objects.sh [MOST]
#
# MOST is the greatest power of ten of objects, 6 by default. The text of more than 10^6 spheres or triangles is larger
# than a scene may be, so that from 10^7 on there are meshes alone.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
if [ -z "${TABRAY:-}" ]; then
    cargo build --profile dist --locked --quiet
    TABRAY=$(realpath "${CARGO_TARGET_DIR:-target}/dist/tabray")
fi
c++ -O3 -march=native docs/embree.cpp -o "$out/embree" -lembree3 2>/dev/null ||
    echo "SKIPPED: docs/embree.cpp does not compile"
peers=$(realpath "${SHARED:-../shared}")/peers
if [ -d "$peers" ] && command -v povray >/dev/null; then cp "$peers/course.inc" "$out"; else echo "SKIPPED: POV-Ray"; fi

write() { awk -v name="$1" -v count="$2" -v ply="$out/scene.ply" -f docs/objects.awk >"$out/scene.ray"; }

# The milliseconds of CPU time that POV-Ray takes for the frame alone; nothing without it.
pov() {
    [ -e "$out/course.inc" ] || return 0
    awk -v whole="$1" -f docs/povray.awk "$out/scene.ray" >"$out/pov.pov"
    (cd "$out" && povray +Ipov.pov +W640 +H480 -A +WT1 +FN +Opov.png -D -P 2>&1 >/dev/null) |
        awk '/Trace Time/ { traced = 1 } traced && /CPU-seconds/ { sub(/.*with /, ""); print 1e3 * $1; exit }'
}

grep -m1 '^model name' /proc/cpuinfo 2>/dev/null | sed 's/.*: //' || true
echo
echo "| objects | frame, ms | tests per ray | Embree, ms | ratio | Embree builds, ms | POV-Ray, ms |"
echo "|---|---:|---:|---:|---:|---:|---:|"
for name in sphere triangle mesh; do
    # Ten triangles would lie in one plane.
    for exponent in $(seq "$([ "$name" = sphere ] && echo 0 || echo 2)" "${1:-6}"); do
        if [ "$exponent" -gt 6 ] && [ "$name" != mesh ]; then continue; fi
        objects=${name/mesh/triangle}s
        pov_time=
        if [ "$name" = sphere ]; then
            write sphere "$((10 ** exponent))" && pov_time=$(pov "")
        elif [ "$name" = triangle ]; then
            write triangle "$((10 ** exponent))" && pov_time=$(pov "")
        else
            # POV-Ray's mesh is that of the single triangles.
            if [ "$exponent" -le 6 ]; then write triangle "$((10 ** exponent))" && pov_time=$(pov mesh); fi
            write mesh "$((10 ** exponent))"
        fi
        "$TABRAY" bench "$out/scene.ray" >"$out/ours"
        # An open mesh is lit on both sides, and casts more shadow rays than its triangles do.
        [ "$name" != mesh ] || objects=meshes
        rival=$([ ! -x "$out/embree" ] || "$out/embree" "$objects" "$exponent")
        [ "$name" != mesh ] || objects="triangles, a mesh"
        awk -v name="$name" -v objects="$objects" -v exponent="$exponent" -v rival="$rival" -v pov="$pov_time" -v points="$out/points" '
            function point(program, ms) { if (ms > 0) print family program, 10 ^ exponent, ms >>points }
            $1 == "all" { rays = $2; frame = $3 }
            $1 == name { tests = $2 }
            END {
                family = objects; sub(/, a mesh/, "", family); if (name == "mesh") family = "meshes"
                printf "| 10^%d %s | %.1f | ", exponent, objects, frame
                # A mesh is one object.
                if (name == "mesh") printf "- |"
                else printf "%.2f |", tests / rays
                if (split(rival, of, " ")) printf " %.1f | %.2f | %.1f |", of[1], of[1] / frame, of[2]
                else printf " | | |"
                print pov ? sprintf(" %.0f |", pov) : " |"
                point(",_tabray", frame); point(",_Embree", of[1]); point(",_POV-Ray", pov)
            }' "$out/ours"
    done
done
# Series by series.
sort -s -k 1,1 "$out/points" | awk -v across=objects -v up="CPU time of a frame, ms" -f docs/loglog.awk >docs/charts/objects.svg
