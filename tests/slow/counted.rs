//! What rays and meshes of objects cost, in instructions of the program.

use crate::common::instructions::instructions;
use crate::oracle::rays::Random;
use glam::DVec3;
use std::fmt::Write;
use std::fs;

/// The number of faces along a side of the grid is twice this.
const SIDE: usize = 224;

/// Rays through vertices and along rows of faces of a mesh of 10^5 faces, whose proofs take more than 53 bits.
#[test]
fn a_ray_at_a_vertex_costs_five_times_any_other_at_most() {
    const RAYS: usize = 200;
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("a path that is text").to_owned();
    // Flat blocks between rough ones, with heights of few digits: rays along an axis run in the planes of many faces.
    let height = |x: usize, y: usize| {
        if (x / 16 + y / 16).is_multiple_of(2) { 0.0 } else { ((7 * x + 13 * y) % 5) as f64 / 8.0 }
    };
    let vertex = |x: usize, y: usize| DVec3::new(x as f64, y as f64, height(x, y));
    let mut text = String::new();
    for DVec3 { x, y, z } in (0..=SIDE).flat_map(|x| (0..=SIDE).map(move |y| vertex(x, y))) {
        writeln!(text, "v {x} {y} {z}").expect("memory");
    }
    for (x, y) in (0..SIDE).flat_map(|x| (0..SIDE).map(move |y| (x, y))) {
        let at = |right: usize, up: usize| (x + right) * (SIDE + 1) + y + up + 1;
        writeln!(text, "f {} {} {}\nf {0} {2} {}", at(0, 0), at(1, 0), at(1, 1), at(0, 1)).expect("memory");
    }
    let mesh = path("grid.obj");
    fs::write(&mesh, text).expect("a file");
    let mut random = Random::new(7);
    let mut below = || random.below(SIDE as u32) as usize;
    let mut any = || vertex(below(), below());
    let vertices: Vec<_> = (0..RAYS).map(|_| any()).collect();
    let above = vertices.iter().map(|at| *at + DVec3::new(31.4 - 0.7 * at.y, 0.3 * at.x - 27.1, 90.3));
    let skew: Vec<_> = vertices.iter().zip(above).map(|(at, from)| (from, *at - from)).collect();
    let others: Vec<_> =
        skew.iter().map(|(from, dir)| (*from, *dir + DVec3::new(0.313, 0.271, 0.0))).collect();
    let axis = |at: &DVec3| (DVec3::new(500.0, at.y, at.z), DVec3::NEG_X);
    let along: Vec<_> = vertices.iter().map(axis).collect();
    let cost = |rays: &[(DVec3, DVec3)]| {
        let count = |rays: &[(DVec3, DVec3)]| {
            let line = |(from, dir): &(DVec3, DVec3)| {
                format!("{} {} {} {} {} {}\n", from.x, from.y, from.z, dir.x, dir.y, dir.z)
            };
            let file = path("rays.txt");
            fs::write(&file, rays.iter().map(line).collect::<String>()).expect("a file");
            instructions(&["hits", &mesh, &file])
        };
        Some((count(rays)? - count(&rays[..1])?) as f64 / (rays.len() - 1) as f64)
    };
    let Some(usual) = cost(&others) else { return };
    for (name, rays) in [("vertices", &skew), ("rows", &along)] {
        let cost = cost(rays).expect("Valgrind");
        println!("{name}: {cost:.0}, {:.2} times {usual:.0}", cost / usual);
        assert!(cost < 5.0 * usual, "{name}: {:.2} times", cost / usual);
    }
}

/// The finer a mesh, the larger are its cells beside the error. The proof takes no longer for each face.
#[test]
fn a_mesh_takes_time_for_its_faces() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("a path that is text").to_owned();
    let (scene, file) = (path("ball.ray"), path("ball.stl"));
    fs::write(&scene, "material m { } sphere ball { material m  center 0 0 0  radius 1 }").expect("a file");
    let cost = |error: &str| {
        let count = instructions(&["mesh", &scene, "ball", "--error", error, "-o", &file])?;
        let faces = (fs::metadata(&file).expect("a mesh").len() - 84) / 50;
        Some(count as f64 / faces as f64)
    };
    let Some(coarse) = cost("0.01") else { return };
    let fine = cost("0.0012").expect("Valgrind");
    println!("{coarse:.0} and {fine:.0}");
    assert!(fine < 2.0 * coarse, "{fine:.0} of {coarse:.0}");
}

/// Rays near an outline of a surface by two parameters cost most.
#[test]
fn the_lines_over_an_image_cost_a_few_times_the_image() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("a path that is text").to_owned();
    let (scene, image, lines) = (path("knot.ray"), path("knot.png"), path("knot.svg"));
    let text = "orthographic eye { pixeldim 60 60  position 0 0 9  target 0 0 0  width 8 }
background paper { colour 1 1 1 }
material white { ambient 1 1 1 }
tube trefoil { material white  x \"sin(t) + 2*sin(2*t)\"  y \"cos(t) - 2*cos(2*t)\"  z \"-sin(3*t)\"
               t 0 \"2*pi\"  radius 0.3 }";
    fs::write(&scene, text).expect("a file");
    let cost = |more: &[&str]| instructions(&[&["render", &scene, "-o", &image], more].concat());
    let Some(alone) = cost(&[]) else { return };
    let both = cost(&["--overlay", &lines]).expect("Valgrind");
    let times = (both - alone) as f64 / alone as f64;
    println!("{times:.1} times");
    assert!(times < 12.0, "{times:.1} times");
}
