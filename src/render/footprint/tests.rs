use super::*;
use crate::scene::reader;
use crate::scene::registry::Registry;
use std::path::Path;

fn model(scene: &str) -> Model {
    let registry = Registry::get().expect("sound types");
    match reader::read(registry, "scene", Path::new(""), scene.as_bytes(), None) {
        Ok(loaded) => loaded.model,
        Err(report) => panic!("{report}"),
    }
}

fn proof(model: &Model, pixel: [usize; 2], error: f64) -> Proof {
    let depth = Depth::new(model);
    Prover::new(model).pixel((model, depth.as_ref()), &model.camera.value, pixel, error)
}

#[test]
fn a_lit_plane_is_known_to_a_millionth_of_a_level_or_so() {
    let model = model(
        "camera eye { pixeldim 9 9 worlddim 8 8 viewpoint 4 4 8 }
         material m { ambient 1 1 1 diffuse 1 1 1 }
         light lamp { location 4 8 4 emissivity 8 8 8 }
         plane wall { material m normal 0 0 1 point 0 0 -8 }",
    );
    let proof = proof(&model, [4, 4], 1e-4);
    panic!("{proof:?} {}", 255.0 * proof.half_width(1.0));
}
