//! Everything that a plugin needs, in one `use`: `tabray::prelude::*`, in `plugins/` as elsewhere.
//!
//! Arithmetic that only some shapes share is not included; it is in [`shapes`](tabray_shapes) and
//! [`double_double`](tabray_exact::double_double).

// Registration of an entity type: its table, its constructor, and the constructor's arguments.
pub use inventory;
pub use tabray_world::scene::attribute::{MIN_LENGTH, Pose};
pub use tabray_world::scene::counts::{Counts, OneOf};
pub use tabray_world::scene::entity::{Args, Entity, Refusal};
pub use tabray_world::scene::list::List;
pub use tabray_world::scene::pparm::{Attributes, Derived, Pparm, Row, Table};
pub use tabray_world::scene::value::{COLOUR, Datum, PerChannel, Type, Value, WholePerChannel};

// What a constructor returns: a camera, a material, a texture, a shader, an object, a light or a background.
pub use tabray_world::accuracy::{Accuracy, AccuracyTag, Classic, Draft, Exact, NotClassic, Strict};
pub use tabray_world::any_shape::AnyShape;
pub use tabray_world::background::Background;
pub use tabray_world::ball::Ball;
pub use tabray_world::bent::{Bend, Bent};
pub use tabray_world::body::{AnyShader, Body, Label, NamedBody, ShaderFactory, Warning};
pub use tabray_world::camera::{Camera, Origins, Projected};
pub use tabray_world::emitter::{self, Emitter, EmitterPoint, EnclosedEmitter, Extent};
pub use tabray_world::hittable::{Bracketed, Certified, Curvature, Facts, Hittable, Shape, Sides};
pub use tabray_world::interface::{AnyInterface, Crossing, Interface, Law, Medium};
pub use tabray_world::light::Light;
pub use tabray_world::luminous::Luminous;
pub use tabray_world::material::{Look, Material, Reflectivity, Rgb};
pub use tabray_world::number::{Known, Number, hull, product};
pub use tabray_world::panel::Panel;
pub use tabray_world::patch::{Patch, PatchOf, between, is_odd, tiled};
pub use tabray_world::pinhole::Pinhole;
pub use tabray_world::rules::Rules;
pub use tabray_world::sample::Sampler;
pub use tabray_world::sensor::AnyCamera;
pub use tabray_world::shader::{Anchor, Shader};
pub use tabray_world::surface_formula;
pub use tabray_world::surface_point::{Point, ShaderInputs, SurfacePoint};
pub use tabray_world::texture::{Alpha, Texture};

// What a scene selects by name: shaders, profiles and other alternatives.
pub use tabray_exact::formula::Formula;
pub use tabray_exact::formula::field::{CurveField, Field, PatchField, SurfaceField};
pub use tabray_exact::formula::joint::PointField;
pub use tabray_world::choices;
pub use tabray_world::scene::choice::{Choice, ChoiceName};
pub use tabray_world::scene::procedural::{OnPlane, OnSphere};
pub use tabray_world::scene::profile::{Profile, ProfileLine};

// What the traits of shapes and cameras take and return.
pub use tabray_exact::double_double::DoubleDouble;
pub use tabray_exact::dual::Dual;
pub use tabray_exact::interval::{Float, Interval, Wide};
pub use tabray_exact::scalar::{Scalar, constants, cross, dot, per_axis, unit};
pub use tabray_shapes::Made;
pub use tabray_shapes::implicit::Implicit;
pub use tabray_shapes::parametric::Parametric;
pub use tabray_world::certify::{Equation, Precise};
pub use tabray_world::geometry::aabb::{Aabb, SLACK};
pub use tabray_world::geometry::frame::Frame;
pub use tabray_world::geometry::image_point::{ImagePoint, from_middle};
pub use tabray_world::geometry::placement::Rotation;
pub use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};
pub use tabray_world::geometry::sight::{Line, Sight};
pub use tabray_world::geometry::view_frame::{ViewFrame, half_tangent};

// Vectors and matrices, and functions with the same bits on every machine, unlike `f64::sin`.
pub use glam::{DMat3, DVec2, DVec3};
pub use libm;
