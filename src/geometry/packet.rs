//! Packets: rays by the dozen, an array for each coordinate, so that one call of a shape serves all of them and the
//! processor takes several at a time.
//!
//! A plugin is written for one ray. The loops here take its functions in and are compiled for each level of
//! instructions ([`cpu`](crate::simd::cpu)). Arrays are as long as a multiple of
//! [`STEP`](crate::simd::soa::STEP); what is beyond the last ray is a
//! copy of it, and is computed and ignored.

use crate::geometry::ray::{Bracket, MISS, Ray, Side, Span};
use crate::simd::cpu::kernels;
use crate::simd::soa::View;
use crate::world::hittable::{Hittable, Shader};
use crate::world::material::{Material, Rgb};
use std::ops::Range;

/// The most rays of a packet.
pub const WIDE: usize = 256;

/// The lanes of so many rays in parts of at most so many, neighbours together.
pub fn parts(count: usize, most: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count).step_by(most).map(move |first| first..count.min(first + most))
}

/// Rays. A packet's rays all leave the same object, or none.
#[derive(Clone, Copy)]
pub struct Rays<'r> {
    /// Where each starts.
    pub origin: View<'r>,
    /// Where each goes, a unit vector.
    pub dir: View<'r>,
    /// How far at most any origin is from the point that it stands for, in world units; 0 for rays from the viewer.
    pub origin_error: f64,
}

impl Rays<'_> {
    /// How many there are.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.origin.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.origin.is_empty()
    }

    /// The one of this index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Ray {
        Ray { origin: self.origin.get(index), dir: self.dir.get(index) }
    }

    /// The first of them, so many.
    #[inline(always)]
    pub fn first(&self, count: usize) -> Self {
        Self { origin: self.origin.first(count), dir: self.dir.first(count), ..*self }
    }

    /// Some of them.
    #[inline(always)]
    pub fn part(&self, range: Range<usize>) -> Self {
        Self { origin: self.origin.part(range.clone()), dir: self.dir.part(range), ..*self }
    }
}

/// What the rays of a packet meet first, as far as it is known.
pub struct Nearest<'n> {
    /// The hit of the object in `met` is no nearer than this.
    pub near: &'n mut [f64],
    /// And no farther than this. Both are the same where it is known exactly, and the end of the search where nothing
    /// is met.
    pub far: &'n mut [f64],
    /// The object's index and 1; 0 for none.
    pub met: &'n mut [u64],
    /// Not 0 where brackets overlap: the nearer one of two is not known yet.
    pub doubt: &'n mut [u64],
}

impl Nearest<'_> {
    /// What is known of some of the rays.
    pub fn part(&mut self, range: Range<usize>) -> Nearest<'_> {
        Nearest {
            near: &mut self.near[range.clone()],
            far: &mut self.far[range.clone()],
            met: &mut self.met[range.clone()],
            doubt: &mut self.doubt[range],
        }
    }
}

kernels! {
    /// Compares a shape's hits with the nearest so far. Tells whether any is in doubt.
    pub(crate) fn meet[T: Hittable](shape: &T, rays: Rays, sides: Option<&[Side]>, id: u64, nearest: Nearest) -> bool {
        let (count, rays) = (rays.len(), rays.first(rays.len()));
        let Nearest { near, far, met, doubt } = nearest;
        match sides {
            None => merge(count, &Sought { shape, rays }, id, near, far, met, doubt),
            Some(sides) => {
                merge(count, &Leaving { shape, rays, sides: &sides[..count] }, id, near, far, met, doubt)
            }
        }
    }

    /// Marks the rays that a shape's hits block before they come to their ends. Tells whether any is in doubt.
    pub(crate) fn block[T: Hittable](
        shape: &T, rays: Rays, sides: Option<&[Side]>, ends: &[f64], blocked: &mut [u64], doubt: &mut [u64]
    ) -> bool {
        let (count, rays) = (ends.len(), rays.first(ends.len()));
        match sides {
            None => mark(&Sought { shape, rays }, ends, blocked, doubt),
            Some(sides) => mark(&Leaving { shape, rays, sides: &sides[..count] }, ends, blocked, doubt),
        }
    }

    /// Compares brackets with the nearest so far. Tells whether any is in doubt.
    pub(crate) fn meet_brackets(near: &[f64], far: &[f64], id: u64, nearest: Nearest) -> bool {
        let count = nearest.near.len().min(near.len());
        let (near, far) = (&near[..count], &far[..count]);
        let known = Known { near, far };
        merge(count, &known, id, nearest.near, nearest.far, nearest.met, nearest.doubt)
    }

    /// Marks the rays that brackets say are blocked before their ends. Tells whether any is in doubt.
    pub(crate) fn block_brackets(
        near: &[f64], far: &[f64], ends: &[f64], blocked: &mut [u64], doubt: &mut [u64]
    ) -> bool {
        let (near, far) = (&near[..ends.len()], &far[..ends.len()]);
        mark(&Known { near, far }, ends, blocked, doubt)
    }

    /// The distances of a shape's hits, as [`Hittable::quick_distance`] gives them.
    pub(crate) fn distances[T: Hittable](shape: &T, rays: Rays, sides: Option<&[Side]>, out: &mut [f64]) {
        let (count, rays) = (out.len(), rays.first(out.len()));
        match sides {
            None => for lane in 0..count {
                out[lane] = shape.quick_distance(&rays.get(lane), &Span::RAY);
            },
            Some(sides) => for lane in 0..count {
                out[lane] = shape.quick_distance(&rays.get(lane), &Span { leaves: Some(sides[lane]), ..Span::RAY });
            },
        }
    }

    /// The reflectivities at points of a surface: for light from nowhere in particular, and as a mirror. Tells whether
    /// any of those is not 0.
    pub(crate) fn unlit[T: Shader](shader: &T, material: &Material, points: View) => ambients, speculars -> bool {
        let (count, mut any) = (points.len(), 0);
        let (mut ambients, mut speculars) = (ambients.first(count), speculars.first(count));
        for lane in 0..count {
            let point = points.get(lane);
            let specular = shader.specular(material, point);
            ambients.set(lane, shader.ambient(material, point));
            speculars.set(lane, specular);
            any |= is_any(specular);
        }
        any != 0
    }

    /// Likewise for light from the scene's lights. Tells whether any is not 0.
    pub(crate) fn diffuses[T: Shader](shader: &T, material: &Material, points: View) => out -> bool {
        let (count, mut any) = (points.len(), 0);
        let mut out = out.first(count);
        for lane in 0..count {
            let diffuse = shader.diffuse(material, points.get(lane));
            out.set(lane, diffuse);
            any |= is_any(diffuse);
        }
        any != 0
    }
}

