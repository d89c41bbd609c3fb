//! An image does not depend on the instruction set, on the number of threads, or on whether its pixels are rendered one
//! by one.

use crate::common::program::{folder, outcome, scene, tabray};
use crate::common::{scenes, small};
use tabray::render::{Plan, Renderer, to_byte, trace};
use tabray::simd::Cpu;
use tabray::world::Accuracy;

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let folder = folder();
    for path in [
        scene("gallery/hall-of-mirrors.ray"),
        scene("gallery/stained-glass.ray"),
        scene("material/touching-mirrors.ray"),
    ] {
        // Mirrors that touch cost 20,000 rays per sample. This is the smallest image with as many tiles as the scene's own.
        let size: &[&str] = if path.ends_with("touching-mirrors.ray") { &["--size", "33x17"] } else { &[] };
        let pictures = ["1", "2", "7"].map(|threads| {
            let render = ["-o", "-", "--samples", "2", "--threads", threads];
            let (status, out, err) =
                outcome(tabray(&folder).arg("render").arg(&path).args(render).args(size));
            assert_eq!(status, 0, "{err}");
            out
        });
        assert!(pictures.iter().all(|picture| *picture == pictures[0]), "{}", path.display());
    }
}

#[test]
fn a_picture_depends_neither_on_instructions_nor_on_threads_nor_on_tiles() {
    let renderers: Vec<_> = Cpu::all()
        .map(|cpu| (format!("{cpu}"), Renderer::new(2).expect("threads").on(cpu)))
        .chain([1, 5].map(|threads| (format!("{threads} threads"), Renderer::new(threads).expect("threads"))))
        .collect();
    let mut faults = Vec::new();
    for path in scenes() {
        for accuracy in [Accuracy::Exact, Accuracy::Classic, Accuracy::Draft, Accuracy::Strict] {
            let model = small(&path, Some(accuracy));
            let plan = Plan::new(&model);
            let [width, height] = plan.camera.pixels;
            let alone = renderers[0].1.run(|| {
                let pixels = (0..height).rev().flat_map(|y| (0..width).map(move |x| (x, y)));
                let pixels = pixels.flat_map(|(x, y)| trace::pixel(&plan, x, y).to_array());
                pixels.map(to_byte).collect::<Vec<_>>()
            });
            for (name, renderer) in &renderers {
                let picture = renderer.picture(&plan);
                let differ = picture.iter().zip(&alone).filter(|(one, other)| one != other).count();
                if differ > 0 || picture.len() != alone.len() {
                    faults.push(format!("{} {accuracy:?}, {name}: {differ} bytes", path.display()));
                }
            }
        }
    }
    assert!(faults.is_empty(), "these differ from pixels rendered one by one:\n{}", faults.join("\n"));
}
