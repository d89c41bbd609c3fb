//! Rays of any numbers that the doors let in: each gets an answer, and soon.

use crate::common::{load, root};
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::fs;
use std::slice;
use std::time::Duration;
use tabray::query::{Query, QueryRay};
use tabray::tools::clock;

/// The most CPU time for a ray, traced and proven twice. A ray that takes longer is tried thrice, and its least time
/// counts. Parametric surfaces need most, where products overflow in `f64` and 237 bits try all their parts.
const MOST: Duration = Duration::from_secs(1);

/// The number of rays for each entity type's scene, unless the environment's FAR_RAYS says another.
const RAYS: usize = 1000;

#[test]
fn rays_of_any_numbers_have_an_answer_soon() {
    let count = std::env::var("FAR_RAYS").ok().and_then(|text| text.parse().ok()).unwrap_or(RAYS);
    let mut late = Vec::new();
    for entry in fs::read_dir(root().join("scenes/entities")).expect("the folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|ending| ending != "ray") {
            continue;
        }
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let model = load(&path);
        let query = Query::new(&model);
        let mut numbers =
            Pcg64::new(name.bytes().fold(1, |seed, byte| 257 * seed % 65521 + u128::from(byte)), 0);
        let (mut least_of_dearest, mut dearest) = (Duration::ZERO, String::new());
        for _ in 0..count {
            let (ray, end) = draw(&mut numbers);
            let time = || {
                let start = clock::now();
                let traced = query.traced(slice::from_ref(&ray));
                let proven = query.proven(slice::from_ref(&ray), false);
                let within = query.occluded(slice::from_ref(&ray), &[end]);
                assert_eq!([traced.len(), proven.len(), within.len()], [1; 3], "{name}: {ray:?}");
                clock::now() - start
            };
            let mut least = time();
            if least > MOST {
                least = least.min(time()).min(time());
            }
            if least > least_of_dearest {
                (least_of_dearest, dearest) = (least, format!("{ray:?} until {end}"));
            }
        }
        println!("{name:16} {:8.3} ms", 1e3 * least_of_dearest.as_secs_f64());
        if least_of_dearest > MOST {
            late.push(format!("{name}: {least_of_dearest:?}, {dearest}"));
        }
    }
    assert!(late.is_empty(), "{late:#?}");
}

/// Draws a ray that [`QueryRay`] takes, and where it ends. A third of its numbers have any 64 bits, a third are far away
/// or tiny powers of 10, and a third are usual ones.
fn draw(numbers: &mut Pcg64) -> (QueryRay, f64) {
    loop {
        let mut number = || {
            let bits = numbers.next_u64();
            let usual = ((numbers.next_u32() % 2001) as f64 - 1000.0) / 100.0;
            match numbers.next_u32() % 3 {
                0 => f64::from_bits(bits),
                1 => usual * libm::exp10((bits % 617) as f64 - 308.0),
                _ => usual,
            }
        };
        let mut vector = || DVec3::new(number(), number(), number());
        let (origin, dir) = (vector(), vector());
        let end = number();
        if let Some(ray) = QueryRay::new(origin, dir)
            && !end.is_nan()
        {
            return (ray, end);
        }
    }
}
