//! A light as the places of a surface see it (the notes' `light_t::illuminate`, but for shadows).
//!
//! All arrays are as long as the packet's whose rays came to the places.

use crate::geometry::bounds::larger;
use crate::simd::cpu::kernels;
use crate::simd::soa::{View, ViewMut};
use crate::world::hittable::Light;
use crate::world::material::Rgb;
use glam::DVec3;

/// Places of a surface that may see a light.
pub struct Places<'p> {
    /// Where they are, in world coordinates.
    pub points: View<'p>,
    /// The unit normals there.
    pub normals: View<'p>,
    /// Where each sees the light; nothing where that is the light's own place.
    pub lights: Option<View<'p>>,
    /// What the ends of the ways are short of the light, as a part of how far that is, and of how far the places are from
    /// the world's origin.
    pub slack: f64,
}

/// What a light sends to places, and how it comes there.
pub struct Facing<'f> {
    /// The directions to it, unit vectors.
    pub toward: ViewMut<'f>,
    /// The colours that it sends, black where it sends nothing; of a light that is even they are left as they are.
    pub emissivity: ViewMut<'f>,
    /// The cosines of the angles between those directions and the normals, divided by the distances to it in world
    /// units.
    pub falloffs: &'f mut [f64],
    /// Where the ways to it end, in world units from the places; 0 where none need be gone.
    pub ends: &'f mut [f64],
    /// 0 for a place to which it sends nothing, or from behind; else 1.
    pub shines: &'f mut [u64],
}

/// What is so of any of some places.
pub struct Faced {
    /// One faces the light.
    pub any_faces: bool,
    /// To one that does the light sends something, too.
    pub any_shines: bool,
}

kernels! {
    /// How a light comes to places.
    pub(crate) fn face[T: Light](
        light: &T,
        places: &Places,
        falloffs: &mut [f64],
        ends: &mut [f64],
        shines: &mut [u64],
    ) => toward, emissivity -> Faced {
        let (count, middle) = (places.points.len(), light.location());
        let out = (falloffs, ends, shines, toward.first(count), emissivity.first(count));
        match places.lights {
            None => face_all(light, places, |_| middle, out),
            Some(lights) => {
                let lights = lights.first(count);
                face_all(light, places, |lane| lights.get(lane), out)
            }
        }
    }
}

/// As `face`, each place with the point of the light that it sees.
#[inline(always)]
fn face_all<T: Light + ?Sized>(
    light: &T,
    places: &Places,
    place: impl Fn(usize) -> DVec3,
    (falloffs, ends, shines, mut toward, mut emissivity): (
        &mut [f64],
        &mut [f64],
        &mut [u64],
        ViewMut,
        ViewMut,
    ),
) -> Faced {
    let (count, slack, is_even) = (places.points.len(), places.slack, light.even().is_some());
    let (points, normals) = (places.points.first(count), places.normals.first(count));
    let (falloffs, ends, shines) = (&mut falloffs[..count], &mut ends[..count], &mut shines[..count]);
    let (mut any_faces, mut any_shines) = (0, 0);
    for lane in 0..count {
        let point = points.get(lane);
        let between = place(lane) - point;
        let distance = between.length();
        let inverse = 1.0 / distance;
        let dir = between * inverse;
        let cosine = dir.dot(normals.get(lane));
        // A light on the surface itself makes it NaN, and is behind.
        let faces = u64::from(cosine > 0.0);
        let sent = light.emissivity(point);
        let does_shine = faces & u64::from(sent.is_some());
        let end = distance - slack * (distance + reach(point));
        toward.set(lane, dir);
        if !is_even {
            emissivity.set(lane, sent.unwrap_or(Rgb::ZERO));
        }
        falloffs[lane] = cosine * inverse;
        ends[lane] = if does_shine != 0 { end } else { 0.0 };
        shines[lane] = does_shine;
        any_faces |= faces;
        any_shines |= does_shine;
    }
    Faced { any_faces: any_faces != 0, any_shines: any_shines != 0 }
}

/// How far a point is from the world's origin along the axis where that is farthest.
#[inline(always)]
fn reach(point: DVec3) -> f64 {
    let reach = point.abs();
    larger(larger(reach.x, reach.y), reach.z)
}
