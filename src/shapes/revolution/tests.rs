//! Profiles of all kinds: some load, others are refused, and no part is lost or invented.

use super::no_surface::NoSurface;
use super::*;
use glam::DVec3;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use tabray_exact::formula::Formula;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::Scalar;
use tabray_world::geometry::frame::Frame;
use tabray_world::geometry::ray::{Ray, RayRange};

fn formula(profile: &str) -> Formula {
    Formula::parse(profile).unwrap_or_else(|fault| panic!("{profile}: {fault:?}"))
}

fn surface(profile: &str, height: f64) -> Result<Revolution, NoSurface> {
    Revolution::new(&formula(profile), height, Refinement::Root)
}

struct Random(Pcg32);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        let part = (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * part
    }

    fn power(&mut self, low: f64, high: f64) -> f64 {
        libm::exp10(self.between(low, high))
    }

    /// Returns a profile of thin discs, steps, kinks, poles, waves and parts cut off at 0.
    fn profile(&mut self) -> String {
        let mut profile = format!("{:?}", self.between(-1.0, 1.5));
        for _ in 0..1 + self.0.next_u32() % 4 {
            let at = self.between(0.0, 6.0);
            let size = self.between(0.1, 2.0);
            profile = match self.0.next_u32() % 8 {
                0 => format!("max({profile}, {size:?} - {:?}*(y - {at:?})^2)", self.power(0.0, 20.0)),
                1 => format!("{profile} + {size:?}*floor({:?}*y)", self.between(0.2, 3.0)),
                2 => format!("{profile} - {size:?}*abs(y - {at:?})"),
                3 => format!("min({size:?}, {profile} + {:?}/abs(y - {at:?}))", self.power(-6.0, 0.0)),
                4 => format!("{profile} + {size:?}*sin({:?}*y)", self.power(0.0, 2.0)),
                5 => format!("max({profile}, ln(y + {:?}))", self.power(-9.0, 0.0)),
                6 => format!("{profile} + {size:?}*exp(-({:?}*(y - {at:?}))^2)", self.power(0.0, 6.0)),
                _ => format!("({profile})*(y - {at:?})"),
            };
        }
        profile
    }
}

/// Returns critical heights: random ones, and some at the ends of slabs.
fn heights(surface: &Revolution, random: &mut Random) -> Vec<f64> {
    let mut heights: Vec<f64> = (0..300).map(|_| random.between(0.0, surface.height)).collect();
    for index in 0..surface.slabs.count() {
        let slab = surface.slabs.get(index);
        heights.extend([slab.from, slab.to, slab.from.next_up(), slab.to.next_down()]);
        heights.extend((0..3).map(|_| random.between(slab.from, slab.to)));
        let apart = random.power(-16.0, -1.0);
        heights.extend([slab.from - apart, slab.from + apart]);
    }
    heights.retain(|y| (0.0..=surface.height).contains(y));
    heights
}

/// Checks many heights of each slab.
#[test]
fn slabs_are_what_they_say_of_any_profile() {
    let mut random = Random(Pcg32::new(5, 0));
    let (mut loaded, mut checked) = (0, 0);
    for _ in 0..300 {
        let profile = random.profile();
        let Ok(surface) = surface(&profile, 6.0) else { continue };
        loaded += 1;
        let slabs = &surface.slabs;
        assert_eq!((slabs.get(0).from, slabs.get(slabs.count() - 1).to), (0.0, 6.0), "{profile}");
        assert!(
            (1..slabs.count()).all(|index| slabs.get(index - 1).to == slabs.get(index).from),
            "{profile}"
        );
        for y in heights(&surface, &mut random) {
            let slab = slabs.get(slabs.index(y));
            // An end belongs to the slabs on both sides.
            if y == slab.from || y == slab.to {
                continue;
            }
            let radius = surface.profile.at(Interval::<f64>::constant(y));
            assert!(!slab.is_void || radius.low <= 0.0, "{profile} is lost at {y:?}: {radius:?}");
            assert!(slab.is_void || radius.high >= 0.0, "{profile} is invented at {y:?}: {radius:?}");
            let square = surface.square.at(Interval::<f64>::constant(y));
            // Exactly at a pole, a formula has no value.
            if !slab.is_void && square.is_bounded() {
                let parabola = slab.parabola(y - slab.middle);
                let rounding = 1e-13 * (1.0 + parabola.abs() + slab.max_square);
                let apart = (square - Interval::constant(parabola)).magnitude() - square.width();
                assert!(apart <= slab.error + rounding, "{profile} at {y:?}: {apart:e}, {slab:?}");
                assert!(square.low <= slab.max_square, "{profile} at {y:?}: {square:?}, {slab:?}");
            }
            checked += 1;
        }
    }
    assert!(loaded > 200 && checked > 100_000, "{loaded} {checked}");
}

