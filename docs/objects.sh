#!/usr/bin/env bash
# What many objects cost, beside Embree, which takes turns with tabray. Prints a table in Markdown. Without Embree or a
# compiler of C++, its columns stay empty.
#
#     bash docs/objects.sh
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
if c++ -O3 -march=native docs/embree.cpp -o "$out/embree" -lembree3 2>"$out/told"; then
    export EMBREE=$out/embree
else
    echo "SKIPPED: docs/embree.cpp does not compile, which needs g++ and libembree-dev"
fi
cargo test --profile dist --locked --quiet --test slow -- --ignored --nocapture many_objects
