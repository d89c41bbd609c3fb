//! The targets of `tests/fuzz/`, run on a fixed sequence of mutated inputs that is the same on every machine.

use crate::common::{root, scenes};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::{env, fs};
use target::{
    COPIES, IMPORTED, MESHES, OLDER, TO_REVIEW, TO_WATCH, checkpoint, fmt, formula, gltf, hits, import, lsp,
    mesh, notes, older, rays, render, review, texture, toml, triangle, watch,
};

#[path = "../fuzz/target.rs"]
mod target;

/// Text that readers treat specially. Mutations insert it.
const WORDS: [&str; 20] = [
    "{", "}", "[", "]", "\"", "=", "==", "#", "\n", "\0", "é", "1e300", "1e-320", "-0", "nan", "0", "sphere",
    "material", "^", "(",
];

/// Returns a random seed with one to eight changes: each removes, repeats or overwrites a part, or replaces it with one
/// of [`WORDS`] or with a part of another seed.
fn mutated(seeds: &[Vec<u8>], random: &mut Pcg32) -> Vec<u8> {
    let below = |random: &mut Pcg32, end: usize| random.next_u32() as usize % end.max(1);
    let mut bytes = seeds[below(random, seeds.len())].clone();
    for _ in 0..=below(random, 8) {
        let start = below(random, bytes.len() + 1);
        let end = bytes.len().min(start + below(random, 16));
        match below(random, 5) {
            0 => drop(bytes.drain(start..end)),
            1 => drop(bytes.splice(end..end, bytes[start..end].to_vec())),
            2 => bytes[start..end].iter_mut().for_each(|byte| *byte = random.next_u32() as u8),
            3 => drop(bytes.splice(start..end, WORDS[below(random, WORDS.len())].bytes())),
            _ => {
                let other = &seeds[below(random, seeds.len())];
                let from = below(random, other.len() + 1);
                let to = other.len().min(from + below(random, 64));
                drop(bytes.splice(start..end, other[from..to].to_vec()));
            }
        }
    }
    bytes
}

/// Runs a target on `count` mutated inputs, or as many as `TABRAY_INPUTS` says; an input that breaks a promise is printed.
fn run(target: impl Fn(&[u8]), seeds: &[Vec<u8>], count: usize) {
    let wanted = env::var("TABRAY_INPUTS").ok().map(|count| count.parse().expect("a number"));
    let mut random = Pcg32::seed_from_u64(1);
    for _ in 0..wanted.unwrap_or(count) {
        let input = mutated(seeds, &mut random);
        if let Err(fault) = catch_unwind(AssertUnwindSafe(|| target(&input))) {
            eprintln!("the input: b\"{}\"", input.escape_ascii());
            resume_unwind(fault);
        }
    }
}

/// Returns the bytes of the project's scenes whose file names have this extension.
fn scenes_in(extension: &str) -> Vec<Vec<u8>> {
    let paths = scenes().into_iter().filter(|path| path.extension().is_some_and(|is| is == extension));
    paths.map(|path| fs::read(path).expect("a scene")).collect()
}

#[test]
fn scenes_in_the_notes_syntax_are_refused_or_dumped() {
    run(notes, &scenes_in("ray"), 4000);
}

#[test]
fn scenes_in_toml_are_refused_or_dumped() {
    run(toml, &scenes_in("toml"), 4000);
}

#[test]
fn older_scenes_are_refused_or_dumped() {
    run(older, &[OLDER.as_bytes().to_vec()], 2000);
}

#[test]
fn what_is_formatted_is_formatted_and_the_same_scene() {
    let of_kind = |extension, kind: u8| {
        scenes_in(extension)
            .into_iter()
            .filter(|text| text.len() <= 1024)
            .map(move |text| [&[kind], &*text].concat())
    };
    run(fmt, &of_kind("ray", 0).chain(of_kind("toml", 1)).collect::<Vec<_>>(), 2000);
}

#[test]
fn files_of_other_programs_are_refused_or_imported() {
    run(import, &IMPORTED.map(|text| text.as_bytes().to_vec()), 2000);
}

