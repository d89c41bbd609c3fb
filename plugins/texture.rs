//! A texture: a picture from a file.

use crate::prelude::*;

static FILENAME: Pparm<String> =
    Pparm::required("filename", "the file of the picture, a PPM or PNG, from the scene's folder");

const TABLE: Table = &[&FILENAME];

inventory::submit! {
    Entity::texture("texture", "a picture for texplanes and projectors", &[TABLE], |args| {
        Ok(Texture::new(args.setting.folder.join(args.get(&FILENAME))))
    })
}
