//! Which hits each choice finds, at which distances, and in what time: for rays through the image, and for rays that
//! graze silhouettes.

use super::candidate::Candidate;
use super::clock;
use super::data::{Panel, Point, Subject, WrongHits, WrongHitsOf};
use super::judgement::{Judgement, Known, Pair, Truth};
use super::packets::Packet;
use super::progress::Progress;
use super::study::Study;
use glam::{DVec2, DVec3};
use std::array;
use std::hint::black_box;
use std::ops::{ControlFlow, Range};
use tabray_core::geometry::ray::{MISS, Ray, RayRange};
use tabray_core::geometry::ray_packet::PACKET_SIZE;
use tabray_core::geometry::sight::Sight;
use tabray_core::parallel;
use tabray_core::scene::model::Model;
use tabray_core::shapes::by_method::is_searched;
use tabray_core::simd::cpu::Cpu;
use tabray_core::text::visible;
use tabray_core::world::any_shape::AnyShape;
use tabray_core::world::camera::Projected;
use tabray_core::world::certify::{Enclosure, Precision};
use tabray_exact::roots::bisection::bisect;
use tabray_tools::sampling::places::{spread, tiles};

/// The approximate numbers of pairs of a ray and an object in a set of camera rays and in one of grazing rays.
pub const PAIRS: [usize; 2] = [20_000, 4_000];

/// The approximate number of pairs that are timed.
const TIMED: usize = 2_000;

/// The number of rays that are aimed at an object that few camera rays hit, and the distances in pixels from the middle of
/// one that shows it, along each axis, within which half of them and the other half pass.
const AIMED: usize = 128;
const WITHIN: f64 = 0.05;
const NEAR: f64 = 4.0;

/// The maximum number of pairs of a pixel and an object up to which the whole image is looked at for each object.
const MAX_SCANNED: usize = 1 << 23;

/// The work of finding the true hit of one pair, in units of [`Progress`].
const TRUTH: usize = 30;

/// Rays, with the objects that they are tested against.
pub struct Set {
    title: String,
    packets: Vec<Packet>,
    /// Whether the objects' hits are roots of a function along a ray.
    is_searched: bool,
}

/// The pixels whose middle ray hits an object.
pub struct Scan {
    object: usize,
    hit: Vec<[usize; 2]>,
    /// The pixels that differ from their left neighbours, and whether they are hit.
    edges: Vec<([usize; 2], bool)>,
}

/// Scans the image for the objects whose hits can be proven.
pub fn scans(study: &Study) -> Vec<Scan> {
    let model = &study.candidates[study.strict].model;
    let objects: Vec<_> = (0..model.objects.len()).collect();
    let scan =
        |object: &usize| is_provable(model, &model.objects[*object].shape).then(|| Scan::new(model, *object));
    study.threads.run(|| each(&objects, scan)).into_iter().flatten().collect()
}

impl Scan {
    fn new(model: &Model, object: usize) -> Self {
        let [width, height] = model.camera.value.pixels;
        let mut scan = Self { object, hit: Vec::new(), edges: Vec::new() };
        let [columns, rows] = region(model, object).unwrap_or([0..width, 0..height]);
        for y in rows {
            let mut last = hits(model, object, [columns.start as f64, y as f64]);
            for x in columns.clone() {
                let here = hits(model, object, [x as f64, y as f64]);
                if here {
                    scan.hit.push([x, y]);
                }
                if here != last {
                    scan.edges.push(([x, y], here));
                }
                last = here;
            }
        }
        scan
    }

    /// Returns this many places, or one more, half of them in pixels that show the object, and half in pixels near those.
    fn aimed(&self, count: usize, [width, height]: [usize; 2]) -> Vec<[f64; 2]> {
        let most = DVec2::new(width as f64 - 1.0, height as f64 - 1.0);
        let near = |index: usize| {
            let [x, y] = self.hit[index * self.hit.len().max(count / 2) / (count / 2) % self.hit.len()];
            let at = DVec2::new(x as f64, y as f64);
            // Spread over a square, by a sequence of Korobov's kind.
            let turn = |by: f64| 2.0 * (by * index as f64).fract() - 1.0;
            let off = DVec2::new(turn(0.754_877_666_246_693), turn(0.569_840_290_998_053));
            [WITHIN, NEAR].map(|far| (at + far * off).clamp(DVec2::ZERO, most))
        };
        (0..count.div_ceil(2)).flat_map(near).map(|at| at.to_array()).collect()
    }
}

