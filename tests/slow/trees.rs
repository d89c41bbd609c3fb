//! The trees of rays under the free rules against whole ones, which have no ends but a number of rays that leaves
//! nothing to be seen.

use crate::common::glass::{SHAPES, glass};
use crate::common::model;
use tabray::render::limits::MAX_RAYS;
use tabray::render::plan::Plan;
use tabray::render::plan::depth::Depth;
use tabray::render::trace;

/// The work of a whole tree, in simple rays.
const WHOLE: u32 = 400_000;

/// Surroundings that are not the same all around.
const SURROUNDINGS: &str = "sky s { horizon 0.9 0.9 1 zenith 0.3 0.5 0.8 ground 0.2 0.2 0.2 }
    light l { location 3 5 4 emissivity 0.8 0.8 0.7 }
    material dark { ambient 0.02 0.02 0.02 diffuse 0.1 0.1 0.1 }
    disc floor { material dark center 0 -1.1 0 normal 0 1 0 radius 4 }\n";

#[test]
fn trees_end_within_half_a_level_of_their_whole() {
    let (mut counted, mut all) = (0, 0);
    for (name, shape) in SHAPES {
        for index in [1.1, 1.5] {
            let text = format!("{}{SURROUNDINGS}{shape}", glass(index));
            for transfer in ["linear", "srgb"] {
                let model = model(&text.replace("transfer linear", &format!("transfer {transfer}")));
                let [mut ended, mut whole] = [Plan::new(&model), Plan::new(&model)];
                ended.camera.pixels = [6, 5];
                whole.depth = whole.depth.map(Depth::uncut);
                whole.camera.pixels = [6, 5];
                let display = ended.camera.display();
                all += 30;
                for pixel in (0..30).map(|pixel| [pixel % 6, pixel / 6]) {
                    let most = MAX_RAYS as u32;
                    let (one, missing) = trace::within_budgets(&ended, &[pixel], &[most], &mut ())[0];
                    let (other, _) = trace::within_budgets(&whole, &[pixel], &[WHOLE], &mut ())[0];
                    let off = 255.0 * (display.shown(one) - display.shown(other)).abs().max_element();
                    assert!(
                        off <= 0.5 || missing > 0.0,
                        "{name}, {index}, {transfer}, {pixel:?}: {off} levels"
                    );
                    counted += u32::from(missing > 0.0);
                }
            }
        }
    }
    assert!(50 * counted <= all, "{counted} of {all} pixels cost too much");
}
