//! Objects made of the shapes here.

use super::{implicit, parametric, solid};
use std::sync::Arc;
use tabray_world::body::Body;
use tabray_world::geometry::frame::Frame;
use tabray_world::geometry::placement::Placement;
use tabray_world::material::Material;
use tabray_world::scene::entity::Refusal;

/// The ways to make an object of shapes that several plugins share, such as `Body::implicit`. The prelude has them.
pub trait Made: Sized {
    /// Makes an object of an implicit surface. The material gives the reflectivities.
    fn implicit(formula: impl implicit::Implicit + 'static, frame: Frame) -> Self;

    /// Makes an object of a parametric surface. The material gives the reflectivities. Returns `None` if the surface is
    /// unbounded, or turns so often that the boxes of its parts do not locate them.
    fn parametric(formula: impl parametric::Parametric + 'static) -> Option<Self>;

    /// Makes the union of closed shapes, each with its name and material. An object may consist of several shapes.
    ///
    /// # Errors
    /// Returns the reason why the shapes make no solid.
    fn union(of: impl IntoIterator<Item = (String, Self, Arc<Material>)>) -> Result<Self, Refusal>;

    /// Makes a copy of an object, which may be a solid, with the given material or its own. A copy of a plane ends at
    /// `max_z`, in world space, if given.
    fn placed(object: &Arc<Self>, place: (Placement, Option<f64>), material: Option<Arc<Material>>) -> Self;
}

impl Made for Body {
    fn implicit(formula: impl implicit::Implicit + 'static, frame: Frame) -> Self {
        implicit::body(formula, frame)
    }

    fn parametric(formula: impl parametric::Parametric + 'static) -> Option<Self> {
        parametric::body(formula)
    }

    fn union(of: impl IntoIterator<Item = (String, Self, Arc<Material>)>) -> Result<Self, Refusal> {
        solid::union(of)
    }

    fn placed(object: &Arc<Self>, place: (Placement, Option<f64>), material: Option<Arc<Material>>) -> Self {
        solid::placed(object, place, material)
    }
}