/// Returns the columns and rows that may show an object of a scene with many, where its bounds tell.
fn region(model: &Model, object: usize) -> Option<[Range<usize>; 2]> {
    let camera = &model.camera.value;
    let [width, height] = camera.pixels;
    if model.objects.len() * width * height <= MAX_SCANNED
        || camera.camera.corners(camera.pixels, 0.0).is_none()
    {
        return None;
    }
    let bounds = model.objects[object].shape.facts().bounds?;
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for corner in 0..8 {
        let side = |axis: usize| if corner >> axis & 1 == 0 { bounds.low[axis] } else { bounds.high[axis] };
        let Projected::At(at) = camera.project(DVec3::from_array(array::from_fn(side))) else { return None };
        (low, high) = (low.min(at), high.max(at));
    }
    let range = |side: usize, end: usize| {
        let clamped = |at: f64| at.clamp(0.0, end as f64) as usize;
        clamped(low[side] - 1.0)..clamped(high[side] + 2.0)
    };
    Some([range(0, width), range(1, height)])
}

/// Tells whether the ray through a place hits an object.
fn hits(model: &Model, object: usize, [x, y]: [f64; 2]) -> bool {
    model.objects[object].shape.distance(&model.camera.value.ray(x, y), &RayRange::ALL) != MISS
}

/// Returns all sets of a scene, with about these numbers of pairs of a ray and an object in one of camera rays and in
/// one of grazing rays.
pub fn sets(model: &Model, scans: &[Scan], [of_camera, of_grazing]: [usize; 2]) -> Vec<Set> {
    let mut sets = Vec::new();
    for is_of_roots in [true, false] {
        let group: Vec<&Scan> = scans
            .iter()
            .filter(|scan| is_searched(&model.objects[scan.object].shape) == is_of_roots)
            .collect();
        if group.is_empty() {
            continue;
        }
        let names: Vec<_> = group.iter().map(|scan| model.objects[scan.object].args.name()).collect();
        let what = visible(&list(names)).into_owned();
        let mut add = |kind: &str, packets: Vec<Packet>| {
            if !packets.is_empty() {
                let title = format!("{what}: {kind}");
                sets.push(Set { title, packets, is_searched: is_of_roots });
            }
        };
        add("camera rays", camera(model, &group, of_camera));
        add("grazing rays", grazing(model, &group, of_grazing));
    }
    sets
}

/// Returns the number of rays in packets.
fn count(packets: &[Packet]) -> usize {
    packets.iter().map(Packet::len).sum()
}

/// Returns the work of measuring a set, in units of [`Progress`].
pub fn work(set: &Set, candidates: usize) -> usize {
    count(&set.packets) * (TRUTH + candidates) + clock::work(candidates)
}

/// Counts the wrong hits of all choices on a set.
pub fn wrong(study: &Study, set: &Set, progress: &mut dyn Progress) -> ControlFlow<(), WrongHitsOf> {
    let truths = truths(study, set, progress)?;
    let of = |candidate: &&Candidate| {
        (candidate.name.clone(), tally(&judge_all(study, candidate, set, &truths)).1)
    };
    let counts = candidates(study, set).iter().map(of).collect();
    ControlFlow::Continue(WrongHitsOf { title: set.title.clone(), counts })
}

/// Measures all choices on a set.
pub fn panel(study: &Study, set: &Set, progress: &mut dyn Progress) -> ControlFlow<(), Option<Panel>> {
    let candidates = candidates(study, set);
    let (cpu, rays) = (Cpu::best(), count(&set.packets));
    let truths = truths(study, set, progress)?;
    let mut errors = Vec::new();
    for candidate in &candidates {
        errors.push(tally(&judge_all(study, candidate, set, &truths)));
        progress.done(rays)?;
    }
    let step = rays.div_ceil(TIMED);
    let timed: Vec<_> = set.packets.iter().step_by(step).collect();
    let work = |choice: usize| {
        let objects = &candidates[choice].model.objects;
        for packet in &timed {
            black_box(black_box(packet).hits(&objects[packet.object].shape, cpu));
        }
    };
    let count = timed.iter().map(|packet| packet.len()).sum();
    let times = clock::rounds((candidates.len(), count), study.effort, work, progress)?;
    let moved = moved_by_rounding(study, set, &truths);
    let truths: Vec<_> = truths.iter().flatten().map(|known| &known.truth).collect();
    let hits = truths.iter().filter(|truth| matches!(truth, Truth::Hit { .. })).count();
    let undecided = truths.iter().filter(|truth| matches!(truth, Truth::Undecided)).count();
    if hits == 0 {
        return ControlFlow::Continue(None);
    }
    let lost = candidates.iter().zip(&errors).filter(|(_, (errors, _))| errors.is_empty());
    let lost: Vec<_> = lost.map(|(candidate, _)| candidate.name.as_str()).collect();
    let lost = if lost.is_empty() { String::new() } else { format!("; none found by {}", lost.join(", ")) };
    let undecided = if undecided == 0 { String::new() } else { format!(", {undecided} undecided") };
    let points = candidates.iter().zip(errors).zip(times).map(|((candidate, (errors, wrong)), times)| {
        let part = |part: f64| {
            let place = (part * errors.len() as f64) as usize;
            errors.get(place.min(errors.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
        };
        Point {
            name: candidate.name.clone(),
            family: candidate.family,
            is_default: candidate.is_default,
            times,
            error: part(0.99),
            worst: part(1.0),
            wrong,
            visible: None,
            changed: None,
            samples: 1,
        }
    });
    ControlFlow::Continue(Some(Panel {
        title: set.title.clone(),
        note: format!(
            "{} rays, {hits} hits{undecided}, rounding may move 1 % by {moved:.0e} or more{lost}",
            truths.len()
        ),
        subject: Subject::Distances,
        points: points.collect(),
    }))
}

/// Returns the candidates that differ on a set.
fn candidates<'s>(study: &'s Study, set: &Set) -> Vec<&'s Candidate> {
    study.candidates.iter().filter(|candidate| set.is_searched || candidate.accuracy.is_some()).collect()
}

