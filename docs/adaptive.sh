#!/usr/bin/env bash
# What adaptive numbers of samples cost and how wrong they are: the tables behind docs/accuracy.md, printed in Markdown, and
# a chart, docs/charts/adaptive.svg.
#
#     bash docs/adaptive.sh [rms|limits|povray]
#
# Without an argument, all three. What is measured is kept in a folder, scene by scene, so that a run that was ended goes
# on where it stopped; remove the folder to measure anew. TABRAY names a program other than a new build, SHARED the folder
# of the course's scenes and of POV-Ray's, KEEP the folder of what is measured (target/adaptive), SIZE the size of the
# pictures of `rms` (640x480), SMALL that of `limits` (80x60).
set -euo pipefail
cd "$(dirname "$0")/.."

what=${1:-all}
shared=$(realpath "${SHARED:-../shared}")
target=${CARGO_TARGET_DIR:-target}
keep=${KEEP:-$target/adaptive}
mkdir -p "$keep"
if [ -z "${TABRAY:-}" ]; then
    cargo build --profile dist --locked --quiet
    TABRAY=$(realpath "$target/dist/tabray")
fi
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT

# A scene made at random from a seed: planes, spheres of all sizes, long triangles, mirrors, lights with and without size.
made() {
    awk -v seed="$1" '
    function number(from, to) { return from + (to - from) * rand() }
    function place() { return sprintf("%.3f %.3f %.3f", number(0, 8), number(0, 5), number(-7, -1)) }
    BEGIN {
        srand(seed)
        print "camera eye { pixeldim 160 120  worlddim 8 6  viewpoint 4 3 8 }"
        print "material wall { ambient 0.2 0.2 0.2  diffuse 3 3 3 }"
        for (i = 0; i < 4; i++)
            printf "material m%d { ambient %.2f %.2f %.2f  diffuse %.2f %.2f %.2f  specular %.2f  shininess 20 }\n", i,
                number(0, 0.5), number(0, 0.5), number(0, 0.5), number(0, 4), number(0, 4), number(0, 4),
                i ? 0 : number(0, 0.5)
        print "plane floor { material wall  normal 0 1 0  point 0 0 0 }"
        print "plane back { material wall  normal 0 0 1  point 0 0 -8 }"
        count = 4 + int(12 * rand())
        for (i = 0; i < count; i++)
            printf "sphere s%d { material m%d  center %s  radius %.3f }\n", i, int(4 * rand()), place(),
                0.02 + 0.9 * rand() * rand()
        for (i = 0; i < count; i++)
            printf "triangle t%d { material m%d  vertex1 %s  vertex2 %s  vertex3 %s }\n", i, int(4 * rand()), place(),
                place(), place()
        lights = 1 + int(2 * rand())
        for (i = 0; i < lights; i++)
            printf "light l%d { location %.2f %.2f %.2f  emissivity %.1f %.1f %.1f  size %.2f }\n", i, number(0, 8),
                number(5, 6), number(0, 2), number(3, 7), number(3, 7), number(3, 7), rand() < 0.4 ? number(0, 0.5) : 0
    }'
}

if [ "$what" = all ] || [ "$what" = rms ]; then
    "$TABRAY" bench --sampling rms --size "${SIZE:-640x480}" --keep "$keep" -o docs/charts/adaptive.svg \
        scenes/gallery/{marbles,three-lamps,stained-glass,hall-of-mirrors}.ray "$shared"/conformance/fplane/fplane1.txt \
        "$shared"/conformance/spec/spec1.txt scenes/texplane/tiled.ray scenes/pplane/rainbow_tiles.ray 2>/dev/null
    # The docs show one of the panels, that of three-lamps, which is the second.
    sed -i '1s/.*/<svg width="520" height="566" viewBox="520 104 520 566" xmlns="http:\/\/www.w3.org\/2000\/svg">/' docs/charts/adaptive.svg
fi

if [ "$what" = all ] || [ "$what" = limits ]; then
    for seed in {1..20}; do made "$seed" >"$out/random-$seed.ray"; done
    "$TABRAY" bench --sampling limits --size "${SMALL:-80x60}" --keep "$keep" \
        scenes/gallery/{marbles,three-lamps,stained-glass}.ray scenes/{material/transparent,light/size,projector/fit}.ray \
        scenes/texplane/tiled.ray scenes/pplane/{rainbow_tiles,tiles}.ray scenes/sphere/in-front.ray \
        "$out"/random-*.ray 2>/dev/null
fi

# Prints the RMS error and the largest one of a picture's bytes against a larger one, of four times the width and height;
# both are of 8 bits.
difference() {
    perl -e '
        use strict;
        my @read = map {
            open my $file, "<:raw", $_ or die "$_: $!";
            local $/;
            my $bytes = <$file>;
            $bytes =~ s/^P6\s+(?:#.*\n\s*)*(\d+)\s+(\d+)\s+255\s// or die "$_ is no PPM of 8 bits";
            [$1, $2, $bytes];
        } @ARGV;
        my ($large, $small) = @read;
        my ($width, $height) = @$small;
        my ($squares, $worst) = (0, 0);
        for my $y (0 .. $height - 1) {
            my @sums = (0) x (3 * $width);
            for my $row (4 * $y .. 4 * $y + 3) {
                my @bytes = unpack "C*", substr($large->[2], 12 * $width * $row, 12 * $width);
                $sums[3 * int($_ / 12) + $_ % 3] += $bytes[$_] for 0 .. $#bytes;
            }
            my @bytes = unpack "C*", substr($small->[2], 3 * $width * $y, 3 * $width);
            for (0 .. $#bytes) {
                my $off = abs($bytes[$_] - $sums[$_] / 16);
                $squares += $off * $off;
                $worst = $off if $worst < $off;
            }
        }
        printf "%.3f | %.1f", sqrt($squares / (3 * $width * $height)), $worst;
    ' "$1" "$2"
}

# POV-Ray's own error, in levels, against 256 samples per pixel: an image of four times the width and height, whose pixels
# have 16 samples each.
if [ "$what" = all ] || [ "$what" = povray ]; then
    if ! command -v povray >/dev/null || ! command -v perl >/dev/null || ! [ -d "$shared/peers" ]; then
        echo "SKIPPED: POV-Ray, Perl or $shared/peers is not installed"
        exit
    fi
    echo "| scene | POV-Ray | CPU seconds | RMS error of the bytes | worst pixel |"
    echo "|---|---|---:|---:|---:|"
    pov() {
        local scene=$1 name=$2
        shift 2
        (cd "$shared/peers" && povray "+I$scene.pov" "+O$out/$name.ppm" +FP -D -P -V -GA File_Gamma=1.0 "$@") \
            >"$out/told" 2>&1
    }
    for scene in fplane1 spec1; do
        if ! [ -e "$keep/povray-$scene.md" ]; then
            pov "$scene" large +W2560 +H1920 +A0.0 +AM1 +R4 -J
            for options in -A "+A0.3 +AM1 +R3" "+A0.1 +AM2 +R3" "+A0.03 +AM2 +R4" "+A0.1 +AM3 +R3" "+A0.03 +AM3 +R4"; do
                TIMEFORMAT='%U %S'
                # shellcheck disable=SC2086
                time=$({ time pov "$scene" small +W640 +H480 +WT1 -J $options; } 2>&1 | awk '{ print $1 + $2 }')
                echo "| $scene | \`$options\` | $time | $(difference "$out/large.ppm" "$out/small.ppm") |"
            done >"$out/rows"
            mv "$out/rows" "$keep/povray-$scene.md"
        fi
        cat "$keep/povray-$scene.md"
    done
fi
