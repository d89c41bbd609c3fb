//! The body that an object of a scene encloses.

use super::thick::Thick;
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

/// What lies inside of a body.
enum Inside<'m> {
    /// The inside of a closed shape.
    Of(&'m AnyShape),
    /// The surroundings of a surface.
    Near(Thick),
}

/// The inside of an object, or the surroundings of its surface.
pub struct Body<'m> {
    inside: Inside<'m>,
    /// A box around it.
    pub bounds: Aabb,
    /// Whether its surface has edges that gradients do not show: it is a solid, or is closed by the faces of its box.
    pub(super) has_edges: bool,
    /// Whether it is made of faces, each with an equation of its own.
    has_faces: bool,
    /// What closes it, if its surface is open, as words.
    pub closed_by: Option<&'static str>,
    /// The places where it is not known whether there is a surface: low and high corners.
    pub(super) doubtful: Vec<[DVec3; 2]>,
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
    /// Nothing is proven about its surface.
    Unproven,
    /// It is a mesh already, or made of one.
    Mesh,
}

/// Returns the objects of a name, at least one, and a box around them.
pub(super) fn named<'m>(model: &'m Model, name: &str) -> Result<(Vec<&'m Object>, Aabb), NoBody> {
    let objects: Vec<_> = model.objects.iter().filter(|object| object.args.name() == name).collect();
    if objects.is_empty() {
        let mut names: Vec<_> = model.objects.iter().map(|object| object.args.name().to_owned()).collect();
        names.dedup();
        return Err(NoBody::Unknown(names));
    }
    let mut bounds = Aabb::EMPTY;
    for object in &objects {
        bounds = bounds.and(&object.shape.facts().bounds.ok_or(NoBody::Unbounded)?);
    }
    Ok((objects, bounds))
}

impl<'m> Body<'m> {
    /// Returns a box around an object of a scene.
    ///
    /// # Errors
    /// Returns why there is none.
    pub fn bounds_of(model: &Model, name: &str) -> Result<Aabb, NoBody> {
        Ok(named(model, name)?.1)
    }

    /// Returns the body of an object of a scene.
    ///
    /// # Errors
    /// Returns why the object has no body.
    pub fn of(model: &'m Model, name: &str) -> Result<Self, NoBody> {
        let (objects, bounds) = named(model, name)?;
        let first = objects[0];
        let shape = &first.shape;
        // Each part of a solid is an object of its own, and knows the whole.
        let is_solid = shape.is_of_solid();
        let why = shape.why_not_closed().filter(|_| !is_solid);
        let closed_by = match why {
            Some(CUT_BY_BOX) => Some("the faces of its box"),
            Some(why) => return Err(NoBody::Open(why.to_owned())),
            None if is_solid && !shape.bounds_body() => Some("the object that clips it"),
            None => None,
        };
        // For a mesh of many faces, intervals do not tell what is inside, and a solid does not tell what it is made
        // of.
        let parts = model.patterns.iter().map(|pattern| &pattern.args).filter(|_| is_solid);
        if parts.chain([&first.args]).any(|args| args.entity().reads_files()) {
            return Err(NoBody::Mesh);
        }
        // Of a shape of faces, proofs know the equation of one.
        let has_faces = |proven: &dyn ProofMethods| HitProofs::<f64>::face_of(proven, 0).is_some();
        let has_faces = shape.proven().is_none_or(has_faces);
        let has_edges = is_solid || closed_by.is_some() || has_faces;
        let inside = Inside::Of(shape);
        Ok(Self { inside, bounds, has_edges, has_faces, closed_by, doubtful: Vec::new() })
    }

    /// Returns the body of the points near a surface, which lie in a box.
    pub(super) fn near(thick: Thick, bounds: Aabb, doubtful: Vec<[DVec3; 2]>) -> Self {
        let inside = Inside::Near(thick);
        // Its border has edges wherever the surface has.
        Self { inside, bounds, has_edges: true, has_faces: true, closed_by: None, doubtful }
    }

    /// Tells whether a cube lies inside or outside; `None` where the surface may pass through it.
    pub fn contains(&self, middle: DVec3, half: f64) -> Option<bool> {
        let margin = MARGIN * (middle.abs().max_element() + half);
        match &self.inside {
            Inside::Of(shape) => shape.contains(middle, half + margin),
            Inside::Near(thick) => thick.contains(middle, half + margin),
        }
    }

    /// Tells whether a point lies inside or outside; `None` on the surface, or too near to it to tell.
    pub fn contains_point(&self, at: DVec3) -> Option<bool> {
        match &self.inside {
            Inside::Of(shape) => shape.contains(at, 0.0),
            Inside::Near(thick) => thick.contains(at, 0.0),
        }
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
        let value = HitProofs::<f64>::slope(self.proven()?, point, 0).value + a.hull(b).hull(c);
        let is_inside = value.high < 0.0;
        // The formula does not tell where the shape ends.
        (!value.has_zero() && self.contains_point(middle) == Some(is_inside)).then_some(is_inside)
    }

    /// Returns the surface whose surroundings it is.
    pub(super) fn thick(&self) -> Option<&Thick> {
        match &self.inside {
            Inside::Of(_) => None,
            Inside::Near(thick) => Some(thick),
        }
    }

    /// Returns the proofs about the shape whose inside it is.
    fn proven(&self) -> Option<&dyn ProofMethods> {
        match self.inside {
            Inside::Of(shape) => shape.proven(),
            Inside::Near(_) => None,
        }
    }

    /// Encloses the gradients of the equation in a box; `None` where the surface has edges that they do not show, and
    /// where they are unbounded.
    fn gradient(&self, at: [Interval; 3]) -> Option<[Interval; 3]> {
        let proven = self.proven().filter(|_| !self.has_edges)?;
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
        let Some(proven) = self.proven().filter(|_| !self.has_faces) else { return false };
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