/// Returns what is proven about the rays of each packet; of the first packets, if time does not suffice for all.
fn truths(study: &Study, set: &Set, progress: &mut dyn Progress) -> ControlFlow<(), Vec<Vec<Known>>> {
    let strict = &study.candidates[study.strict].model;
    let mut truths = Vec::new();
    for packets in set.packets.chunks(8) {
        truths.extend(study.threads.run(|| each(packets, |packet| truths_of(strict, packet))));
        progress.done(count(packets) * TRUTH)?;
        if progress.is_late() {
            break;
        }
    }
    ControlFlow::Continue(truths)
}

/// Maps items on all threads of the current pool.
fn each<T: Sync, U: Send>(of: &[T], work: impl Fn(&T) -> U + Sync + Send) -> Vec<U> {
    parallel::map(of.len(), |index| work(&of[index]))
}

/// Returns what is proven about each ray of a packet.
fn truths_of(model: &Model, packet: &Packet) -> Vec<Known> {
    let shape = &model.objects[packet.object].shape;
    packet.sights().map(|(_, sight)| Known::of(shape, sight)).collect()
}

/// Returns the distance by which rounding may move one in a hundred of the true hits, or more, in world units.
fn moved_by_rounding(study: &Study, set: &Set, truths: &[Vec<Known>]) -> f64 {
    let strict = &study.candidates[study.strict].model;
    let moved = |(packet, truths): (&Packet, &Vec<Known>)| -> Vec<f64> {
        let shape = &strict.objects[packet.object].shape;
        let pairs = packet.sights().zip(truths);
        pairs
            .filter_map(|((ray, sight), known)| Pair { shape, ray, sight }.moved_by_rounding(known))
            .collect()
    };
    let mut moved: Vec<f64> = set.packets.iter().zip(truths).flat_map(moved).collect();
    moved.sort_unstable_by(f64::total_cmp);
    moved.get((0.99 * moved.len() as f64) as usize).copied().unwrap_or(0.0)
}

/// Judges the hits that a candidate finds in the packets of which the truth is known.
fn judge_all(study: &Study, candidate: &Candidate, set: &Set, truths: &[Vec<Known>]) -> Vec<Judgement> {
    let strict = &study.candidates[study.strict].model;
    let packets: Vec<_> = set.packets.iter().zip(truths).collect();
    let judge = |(packet, truths): &(&Packet, &Vec<Known>)| -> Vec<Judgement> {
        let [shape, own] = [strict, &candidate.model].map(|model| &model.objects[packet.object].shape);
        let found = packet.hits(own, Cpu::best());
        let one = |(((ray, sight), truth), found): (((Ray, &Sight), &Known), f64)| {
            let judged = Pair { shape, ray, sight }.judge(truth, found, candidate.promise);
            // The notes mean another surface in places, as the upper half of a cone.
            let is_of_another = || {
                let by_own =
                    Pair { shape: own, ray, sight }.judge(&Known::of(own, sight), found, candidate.promise);
                matches!(by_own, Judgement::Right(_))
            };
            let is_wrong = !matches!(judged, Judgement::Right(_) | Judgement::Undecided);
            if is_wrong && candidate.accuracy.is_some() && is_of_another() {
                Judgement::Undecided
            } else {
                judged
            }
        };
        packet.sights().zip(*truths).zip(found).map(one).collect()
    };
    study.threads.run(|| each(&packets, judge)).concat()
}

