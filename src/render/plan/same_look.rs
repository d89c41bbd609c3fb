//! Which objects look the same: rays that hit them can be shaded together.

use std::collections::HashMap;
use std::sync::Arc;
use tabray_world::accuracy::Accuracy;
use tabray_world::material::Rgb;
use tabray_world::scene::model::{Model, Object};

/// The maximum number of looks that are told apart. It saves memory in scenes in which each object has its own look.
const MAX_LOOKS: usize = 256;

/// What objects look like: their material and their shader, by where these are in memory.
type Look = (usize, usize);

/// For each object, the first one that looks the same.
pub(crate) struct SameLook {
    first: Vec<u32>,
}

impl SameLook {
    /// Finds the objects that look the same: of one material and one shader, on which all points reflect the same
    /// light, and none of it as a mirror. `None` where there are none.
    pub fn of(model: &Model) -> Option<Self> {
        if model.camera.value.accuracy == Accuracy::Classic {
            return None;
        }
        let (mut looks, mut last) = (HashMap::<Look, Option<u32>>::new(), None);
        let mut any = false;
        let first = model.objects.iter().zip(0..).map(|(object, index)| {
            let look: Look =
                (Arc::as_ptr(&object.material) as usize, Arc::as_ptr(&object.shader).cast::<()>() as usize);
            let known = match last {
                Some((known, first)) if known == look => first,
                _ if looks.len() >= MAX_LOOKS && !looks.contains_key(&look) => None,
                _ => *looks.entry(look).or_insert_with(|| is_plain(object).then_some(index)),
            };
            last = Some((look, known));
            let first = known.filter(|_| !object.shape.is_smooth()).unwrap_or(index);
            any |= first != index;
            first
        });
        let first = first.collect();
        any.then_some(Self { first })
    }

    /// Returns the first object that looks like the given one, as indices plus 1; 0 stands for none.
    #[inline]
    pub fn look_up(&self, id: u64) -> u64 {
        match (id as usize).checked_sub(1) {
            Some(index) => u64::from(self.first[index]) + 1,
            None => 0,
        }
    }
}

/// Tells whether all points of an object reflect the same light, and none of it as a mirror.
fn is_plain(Object { material, shader, .. }: &Object) -> bool {
    let sees = shader.sees();
    material.transparency == 0.0
        && !shader.covers_in_part()
        && material.interface.is_none()
        && material.medium().is_none()
        && material.roughness() == 0.0
        && !material.glints()
        && sees.is_position()
        && !sees.patch
        && !shader.bends()
        && shader.uniform(material).is_some_and(|look| look.specular == Rgb::ZERO)
}
