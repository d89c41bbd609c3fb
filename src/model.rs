//! A scene ready to be traced. It does not change while a picture is made.

use crate::entity::Args;
use crate::geometry::{Hittable, Light, Ray, Rgb, Shader};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// All that a picture is made from.
pub struct Model {
    /// The viewer and the screen.
    pub camera: Item<Camera>,
    /// The materials, in the order of the scene.
    pub materials: Vec<Item<Arc<Material>>>,
    /// The visible objects, in the order of the scene.
    pub objects: Vec<Object>,
    /// The lights, in the order of the scene.
    pub lights: Vec<Item<Box<dyn Light>>>,
}

/// An entity of a scene: its attributes as given, and what its constructor made of them.
pub struct Item<T> {
    /// Type, name and values.
    pub args: Args,
    /// The thing itself.
    pub value: T,
}

/// A visible object.
pub struct Object {
    /// Type, name and values.
    pub args: Args,
    /// What it is made of.
    pub material: Arc<Material>,
    /// Where it is.
    pub shape: Box<dyn Hittable>,
    /// What it looks like.
    pub shader: Box<dyn Shader>,
}

impl Object {
    /// How much it tints light of each channel that passes through: transparency times the diffuse colour,
    /// its strongest channel being 1. Glass without a diffuse colour is grey.
    pub fn tint(&self, at: DVec3) -> Rgb {
        let diffuse = self.shader.diffuse(&self.material, at);
        let strongest = diffuse.max_element();
        let colour = if strongest > 0.0 { diffuse / strongest } else { DVec3::ONE };
        self.material.transparency * colour
    }
}

/// The viewer and a screen in the plane z = 0, whose lower left corner is the world's origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The picture's width and height in pixels.
    pub pixels: [usize; 2],
    /// The screen's width and height in world units.
    pub screen: DVec2,
    /// Where the viewer is, in front of the screen (z > 0).
    pub viewpoint: DVec3,
}

impl Camera {
    /// The ray from the viewpoint through a pixel. `x` counts from the left and `y` from the bottom; the
    /// outermost pixels lie on the edges of the screen.
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let [width, height] = self.pixels;
        let on_screen =
            DVec3::new(fraction(x, width) * self.screen.x, fraction(y, height) * self.screen.y, 0.0);
        Ray { origin: self.viewpoint, dir: (on_screen - self.viewpoint).normalize() }
    }
}

/// How far across a row of pixels one of them is; a single pixel looks through the middle.
fn fraction(at: f64, pixels: usize) -> f64 {
    if pixels > 1 { at / (pixels - 1) as f64 } else { 0.5 }
}

/// How a surface answers light, per channel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// The part of light from nowhere in particular that it reflects.
    pub ambient: Rgb,
    /// The part of light from the scene's lights that it scatters evenly.
    pub diffuse: Rgb,
    /// The part of light that it reflects as a mirror does.
    pub specular: Rgb,
    /// The sharpness of the glint that a light leaves on it; 0 for none.
    pub shininess: f64,
    /// The part of light that passes through it, from 0 to 1.
    pub transparency: f64,
}
