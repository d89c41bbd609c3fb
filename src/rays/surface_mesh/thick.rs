//! Surfaces of a thickness: the points near a surface, which may be open.
//!
//! A cube around the surface is halved along each axis until the cells that the surface may cross are small. In or beside
//! each of them, a short ray hits the surface for certain. The distance from the nearest of these hits is that from the
//! surface, or a little more: at most [`APART`] times half the diagonal of a cell.

use super::body::{Body, NoBody, named};
use super::cells::Cells;
use super::proof::eighths;
use super::triangles::Triangles;
use super::{Event, NoMesh, PILOT};
use glam::DVec3;
use tabray_core::geometry::sight::Line;
use tabray_core::geometry::{Aabb, Bvh, MISS, Ray, RayBall, RayError, RayRange};
use tabray_core::parallel;
use tabray_core::scene::Model;
use tabray_core::world::AnyShape;
use tabray_core::world::certify::{HitEnclosure, HitProofs};
use tabray_exact::interval::Interval;
use tabray_exact::scalar::per_axis;

/// The maximum number of cells that the surface may cross, and the approximate number of bytes that each takes.
const MAX_CELLS: usize = 1 << 23;
const CELL: u64 = 150;

/// The maximum distance from the middle of a cell to a hit beside it, in half diagonals of the cell.
const BESIDE: f64 = 1.25;

/// The largest number of times that the cube is halved: indices of cells have 20 bits.
const MAX_HALVINGS: u32 = 20;

/// A hit counts where its distance is known up to this part of half a diagonal.
const NARROW: f64 = 1.0 / 64.0;

/// The maximum distance from a point of the surface in a cell to the hit beside the cell, in half diagonals.
const APART: f64 = 1.0 + BESIDE + NARROW;

/// The maximum number of times that a cell is halved where nothing hits the surface for certain, as beside its edge.
const DEEPEST: u32 = 4;

/// The number of steps in which a point of the border is found.
const SECANTS: u32 = 3;

/// The minimum number of cells for which threads share the work.
const MANY: usize = 64;

/// The part of a diagonal that remains as the nearest known point of the surface is a little beside the nearest one.
const SMOOTH: f64 = 0.9;

/// The number of steps that take a noticeable time.
const MANY_STEPS: usize = 1 << 14;

/// The points that are no farther from a surface than half of a thickness.
pub struct Thick {
    half: f64,
    /// Points of the surface.
    points: Vec<DVec3>,
    tree: Bvh,
}

/// The surface of an object, which may be open.
pub struct Sheet<'m> {
    shapes: Vec<&'m AnyShape>,
    bounds: Aabb,
}

impl<'m> Sheet<'m> {
    /// Returns the surface of an object of a scene.
    ///
    /// # Errors
    /// Returns why the object has no body, however thick its surface is.
    pub fn of(model: &'m Model, name: &str) -> Result<Self, NoBody> {
        let (objects, bounds) = named(model, name)?;
        let shapes: Vec<_> = objects.iter().map(|object| &object.shape).collect();
        if shapes.iter().any(|shape| shape.proven().is_none() || !shape.is_certified()) {
            return Err(NoBody::Unproven);
        }
        Ok(Self { shapes, bounds })
    }

