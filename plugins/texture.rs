//! A texture: an image from a file.

use tabray::prelude::*;

static FILENAME: Pparm<String> = Pparm::required(
    "filename",
    "an image, relative to the scene's folder: PNG, JPEG, WebP, TIFF, BMP, PPM, Radiance HDR or OpenEXR",
);

static CUTOUT: Pparm<bool> = Pparm::or(
    "cutout",
    "whether an `image` or a `texplane` cuts the object out where the image is less than half opaque; otherwise, the \
     object has its own colour there",
    false,
)
.not_dumped();

const TABLE: Table = &[&FILENAME, &CUTOUT];

inventory::submit! {
    Entity::texture("texture", "an image for texplanes, projectors, shaders and environments", &[TABLE], |args| {
        let path = args.setting.folder.join(args.get(&FILENAME));
        Ok(if args.get(&CUTOUT) { Texture::cutout(path) } else { Texture::new(path) })
    })
}
