//! What rays that leave a surface see: the same sphere as each shape that can be one, and surfaces that coincide or
//! touch.

use super::program::Program;
use super::random::{Point, Random, cross, dot, moved, unit};
use super::scenes::numbers;
use tabray::render::Renderer;
use tabray::tools::threads::renderer_with;

/// A kind of scene, and the function that checks the image of a random scene of it.
struct Kind {
    name: &'static str,
    look: fn(&mut Random, &Renderer) -> Looks,
}

/// The number of pixels that were checked, the number of those that are wrong, and the scene.
struct Looks {
    pixels: usize,
    wrong: usize,
    text: String,
}

const KINDS: [Kind; 6] = [
    Kind { name: "closed balls, lamps outside", look: leak },
    Kind { name: "mirror balls from inside", look: mirror },
    Kind { name: "glass balls", look: glass },
    Kind { name: "rugs on a floor", look: rug },
    Kind { name: "floor and wall", look: seam },
    Kind { name: "edges on a plane", look: edge },
];

/// Checks `scenes` scenes of each kind. Returns a message for each kind in which something is wrong.
pub fn all(scenes: u64) -> Vec<String> {
    let renderer = renderer_with(0).expect("threads");
    println!("| scenes | pictures | pixels | wrong |\n|---|--:|--:|--:|");
    let mut faults = Vec::new();
    for kind in &KINDS {
        let (mut pixels, mut wrong, mut worst) = (0, 0, None);
        for number in 0..scenes {
            let looks = (kind.look)(&mut Random::new(kind.name, number), &renderer);
            pixels += looks.pixels;
            wrong += looks.wrong;
            if looks.wrong > 0 && worst.is_none() {
                worst = Some(looks.text);
            }
        }
        println!("| {} | {scenes} | {pixels} | {wrong} |", kind.name);
        if let Some(text) = worst {
            faults.push(format!("{}: {wrong} of {pixels} pixels, the first in\n{text}", kind.name));
        }
    }
    faults
}

fn picture(text: &str, renderer: &Renderer) -> Vec<[u8; 3]> {
    Program::read(text, "").unwrap_or_else(|| panic!("refused:\n{text}")).picture(renderer)
}

/// Returns the text of a sphere as each shape that can be one.
fn balls(center: Point, radius: f64) -> [String; 5] {
    let at = numbers(center);
    let foot = numbers(moved(center, -radius, [0.0, 1.0, 0.0]));
    [
        format!("sphere ball {{ material m center {at} radius {radius:?} }}"),
        // The shader changes only the ambient colour, and the material has none.
        format!("psphere ball {{ material m center {at} radius {radius:?} shader tiles }}"),
        format!("ellipsoid ball {{ material m center {at} radius {radius:?} scale 1 1 1 }}"),
        format!(
            "quadric ball {{ material m coefficients 1 1 1 0 0 0 0 0 0 {:?} center {at} box {} }}",
            radius * radius,
            numbers([-2.0, -2.0, -2.0, 2.0, 2.0, 2.0].map(|side| side * radius)),
        ),
        format!(
            "revsurf ball {{ material m profile \"sqrt(max(0, {r:?}^2 - (y - {r:?})^2))\" base {foot} direction 0 1 0 height {:?} }}",
            2.0 * radius,
            r = radius,
        ),
    ]
}

/// Counts the pixels in which images of the same sphere differ. At its rim, where rounding decides, 1 of 500 may.
fn same_looks(before: &str, center: Point, radius: f64, renderer: &Renderer) -> Looks {
    let texts = balls(center, radius).map(|ball| format!("{before}{ball}\n"));
    let [first, others @ ..] = &texts;
    let truth = picture(first, renderer);
    let mut looks = Looks { pixels: 0, wrong: 0, text: String::new() };
    for text in others {
        let seen = picture(text, renderer);
        let is_off = |(one, other): &(&[u8; 3], &[u8; 3])| {
            (0..3).any(|channel| one[channel].abs_diff(other[channel]) > 1)
        };
        let off = truth.iter().zip(&seen).filter(is_off).count();
        looks.pixels += seen.len();
        if off > seen.len() / 500 {
            looks.wrong += off;
            looks.text = format!("{first}# and\n{text}");
        }
    }
    looks
}

fn camera(screen: f64, eye: Point) -> String {
    format!(
        "camera eye {{ pixeldim 41 31 worlddim {screen:?} {:?} viewpoint {} }}\n",
        0.75 * screen,
        numbers(eye)
    )
}

