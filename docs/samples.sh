#!/usr/bin/env bash
# What samples cost: CPU time of the whole program on one thread for 1 to 256 samples of each pixel, as a multiple of that
# for one sample. The numbers of samples take turns. Prints the processor and a table in Markdown, and draws a chart,
# docs/charts/samples.svg.
#
#     bash docs/samples.sh [ROUNDS]
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
if [ -z "${TABRAY:-}" ]; then
    cargo build --profile dist --locked --quiet
    TABRAY=$(realpath "${CARGO_TARGET_DIR:-target}/dist/tabray")
fi
numbers="1 2 4 8 16 32 64 128 256"
grep -m1 '^model name' /proc/cpuinfo 2>/dev/null | sed 's/.*: //' || true
echo
echo "| scene | 1, s |$(for number in $numbers; do [ "$number" = 1 ] || printf ' %s |' "$number"; done)"
echo "|---|---:|$(for number in $numbers; do [ "$number" = 1 ] || printf -- '---:|'; done)"
TIMEFORMAT='%U %S'
for scene in marbles three-lamps; do
    for ((round = 0; round < ${1:-5}; round++)); do
        for number in $numbers; do
            { time "$TABRAY" render "scenes/gallery/$scene.ray" --samples "$number" -o "$out/image.ppm" --threads 1 \
                --quiet; } 2>&1 | awk -v number="$number" '{ print number, $1 + $2 }' >>"$out/$scene"
        done
    done
    awk -v scene="$scene" -v numbers="$numbers" -v points="$out/points" '
        !($1 in least) || $2 < least[$1] { least[$1] = $2 }
        END {
            count = split(numbers, number, " ")
            printf "| %s | %.3f |", scene, least[1]
            for (n = 2; n <= count; n++) printf " %.1f |", least[number[n]] / least[1]
            print ""
            for (n = 1; n <= count; n++) print scene, number[n], least[number[n]] >>points
        }' "$out/$scene"
done
awk -v across="samples per pixel" -v up="CPU time of the program, s" -f docs/loglog.awk "$out/points" >docs/charts/samples.svg
