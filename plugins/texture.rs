//! A texture: a picture from a file.

use crate::entity::Entity;
use crate::pparm::{Pparm, Table};
use crate::texture::Texture;

static FILENAME: Pparm<String> =
    Pparm::required("filename", "a PPM or PNG file, relative to the scene's folder");

const TABLE: Table = &[&FILENAME];

inventory::submit! {
    Entity::texture("texture", "an image for texplanes and projectors", &[TABLE], |args| {
        Ok(Texture::new(args.setting.folder.join(args.get(&FILENAME))))
    })
}
