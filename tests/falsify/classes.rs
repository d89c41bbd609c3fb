//! Classes of scenes: shapes, and rays that are aimed where arithmetic is hard.

mod flat;
mod revolved;
mod round;

use super::random::Random;
use super::scenes::Question;

/// A class of scenes.
pub struct Class {
    pub name: &'static str,
    /// The rays of a whole run, and of a small one.
    pub rays: [usize; 2],
    pub ask: fn(&mut Random) -> Question,
    /// Whether the first in the scene must be seen of those that are met at one distance.
    pub is_first_seen: bool,
}

const fn class(name: &'static str, rays: [usize; 2], ask: fn(&mut Random) -> Question) -> Class {
    Class { name, rays, ask, is_first_seen: false }
}

const MILLION: usize = 1_000_000;

/// All of them.
pub const CLASSES: [Class; 24] = [
    class("sphere", [MILLION, 4000], round::spheres),
    class("sphere, tangents", [MILLION, 4000], round::sphere_tangents),
    class("sphere, from inside", [MILLION / 4, 1000], round::inside),
    class("sphere, 1e-150 to 1e150", [MILLION / 10, 1000], round::scales),
    class("ellipsoid", [MILLION, 4000], round::ellipsoids),
    class("ellipsoid, tangents", [MILLION / 2, 4000], round::ellipsoid_tangents),
    class("quadric", [MILLION, 4000], round::quadrics),
    class("quadric, tangents", [MILLION / 2, 2000], round::quadric_tangents),
    class("quadric, far from its center", [MILLION / 2, 2000], round::quadric_moved),
    class("quadric, box that touches", [MILLION / 4, 2000], round::quadric_boxes),
    class("quadric, pairs of planes", [MILLION / 4, 2000], round::quadric_pairs),
    class("quadric, cones and tiny numbers", [MILLION / 4, 2000], round::quadric_cones),
    class("plane", [MILLION, 4000], flat::planes),
    class("plane, nearly parallel", [MILLION, 4000], flat::parallel),
    class("fplane, edges", [MILLION, 4000], flat::rectangles),
    class("triangle", [MILLION, 4000], flat::triangles),
    class("triangle, slivers", [MILLION / 2, 4000], flat::slivers),
    Class { name: "coincident", rays: [MILLION / 4, 2000], ask: flat::rugs, is_first_seen: true },
    class("mixed, equal distances", [MILLION / 4, 2000], round::meeting),
    class("revsurf, surfers", [MILLION, 800], revolved::surfers),
    class("revsurf, formulas", [MILLION / 4, 600], revolved::formulas),
    class("revsurf, tangents and rims", [MILLION / 4, 600], revolved::tangents),
    class("torus", [MILLION, 800], revolved::tori),
    class("heart", [MILLION / 2, 500], revolved::hearts),
];
