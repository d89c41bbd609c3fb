//! Material files of OBJ.

use super::blocks::{self, Words, words};
use super::finish::{Factor, Finish, Map, Opacity};
use super::model::{MemoryBudget, Model, Remark};
use super::textures::{Textures, first_of};
use glam::{DMat2, DVec2, DVec3};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;
use std::path::Path;
use std::sync::Arc;
use tabray_world::files::{self, held::SceneFile};
use tabray_world::material::Rgb;
use tabray_world::text;
use tabray_world::texture::{CUTOFF, Texture};

/// The maximum length of a material file, in bytes.
const LONGEST: u64 = 1 << 26;

/// The keywords of a material that are used, or that do not affect its appearance here: ambient light is the scene's.
const KNOWN: [&str; 23] = [
    "newmtl",
    "illum",
    "Ka",
    "Kd",
    "Ks",
    "Ke",
    "Ns",
    "Ni",
    "d",
    "Tr",
    "Pr",
    "Pm",
    "map_Ka",
    "map_Kd",
    "map_Ke",
    "map_d",
    "map_Pr",
    "map_Pm",
    "map_Bump",
    "map_bump",
    "bump",
    "norm",
    "sharpness",
];

/// The contents of material files.
#[derive(Default)]
struct Found {
    finishes: BTreeMap<String, Finish>,
    /// The keywords that are not rendered.
    unseen: BTreeSet<String>,
    /// The places of errors.
    wrong: Vec<String>,
    /// Whether surfaces may cover a part of what is behind them.
    covers_in_part: bool,
}

/// Reads the material files that an OBJ names in the given lines, and sets the appearances of the model's materials.
pub fn furnish(model: &mut Model, libraries: &[(Vec<u8>, usize)], folder: &Path, budget: &MemoryBudget) {
    let mut found = Found { covers_in_part: budget.wanted.covers_in_part(), ..Found::default() };
    let (mut textures, mut missing) = (Textures::new(folder, budget), Vec::new());
    for (names, line) in libraries {
        for name in named(names, folder) {
            // A file that is not at its path is looked for beside the model.
            let (whole, beside) =
                (folder.join(&name), folder.join(Path::new(&name).file_name().unwrap_or_default()));
            let path = if !files::is_file(&whole) && files::is_file(&beside) { beside } else { whole };
            model.files.push(path.clone());
            match text_of(&path) {
                Ok(bytes) => {
                    textures.folder = path.parent().unwrap_or(folder).to_owned();
                    found.read(&bytes, &name, &mut textures);
                }
                Err(reason) => missing.push(format!("`{}` (line {line}: {reason})", text::abridged(&name))),
            }
        }
    }
    let unknown: Vec<_> = model.materials.iter().filter(|name| !found.finishes.contains_key(*name)).collect();
    let unknown: Vec<_> = unknown.iter().map(|name| format!("`{}`", text::abridged(name))).collect();
    model.finishes = model.materials.iter().map(|name| found.finishes.get(name).cloned()).collect();
    let mut tell = |all: &[String], what: &str, help| {
        if !all.is_empty() {
            model.remarks.push(Remark { message: format!("{what}: {}", first_of(all)), help });
        }
    };
    tell(&missing, "names material files that cannot be read", "their materials are that of the mesh");
    if missing.is_empty() {
        tell(
            &unknown,
            "names materials that its material files do not have",
            "their faces have the material of the mesh",
        );
    }
    tell(&found.wrong, "has material files with lines that are not understood", "these lines are left out");
    let unseen: Vec<_> = found.unseen.into_iter().collect();
    tell(&unseen, "has materials with properties that are not shown", "the rest of the materials is shown");
    textures.finish(model);
}

/// The maximum number of words in a name with blanks.
const MAX_WORDS: usize = 16;

