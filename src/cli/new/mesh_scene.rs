//! A scene that shows a mesh: its camera, lights and floor fit the mesh, whatever its size.

use crate::files::mesh;
use crate::process::failure::Failure;
use glam::DVec3;
use std::path::{Path, PathBuf};
use tabray_core::scene::value::Datum;
use tabray_core::shapes::mesh::read::Wanted;
use tabray_core::shapes::mesh::read::staging::{Lamp, Viewer};
use tabray_core::text::{shortest, shown};
use tabray_core::world::sensor::Sensor;
use tabray_lang::dump;
use tabray_lang::reader;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// Half of the diagonal of the box around the mesh in the scene, in world units.
const HALF: f64 = 2.0;

/// From the middle of the mesh toward the viewer and toward the lamp.
const VIEWER: DVec3 = DVec3::new(0.6, 0.75, 1.0);
const LAMP: DVec3 = DVec3::new(-0.7, 1.2, 0.6);

/// The distance of the lamp from the middle of the mesh, in world units.
const FAR: f64 = 8.0;

/// The tangents of half the angles of view: 40 degrees across, and the height three quarters of the width.
const TANGENTS: [f64; 2] = [0.363_970, 0.272_978];

/// The part of the image's width or height that the mesh fills.
const FILLED: f64 = 0.8;

/// How many names of materials in a file are given colours.
const MOST_NAMES: usize = 64;

/// Returns the text of a scene in a file, which shows the mesh of another file.
pub fn text(registry: &Registry, file: &Path, scene: &Path, syntax: Syntax) -> Result<String, Failure> {
    let text = in_notes(file, scene)?;
    let folder = scene.parent().unwrap_or(scene);
    let name = shown(scene.with_extension("ray"));
    let loaded = reader::read(registry, &name, folder, text.as_bytes(), None).map_err(Failure::Scene)?;
    Ok(match syntax {
        Syntax::Notes => text,
        Syntax::Toml => dump::scene(&loaded.model, Syntax::Toml),
    })
}

fn in_notes(file: &Path, scene: &Path) -> Result<String, Failure> {
    let wanted = Wanted { normals: true, materials: Some(Sensor::default().display()) };
    let (surface, staging) = mesh::read(file, wanted)?;
    let [low, high] = surface.bounds();
    let own = [
        ("    normals     file\n", surface.is_smooth()),
        (
            "    materials   file          # anything it does not give comes from `metal`\n",
            surface.has_looks(),
        ),
    ];
    let own: String = own.iter().filter(|(_, has)| *has).map(|(line, _)| *line).collect();
    // What draws parts to be made writes STL, and has z upward; what models for pictures has y.
    let is_upright = !file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("stl"));
    let turned = |at: DVec3| if is_upright { at } else { DVec3::new(at.x, at.z, -at.y) };
    // Halves first, so that nothing overflows.
    let middle = turned(low / 2.0 + high / 2.0);
    let half = turned(high / 2.0 - low / 2.0).abs();
    let scale = rounded_to_four_digits(HALF / (half / half.max_element()).length() / half.max_element());
    let half = half * scale;
    let translation = DVec3::new(0.0, half.y, 0.0) - middle * scale;
    let target = DVec3::new(0.0, half.y, 0.0);
    let placed = |at: DVec3| scale * turned(at) + translation;
    let camera = match &staging.viewer {
        Some(viewer) => own_camera(viewer, &placed, target),
        None => include_str!("templates/mesh_camera.ray")
            .replace("@POSITION@", &point(target + distance(half) * VIEWER.normalize()))
            .replace("@TARGET@", &point(target)),
    };
    let lamps = if staging.lamps.is_empty() {
        include_str!("templates/mesh_lamps.ray")
            .replace("@LAMP_AT@", &point(target + FAR * LAMP.normalize()))
            .replace("@TARGET@", &point(target))
    } else {
        own_lamps(&staging.lamps, &placed, scale, target)
    };
    // A floor would hide what a viewer of the file's own may show below the mesh.
    let floor = if staging.viewer.is_some() { "" } else { include_str!("templates/mesh_floor.ray") };
    let scale = shortest(scale);
    let size = (high - low).to_array().map(mesh::six_digits).join(" x ");
    let words = [
        ("FILE", Syntax::Notes.values(&Datum::Word(relative(file, scene))).concat()),
        ("SIZE", size),
        ("CAMERA", camera),
        ("FLOOR", floor.to_owned()),
        ("LAMPS", lamps),
        ("SCALE", [scale.as_str(); 3].join(" ")),
        ("ROTATION", if is_upright { "0 0 0" } else { "-90 0 0" }.to_owned()),
        ("OWN", own),
        ("NAMES", if surface.has_looks() { String::new() } else { named(&surface.materials) }),
        ("UP", if is_upright { "y" } else { "z" }.to_owned()),
        ("TRANSLATION", point(translation)),
    ];
    let template = include_str!("templates/mesh.ray");
    Ok(words
        .iter()
        .fold(template.to_owned(), |text, (word, value)| text.replace(&format!("@{word}@"), value)))
}

