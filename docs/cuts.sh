#!/usr/bin/env bash
# What a scene does not use costs nothing: counts the instructions of renders of a scene without lights, mirrors and
# additional samples, by this program and by builds from which the code for those has been removed. Prints a table in
# Markdown. Instructions are counted by Valgrind, on one thread with AVX2, minus those of an image of one pixel.
#
#     bash docs/cuts.sh
set -euo pipefail
cd "$(dirname "$0")/.."
if ! command -v valgrind >/dev/null && ! apt-get install --yes --quiet valgrind >/dev/null; then
    echo "SKIPPED: there is no Valgrind"
    exit
fi
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
target=${CARGO_TARGET_DIR:-target}/cuts

cat >"$out/scene.ray" <<'SCENE'
camera eye { pixeldim 320 240  worlddim 8 6  viewpoint 4 3 6 }
material blue { ambient 5 5 10 }
material grey { ambient 5 5 5 }
plane floor { material grey  normal 0 1 0  point 0 0 0 }
plane back { material grey  normal 0.2 0.1 1  point 0 0 -9 }
sphere ball { material blue  center 3 2 -4  radius 1.5 }
revsurf vase { material blue  profile "1 + sin(y) / 2"  direction 0 1 0  base 6 0 -5  height 5 }
SCENE

# The instructions of a render at a size.
count() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$1" render "$out/scene.ray" --size "$2" --threads 1 \
        --cpu avx2 -o "$out/picture.ppm" 2>&1 | awk '/Collected/ { print $NF }'
}

# The instructions for each ray of a build of the sources, one file of them as Perl leaves it.
build() {
    local sources=$out/sources
    rm -rf "$sources"
    mkdir "$sources"
    cp -r Cargo.toml Cargo.lock src plugins tests "$sources"
    if [ $# -gt 0 ]; then
        perl -0pi -e "$2" "$sources/$1"
        ! cmp -s "$1" "$sources/$1" || { echo "nothing is cut from $1" >&2; exit 1; }
    fi
    cargo build --profile dist --locked --quiet --manifest-path "$sources/Cargo.toml" --target-dir "$target" 2>/dev/null
    awk -v all="$(count "$target/dist/tabray" 320)" -v none="$(count "$target/dist/tabray" 1x1)" \
        'BEGIN { print (all - none) / (320 * 240) }'
}

whole=$(build)
row() { awk -v name="$1" -v of="$2" -v whole="$whole" 'BEGIN { printf "| %s | %.1f | %.4f |\n", name, of, whole / of }'; }
echo "| build | instructions per ray | ratio of the whole program to it |"
echo "|---|---:|---:|"
row "whole" "$whole"
row "without lights" "$(build src/render/trace/shade.rs 's/self\.illuminate\(.*?\);//')"
row "without mirrors" "$(build src/render/trace/shade.rs 's/self\.add_reflected\(.*?\);//')"
row "without additional samples" "$(build src/render/trace/mod.rs 's/if camera\.samples == 1 \{/if true {/')"