/// Returns the names that follow `mtllib`. Several words form one name if a file with that name exists.
fn named(names: &[u8], folder: &Path) -> Vec<String> {
    let words = words(names)
        .take_while(|word| *word != b"#")
        .map(|word| String::from_utf8_lossy(word).replace('\\', "/"));
    let words: Vec<_> = words.collect();
    let (mut rest, mut found) = (&words[..], Vec::new());
    while !rest.is_empty() {
        let joined = (2..=rest.len().min(MAX_WORDS)).rev().map(|count| (count, rest[..count].join(" ")));
        let (count, name) = joined
            .into_iter()
            .find(|(_, name)| files::is_file(&folder.join(name)))
            .unwrap_or((1, rest[0].clone()));
        rest = &rest[count..];
        found.push(name);
    }
    found
}

fn text_of(path: &Path) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let file = SceneFile::open(path);
    let read = file.and_then(|file| file.take(LONGEST + 1).read_to_end(&mut bytes));
    match read {
        Ok(_) if bytes.len() as u64 > LONGEST => Err("it is longer than 64 MiB".to_owned()),
        Ok(_) => {
            blocks::end_lines(&mut bytes);
            Ok(bytes)
        }
        Err(error) => Err(match text::nearest_file(path) {
            Some(near) if !path.exists() => format!("it does not exist, but `{near}` does"),
            _ => text::reason(&error),
        }),
    }
}

/// The properties of a material as written. Their meaning depends on each other.
#[derive(Default)]
struct Raw {
    finish: Finish,
    /// The opacity that `d` gives, and the transparency that `Tr` gives.
    opacity: Option<f64>,
    transparency: Option<f64>,
    /// The image of the opacity.
    opacities: Option<Map>,
    illumination: f64,
    mirror: Option<Rgb>,
    shininess: f64,
    roughness: Option<f64>,
    metal: f64,
    /// The images of the roughness and of the metal, which replace the numbers.
    roughnesses: Option<Map>,
    metals: Option<Map>,
    has_index: bool,
}

impl Found {
    /// Reads the text of a material file with this name.
    fn read(&mut self, bytes: &[u8], file: &str, textures: &mut Textures) {
        let mut current: Option<(String, Raw)> = None;
        // A colour may be one number, but where the last line has no end, two may be missing.
        let is_cut = |keyword: &str, line: &[u8], words: &Words| {
            let is_last = line.as_ptr_range().end == bytes.as_ptr_range().end;
            let is_colour = matches!(keyword, "Ka" | "Kd" | "Ks" | "Ke");
            let is_number = is_colour || matches!(keyword, "d" | "Tr" | "Ni" | "Ns" | "Pr" | "Pm" | "illum");
            is_last
                && (is_number && blocks::ends_within_number(line) || is_colour && words.clone().count() == 1)
        };
        for (index, line) in blocks::lines(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)).enumerate() {
            let mut words = words(line);
            let Some(keyword) = words.next().and_then(|word| str::from_utf8(word).ok()) else { continue };
            if keyword.starts_with('#') {
                continue;
            }
            let place = format!("line {} of `{}`", index + 1, text::abridged(file));
            if keyword == "newmtl" {
                self.add(current.take());
                current = Some((material(line), Raw::default()));
            } else if let Some((_, raw)) = &mut current {
                if !KNOWN.contains(&keyword) {
                    // Other words may be names from other programs.
                    self.unseen.insert(text::abridged(keyword).into_owned());
                } else if is_cut(keyword, line, &words)
                    || raw.read(keyword, words, &place, textures, &mut self.unseen).is_none()
                {
                    self.wrong.push(place);
                }
            }
        }
        self.add(current);
    }

    /// Adds a material. Of several with the same name, the first counts.
    fn add(&mut self, material: Option<(String, Raw)>) {
        let Some((name, raw)) = material else { return };
        let finish = raw.finish(self.covers_in_part, &mut self.unseen);
        self.finishes.entry(name).or_insert(finish);
    }
}

