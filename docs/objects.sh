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

# Writes the scenes that src/tools/bench/scenes.rs makes. A mesh is that of the triangles.
write() {
    awk -v name="$1" -v count="$2" -v ply="$out/scene.ply" '
        function part(x) { return x - int(x) }
        function at(ring, step,    y, angle, radius) {
            y = 6.25 * ring / rings; angle = 6.283185307179586 * (step % around) / around; radius = 2 + sin(y)
            return sprintf("%.17g %.17g %.17g", 4 + radius * cos(angle), y, -4 + radius * sin(angle))
        }
        BEGIN {
            print "camera eye { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 7 }"
            print "material white { ambient 1 1 1 diffuse 4 4 4 }"
            print "light left { location 2 4 0 emissivity 3 3 3 }"
            print "light right { location 6 4 0 emissivity 3 3 3 }"
            if (name == "sphere") {
                for (i = 0; i < count; i++)
                    printf "sphere s%d { material white center %.17g %.17g %.17g radius %.17g }\n", i, \
                        8 * part((i + 1) * 0.8191725133961645), 6 * part((i + 1) * 0.6710436067037893), \
                        -8 * part((i + 1) * 0.5497004779019702) - 1, 1.5 / sqrt(count)
                exit
            }
            rings = int(sqrt(count / 2)); around = int(count / 2 / rings)
            if (name == "mesh") {
                print "mesh all { material white file \"scene.ply\" }"
                print "ply\nformat ascii 1.0\nelement vertex " (rings + 1) * around >ply
                print "property double x\nproperty double y\nproperty double z" >ply
                print "element face " 2 * rings * around "\nproperty list uchar int vertex_indices\nend_header" >ply
                for (i = 0; i < (rings + 1) * around; i++) print at(int(i / around), i % around) >ply
                for (i = 0; i < rings * around; i++) {
                    a = i; b = i - i % around + (i + 1) % around
                    print "3 " a, b, a + around "\n3 " b, b + around, a + around >ply
                }
                exit
            }
            for (i = 0; i < rings * around; i++) {
                ring = int(i / around); step = i % around
                a = at(ring, step); b = at(ring, step + 1); c = at(ring + 1, step); d = at(ring + 1, step + 1)
                printf "triangle low%d { material white vertex1 %s vertex2 %s vertex3 %s }\n", i, a, b, c
                printf "triangle high%d { material white vertex1 %s vertex2 %s vertex3 %s }\n", i, b, d, c
            }
        }' >"$out/scene.ray"
}

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
