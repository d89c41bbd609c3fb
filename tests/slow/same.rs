//! An image does not depend on the instruction set, on the number of threads, on whether its pixels are rendered one by
//! one, or on whether somebody looks on.

use crate::common::program::{folder, outcome, scene, tabray};
use crate::common::{Onlooker, model, scenes, small};
use tabray::render::{Plan, trace};
use tabray::scene::Model;
use tabray::simd::Cpu;
use tabray::tools::threads::renderer_with;
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
        .map(|cpu| (format!("{cpu}"), renderer_with(2).expect("threads").on(cpu)))
        .chain([1, 5].map(|threads| (format!("{threads} threads"), renderer_with(threads).expect("threads"))))
        .collect();
    let mut faults = Vec::new();
    for path in scenes() {
        for accuracy in [Accuracy::Exact, Accuracy::Classic, Accuracy::Draft, Accuracy::Strict] {
            let model = small(&path, Some(accuracy));
            let plan = Plan::new(&model);
            let ([width, height], display) = (plan.camera.pixels, plan.camera.display());
            let alone = renderers[0].1.run(|| {
                let pixels = (0..height).rev().flat_map(|y| (0..width).map(move |x| (x, y)));
                let pixels = pixels.flat_map(|(x, y)| display.bytes(trace::pixel(&plan, x, y)));
                pixels.collect::<Vec<_>>()
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

#[test]
fn certain_pixels_depend_on_neither_threads_nor_instructions() {
    let folder = folder();
    let with = |others: &[&str]| {
        let options = ["--size", "24", "--max-error", "4", "--certain", "-o", "-"];
        let mut render = tabray(&folder);
        let render = render.arg("render").arg(scene("gallery/marbles.ray")).args(options).args(others);
        let (status, out, err) = outcome(render);
        assert_eq!(status, 0, "{others:?}: {err}");
        out
    };
    let one = with(&["--threads", "1"]);
    assert!(with(&["--threads", "4"]) == one);
    assert!(with(&["--threads", "3", "--cpu", "baseline"]) == one);
}

#[test]
fn whoever_looks_on_sees_the_colours_of_the_picture() {
    let thread = renderer_with(1).expect("a thread with room for deep reflections");
    let check = |name: &str, model: &Model| {
        let plan = Plan::new(model);
        let [width, height] = plan.camera.pixels;
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let [seen, alone] =
                thread.run(|| [trace::observe_pixel(&plan, x, y, &mut Onlooker), trace::pixel(&plan, x, y)]);
            assert_eq!(seen, alone, "{name}, pixel {x} {y}");
        }
    };
    for path in scenes() {
        let mut model = small(&path, Some(Accuracy::Exact));
        model.camera.value.pixels = model.camera.value.pixels.map(|side| side.min(18));
        check(&path.display().to_string(), &model);
    }
    // Mirrors that scatter no light cost as many rays as allowed, whether or not shadow rays are traced.
    let runaway = model(
        "camera eye { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 7 }
         material mirror { ambient 1 1 1 specular 0.999 } material pane { specular 1 transparency 0.5 diffuse 1 1 1 }
         plane one { material mirror normal 0 0 1 point 0 0 -1 }
         fplane other { material pane normal 0 0 1 xdir 1 0 0 point -9 -9 -0.999 dimensions 30 30 }
         light lamp { location 1 7 2 emissivity 5 5 5 }"
    );
    check("runaway", &runaway);
}