impl Raw {
    /// Reads the values of a keyword, or returns `None` if they make no sense.
    fn read(
        &mut self,
        keyword: &str,
        mut words: Words,
        place: &str,
        textures: &mut Textures,
        unseen: &mut BTreeSet<String>,
    ) -> Option<()> {
        let finish = &mut self.finish;
        match keyword {
            "Kd" => finish.colour = colour(words)?,
            "Ks" => self.mirror = Some(colour(words)?),
            "Ke" => finish.emission = colour(words)?,
            "Ns" => self.shininess = number(&mut words)?.clamp(0.0, 1e6),
            "Ni" => self.has_index = number(&mut words)? != 1.0,
            "illum" => self.illumination = number(&mut words)?,
            "Pr" => self.roughness = Some(number(&mut words)?),
            "Pm" => self.metal = number(&mut words)?,
            "d" => {
                if words.clone().next() == Some(b"-halo") {
                    words.next();
                }
                self.opacity = Some(number(&mut words)?.clamp(0.0, 1.0));
            }
            "Tr" => self.transparency = Some(number(&mut words)?.clamp(0.0, 1.0)),
            "map_Kd" => finish.colours = map(words, place, textures)?.map(|(map, _)| map),
            "map_Ke" => finish.emissions = map(words, place, textures)?.map(|(map, _)| map),
            "map_d" => self.opacities = map(words, place, textures)?.map(|(map, _)| map),
            "map_Pr" => self.roughnesses = map(words, place, textures)?.map(|(map, _)| map),
            "map_Pm" => self.metals = map(words, place, textures)?.map(|(map, _)| map),
            "map_Bump" | "map_bump" | "bump" | "norm" => {
                let bumps = map(words, place, textures)?;
                // Programs also write normal maps where the format expects heights.
                if bumps.as_ref().is_some_and(|(map, _)| keyword != "norm" && !has_normals(&map.texture)) {
                    unseen.insert(format!("{keyword} (an image of heights)"));
                } else {
                    finish.normals = bumps;
                }
            }
            _ => {}
        }
        Some(())
    }

    /// Returns the appearance of the material, and adds properties that are not rendered to `unseen`.
    fn finish(self, covers_in_part: bool, unseen: &mut BTreeSet<String>) -> Finish {
        let Self { mut finish, opacity, transparency, illumination, mirror, shininess, .. } = self;
        let Self { roughness, roughnesses, metal, metals, has_index, opacities, .. } = self;
        if finish.colours.is_some() && finish.colour == Rgb::ZERO {
            // Some programs write black if an image gives the colours.
            finish.colour = Rgb::ONE;
        }
        if finish.emissions.is_some() && finish.emission == Rgb::ZERO {
            finish.emission = Rgb::ONE;
        }
        // Some programs write 0 beside an image.
        let factor = |number: f64, map: Option<Map>| {
            map.map_or_else(|| number.into(), |map| Factor::of_image(1.0, map, 0))
        };
        finish.metal = factor(metal, metals);
        finish.roughness = factor(roughness.unwrap_or(1.0), roughnesses);
        let mut hide = |is_hidden: bool, word: &str| {
            if is_hidden {
                unseen.insert(word.to_owned());
            }
        };
        match mirror {
            // Illumination models from 3 on have mirror images.
            Some(mirror) if illumination >= 3.0 => (finish.specular, finish.shininess) = (mirror, shininess),
            Some(mirror) if shininess > 0.0 => (finish.highlight, finish.shininess) = (mirror, shininess),
            _ => {}
        }
        let passed = opacity.map_or(transparency.unwrap_or(0.0), |opacity| 1.0 - opacity);
        // 3ds Max writes 1 for both of an opaque material.
        let is_other = |transparency: f64| (transparency - passed).abs() > 1e-3;
        hide(transparency.is_some_and(is_other), "Tr (`d` says otherwise)");
        hide(has_index && passed > 0.0, "Ni");
        finish.opacity = match covers_in_part {
            true => Opacity::new(opacities, 1.0 - passed, None),
            false => {
                // The notes' rules know no coverage, but glass.
                finish.transparency = passed;
                opacities.and_then(|map| Opacity::new(Some(map), 1.0, Some(CUTOFF)))
            }
        };
        finish
    }
}

