#!/usr/bin/env bash
# What whole programs take to read a million objects and to render one image of them, a PNG of 640 x 480 pixels, on one
# thread: tabray and POV-Ray in turns. Prints a table in Markdown: CPU seconds, the minimum of each, the median of the
# ratios, and the memory. Needs GNU time.
#
#     bash docs/million.sh [ROUNDS]
#
# TABRAY names a program other than a new build. The camera and the lights of POV-Ray's scenes are those in the folder given by
# SHARED.
set -euo pipefail
cd "$(dirname "$0")/.."

rounds=${1:-3}
peers=$(realpath "${SHARED:-../shared}")/peers
if ! [ -d "$peers" ]; then
    echo "SKIPPED: $peers does not exist"
    exit
fi
if ! command -v povray >/dev/null; then
    echo "SKIPPED: POV-Ray is not installed"
    exit
fi
if [ -z "${TABRAY:-}" ]; then
    cargo build --profile dist --locked --quiet
    TABRAY=$(realpath "${CARGO_TARGET_DIR:-target}/dist/tabray")
fi
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
cp "$peers/course.inc" "$out"

write() { awk -v name="$1" -v count=1000000 -v ply="$out/scene.ply" -f docs/objects.awk >"$out/$1.ray"; }

# Writes the POV-Ray scene of a scene, whose objects are parts of one if `$2` names that.
translate() { awk -v whole="${2:-}" -f docs/povray.awk "$out/$1.ray" >"$out/pov.pov"; }

# Adds the CPU seconds and the MiB that a command takes to a file.
measure() {
    local into=$1
    shift
    env time -o "$out/taken" -f '%U %S %M' "$@" >"$out/told" 2>&1 || { cat "$out/told" >&2; exit 1; }
    awk '{ print $1 + $2, $3 / 1024 }' "$out/taken" >>"$into"
}

# One row: its name, the scene of tabray, and that of which POV-Ray's is made, with the object that its objects are parts of.
row() {
    local name=$1 scene=$2
    write "$scene" && write "$3"
    translate "$3" "${4:-}"
    : >"$out/ours" && : >"$out/pov"
    for ((round = 0; round < rounds; round++)); do
        measure "$out/ours" "$TABRAY" render "$out/$scene.ray" -o "$out/ours.png" --threads 1
        (cd "$out" && measure "$out/pov" povray +Ipov.pov +W640 +H480 -A +WT1 +FN "+O$out/pov.png" -D -P -V -GA)
    done
    paste -d ' ' "$out/ours" "$out/pov" | awk '{ print $0, $3 / $1 }' | sort -g -k 5 | awk -v name="$name" '
        NR == 1 || $1 < ours { ours = $1 }
        NR == 1 || $3 < pov { pov = $3 }
        { ratio[NR] = $5; memory = $2; rival = $4 }
        END {
            middle = (ratio[int((NR + 1) / 2)] + ratio[int(NR / 2) + 1]) / 2
            printf "| %s | %.2f | %.1f | %.1f | %.0f | %.0f |\n", name, ours, pov, middle, memory, rival
        }'
}

echo "| a million | tabray, s | POV-Ray, s | ratio | tabray, MiB | POV-Ray, MiB |"
echo "|---|---:|---:|---:|---:|---:|"
row "spheres" sphere sphere
row "spheres; POV-Ray: a \`union\`" sphere sphere union
row "triangles" triangle triangle
row "triangles; POV-Ray: a \`mesh\`" triangle triangle mesh
row "triangles, a \`mesh\` in both" mesh triangle mesh
