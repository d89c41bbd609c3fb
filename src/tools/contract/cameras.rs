//! The contract of cameras.

use super::promise::{Fault, Promise};
use glam::{DVec2, DVec3};
use tabray_core::geometry::image_point::ImagePoint;
use tabray_core::geometry::ray::Ray;
use tabray_core::geometry::sight::Line;
use tabray_core::simd::cpu::Cpu;
use tabray_core::simd::soa::{LANES, Vectors};
use tabray_core::world::camera::{Origins, Projected};
use tabray_core::world::sensor::Sensor;

/// Points of the lens, in its radius: the centre, and some of the rim and within.
const LENSES: [DVec2; 4] =
    [DVec2::ZERO, DVec2::new(1.0, 0.0), DVec2::new(-0.6, 0.8), DVec2::new(0.125, -0.5)];

/// The maximum difference between the direction to a point and that of the ray through its projection: the length of
/// the difference between unit vectors.
const DIRECTION_OFF: f64 = 1e-6;

/// An upper limit on the rounding error of a direction, which is a unit vector.
const ROUNDING: f64 = 1e-12;

/// Checks the rays of a camera through the corners and the centre of its image, and its statements about them.
pub fn camera(camera: &Sensor) -> Result<(), Fault> {
    let Sensor { pixels: [width, height], samples, .. } = *camera;
    if width == 0 || height == 0 || samples == 0 {
        let found = format!("{width} by {height} pixels, {samples} samples");
        return Err(Promise::CameraLooks.fault(found));
    }
    let [right, top] = [width - 1, height - 1].map(|side| side as f64);
    let lenses = if camera.camera.has_lens() { &LENSES[..] } else { &LENSES[..1] };
    for place in [[0.0, 0.0], [right, 0.0], [0.0, top], [right, top], [right / 2.0, top / 2.0], [-1.5, -1.5]]
    {
        for lens in lenses {
            looks(camera, place, *lens)?;
        }
        knows(camera, place)?;
    }
    in_packets(camera, [right, top])
}

/// Checks one ray.
fn looks(camera: &Sensor, at: [f64; 2], lens: DVec2) -> Result<(), Fault> {
    let place = ImagePoint { at, pixels: camera.pixels };
    let fault = |promise: Promise, found: String| {
        let [x, y] = at;
        Err(promise.fault(format!("pixel {x} {y}, lens {lens}: {found}")))
    };
    let ray @ Ray { origin, dir } = camera.camera.ray(&place, lens);
    if !origin.is_finite() || !dir.is_normalized() {
        return fault(Promise::CameraLooks, format!("it is seen along {ray:?}"));
    }
    let again = camera.camera.ray(&place, lens);
    if again.origin != origin || again.dir != dir {
        return fault(Promise::CameraLooks, format!("it is seen along {ray:?}, and then along {again:?}"));
    }
    let Origins { middle, radius } = camera.origins();
    let off = origin.distance(middle);
    if radius == 0.0 && origin != middle || off > radius + ROUNDING * middle.abs().max_element() {
        return fault(Promise::CameraKnows, format!("its ray starts {off} from the middle of the origins"));
    }
    let exact = camera.camera.sight(&place, lens).ray();
    if exact.origin != origin || exact.dir.distance(dir) > ROUNDING {
        return fault(Promise::CameraKnows, format!("its ray is {ray:?}, and exactly {exact:?}"));
    }
    Ok(())
}

/// Checks the statements of a camera about its rays at a place.
fn knows(camera: &Sensor, at: [f64; 2]) -> Result<(), Fault> {
    let fault = |found: String| {
        let [x, y] = at;
        Err(Promise::CameraKnows.fault(format!("pixel {x} {y}: {found}")))
    };
    let ray = camera.ray(at[0], at[1]);
    for distance in [0.5, 7.0] {
        let point = ray.at(distance);
        match camera.project(point) {
            // A view of more than all around shows some points twice.
            Projected::At(seen) => {
                let other = camera.ray(seen.x, seen.y);
                let off = (point - other.origin).normalize_or_zero().distance(other.dir);
                if off > DIRECTION_OFF {
                    return fault(format!(
                        "{point}, which it shows, is projected at {seen}, where the ray is {other:?}"
                    ));
                }
            }
            Projected::Nowhere if !camera.pixels.contains(&1) => {
                return fault(format!("{point}, which it shows, is projected nowhere"));
            }
            _ => {}
        }
    }
    if let Some(corners) = camera.camera.corners(camera.pixels, 1e-9)
        && at[0] >= 0.0
        && !is_between(ray.dir, corners)
    {
        return fault(format!("its ray along {} is not between the corners", ray.dir));
    }
    if let Some(Line { origin, dir }) = camera.camera.rounded_line(ImagePoint { at, pixels: camera.pixels }) {
        let dir = DVec3::from(dir).normalize();
        let off = (ray.origin - DVec3::from(origin)).length() / (1.0 + ray.origin.length());
        if off > ROUNDING || dir.distance(ray.dir) > ROUNDING {
            return fault(format!("its ray is {ray:?}, and its line {origin:?} along {dir}"));
        }
    }
    Ok(())
}

/// Tells whether a direction lies between the corners of an image, given in the order around it.
fn is_between(dir: DVec3, corners: [DVec3; 4]) -> bool {
    let middle: DVec3 = corners.iter().sum();
    (0..4).all(|corner| {
        let side = corners[corner].cross(corners[(corner + 1) % 4]);
        side.dot(dir) * side.dot(middle).signum() >= -ROUNDING
    })
}

/// Checks that packets of rays are those of single places, whatever the processor.
fn in_packets(camera: &Sensor, [right, top]: [f64; 2]) -> Result<(), Fault> {
    let part = |lane: usize| lane as f64 / (LANES - 1) as f64;
    let (mut x, mut y) = ([0.0; LANES], [0.0; LANES]);
    let [mut u, mut v] = [[0.0; LANES]; 2];
    for lane in 0..LANES {
        (x[lane], y[lane]) = (part(lane) * right, part(LANES - 1 - lane) * top + 0.25);
        DVec2 { x: u[lane], y: v[lane] } = LENSES[lane % LENSES.len()];
    }
    let has_lens = camera.camera.has_lens();
    let lens: [&[f64]; 2] = if has_lens { [&u, &v] } else { [&[], &[]] };
    let is_from_one = camera.origins().radius == 0.0;
    for cpu in Cpu::all() {
        let places = camera.places_of([&x, &y], lens);
        let (mut origins, mut dirs) = (Vectors::<LANES>::of(camera.origins().middle), Vectors::<LANES>::ZERO);
        if is_from_one {
            camera.camera.fill_directions(cpu, &places, dirs.view_mut(LANES));
        } else {
            camera.camera.fill_rays(cpu, &places, origins.view_mut(LANES), dirs.view_mut(LANES));
        }
        for lane in 0..LANES {
            let lens = if has_lens { DVec2::new(u[lane], v[lane]) } else { DVec2::ZERO };
            let place = ImagePoint { at: [x[lane], y[lane]], pixels: camera.pixels };
            let alone = camera.camera.ray(&place, lens);
            if alone.origin != origins.get(lane) || alone.dir != dirs.get(lane) {
                let found =
                    format!("{alone:?} alone, {} along {} with {cpu}", origins.get(lane), dirs.get(lane));
                return Err(Promise::CameraLooks.fault(found));
            }
        }
    }
    Ok(())
}
