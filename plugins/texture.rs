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

static COVERAGE: Pparm<bool> = Pparm::or(
    "coverage",
    "whether the alpha of the image is the fraction of what is behind the object that an `image` or a `texplane` \
     covers; the notes' rules of light cut the object out instead",
    false,
)
.not_dumped();

const TABLE: Table = &[&FILENAME, &CUTOUT, &COVERAGE];

inventory::submit! {
    Entity::texture("texture", "an image for texplanes, projectors, shaders and environments", &[TABLE], |args| {
        let path = args.setting.folder.join(args.get(&FILENAME));
        Ok(Texture::with_alpha(path, match (args.get(&CUTOUT), args.get(&COVERAGE)) {
            (false, false) => Alpha::Own,
            (true, false) => Alpha::CutsOut,
            (false, true) => Alpha::Covers,
            (true, true) => {
                return Err(Refusal {
                    attribute: Some("coverage"),
                    message: "either cuts out or covers in part, and not both".to_owned(),
                    help: "`cutout` takes half of the opacity as the limit, `coverage` the opacity as it is",
                });
            }
        }))
    })
}
