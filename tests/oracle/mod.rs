//! The truth that tests compare the program with, from the text of a scene and without any code of the program, and rays
//! to test. Planes, triangles and quadrics are decided by signs of whole numbers, all other shapes by intervals of `f64`
//! and of 320 bits.
#![allow(dead_code, reason = "each test program uses a part of it")]

pub mod closed;
pub mod curved;
pub mod dyadic;
pub mod fast;
pub mod first;
pub mod formula;
pub mod hard;
pub mod number;
pub mod place;
pub mod ray;
pub mod rays;
pub mod revolution;
pub mod solid;
pub mod spline;
pub mod tally;
pub mod text;
pub mod wide;

use closed::Hit as Met;
use glam::{DVec2, DVec3};
use number::Number;
use tabray::exact::double_double::DoubleDouble;
use tabray::geometry;
use text::Scene;

/// The first hit of a ray on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Truth {
    /// The ray hits the surface.
    Hit(Hit),
    /// The ray misses the surface.
    Miss,
    /// The ray is so close to the boundary between a hit and a miss that the numbers of the scene do not decide.
    Undecided,
}

/// A hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The distance along the ray, in lengths of its direction.
    pub t: DoubleDouble,
    /// The cosine of the angle between the ray and the outward normal: negative where the ray enters.
    pub slope: f64,
}

/// Writes a vector as scenes do.
pub fn spelt(vector: DVec3) -> String {
    format!("{:?} {:?} {:?}", vector.x, vector.y, vector.z)
}

/// Returns the text of an fplane.
pub fn fplane_text(normal: DVec3, point: DVec3, xdir: DVec3, DVec2 { x, y }: DVec2) -> String {
    let [normal, point, xdir] = [normal, point, xdir].map(spelt);
    format!("fplane f {{ material m normal {normal} point {point} xdir {xdir} dimensions {x:?} {y:?} }}")
}

/// The surface of an object, as the text of its scene has it.
pub struct Surface(Scene);

impl Surface {
    /// Reads a scene of one object. A camera may stand before it.
    pub fn read(text: &str) -> Self {
        Self(Scene::read(text, ""))
    }

    /// Returns the first hit, beyond a distance, of a ray of the program, whose numbers are taken as exact.
    pub fn first_hit(&self, ray: &geometry::Ray, near: f64) -> Truth {
        self.beyond(&ray::Ray::as_is(&self.0, ray.origin.to_array(), ray.dir.to_array()), near)
    }

    /// Returns the first hit of the exact ray through a pixel of the scene's camera.
    pub fn first_hit_of_pixel(&self, [x, y]: [u32; 2]) -> Truth {
        self.beyond(&ray::Ray::of_pixel(&self.0, x.into(), y.into()), 0.0)
    }

    fn beyond(&self, ray: &ray::Ray, near: f64) -> Truth {
        let near = dyadic::Dyadic::from(near);
        let [object] = &*self.0.objects else { panic!("a scene of one object") };
        let onward = ray.from(&near);
        match first::hit(object, &onward) {
            Met::Miss => Truth::Miss,
            Met::Touch => Truth::Undecided,
            Met::At(place) => {
                let t = ray.distance(&place.add(&wide::Wide::exact(&near)));
                let high = t.near();
                let low = t.sub(&wide::Wide::f64(high)).near();
                let slope = first::slope(object, &onward, &place);
                Truth::Hit(Hit { t: DoubleDouble::from(high) + DoubleDouble::from(low), slope })
            }
        }
    }
}

impl Truth {
    /// Returns the hit, if there is one.
    pub fn hit(self) -> Option<Hit> {
        match self {
            Self::Hit(hit) => Some(hit),
            Self::Miss | Self::Undecided => None,
        }
    }
}

/// The crossings of a surface that count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossings {
    /// All crossings.
    All,
    /// Crossings from outside to inside: the ones that a ray leaving the outside can meet.
    Entries,
    /// Crossings from inside to outside.
    Exits,
}

impl Crossings {
    /// Tells whether a crossing counts at which the surface's function has this slope.
    pub fn count(self, slope: f64) -> bool {
        match self {
            Self::All => true,
            Self::Entries => slope < 0.0,
            Self::Exits => slope > 0.0,
        }
    }
}
