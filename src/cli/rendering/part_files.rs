//! Finds the parts of an image, and refuses parts that do not belong together.

use crate::files::input;
use crate::process::failure::Failure;
use crate::rendering::{part, resume};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use tabray_core::files;
use tabray_core::text;
use tabray_tools::identity::Identity;
use tabray_tools::pixels::{Label, PixelFormat, Reader};

/// The maximum number of runs of missing parts that are named in a message.
const RUNS: usize = 12;

/// All parts of an image.
pub struct Parts {
    /// The label of the first.
    pub label: Label,
    /// The files of all parts, in their order.
    pub paths: Vec<PathBuf>,
}

/// The label of a part, without what all labels have in common.
struct PartFile {
    path: PathBuf,
    tiles: Range<usize>,
}

impl Parts {
    /// Finds all parts among these files, or beside the image if there are none, of those that contain what `is`
    /// wanted. Refuses files that are not whole parts of one image, but does not check the pixels.
    pub fn gather(
        image: &Path,
        files: &[PathBuf],
        is: impl Fn(PixelFormat) -> bool,
    ) -> Result<Self, Failure> {
        let paths = if files.is_empty() { beside(image)? } else { files.to_vec() };
        let (mut first, mut found): (Option<(PathBuf, Label)>, BTreeMap<usize, PartFile>) =
            (None, BTreeMap::new());
        for path in paths {
            let label = open(&path)?.label;
            if !is(label.what) {
                continue;
            }
            if let Some((other, first)) = &first {
                same((&path, &label), (other, first))?;
            }
            let (number, tiles) = (label.part[0], label.tiles());
            if let Some(other) = found.get(&number) {
                if open(&path)?.checksum().map_err(|error| Failure::cannot_read(&path, &error))?
                    != open(&other.path)?
                        .checksum()
                        .map_err(|error| Failure::cannot_read(&other.path, &error))?
                {
                    let (one, other) = (text::shown(&other.path), text::shown(path));
                    return Err(Failure::usage(format!(
                        "`{one}` and `{other}` are two versions of part {number}"
                    ))
                    .help("leave out the one that is wrong"));
                }
                continue;
            }
            found.insert(number, PartFile { path: path.clone(), tiles });
            first.get_or_insert((path, label));
        }
        let Some((_, label)) = first else {
            return Err(Failure::usage(format!("there is no part of `{}`", text::shown(image)))
                .help("`tabray render SCENE -o IMAGE --part 1/16` makes the first of 16 parts"));
        };
        let of = label.part[1];
        if found.len() < of {
            let missing: Vec<_> = (1..=of).filter(|number| !found.contains_key(number)).collect();
            let begun =
                missing.iter().find(|number| resume::beside(&part::beside(image, [**number, of])).exists());
            return Err(Failure::usage(format!(
                "`{}` lacks {} of {of}",
                text::shown(image),
                named(&missing)
            ))
            .help(match begun {
                Some(number) => format!(
                    "part {number} is begun: `tabray render --part {number}/{of} --resume` renders the rest"
                ),
                None => format!("render each with `tabray render --part {}/{of}`", missing[0]),
            }));
        }
        refuse_gaps(&found, &label, image)?;
        Ok(Self { label, paths: found.into_values().map(|part| part.path).collect() })
    }

    /// Refuses parts of an image beside this one that belong to another scene.
    pub fn refuse_other_scene(&self, other: &Self) -> Result<(), Failure> {
        let what = self.label.what;
        let like = |label: &Label| Label {
            part: self.label.part,
            what,
            identity: Identity::clone(&label.identity),
            beside: label.beside.clone(),
            made: label.made.clone(),
            ..*label
        };
        same((&other.paths[0], &like(&other.label)), (&self.paths[0], &self.label))
    }
}

