//! The materials of a mesh whose file names them.

use super::surface::Surface;
use crate::world::certify::Precise;
use crate::world::material::{Look, Material, Rgb};
use crate::world::shader::{LookBounds, PointBounds, Shader, SurfacePoint};
use glam::{DVec2, DVec3};
use std::sync::Arc;
use tabray_exact::interval::Interval;

/// The colours of a mesh whose faces have materials of their own.
///
/// A face is chosen by the point alone: at an edge, where two materials meet, it may be that of the neighbouring face.
pub struct Painted {
    /// The surface.
    pub surface: Arc<Surface>,
    /// The materials in the order of the file's names; `None` for the material of the mesh itself.
    pub materials: Vec<Option<Arc<Material>>>,
}

impl Painted {
    /// Returns the slot of the material at a point.
    fn slot(&self, at: DVec3) -> u16 {
        self.surface.slots[self.surface.face_at(at)]
    }

    /// Returns the material of a slot; `own` is that of the mesh itself.
    fn material<'m>(&'m self, own: &'m Material, slot: u16) -> &'m Material {
        usize::from(slot).checked_sub(1).and_then(|index| self.materials[index].as_deref()).unwrap_or(own)
    }

    /// Returns the material at a point; `own` is that of the mesh itself.
    fn at<'m>(&'m self, own: &'m Material, at: DVec3) -> &'m Material {
        self.material(own, self.slot(at))
    }
}

impl Shader for Painted {
    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.at(material, at.position).ambient
    }

    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.at(material, at.position).diffuse
    }

    fn specular(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.at(material, at.position).specular
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        DVec2::new(f64::from(self.slot(at.position)), 0.0)
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let coarse = at.position.map(Interval::coarse);
        let slot = self.slot(DVec3::from(coarse.map(Interval::middle)));
        if self.surface.is_alone(coarse, |face| self.surface.slots[face] == slot) {
            return Some(self.material(material, slot).into());
        }
        let others = self.materials.iter().flatten().map(|other| LookBounds::from(&**other));
        Some(others.fold(material.into(), |all: LookBounds<F>, other| all.hull(&other)))
    }

    /// The largest of all materials, if none has a negative diffuse colour.
    fn brightest(&self, material: &Material) -> Option<Look> {
        let all = || self.materials.iter().flatten().map(|material| &**material).chain([material]);
        let most =
            |of: fn(&Material) -> Rgb| all().fold(Rgb::ZERO, |most, material| most.max(of(material).abs()));
        let is_plain = all().all(|material| material.diffuse.min_element() >= 0.0);
        is_plain.then(|| Look {
            ambient: most(|material| material.ambient),
            diffuse: most(|material| material.diffuse),
            specular: most(|material| material.specular),
        })
    }
}
