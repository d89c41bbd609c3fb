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

/// A shape, and where it ends.
struct Extended {
    /// The type and the attributes of the shape, and of the same shape as the oracle knows it.
    text: String,
    known: String,
    /// The distances from its point at which it ends, or has a face.
    ends: Vec<f64>,
    /// Whether it can be a part of a union.
    is_closed: bool,
}

/// Returns a shape at a point.
fn shape(random: &mut Random, at: Point) -> Extended {
    let mut short = |most: i64| 0.01 * random.whole(1, most);
    let (r, t, h) = (short(300), short(100), short(300));
    let [s, u, v] = [short(200), short(200), short(200)];
    let (place, axis) = (numbers(at), ["1 0 0", "0 1 0", "0 0 1"][random.below(3) as usize]);
    let even = |of: f64| (64.0 * of).ceil() / 64.0;
    let (low, sides, corner) = (at.map(even), [s, u, v].map(even), numbers(at.map(even)));
    let closed = |text: String, ends: Vec<f64>| Extended { known: text.clone(), text, ends, is_closed: true };
    let open = |text: String, ends: Vec<f64>| Extended { is_closed: false, ..closed(text, ends) };
    match random.below(20) {
        0 => closed(format!("sphere center {place} radius {r:?}"), vec![r]),
        1 => closed(
            format!("ellipsoid center {place} radius {r:?} scale {s:?} {u:?} {v:?}"),
            vec![r * s, r * u, r * v],
        ),
        2 | 3 => {
            let (r, t) = (r.max(t), r.min(t));
            let text = format!("torus center {place} direction {axis} radius {r:?} tube {t:?}");
            closed(text, vec![r + t, r - t, r, t])
        }
        4 => closed(format!("heart center {place} size {r:?}"), vec![r, 1.5 * r, 1.2 * r]),
        5 => {
            let text = format!("cylinder base {place} direction {axis} height {h:?} radius {r:?} open");
            let ends = vec![r, h, 0.5 * h];
            if random.once_in(2) {
                open(format!("{text} yes"), ends)
            } else {
                closed(format!("{text} no"), ends)
            }
        }
        6 => closed(
            format!("capsule base {place} direction {axis} height {h:?} radius {r:?}"),
            vec![r, h, h + r],
        ),
        7 => closed(
            format!("box center {corner} size {}", numbers(sides)),
            sides.map(|side| 0.5 * side).to_vec(),
        ),
        8 => open(
            format!("lathe points 0 {r:?}  {h:?} {r:?}  {:?} {s:?} base {place} direction {axis}", h + t),
            vec![r, h, h + t],
        ),
        9 => {
            let normal = ["1 0 0", "0 -1 0", "0 0 2", "1 2 -2", "0.3 0 0.4"][random.below(5) as usize];
            open(format!("plane normal {normal} point {place}"), vec![r, t, h])
        }
        10 => {
            let [normal, xdir] =
                [["1 0 0", "0 1 1"], ["0 -2 0", "1 0 0"], ["0 0 1", "3 4 0"]][random.below(3) as usize];
            let text = format!("fplane normal {normal} point {place} xdir {xdir} dimensions {h:?} {r:?}");
            open(text, vec![h, r])
        }
        11 => {
            let [s, u, v] = sides;
            let off = [[0.0; 3], [s, 0.0, v], [0.0, u, random.sign() * v]];
            let [one, two, three] = off.map(|off| numbers([0, 1, 2].map(|axis| low[axis] + off[axis])));
            open(format!("triangle vertex1 {one} vertex2 {two} vertex3 {three}"), sides.to_vec())
        }
        12 => {
            let corners = [[0.0, 0.0], [s, 0.0], [s, u], [0.5 * s, 2.0 * u], [0.0, u]].map(|of| of.map(even));
            let points = corners.map(|[x, z]| numbers([low[0] + x, low[1], low[2] + z])).join("  ");
            open(format!("polygon points {points}"), corners.as_flattened().to_vec())
        }
        13 => {
            let corners = [[0.0, 0.0], [s, 0.0], [s, u], [0.5 * s, 2.0 * u], [0.0, u]].map(|of| of.map(even));
            let points = corners.map(|[x, z]| format!("{x:?} {z:?}")).join("  ");
            let text = format!("prism points {points} base {corner} height {:?} open", even(h));
            let ends = [corners.as_flattened(), &[even(h)]].concat();
            if random.once_in(2) {
                open(format!("{text} yes"), ends)
            } else {
                closed(format!("{text} no"), ends)
            }
        }
        14 => open(format!("disc center {place} normal {axis} radius {r:?}"), vec![r]),
        // An ellipsoid, a cone, a cylinder, a paraboloid, and hyperboloids of both kinds, clipped by their boxes.
        15 | 16 => {
            let [a, b, c] = [s, u, v].map(|side| 1.0 / (side * side));
            let (coefficients, ends) = [
                (format!("{a:?} {b:?} {c:?} 0 0 0 0 0 0 1"), [s, u, v]),
                (format!("{a:?} {:?} {c:?} 0 0 0 0 0 0 0", -b), [s, u, v]),
                (format!("{a:?} 0 {c:?} 0 0 0 0 0 0 1"), [s, u, v]),
                (format!("{a:?} 0 {c:?} 0 0 0 0 1 0 0"), [s, 1.0, v]),
                (format!("{a:?} {:?} {c:?} 0 0 0 0 0 0 1", -b), [s, u, v]),
                (format!("{a:?} {:?} {c:?} 0 0 0 0 0 0 -1", -b), [s, u, v]),
            ][random.below(6) as usize]
                .clone();
            let reach = [0, 1, 2].map(|axis| ends[axis] * [1.0, 1.5, 2.0][random.below(3) as usize]);
            let clip = format!("{} {}", numbers(reach.map(|of| -of)), numbers(reach));
            let text = format!("quadric center {place} coefficients {coefficients} box {clip}");
            open(text, [ends, reach].concat())
        }
        17 | 18 => {
            let (profile, ends) = match random.below(4) {
                0 => (format!("{r:?}"), vec![r]),
                1 => (format!("{r:?} - {:?}*y", 0.5 * r), vec![r, 2.0]),
                2 => (format!("{r:?} + {t:?}*sin(3*y)"), vec![r + t, r]),
                _ => (format!("sqrt(abs({h:?}*y - y^2))"), vec![0.5 * h]),
            };
            let text = format!("revsurf profile \"{profile}\" base {place} direction {axis} height {h:?}");
            open(text, [ends, vec![h, 0.5 * h]].concat())
        }
        // Around a straight line, and more than once around a circle.
        _ if random.once_in(2) => Extended {
            text: format!("tube center {place} x \"0\" y \"t\" z \"0\" t 0 {h:?} radius {r:?}"),
            ..open(
                format!("cylinder base {place} direction 0 1 0 height {h:?} radius {r:?} open yes"),
                vec![r, h],
            )
        },
        _ => {
            let (r, t) = (r.max(t), 0.9 * r.min(t));
            Extended {
                text: format!(
                    "tube center {place} x \"{r:?}*cos(t)\" y \"0\" z \"{r:?}*sin(t)\" t -1 5.5 radius {t:?}"
                ),
                ..open(
                    format!("torus center {place} direction 0 1 0 radius {r:?} tube {t:?}"),
                    vec![r + t, r - t, r, t],
                )
            }
        }
    }
}

