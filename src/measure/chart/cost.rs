//! The CPU time of an image, measured on some of its packets of rays, which are spread over it.
//!
//! A packet is traced as in a render, while the other threads trace others, and timed by the clock of its own thread,
//! which stands still while other programs run.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use tabray_core::geometry::ray_packet::PACKET_SIZE;
use tabray_core::render::flaws::Flaws;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::trace::{Scratch, Tracer};
use tabray_core::simd::cpu::Cpu;
use tabray_tools::sampling::places::{self, Pixels};
use tabray_tools::sampling::traced::{self, Group, Rays};

/// The numbers of packets that are timed at first: more only where they are fast.
const FEWEST: usize = 4;
const MORE: usize = 64;

/// About the CPU time that the first packets of a choice may take, in seconds.
const FIRST: f64 = 0.02;

/// The assumed error of an image's time, in standard errors.
const DEVIATIONS: f64 = 3.0;

/// The sufficient relative error of counted rays, and the maximum number of packets and CPU time in seconds for
/// counting.
const COUNTED: f64 = 0.1;
const MAX_COUNTED: usize = 128;
const COUNTING: f64 = 0.1;

/// The number of pixels whose rays are counted one by one, and the number between two checks of the time.
const ALONE: usize = 1024;
const ALONE_AT_ONCE: usize = 64;

/// The step between numbers that are spread most evenly from 0 to 1: the fractional part of the golden ratio.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The number of packets that are looked for in vain before the image counts as measured.
const IN_VAIN: usize = 64;

/// The relative error of a time that is exact enough.
const EXACT: f64 = 0.2;

/// The maximum CPU time for making a time more exact, in seconds, and the maximum part of the image that is traced
/// for it.
const LONGEST: f64 = 0.6;
const PART: f64 = 0.25;

/// A time that is estimated from a part of the work, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimated {
    /// The time.
    pub mean: f64,
    /// The least and the greatest plausible time.
    pub range: [f64; 2],
}

impl Estimated {
    pub(super) fn map(self, of: impl Fn(f64) -> f64) -> Self {
        Self { mean: of(self.mean), range: self.range.map(of) }
    }
}

/// The packets of an image that have been timed.
#[derive(Default)]
pub(super) struct Timing {
    packets: Vec<Packet>,
    /// The packets by the first pixel of each.
    known: BTreeMap<[usize; 2], usize>,
    /// The number of places of the image that have been looked at.
    looked: usize,
    /// Whether there are hardly any other packets.
    is_over: bool,
    /// Whether all packets of the image are known.
    is_whole: bool,
}

/// A packet of rays, or the rays of tiles that are traced together.
#[derive(Clone, Copy, Default)]
struct Packet {
    pixels: usize,
    seconds: f64,
    rays: Rays,
    /// The number of times that it has been looked at.
    looked: f64,
}

impl Timing {
    /// Times the first packets of an image: as many as can be timed quickly.
    pub fn begun(plan: &Plan, threads: &Renderer, counted: Option<&Counted>) -> Self {
        let mut timing = Self::default();
        timing.add(plan, threads, counted, FEWEST);
        let mean = timing.seconds() / timing.packets.len() as f64;
        let more = ((FIRST / mean) as usize).clamp(FEWEST, MORE);
        timing.add(plan, threads, counted, more - FEWEST);
        timing
    }

    /// Times more packets, unless the time is exact enough or the timed part of the image is large. Returns whether
    /// it did.
    pub fn refine(&mut self, plan: &Plan, threads: &Renderer, counted: Option<&Counted>) -> bool {
        let [width, height] = plan.camera.pixels;
        let pixels: usize = self.packets.iter().map(|packet| packet.pixels).sum();
        let is_done = self.error(counted) * DEVIATIONS <= EXACT
            || self.is_over
            || 2.0 * self.seconds() > LONGEST
            || pixels as f64 > PART * (width * height) as f64;
        if !is_done {
            self.add(plan, threads, counted, self.packets.len());
        }
        !is_done
    }

