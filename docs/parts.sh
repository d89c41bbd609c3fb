#!/usr/bin/env bash
# What parts cost: the CPU time of an image rendered whole and in 16 parts, on one thread, in turns; and the merging of
# 40,000 x 30,000 pixels beside copying its parts. Takes 7 minutes of CPU time and 5 GB of disk.
#
#     bash docs/parts.sh [ROUNDS]
set -euo pipefail
cd "$(dirname "$0")/.."
rounds=${1:-2}
cargo build --release --locked --quiet
tabray=$(realpath "${CARGO_TARGET_DIR:-target}/release/tabray")
marbles=$(realpath scenes/gallery/marbles.ray)
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
cd "$out"

# Adds the seconds of the clock, the CPU seconds and the MB of a command to a file.
timed() {
    local into=$1
    shift
    env time -a -o "$into" -f '%e %U %S %M' "$@"
}
cpu() { awk '{ all += $2 + $3; if ($2 + $3 > most) most = $2 + $3 } END { printf "%.2f s, the longest %.2f s\n", all, most }' "$1"; }

for ((round = 0; round < rounds; round++)); do
    rm -f whole parts
    options=(--size 3200x2400 --samples 64 --threads 1 -q)
    timed whole "$tabray" render "$marbles" "${options[@]}" -o whole.png
    for part in $(seq 16); do timed parts "$tabray" render "$marbles" "${options[@]}" -o parts.png --part "$part/16"; done
    timed parts "$tabray" merge parts.png -q --remove-parts
    cmp whole.png parts.png
    printf 'whole: %s16 parts and merging: %s' "$(cpu whole)
" "$(cpu parts)
"
done

cat >ball.ray <<'SCENE'
camera eye { pixeldim 40000 30000  worlddim 8 6  viewpoint 4 3 6 }
material paint { ambient 0.1 0.4 0.8 }
sphere ball { material paint  center 4 3 -2  radius 2 }
SCENE
for part in 1 2 3 4; do "$tabray" render ball.ray -o big.png -q --part "$part/4"; done
rm -f merge copy
timed merge "$tabray" merge big.png -q
timed copy sh -c 'cat big.png.part-* >copy.bin'
size=$(stat -c %s big.png.part-* | awk '{ all += $1 } END { print all / 1e6 }')
awk -v size="$size" '{ printf "merging %d MB of parts: %.1f s, %.0f MB/s, %.2f s of CPU, %d MB of memory\n", size, $1, size / $1, $2 + $3, $4 / 1024 }' merge
awk -v size="$size" '{ printf "copying them: %.1f s, %.0f MB/s\n", $1, size / $1 }' copy
