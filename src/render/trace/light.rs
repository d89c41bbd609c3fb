//! The arithmetic of shading, for all places of a packet at once.

use crate::render::limits::MAX_RAYS;
use crate::render::plan::depth::{Branch, MANY};
use crate::simd::cpu::kernels;
use crate::simd::soa::{View, ViewMut};
use crate::world::material::{Look, Rgb};
use crate::world::packets::shader::is_any;

/// What rays are worth that have come the same way, from object to object.
#[derive(Clone, Copy)]
pub(super) struct Worth {
    /// What their light is multiplied by on its way, at most.
    pub weight: f64,
    /// The part that each may leave out of what its camera ray may.
    pub share: f64,
}

/// Of rays that may cost so few more, [`MANY`] have been followed.
pub(super) const FEW: u32 = MAX_RAYS as u32 - MANY;

/// Places that a light shines on.
pub(super) struct Lit<'l> {
    /// From each place to the light.
    pub toward: View<'l>,
    /// Along which each is seen.
    pub seen: View<'l>,
    pub normals: View<'l>,
    /// The cosines of the angles between the normals and the directions of the light, divided by its distances.
    pub cos_over_distance: &'l [f64],
    /// 0 where no light comes.
    pub shines: &'l [u64],
    /// 1 where something stands in its way.
    pub blocked: &'l [u64],
    /// What it sends there.
    pub emissivity: Colours<'l>,
    pub looks: Reflectivities<'l>,
}

/// What places of a surface answer to light.
#[derive(Clone, Copy)]
pub(super) enum Reflectivities<'l> {
    /// All the same.
    Even(Look),
    /// Each something else.
    Each { diffuse: View<'l>, specular: View<'l> },
}

/// Colours at places of a surface.
#[derive(Clone, Copy)]
pub(super) enum Colours<'c> {
    /// The same at all.
    Even(Rgb),
    /// That of each.
    Each(View<'c>),
}

kernels! {
    /// Adds the light that comes to places, where it does.
    pub(super) fn shine(lit: &Lit, shininess: f64) => colours {
        let (count, whole) = (lit.shines.len(), shininess as u32);
        let colours = colours.first(count);
        if shininess == 0.0 {
            shine_each(lit, None::<fn(f64) -> f64>, colours);
        } else if f64::from(whole) == shininess && whole < 1 << 8 {
            shine_each(lit, Some(|cos| whole_power::<8>(cos, whole)), colours);
        } else if f64::from(whole) == shininess && whole < 1 << 17 {
            shine_each(lit, Some(|cos| whole_power::<17>(cos, whole)), colours);
        } else {
            // Rounding may make a cosine more than 1, and a large power of that anything.
            shine_each(lit, Some(|cos: f64| libm::pow(cos.min(1.0), shininess)), colours);
        }
    }

    /// Marks the rays that go on from a surface: those which have not travelled too far yet.
    pub(super) fn reach(travelled: &[f64], most: f64, goes: &mut [u64]) {
        let (count, travelled) = (goes.len(), &travelled[..goes.len()]);
        for lane in 0..count {
            goes[lane] = u64::from(travelled[lane] <= most);
        }
    }

    /// Takes the mark from rays that can bring back too little to be seen. `budget` has the rays that each may still cost;
    /// nothing where none has cost [`MANY`].
    pub(super) fn leave_out(
        travelled: &[f64], worth: Worth, branch: &Branch, ray_budget: Option<&[u32]>, goes: &mut [u64]
    ) {
        let (count, Worth { weight, share }) = (goes.len(), worth);
        let (most, most_alone) = (weight * branch.faint, weight * branch.faint_alone);
        let travelled = &travelled[..count];
        for lane in 0..count {
            let is_faint = most < share * travelled[lane];
            goes[lane] &= u64::from(!is_faint);
        }
        if let Some(ray_budget) = ray_budget {
            let ray_budget = &ray_budget[..count];
            for lane in 0..count {
                let is_faint = (ray_budget[lane] < FEW) & (most_alone < travelled[lane]);
                goes[lane] &= u64::from(!is_faint);
            }
        }
    }

    /// The fewest rays that any may still cost.
    pub(super) fn fewest(ray_budget: &[u32]) -> u32 {
        ray_budget.iter().fold(u32::MAX, |fewest, ray_budget| fewest.min(*ray_budget))
    }

    /// Directions, mirrored. Marks the rays that go on there: likewise, where the surface is a mirror.
    pub(super) fn mirror(
        dir: View, normals: View, specular: Colours, travelled: &[f64], most: f64, goes: &mut [u64]
    ) => out {
        let count = dir.len();
        let (normals, mut out) = (normals.first(count), out.first(count));
        let (travelled, goes) = (&travelled[..count], &mut goes[..count]);
        for lane in 0..count {
            let (dir, normal) = (dir.get(lane), normals.get(lane));
            out.set(lane, dir - 2.0 * dir.dot(normal) * normal);
            goes[lane] = u64::from(travelled[lane] <= most);
        }
        if let Colours::Each(specular) = specular {
            let specular = specular.first(count);
            for lane in 0..count {
                goes[lane] &= is_any(specular.get(lane));
            }
        }
    }

    /// Divides colours by how far their light has travelled.
    pub(super) fn fade(travelled: &[f64]) => colours {
        let count = travelled.len();
        let mut colours = colours.first(count);
        for lane in 0..count {
            colours.set(lane, colours.get(lane) * (1.0 / travelled[lane]));
        }
    }

    /// Adds what is mirrored.
    pub(super) fn reflect(specular: Colours, seen: View) => colours {
        let count = seen.len();
        let mut colours = colours.first(count);
        match specular {
            Colours::Even(specular) => for lane in 0..count {
                colours.set(lane, colours.get(lane) + specular * seen.get(lane));
            },
            Colours::Each(specular) => {
                let specular = specular.first(count);
                for lane in 0..count {
                    colours.set(lane, colours.get(lane) + specular.get(lane) * seen.get(lane));
                }
            }
        }
    }
}

