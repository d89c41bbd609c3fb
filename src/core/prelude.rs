//! Everything that a plugin needs, in one `use`: `tabray::prelude::*`, in `plugins/` as elsewhere.
//!
//! Arithmetic that only some shapes share is not included; it is in [`shapes`](crate::shapes) and
//! [`double_double`](tabray_exact::double_double).

// Registration of an entity type: its table, its constructor, and the constructor's arguments.
pub use crate::scene::attribute::{MIN_LENGTH, Pose};
pub use crate::scene::counts::{Counts, OneOf};
pub use crate::scene::entity::{Args, Entity, Refusal};
pub use crate::scene::list::List;
pub use crate::scene::pparm::{Attributes, Derived, Pparm, Row, Table};
pub use crate::scene::value::{COLOUR, Datum, PerChannel, Type, Value, WholePerChannel};
pub use inventory;

// What a constructor returns: a camera, a material, a texture, a shader, an object, a light or a background.
pub use crate::world::accuracy::{Accuracy, AccuracyTag, Bounded, Classic, Draft, Exact, Strict};
pub use crate::world::any_shape::AnyShape;
pub use crate::world::background::Background;
pub use crate::world::ball::{Ball, BallSample};
pub use crate::world::bent::{Bend, Bent};
pub use crate::world::body::{AnyShader, Body, NamedBody, ShaderFactory, Warning};
pub use crate::world::camera::{Camera, Origins, Projected};
pub use crate::world::emitter::{self, Emitter, Extent, LightSample};
pub use crate::world::hittable::{Bracketed, Certified, Curvature, Facts, Hittable, Shape, Sides};
pub use crate::world::interface::{AnyInterface, Crossing, Interface, Law, Medium};
pub use crate::world::light::Light;
pub use crate::world::material::{Look, Material, Rgb};
pub use crate::world::panel::Panel;
pub use crate::world::patch::{Patch, PatchBounds, between, is_odd, odd_part, odd_part_bounds};
pub use crate::world::pinhole::Pinhole;
pub use crate::world::rules::Rules;
pub use crate::world::sample::Sampler;
pub use crate::world::sensor::AnyCamera;
pub use crate::world::shader::{Anchor, EnclosedShader, LookBounds, Shader, enclosed};
pub use crate::world::surface_formula;
pub use crate::world::surface_point::{PointBounds, ShaderInputs, SurfacePoint};
pub use crate::world::texture::{CUTOFF, Texture};

// What a scene selects by name: shaders, profiles and other alternatives.
pub use crate::choices;
pub use crate::scene::choice::{Choice, ChoiceName};
pub use crate::scene::procedural::{OnPlane, OnSphere};
pub use crate::scene::profile::{Profile, ProfileLine};
pub use tabray_exact::formula::Formula;
pub use tabray_exact::formula::field::{CurveField, Field, PatchField, SurfaceField};

// What the traits of shapes and cameras take and return.
pub use crate::geometry::aabb::{Aabb, SLACK};
pub use crate::geometry::frame::Frame;
pub use crate::geometry::image_point::{ImagePoint, from_middle};
pub use crate::geometry::placement::Rotation;
pub use crate::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};
pub use crate::geometry::sight::{Line, Sight};
pub use crate::geometry::view_frame::{ViewFrame, half_tangent};
pub use crate::shapes::Made;
pub use crate::shapes::implicit::Implicit;
pub use crate::shapes::parametric::Parametric;
pub use crate::world::certify::{Equation, Precise};
pub use tabray_exact::double_double::DoubleDouble;
pub use tabray_exact::dual::Dual;
pub use tabray_exact::interval::{Interval, Wide};
pub use tabray_exact::scalar::{Scalar, constants, cross, dot, per_axis};

// Vectors and matrices, and functions with the same bits on every machine, unlike `f64::sin`.
pub use glam::{DMat3, DVec2, DVec3};
pub use libm;
