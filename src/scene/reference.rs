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

Made from the tables of the plugins by `cargo run --release -- list --markdown > docs/language.md`; the pictures
beside it by

```sh
for scene in scenes/entities/*.ray; do
    cargo run --release -- render $scene -o docs/entities/$(basename $scene .ray).png
done
```

A scene is a text of entities, `TYPE NAME { ATTRIBUTES }`. Blanks and line ends part words, braces stand for
themselves, and a `#` that begins a word begins a comment, which ends with the line. A name is any word; one
with blanks stands in quotes, `"dark red"`, where `\"` is a quote and `\\` a backslash. Each
attribute is followed by its values, and attributes come in any order. A material or a texture stands above
what refers to it. Lengths are in world units: the screen lies in the plane z = 0, its lower left corner is the
world's origin, x goes to the right, y up and z toward the viewer. A colour is red, green and blue; 1 is as
bright as a picture can show, after the light has been divided by the distance that it travelled.

The byte of a channel is 255 times its colour, cut and not rounded; above 1 it is 255, below 0 it is 0. No transfer
function is applied. So colours are not amounts of light but what a screen is told, as in the notes: half the colour is
half the byte, 127, which a screen shows as about a fifth of white's light. A PNG says just that of its bytes (`sRGB`),
and looks like the PPM of the same scene. Of a pixel with several `samples` their colours are averaged first, and what is
above 1 is cut then, as in the notes: the edge of something far brighter than white has no smooth steps, as a single one
of its samples is enough for a white pixel.

The same scenes can be written in TOML, in files whose names end in `.toml`: `sphere ball { radius 2 }` is
`[sphere.ball]` and below it `radius = 2` there; several values stand in brackets, `center = [4, 2, -4]`, and names in
quotes, `material = "red"`. Lights that share a name are `[[light.lamp]]` each. The order of the text counts in
TOML, too. `tabray convert` turns each spelling into the other, and `tabray schema` prints a JSON Schema for editors.
"#;

const PROFILES: &str = "
A profile, of a surfer or a formula, is the distance from the axis at each height. Where it is below 0 there is nothing.
Where that is so is proven when the scene is loaded, down to heights that are neighbouring numbers, and so are bounds
by which rays find the surface: parts of any thinness are kept. What cannot be proven is refused, with the height and
the reason: a profile without a bound; one that crosses 0 or bends too often, as `sin(y)` does in a height of 1e9; and
one whose sign is lost in rounding, farther than 1/4294967296 of its largest radius from 0. Loading a profile takes
60 million operations at most, a function counted as eight: some tenths of a second.
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
    text += "\n## Procedural shaders\n\nWhat `shader` may be, by name or by number; the numbers differ on spheres.\n\n";
    text += &choices::<OnPlane>("number on planes");
    text += "\n";
    text += &choices::<OnSphere>("number on spheres");
    text += "\n## Profiles\n\nWhat `surfer` may be, by name or by number.\n\n";
    text += &choices::<&'static Profile>("number");
    text += PROFILES;
    text
}

fn entity_section(entity: &'static Entity) -> String {
    let name = entity.name;
    let also = match entity.aliases {
        [] => String::new(),
        aliases => {
            format!(", also written {}", aliases.iter().map(|alias| format!("`{alias}`")).collect::<String>())
        }
    };
    let rows: String = entity.attributes().map(attribute_row).collect();
    format!(
        "\n### {name}\n\n{}{also}. [This scene](../scenes/entities/{name}.ray):\n\n\
         ![a picture of {name}](entities/{name}.png)\n\n\
         | attribute | values | if not given | what it is |\n|---|---|---|---|\n{rows}",
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
        None => "must be given".to_owned(),
        Some(Datum::Absent) => "left out".to_owned(),
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
    format!("| {} | {number} | what it is |\n|---|---|---|\n{rows}", choices.what)
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}
