//! The table of self-intersections: rays that leave a surface of revolution, as shadow rays and reflected rays do.

use super::profiles::{Line, NASTY, VASE};
use super::{Random, distance};
use glam::{DVec3, dvec3};
use tabray::geometry::{MISS, Ray, RayRange, Side};
use tabray::world::Hittable;

/// The point where a camera ray met a surface from outside, as computed from its distance and direction, and the
/// direction of a ray that starts there.
struct Start {
    point: DVec3,
    dir: DVec3,
}

/// Returns 5000 starts on a surface, half of them shallow. The camera of the course's scene is moved away by a factor.
fn starts(line: &Line, shape: &dyn Hittable, away: f64) -> Vec<Start> {
    let mut random = Random(9);
    let mut found = Vec::new();
    while found.len() < 5_000 {
        let target = dvec3(random.between(-4.0, 4.0), random.between(0.0, 6.0), 4.0);
        let dir = (target - dvec3(0.0, 3.0, 11.0)).normalize();
        let eye = dvec3(0.0, 3.0, 11.0) - (away - 1.0) * dir;
        let hit = distance(shape, eye, dir);
        let point = eye + hit * dir;
        if hit == MISS || point.y < 0.01 || point.y > line.height - 0.01 {
            continue;
        }
        let normal = line.normal(point);
        let cosine = if random.whole(0, 1) == 0 {
            random.between(0.0, 1.0)
        } else {
            10_f64.powf(-random.between(0.0, 4.0))
        };
        if normal.dot(dir) < 0.0 {
            found.push(Start { point, dir: random.around(normal, cosine) });
        }
    }
    found
}

/// Returns the distance of the next hit of a ray that leaves the shape on the outside.
fn next(shape: &dyn Hittable, start: &Start) -> f64 {
    let ray = Ray { origin: start.point, dir: start.dir };
    shape.distance(&ray, &RayRange { origin_side: Some(Side::Outside), ..RayRange::ALL })
}

/// Returns the first of many samples of a ray that lies inside although the sample before it lies outside: a certain
/// hit, if not the first. The start is off the surface by the rounding error of its distance, and the samples begin
/// beyond that.
fn sampled(line: &Line, start: &Start) -> Option<f64> {
    const SAMPLES: usize = 1_000;
    let [_, far] = line.bounds(start.point, start.dir)?;
    let outside = |sample: usize| {
        // The samples are close together near the start, where the surface is near.
        let part = sample as f64 / SAMPLES as f64;
        line.outside(start.point + 1e-3_f64.max(far * part * part) * start.dir) > 0.0
    };
    let entered = (1..SAMPLES).find(|sample| outside(*sample) && !outside(sample + 1))?;
    Some(far * ((entered + 1) as f64 / SAMPLES as f64).powi(2))
}

/// Asserts that rays that leave a surface meet only what is there. Starts lie up to `rounding` from the surface.
fn leaves_without_meeting_itself(line: &Line, away: f64, rounding: f64) {
    let shape = line.shape();
    assert!(shape.can_hit_itself(Side::Outside), "a surface of revolution can meet what leaves it");
    let starts = starts(line, &*shape, away);
    let (mut judged_inside, mut again) = (0, 0);
    let (mut met_itself, mut lost) = (Vec::new(), Vec::new());
    for start in &starts {
        // The naive form takes the sign of the function at the start for the side on which the ray starts.
        judged_inside += u32::from(line.outside(start.point) < 0.0);
        let hit = next(&*shape, start);
        let told = format!("{hit} from {:?} along {:?}", start.point.to_array(), start.dir.to_array());
        // A true hit comes from outside: halfway to it, the ray is outside the surface by more than rounding.
        let half_way = line.outside(start.point + 0.5 * hit * start.dir);
        if hit < MISS && (hit <= 0.0 || half_way <= -rounding || (hit < 1e-3 && half_way <= rounding)) {
            met_itself.push(told.clone());
        }
        if let Some(sampled) = sampled(line, start) {
            again += 1;
            if hit > sampled {
                lost.push(format!("{told}, a hit at {sampled}"));
            }
        }
    }
    assert!(judged_inside > 1_000, "{judged_inside} judged inside");
    assert!(again > 100, "skipping the object loses {again}");
    assert!(met_itself.is_empty(), "{} meet themselves:\n{}", met_itself.len(), met_itself.join("\n"));
    assert!(lost.is_empty(), "{} are lost:\n{}", lost.len(), lost.join("\n"));
}

#[test]
fn a_ray_that_leaves_the_vase_meets_only_what_is_there() {
    leaves_without_meeting_itself(&VASE, 1.0, 1e-14);
}

#[test]
fn a_ray_that_leaves_ripples_meets_only_what_is_there() {
    leaves_without_meeting_itself(&NASTY, 1.0, 1e-14);
}

/// From so far away, a hit is rounded to 1e-9.
#[test]
fn a_ray_that_leaves_a_far_vase_meets_only_what_is_there() {
    leaves_without_meeting_itself(&VASE, 1e6, 1e-8);
}

/// Rays leave the inner wall of a pipe inward. Seen from outside, the pipe is convex; from inside, rays meet the
/// opposite wall.
#[test]
fn a_ray_that_leaves_the_inner_wall_meets_the_opposite_one() {
    let pipe = super::profiles::revsurf("", "profile \"1\"", 6.0);
    let mut random = Random(10);
    for _ in 0..2_000 {
        let turn = random.between(0.0, std::f64::consts::TAU);
        let inward = dvec3(-turn.cos(), 0.0, -turn.sin());
        let point = dvec3(turn.cos(), 3.0, turn.sin());
        let cosine = random.between(0.3, 1.0);
        let along = dvec3(-inward.z, 0.0, inward.x);
        let dir = cosine * inward + (1.0 - cosine * cosine).sqrt() * along;
        let range = |side| RayRange { origin_side: Some(side), ..RayRange::ALL };
        let ray = Ray { origin: point, dir };
        let across = pipe.distance(&ray, &range(Side::Inside));
        assert!((across - 2.0 * cosine).abs() < 1e-14, "{across} is not {}", 2.0 * cosine);
        let outward = Ray { origin: point, dir: -dir };
        assert_eq!(pipe.distance(&outward, &range(Side::Outside)), MISS, "from {point} along {}", -dir);
    }
}
