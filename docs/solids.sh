#!/usr/bin/env bash
# Solids and a turned piece beside POV-Ray's csg and lathe: a table in Markdown of the CPU seconds for an image of
# 640 x 480 pixels on one thread, the least of some rounds, and of the pixels in which POV-Ray sees something else. Each
# part has a colour of its own, and all pixels of tabray are proven by `tabray verify`.
#
#     bash docs/solids.sh [ROUNDS]
#
# TABRAY names a program other than a new build.
set -euo pipefail
cd "$(dirname "$0")/.."

rounds=${1:-5}
if [ -z "${TABRAY:-}" ]; then
    cargo build --profile dist --locked --quiet
    TABRAY=$(realpath "${CARGO_TARGET_DIR:-target}/dist/tabray")
fi
if ! command -v povray >/dev/null; then
    echo "SKIPPED: POV-Ray is not installed"
    exit
fi
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT

# The least CPU seconds of a command in some rounds.
least() {
    local TIMEFORMAT='%U %S'
    for ((round = 0; round < rounds; round++)); do
        { time "$@" >"$out/told" 2>&1 || { cat "$out/told" >&2; exit 1; }; } 2>&1
    done | awk '{ print $1 + $2 }' | sort -g | head -1
}

# One row: the objects of $out/ours.txt and those of $out/pov.txt, from the same place through the same pixels.
row() {
    local name=$1
    cat - "$out/ours.txt" >"$out/ours.ray" <<'SCENE'
camera eye { pixeldim 640 480  worlddim 8 6  viewpoint 4 3 7 }
material white { ambient 1 1 1 }
material red { ambient 1 0 0 }
material green { ambient 0 1 0 }
SCENE
    # POV-Ray's pixels have their places in their middles.
    cat - "$out/pov.txt" >"$out/pov.pov" <<'SCENE'
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <4,3,7> direction <0,0,-7> up <0,6*480/479,0> right <8*640/639,0,0> look_at <4,3,0> }
#default { finish { ambient 1 diffuse 0 } }
#declare White = texture { pigment { rgb 1 } };
#declare Red = texture { pigment { rgb <1,0,0> } };
#declare Green = texture { pigment { rgb <0,1,0> } };
SCENE
    "$TABRAY" verify "$out/ours.ray" | grep -q '(100.0000 %)' || { echo "$name: not proven" >&2; exit 1; }
    printf '| %s | %s | %s ' "$name" "$(least "$TABRAY" render "$out/ours.ray" --threads 1 -o "$out/ours.ppm")" \
        "$(least povray "+I$out/pov.pov" +W640 +H480 -A +WT1 +FP "+O$out/pov.ppm" -D -P -V -GA)"
    # The colours of each image, a line for each pixel.
    for image in ours pov; do
        tail -c $((640 * 480 * 3)) "$out/$image.ppm" | od -An -v -tu1 -w3 |
            awk '{ print ($1 > 0) ($2 > 0) ($3 > 0) }' >"$out/$image.hits"
    done
    paste "$out/ours.hits" "$out/pov.hits" |
        awk '$1 != "000" || $2 != "000" { hits++ } $1 != $2 { wrong++ } END { printf "| %d of %d |\n", wrong, hits }'
}

echo '| solid | tabray (s) | POV-Ray (s) | wrong pixels of POV-Ray |'
echo '|---|--:|--:|--:|'