/// Returns what is wrong with what is found for the rays of a scene, and the number of its rays that are decided.
fn ask(random: &mut Random) -> (Vec<String>, usize) {
    let at = [0; 3].map(|_| if random.once_in(3) { 0.0 } else { 0.01 * random.whole(-300, 300) });
    let Extended { text, known, ends, is_closed } = shape(random, at);
    let (scale, moved) =
        ([0; 3].map(|_| 0.01 * random.whole(50, 300)), [0; 3].map(|_| 0.01 * random.whole(-300, 300)));
    let is_placed = random.once_in(3);
    let around = match (is_placed, random.once_in(3) && is_closed) {
        (true, _) => {
            format!("place p {{ object o scale {} translation {} }}", numbers(scale), numbers(moved))
        }
        (_, true) => {
            let other = numbers([0, 1, 2].map(|axis| at[axis] + moved[axis]));
            format!("sphere b {{ material m center {other} radius 0.35 }}\nunion u {{ objects o b }}")
        }
        _ => String::new(),
    };
    let scene_of = |shape: &str| {
        let (kind, attributes) = shape.split_once(' ').expect("a type and attributes");
        format!(
            "look_at eye {{ pixeldim 64 48 position 3 2 9 target 0 0 0 angle 45 }}\n\
             material m {{ ambient 1 1 1 }}\n{kind} o {{ material m {attributes} }}\n{around}\n"
        )
    };
    let text = scene_of(&text);
    let (scene, model) = (Scene::read(&scene_of(&known), ""), model(&text));
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
