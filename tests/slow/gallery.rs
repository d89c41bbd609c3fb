//! The gallery of charts: writes `docs/charts.md` and the images that it shows.
//!
//! `cargo test --profile dist --test slow -- --ignored --nocapture gallery`

use crate::common::root;
use assert_cmd::cargo::cargo_bin_cmd;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const COMMAND: &str = "cargo test --profile dist --test slow -- --ignored --nocapture gallery";

/// Scenes, their titles, and what to look for in their charts.
const SCENES: [(&str, &str, &str); 8] = [
    (
        "revsurf/surfer-0",
        "The notes' vase",
        "Steps and samples find nearly all hits of camera rays, but lose a third of those at silhouettes, which are \
         few pixels of an image and the ones that people look at. There the default proves its hits; turning points, \
         which prove nothing, are faster and, on so smooth a profile, as accurate. The flange below shows what they \
         rely on.",
    ),
    (
        "revsurf/surfer-1",
        "The notes' cone",
        "Its square is a parabola, so a single slab of the default represents it without an error: `draft` is as \
         exact as `exact` except for grazing rays.",
    ),
    (
        "hard/ripples",
        "A column with 20 waves",
        "Methods whose samples have two turning points between them lose hits, or find later ones.",
    ),
    (
        "hard/flange-from-above",
        "A thin disc on a rod",
        "Here every method that samples has wrong hits. That includes the one that looks for turning points, which is \
         faster than the default where a profile is smooth: nothing says beforehand that 16 samples are enough. \
         Bounds need no such guess.",
    ),
    (
        "gallery/hall-of-mirrors",
        "A hall of mirrors",
        "Planes and spheres near the viewer: the choice of method changes no pixel, and the samples take the time.",
    ),
    (
        "hard/far-camera",
        "A vase from ten million units away",
        "No distance is more exact than half a unit in its last place, 9e-10 there, which is the error of all methods \
         that compute from near the surface. The notes follow a ray for 100 units between a surface's heights, and \
         have lost it by then.",
    ),
    (
        "camera/samples",
        "Edges",
        "The error of evenly spread samples falls with nearly twice the exponent of that of random ones.",
    ),
    (
        "light/size",
        "Soft shadows",
        "The last panel samples the centres of pixels only, so it shows the shadows alone.",
    ),
];

