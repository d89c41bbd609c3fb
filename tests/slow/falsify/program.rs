//! The program under test. All questions to it go through this file.

use super::tally;
use crate::common::registry;
use std::fs;
use std::path::Path;
use tabray::render::{Plan, Renderer, trace};
use tabray::scene::{self, Model};
use tabray::tools::verify::{self, Verdict};

/// A scene as the program has loaded it.
pub struct Program(Model);

/// What the program proves about its first hit of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// The hit is certainly right.
    Right,
    /// The hit is certainly wrong.
    Wrong,
    /// Neither is certain.
    Unknown,
}

/// The first hit that the program finds for a ray.
pub struct ProgramHit {
    pub first: Option<usize>,
    /// The index of the material that is hit.
    pub material: Option<usize>,
    pub distance: f64,
    /// The origin and the direction of the ray as the program rounds them.
    pub origin: [f64; 3],
    pub dir: [f64; 3],
}

impl Program {
    /// Loads a scene, unless the program refuses it. `mesh` is the text of `mesh.obj`, if the scene has one.
    pub fn read(text: &str, mesh: &str) -> Option<Self> {
        let folder = (!mesh.is_empty()).then(|| tempfile::tempdir().expect("room for a folder"));
        let path = folder.as_ref().map_or(Path::new(""), |folder| folder.path());
        if folder.is_some() {
            fs::write(path.join("mesh.obj"), mesh).expect("room for a file");
        }
        scene::read(registry(), "scene", path, text.as_bytes(), None).ok().map(|loaded| Self(loaded.model))
    }

    pub fn find(&self, [x, y]: [usize; 2]) -> ProgramHit {
        let ray = self.0.camera.value.ray(x as f64, y as f64);
        let hit = trace::first_hit(&Plan::new(&self.0), &self.0.camera.value.sight(x as f64, y as f64));
        ProgramHit {
            first: hit.as_ref().map(|hit| self.entity(hit.index)),
            material: hit.as_ref().and_then(|hit| {
                let ambient = hit.object.material.ambient.to_array();
                tally::material_of(ambient.map(|channel| if channel > 0.0 { 255 } else { 0 }))
            }),
            distance: hit.map_or(f64::INFINITY, |hit| hit.distance),
            origin: ray.origin.to_array(),
            dir: ray.dir.to_array(),
        }
    }

    /// Returns which of the seen entities an object is: a solid is seen as several.
    fn entity(&self, object: usize) -> usize {
        let name = |index: usize| self.0.objects[index].args.name();
        (1..=object).filter(|index| name(*index) != name(index - 1)).count()
    }

    pub fn claim(&self, [x, y]: [usize; 2]) -> Claim {
        match verify::pixel(&Plan::new(&self.0), x, y).verdict {
            Verdict::Proven => Claim::Right,
            Verdict::Contradicted => Claim::Wrong,
            Verdict::Tie | Verdict::Uncertified => Claim::Unknown,
        }
    }

    pub fn size(&self) -> [usize; 2] {
        self.0.camera.value.pixels
    }

    /// Renders the image with packets of rays: the red, green and blue of each pixel, from the top left, row by row.
    pub fn picture(&self, renderer: &Renderer) -> Vec<[u8; 3]> {
        renderer.picture(&Plan::new(&self.0)).chunks(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
    }
}