    /// Returns the points that are no farther from the surface than half of a thickness, in world units. The distance of
    /// the body's border from the surface differs from that by at most `error`, except near the places where it is not
    /// known whether there is a surface. `memory` is as for a mesh.
    ///
    /// # Errors
    /// Returns why there is no such body.
    pub fn thickened(
        &self,
        thickness: f64,
        error: f64,
        memory: Option<u64>,
        tell: &(dyn Fn(Event) + Sync),
    ) -> Result<Body<'static>, NoMesh> {
        let most = memory.map_or(MAX_CELLS, |bytes| MAX_CELLS.min((bytes / CELL) as usize));
        let mut cells = Cells::enclosing(&self.bounds);
        let last = cells.fit(2.0 / APART * error);
        if last > MAX_HALVINGS {
            return Err(NoMesh::TooFine);
        }
        let may_be_crossed = |middle: DVec3, half: f64| {
            // Equations do not tell where a shape ends.
            self.bounds.overlaps(&Aabb { low: middle - half, high: middle + half })
                && self.shapes.iter().any(|shape| may_touch(shape, middle, half))
        };
        let done = |steps: usize| tell(Event::Done(steps));
        while cells.halvings() < last {
            if cells.halvings() == PILOT {
                // Halved once, four times as many are crossed. In the end, each is examined twice.
                let growth = 4usize.saturating_pow(last - PILOT);
                let steps = cells.list.len().saturating_mul(growth / 3 + 2 * growth);
                if steps > MANY_STEPS {
                    tell(Event::Expected { triangles: None, steps });
                }
            }
            if cells.halve(&may_be_crossed, most, &done).is_err() {
                return Err(NoMesh::TooMany(APART / 2.0 * cells.diagonal()));
            }
        }
        let radius = cells.diagonal() / 2.0;
        let found = parallel::filled(cells.list.len(), MANY, |cell| {
            done(1);
            let middle = cells.middle(cells.list[cell]);
            self.shapes.iter().find_map(|shape| point_near(shape, middle, radius))
        });
        let points: Vec<_> = found.iter().flatten().copied().collect();
        if points.is_empty() {
            return Err(NoMesh::Empty);
        }
        let tree = Bvh::of(points.len(), |index| Aabb { low: points[index], high: points[index] });
        let thick = Thick { half: thickness / 2.0, points, tree };
        let doubtful = parallel::map_ranges(cells.list.len(), MANY, &|range| {
            done(range.len());
            let is_doubtful = |cell: &usize| {
                found[*cell].is_none()
                    && self.is_doubtful(&thick, cells.middle(cells.list[*cell]), radius, DEEPEST)
            };
            range.filter(is_doubtful).map(|cell| cells.cube(cell)).collect()
        });
        let Aabb { low, high } = self.bounds;
        let bounds = Aabb { low: low - thick.half, high: high + thick.half };
        Ok(Body::near(thick, bounds, doubtful))
    }

    /// Tells whether a cube may have a point of the surface that is too far from all known ones. `radius` is half of its
    /// diagonal, and it may be halved so many times.
    fn is_doubtful(&self, thick: &Thick, middle: DVec3, radius: f64, halvings: u32) -> bool {
        let half = radius / 3f64.sqrt();
        let limit = APART * libm::scalbn(radius, (DEEPEST - halvings) as i32) - radius;
        thick.distance(middle, limit).is_none()
            && self.shapes.iter().any(|shape| may_touch(shape, middle, half))
            // Most cells are cleared by their halves alone.
            && (halvings == DEEPEST || self.shapes.iter().any(|shape| may_cross(shape, middle, half)))
            && (halvings == 0
                || eighths(middle, half).any(|middle| self.is_doubtful(thick, middle, radius / 2.0, halvings - 1)))
    }
}

impl Thick {
    /// Tells whether a cube lies inside or outside; `None` where the border may pass through it.
    pub fn contains(&self, middle: DVec3, half: f64) -> Option<bool> {
        let radius = half * 3f64.sqrt();
        match self.distance(middle, self.half + radius) {
            None => Some(false),
            Some(distance) if distance + radius < self.half => Some(true),
            Some(distance) if distance - radius > self.half => Some(false),
            Some(_) => None,
        }
    }

    /// Returns the part of the way from a point inside to a point outside that lies inside, approximately.
    pub fn inner_part(&self, inside: DVec3, outside: DVec3) -> f64 {
        // By the secant method, which takes fewer steps than halving, as distances hardly bend.
        let (mut low, mut high) = ((0.0, self.depth(inside)), (1.0, self.depth(outside)));
        let mut part = 0.5;
        for _ in 0..SECANTS {
            part = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            let depth = self.depth(inside.lerp(outside, part));
            *(if depth > 0.0 { &mut low } else { &mut high }) = (part, depth);
        }
        part
    }

    /// Returns how deep a point lies inside, as the difference between half of the thickness and its distance from the
    /// surface, in world units. It is negative outside.
    pub fn depth(&self, at: DVec3) -> f64 {
        self.half - self.distance(at, MISS).unwrap_or(MISS)
    }

    /// Returns the diagonal of cells whose triangles are within an error of the border where that is smooth.
    pub fn smooth_diagonal(&self, error: f64) -> f64 {
        SMOOTH * (2.0 * self.half * error).sqrt()
    }

    /// Returns the error with which cells of a diagonal suffice where the border is smooth, twice as large as that of
    /// their triangles.
    pub fn smooth_error(&self, diagonal: f64) -> f64 {
        let diagonal = diagonal / SMOOTH;
        diagonal * diagonal / self.half
    }