#[test]
fn bounded_profiles_load() {
    for profile in ["min(2, 1/abs(y-3))", "max(0.2, ln(y))", "y^y/10", "max(0.3 - y, 2 - 1e14*(y-3.1)^2)"] {
        let surface = surface(profile, 4.0).unwrap_or_else(|fault| panic!("{profile}: {fault:?}"));
        assert!(surface.slabs.count() < 200, "{profile}: {}", surface.slabs.count());
    }
}

#[test]
fn parts_of_any_thinness_are_kept() {
    for power in 3..28 {
        let steep = libm::exp10(f64::from(power));
        let profile = format!("max(0.3 - y, 2 - {steep:e}*(y-3.1)^2)").replace("e+", "e");
        let surface = surface(&profile, 6.0).expect("a surface");
        let half = (2.0 / steep).sqrt();
        let slab = surface.slabs.get(surface.slabs.index(3.1));
        assert!(!slab.is_void && surface.slabs.widest() >= 2.0, "{profile}: {slab:?}");
        let solid =
            (0..surface.slabs.count()).map(|index| surface.slabs.get(index)).filter(|slab| !slab.is_void);
        let disc = solid.filter(|slab| slab.from > 1.0).map(|slab| slab.to - slab.from).sum::<f64>();
        let ulp = 3.1_f64.next_up() - 3.1;
        assert!((disc - 2.0 * half).abs() <= 1e-9 * half + 4.0 * ulp, "{profile}: {disc:e} of {half:e}");
    }
}

#[test]
fn what_cannot_be_told_is_refused_with_the_reason() {
    let wild = "1e-8 + ln(sin(2) ^ 2) + sin(tan(pi ^ y) / 0.5) + min(abs(0.5 - 1e-8), pi ^ 2.11 * 0.5) \
        ^ abs(max(pi, y)) * 1e-9 * 1e-8 * floor(0.5 - (y) * cos(7.27))";
    for (profile, height, told) in [
        ("sin(y)", 1e9, "with too many parts below 0 to separate them from y = "),
        (wild, 12.0, "with too many parts below 0 to separate them from y = 0.3"),
        ("sin(1/y)", 6.0, "with too many parts below 0 to separate them from y = 0.0"),
        ("2 + sin(y)", 1e9, "that bends too often to be bounded from y = "),
        ("1/(y-3)", 6.0, "that is unbounded near y = 3.0"),
        ("ln(y-3)", 6.0, "that is unbounded near y = "),
        ("tan(y)", 6.0, "that is unbounded near y = 1.570796"),
        ("1e10 + (y - 3) - 1e10", 6.0, "whose sign is lost in rounding near y = "),
        ("-1", 6.0, "that is nowhere above 0"),
    ] {
        let fault = surface(profile, height).err().unwrap_or_else(|| panic!("{profile} loads"));
        assert!(fault.message().0.starts_with(told), "{profile}: {}", fault.message().0);
    }
}

