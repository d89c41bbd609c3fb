//! How rays continue from an object, and when they are cut.

use tabray_exact::double_double::power_of_two;
/// The most that cuts may take from a channel of a primary ray's colour: 1/1024 of a level of 1/255.
pub const FAINT: f64 = 1.0 / (1024.0 * 255.0);

/// The number of rays that a primary ray may cost before branches are cut one by one, each without regard to the
/// others.
pub(crate) const MANY: u32 = 4000;

/// Bounds on the light from the points where rays hit an object.
#[derive(Clone, Copy)]
pub struct ContinuationBounds {
    /// A bound on the light of the object's own surface, times the path length to the surface.
    pub own: f64,
    /// A bound on what rays that hit the object return, times the path length to the object.
    pub hit: f64,
    /// A bound on what rays that leave the object return, times the path length to the object.
    pub beyond: f64,
    /// How transmitted rays continue.
    pub through: Branch,
    /// How reflected rays continue.
    pub mirrored: Branch,
}

/// How rays continue in one way.
#[derive(Clone, Copy)]
pub struct Branch {
    /// The largest factor by which the rays' light is multiplied.
    pub weight: f64,
    /// The fraction of the allowance for cuts that the rays get.
    pub share: f64,
    /// The rays are cut where the path's weight times this number is less than its share times its length.
    pub faint: f64,
    /// After `MANY` rays, the rays are also cut where the path's weight times this number is less than its length.
    pub faint_alone: f64,
}

impl ContinuationBounds {
    /// The value of an object from which no rays continue.
    pub const NONE: Self =
        Self { own: 0.0, hit: 0.0, beyond: 0.0, through: Branch::NONE, mirrored: Branch::NONE };
}

/// The number of steps that reflected fractions are divided into.
pub(crate) const STEPS: i32 = 16;

/// The fraction of the allowance for cuts that the reflected ray gets where an interface divides a ray in two.
pub(super) const REFLECTED: f64 = 0.25;

/// Returns the step of a reflected fraction: 0 for all, and else the largest number n, up to [`STEPS`], such that the
/// fraction is at most 2 to the power 1 - n; `None` where nothing is reflected.
pub(crate) fn step(reflected: f64) -> Option<i32> {
    if reflected.is_nan() || reflected <= 0.0 {
        return None;
    }
    if reflected >= 1.0 {
        return Some(0);
    }
    let (mut step, mut next) = (1, 0.5);
    while step < STEPS && reflected <= next {
        step += 1;
        next *= 0.5;
    }
    Some(step)
}

impl Branch {
    /// Returns the branch of the rays at an interface whose reflected fraction is of this `step`. Where all light is
    /// reflected, no other ray continues, and the reflected ray gets the whole allowance.
    pub fn reduced(self, step: i32) -> Self {
        if step == 0 {
            return Self { share: 1.0, faint: REFLECTED * self.faint, ..self };
        }
        let most = power_of_two(1 - step);
        let times = |light: f64| if light == f64::INFINITY { light } else { most * light };
        let Self { weight, share, faint, faint_alone } = self;
        Self { weight: times(weight), share, faint: times(faint), faint_alone: times(faint_alone) }
    }

    const NONE: Self = Self { weight: 0.0, share: 1.0, faint: 0.0, faint_alone: 0.0 };
}
