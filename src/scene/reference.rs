//! The reference of the scene language, written from the tables: `docs/language.md`.

use crate::scene::choice::{Choice, ChoiceName};
use crate::scene::entity::Entity;
use crate::scene::kind::Kind;
use crate::scene::pparm::Attribute;
use crate::scene::procedural::{OnPlane, OnSphere};
use crate::scene::profile::Profile;
use crate::scene::registry::Registry;
use crate::scene::value::{Datum, Type, Value};

const INTRODUCTION: &str = r#"# The scene language

This page is generated from the tables of the plugins by `cargo run --release -- list --markdown > docs/language.md`,
and its images by

```sh
for scene in scenes/entities/*.ray; do
    cargo run --release -- render $scene -o docs/entities/$(basename $scene .ray).png
done
```

A scene is a sequence of entities, `TYPE NAME { ATTRIBUTES }`. Words are separated by white space and by braces; a `#` at
the beginning of a word starts a comment, which ends with the line. A name is any word; one that contains white space
goes in quotes, `"dark red"`, in which `\"` is a quote and `\\` a backslash. Each attribute is followed by its values, and
attributes may come in any order. A material or a texture must be defined before it is used. Lengths are in world units:
the image plane is z = 0, the lower left corner of the image is the world's origin, x points right, y up and z toward the
viewer. A colour is red, green and blue; 1 is the brightest that an image can show, after the light has been divided by
the distance that it travelled.

The byte of a channel is 255 times its colour, truncated rather than rounded; above 1 it is 255, below 0 it is 0. No
transfer function is applied. Colours are therefore not amounts of light but the values sent to a display, as in the
notes: half the colour is half the byte, 127, which a display shows as about a fifth of the light of white. A PNG
declares its bytes accordingly (`sRGB`), and looks like the PPM of the same scene. In a pixel with several `samples`,
their colours are averaged first and clamped to 1 afterwards, as in the notes: the edge of something far brighter than
white is not smooth, since one bright sample is enough for a white pixel.

The same scenes can be written in TOML, in files whose names end in `.toml`: `sphere ball { radius 2 }` becomes the table
`[sphere.ball]` with `radius = 2` below it; several values go in brackets, `center = [4, 2, -4]`, and names in quotes,
`material = "red"`. Lights that share a name are written `[[light.lamp]]` each. The order of the file matters in TOML,
too. `tabray convert` converts either syntax to the other, and `tabray schema` prints a JSON Schema for editors.
"#;

const PROFILES: &str = "
A profile, whether a surfer or a formula, is the distance from the axis at each height. Where it is below 0 there is no
surface. When the scene is loaded, tabray proves where that is, down to heights that are neighbouring f64 numbers, and
derives bounds by which rays find the surface, so that no part is too thin to be kept. A profile for which the proof
fails is refused, with the height and the reason: one that is unbounded; one that crosses 0 or bends too often, as
`sin(y)` does over a height of 1e9; and one whose sign rounding leaves open by more than 1/4294967296 of its largest
radius. Loading a profile takes at most 60 million operations, where a function counts as eight: some tenths of a second.
";

/// The reference as Markdown. Pictures are named `entities/TYPE.png`, scenes `../scenes/entities/TYPE.ray`.
pub fn markdown(registry: &Registry) -> String {
    let mut text = INTRODUCTION.to_owned();
    for (kind, title) in [
        (Kind::Camera, "The camera"),
        (Kind::Material, "Materials"),
        (Kind::Texture, "Textures"),
        (Kind::Light, "Lights"),
        (Kind::Object, "Objects"),
    ] {
        text += &format!("\n## {title}\n");
        text.extend(registry.iter().filter(|entity| entity.kind() == kind).map(entity_section));
    }
    text += "\n## Procedural shaders\n\nThe values of `shader`, by name or by number; the numbers differ on spheres.\n\n";
    text += &choices::<OnPlane>("number on planes");
    text += "\n";
    text += &choices::<OnSphere>("number on spheres");
    text += "\n## Profiles\n\nThe values of `surfer`, by name or by number.\n\n";
    text += &choices::<&'static Profile>("number");
    text += PROFILES;
    text
}

fn entity_section(entity: &'static Entity) -> String {
    let name = entity.name;
    let also = match entity.aliases {
        [] => String::new(),
        aliases => {
            format!("; alias {}", aliases.iter().map(|alias| format!("`{alias}`")).collect::<String>())
        }
    };
    let rows: String = entity.attributes().map(attribute_row).collect();
    format!(
        "\n### {name}\n\n{}{also}. [This scene](../scenes/entities/{name}.ray):\n\n\
         ![an image of {name}](entities/{name}.png)\n\n\
         | attribute | values | default | meaning |\n|---|---|---|---|\n{rows}",
        capital(entity.meaning)
    )
}

fn attribute_row(attribute: &'static dyn Attribute) -> String {
    let names = [attribute.name()]
        .iter()
        .chain(attribute.aliases())
        .map(|name| format!("`{name}`"))
        .collect::<Vec<_>>();
    let default = match attribute.default() {
        None => "required".to_owned(),
        Some(Datum::Absent) => "none".to_owned(),
        Some(datum) => format!("`{datum}`"),
    };
    let mut meaning = attribute.meaning().to_owned();
    if !attribute.unit().is_empty() {
        meaning += &format!(", in {}", attribute.unit());
    }
    if !attribute.rule().is_empty() {
        meaning += &format!("; must be {}", attribute.rule());
    }
    format!("| {} | {} | {default} | {meaning} |\n", names.join(", "), attribute.takes())
}

fn choices<T: Choice + Value>(number: &str) -> String {
    let Type::Choice(choices) = T::TYPE else { return String::new() };
    let row = |ChoiceName { name, number, meaning, .. }: ChoiceName| {
        let number = number.map_or("".to_owned(), |number| number.to_string());
        format!("| `{name}` | {number} | {meaning} |\n")
    };
    let rows: String = choices.all().into_iter().map(row).collect();
    format!("| {} | {number} | meaning |\n|---|---|---|\n{rows}", choices.what)
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}