/// A power of less than so many bits by repeated squaring: of many numbers at a time, which a general power is not, nor
/// one that ends with its last bit.
#[inline(always)]
fn whole_power<const BITS: u32>(of: f64, power: u32) -> f64 {
    let (mut product, mut square) = (1.0, of);
    for bit in 0..BITS {
        product = if power >> bit & 1 == 1 { product * square } else { product };
        square *= square;
    }
    product
}

/// As `shine`, with what a glint is of the cosine of its angle.
#[inline(always)]
fn shine_each(lit: &Lit, glint: Option<impl Fn(f64) -> f64>, colours: ViewMut) {
    let count = lit.shines.len();
    match lit.looks {
        Reflectivities::Even(Look { diffuse, specular, .. }) => {
            shine_sent(lit, |_| diffuse, |_| specular, glint, colours);
        }
        Reflectivities::Each { diffuse, specular } => {
            let (diffuse, specular) = (diffuse.first(count), specular.first(count));
            shine_sent(lit, |lane| diffuse.get(lane), |lane| specular.get(lane), glint, colours);
        }
    }
}

/// Likewise, with the reflectivities.
#[inline(always)]
fn shine_sent(
    lit: &Lit,
    diffuse: impl Fn(usize) -> Rgb,
    specular: impl Fn(usize) -> Rgb,
    glint: Option<impl Fn(f64) -> f64>,
    colours: ViewMut,
) {
    match lit.emissivity {
        Colours::Even(sent) => shine_all(lit, |_| sent, diffuse, specular, glint, colours),
        Colours::Each(sent) => {
            let sent = sent.first(lit.shines.len());
            shine_all(lit, |lane| sent.get(lane), diffuse, specular, glint, colours);
        }
    }
}

/// Likewise, with what the light sends.
#[inline(always)]
fn shine_all(
    lit: &Lit,
    sent: impl Fn(usize) -> Rgb,
    diffuse: impl Fn(usize) -> Rgb,
    specular: impl Fn(usize) -> Rgb,
    glint: Option<impl Fn(f64) -> f64>,
    mut colours: ViewMut,
) {
    let count = lit.shines.len();
    let (toward, seen, normals) = (lit.toward.first(count), lit.seen.first(count), lit.normals.first(count));
    let (cos_over_distance, shines, blocked) =
        (&lit.cos_over_distance[..count], &lit.shines[..count], &lit.blocked[..count]);
    for lane in 0..count {
        let light = sent(lane);
        let mut colour = diffuse(lane) * light * cos_over_distance[lane];
        if let Some(glint) = &glint {
            let half = (toward.get(lane) - seen.get(lane)).normalize();
            let cosine = half.dot(normals.get(lane));
            // From the wrong side there is none: powers of what is below 0 are light of the wrong sign, or no numbers.
            let lustre = light * specular(lane) * glint(cosine);
            colour = if cosine > 0.0 { colour + lustre } else { colour };
        }
        let before = colours.get(lane);
        let is_lit = (shines[lane] != 0) & (blocked[lane] != 1);
        colours.set(lane, if is_lit { before + colour } else { before });
    }
}