/// Writes a material for each name in a file that does not say how it looks, in colours that can be told apart.
fn named(names: &[String]) -> String {
    let used = ["metal", "grey"];
    let names =
        names.iter().filter(|name| !name.is_empty() && !used.contains(&name.as_str())).take(MOST_NAMES);
    let text: String = names
        .enumerate()
        .map(|(index, name)| {
            let turn = |third: f64| {
                0.6 + 0.15 * libm::cos(std::f64::consts::TAU * (0.382 * index as f64 - third / 3.0))
            };
            let colour = point(DVec3::new(turn(0.0), turn(1.0), turn(2.0)));
            format!(
                "material {} {{ diffuse {colour}  specular 0.12  shininess 40 }}\n",
                Syntax::Notes.key(name)
            )
        })
        .collect();
    if text.is_empty() {
        return text;
    }
    format!("# The names of materials in the file, which does not say how they look.\n{text}\n")
}

/// Writes the viewer of a file. `placed` leads from its coordinates to those of the scene, where `middle` is the middle
/// of the mesh.
fn own_camera(viewer: &Viewer, placed: &dyn Fn(DVec3) -> DVec3, middle: DVec3) -> String {
    const WIDTH: f64 = 480.0;
    let aspect = viewer.aspect.unwrap_or(4.0 / 3.0);
    let height = (WIDTH / aspect).round().max(1.0);
    let [position, target] = {
        let position = placed(viewer.position);
        // Beside the middle of the mesh, as the direction alone tells nothing of the distance.
        let away = (middle - position).dot(viewer.forward).max(1.0);
        [position, position + away * viewer.forward]
    };
    let angle = 2.0 * libm::atan(aspect * viewer.tangent).to_degrees();
    format!(
        "# The first camera of the file.
look_at eye
{{
    pixeldim {WIDTH} {height}
    position {}
    target   {}
    up       {}
    angle    {}               # across the width of the image, in degrees
    samples  16
}}
",
        point(position),
        point(target),
        point(viewer.up.normalize_or(DVec3::Y)),
        shortest(rounded_to_four_digits(angle))
    )
}

/// Writes the lights of a file, the strongest at the middle of the mesh with an emissivity of 1.
fn own_lamps(lamps: &[Lamp], placed: &dyn Fn(DVec3) -> DVec3, scale: f64, middle: DVec3) -> String {
    // Candela over the square of metres, which are the file's units, is lux.
    let away = |lamp: &Lamp| lamp.position.map(|at| placed(at).distance(middle).max(1e-3));
    let lux = |lamp: &Lamp| lamp.light / away(lamp).map_or(1.0, |away| away * away / (scale * scale));
    let strongest = lamps.iter().map(|lamp| lux(lamp).max_element()).fold(0.0, f64::max);
    let unit = if strongest > 0.0 { strongest } else { 1.0 };
    let mut text =
        "# The lights of the file, the strongest with an emissivity of 1 at the mesh.\n".to_owned();
    for (number, lamp) in (1..).zip(lamps) {
        let emissivity = point(lux(lamp) / unit);
        let (position, forward) = (lamp.position.map(placed), lamp.forward.unwrap_or(DVec3::NEG_Y));
        text += &match (position, away(lamp)) {
            (Some(position), Some(away)) => {
                let (kind, beam) = match lamp.edge {
                    Some(edge) => {
                        let edge = shortest(rounded_to_four_digits(edge.clamp(0.01, 180.0)));
                        let axis = point(position + away * forward);
                        ("spotlight", format!("    point      {axis}\n    theta      {edge}\n"))
                    }
                    None => ("light", String::new()),
                };
                let (location, away) = (point(position), shortest(rounded_to_four_digits(away)));
                format!(
                    "{kind} lamp{number}\n{{\n    location   {location}\n    emissivity {emissivity}\n    falloff    square\n    at         {away}\n{beam}}}\n"
                )
            }
            _ => format!(
                "sun lamp{number}\n{{\n    direction  {}\n    emissivity {emissivity}\n}}\n",
                point(-forward)
            ),
        };
    }
    text
}

/// Returns how far from the middle the viewer must be to see a box with these half sides.
fn distance(half: DVec3) -> f64 {
    let toward = VIEWER.normalize();
    let right = DVec3::Y.cross(toward).normalize();
    let up = toward.cross(right);
    let corners = (0..8)
        .map(|corner| half * DVec3::from([1, 2, 4].map(|bit| if corner & bit == 0 { -1.0 } else { 1.0 })));
    let needed = corners.map(|at| {
        let across = [at.dot(right).abs() / TANGENTS[0], at.dot(up).abs() / TANGENTS[1]];
        at.dot(toward) + across[0].max(across[1]) / FILLED
    });
    needed.fold(0.0, f64::max)
}

fn rounded_to_four_digits(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
}

fn point(at: DVec3) -> String {
    at.to_array().map(|side| shortest((1e4 * side).round() / 1e4 + 0.0)).join(" ")
}

/// Returns the path of a file as a scene names it: relative to the scene's folder if it is below, and absolute otherwise.
fn relative(file: &Path, scene: &Path) -> String {
    let folder = scene.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let path = match (file.canonicalize(), folder.canonicalize()) {
        (Ok(file), Ok(folder)) => file.strip_prefix(folder).map(PathBuf::from).unwrap_or(file),
        _ => file.to_owned(),
    };
    path.display().to_string()
}
