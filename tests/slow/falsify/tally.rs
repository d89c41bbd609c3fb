//! The results of each class: counts of hits and proofs, and of what is wrong with them.

use super::classes::Class;
use super::program::{Claim, Program, ProgramHit};
use super::scenes::Question;
use crate::oracle::dyadic::Dyadic;
use crate::oracle::first::{self as oracle, Truth};
use crate::oracle::number::Number;
use crate::oracle::ray::Ray;
use crate::oracle::text::Scene;
use crate::oracle::wide::Wide;
use std::env;
use std::fs;
use std::path::Path;
use std::time::Duration;
use tabray::render::Renderer;

/// The head of the table.
pub const HEADING: &str = "\
| sound | class | rays | wrong hits | wrong distances | rays rounded | ties | ties lost | proofs | wrong proofs | undecided | packets differ | \
largest error (ulp) | off the surface (ulp) | refused | seconds |
|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|";

/// The deviation from the surface above which a hit counts as a hit of another point, in units in the last place of its
/// distance or of the eye's largest coordinate. A rounding error is a few of these units.
const OFF: f64 = 1000.0;

/// Counts, the largest errors, and scenes with faults.
#[derive(Default)]
pub struct Tally {
    rays: usize,
    /// Rays that find an object, or none, where neither the exact ray nor the rounded one does.
    wrong: usize,
    /// Hits of the right object that are far from its first intersection with either ray.
    late: usize,
    /// Rays whose result is right for the rounded ray only.
    rounded: usize,
    /// Rays that touch something exactly, or meet several objects at the same distance.
    ties: usize,
    /// Rays that meet several objects at the same distance, and show an object other than the first in the scene.
    lost: usize,
    /// Rays that were asked for their proof.
    proofs: usize,
    wrong_proofs: usize,
    /// Rays for which the program has no proof, although the oracle knows the answer.
    undecided: usize,
    /// Pixels of images that show an object other than the one that a single ray finds.
    differ: usize,
    refused: usize,
    error: f64,
    off: f64,
    strict: bool,
    is_closed: bool,
    /// The first scenes of each kind of fault: the kind, the scene's number, its text and the pixel.
    kept: Vec<(&'static str, u64, String, [usize; 2])>,
}

impl Tally {
    /// Judges what the program finds in a scene. One ray in `proofs` is also asked for its proof.
    pub fn judge(
        &mut self,
        class: &Class,
        question: &Question,
        number: u64,
        renderer: &Renderer,
        proofs: u64,
    ) {
        (self.strict, self.is_closed) = (class.is_first_seen, class.is_closed);
        let Some(program) = Program::read(&question.text, &question.mesh) else {
            self.refused += question.pixels.len();
            self.keep("refused", number, question, [0, 0]);
            return;
        };
        let scene = Scene::read(&question.text, &question.mesh);
        let picture = question.is_picture.then(|| program.picture(renderer));
        for pixel in &question.pixels {
            let found = program.find(*pixel);
            let truth = self.ray(&scene, question, number, *pixel, &found);
            if (self.rays as u64).is_multiple_of(proofs) {
                self.proof(question, number, *pixel, &found, &truth, &program);
            }
            if let Some(picture) = &picture {
                let [width, height] = program.size();
                let seen = picture[(height - 1 - pixel[1]) * width + pixel[0]];
                if material_of(seen) != found.material {
                    self.differ += 1;
                    self.keep("packets", number, question, *pixel);
                }
            }
        }
    }

