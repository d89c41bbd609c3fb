//! The arithmetic of shading, for all points of a packet at once.

use crate::limits::MAX_RAYS;
use crate::plan::depth::{Branch, MANY};
use tabray_world::material::{Look, Rgb};
use tabray_world::packets::shader::is_any;
use tabray_world::rules;
use tabray_world::simd::cpu::kernels;
use tabray_world::simd::soa::{View, ViewMut};

/// The light that rays on the same path, from object to object, can add to a pixel.
#[derive(Clone, Copy)]
pub(super) struct PathWeight {
    /// The largest factor by which the rays' light is multiplied on the path.
    pub weight: f64,
    /// The fraction of the primary ray's allowance for cuts that each ray gets.
    pub share: f64,
}

/// A ray budget below this means that [`MANY`] rays have been followed.
pub(super) const FEW: u32 = MAX_RAYS as u32 - MANY;

/// Points on which a light shines.
pub(super) struct LitPoints<'l> {
    /// The unit vectors toward the light.
    pub toward: View<'l>,
    /// The directions of the rays that hit the points.
    pub seen: View<'l>,
    pub normals: View<'l>,
    /// The factors of the light, from the angles at which it arrives and under the notes' rules the distances.
    pub strengths: &'l [f64],
    /// 0 where the light does not shine.
    pub shines: &'l [u64],
    /// 1 where the light is blocked.
    pub blocked: &'l [u64],
    /// The colours that the light sends.
    pub emissivity: Colours<'l>,
    /// The exponent of each point's highlight, 0 for no highlight; empty where all have the same.
    pub exponents: &'l [f64],
    pub looks: Reflectivities<'l>,
}

/// The reflectivities of points of a surface.
#[derive(Clone, Copy)]
pub(super) enum Reflectivities<'l> {
    /// One set of reflectivities for all points.
    Uniform(Look),
    /// Reflectivities for each point.
    Each { diffuse: View<'l>, specular: View<'l> },
}

/// Colours at points of a surface.
#[derive(Clone, Copy)]
pub(super) enum Colours<'c> {
    /// One colour for all points.
    Uniform(Rgb),
    /// A colour for each point.
    Each(View<'c>),
}

kernels! {
    /// Adds the light that reaches points, where it does.
    pub(super) fn add_glints(lit: &LitPoints, shininess: f64) => colours {
        let (count, whole) = (lit.shines.len(), shininess as u32);
        let colours = colours.first(count);
        if shininess == 0.0 {
            shine_each(lit, None::<fn(usize, f64) -> f64>, colours);
        } else if !lit.exponents.is_empty() {
            let highlight = |lane: usize, cos: f64| match lit.exponents[lane] {
                0.0 => 0.0,
                exponent => libm::pow(cos.min(1.0), exponent),
            };
            shine_each(lit, Some(highlight), colours);
        } else if f64::from(whole) == shininess && whole < 1 << 8 {
            shine_each(lit, Some(|_, cos| whole_power::<8>(cos, whole)), colours);
        } else if f64::from(whole) == shininess && whole < 1 << 17 {
            shine_each(lit, Some(|_, cos| whole_power::<17>(cos, whole)), colours);
        } else {
            // Rounding may make a cosine larger than 1, and a large power of it much larger.
            shine_each(lit, Some(|_, cos: f64| libm::pow(cos.min(1.0), shininess)), colours);
        }
    }

    /// Marks the rays that continue from a surface, given the lengths of the paths to it, in world units.
    pub(super) fn reach(travelled: &[f64], continue_mask: &mut [u64]) {
        let (count, travelled) = (continue_mask.len(), &travelled[..continue_mask.len()]);
        for lane in 0..count {
            continue_mask[lane] = u64::from(rules::path_left(travelled[lane]) >= 0.0);
        }
    }

    /// Clears `continue_mask` for the rays that can return too little to be seen. `ray_budget` has the number of rays that
    /// each ray may still cost; `None` where no ray has cost [`MANY`] yet.
    pub(super) fn cull_faint(
        travelled: &[f64], path_weight: PathWeight, branch: &Branch, ray_budget: Option<&[u32]>, continue_mask: &mut [u64]
    ) {
        let (count, PathWeight { weight, share }) = (continue_mask.len(), path_weight);
        let (faint, faint_alone) = (weight * branch.faint, weight * branch.faint_alone);
        let travelled = &travelled[..count];
        for lane in 0..count {
            let is_faint = faint < share * travelled[lane];
            continue_mask[lane] &= u64::from(!is_faint);
        }
        if let Some(ray_budget) = ray_budget {
            let ray_budget = &ray_budget[..count];
            for lane in 0..count {
                let is_faint = (ray_budget[lane] < FEW) & (faint_alone < travelled[lane]);
                continue_mask[lane] &= u64::from(!is_faint);
            }
        }
    }

    /// Returns the smallest ray budget.
    pub(super) fn fewest(ray_budget: &[u32]) -> u32 {
        ray_budget.iter().fold(u32::MAX, |fewest, ray_budget| fewest.min(*ray_budget))
    }

    /// Reflects directions. Marks the rays that continue: those whose path is not too long, and that hit a point whose
    /// specular reflectivity is not 0.
    pub(super) fn mirror(
        dir: View, normals: View, specular: Colours, travelled: &[f64], continue_mask: &mut [u64]
    ) => out {
        let count = dir.len();
        let (normals, mut out) = (normals.first(count), out.first(count));
        let (travelled, continue_mask) = (&travelled[..count], &mut continue_mask[..count]);
        for lane in 0..count {
            let (dir, normal) = (dir.get(lane), normals.get(lane));
            out.set(lane, rules::mirrored(dir.to_array(), normal.to_array()).into());
            continue_mask[lane] = u64::from(rules::path_left(travelled[lane]) >= 0.0);
        }
        if let Colours::Each(specular) = specular {
            let specular = specular.first(count);
            for lane in 0..count {
                continue_mask[lane] &= is_any(specular.get(lane));
            }
        }
    }

    /// Attenuates colours, given the path lengths of their light, in world units.
    pub(super) fn fade(travelled: &[f64]) => colours {
        let count = travelled.len();
        let mut colours = colours.first(count);
        for lane in 0..count {
            colours.set(lane, rules::attenuation(travelled[lane]) * colours.get(lane));
        }
    }

    /// Adds reflected light.
    pub(super) fn reflect(specular: Colours, seen: View) => colours {
        let count = seen.len();
        let mut colours = colours.first(count);
        match specular {
            Colours::Uniform(specular) => for lane in 0..count {
                colours.set(lane, rules::reflected(colours.get(lane), seen.get(lane), specular));
            },
            Colours::Each(specular) => {
                let specular = specular.first(count);
                for lane in 0..count {
                    let specular = specular.get(lane);
                    colours.set(lane, rules::reflected(colours.get(lane), seen.get(lane), specular));
                }
            }
        }
    }
}

