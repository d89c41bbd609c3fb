//! Hits of rays, without an image: as the tracer finds them, and as they are proven.
//!
//! ```
//! use tabray_core::glam::DVec3;
//! use tabray_core::prelude::*;
//! use tabray_core::query::first::{FirstHits, first_of};
//! # struct Ball;
//! # impl Implicit for Ball {
//! #     fn value<N: Scalar>(&self, at: [N; 3]) -> N { dot(at, at) - N::constant(4.0) }
//! #     fn bounds(&self) -> [DVec3; 2] { [DVec3::splat(-3.0), DVec3::splat(3.0)] }
//! # }
//! let ray = tabray_core::query::QueryRay::new(DVec3::new(5.0, 0.0, 0.0), DVec3::new(-2.0, 0.0, 0.0)).expect("a ray");
//! let ball = Body::implicit(Ball, Frame::at(DVec3::ZERO)).shape;
//! let (FirstHits::Certain(Some(hit)), _) = first_of([(0, &ball)], ray.sight()) else { panic!("the ball is hit") };
//! let t = ray.t(hit.at);
//! assert!(t.low <= 1.5 && 1.5 <= t.high);
//! ```

pub mod answer;
mod crossings;
pub mod first;
mod ray;
mod scene;

pub use answer::{Answer, Surroundings, Verdict};
pub use crossings::Crossing;
pub use ray::{QueryRay, Start};
pub use scene::{Query, is_contradicted};
