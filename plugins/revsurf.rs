//! A surface of revolution: a line turned around an axis.

use crate::accuracy::Accuracy;
use crate::bounds::Bounds;
use crate::certify::{self, Enclosure};
use crate::entity::{Args, Entity, Refusal};
use crate::formula::Formula;
use crate::geometry::{Body, Hittable, Ray, Span};
use crate::pparm::{Pparm, Table};
use crate::profile::{Line, Profile};
use crate::revolution::{Classic, Finish, NoSurface, Revolution};
use glam::{DMat3, DVec3};
use std::sync::Arc;

static SURFER: Pparm<Option<&'static Profile>> =
    Pparm::or("surfer", "the line that is turned, by the notes' number or by its name", None);
static PROFILE: Pparm<Option<Arc<Formula>>> = Pparm::or(
    "profile",
    "the line that is turned, in place of a surfer: its distance from the axis at each height y",
    None,
);
static DIRECTION: Pparm<DVec3> = Pparm::required("direction", "the direction of the axis, from base upward")
    .must("a vector with a direction", |axis: &DVec3| axis.try_normalize().is_some());
static BASE: Pparm<DVec3> =
    Pparm::required("base", "the point of the axis where the height is 0").unit("world coordinates");
static HEIGHT: Pparm<f64> = Pparm::required("height", "how far along the axis it goes")
    .unit("world units")
    .must("positive", |height| *height > 0.0)
    .not_dumped();

const TABLE: Table = &[&SURFER, &PROFILE, &DIRECTION, &BASE, &HEIGHT];

inventory::submit! {
    Entity::shape("revsurf", "a line turned around an axis, such as a cone, a vase or a column", &[TABLE], |args| {
        let up = args.get(&DIRECTION).normalize();
        let (across, away) = up.any_orthonormal_pair();
        let frame = Frame { base: args.get(&BASE), axes: DMat3::from_cols(across, up, away) };
        let (line, height) = (line(args)?, args.get(&HEIGHT));
        let finish = match args.accuracy() {
            Accuracy::Classic => {
                let surface = Surface::Classic(Classic { line, height });
                return Ok(Body::plain(Revsurf { frame, surface }));
            }
            Accuracy::Draft => Finish::Bracket,
            Accuracy::Exact | Accuracy::Strict => Finish::Root,
        };
        let surface = Revolution::new(&line.radius, height).map_err(|fault| Refusal {
            attribute: Some(if args.get(&SURFER).is_some() { "surfer" } else { "profile" }),
            message: match fault {
                NoSurface::Unbounded { near } => format!("has a profile without a bound near y = {near:.6}"),
                NoSurface::Nowhere => "has a profile that is nowhere above 0".to_owned(),
            },
            help: "a profile is the distance from the axis, finite at each height from 0 to the surface's own",
        })?;
        Ok(Body::plain(Revsurf { frame, surface: Surface::Exact(surface, finish) }))
    })
}

/// The line that an entity names or spells out.
fn line(args: &Args) -> Result<Line, Refusal> {
    match (args.get(&SURFER), args.get(&PROFILE)) {
        (Some(profile), None) => Ok(profile.line()),
        (None, Some(formula)) => Ok(Line { radius: (*formula).clone(), slope: None }),
        (Some(_), Some(_)) => Err(Refusal {
            attribute: Some("profile"),
            message: "has a surfer and a profile".to_owned(),
            help: "one of them is the line that is turned",
        }),
        (None, None) => Err(Refusal {
            attribute: None,
            message: "lacks `surfer` or `profile`".to_owned(),
            help: "give it `surfer N`, or a formula: `profile \"2 + sin(y)\"`",
        }),
    }
}

/// Where it stands, and the directions in the world of its own x, y (the axis) and z.
struct Frame {
    base: DVec3,
    axes: DMat3,
}

impl Frame {
    #[inline(always)]
    fn to_local(&self, ray: &Ray) -> Ray {
        Ray { origin: self.place(ray.origin), dir: self.axes.transpose_mul_vec3(ray.dir) }
    }

    #[inline(always)]
    fn place(&self, at: DVec3) -> DVec3 {
        self.axes.transpose_mul_vec3(at - self.base)
    }
}

struct Revsurf {
    frame: Frame,
    surface: Surface,
}

enum Surface {
    Classic(Classic),
    Exact(Revolution, Finish),
}

impl Hittable for Revsurf {
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let ray = self.frame.to_local(ray);
        match &self.surface {
            Surface::Classic(surface) => surface.first_hit(&ray, within),
            Surface::Exact(surface, finish) => surface.first_hit(&ray, within, *finish),
        }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        let at = self.frame.place(at);
        let normal = match &self.surface {
            Surface::Classic(surface) => surface.normal(at),
            Surface::Exact(surface, _) => surface.normal(at),
        };
        (self.frame.axes * normal).normalize()
    }

    fn bounds(&self) -> Option<Bounds> {
        match &self.surface {
            Surface::Classic(_) => None,
            Surface::Exact(surface, _) => {
                Some(surface.bounds().from_frame(self.frame.base, &self.frame.axes))
            }
        }
    }

    fn is_convex(&self) -> bool {
        matches!(self.surface, Surface::Classic(_))
    }

    fn is_two_sided(&self) -> bool {
        !self.is_convex()
    }

    fn certify(&self, ray: &Ray) -> Enclosure {
        match &self.surface {
            Surface::Classic(surface) => certify::first_hit(surface, &self.frame.to_local(ray)),
            Surface::Exact(surface, _) => certify::first_hit(surface, &self.frame.to_local(ray)),
        }
    }
}
