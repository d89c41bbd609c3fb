//! Results of a search for a ray's first hit.

use super::face::Leaving;
use tabray_world::coincidence::{self, CLOSE};
use tabray_world::geometry::aabb::smaller;
use tabray_world::geometry::ray::{Bracket, MISS, Ray};
use tabray_world::simd::soa::LANES;

/// The hits of a ray that a search has found so far.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    /// The smallest lower bound of a hit's distance, and its face.
    near: f64,
    face: u64,
    /// The second smallest lower bound.
    second: f64,
    /// The smallest upper bound of a certain hit's distance.
    far: f64,
    /// The smallest lower bound of an uncertain hit's distance.
    doubtful: f64,
}

/// The result of a search for a ray's first hit.
#[derive(Clone, Copy)]
pub(super) enum Known {
    /// A bracket of the distance.
    Bracket(Bracket),
    /// The ray certainly hits this face first. If `is_alone`, [`Surface::face_along`] returns the same face.
    ///
    /// [`Surface::face_along`]: super::Surface::face_along
    Face { face: usize, bracket: Bracket, is_alone: bool },
}

impl Known {
    /// Returns the face that the ray certainly hits first.
    #[inline(always)]
    pub(super) fn face(self) -> Option<usize> {
        match self {
            Self::Face { face, .. } => Some(face),
            Self::Bracket(_) => None,
        }
    }

    /// Returns a bracket of the first hits of all rays within a drift, given the distance of the plane of the hit face.
    #[inline(always)]
    pub(super) fn within(self, crossing: f64) -> Bracket {
        match self {
            Self::Face { bracket, .. } => {
                // A bracket far narrower than the distance between coincident surfaces counts as a known distance.
                let is_narrow = bracket.far - bracket.near <= 0.125 * CLOSE * bracket.near;
                let is_known = is_narrow & (bracket.near <= crossing) & (crossing <= bracket.far);
                if is_known { Bracket::exactly(crossing) } else { bracket }
            }
            Self::Bracket(bracket) => bracket,
        }
    }
}

impl Nearest {
    pub(super) const NONE: Self = Self { near: MISS, face: 0, second: MISS, far: MISS, doubtful: MISS };

    /// Adds a hit of a face, or a miss.
    #[inline(always)]
    pub(super) fn add(&mut self, face: u64, Bracket { near, far }: Bracket) {
        let is_first = near < self.near;
        // Minima need no branches.
        self.second = smaller(self.second, if is_first { self.near } else { near });
        self.face = if is_first { face } else { self.face };
        self.near = smaller(near, self.near);
        let uncertain = if far == MISS { near } else { MISS };
        self.doubtful = smaller(uncertain, self.doubtful);
        self.far = smaller(far, self.far);
    }

    /// Returns the distance beyond which faces no longer matter to a ray that ends at `t_max`, in world units: later
    /// hits are certainly behind the first one. If `is_any`, a certain hit ends the search.
    #[inline(always)]
    pub(super) fn end(&self, ray: &Ray, t_max: f64, is_any: bool) -> f64 {
        let end = self.far + close(ray, self.far);
        let end = if is_any & (self.far < MISS) { -1.0 } else { end };
        if end < t_max { end } else { t_max }
    }

    /// Returns the result for a ray that ends at `end`. If `is_any`, any certain hit is enough.
    #[inline(always)]
    pub(super) fn known(self, ray: &Ray, end: f64, leaving: Leaving, is_any: bool) -> Known {
        let Self { near, face, second, far, doubtful } = self;
        if doubtful < far {
            // A certain hit behind an uncertain one does not make the nearer one certain.
            return Known::Bracket(Bracket { near, far: if is_any && far < MISS { far } else { MISS } });
        }
        let bracket = Bracket { near, far };
        if far < MISS && far < second && !is_any {
            let is_alone = leaving.most < 0.0 && far + close(ray, far) < second.min(end);
            Known::Face { face: face as usize, bracket, is_alone }
        } else {
            Known::Bracket(bracket)
        }
    }
}

/// Returns more than the distance, in world units, within which [`Surface::face_along`] merges two hits.
///
/// [`Surface::face_along`]: super::Surface::face_along
#[inline(always)]
fn close(ray: &Ray, distance: f64) -> f64 {
    2.0 * coincidence::close(ray, distance)
}

/// The hits of eight rays that a search has found so far.
#[derive(Clone)]
pub(super) struct Eight {
    near: [f64; LANES],
    face: [u64; LANES],
    second: [f64; LANES],
    far: [f64; LANES],
    doubtful: [f64; LANES],
}

impl Eight {
    pub(super) const NONE: Self = Self {
        near: [MISS; LANES],
        face: [0; LANES],
        second: [MISS; LANES],
        far: [MISS; LANES],
        doubtful: [MISS; LANES],
    };

    /// Returns the hits of one ray.
    #[inline(always)]
    pub(super) fn get(&self, lane: usize) -> Nearest {
        let Self { near, face, second, far, doubtful } = self;
        Nearest {
            near: near[lane],
            face: face[lane],
            second: second[lane],
            far: far[lane],
            doubtful: doubtful[lane],
        }
    }

    /// Sets the hits of one ray.
    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, nearest: Nearest) {
        let Nearest { near, face, second, far, doubtful } = nearest;
        self.near[lane] = near;
        self.face[lane] = face;
        self.second[lane] = second;
        self.far[lane] = far;
        self.doubtful[lane] = doubtful;
    }
}
