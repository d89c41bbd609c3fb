//! Lamps: the lights of a scene, each with the attributes that all lights share.

use crate::body::AnyLight;
use crate::packets::light::PacketLight;
use crate::rules::Fading;
use std::ops::Deref;

/// A light of a scene.
pub struct Lamp {
    /// The light itself.
    pub light: AnyLight,
    /// How its light weakens with the distance, under the free rules.
    pub fading: Fading,
}

/// Gives direct access to the light.
impl Deref for Lamp {
    type Target = dyn PacketLight;

    fn deref(&self) -> &Self::Target {
        &*self.light
    }
}