fn number(words: &mut Words) -> Option<f64> {
    let number: f64 = str::from_utf8(words.next()?).ok()?.parse().ok()?;
    number.is_finite().then_some(number)
}

/// Reads a colour of three numbers, or one number for all channels.
fn colour(mut words: Words) -> Option<Rgb> {
    let red = number(&mut words)?;
    let colour = match words.clone().next() {
        None => Rgb::splat(red),
        Some(_) => Rgb::new(red, number(&mut words)?, number(&mut words)?),
    };
    Some(colour.clamp(Rgb::ZERO, Rgb::splat(1e6)))
}

/// Reads the options and the name of an image, and the factor of its bumps. Returns `None` without a name, and
/// `Some(None)` for an image that cannot be read.
fn map(mut words: Words, place: &str, textures: &mut Textures) -> Option<Option<(Map, f64)>> {
    let (mut scale, mut offset, mut bumps) = (DVec2::ONE, DVec2::ZERO, 1.0);
    loop {
        let mut ahead = words.clone();
        let option = ahead.next()?;
        let pair = |words: &mut Words, or: DVec2| {
            let first = number(words)?;
            let mut rest = [None; 2];
            for part in &mut rest {
                let mut next = words.clone();
                *part = number(&mut next).filter(|_| next.clone().next().is_some());
                *words = if part.is_some() { next } else { break };
            }
            Some(DVec2::new(first, rest[0].unwrap_or(or.y)))
        };
        match option {
            b"-s" => scale = pair(&mut ahead, DVec2::ONE)?,
            b"-o" => offset = pair(&mut ahead, DVec2::ZERO)?,
            b"-t" => _ = pair(&mut ahead, DVec2::ZERO)?,
            b"-bm" => bumps = number(&mut ahead)?,
            b"-mm" => _ = (number(&mut ahead)?, number(&mut ahead)?),
            b"-blendu" | b"-blendv" | b"-boost" | b"-texres" | b"-clamp" | b"-imfchan" | b"-type"
            | b"-cc" | b"-colorspace" => {
                ahead.next()?;
            }
            _ => break,
        }
        words = ahead;
    }
    // A name may contain blanks and a `#`. A `#` between blanks begins a comment.
    let mut after = blocks::words(words.rest);
    let is_comment = after.find(|word| *word == b"#").is_some();
    let end = if is_comment { words.rest.len() - after.rest.len() - 1 } else { words.rest.len() };
    let name = String::from_utf8_lossy(words.rest[..end].trim_ascii());
    let texture = textures.named(&name, place);
    let matrix = DMat2::from_diagonal(scale);
    Some(texture.map(|texture| (Map { matrix, offset, ..Map::new(texture) }, bumps)))
}

/// Tells whether an image holds normals: nearly unit vectors, which point out of the surface on average.
fn has_normals(texture: &Arc<Texture>) -> bool {
    let [width, height] = texture.size();
    let texels = (0..height).flat_map(|row| (0..width).map(move |column| [column, row]));
    let (mut sum, mut off) = (DVec3::ZERO, 0.0);
    for [column, row] in texels {
        let normal = 2.0 * texture.numbers(column, row) - 1.0;
        sum += normal;
        off += (normal.length() - 1.0).abs();
    }
    let count = f64::from(width) * f64::from(height);
    off < 0.2 * count && sum.z > 0.5 * count && sum.truncate().abs().max_element() < 0.3 * count
}

/// Returns the name that follows `usemtl` or `newmtl`. The name may contain a `#`, as in `Material #25`. A `#` between
/// blanks begins a comment.
pub(super) fn material(line: &[u8]) -> String {
    let name = words(line).skip(1).take_while(|word| *word != b"#");
    name.map(String::from_utf8_lossy).collect::<Vec<_>>().join(" ")
}
