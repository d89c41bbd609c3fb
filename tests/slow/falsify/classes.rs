//! Classes of scenes: shapes, and rays aimed where the arithmetic is hard.

mod far;
mod flat;
mod formulas;
mod meshes;
mod revolved;
mod round;
mod solids;

use super::random::Random;
use super::scenes::Question;
use crate::oracle::first as oracle;
use crate::oracle::ray::Ray;
use crate::oracle::text::Scene;

/// A class of scenes.
pub struct Class {
    pub name: &'static str,
    /// The number of rays of the long run, and of the short one.
    pub rays: [usize; 2],
    pub ask: fn(&mut Random) -> Question,
    /// Whether the first object in the scene must be seen where several are met at the same distance.
    pub is_first_seen: bool,
    /// Whether each ray must hit something, as from inside a closed mesh.
    pub is_closed: bool,
}

const fn class(name: &'static str, rays: [usize; 2], ask: fn(&mut Random) -> Question) -> Class {
    Class { name, rays, ask, is_first_seen: false, is_closed: false }
}

const fn closed(name: &'static str, rays: [usize; 2], ask: fn(&mut Random) -> Question) -> Class {
    Class { is_closed: true, ..class(name, rays, ask) }
}

/// Returns one of the questions between 0 and `far`, found by so many bisections at most, whose ray barely hits or barely
/// misses.
fn barely(
    random: &mut Random,
    question: impl Fn(f64) -> Question,
    mut far: f64,
    bisections: u64,
) -> Question {
    let is_met = |by: f64| {
        let scene = Scene::read(&question(by).text, "");
        oracle::first(&scene, &Ray::of_pixel(&scene, 0, 0)).first.is_some()
    };
    let mut near = 0.0;
    if !is_met(near) || is_met(far) {
        return question(near);
    }
    for _ in 0..random.below(bisections) {
        let middle = 0.5 * (near + far);
        if is_met(middle) { near = middle } else { far = middle }
    }
    question(if random.once_in(2) { near } else { far })
}

/// All classes.
pub const CLASSES: [Class; 51] = [
    class("sphere", [600_000, 4000], round::spheres),
    class("sphere, tangents", [400_000, 4000], round::sphere_tangents),
    class("sphere, from inside", [100_000, 1000], round::inside),
    class("sphere, 1e-150 to 1e150", [100_000, 1000], round::scales),
    class("ellipsoid", [600_000, 4000], round::ellipsoids),
    class("ellipsoid, tangents", [400_000, 4000], round::ellipsoid_tangents),
    class("quadric", [500_000, 4000], round::quadrics),
    class("quadric, tangents", [200_000, 2000], round::quadric_tangents),
    class("quadric, far from its center", [100_000, 2000], round::quadric_moved),
    class("quadric, box that touches", [100_000, 2000], round::quadric_boxes),
    class("quadric, pairs of planes", [50_000, 1000], round::quadric_pairs),
    class("quadric, cones and tiny numbers", [100_000, 2000], round::quadric_cones),
    class("plane", [600_000, 4000], flat::planes),
    class("plane, nearly parallel", [400_000, 4000], flat::parallel),
    class("fplane, edges", [1_000_000, 4000], flat::rectangles),
    class("triangle", [700_000, 4000], flat::triangles),
    class("triangle, slivers", [300_000, 4000], flat::slivers),
    Class { is_first_seen: true, ..class("coincident", [200_000, 2000], flat::rugs) },
    class("mixed, equal distances", [100_000, 2000], round::meeting),
    class("mesh, edges and vertices", [1_000_000, 1500], meshes::edges),
    class("mesh, slivers", [1_000_000, 1500], meshes::slivers),
    class("mesh, doubled faces", [1_000_000, 1500], meshes::doubled),
    class("mesh, 1e-6 beside 1e6", [1_000_000, 1500], meshes::sizes),
    class("mesh, along an edge or in a face", [1_000_000, 1500], meshes::along),
    closed("mesh, from inside", [1_000_000, 3000], meshes::inside),
    class("place, spheres", [1_000_000, 1500], meshes::placed_spheres),
    class("place, meshes", [1_000_000, 1500], meshes::placed_meshes),
    class("place, places", [1_000_000, 1500], meshes::placed_places),
    class("place, planes", [1_000_000, 1500], flat::placed),
    closed("place, from inside", [1_000_000, 3000], meshes::placed_inside),
    class("revsurf, surfers", [900_000, 800], revolved::surfers),
    class("revsurf, formulas", [80_000, 600], revolved::formulas),
    class("revsurf, tangents and rims", [50_000, 600], revolved::tangents),
    class("torus", [1_000_000, 800], revolved::tori),
    class("heart", [1_000_000, 500], revolved::hearts),
    class("curved, silhouettes", [20_000, 200], revolved::silhouettes),
    class("implicit, formulas", [1_000_000, 500], formulas::implicits),
    class("implicit, silhouettes", [20_000, 100], formulas::silhouettes),
    class("implicit, from inside", [100_000, 300], formulas::inside),
    class("cylinder, capsule, disc", [1_000_000, 500], formulas::rounds),
    class("cylinder, capsule, disc, rims", [100_000, 300], formulas::rims),
    class("lathe", [1_000_000, 300], formulas::lathes),
    class("box", [1_000_000, 1000], formulas::boxes),
    class("prism", [1_000_000, 1000], formulas::prisms),
    class("polygon", [1_000_000, 1000], formulas::polygons),
    class("solid", [1_000_000, 600], solids::solids),
    class("solid, silhouettes and edges", [20_000, 60], solids::silhouettes),
    class("solid, sides that coincide", [1_000_000, 800], solids::flush),
    class("solid, ends that coincide", [1_000_000, 600], solids::ends),
    class("solid, from inside", [1_000_000, 600], solids::inside),
    class("far away, edges", [1_000_000, 1200], far::edges),
];