    fn ray(
        &mut self,
        scene: &Scene,
        question: &Question,
        number: u64,
        pixel: [usize; 2],
        found: &ProgramHit,
    ) -> Truth {
        self.rays += 1;
        let real = Ray::of_pixel(scene, pixel[0] as i64, pixel[1] as i64);
        let truth = oracle::first(scene, &real);
        let rounded = Ray::as_is(scene, found.origin, found.dir);
        let of_rounded = oracle::first(scene, &rounded);
        // The smaller of the two errors of the distance counts, since the rounded ray itself has an error.
        let by_real = Off::of(scene, &real, &truth, found);
        let by_rounded = Off::of(scene, &rounded, &of_rounded, found);
        if self.is_closed && found.first.is_none() {
            self.wrong += 1;
            self.keep("wrong", number, question, pixel);
        } else if truth.is_touch || truth.is_shared || of_rounded.is_touch || of_rounded.is_shared {
            self.ties += 1;
            self.keep("tie", number, question, pixel);
            if !truth.is_touch && !of_rounded.is_touch && !by_real.is_hit && !by_rounded.is_hit {
                self.lost += 1;
                self.keep("lost", number, question, pixel);
            }
        } else if !by_real.is_right() {
            if by_rounded.is_right() {
                self.rounded += 1;
            } else if by_real.is_hit || by_rounded.is_hit {
                self.late += 1;
                self.keep("late", number, question, pixel);
            } else {
                self.wrong += 1;
                self.keep("wrong", number, question, pixel);
            }
        }
        if by_real.is_right() || by_rounded.is_right() {
            let least = |of: fn(&Off) -> f64| {
                let right = [&by_real, &by_rounded].into_iter().filter(|off| off.is_right());
                right.map(of).fold(f64::INFINITY, f64::min)
            };
            self.error = self.error.max(least(|off| off.error));
            self.off = self.off.max(least(|off| off.off));
        }
        truth
    }

    fn proof(
        &mut self,
        question: &Question,
        number: u64,
        pixel: [usize; 2],
        found: &ProgramHit,
        truth: &Truth,
        program: &Program,
    ) {
        self.proofs += 1;
        let is_tie = truth.is_touch || truth.is_shared;
        // Parts of a solid are told apart by their materials.
        let is_hit = found.first == truth.first && (is_tie || found.material == truth.material);
        let is_wrong = match program.claim(pixel) {
            Claim::Right => !is_hit && !truth.is_touch,
            Claim::Wrong => is_hit && !is_tie,
            Claim::Unknown => {
                if !is_tie {
                    self.undecided += 1;
                    self.keep("undecided", number, question, pixel);
                }
                false
            }
        };
        if is_wrong {
            self.wrong_proofs += 1;
            self.keep("proof", number, question, pixel);
        }
    }

    fn keep(&mut self, kind: &'static str, number: u64, question: &Question, pixel: [usize; 2]) {
        const MAX_KEPT: usize = 3;
        if self.kept.iter().filter(|(other, ..)| *other == kind).count() < MAX_KEPT {
            let mesh = question.mesh.lines().map(|line| format!("# {line}\n"));
            let text = mesh.fold(question.text.clone(), |text, line| text + &line);
            self.kept.push((kind, number, text, pixel));
        }
    }

    pub fn merge(&mut self, other: Self) {
        for (mine, its) in [
            (&mut self.rays, other.rays),
            (&mut self.wrong, other.wrong),
            (&mut self.late, other.late),
            (&mut self.rounded, other.rounded),
            (&mut self.ties, other.ties),
            (&mut self.lost, other.lost),
            (&mut self.proofs, other.proofs),
            (&mut self.wrong_proofs, other.wrong_proofs),
            (&mut self.undecided, other.undecided),
            (&mut self.differ, other.differ),
            (&mut self.refused, other.refused),
        ] {
            *mine += its;
        }
        (self.error, self.off) = (self.error.max(other.error), self.off.max(other.off));
        self.strict |= other.strict;
        self.kept.extend(other.kept);
    }

    /// Tells whether nothing is wrong.
    pub fn is_sound(&self) -> bool {
        self.wrong + self.late + self.wrong_proofs + self.differ == 0 && (self.lost == 0 || !self.strict)
    }

