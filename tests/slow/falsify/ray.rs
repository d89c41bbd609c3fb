//! Rays, and vectors of exact numbers.

use super::dyadic::Dyadic;
use super::number::Number;
use super::text::{Scene, Vector};
use super::wide::Wide;

/// The ray `origin + s * dir`, and the length of `dir`.
#[derive(Clone)]
pub struct Ray {
    pub origin: Vector,
    pub dir: Vector,
    pub length: Wide,
}

impl Ray {
    /// Returns the exact ray from the eye through a pixel, whose coordinates count from the left and from the bottom.
    pub fn of_pixel(scene: &Scene, x: i64, y: i64) -> Self {
        // x / (width - 1) of the image plane's width, or the middle of a single pixel, times both denominators.
        let part = |at: i64, pixels: i64| if pixels > 1 { (at, pixels - 1) } else { (1, 2) };
        let [(x, of_x), (y, of_y)] = [part(x, scene.pixels[0]), part(y, scene.pixels[1])];
        let place = [
            scene.screen[0].mul(&Dyadic::int(x * of_y)),
            scene.screen[1].mul(&Dyadic::int(y * of_x)),
            Dyadic::zero(),
        ];
        let both = Dyadic::int(of_x * of_y);
        let dir = [0, 1, 2].map(|axis| place[axis].sub(&scene.eye[axis].mul(&both)));
        let length = Wide::root_of(&dot(&dir, &dir));
        Self { origin: scene.eye.clone(), dir, length }
    }

    /// Returns a ray of `f64` numbers as they are. Distances along it are in units of its direction's length.
    pub fn as_is(origin: [f64; 3], dir: [f64; 3]) -> Self {
        Self { origin: origin.map(Dyadic::from), dir: dir.map(Dyadic::from), length: Wide::int(1) }
    }

    /// Returns the distance of a place along the ray.
    pub fn distance(&self, place: &Wide) -> Wide {
        place.mul(&self.length)
    }

    /// Returns the point at `place` times the direction, relative to the point `from`, rounded to `f64`.
    pub fn near(&self, place: f64, from: &Vector) -> [f64; 3] {
        let place = Dyadic::from(place);
        [0, 1, 2]
            .map(|axis| self.origin[axis].add(&self.dir[axis].mul(&place)).sub(&from[axis]).to_f64(false))
    }
}

pub fn dot(a: &Vector, b: &Vector) -> Dyadic {
    a[0].mul(&b[0]).add(&a[1].mul(&b[1])).add(&a[2].mul(&b[2]))
}

pub fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i].mul(&b[j]).sub(&a[j].mul(&b[i])))
}

pub fn minus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|axis| a[axis].sub(&b[axis]))
}

pub fn times(a: &Vector, by: &Dyadic) -> Vector {
    [0, 1, 2].map(|axis| a[axis].mul(by))
}