/// Rounds a number to hundredths.
fn round(number: f64) -> f64 {
    (number * 100.0).round() / 100.0
}

/// Checks a closed sphere around the viewer, with a lamp outside or inside.
fn leak(random: &mut Random, renderer: &Renderer) -> Looks {
    let eye = [2.0, 1.5, 1.0];
    let radius = round(random.between(1.5, 4.0));
    let center = moved(eye, random.between(0.0, 0.9) * radius, random.direction()).map(round);
    let away = radius * if random.once_in(3) { random.between(0.1, 0.9) } else { random.between(1.1, 3.0) };
    let lamp = moved(center, away, random.direction());
    let before = format!(
        "{}material m {{ diffuse 1 1 1 }}\nlight lamp {{ location {} emissivity 40 40 40 }}\n",
        camera(4.0, eye),
        numbers(lamp),
    );
    let mut looks = same_looks(&before, center, radius, renderer);
    if away > radius {
        // No light enters the sphere.
        let text = format!("{before}{}\n", balls(center, radius)[0]);
        let lit = picture(&text, renderer).iter().filter(|seen| **seen != [0; 3]).count();
        if lit > 0 {
            looks.wrong += lit;
            looks.text = text;
        }
    }
    looks
}

fn mirror(random: &mut Random, renderer: &Renderer) -> Looks {
    let eye = [2.0, 1.5, 1.0];
    let radius = round(random.between(1.0, 3.0));
    let center = moved(eye, random.between(0.1, 0.8) * radius, random.direction()).map(round);
    let before = format!(
        "{}material m {{ specular {:?} diffuse 0.5 0.4 0.3 }}\nlight lamp {{ location {} emissivity 3 3 3 }}\n",
        camera(4.0, eye),
        round(random.between(0.2, 0.9)),
        numbers(moved(center, 0.5 * radius, random.direction())),
    );
    same_looks(&before, center, radius, renderer)
}

fn glass(random: &mut Random, renderer: &Renderer) -> Looks {
    let radius = round(random.between(0.5, 2.0));
    let center = [random.between(2.5, 5.5), random.between(2.0, 4.0), random.between(-5.0, -3.0)].map(round);
    let before = format!(
        "{}material m {{ diffuse 0.5 0.8 1 transparency {:?} }}\nmaterial wall {{ ambient 5 4 3 diffuse 2 2 2 }}\n\
         plane back {{ material wall normal 0 0 1 point 0 0 -8 }}\nlight lamp {{ location 2 7 1 emissivity 9 9 9 }}\n",
        camera(8.0, [4.0, 3.0, 6.0]),
        round(random.between(0.2, 0.9)),
    );
    same_looks(&before, center, radius, renderer)
}

/// Returns a direction of small integers that points up and toward the viewer.
fn slope(random: &mut Random) -> Point {
    [random.whole(-2, 2), random.whole(1, 4), random.whole(0, 3)]
}

/// Counts every black pixel of an object as wrong, for a scene whose visible surfaces are all lit and have no shadows.
fn black(text: String, renderer: &Renderer) -> Looks {
    dark(text, renderer, |_, _| true)
}

/// Counts each black pixel between two lit pixels as wrong, for a scene with shadows, which are wider than a pixel.
fn dots(text: String, renderer: &Renderer) -> Looks {
    dark(text, renderer, |[x, y], is_black| {
        let is_lit = |x: usize, y: usize| !is_black(x, y);
        is_lit(x.wrapping_sub(1), y) && is_lit(x + 1, y) || is_lit(x, y.wrapping_sub(1)) && is_lit(x, y + 1)
    })
}

/// Counts the pixels that show an object and are black but should not be. Pixels outside the image count as black.
fn dark(
    text: String,
    renderer: &Renderer,
    is_wrong: impl Fn([usize; 2], &dyn Fn(usize, usize) -> bool) -> bool,
) -> Looks {
    let program = Program::read(&text, "").unwrap_or_else(|| panic!("refused:\n{text}"));
    let (seen, [width, height]) = (program.picture(renderer), program.size());
    let is_black = |x: usize, y: usize| x >= width || y >= height || seen[y * width + x] == [0; 3];
    let mut looks = Looks { pixels: 0, wrong: 0, text };
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        if program.find([x, height - 1 - y]).first.is_some() {
            looks.pixels += 1;
            looks.wrong += usize::from(is_black(x, y) && is_wrong([x, y], &is_black));
        }
    }
    looks
}

const LIT: &str = "material white { diffuse 9e9 9e9 9e9 }\nmaterial red { diffuse 9e9 0 0 }\n";

