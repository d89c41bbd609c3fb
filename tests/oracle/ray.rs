//! Rays, and vectors of exact numbers.

use super::dyadic::Dyadic;
use super::number::Number;
use super::text::{Scene, Vector, View};
use super::wide::Wide;

/// The ray `origin + s * dir`, and the length of `dir`.
#[derive(Clone)]
pub struct Ray {
    pub origin: Vector,
    pub dir: Vector,
    pub length: Wide,
    /// The z of `origin` and of `dir` in the world, also where the ray is in a copy's own coordinates; `None` where the
    /// camera does not cut planes off.
    pub world_z: Option<[Dyadic; 2]>,
}

impl Ray {
    /// Returns the exact ray from the eye through a pixel, whose coordinates count from the left and from the bottom.
    pub fn of_pixel(scene: &Scene, x: i64, y: i64) -> Self {
        let [width, height] = scene.pixels;
        let dir = match &scene.view {
            View::Screen(screen) => {
                // x / (width - 1) of the image plane's width, or the middle of a single pixel, times both denominators.
                let part = |at: i64, pixels: i64| if pixels > 1 { (at, pixels - 1) } else { (1, 2) };
                let [(x, of_x), (y, of_y)] = [part(x, width), part(y, height)];
                let place = [
                    screen[0].mul(&Dyadic::int(x * of_y)),
                    screen[1].mul(&Dyadic::int(y * of_x)),
                    Dyadic::zero(),
                ];
                let both = Dyadic::int(of_x * of_y);
                [0, 1, 2].map(|axis| place[axis].sub(&scene.eye[axis].mul(&both)))
            }
            View::Ahead(vectors) => {
                let [forward, right, up] = &**vectors;
                // The image's edges are half a pixel beyond the outermost pixels; all times its width in pixels.
                let [x, y] = [2 * x + 1 - width, 2 * y + 1 - height].map(Dyadic::int);
                let part = |axis: usize| right[axis].mul(&x).add(&up[axis].mul(&y));
                [0, 1, 2].map(|axis| forward[axis].mul(&Dyadic::int(width)).add(&part(axis)))
            }
        };
        Self { length: Wide::root_of(&dot(&dir, &dir)), ..Self::new(scene, scene.eye.clone(), dir) }
    }

    /// Returns a ray of `f64` numbers as they are. Distances along it are in units of its direction's length.
    pub fn as_is(scene: &Scene, origin: [f64; 3], dir: [f64; 3]) -> Self {
        Self::new(scene, origin.map(Dyadic::from), dir.map(Dyadic::from))
    }

    fn new(scene: &Scene, origin: Vector, dir: Vector) -> Self {
        let does_cut = matches!(scene.view, View::Screen(_));
        let world_z = does_cut.then(|| [origin[2].clone(), dir[2].clone()]);
        Self { origin, dir, length: Wide::int(1), world_z }
    }

    /// Returns the ray from one of its places on.
    pub fn from(&self, place: &Dyadic) -> Self {
        let ahead = |origin: &Dyadic, dir: &Dyadic| origin.add(&dir.mul(place));
        let origin = [0, 1, 2].map(|axis| ahead(&self.origin[axis], &self.dir[axis]));
        let world_z = self.world_z.as_ref().map(|[z, dir]| [ahead(z, dir), dir.clone()]);
        Self { origin, world_z, ..self.clone() }
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
