//! The gallery of charts: writes `docs/charts.md` and the pictures that it shows.
//!
//! `cargo test --profile dist --test slow -- --ignored --nocapture gallery`

use crate::common::root;
use assert_cmd::cargo::cargo_bin_cmd;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const COMMAND: &str = "cargo test --profile dist --test slow -- --ignored --nocapture gallery";

/// Scenes, what they are and what to look for.
const SCENES: [(&str, &str, &str); 8] = [
    (
        "revsurf/surfer-0",
        "The notes' vase",
        "Steps and samples find nearly all of the camera's rays and lose a third of those at silhouettes, which are \
         few pixels of a picture and the ones that are looked at. There the default proves what it finds, and turning \
         points, which prove nothing, are faster and on so smooth a profile as right; the flange below shows what they \
         rest on.",
    ),
    (
        "revsurf/surfer-1",
        "The notes' cone",
        "Its square is a parabola, so that one slab of the default holds it without an error: `draft` is as exact as \
         `exact` but where rays graze.",
    ),
    (
        "hard/ripples",
        "A column with 20 waves",
        "Samples between which the function turns twice lose hits, or find later ones.",
    ),
    (
        "hard/flange-from-above",
        "A thin disc on a rod",
        "Here every method that samples has wrong hits, the one that looks for turning points among them, which is \
         faster than the default where a profile is smooth: nothing says beforehand that 16 samples are enough. Bounds \
         need no such guess.",
    ),
    (
        "gallery/hall-of-mirrors",
        "A hall of mirrors",
        "Planes and balls near the viewer: no choice of a method changes a pixel, and samples are what costs time.",
    ),
    (
        "hard/far-camera",
        "A vase from ten million away",
        "A distance has no more digits than half a unit in its last place, 9e-10 there, which is the error of all that \
         count from near the surface. The notes follow a ray for 100 units between a surface's heights, and have lost \
         it by then.",
    ),
    (
        "camera/samples",
        "Edges",
        "Samples that are spread evenly fall toward the true colour with nearly twice the power of random ones.",
    ),
    (
        "light/size",
        "Soft shadows",
        "The last panel looks at the middles of pixels, so that what it shows are shadows alone.",
    ),
];

