//! The faces of a mesh, sorted by what is the same at all points of a material.

use super::surface::Surface;
use std::collections::BTreeSet;
use tabray_world::body::Warning;
use tabray_world::material::Material;
use tabray_world::text;

/// The maximum number of materials that differ in more than their colours.
const MAX_MATERIALS: usize = 64;

/// The slots of the faces that have the same material, but for its colours.
pub struct Sort {
    /// The material.
    pub material: Material,
    /// The slots.
    pub slots: BTreeSet<u16>,
}

/// Sorts the faces of a surface by their materials, given that of each slot. There is at least one sort.
///
/// # Errors
/// Returns a warning if there are too many materials. Then all faces have that of the mesh.
pub fn sorts(surface: &Surface, of: impl Fn(u16) -> Material) -> Result<Vec<Sort>, Warning> {
    let mut used = vec![false; surface.materials.len() + 1];
    surface.slots.iter().for_each(|slot| used[usize::from(*slot)] = true);
    used[0] |= surface.slots.is_empty();
    let mut sorts: Vec<Sort> = Vec::new();
    for slot in (0..used.len()).filter(|slot| used[*slot]).map(|slot| slot as u16) {
        let material = of(slot);
        match sorts.iter_mut().find(|sort| sort.material == material) {
            Some(sort) => drop(sort.slots.insert(slot)),
            None => sorts.push(Sort { material, slots: BTreeSet::from([slot]) }),
        }
        if sorts.len() > MAX_MATERIALS {
            return Err(Warning {
                attribute: "file",
                message: format!(
                    "ignores the shininess and transparency of its faces' materials, as more than {} differ in them",
                    text::count(MAX_MATERIALS, "material")
                ),
                help: "these are those of the mesh's own material: split the file into several meshes"
                    .to_owned(),
            });
        }
    }
    Ok(sorts)
}
