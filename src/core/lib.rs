//! The core of a ray tracer in which a scene is data: geometry, what a scene is made of, the tables of entity types,
//! shapes, rendering and images.
//!
//! A [`Model`](scene::Model) becomes a [`Plan`](render::Plan), and tile by tile an image
//! ([`Renderer`](render::Renderer), [`Format`](output::Format)). A plugin registers an entity type as an
//! [`Entity`](scene::Entity); [`prelude`] has everything that it needs. `tabray-lang` reads the texts of scenes, and
//! `tabray-plugins` has the entity types of tabray.
//!
//! The core starts no threads and reads no clock: its loops run on the rayon pool that the caller is in ([`parallel`]).
//!
//! ```
//! use tabray_core::prelude::*;
//!
//! struct Ball;
//!
//! impl Implicit for Ball {
//!     fn value<N: Scalar>(&self, at: [N; 3]) -> N {
//!         dot(at, at) - N::constant(4.0)
//!     }
//!
//!     fn bounds(&self) -> [DVec3; 2] {
//!         [DVec3::splat(-2.0), DVec3::splat(2.0)]
//!     }
//! }
//!
//! let ball = Body::implicit(Ball, Frame::at(DVec3::new(4.0, 2.0, -4.0))).shape;
//! let ray = Ray { origin: DVec3::new(4.0, 2.0, 6.0), dir: DVec3::NEG_Z };
//! assert_eq!(ball.distance(&ray, &RayRange::ALL), 8.0);
//! ```
//!
//! `cargo run -p tabray-core --example torus` draws a shape; examples of `tabray-lang` render scenes.

// The vectors of positions and colours, and the numbers of formulas.
pub use glam;
pub use tabray_exact as exact;
pub use tabray_render as render;
pub use tabray_render::output;
pub use tabray_shapes as shapes;
pub use tabray_world as world;
pub use tabray_world::{beside, choices, kernels, levels, named, queries_by_equation};
pub use tabray_world::{files, geometry, memory, parallel, scene, simd, text};

pub mod prelude;
pub mod query;