cat >"$out/ours.txt" <<'SCENE'
box cube { material white  center 0 0 0  size 2 2 2 }
sphere around { material green  center 0 0 0  radius 1.4 }
intersection round { objects cube around }
sphere one { material red  center 0 1.1 0  radius 0.35 }
sphere two { material red  center -0.45 -0.45 1.1  radius 0.3 }
sphere three { material red  center 0.45 0.45 1.1  radius 0.3 }
sphere four { material red  center 1.1 -0.55 -0.55  radius 0.28 }
sphere five { material red  center 1.1 0 0  radius 0.28 }
sphere six { material red  center 1.1 0.55 0.55  radius 0.28 }
difference die { objects round one two three four five six }
place shown { object die  rotation 30 -35 0  translation 4 3 -1 }
SCENE
cat >"$out/pov.txt" <<'SCENE'
difference {
  intersection { box { -1, 1 texture { White } } sphere { 0, 1.4 texture { Green } } }
  sphere { <0,1.1,0>, 0.35 texture { Red } }
  sphere { <-0.45,-0.45,1.1>, 0.3 texture { Red } } sphere { <0.45,0.45,1.1>, 0.3 texture { Red } }
  sphere { <1.1,-0.55,-0.55>, 0.28 texture { Red } } sphere { <1.1,0,0>, 0.28 texture { Red } }
  sphere { <1.1,0.55,0.55>, 0.28 texture { Red } }
  rotate <30,0,0> rotate <0,-35,0> translate <4,3,-1>
}
SCENE
row 'a die'

# 100 holes, bored through a plate whose back is seen through them.
echo 'box plate { material white  center 4 3 -1  size 6 5 0.5 }' >"$out/ours.txt"
names=''
echo 'difference { box { <1,0.5,-1.25>, <7,5.5,-0.75> texture { White } }' >"$out/pov.txt"
for row in 0 1 2 3 4 5 6 7 8 9; do
    for column in 0 1 2 3 4 5 6 7 8 9; do
        x=$(awk "BEGIN { print 1.3 + 0.6 * $column }") y=$(awk "BEGIN { print 0.75 + 0.5 * $row }")
        echo "cylinder h$row$column { material red  base $x $y -2  direction 0 0 1  height 2  radius 0.2 }" >>"$out/ours.txt"
        echo "cylinder { <$x,$y,-2>, <$x,$y,0>, 0.2 texture { Red } }" >>"$out/pov.txt"
        names+=" h$row$column"
    done
done
echo "difference bored { objects plate$names }" >>"$out/ours.txt"
echo '}' >>"$out/pov.txt"
row 'a plate with 100 holes'

# The front of what is cut away lies in the front of the box.
cat >"$out/ours.txt" <<'SCENE'
box block { material white  center 4 3 -2  size 4 4 2 }
box recess { material red  center 4 3 -1.5  size 2 2 1 }
difference cut { objects block recess }
SCENE
cat >"$out/pov.txt" <<'SCENE'
difference { box { <2,1,-3>, <6,5,-1> texture { White } } box { <3,2,-2>, <5,4,-1> texture { Red } } }
SCENE
row 'a recess flush with a side'

# Two boxes of one size share a side, and a cylinder stands on them, flush with its base.
cat >"$out/ours.txt" <<'SCENE'
box left { material white  center 3 1 -2  size 2 2 2 }
box right { material red  center 5 1 -2  size 2 2 2 }
cylinder post { material green  base 4 2 -2  height 2  radius 0.8 }
union joined { objects left right post }
SCENE
cat >"$out/pov.txt" <<'SCENE'
merge {
  box { <2,0,-3>, <4,2,-1> texture { White } } box { <4,0,-3>, <6,2,-1> texture { Red } }
  cylinder { <4,2,-2>, <4,4,-2>, 0.8 texture { Green } }
}
SCENE
row 'boxes that share a side'

# A natural spline through three points, as two Bézier curves.
cat >"$out/ours.txt" <<'SCENE'
lathe vase { material white  points 0 0.4  1 1  2 0.3  base 4 2 -1 }
SCENE
awk -v a=0.4 -v b=1 -v c=0.3 'BEGIN {
    m = 1.5 * (a - 2 * b + c)
    one = b - a - m / 6; two = b - a + m / 3; three = c - b + m / 6
    printf "lathe { bezier_spline 8, <%.17g,0>, <%.17g,%.17g>, <%.17g,%.17g>, <%.17g,1>,", a, a + one / 3, 1 / 3, b - two / 3, 2 / 3, b
    printf "<%.17g,1>, <%.17g,%.17g>, <%.17g,%.17g>, <%.17g,2>", b, b + two / 3, 4 / 3, c - three / 3, 5 / 3, c
    print " texture { White } translate <4,2,-1> }"
}' >"$out/pov.txt"
row 'a turned piece'
