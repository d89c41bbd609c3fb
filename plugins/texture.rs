//! A texture: an image from a file.

use tabray::prelude::*;

static FILENAME: Pparm<String> = Pparm::required(
    "filename",
    "an image, relative to the scene's folder: PNG, JPEG, WebP, TIFF, BMP, PPM, Radiance HDR or OpenEXR",
);

const TABLE: Table = &[&FILENAME];

inventory::submit! {
    Entity::texture("texture", "an image for texplanes, projectors, shaders and environments", &[TABLE], |args| {
        Ok(Texture::new(args.setting.folder.join(args.get(&FILENAME))))
    })
}
