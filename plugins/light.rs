//! A light: a point that shines evenly in all directions.

use crate::entity::Entity;
use crate::geometry::Light;
use crate::material::Rgb;
use crate::pparm::{Pparm, Table};
use glam::DVec3;

static LOCATION: Pparm<DVec3> = Pparm::required("location", "where it is").unit("world coordinates");
static EMISSIVITY: Pparm<Rgb> =
    Pparm::required("emissivity", "red, green and blue of the light that it sends");

const TABLE: Table = &[&LOCATION, &EMISSIVITY];

inventory::submit! {
    Entity::light("light", "a point that shines evenly in all directions", &[TABLE], |args| {
        Ok(Box::new(PointLight { location: args.get(&LOCATION), emissivity: args.get(&EMISSIVITY) }))
    })
}

struct PointLight {
    location: DVec3,
    emissivity: Rgb,
}

impl Light for PointLight {
    fn location(&self) -> DVec3 {
        self.location
    }

    fn emissivity(&self, _toward: DVec3) -> Option<Rgb> {
        Some(self.emissivity)
    }
}