/// Computes a power whose exponent has fewer than `BITS` bits, by repeated squaring. The number of steps is fixed, so
/// the loop around it is vectorized, unlike one around a general power function.
#[inline(always)]
fn whole_power<const BITS: u32>(of: f64, power: u32) -> f64 {
    let (mut product, mut square) = (1.0, of);
    for bit in 0..BITS {
        product = if power >> bit & 1 == 1 { product * square } else { product };
        square *= square;
    }
    product
}

/// Adds the light that reaches points. `highlight` returns the strength of a point's highlight from the cosine of its angle.
#[inline(always)]
fn shine_each(lit: &LitPoints, highlight: Option<impl Fn(usize, f64) -> f64>, colours: ViewMut) {
    let count = lit.shines.len();
    match lit.looks {
        Reflectivities::Uniform(Look { diffuse, specular, .. }) => {
            shine_sent(lit, |_| diffuse, |_| specular, highlight, colours);
        }
        Reflectivities::Each { diffuse, specular } => {
            let (diffuse, specular) = (diffuse.first(count), specular.first(count));
            shine_sent(lit, |lane| diffuse.get(lane), |lane| specular.get(lane), highlight, colours);
        }
    }
}

/// Adds the light that reaches points, given their reflectivities by lane.
#[inline(always)]
fn shine_sent(
    lit: &LitPoints,
    diffuse: impl Fn(usize) -> Rgb,
    specular: impl Fn(usize) -> Rgb,
    highlight: Option<impl Fn(usize, f64) -> f64>,
    colours: ViewMut,
) {
    match lit.emissivity {
        Colours::Uniform(sent) => shine_all(lit, |_| sent, diffuse, specular, highlight, colours),
        Colours::Each(sent) => {
            let sent = sent.first(lit.shines.len());
            shine_all(lit, |lane| sent.get(lane), diffuse, specular, highlight, colours);
        }
    }
}

/// Adds the light that reaches points, given their reflectivities and the colours that the light sends by lane.
#[inline(always)]
fn shine_all(
    lit: &LitPoints,
    sent: impl Fn(usize) -> Rgb,
    diffuse: impl Fn(usize) -> Rgb,
    specular: impl Fn(usize) -> Rgb,
    highlight: Option<impl Fn(usize, f64) -> f64>,
    mut colours: ViewMut,
) {
    let count = lit.shines.len();
    let (toward, seen, normals) = (lit.toward.first(count), lit.seen.first(count), lit.normals.first(count));
    let (strengths, shines, blocked) = (&lit.strengths[..count], &lit.shines[..count], &lit.blocked[..count]);
    for lane in 0..count {
        let light = sent(lane);
        let mut colour = diffuse(lane) * light * strengths[lane];
        if let Some(highlight) = &highlight {
            let half = (toward.get(lane) - seen.get(lane)).normalize();
            let cosine = half.dot(normals.get(lane));
            // There is no highlight from behind: powers of a negative cosine have the wrong sign, or are NaN.
            let added = light * specular(lane) * highlight(lane, cosine);
            colour = if cosine > 0.0 { colour + added } else { colour };
        }
        let before = colours.get(lane);
        let is_lit = (shines[lane] != 0) & (blocked[lane] != 1);
        colours.set(lane, if is_lit { before + colour } else { before });
    }
}