/// 1 for a colour that is not black, else 0.
#[inline(always)]
pub(crate) fn is_any(colour: Rgb) -> u64 {
    u64::from((colour.x != 0.0) | (colour.y != 0.0) | (colour.z != 0.0))
}

/// The brackets of rays, by lane. No closures: those are taken in only where it pleases the compiler.
trait Brackets {
    /// That of a hit before `far`.
    fn get(&self, lane: usize, far: f64) -> Bracket;
}

/// Brackets that are known.
struct Known<'b> {
    near: &'b [f64],
    far: &'b [f64],
}

impl Brackets for Known<'_> {
    #[inline(always)]
    fn get(&self, lane: usize, _far: f64) -> Bracket {
        Bracket { near: self.near[lane], far: self.far[lane] }
    }
}

/// Those that a shape gives.
struct Sought<'b, T: ?Sized> {
    shape: &'b T,
    rays: Rays<'b>,
}

impl<T: Hittable + ?Sized> Brackets for Sought<'_, T> {
    #[inline(always)]
    fn get(&self, lane: usize, far: f64) -> Bracket {
        let origin_error = self.rays.origin_error;
        self.shape.bracket(&self.rays.get(lane), &Span { far, origin_error, ..Span::RAY })
    }
}

/// Those that a shape gives for rays that leave it.
struct Leaving<'b, T: ?Sized> {
    shape: &'b T,
    rays: Rays<'b>,
    sides: &'b [Side],
}

impl<T: Hittable + ?Sized> Brackets for Leaving<'_, T> {
    #[inline(always)]
    fn get(&self, lane: usize, far: f64) -> Bracket {
        let leaves = self.sides[lane];
        if !self.shape.meets_itself(leaves) {
            return Bracket::MISS;
        }
        let (leaves, origin_error) = (Some(leaves), self.rays.origin_error);
        self.shape.bracket(&self.rays.get(lane), &Span { far, leaves, origin_error, ..Span::RAY })
    }
}

// The arrays are arguments of their own, not a `Nearest`, for the compiler to know that they are not the same: else it
// looks at that each time, and takes single rays where there are few.
#[inline(always)]
fn merge(
    count: usize,
    brackets: &impl Brackets,
    id: u64,
    near: &mut [f64],
    far: &mut [f64],
    met: &mut [u64],
    doubt: &mut [u64],
) -> bool {
    let (near, far) = (&mut near[..count], &mut far[..count]);
    let (met, doubt) = (&mut met[..count], &mut doubt[..count]);
    let mut any = 0;
    for lane in 0..count {
        let Bracket { near: low, far: high } = brackets.get(lane, far[lane]);
        let is_nearer = high < near[lane];
        // Of two at the same distance the earlier one in the scene wins.
        let is_earlier = (low == far[lane]) & (met[lane] > id);
        let is_farther = (low >= far[lane]) & !is_earlier;
        // As the lesser of two, not as one or the other: of that the compiler would make stores that leave some lanes
        // out, which are slow where there is no AVX-512.
        let (low, high) = if is_nearer { (low, high) } else { (MISS, MISS) };
        near[lane] = if low < near[lane] { low } else { near[lane] };
        far[lane] = if high < far[lane] { high } else { far[lane] };
        met[lane] ^= if is_nearer { met[lane] ^ id } else { 0 };
        doubt[lane] = u64::from(!(is_nearer | is_farther));
        any |= doubt[lane];
    }
    any != 0
}

#[inline(always)]
fn mark(brackets: &impl Brackets, ends: &[f64], blocked: &mut [u64], doubt: &mut [u64]) -> bool {
    let count = ends.len();
    let (blocked, doubt) = (&mut blocked[..count], &mut doubt[..count]);
    let mut any = 0;
    for lane in 0..count {
        let Bracket { near: low, far: high } = brackets.get(lane, ends[lane]);
        let (is_before, is_behind) = (high < ends[lane], low >= ends[lane]);
        blocked[lane] |= u64::from(is_before);
        doubt[lane] = u64::from(!(is_before | is_behind)) & !blocked[lane];
        any |= doubt[lane];
    }
    any != 0
}
