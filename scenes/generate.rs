//! Generates scenes that are too large to be kept: `cargo run --release --example generate -- shell` writes
//! `scenes/generated/shell.ray` and the files that it names.

use clap::{Parser, ValueEnum};
use glam::DVec3;
use libm::{cos, sin};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Generates a large scene.
#[derive(Parser)]
struct Args {
    /// The scene
    scene: Scene,
    /// The folder that the files are written to
    #[arg(long, default_value = "scenes/generated")]
    folder: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum Scene {
    /// A sea shell of a million triangles
    Shell,
    /// A forest of a million trees, each an instance of one mesh
    Forest,
}

fn main() -> io::Result<()> {
    let Args { scene, folder } = Args::parse();
    fs::create_dir_all(&folder)?;
    match scene {
        Scene::Shell => shell(&folder),
        Scene::Forest => forest(&folder),
    }
}

/// A surface of triangles, whose corners are indices of points.
#[derive(Default)]
struct Surface {
    points: Vec<DVec3>,
    faces: Vec<[usize; 3]>,
}

impl Surface {
    /// Adds a grid of points, and two triangles for each of its cells. `point` maps two numbers from 0 to 1 to a place;
    /// the second one goes around, so that the last cells of a row end at its first points.
    fn grid(&mut self, rows: usize, columns: usize, point: impl Fn(f64, f64) -> DVec3) {
        let first = self.points.len();
        for row in 0..=rows {
            let along = row as f64 / rows as f64;
            self.points.extend((0..columns).map(|column| point(along, column as f64 / columns as f64)));
        }
        for row in 0..rows {
            for column in 0..columns {
                let at = |row: usize, column: usize| first + row * columns + column % columns;
                let [a, b, c, d] =
                    [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
                self.faces.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    /// Writes the surface as an OBJ file.
    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        for point in &self.points {
            writeln!(out, "v {:.7} {:.7} {:.7}", point.x, point.y, point.z)?;
        }
        for [a, b, c] in self.faces.iter().map(|face| face.map(|index| index + 1)) {
            writeln!(out, "f {a} {b} {c}")?;
        }
        Ok(())
    }
}

/// Creates a file that is written in large pieces.
fn create(folder: &Path, name: &str) -> io::Result<BufWriter<File>> {
    let path = folder.join(name);
    println!("{}", path.display());
    Ok(BufWriter::new(File::create(path)?))
}

/// A tube that winds around an axis and grows with each turn (Raup, "Geometric analysis of shell coiling", 1966), with
/// ribs along it and knobs on its shoulder.
fn shell(folder: &Path) -> io::Result<()> {
    const TURNS: f64 = 7.0;
    const GROWTH: f64 = 1.75;
    let mut surface = Surface::default();
    surface.grid(1600, 320, |along, around| {
        let (turns, angle) = (TURNS * (along - 1.0), TAU * around);
        let size = libm::pow(GROWTH, turns);
        let ribs = 0.02 * cos(TAU * 30.0 * turns);
        let knobs = 0.5 + 0.5 * cos(TAU * 11.0 * turns);
        let shoulder = libm::exp(-libm::pow((angle - 0.9) / 0.33, 2.0));
        let tube = 1.0 + ribs + 0.28 * libm::pow(knobs, 3.0) * shoulder;
        let from_axis = size * (0.95 + 0.9 * tube * cos(angle));
        let height = size * (-2.3 + 1.15 * tube * sin(angle));
        let (sin, cos) = libm::sincos(TAU * turns);
        DVec3::new(from_axis * cos, height, from_axis * sin)
    });
    let mut out = create(folder, "shell.obj")?;
    surface.write(&mut out)?;
    out.flush()?;
    fs::write(folder.join("shell.ray"), SHELL)
}

const SHELL: &str = "\
# A sea shell of 1,024,000 triangles, made by `cargo run --release --example generate -- shell`.

camera eye
{
    pixeldim  640 480
    worlddim  8 6
    viewpoint 4 3.6 8
    samples   16
}

material sand  { ambient 2.2 1.9 1.4 diffuse 1.6 1.4 1.0 }
material dusk  { ambient 5 7 10 diffuse 0.6 0.7 0.9 }
material pearl { ambient 1.6 1.25 1.05 diffuse 1.9 1.5 1.2 specular 0.12 shininess 50 }

plane beach { material sand normal 0 1 0 point 0 0 0 }
plane sky   { material dusk normal 0 0 1 point 0 0 -14 }

mesh shell
{
    material    pearl
    file        shell.obj
    smooth      1
    scale       1.35 1.35 1.35
    rotation    0 -70 -62
    translation 6.9 3.55 -3
}

light sun  { location -2 11 5 emissivity 80 72 56 size 0.8 }
light sky  { location 9 7 5 emissivity 16 20 26 }
";

/// The extent of the forest along x and along z, in world units, and the z at which it begins before the image plane.
const EXTENT: [f64; 2] = [130.0, 135.0];
const NEAREST: f64 = 5.0;

/// The number of trees in each of as many rows.
const TREES: usize = 1000;

/// Returns the height of the ground.
fn ground(x: f64, z: f64) -> f64 {
    let hills = sin(0.11 * x + 0.4) * cos(0.09 * z) + 0.4 * sin(0.23 * x - 0.19 * z);
    let far = (-z / 100.0).clamp(0.0, 1.0);
    1.3 * hills + 14.0 * far * far * (0.6 + 0.4 * sin(0.06 * x - 1.0)) - 0.8
}

/// A million trees on hills: places of one mesh, which is not copied.
fn forest(folder: &Path) -> io::Result<()> {
    let mut tree = Surface::default();
    tree.grid(1, 8, |along, around| {
        let (sin, cos) = libm::sincos(TAU * around);
        DVec3::new(0.035 * cos, 0.3 * along, -0.035 * sin)
    });
    for tier in 0..5 {
        let tier = f64::from(tier);
        let (low, high, radius) = (0.15 + 0.15 * tier, 0.42 + 0.15 * tier, 0.27 - 0.045 * tier);
        tree.grid(2, 18, |along, around| {
            let (sin, cos) = libm::sincos(TAU * around + tier);
            // The tips of the branches hang down between the others.
            let tip = if ((around * 18.0).round() as usize).is_multiple_of(2) { 1.0 } else { 0.6 };
            let out = 1.0 - 0.98 * along;
            let from_axis = radius * out * (1.0 + (tip - 1.0) * out);
            let droop = 0.05 * tip * libm::pow(out, 3.0);
            DVec3::new(from_axis * cos, low + (high - low) * along - droop, -from_axis * sin)
        });
    }
    let mut out = create(folder, "tree.obj")?;
    tree.write(&mut out)?;
    out.flush()?;

    let [wide, deep] = EXTENT;
    let mut hills = Surface::default();
    let cells = 260;
    for row in 0..=cells {
        for column in 0..=cells {
            let [x, z] = [column, row].map(|at| at as f64 / cells as f64);
            let (x, z) = (4.0 + wide * (x - 0.5), NEAREST - deep * z);
            hills.points.push(DVec3::new(x, ground(x, z), z));
            if row < cells && column < cells {
                let at = row * (cells + 1) + column;
                let [a, b, c, d] = [at, at + 1, at + cells + 2, at + cells + 1];
                hills.faces.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    let mut out = create(folder, "hills.obj")?;
    hills.write(&mut out)?;
    out.flush()?;

    let mut out = create(folder, "forest.ray")?;
    out.write_all(FOREST.as_bytes())?;
    let mut random = Pcg32::seed_from_u64(1);
    let mut between =
        |low: f64, high: f64| low + (high - low) * f64::from(random.next_u32()) / f64::from(u32::MAX);
    for number in 0..TREES * TREES {
        let at = [number % TREES, number / TREES].map(|at| (at as f64 + between(0.0, 1.0)) / TREES as f64);
        let (x, z) = (4.0 + wide * (at[0] - 0.5), NEAREST - deep * at[1]);
        let (turn, scale) = (between(0.0, 360.0), between(0.7, 1.5));
        writeln!(
            out,
            "place {number} {{ object tree material needles translation {x:.3} {:.3} {z:.3} rotation 0 {turn:.0} 0 scale {scale:.2} {scale:.2} {scale:.2} }}",
            ground(x, z)
        )?;
    }
    out.flush()
}

const FOREST: &str = "\
# A forest of 1,000,000 trees, all of them places of one mesh, made by `cargo run --release --example generate -- forest`.

camera eye
{
    pixeldim  640 480
    worlddim  8 6
    viewpoint 4 5 6
    samples   16
}

material needles { ambient 0.6 1 0.7 diffuse 0.24 0.42 0.2 }
material moss    { ambient 0.4 0.5 0.2 diffuse 0.12 0.16 0.06 }
material evening { ambient 96 62 44 }

plane heaven { material evening normal 0 0 1 point 0 0 -140 }

mesh hills { material moss file hills.obj smooth 1 }
mesh tree  { material needles file tree.obj }

light sun { location -70 45 -30 emissivity 1700 1300 800 }
light sky { location 40 80 -20 emissivity 500 560 760 }

";