    /// Times this many more packets of an image, if it has them.
    fn add(&mut self, plan: &Plan, threads: &Renderer, counted: Option<&Counted>, count: usize) {
        let (mut scratch, mut nobody) = (Scratch::default(), Flaws::default());
        let tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut nobody);
        let (size, together) = (plan.camera.pixels, [tracer.tiles_together(), tracer.pixels_together()]);
        let before = self.packets.len();
        let (mut packets, mut again, mut in_vain) = (Vec::new(), vec![0.0; before], 0);
        while packets.len() < count && in_vain < IN_VAIN {
            let place =
                counted.map_or_else(|| places::place(size, self.looked), |all| all.place(self.looked));
            let pixels = packet(size, place, together);
            self.looked += 1;
            match self.known.entry(pixels[0]) {
                Entry::Occupied(known) => {
                    again[*known.get()] += 1.0;
                    in_vain += 1;
                }
                Entry::Vacant(place) => {
                    place.insert(again.len());
                    again.push(1.0);
                    packets.push(pixels);
                    in_vain = 0;
                }
            }
        }
        self.packets.extend(traced(plan, threads, &packets));
        self.packets.iter_mut().zip(again).for_each(|(packet, again)| packet.looked += again);
        self.is_over |= in_vain == IN_VAIN;
        self.is_whole = self.sum(|packet| packet.pixels as f64) == (size[0] * size[1]) as f64;
    }

    /// Returns the time for all of an image, which takes this number of rays from the viewer. If rays are counted,
    /// packets with more rays have been looked at more often.
    pub fn of_all(&self, primary: f64, counted: Option<&Counted>) -> Estimated {
        let of_primary = match counted.filter(|_| !self.is_whole) {
            Some(counted) => counted.each * self.of_ray(),
            None => self.seconds() / self.sum(Packet::primary),
        };
        let (mean, off) = (primary * of_primary, DEVIATIONS * self.error(counted));
        Estimated { mean, range: [(mean * (1.0 - off)).max(0.0), mean * (1.0 + off)] }
    }

    /// Returns the mean time of a ray of any kind, in seconds.
    fn of_ray(&self) -> f64 {
        self.sum(|packet| packet.looked * packet.of_ray()) / self.sum(|packet| packet.looked)
    }

    /// Returns the number of rays of all kinds for each ray from the viewer.
    pub fn all_rays(&self, counted: Option<&Counted>) -> f64 {
        counted.map_or(self.sum(Packet::all) / self.sum(Packet::primary), |counted| counted.each)
    }

    /// Returns the number of probes for a pixel, where pixels differ in their numbers of samples. It does not depend on
    /// how many packets there was time for.
    pub fn probes(&self) -> f64 {
        let first = || self.packets.iter().take(FEWEST);
        let probes: u64 = first().map(|packet| packet.rays.primary.saturating_sub(packet.rays.samples)).sum();
        probes as f64 / first().map(|packet| packet.pixels).sum::<usize>() as f64
    }

    /// Tells whether the packets take at most this part of the time of the other ones at the same places, in each of
    /// this many groups.
    pub fn is_faster(&self, other: &Self, part: f64, groups: usize) -> bool {
        let count = self.packets.len().min(other.packets.len());
        let [one, other] = [self, other].map(|timing| timing.packets[..count].chunks(count.div_ceil(groups)));
        let seconds = |packets: &[Packet]| packets.iter().map(|packet| packet.seconds).sum::<f64>();
        one.zip(other).all(|(one, other)| seconds(one) <= part * seconds(other))
    }

    fn sum(&self, of: impl Fn(&Packet) -> f64) -> f64 {
        self.packets.iter().map(of).sum()
    }

    fn seconds(&self) -> f64 {
        self.sum(|packet| packet.seconds)
    }

    /// Returns the relative standard error of the time of an image.
    fn error(&self, counted: Option<&Counted>) -> f64 {
        match counted {
            _ if self.is_whole => 0.0,
            Some(_) if self.packets.len() < 2 => f64::INFINITY,
            Some(counted) => {
                let mean = self.of_ray();
                let square = |packet: &Packet| packet.looked * (packet.of_ray() / mean - 1.0).powi(2);
                let variance = self.sum(square) / self.sum(|packet| packet.looked);
                (variance / (self.packets.len() as f64 - 1.0)).sqrt().hypot(counted.error)
            }
            None => ratio_error(&self.packets, |packet| packet.seconds, Packet::primary),
        }
    }
}