#[test]
fn runs_contain_their_slabs() {
    let surface = surface("cos(sin(y) + 1e-8 - exp(y))", 7.88).expect("a surface");
    let slabs = &surface.slabs;
    let all = 0..slabs.count();
    let mut longest = 0;
    for is_upward in [true, false] {
        for index in all.clone() {
            let mut runs = Vec::new();
            let length = slabs.skipped(index, is_upward, all.clone(), |run| {
                runs.push(*run);
                false
            });
            longest = longest.max(length);
            let first = if is_upward { index } else { index + 1 - length.max(1) };
            let Some(run) = runs.last() else {
                assert_eq!(length, 0);
                continue;
            };
            for slab in (first..first + length).map(|index| surface.slab(index)) {
                let contains = run.from <= slab.from && slab.to <= run.to;
                assert!(contains && slab.max_square <= run.max_square, "{slab:?} in {run:?}");
            }
        }
    }
    assert_eq!(longest, 4096);
    // A run that extends beyond the given slabs is not skipped.
    assert_eq!(slabs.skipped(0, true, 0..20, |_| false), 16);
    assert_eq!(slabs.skipped(0, true, 0..15, |_| false), 0);
    assert_eq!(slabs.skipped(0, true, all, |run| run.to > slabs.get(255).to), 256);
}

/// Without a limit for all slabs together, one ray took minutes.
#[test]
fn a_search_ends_however_many_slabs_have_no_good_bounds() {
    let profile = "0.3 + abs(min(y, sqrt(2*exp(sqrt(9.6^7 - y^3)))))";
    let surface = surface(profile, 15.0).expect("a surface");
    assert!(surface.may_be_costly() && surface.slabs.count() > 1000);
    let frame = Frame::around(DVec3::ZERO, DVec3::Y);
    let dir = DVec3::new(0.5, 1.0, 0.0).normalize();
    for part in 0..50 {
        let origin = DVec3::new(-0.4 - 0.01 * f64::from(part), -0.5, 0.1);
        let cost = surface.search_cost(&frame, &Ray { origin, dir }, None);
        assert!(cost < 10_000, "{cost}");
    }
}

/// The bounds of far rays are as wide at a jump as on a piece around it. Further halving would take thousands of
/// pieces, and the last slabs would not be searched at all.
#[test]
fn a_ray_along_the_axis_hits_the_tip_from_both_sides() {
    for (profile, height, tip) in [
        ("1 - y", 2.0, 1.0),
        ("1 - y^2", 1.5, 1.0),
        ("sin(3*y)", 2.0, std::f64::consts::FRAC_PI_3),
        ("y - 0.5", 1.0, 0.5),
    ] {
        let surface = surface(profile, height).unwrap_or_else(|fault| panic!("{profile}: {fault:?}"));
        for axis in [DVec3::Y, DVec3::Z, DVec3::NEG_X] {
            let frame = Frame::around(DVec3::new(0.25, -0.5, 2.0), axis);
            for start in [0.1, 0.9, tip - 0.25, tip + 0.25, -2.0, 4.0] {
                // The sine begins with a tip, too.
                if start < 0.0 && profile.starts_with("sin") {
                    continue;
                }
                let dir = if start < tip { axis } else { -axis };
                let ray = Ray { origin: frame.origin + start * axis, dir };
                let found = surface.first_hit(&frame, &ray, &RayRange::ALL).0;
                let away = (start - tip).abs();
                assert!((found - away).abs() < 1e-12, "{profile} from {start}: {found} for {away}");
            }
        }
    }
}

#[test]
fn a_jump_takes_few_pieces_however_far_a_ray_comes_from() {
    let surface = surface("0.001*(0.5 + 0.25*floor(y/0.001))", 0.00628).expect("a surface");
    let base = DVec3::new(0.004, 0.0, -0.004);
    let frame = Frame::around(base, DVec3::Y);
    let dir = DVec3::new(-0.0553758255167238, 0.9672145356099231, -0.24784987402301045);
    for distance in [0.01, 10.0, 1e4] {
        for ray in 0..1000 {
            let part = [0.7, 0.37, 0.91].map(|step| (step * f64::from(ray)).sin());
            let target = base + DVec3::new(0.0, 0.003, 0.0) + 0.002 * DVec3::from(part);
            let ray = Ray { origin: target - distance * dir, dir };
            let cost = surface.search_cost(&frame, &ray, None);
            assert!(cost < 500, "{ray:?}: {cost}");
        }
    }
}
