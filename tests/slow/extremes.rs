//! Rays along the axes through the extremes of shapes, where a bounding box that is too small by a rounding error loses
//! hits; by themselves, as copies, and in unions.

use crate::common::model;
use crate::falsify::random::{Point, Random};
use crate::falsify::scenes::numbers;
use crate::falsify::setting;
use crate::oracle::first;
use crate::oracle::number::Number;
use crate::oracle::ray::Ray;
use crate::oracle::text::Scene;
use crate::oracle::wide::Wide;
use glam::DVec3;
use tabray::query::{Query, QueryRay, Verdict};

/// The number of rays of each scene.
const RAYS: usize = 24;

/// Returns the type and the attributes of a shape at a point, and the distances from there at which it ends.
fn shape(random: &mut Random, at: Point) -> (String, Vec<f64>) {
    let mut short = |most: i64| 0.01 * random.whole(1, most);
    let (r, t, h) = (short(300), short(100), short(300));
    let [s, u, v] = [short(200), short(200), short(200)];
    let (place, axis) = (numbers(at), ["1 0 0", "0 1 0", "0 0 1"][random.below(3) as usize]);
    let even = |of: f64| (64.0 * of).ceil() / 64.0;
    match random.below(9) {
        0 => (format!("sphere center {place} radius {r:?}"), vec![r]),
        1 => (
            format!("ellipsoid center {place} radius {r:?} scale {s:?} {u:?} {v:?}"),
            vec![r * s, r * u, r * v],
        ),
        2 | 3 => {
            let (r, t) = (r.max(t), r.min(t));
            let text = format!("torus center {place} direction {axis} radius {r:?} tube {t:?}");
            (text, vec![r + t, r - t, r, t])
        }
        4 => (format!("heart center {place} size {r:?}"), vec![r, 1.5 * r, 1.2 * r]),
        5 => {
            let open = ["yes", "no"][random.below(2) as usize];
            let text =
                format!("cylinder base {place} direction {axis} height {h:?} radius {r:?} open {open}");
            (text, vec![r, h, 0.5 * h])
        }
        6 => (format!("capsule base {place} direction {axis} height {h:?} radius {r:?}"), vec![r, h, h + r]),
        7 => {
            let sides = [even(s), even(u), even(v)];
            (
                format!("box center {} size {}", numbers(at.map(even)), numbers(sides)),
                sides.map(|side| 0.5 * side).to_vec(),
            )
        }
        _ => {
            let text =
                format!("lathe points 0 {r:?}  {h:?} {r:?}  {:?} {s:?} base {place} direction {axis}", h + t);
            (text, vec![r, h, h + t])
        }
    }
}

/// Returns what is wrong with what is found for the rays of a scene, and the number of its rays that are decided.
fn ask(random: &mut Random) -> (Vec<String>, usize) {
    let at = [0; 3].map(|_| if random.once_in(3) { 0.0 } else { 0.01 * random.whole(-300, 300) });
    let (shape, ends) = shape(random, at);
    let (kind, attributes) = shape.split_once(' ').expect("a type and attributes");
    let (scale, moved) =
        ([0; 3].map(|_| 0.01 * random.whole(50, 300)), [0; 3].map(|_| 0.01 * random.whole(-300, 300)));
    let is_placed = random.once_in(3);
    let around = match (is_placed, random.once_in(3) && kind != "lathe" && !attributes.ends_with("yes")) {
        (true, _) => {
            format!("place p {{ object o scale {} translation {} }}", numbers(scale), numbers(moved))
        }
        (_, true) => {
            let other = numbers([0, 1, 2].map(|axis| at[axis] + moved[axis]));
            format!("sphere b {{ material m center {other} radius 0.35 }}\nunion u {{ objects o b }}")
        }
        _ => String::new(),
    };
    let text = format!(
        "look_at eye {{ pixeldim 64 48 position 3 2 9 target 0 0 0 angle 45 }}\nmaterial m {{ ambient 1 1 1 }}\n\
         {kind} o {{ material m {attributes} }}\n{around}\n"
    );
    let (scene, model) = (Scene::read(&text, ""), model(&text));
    let query = Query::new(&model);
    let (mut wrong, mut decided) = (Vec::new(), 0);
    for _ in 0..RAYS {
        let axis = random.below(3) as usize;
        let (mut from, mut dir) = (at, [0.0; 3]);
        for of in 0..3 {
            let end = ends[random.below(ends.len() as u64) as usize];
            match random.below(8) {
                0 => from[of] += random.sign() * end,
                1 => from[of] += random.between(-1.0, 1.0) * end,
                2 => from[of] += random.sign() * end * (1.0 - random.power(-16.0, -1.0)),
                _ => {}
            }
            if is_placed {
                from[of] = from[of] * scale[of] + moved[of];
            }
        }
        let sign = random.sign();
        from[axis] = sign * random.whole(15, 20);
        dir[axis] = -sign;
        let truth = first::first(&scene, &Ray::as_is(&scene, from, dir));
        if truth.is_touch || truth.is_shared {
            continue;
        }
        decided += 1;
        let ray = QueryRay::new(DVec3::from(from), DVec3::from(dir)).expect("a ray");
        let ray = std::slice::from_ref(&ray);
        let answer = query.proven(ray, false)[0];
        let is_right = match (answer.verdict, &truth.place) {
            (Verdict::Miss, place) => place.is_none(),
            (Verdict::Hit, Some(place)) => {
                let [low, high] = [answer.bounds.low, answer.bounds.high].map(Wide::f64);
                ![place.sub(&low).high(), high.sub(place).high()].iter().any(Wide::is_negative)
            }
            (Verdict::Hit, None) => false,
            _ => true,
        };
        let traced = query.traced(ray)[0];
        let is_near = match (traced.verdict, &truth.place) {
            (Verdict::Hit, Some(place)) => (place.near() - traced.t).abs() < 1e-9,
            (verdict, place) => verdict == Verdict::Miss && place.is_none(),
        };
        if !is_right || !is_near {
            let right = truth.place.map_or("a miss".to_owned(), |place| format!("t = {:?}", place.near()));
            wrong.push(format!(
                "# {} {}: {right}; the program: {:?} in [{:?}, {:?}], traced {:?} at {:?}\n{text}",
                numbers(from),
                numbers(dir),
                answer.verdict,
                answer.bounds.low,
                answer.bounds.high,
                traced.verdict,
                traced.t
            ));
        }
    }
    (wrong, decided)
}

#[test]
fn rays_along_the_axes_meet_the_extremes_of_shapes() {
    let (mut wrong, mut decided) = (Vec::new(), 0);
    for number in 0..setting("EXTREMES_SCENES", 20.0) as u64 {
        let (faults, rays) = ask(&mut Random::new("extremes", number));
        wrong.extend(faults);
        decided += rays;
    }
    println!("{decided} rays are decided, {} wrong", wrong.len());
    assert!(wrong.is_empty(), "{} wrong of {decided}, such as\n{}", wrong.len(), wrong[0]);
}