fn rug(random: &mut Random, renderer: &Renderer) -> Looks {
    let n = slope(random);
    let point = [random.whole(0, 8), random.whole(-2, 1), random.whole(-6, -2)];
    let along = if n[0] == 0.0 && n[1] == 0.0 { [1.0, 0.0, 0.0] } else { [n[1], -n[0], 0.0] };
    let corner = moved(point, random.whole(-2, 2), along);
    let size = [random.whole(2, 6), random.whole(2, 6)];
    let eye = [4.0, 3.0, 6.0];
    // The lamp is above the floor, on its lit side.
    let lamp = moved(moved(point, random.between(1.0, 6.0), unit(n)), random.between(0.0, 3.0), unit(along));
    let text = format!(
        "{}{LIT}fplane rug {{ material red normal {n} point {} xdir {} dimensions {} }}\n\
         plane floor {{ material white normal {n} point {} }}\nlight lamp {{ location {} emissivity 60 60 60 }}\n",
        camera(8.0, eye),
        numbers(corner),
        numbers(along),
        numbers(size),
        numbers(point),
        numbers(lamp),
        n = numbers(n),
    );
    black(text, renderer)
}

/// Checks two planes that both face the viewer and the lamp.
fn seam(random: &mut Random, renderer: &Renderer) -> Looks {
    let eye = [4.0, 3.5, 5.0];
    let part = |random: &mut Random| round(random.between(-0.3, 0.3));
    let floor = [part(random), 1.0, part(random)];
    let wall = [part(random), part(random), 1.0];
    let [on_floor, on_wall] =
        [[4.0, round(random.between(-1.0, 1.0)), 0.0], [4.0, 0.0, -round(random.between(3.0, 9.0))]];
    let above =
        |at: Point, n: Point, point: Point| dot([0, 1, 2].map(|axis| at[axis] - point[axis]), n) > 0.1;
    let lamp = loop {
        let lamp = [random.between(0.0, 8.0), random.between(0.0, 8.0), random.between(-8.0, 4.0)];
        if above(lamp, floor, on_floor) && above(lamp, wall, on_wall) {
            break lamp;
        }
    };
    if !(above(eye, floor, on_floor) && above(eye, wall, on_wall)) {
        return seam(random, renderer);
    }
    let text = format!(
        "{}{LIT}plane floor {{ material white normal {} point {} }}\nplane wall {{ material red normal {} point {} }}\n\
         light lamp {{ location {} emissivity 60 60 60 }}\n",
        camera(8.0, eye).replace("41 31", "161 121"),
        numbers(floor),
        numbers(on_floor),
        numbers(wall),
        numbers(on_wall),
        numbers(lamp),
    );
    // Planes are not hit in front of the image plane. Through the unseen part of the floor, one sees the shadow of the
    // rest of the floor.
    dots(text, renderer)
}

/// Checks a triangle that stands on a floor with one edge.
fn edge(random: &mut Random, renderer: &Renderer) -> Looks {
    let n = slope(random);
    let point = [4.0, random.whole(-1, 0), random.whole(-6, -3)];
    let along = [n[1], -n[0], 0.0];
    let one = moved(point, -1.0, along);
    let two = moved(point, random.whole(1, 2), along);
    let back = cross(along, n);
    let back = if back[2] > 0.0 { back.map(|part| -part) } else { back };
    let up = unit(n);
    let top = moved(moved(point, random.between(1.0, 3.0), up), random.between(0.1, 1.0), unit(back));
    // The lit side faces the viewer, from whom its vertices are counterclockwise.
    let eye = [4.0, 3.0, 6.0];
    let sub = |a: Point, b: Point| [0, 1, 2].map(|axis| a[axis] - b[axis]);
    if dot(sub(eye, point), n) < 0.1 {
        return edge(random, renderer);
    }
    let faces = dot(cross(sub(two, one), sub(top, one)), sub(eye, one)) > 0.0;
    let [first, second] = if faces { [one, two] } else { [two, one] };
    // A lamp at the viewer's position lights everything that is seen.
    let text = format!(
        "{}{LIT}triangle flag {{ material red vertex1 {} vertex2 {} vertex3 {} }}\n\
         plane floor {{ material white normal {} point {} }}\nlight lamp {{ location {} emissivity 60 60 60 }}\n",
        camera(8.0, eye).replace("41 31", "161 121"),
        numbers(first),
        numbers(second),
        numbers(top),
        numbers(n),
        numbers(point),
        numbers(eye),
    );
    black(text, renderer)
}
