#!/bin/bash
# Proves the colours of all scenes, with one sample a pixel, and prints a table, whose sums are in accuracy.md.
# Usage: docs/colours.sh [PROGRAM]
cd "$(dirname "$0")/.." || exit 1
program=${1:-target/release/tabray}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
TIMEFORMAT=%U
while read -r scene; do
    kind=without
    grep -v '^#' "$scene" | grep -qE 'specular|transparency|^(glass|metal) ' && kind=with
    rendered=$({ time "$program" render --method exact --samples 1 "$scene" -o "$folder/a.ppm" 2>"$folder/err"; } 2>&1) || continue
    proven=$({ time "$program" verify --colours --method exact --samples 1 --time-limit 300s --json "$scene" >"$folder/found" 2>/dev/null; } 2>&1)
    # Numbers of pixels: all, proven, rounded, open, contradicted, not reached.
    numbers=$(grep -oE '^ +"(all|proven|rounded|open|contradicted|not_reached)": [0-9]+' "$folder/found" | head -6 | grep -oE '[0-9]+$' | tr '\n' ' ')
    [ -n "$numbers" ] && echo "$kind $scene $numbers $rendered $proven"
done < <(find scenes -name '*.ray' -o -name '*.toml' | grep -v '^scenes/wrong/' | sort) >"$folder/all"
[ -n "$KEEP" ] && cp "$folder/all" "$KEEP"
awk '
    { n[$1]++; for (i = 3; i <= 10; i++) sum[$1, i] += $i; share = $4 / $3; if (!($1 in least) || share < least[$1]) { least[$1] = share; where[$1] = $2 } }
    END {
        print "| scenes | number | pixels | proven | off by rounding | open | contradicted | least in a scene | time, times that of the render |"
        print "|---|---|---|---|---|---|---|---|---|"
        for (k = 0; k < 2; k++) {
            kind = k ? "with" : "without"
            printf "| %s mirrors or glass | %d | %d | %.3f %% | %d | %d | %d | %.2f %%, `%s` | %.0f |\n", kind, n[kind], sum[kind, 3], 100 * sum[kind, 4] / sum[kind, 3], sum[kind, 5], sum[kind, 6] + sum[kind, 8], sum[kind, 7], 100 * least[kind], substr(where[kind], 8), sum[kind, 10] / sum[kind, 9]
        }
    }' "$folder/all"
