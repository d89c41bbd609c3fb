//! Backgrounds: the trait that a plugin implements for the colour of rays that hit no object.

use crate::material::Rgb;
use crate::number::{Number, coarse, plain};
use glam::DVec3;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::constants;

/// A background of any type.
pub type AnyBackground = Box<dyn EnclosedBackground>;

/// The colour of rays that hit nothing: primary, reflected and transmitted ones.
///
/// Its light comes from infinitely far away, so it is not divided by the distance. With `lights yes` in a scene, it
/// lights surfaces as well.
pub trait Background: Send + Sync {
    /// Returns the colour in a direction, given by a unit vector, or bounds of it in all directions of a box. Every
    /// channel is finite and 0 or more. Pictures ask in plain numbers, and proofs of colours in intervals.
    fn colour<N: Number>(&self, toward: [N; 3]) -> [N; 3]
    where
        Self: Sized;

    /// Returns an upper bound of all colours, per channel. The bound decides how deep rays are followed into mirrors
    /// and glass.
    fn brightest(&self) -> Rgb;

    /// Returns the numbers of columns and rows of an equirectangular map in whose cells the colours vary little;
    /// `None` if the colours vary slowly everywhere. The map decides in which directions light is sampled, and
    /// changes no mean.
    fn detail(&self) -> Option<[u32; 2]> {
        None
    }
}

/// A background of any type, asked in plain numbers and in intervals. Every [`Background`] is one.
pub trait EnclosedBackground: Background {
    /// Returns the [`colour`](Background::colour) in a direction.
    fn colour_toward(&self, toward: DVec3) -> Rgb;

    /// Encloses the [`colour`](Background::colour)s, before any rounding, in all directions of a box.
    fn colours_toward(&self, toward: [Interval; 3]) -> [Interval; 3];
}

impl dyn EnclosedBackground {
    /// Returns the [`colour`](Background::colour) in a direction, or bounds of it in all directions of a box.
    pub fn colour_in<N: Number>(&self, toward: [N; 3]) -> [N; 3] {
        match plain(toward) {
            Some(toward) => constants(self.colour_toward(toward)),
            None => self.colours_toward(toward.map(coarse)).map(|Interval { low, high }| N::any(low, high)),
        }
    }
}

impl<T: Background> EnclosedBackground for T {
    fn colour_toward(&self, toward: DVec3) -> Rgb {
        self.colour(toward.to_array()).into()
    }

    fn colours_toward(&self, toward: [Interval; 3]) -> [Interval; 3] {
        self.colour(toward)
    }
}
