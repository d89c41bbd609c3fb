//! Materials of a mesh with names in its file.

use super::surface::Surface;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::sync::Arc;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::constants;
use tabray_world::body::Warning;
use tabray_world::material::{Look, Material, Reflectivity, Rgb};
use tabray_world::number::{Number, coarse, hull};
use tabray_world::shader::Shader;
use tabray_world::surface_point::{Point, SurfacePoint};
use tabray_world::text;

/// The colours of a mesh whose faces have their own materials.
///
/// The point alone determines the face. At an edge between two materials, this may be the neighbouring face.
pub struct Painted {
    /// The surface.
    pub surface: Arc<Surface>,
    /// The materials in the order of the file's names, or `None` for the material of the mesh itself.
    pub materials: Vec<Option<Arc<Material>>>,
}

impl Painted {
    /// Returns the slot of the material at a point.
    fn slot(&self, at: DVec3) -> u16 {
        self.surface.slots[self.surface.face_at(at)]
    }

    /// Returns the material of a slot. The mesh itself has the material `own`.
    fn material<'m>(&'m self, own: &'m Material, slot: u16) -> &'m Material {
        usize::from(slot).checked_sub(1).and_then(|index| self.materials[index].as_deref()).unwrap_or(own)
    }

    /// Returns the material at a point. The mesh itself has the material `own`.
    fn at<'m>(&'m self, own: &'m Material, at: DVec3) -> &'m Material {
        self.material(own, self.slot(at))
    }

    /// Warns of materials in the file that are not among the `known` ones of the scene.
    pub fn unknown_materials(&self, known: &BTreeMap<String, Arc<Material>>) -> Option<Warning> {
        let unknown: Vec<_> =
            self.surface.materials.iter().filter(|name| !known.contains_key(*name)).collect();
        let near = text::nearest(unknown.first()?, known.keys().map(String::as_str));
        let guess = near.map_or(String::new(), |near| format!(" (did you mean `{near}`?)"));
        Some(Warning {
            attribute: "file",
            message: format!(
                "names {} that the scene does not have: {}{guess}",
                text::count(unknown.len(), "material"),
                first_of(&unknown)
            ),
            help: "define a material for each name; until then these faces have the material of the mesh"
                .to_owned(),
        })
    }

    /// Returns the material of the faces of a slot, with the colours of the mesh's material, `own`: those of faces are
    /// the shader's.
    pub fn material_of(&self, slot: u16, own: &Material) -> Material {
        let Material { ambient, diffuse, specular, .. } = *own;
        Material { ambient, diffuse, specular, ..self.material(own, slot).clone() }
    }
}

/// Lists the first few names.
fn first_of(names: &[&String]) -> String {
    const FEW: usize = 5;
    let shown: Vec<_> = names.iter().take(FEW).map(|name| text::abridged(name)).collect();
    let listed = text::list(shown.iter().map(|name| &**name));
    if names.len() > FEW { format!("{listed} and {} more", names.len() - FEW) } else { listed }
}

impl Shader for Painted {
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        if let Some(at) = at.plain {
            return Some(constants(self.at(material, at.position).reflectivity(of)));
        }
        let coarse = at.position.map(coarse);
        let slot = self.slot(DVec3::from(coarse.map(Interval::middle)));
        if self.surface.is_alone(coarse, |face| self.surface.slots[face] == slot) {
            return Some(constants(self.material(material, slot).reflectivity(of)));
        }
        let all = self.materials.iter().flatten().map(|other| &**other).chain([material]);
        all.map(|material| constants(material.reflectivity(of))).reduce(hull)
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        DVec2::new(f64::from(self.slot(at.position)), 0.0)
    }

    /// Returns the largest reflectivities of all materials, unless one has a negative diffuse colour.
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
