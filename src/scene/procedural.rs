//! Procedural shaders: surface looks that vary from point to point by a rule (the notes' `pplane`).

use crate::scene::choice::{Choice, ChoiceName};
use crate::world::any_shape::AnyShape;
use crate::world::body::{AnyShader, Body};
use glam::DVec3;
use std::panic::Location;

/// A rule for the look of a surface, which a scene chooses by name or by number. A plugin registers one with
/// `inventory::submit!`.
pub struct ProceduralShader {
    name: &'static str,
    meaning: &'static str,
    on_plane: Option<i64>,
    on_sphere: Option<i64>,
    /// Makes the shader of one object.
    pub make: fn(Anchor) -> AnyShader,
    place: &'static Location<'static>,
}

inventory::collect!(ProceduralShader);

/// The origin and the unit of length of a procedural shader's pattern.
#[derive(Clone, Copy, Debug)]
pub struct Anchor {
    /// The point of the plane or the centre of the sphere, in world units.
    pub origin: DVec3,
    /// The length that counts as 1, in world units: 1 on a plane, the diameter of a sphere.
    pub unit: f64,
}

impl ProceduralShader {
    /// Describes a procedural shader that has a name and no number.
    #[track_caller]
    pub const fn new(name: &'static str, meaning: &'static str, make: fn(Anchor) -> AnyShader) -> Self {
        Self { name, meaning, on_plane: None, on_sphere: None, make, place: Location::caller() }
    }

    /// Sets the number that the notes give the shader on planes.
    pub const fn on_plane(mut self, number: i64) -> Self {
        self.on_plane = Some(number);
        self
    }

    /// Sets the number that the notes give the shader on spheres.
    pub const fn on_sphere(mut self, number: i64) -> Self {
        self.on_sphere = Some(number);
        self
    }

    fn option(&self, number: Option<i64>) -> ChoiceName {
        ChoiceName { name: self.name, number, meaning: self.meaning, place: self.place }
    }
}

impl Body {
    /// Makes an object with the look of a procedural shader.
    pub fn procedural(shape: impl Into<AnyShape>, shader: &ProceduralShader, anchor: Anchor) -> Self {
        Self { shader: (shader.make)(anchor), ..Self::plain(shape) }
    }
}

/// A procedural shader, chosen by its name or by its number on planes.
#[derive(Clone, Copy)]
pub struct OnPlane(pub &'static ProceduralShader);

/// A procedural shader, chosen by its name or by its number on spheres.
#[derive(Clone, Copy)]
pub struct OnSphere(pub &'static ProceduralShader);

impl Choice for OnPlane {
    const WHAT: &'static str = "shader";

    fn all() -> Vec<Self> {
        inventory::iter::<ProceduralShader>().map(Self).collect()
    }

    fn option(&self) -> ChoiceName {
        self.0.option(self.0.on_plane)
    }
}

impl Choice for OnSphere {
    const WHAT: &'static str = "shader";

    fn all() -> Vec<Self> {
        inventory::iter::<ProceduralShader>().map(Self).collect()
    }

    fn option(&self) -> ChoiceName {
        self.0.option(self.0.on_sphere)
    }
}