    /// Returns the table's row for a class. Scenes with faults are written to the folder that FALSIFY_KEEP names.
    pub fn row(&self, name: &str, time: Duration) -> String {
        if let Ok(folder) = env::var("FALSIFY_KEEP") {
            fs::create_dir_all(&folder).expect("room for a folder");
            for (kind, number, text, [x, y]) in &self.kept {
                let name = name.replace([',', ' '], "-").replace("--", "-");
                let path = Path::new(&folder).join(format!("{name}-{kind}-{number}.ray"));
                fs::write(path, format!("# pixel {x} {y}\n{text}")).expect("room for a file");
            }
        }
        let Self {
            rays,
            wrong,
            late,
            rounded,
            ties,
            lost,
            proofs,
            wrong_proofs,
            undecided,
            differ,
            refused,
            ..
        } = self;
        format!(
            "| {} | {name} | {rays} | {wrong} | {late} | {rounded} | {ties} | {lost} | {proofs} | {wrong_proofs} | {undecided} | \
             {differ} | {:.1} | {:.1} | {refused} | {:.1} |",
            if self.is_sound() { "yes" } else { "NO" },
            self.error,
            self.off,
            time.as_secs_f64(),
        )
    }

    /// Returns the counts of what is wrong, and the scene with the worst fault.
    pub fn worst(&self) -> String {
        let rank = |kind: &str| {
            ["proof", "wrong", "late", "packets", "lost"].iter().position(|other| *other == kind)
        };
        let worst = self.kept.iter().filter(|(kind, ..)| rank(kind).is_some());
        let worst = worst.min_by_key(|(kind, number, ..)| (rank(kind), *number));
        let scene = worst.map_or(String::new(), |(kind, number, text, pixel)| {
            format!("; {kind}, scene {number}, pixel {pixel:?}:\n{text}")
        });
        format!(
            "{} wrong hits, {} wrong distances, {} wrong proofs, {} lost ties and {} pixels of packets in {} rays{scene}",
            self.wrong, self.late, self.wrong_proofs, self.lost, self.differ, self.rays
        )
    }
}

/// Returns the index of the material that a pixel shows, by the channels that are 255.
pub fn material_of(seen: [u8; 3]) -> Option<usize> {
    match seen.map(|channel| channel == 255) {
        [true, true, _] => Some(3),
        [true, _, _] => Some(0),
        [_, true, _] => Some(1),
        [_, _, true] => Some(2),
        _ => None,
    }
}

/// The deviation of a hit from the true one.
struct Off {
    /// Whether the hit is of the true object.
    is_hit: bool,
    /// The error of the distance, in units in the last place of the distance.
    error: f64,
    /// The distance from the surface, in units in the last place of the distance or of the eye's largest coordinate.
    off: f64,
}

impl Off {
    fn of(scene: &Scene, ray: &Ray, truth: &Truth, found: &ProgramHit) -> Self {
        let mut off = Self {
            is_hit: truth.first == found.first && truth.material == found.material,
            error: 0.0,
            off: 0.0,
        };
        if let (true, Some(first), Some(place)) = (off.is_hit, truth.first, &truth.place) {
            if !found.distance.is_finite() {
                off.is_hit = false;
                return off;
            }
            let distance = ray.distance(place);
            let apart = Number::abs(&distance.sub(&Wide::point(&Dyadic::from(found.distance))));
            let near = distance.near();
            let unit = Wide::f64(near.next_up() - near);
            off.error = apart.div(&unit).near();
            // A point right in front of the eye is known no better than the eye's own position.
            let size = found.origin.iter().fold(near, |most, part| most.max(part.abs()));
            let size = size.max(oracle::reach(&scene.objects[first]));
            let grain = Wide::f64(size.next_up() - size);
            off.off = apart.div(&grain).near() * oracle::cosine(&scene.objects[first], ray, place);
        }
        off
    }

    fn is_right(&self) -> bool {
        self.is_hit && self.off <= OFF
    }
}
