//! The body that an object of a scene encloses.

use glam::DVec3;
use tabray_core::geometry::Aabb;
use tabray_core::scene::Model;
use tabray_core::scene::model::Object;
use tabray_core::shapes::implicit::CUT_BY_BOX;
use tabray_core::world::AnyShape;
use tabray_core::world::certify::{HitProofs, ProofMethods, gradient};
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{dot, per_axis};

/// The margin by which cells are enlarged, as a fraction of the numbers that they are made of: rounding is less.
const MARGIN: f64 = 1e-12;

/// The inside of an object.
pub struct Body<'m> {
    shape: &'m AnyShape,
    /// A box around it.
    pub bounds: Aabb,
    /// Whether its surface has edges that gradients do not show: it is a solid, or is closed by the faces of its box.
    pub(super) has_edges: bool,
    /// Whether it is made of faces, each with an equation of its own.
    has_faces: bool,
    /// Whether the faces of its box close it.
    pub is_capped: bool,
}

/// The reason why an object encloses nothing.
#[derive(Debug, PartialEq)]
pub enum NoBody {
    /// The scene has no object of this name; the names that it has.
    Unknown(Vec<String>),
    /// Its surface is not closed, for this reason.
    Open(String),
    /// It has no bounds.
    Unbounded,
    /// It is a mesh already, or made of one.
    Mesh,
}

impl<'m> Body<'m> {
    /// Returns the body of an object of a scene.
    ///
    /// # Errors
    /// Returns why the object has no body.
    pub fn of(model: &'m Model, name: &str) -> Result<Self, NoBody> {
        let named = |object: &&Object| object.args.name() == name;
        let objects: Vec<_> = model.objects.iter().filter(named).collect();
        let Some(first) = objects.first() else {
            let mut names: Vec<_> =
                model.objects.iter().map(|object| object.args.name().to_owned()).collect();
            names.dedup();
            return Err(NoBody::Unknown(names));
        };
        let shape = &first.shape;
        let mut bounds = Aabb::EMPTY;
        for object in &objects {
            bounds = bounds.and(&object.shape.facts().bounds.ok_or(NoBody::Unbounded)?);
        }
        // Each part of a solid is an object of its own, and knows the whole.
        let is_solid = shape.is_of_solid();
        let why = shape.why_not_closed().filter(|_| !is_solid);
        let is_capped = why == Some(CUT_BY_BOX);
        if let Some(why) = why.filter(|_| !is_capped) {
            return Err(NoBody::Open(why.to_owned()));
        }
        // For a mesh of many faces, intervals do not tell what is inside, and a solid does not tell what it is made
        // of.
        let parts = model.patterns.iter().map(|pattern| &pattern.args).filter(|_| is_solid);
        if parts.chain([&first.args]).any(|args| args.entity().reads_files()) {
            return Err(NoBody::Mesh);
        }
        // Of a shape of faces, proofs know the equation of one.
        let has_faces = |proven: &dyn ProofMethods| HitProofs::<f64>::face_of(proven, 0).is_some();
        let has_faces = shape.proven().is_none_or(has_faces);
        Ok(Self { shape, bounds, has_edges: is_solid || is_capped || has_faces, has_faces, is_capped })
    }

    /// Tells whether a cube lies inside or outside; `None` where the surface may pass through it.
    pub fn contains(&self, middle: DVec3, half: f64) -> Option<bool> {
        let margin = MARGIN * (middle.abs().max_element() + half);
        self.shape.contains(middle, half + margin)
    }

    /// Tells whether a point lies inside or outside; `None` on the surface, or too near to it to tell.
    pub fn contains_point(&self, at: DVec3) -> Option<bool> {
        self.shape.contains(at, 0.0)
    }

    /// Tells whether a triangle lies inside or outside, by the mean value theorem; `None` where that does not tell.
    pub fn contains_triangle(&self, corners: [DVec3; 3]) -> Option<bool> {
        let (low, high) =
            corners.iter().fold((corners[0], corners[0]), |(low, high), at| (low.min(*at), high.max(*at)));
        let (middle, margin) = ((low + high) / 2.0, MARGIN * low.abs().max(high.abs()).max_element());
        let about = |of: f64| Interval { low: of - margin, high: of + margin };
        let gradient = self.gradient(per_axis(|axis| about(low[axis]).hull(about(high[axis]))))?;
        let [a, b, c] = corners.map(|at| dot(gradient, per_axis(|axis| about(at[axis] - middle[axis]))));
        let point = middle.to_array().map(|at| Dual::fixed(Interval::point(at)));
        let value = HitProofs::<f64>::slope(self.shape.proven()?, point, 0).value + a.hull(b).hull(c);
        let is_inside = value.high < 0.0;
        // The formula does not tell where the shape ends.
        (!value.has_zero() && self.contains_point(middle) == Some(is_inside)).then_some(is_inside)
    }

    /// Encloses the gradients of the equation in a box; `None` where the surface has edges that they do not show, and
    /// where they are unbounded.
    fn gradient(&self, at: [Interval; 3]) -> Option<[Interval; 3]> {
        let proven = self.shape.proven().filter(|_| !self.has_edges)?;
        let gradient: [Interval; 3] = gradient(proven, at, 0);
        gradient.iter().all(|of| of.is_bounded()).then_some(gradient)
    }

    /// Encloses the gradients of the equation in a cube, like `gradient`.
    pub fn gradient_in(&self, middle: DVec3, half: f64) -> Option<[Interval; 3]> {
        let half = half + MARGIN * (middle.abs().max_element() + half);
        self.gradient(middle.to_array().map(|at| Interval { low: at - half, high: at + half }))
    }

    /// Tells whether a cube may have a point of the surface where the gradient is 0, as at a node. Of a solid, this is
    /// asked of its first part.
    pub fn may_be_singular(&self, middle: DVec3, half: f64) -> bool {
        let Some(proven) = self.shape.proven().filter(|_| !self.has_faces) else { return false };
        let at = middle.to_array().map(|at| Interval { low: at - half, high: at + half });
        let gradient: [Interval; 3] = gradient(proven, at, 0);
        gradient.iter().all(|of| of.is_bounded() && of.has_zero())
            && HitProofs::<f64>::slope(proven, at.map(Dual::fixed), 0).value.has_zero()
            && self.contains(middle, half).is_none()
    }

    /// Tells whether gradients at any two points of a cube are at less than a right angle: the surface in it is then
    /// a graph over a plane. `None` where gradients do not tell.
    pub fn is_graph(&self, middle: DVec3, half: f64) -> Option<bool> {
        if self.has_edges {
            return None;
        }
        let Some(gradient) = self.gradient_in(middle, half) else { return Some(false) };
        // Products of two different numbers of an interval, not squares of one.
        let products = gradient.map(|Interval { low, high }| (low * low).min(high * high).min(low * high));
        let size = gradient.iter().map(|of| of.low.abs().max(of.high.abs())).fold(0.0, f64::max);
        Some(products.iter().sum::<f64>() > 1e-12 * size * size)
    }
}