/// Runs the program, which must succeed, and returns its standard output.
fn tabray(arguments: &[&str], folder: &Path) -> String {
    let output = cargo_bin_cmd!("tabray").current_dir(folder).args(arguments).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// Asserts that a chart shows the name of every choice, however crowded it is. The choices of samples are left out,
/// because their names are numbers, which axes have, too; so are choices that find nothing, which have no error and no
/// place in the chart.
fn every_choice_has_its_name(table: &str, drawing: &str) {
    let rows = table.lines().skip(1).filter(|row| !row.starts_with("\"samples"));
    let has_error = |row: &str| row.rsplit(',').nth(8).is_some_and(|error| error != "NaN");
    let mut names: Vec<_> =
        rows.filter(|row| has_error(row)).filter_map(|row| row.split('"').nth(3)).collect();
    names.sort_unstable();
    for same in names.chunk_by(|one, other| one == other) {
        let drawn = drawing.lines().filter(|line| line.starts_with(same[0])).count();
        assert!(drawn >= same.len(), "{} names of {} points `{}`", drawn, same.len(), same[0]);
    }
}

#[test]
#[ignore = "runs for minutes; its times are a document"]
fn the_gallery_of_charts_is_drawn() {
    let docs = root().join("docs");
    let pictures = docs.join("charts");
    let _ = fs::remove_dir_all(&pictures);
    fs::create_dir_all(&pictures).expect("room for pictures");
    let folder = TempDir::new().expect("a folder");
    let mut text = INTRODUCTION.replace("COMMAND", COMMAND);
    for (scene, title, words) in SCENES {
        let path = root().join("scenes").join(scene).with_extension("ray");
        let verdict =
            tabray(&["chart", path.to_str().expect("UTF-8"), "-o", ".", "--time-limit", "1h"], folder.path());
        let name = path.file_stem().expect("a name").to_str().expect("UTF-8");
        for extension in ["png", "csv"] {
            let file = folder.path().join(format!("{name}-chart.{extension}"));
            fs::copy(file, pictures.join(format!("{name}.{extension}"))).expect("a copy");
        }
        let read = |extension: &str| {
            let file = folder.path().join(format!("{name}-chart.{extension}"));
            fs::read_to_string(file).expect("it is written")
        };
        every_choice_has_its_name(&read("csv"), &read("svg"));
        println!("{title}\n{verdict}");
        write!(
            text,
            "\n## {title}\n\n[{scene}.ray](../scenes/{scene}.ray). {words}\n\n![{title}](charts/{name}.png)\n\n\
             The numbers: [{name}.csv](charts/{name}.csv). The verdict:\n\n```text\n{}\n```\n",
            verdict.trim_end()
        )
        .expect("text grows");
    }
    for method in ["classic", "exact"] {
        let picture = format!("{method}.png");
        let scene = root().join("scenes/hard/ripples.ray");
        let scene = scene.to_str().expect("UTF-8");
        let arguments = ["render", scene, "--method", method, "--aov", "cost,error", "-o", &picture];
        tabray(&arguments, folder.path());
        for aov in ["cost", "error"] {
            let name = format!("{method}-{aov}.png");
            fs::copy(folder.path().join(&name), pictures.join(format!("ripples-{name}"))).expect("a copy");
        }
    }
    text += HEAT_MAPS;
    let path = docs.join("charts.md");
    fs::write(&path, text).expect("the folder of the documents is there");
    println!("wrote {}", path.display());
}

const INTRODUCTION: &str = "# Speed against accuracy

What does each choice cost, how large is its error, and is the default the right choice? `tabray chart SCENE` answers
this for any scene. This page shows the charts of some scenes, each with its machine and its date. This command writes
the charts and the page:

```sh
COMMAND
```

## How to read a chart

The verdict of a chart begins with what to do. What rests on errors comes first, as other work of the machine does not
change it; where the machine was busy, times decide nothing, and the last line says to measure them again. A method is
advised only if it bounds the errors of its hits and has no wrong ones in any panel. `classic` and the methods that sample
have no bounds: they lose some of the hard rays of each kind of shape, as [accuracy.md](accuracy.md) counts, even where
they lose none in a scene. `-o a.svg` writes that file alone.

Each panel answers one question. The horizontal axis is CPU time and the vertical axis the error, both logarithmic: the
best place is the lower left. The star is the scene's own setting. A hollow point has hits that are missed, invented,
not the first or inaccurate; their percentage of all rays is written beside it. The line is the Pareto front: of the
choices without such hits in any panel, those that no other beats in both time and error. Times that differ by less than
a tenth count as equal, and so do errors that differ by less than a half.

- **Camera rays**: about 20000 pairs of a ray through a pixel and an object, in evenly spread tiles of 16 by 16 pixels.
  Objects are separated by kind: those whose hits are found by a search along the ray, and those with a formula.
- **Grazing rays**: pairs beside the edge of an object as the camera sees it, at distances from one pixel down to 10^-10
  of one. An error in the last digit changes their distances by its square root.
- **The image, by method**: one ray through each pixel, and the difference of its colours from those of `strict`.
- **Samples per pixel**: the error of the image against 1024 other samples. `sobol` samples are evenly spread, `random`
  ones are those of the notes.
- **Reflections and transmissions**: one ray through each pixel, in scenes with mirrors or glass. Each choice ends paths
  after a number of reflections and transmissions; its error is the difference from the image with all visible ones.
- **The whole image**: accuracy and samples together, as `tabray choose` measures them: pixels drawn at random
  against more samples, with all sources of error.

Errors of distances are the 99th percentile of all right hits. The ground truth is that of the real ray through the
point of the image and of the scene's numbers as they are read: a hit is isolated by intervals of 237 bits, as in
`tabray verify`, which names what that assumes, and the error of a distance includes the effect of rounding the ray. Where the intervals do not decide,
the pair is left out and counted as undecided.

A found hit is judged by what it is, not by how far off it is. It is *missed* if the ray has a root and none was found,
*invented* if it has none, and *later* only if another root lies between it and the first one. It is *inaccurate* if no
root lies between, but its point is farther from the surface than rounding and the method's own tolerance explain. The
distance itself would say little: on a plane that a ray nearly runs along, rounding the ray's direction moves the hit by
millions of units. Each panel says how far rounding may move the hits that it moves most, the error across the surface
divided by the cosine. Where a ray within rounding of the true one hits what was found, rounding decides and not the method;
and in places the notes mean another surface, as the upper half of a cone. The pair is then left out for that method.

Errors of colours are root mean squares over pixels and channels, of the
colours as displayed, from 0 to 1; their truth is this renderer, by `strict` or with more samples, so that what it draws
wrongly in both is no error here. Errors depend on the scene alone: two runs give the same errors to the last digit,
unless the time limit, 2 minutes if `--time-limit` does not set it, leaves time for fewer pixels; the panel has their number.

Times are CPU times of one thread, of the same work for each choice in turn, in up to 15 rounds after a warm-up round;
the minimum counts. Distances are timed on about 2000 of the pairs, images on some of their tiles. Both are traced as in
a render: up to 256 rays at a time, with the best instructions of the processor. Where a hit is searched for, only
`draft`, `exact` and `strict` trace the rays of a packet together; all other methods trace them one by one, which
accounts for part of the default's advantage. Most grazing rays are traced one by one by the default, too.

The caption gives the difference between the median and the minimum round, for the median choice: above 15 % it says not
to trust the times. If rounds waited long for other work of the machine, the caption says so: waiting is not part of CPU
time, but cores that share a cache or an arithmetic unit slow each other down, for all choices alike.

## The methods

The methods without a link are `tabray`'s own: `classic` is the method of the notes' program, and `draft`, `exact` and
`strict` are those that a scene chooses with `accuracy`; see [how exact the methods are](accuracy.md). `strict` changes
closed forms only: where a hit is searched for, it gives the same numbers as `exact`. The other methods, such as `steps`,
replace the search only: objects with a closed form keep the numbers of `exact`, and a scene without searched objects has
no such points.

| point | method | where it fails |
|---|---|---|
| `classic` | one bracket, from the viewer to the ray's point closest to the axis | silhouettes, inner walls, distant spheres |
| [`steps of 0.1`](../src/exact/roots/steps.rs) | the notes' page on procedural surfaces: steps, then bisection to 1e-6 | anything thinner than a step |
| [`64 + ...`](../src/exact/roots/samples.rs) | samples in the bounding cylinder, then a refiner: [bisection](../src/exact/roots/bisection.rs), [Chandrupatla](../src/exact/roots/chandrupatla.rs) or [Newton](../src/exact/roots/newton.rs) | silhouettes, however many samples |
| [`16 + turning points`](../src/exact/roots/turning.rs) | samples, and the turning points of the function between them | functions that turn twice between two samples |
| [`sphere tracing`](../src/exact/roots/tracing.rs) | steps of a length that a bound of the slope allows | hits surfaces that it only passes closely; slow at silhouettes |
| [`intervals`](../src/exact/roots/intervals.rs) | bounds of values and slopes (Mitchell 1990) | slow at silhouettes |
| [`Taylor bounds`](../src/exact/roots/taylor.rs) | bounds of the curvature, too; the method for shapes given by one formula | a few of a hundred thousand near tangents: [the falsifier](falsify.md) counts them |
| `draft`, `exact`, `strict` | for surfaces of revolution, quadrics with a proven error, then Newton; Taylor bounds for grazing rays | a few of a hundred thousand near tangents: [the falsifier](falsify.md) counts them |

The counts here differ from those of [accuracy.md](accuracy.md) and of other tables, because the rays differ. There, all
rays of a kind go through one scene, with a million for each profile; here they are those of the scene's own camera, and
grazing rays lie at the silhouettes that it sees. There, the camera is closer, and rays that miss a surface's heights
are counted as well. Half of the grazing rays miss the object here, and no method loses those: a method that loses 60 of
100 tangents has 30 % here. What agrees in both is which methods have wrong hits and which have none.
";

const HEAT_MAPS: &str = "
## Where time goes and where errors are

`render --aov cost,error` writes both beside the image: the number of rays of each pixel, and the difference of its
colour from that of 64 exactly traced samples, in red where its centre sees another object. With `-o a.png`,
`a-error.exr` has the numbers: the error of the colour, the error of the distance, and 1 where the object differs.

| rays, `--method classic` | error, `--method classic` | error, `--method exact` |
|---|---|---|
| ![cost](charts/ripples-classic-cost.png) | ![error](charts/ripples-classic-error.png) | ![error](charts/ripples-exact-error.png) |

```sh
for method in classic exact; do
    cargo run --release -- render scenes/hard/ripples.ray --method $method --aov cost,error -o $method.png
done
```

The classic method loses hits at every ripple; what remains with the exact method are edges, which samples smooth.

## Choosing

`tabray choose SCENE --max-error 2` quickly measures the effect of accuracy and samples on a scene, shows the choices
that it considered, and prints the command line to use; `--max-time 2` chooses the best within two seconds on all cores.
With `--worst`, the error is that which one of a thousand pixels exceeds, instead of the root mean square.

Each error has a bound that holds with a confidence of 99 %, and the bound of what is chosen is at most what was asked
for. Pixels that may show lamps, wires or glints smaller than what is between samples are found and measured by
themselves; if that is not enough, there is no promise and no choice. The samples are chosen by counts, so that the same
scene has the same answer. Another accuracy than the scene's is chosen only if it takes at most 80 % of its time in each
of five groups of packets of rays, and `classic` only where it is the scene's own. Times are
[measured](choose.md#how-times-are-measured) for each number of samples. Where an image needs 16 samples or more,
`--samples 4..16`, `4..64` and `4..256` are measured too, and one is chosen if it takes at most 80 % of the rays of the
fixed number, with its probes: a count, not a time. Choosing takes about a million rays to compare the choices, up to 4
million for small things, and then measures the likely choice on as many pixels as its bound needs, with 8 to 64 samples
beside its own. It ends after 10 seconds unless `--time-limit` gives it more.
[What a promise rests on, and what was measured](choose.md).
";