/// Refuses parts, which are complete by their numbers, if their tiles are not the tiles of the image, each once.
fn refuse_gaps(found: &BTreeMap<usize, PartFile>, label: &Label, image: &Path) -> Result<(), Failure> {
    let refuse_part =
        |message| Err(Failure::usage(message).help("render the parts anew with one build of the program"));
    let mut next = 0;
    for (number, part) in found {
        if part.tiles.start != next {
            return refuse_part(format!(
                "`{}` does not begin where part {} ends",
                text::shown(&part.path),
                number - 1
            ));
        }
        next = part.tiles.end;
    }
    if next != label.grid().count() {
        let of = label.part[1];
        return refuse_part(format!("part {of} of `{}` ends before the image does", text::shown(image)));
    }
    Ok(())
}

/// Names parts by their numbers.
fn named(numbers: &[usize]) -> String {
    let mut runs: Vec<[usize; 2]> = Vec::new();
    for number in numbers {
        match runs.last_mut() {
            Some([_, last]) if *last + 1 == *number => *last = *number,
            _ => runs.push([*number; 2]),
        }
    }
    let run = |[first, last]: &[usize; 2]| match last - first {
        0 => first.to_string(),
        _ => format!("{first} to {last}"),
    };
    let shown: Vec<_> = runs.iter().take(RUNS).map(run).collect();
    let more = if runs.len() > RUNS { ", and more" } else { "" };
    let noun = if numbers.len() == 1 { "part" } else { "parts" };
    format!("{noun} {}{more}", shown.join(", "))
}

/// Refuses two parts that are not of one image.
fn same((path, label): (&Path, &Label), (other, first): (&Path, &Label)) -> Result<(), Failure> {
    let mut differences = label.identity.differences(&first.identity);
    // A texture or a file that only the first has is another scene.
    if differences.is_empty() {
        differences = first.identity.differences(&label.identity);
    }
    if differences.is_empty() && label.part[1] != first.part[1] {
        differences.push(format!("there are {} parts and not {}", label.part[1], first.part[1]));
    }
    if differences.is_empty() && (label.size, label.what) != (first.size, first.what) {
        differences.push("its format differs".to_owned());
    }
    if differences.is_empty() && label.dpi != first.dpi {
        differences.push("`--dpi` differs".to_owned());
    }
    if differences.is_empty() && label.beside != first.beside {
        differences.push("it has other images beside it".to_owned());
    }
    if differences.is_empty() {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "`{}` is not a part of the same image as `{}`: {}",
        text::shown(path),
        text::shown(other),
        differences.join(", ")
    ))
    .help("name the parts that belong together: `tabray merge IMAGE PARTS`"))
}

/// Opens a part, which must be whole.
pub fn open(path: &Path) -> Result<Reader, Failure> {
    let whole = |reader: Reader| match reader.done.is_whole() {
        true => Ok(reader),
        false => Err(io::Error::new(io::ErrorKind::InvalidData, "it is a checkpoint of an unfinished part")),
    };
    let opened = files::open(path).and_then(Reader::open).and_then(whole);
    opened.map_err(|error| match error.kind() {
        io::ErrorKind::Unsupported => Failure::usage(format!("cannot read `{}`: {error}", text::shown(path)))
            .help("render the parts again"),
        _ => Failure::cannot_read(path, &error),
    })
}

/// Lists the parts beside an image, by their names.
fn beside(image: &Path) -> Result<Vec<PathBuf>, Failure> {
    if input::is_standard(image) {
        return Err(Failure::usage("standard output has no parts beside it").help("name the parts"));
    }
    let folder = image.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let name = image.file_name().unwrap_or_default().to_string_lossy().into_owned() + ".part-";
    let is_part = |file: &str| {
        let numbers = file.strip_prefix(&name).and_then(|rest| rest.split_once("-of-"));
        numbers.is_some_and(|(number, of)| number.parse::<usize>().is_ok() && of.parse::<usize>().is_ok())
    };
    let cannot = |error: io::Error| Failure::cannot_read(folder, &error);
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(cannot)? {
        let file = entry.map_err(cannot)?.file_name();
        if is_part(&file.to_string_lossy()) {
            paths.push(image.with_file_name(file));
        }
    }
    paths.sort();
    Ok(paths)
}