#[test]
fn what_an_editor_asks_is_answered_within_the_text() {
    let of_kind = |extension, kind: u8| {
        let texts = scenes_in(extension).into_iter().filter(|text| text.len() <= 1024);
        texts.flat_map(move |text| [0, 85, 170].map(|cursor| [&[kind, cursor], &*text].concat()))
    };
    run(lsp, &of_kind("ray", 0).chain(of_kind("toml", 1)).collect::<Vec<_>>(), 4000);
}

#[test]
fn gltf_is_refused_or_read() {
    let seeds = triangle().into_iter().chain([COPIES.as_bytes().to_vec()]);
    let seeds: Vec<_> = seeds.flat_map(|bytes| [0, 1].map(|kind| [&[kind], &bytes[..]].concat())).collect();
    seeds.iter().for_each(|seed| gltf(seed));
    run(gltf, &seeds, 4000);
}

#[test]
fn rays_and_answers_are_refused_or_read() {
    let seeds = rays();
    seeds.iter().for_each(|seed| hits(seed));
    run(hits, &seeds, 20_000);
}

#[test]
fn formulas_are_refused_or_evaluated() {
    let formulas =
        ["y", "2 + sin(y)", "sqrt(1 - y^2)", "max(0.2, ln(y))", "min(2, 1/abs(y-3))", "exp(-y)*cos(3*y)"];
    run(formula, &formulas.map(|formula| formula.as_bytes().to_vec()), 20_000);
}

#[test]
fn meshes_are_refused_or_read() {
    let names = ["slivers.obj", "icosahedron.ply", "bowl.stl", "points.ply", "lantern.obj"];
    let seed = |name: &str| {
        let bytes = fs::read(root().join("scenes/models").join(name)).expect("a mesh");
        let format = MESHES.iter().position(|format| name.ends_with(format)).expect("a format") as u8;
        [&[format], &bytes[..bytes.len().min(2000)]].concat()
    };
    let gltf = triangle()
        .into_iter()
        .zip(3_u8..)
        .flat_map(|(bytes, kind)| [kind, kind + 5].map(|kind| [&[kind], &bytes[..]].concat()));
    let seeds: Vec<_> = names.map(seed).into_iter().chain(gltf).collect();
    seeds.iter().for_each(|seed| mesh(seed));
    run(mesh, &seeds, 2000);
}

#[test]
fn textures_are_refused_or_read() {
    let files = ["letter.ppm", "bricks.png"].map(|name| fs::read(root().join("scenes/textures").join(name)));
    let files: Vec<_> = files.into_iter().flatten().collect();
    assert!(!files.is_empty(), "there are textures to begin with");
    run(texture, &files, 2000);
}

#[test]
fn scenes_are_refused_or_rendered_alike_by_packets_and_by_single_rays() {
    let with_kind = |kind: u8| move |text: Vec<u8>| [&[kind], &*text].concat();
    let seeds: Vec<_> = (0..4)
        .flat_map(|accuracy| {
            let notes = scenes_in("ray").into_iter().map(with_kind(accuracy));
            notes.chain(scenes_in("toml").into_iter().map(with_kind(accuracy + 4)))
        })
        .collect();
    run(render, &seeds, 300);
}

#[test]
fn checkpoints_are_refused_or_continued_from() {
    let changes = [0u8, 1, 2].map(|kind| {
        let mut random = Pcg32::seed_from_u64(u64::from(kind));
        let changes = (0..8).flat_map(|_| random.next_u32().to_le_bytes());
        [kind].into_iter().chain(changes).collect()
    });
    run(checkpoint, &changes, 20_000);
}

fn seeds(requests: &[&str]) -> Vec<Vec<u8>> {
    requests.iter().map(|request| request.as_bytes().to_vec()).collect()
}

#[test]
fn requests_to_watch_are_refused_or_answered() {
    run(watch, &seeds(&TO_WATCH), 4000);
}

#[test]
fn requests_to_review_are_refused_or_answered() {
    run(review, &seeds(&TO_REVIEW), 4000);
}