impl Packet {
    /// Returns the time of a ray of any kind, in seconds.
    fn of_ray(&self) -> f64 {
        self.seconds / self.all()
    }

    fn all(&self) -> f64 {
        self.rays.all as f64
    }

    fn primary(&self) -> f64 {
        self.rays.primary as f64
    }
}

/// The rays of all kinds of an image, counted in many places.
pub(super) struct Counted {
    /// The number of rays of all kinds for each ray from the viewer.
    each: f64,
    /// The relative standard error of this number.
    error: f64,
    /// Some pixels, each with the sum of its rays and those of all before it.
    pixels: Vec<([usize; 2], f64)>,
}

impl Counted {
    /// Counts the rays of pixels that are spread over an image, with one sample in each. Returns `None` where pixels
    /// use up their ray budgets, and the rays of one sample may depend on those of others.
    pub fn new(plan: &Plan, threads: &Renderer) -> Option<Self> {
        // Pixels one by one, to find those that take many rays.
        let (mut pixels, mut sum, mut seconds) = (Vec::new(), 0.0, 0.0);
        while pixels.len() < ALONE && seconds <= COUNTING {
            let places: Vec<_> = (pixels.len()..pixels.len() + ALONE_AT_ONCE)
                .map(|index| vec![places::place(plan.camera.pixels, index)])
                .collect();
            for (packet, place) in traced(plan, threads, &places).iter().zip(&places) {
                sum += packet.all();
                seconds += packet.seconds;
                pixels.push((place[0], sum));
            }
        }
        let mut packets = Vec::new();
        loop {
            let next = packets.len().max(FEWEST);
            let more: Vec<Pixels> = (packets.len()..packets.len() + next)
                .map(|packet| packet * PACKET_SIZE..(packet + 1) * PACKET_SIZE)
                .map(|range| range.map(|index| places::place(plan.camera.pixels, index)).collect())
                .collect();
            packets.extend(traced(plan, threads, &more));
            if packets.iter().any(|packet| packet.rays.is_cut) {
                return None;
            }
            let seconds: f64 = packets.iter().map(|packet| packet.seconds).sum();
            let error = ratio_error(&packets, Packet::all, Packet::primary);
            if DEVIATIONS * error <= COUNTED || seconds > COUNTING || packets.len() >= MAX_COUNTED {
                let [all, primary] =
                    [Packet::all, Packet::primary].map(|of| packets.iter().map(of).sum::<f64>());
                return Some(Self { each: all / primary, error, pixels });
            }
        }
    }

    /// Returns one of the pixels. Pixels with more rays are returned more often.
    fn place(&self, index: usize) -> [usize; 2] {
        let all = self.pixels.last().map_or(0.0, |(_, sum)| *sum);
        let wanted = all * (GOLDEN * (index as f64 + 0.5)).fract();
        let place = self.pixels.partition_point(|(_, sum)| *sum <= wanted);
        self.pixels[place.min(self.pixels.len() - 1)].0
    }
}

