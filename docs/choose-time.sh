#!/usr/bin/env bash
# Whether `tabray choose --max-time` is right about times: chooses for a time in seconds in each of some scenes, renders
# the choice, and prints a table in Markdown of the CPU time that was stated and the one that was taken.
#
#     bash docs/choose-time.sh target/release/tabray 1 scenes/gallery/*.ray
#
# Where a range of times was stated, the last column says whether the time taken is in it.
set -euo pipefail
tabray=$(realpath "$1")
time=$2
shift 2
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
TIMEFORMAT='%U %S'

echo "| scene | choice | CPU time stated | CPU time taken | ratio |"
echo "|---|---|---|---|---|"
for scene; do
    # A busy machine measures the same, but takes longer.
    if ! "$tabray" choose "$scene" --max-time "$time" --time-limit 10m >"$out/said" 2>"$out/error"; then
        echo "| $(basename "$scene" .ray) | none: $(tail -n 1 "$out/error") | | | |"
        continue
    fi
    # The last line is the command to use, and the times stand above it.
    read -r _ _ _ options <<<"$(tail -n 1 "$out/said")"
    # shellcheck disable=SC2086
    taken=$({ time "$tabray" render "$scene" -o "$out/chosen.png" $options 2>"$out/error"; } 2>&1)
    awk -v name="$(basename "$scene" .ray)" -v taken="$taken" '
        /^>/ { choice = $2 " " $3; stated = $9 }
        /^It takes from/ { least = $4; most = $7; range = " (" least " to " most " s)" }
        END {
            split(taken, part, " ")
            spent = part[1] + part[2]
            within = range == "" ? "" : spent < least || spent > most ? ", out of the range" : ", in the range"
            printf "| %s | %s | %.2f s%s | %.2f s | %.2f%s |\n", name, choice, stated, range, spent, spent / stated, within
        }' "$out/said"
done