/// Runs the program, which ends well, and gives what it prints.
fn tabray(arguments: &[&str], folder: &Path) -> String {
    let output = cargo_bin_cmd!("tabray").current_dir(folder).args(arguments).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// However crowded a chart is. Of samples the names are numbers, which axes have, too; and a choice that finds nothing
/// has no error, and no place.
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
        let verdict = tabray(&["chart", path.to_str().expect("UTF-8"), "-o", "."], folder.path());
        let name = path.file_stem().expect("a name").to_str().expect("UTF-8");
        for extension in ["png", "csv"] {
            let file = Path::new(name).with_extension(extension);
            fs::copy(folder.path().join(&file), pictures.join(&file)).expect("a copy");
        }
        let read = |extension| {
            let file = folder.path().join(name).with_extension(extension);
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

What does each choice cost, how wrong is it, and is the default the right one? `tabray chart SCENE` answers that for
any scene. Here is what it says of some, each chart with its machine and its date; all of them, and this page, are
written by

```sh
COMMAND
```

## How to read a chart

Each panel answers one question. To the right is CPU time, upward the error, both logarithmic: the best place is at the
lower left. The star is how the scene is traced as it stands. A hollow point has hits that are missed, invented or not
the first; beside it stands of how many of all rays. The line is the Pareto front: of the choices without wrong hits,
those that none beats in both time and error. Times that differ by less than a tenth count as equal, and so do errors
that differ by less than a half.

- **Rays of the camera**: about 20000 pairs of a ray through a pixel and an object, in tiles of 16 by 16 pixels that are
  spread evenly. Objects are apart by kind: those that are found by a search along the ray, and those that have a
  formula.
- **Rays that graze silhouettes**: pairs beside an object's edge as the camera sees it, at distances from a pixel to
  10^-10 of one. Their distances answer an error of the last digit with one of its root.
- **The picture, by method**: one ray through each pixel, and how far its colours are from those that `strict` makes.
- **Samples for each pixel**: the error of the picture against 1024 other samples. `sobol` is spread evenly, `random` is
  the notes'.

Errors of distances are the 99th percentile of all right hits. The truth is of the real ray through the place of the
picture and of the numbers of the scene as they are written: a hit is isolated by intervals of 237 bits, as in
`tabray verify`, and the error of a distance has in it what rounding the ray made of it. Where the intervals do not tell,
the pair is left out and counted as undecided. Errors of colours are the root of the mean square over pixels and channels, of what a picture shows, from
0 to 1. Errors depend on the scene alone: two runs give the same to the last digit.

Times are those of one thread, in CPU time, of the same work for each choice by turns, up to 15 rounds after one to warm
up; the least round counts. Distances are timed on about 2000 of the pairs, pictures on some of their tiles. Both go as
in a render: up to 256 rays at a time, with the best instructions that the processor has. Where a hit is searched
for, only `draft`, `exact` and `strict` take a packet's rays together; all others take them one by one, and a part of
what the default is faster is owed to that. Of rays that graze silhouettes it takes most one by one, too.

The caption tells how far the middle round was from the least, for the choice in the middle: above 15 % it says not to
trust the times. Where rounds waited so long for other work of the machine, it says so: that is no part of CPU time, but
cores that share a cache or a unit of arithmetic slow each other, all choices alike.

## The methods

Those without a link are `tabray`'s own: `classic` is the notes' program, `draft`, `exact` and `strict` are what a
scene chooses with `accuracy`; see [how exact the methods are](accuracy.md).

| point | what it is | where it fails |
|---|---|---|
| `classic` | one bracket, from the viewer to the ray's point closest to the axis | silhouettes, inner walls, far balls |
| [`steps of 0.1`](../src/geometry/roots/steps.rs) | the notes' page on procedural surfaces: steps, then bisection to 1e-6 | what is thinner than a step |
| [`64 + ...`](../src/geometry/roots/samples.rs) | samples in the bounding cylinder, then a refiner: [bisection](../src/geometry/roots/bisection.rs), [Chandrupatla](../src/geometry/roots/chandrupatla.rs) or [Newton](../src/geometry/roots/newton.rs) | silhouettes, however many samples |
| [`16 + turning points`](../src/geometry/roots/turning.rs) | samples, and the places between them where the function turns | what turns twice between two samples |
| [`sphere tracing`](../src/geometry/roots/tracing.rs) | steps that a bound of the slope allows | hits what it only comes near to; slow at silhouettes |
| [`intervals`](../src/geometry/roots/intervals.rs) | bounds of values and slopes (Mitchell 1990) | slow at silhouettes |
| [`Taylor bounds`](../src/geometry/roots/taylor.rs) | bounds of the curvature, too; how shapes of one formula are found | a few of a hundred thousand rays that nearly touch: [the falsifier](falsify.md) counts them |
| `draft`, `exact`, `strict` | for surfaces of revolution quadrics with a proven error, then Newton; Taylor bounds where a ray grazes | a few of a hundred thousand rays that nearly touch: [the falsifier](falsify.md) counts them |

The counts here differ from those of [accuracy.md](accuracy.md) and of other tables, as the rays do. There all rays of
a kind go through one scene and each profile has a million; here they are those of the scene's own camera, and grazing
ones lie at the silhouettes that it sees. There the camera stands nearer, and rays that miss a surface's heights are
counted as well. Of grazing rays half miss the object here, and nobody loses those: a method that loses 60 of 100
touches has 30 % here. What holds in both: who has wrong hits and who has none.
";

const HEAT_MAPS: &str = "
## Where time goes and where error sits

`render --aov cost,error` writes both beside the picture: how many rays each pixel costs, and how far its colour is from
that of 64 samples, exactly traced; red where its middle sees another object. With `-o a.png`, `a-error.exr` has the
numbers: the colour's error, the distance's, and 1 where the object is another.

| rays, `--method classic` | error, `--method classic` | error, `--method exact` |
|---|---|---|
| ![cost](charts/ripples-classic-cost.png) | ![error](charts/ripples-classic-error.png) | ![error](charts/ripples-exact-error.png) |

```sh
for method in classic exact; do
    cargo run --release -- render scenes/hard/ripples.ray --method $method --aov cost,error -o $method.png
done
```

The classic method loses hits at every ripple; what is left with the exact one are edges, which samples smooth.

## To choose

`tabray choose SCENE --max-error 0.01` measures quickly what accuracy and samples make of a scene, shows what it
weighed, and prints the command line to use; `--max-time 2` takes what is best within two seconds on all cores.
";