/// Traces packets on all threads of a renderer, and returns them in their order.
fn traced(plan: &Plan, threads: &Renderer, packets: &[Pixels]) -> Vec<Packet> {
    let packet =
        |Group { colours, rays, seconds, .. }| Packet { pixels: colours.len(), seconds, rays, looked: 0.0 };
    traced::groups(threads, plan, packets).into_iter().map(packet).collect()
}

/// Returns the relative standard error of the ratio of the sums of two numbers of packets.
fn ratio_error(packets: &[Packet], above: impl Fn(&Packet) -> f64, below: impl Fn(&Packet) -> f64) -> f64 {
    let count = packets.len() as f64;
    let [sum, of] = [packets.iter().map(&above).sum::<f64>(), packets.iter().map(&below).sum()];
    let off = |packet: &Packet| above(packet) - sum / of * below(packet);
    let squares: f64 = packets.iter().map(|packet| off(packet) * off(packet)).sum();
    if count < 2.0 { f64::INFINITY } else { (squares * count / (count - 1.0)).sqrt() / sum }
}

/// Returns the pixels that a render traces together with this one, given the numbers of tiles and pixels.
fn packet(size: [usize; 2], pixel: [usize; 2], [tiles, pixels]: [usize; 2]) -> Pixels {
    let all = places::tiles_around(size, pixel, tiles);
    let place = all.iter().position(|one| *one == pixel).unwrap_or(0) / pixels * pixels;
    all[place..all.len().min(place + pixels)].to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Packets of 10 rays from the viewer each, by their seconds, their rays and how often they have been looked at.
    fn timing(packets: &[(f64, u64, f64)]) -> Timing {
        let packet = |&(seconds, all, looked): &(f64, u64, f64)| Packet {
            pixels: 10,
            seconds,
            rays: Rays { all, primary: 10, ..Rays::default() },
            looked,
        };
        Timing { packets: packets.iter().map(packet).collect(), ..Timing::default() }
    }

    #[test]
    fn packets_that_are_looked_at_by_their_rays_tell_the_time_of_an_image() {
        // One packet in eleven takes 100 rays of 3 s, and the others 10 rays of 1 s.
        let counted = Counted { each: 2.0 * 100.0 / 110.0, error: 0.0, pixels: Vec::new() };
        let Estimated { mean, range } =
            timing(&[(300.0, 100, 1.0), (10.0, 10, 1.0)]).of_all(110.0, Some(&counted));
        assert!((mean - 400.0).abs() < 1e-9, "{mean}");
        assert!(range[0] < mean && range[1] > mean, "{range:?}");
        let whole = Timing { is_whole: true, ..timing(&[(300.0, 100, 1.0), (10.0, 10, 7.0)]) };
        assert_eq!(whole.of_all(20.0, Some(&counted)), Estimated { mean: 310.0, range: [310.0; 2] });
    }

    #[test]
    fn times_of_packets_that_differ_more_are_less_sure() {
        let off = |seconds: [f64; 2]| {
            let packets: Vec<_> = (0..20).map(|index| (seconds[index % 2], 10, 1.0)).collect();
            timing(&packets).of_all(200.0, None).range
        };
        assert_eq!(off([1.0, 1.0]), [20.0, 20.0]);
        let [narrow, wide] = [off([0.9, 1.1]), off([0.5, 1.5])];
        assert!(wide[0] < narrow[0] && narrow[0] < 20.0 && 20.0 < narrow[1] && narrow[1] < wide[1]);
    }

    #[test]
    fn pixels_are_looked_at_as_often_as_they_take_rays() {
        let counted =
            Counted { each: 1.0, error: 0.0, pixels: vec![([0, 0], 1.0), ([1, 0], 1.0), ([2, 0], 10.0)] };
        let places: Vec<_> = (0..1000).map(|index| counted.place(index)[0]).collect();
        let count = |wanted: usize| places.iter().filter(|place| **place == wanted).count();
        assert!(count(0).abs_diff(100) <= 2 && count(1) == 0, "{} {}", count(0), count(1));
    }
}