/// Returns the errors of the right hits, sorted, and the numbers of the wrong ones.
fn tally(judged: &[Judgement]) -> (Vec<f64>, WrongHits) {
    let (mut errors, mut wrong) = (Vec::new(), WrongHits::default());
    for judgement in judged {
        match judgement {
            Judgement::Undecided => continue,
            Judgement::Right(error) => errors.extend(error),
            Judgement::Missed => wrong.missed += 1,
            Judgement::Invented => wrong.invented += 1,
            Judgement::Later => wrong.later += 1,
            Judgement::Inaccurate => wrong.inaccurate += 1,
        }
        wrong.of += 1;
    }
    errors.sort_unstable_by(f64::total_cmp);
    (errors, wrong)
}

/// Tells whether hits of a shape can be proven.
fn is_provable(model: &Model, shape: &AnyShape) -> bool {
    const LOOKS: usize = 64;
    let camera = &model.camera.value;
    let mut places = spread(camera.pixels, LOOKS).into_iter();
    let is_certain = |[x, y]: [usize; 2]| {
        let sight = camera.sight(x as f64, y as f64);
        matches!(shape.certify(&sight, Precision::Double), Enclosure::Misses | Enclosure::Hits(_))
    };
    places.any(is_certain)
}

/// Returns rays through the centres of pixels, in the packets in which a render traces them, and rays aimed at the
/// objects that few of these hit. Of more objects than these are pairs for, some have aimed rays alone.
fn camera(model: &Model, group: &[&Scan], pairs: usize) -> Vec<Packet> {
    let camera = &model.camera.value;
    let all = camera.pixels[0] * camera.pixels[1];
    let mut packets = Vec::new();
    let mut through = 0;
    if group.len() * PACKET_SIZE <= pairs {
        for tile in tiles(camera.pixels, pairs.div_ceil(group.len() * PACKET_SIZE)) {
            let places: Vec<_> = tile.into_iter().map(|place| place.map(|at| at as f64)).collect();
            packets.extend(group.iter().flat_map(|scan| Packet::of(scan.object, camera, &places)));
            through += places.len();
        }
    }
    // Of an image of which all pixels are looked at, nothing is missing.
    let is_thin = |scan: &&&Scan| through < all && through * scan.hit.len() < AIMED * all;
    let thin: Vec<_> = group.iter().filter(is_thin).filter(|scan| !scan.hit.is_empty()).collect();
    let step = (thin.len() * AIMED).div_ceil(pairs.max(1)).max(1);
    let aimed = thin.iter().step_by(step);
    packets.extend(aimed.flat_map(|scan| {
        Packet::of(scan.object, camera, &scan.aimed(AIMED, camera.pixels)).collect::<Vec<_>>()
    }));
    packets
}

/// Returns rays beside the silhouettes of objects, at distances from one pixel width down to 10^-10 of it.
fn grazing(model: &Model, group: &[&Scan], pairs: usize) -> Vec<Packet> {
    const DIGITS: i32 = 10;
    let camera = &model.camera.value;
    let edges: Vec<_> = group
        .iter()
        .flat_map(|scan| scan.edges.iter().map(|(pixel, here)| (scan.object, *pixel, *here)))
        .collect();
    let rays = 2 * (DIGITS as usize + 1);
    let step = edges.len().div_ceil((pairs / rays).max(1)).max(1);
    let mut places_of = vec![Vec::new(); model.objects.len()];
    for (index, [x, y], here) in edges.into_iter().step_by(step) {
        let (x, y) = (x as f64, y as f64);
        let (_, high) = bisect(|x| hits(model, index, [x, y]) == here, (x - 1.0, x), 0.0);
        for digits in 0..=DIGITS {
            for beside in [-1.0, 1.0] {
                places_of[index].push([high + beside * 0.1_f64.powi(digits), y]);
            }
        }
    }
    let packets = |scan: &&Scan| Packet::of(scan.object, camera, &places_of[scan.object]).collect::<Vec<_>>();
    group.iter().flat_map(packets).collect()
}

/// Lists names, each once, for a sentence.
fn list(mut names: Vec<&str>) -> String {
    const MAX_NAMES: usize = 4;
    names.sort_unstable();
    names.dedup();
    let more = names.len() > MAX_NAMES;
    names.truncate(MAX_NAMES);
    names.join(", ") + if more { ", ..." } else { "" }
}
