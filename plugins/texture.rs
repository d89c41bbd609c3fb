//! A texture: an image from a file.

use tabray::prelude::*;

static FILENAME: Pparm<String> =
    Pparm::required("filename", "a PPM or PNG file, relative to the scene's folder");

const TABLE: Table = &[&FILENAME];

inventory::submit! {
    Entity::texture("texture", "an image for texplanes, projectors, shaders and environments", &[TABLE], |args| {
        Ok(Texture::new(args.setting.folder.join(args.get(&FILENAME))))
    })
}