    /// Tells whether the distances of all points of triangles from the surface certainly differ from half of the thickness
    /// by at most an error.
    pub fn is_near(&self, triangles: &Triangles, error: f64) -> bool {
        let square = |of: f64| of * of;
        let is_off = |face: &usize| {
            let corners = triangles.corners(*face);
            let largest = |of: [f64; 3]| of.into_iter().fold(0.0, f64::max);
            let side = largest([0, 1, 2].map(|at| corners[at].distance_squared(corners[(at + 1) % 3])));
            let slack =
                largest(triangles.faces[*face].map(|vertex| triangles.vertices[vertex as usize].slack));
            // The square of the distance from a point, less that from the origin, is linear, and the least of such
            // functions is concave: in a triangle, it is no less than between the corners. Between the corners, the square
            // of the distance from the origin is too large by at most a third of that of a side.
            let low = square((self.half - slack).max(0.0)) - side / 3.0;
            // No point is farther from a point of the surface than a corner is.
            let middle = corners.into_iter().sum::<DVec3>() / 3.0;
            let high =
                self.nearest(middle, MISS).map(|(_, at)| largest(corners.map(|corner| corner.distance(at))));
            low < square((self.half - error).max(0.0)) || high.is_none_or(|high| high > self.half + error)
        };
        parallel::map_ranges(triangles.faces.len(), MANY, &|mut range| {
            range.find(is_off).into_iter().collect()
        })
        .is_empty()
    }

    /// Returns the distance from the nearest point of the surface that is known, up to a limit.
    fn distance(&self, at: DVec3, limit: f64) -> Option<f64> {
        self.nearest(at, limit).map(|(distance, _)| distance)
    }

    /// Returns the nearest point of the surface that is known, and its distance, up to a limit.
    fn nearest(&self, at: DVec3, limit: f64) -> Option<(f64, DVec3)> {
        let (mut limit, mut nearest) = (limit, None);
        self.tree.around(at, limit, &mut |index| {
            let distance = self.points[index].distance(at);
            if distance <= limit {
                (limit, nearest) = (distance, Some((distance, self.points[index])));
            }
            limit
        });
        nearest
    }
}

/// Tells whether a shape's surface may cross a cube, by its equation and its inside.
fn may_touch(shape: &AnyShape, middle: DVec3, half: f64) -> bool {
    // The bound of the error is that of a ball for some shapes, and of a cube for others.
    shape.is_on_surface(middle, half * 3f64.sqrt()) && shape.contains(middle, half).is_none()
}

/// Tells whether a shape's surface may cross a cube, by all rays through the cube along an axis: unlike an equation, these
/// know where a shape ends.
fn may_cross(shape: &AnyShape, middle: DVec3, half: f64) -> bool {
    let dir = DVec3::AXES[shape.normal(middle).abs().max_position()];
    let ray = Ray { origin: middle - half * dir, dir };
    let rays = RayBall { ray, drift: RayError { origin: half * 2f64.sqrt(), dir: 0.0 } };
    let range = RayRange { far: 2.0 * half, ..RayRange::ALL };
    shape.packets().t_bounds(&rays, &range).near <= range.far
        && shape.proven().is_none_or(|proven| {
            let origin = per_axis(|axis| match dir[axis] {
                0.0 => Interval { low: middle[axis] - half, high: middle[axis] + half },
                _ => Interval::point(middle[axis] - half),
            });
            let line = Line { origin, dir: dir.to_array().map(Interval::point) };
            match HitProofs::<f64>::first_hit(proven, &line, None).0 {
                HitEnclosure::Misses => false,
                HitEnclosure::Hits(at) | HitEnclosure::Edge(at) => at.low <= range.far,
                HitEnclosure::Doubtful(from) => from <= range.far,
            }
        })
}

/// Returns a point of a shape's surface beside a place, if a ray through the place hits one for certain.
fn point_near(shape: &AnyShape, at: DVec3, radius: f64) -> Option<DVec3> {
    [shape.normal(at), DVec3::X, DVec3::Y, DVec3::Z].into_iter().filter(|dir| dir.is_normalized()).find_map(
        |dir| {
            let ray = Ray { origin: at - BESIDE * radius * dir, dir };
            let range = RayRange { far: 2.0 * BESIDE * radius, ..RayRange::ALL };
            let bracket = shape.t_bounds(&ray, &range);
            let is_near = bracket.far <= range.far && bracket.far - bracket.near <= NARROW * radius;
            is_near.then(|| ray.at(0.5 * (bracket.near + bracket.far)))
        },
    )
}
