#!/usr/bin/env bash
# CPU seconds of whole programs that render the same image, a PNG of 640 x 480 pixels, on one thread: tabray, POV-Ray
# and, if the variable COURSE names it, the course's program, which writes a PPM. They take turns, so that other load on
# the machine affects all of them. Prints a table in Markdown: the minimum time of each, and the medians of the ratios of
# consecutive runs.
#
#     bash docs/peers.sh [ROUNDS]
#
# TABRAY names a program other than a new build. The scenes of the other programs are in the folder given by SHARED.
set -euo pipefail
cd "$(dirname "$0")/.."

rounds=${1:-15}
shared=$(realpath "${SHARED:-../shared}")
peers=$shared/peers
scenes=$shared/conformance
if ! [ -d "$peers" ]; then
    echo "SKIPPED: $peers does not exist"
    exit
fi
if ! command -v povray >/dev/null && ! apt-get install --yes --quiet povray >/dev/null; then
    echo "SKIPPED: POV-Ray is not installed"
    exit
fi
if [ -z "${TABRAY:-}" ]; then
    cargo build --profile dist --locked --quiet
    TABRAY=$(realpath "${CARGO_TARGET_DIR:-target}/dist/tabray")
fi
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT

# The CPU seconds that a command takes, the mean of some runs. It stops the script where the command fails.
seconds() {
    local TIMEFORMAT='%U %S' runs=$1
    shift
    for ((run = 0; run < runs; run++)); do "$@" >"$out/told" 2>&1 || { cat "$out/told" >&2; exit 1; }; done
    { time for ((run = 0; run < runs; run++)); do "$@" >/dev/null 2>&1; done; } 2>&1 |
        awk -v runs="$runs" '{ print ($1 + $2) / runs }'
}

ours() { "$TABRAY" render "$out/$1.ray" -o "$out/$1.png" --threads 1; }
course() { "$COURSE" <"$out/$1.ray" >"$out/$1.ppm" 2>/dev/null; }
pov() {
    local scene=$1
    shift
    (cd "$peers" && povray "+I$scene.pov" +W640 +H480 -A +WT1 +FN "+O$out/pov.png" -D -P -V -GA File_Gamma=1.0 "$@")
}

least() { sort -g "$1" | head -1; }
median() { sort -g "$1" | awk '{ all[NR] = $1 } END { print (all[int((NR + 1) / 2)] + all[int(NR / 2) + 1]) / 2 }'; }

# One row: the scene's name, then what POV-Ray is to be told beside it.
row() {
    local name=$1 scene=$2
    shift 2
    local rival_runs=1 course_least=- course_ratio=-
    : >"$out/ours" && : >"$out/pov" && : >"$out/course"
    for ((round = 0; round < rounds; round++)); do
        seconds 5 ours "$scene" >>"$out/ours"
        seconds "$rival_runs" pov "$scene" "$@" >>"$out/pov"
        if [ -n "${COURSE:-}" ]; then seconds 2 course "$scene" >>"$out/course"; fi
    done
    paste "$out/pov" "$out/ours" | awk '{ print $1 / $2 }' >"$out/ratios"
    if [ -n "${COURSE:-}" ]; then
        paste "$out/course" "$out/ours" | awk '{ print $1 / $2 }' >"$out/course-ratios"
        course_least=$(printf %.4f "$(least "$out/course")")
        course_ratio=$(printf %.1f "$(median "$out/course-ratios")")
    fi
    printf '| %s | %.4f | %.3f | %.1f | %s | %s |\n' "$name" "$(least "$out/ours")" "$(least "$out/pov")" \
        "$(median "$out/ratios")" "$course_least" "$course_ratio"
}

resized() { sed 's/pixeldim *[0-9]* *[0-9]*/pixeldim 640 480/' "$scenes/$1.txt" >"$out/$2.ray"; }
resized fplane/fplane1 fplane1
resized spec/spec1 spec1
resized spec/spec8 spec8
resized glint/shiny2 shiny2
resized revsurf/revsurfa revsurfa
cat >"$out/revsurfe.ray" <<'SCENE'
camera eye { pixeldim 640 480  worlddim 8 6  viewpoint 4 3 12 }
material mirror { ambient 1 1 1  diffuse 4 4 4  specular 1 }
material gold { ambient 1 1 0  diffuse 4 4 0 }
revsurf right { material mirror  profile "1 + cos(y)/2"  direction 0 1 0  base 6 0 -4  height 6.28 }
revsurf left { material gold  profile "1 + sin(y)/2"  direction 0 1 0  base 2 0 -4  height 6.28 }
plane floor { material mirror  normal 0 1 0  point 0 0.01 0 }
light one { location 2 4 0  emissivity 6 1 2 }
light two { location 6 4 0  emissivity 2 1 6 }
light three { location 6 4 0  emissivity 1 6 2 }
SCENE

povray --version 2>&1 | grep -m1 '^POV-Ray' | sed 's/.*/&, CPU seconds:/'
[ -n "${COURSE:-}" ] || echo "SKIPPED: COURSE names no program of the course"
echo
echo "| scene | tabray | POV-Ray | ratio | the course's program | ratio |"
echo "|---|---:|---:|---:|---:|---:|"
row fplane1 fplane1
row spec1 spec1
row spec8 spec8
row shiny2 shiny2
row "a cone" revsurfa
row "two vases and a mirror, as isosurfaces" revsurfe
row "the same, as lathes of cubic splines" revsurfe Declare=Shape=3
row "the same, as \`sor\`" revsurfe Declare=Shape=2
