//! Scenes parsed from their text, without any code of the program.

use super::dyadic::Dyadic;
use super::formula::Formula;
use super::place::{self, BITS, Place};
use super::ray::{cross, dot, minus, times};
use super::spline::Spline;
use std::collections::HashMap;
use std::rc::Rc;

/// A point or a direction.
pub type Vector = [Dyadic; 3];

/// The part of a scene that first hits depend on.
pub struct Scene {
    pub pixels: [i64; 2],
    pub view: View,
    pub eye: Vector,
    /// The objects that are seen where they are, not only where they are placed.
    pub objects: Vec<Rc<Shape>>,
}

/// What the viewer looks through.
pub enum View {
    /// The rectangle at z = 0 of this width and height, from the world's origin on. It cuts planes off.
    Screen([Dyadic; 2]),
    /// An image around the line of sight: the vector to its middle, and from there to the middle of its right edge and as
    /// far up.
    Ahead(Box<[Vector; 3]>),
}

/// An object, with its numbers as the text has them.
pub enum Shape {
    Plane {
        normal: Vector,
        point: Vector,
        sides: Option<Sides>,
    },
    Triangle {
        corners: [Vector; 3],
    },
    /// An ellipsoid with half axes `radius * scale`.
    Ball {
        center: Vector,
        radius: Dyadic,
        scale: Vector,
    },
    Quadric {
        coefficients: Vec<Dyadic>,
        center: Vector,
        low: Vector,
        high: Vector,
    },
    Revolved {
        profile: Formula,
        /// An upper bound of the profile.
        widest: f64,
        direction: Vector,
        base: Vector,
        height: Dyadic,
    },
    Torus {
        center: Vector,
        direction: Vector,
        radius: Dyadic,
        tube: Dyadic,
    },
    Heart {
        center: Vector,
        size: Dyadic,
    },
    /// The points where a formula is 0 and others are not negative, in coordinates from `own` on.
    Formula {
        own: Vector,
        /// If there is an axis, y is the height along it and x the squared distance from it.
        axis: Option<Vector>,
        formula: Formula,
        kept: Vec<Formula>,
        /// The middle of the shape, from `own` on, and an upper bound of the distance of its points from there.
        middle: Vector,
        reach: f64,
    },
    /// Triangles, of a closed surface or not.
    Mesh {
        faces: Vec<[Vector; 3]>,
    },
    Placed {
        shape: Rc<Shape>,
        place: Place,
    },
    /// Closed shapes, combined. Each has its own material, unless all have one.
    Combined {
        operation: Operation,
        shapes: Vec<Rc<Shape>>,
        is_one: bool,
    },
}

impl Shape {
    fn revolved(profile: Formula, direction: Vector, base: Vector, height: Dyadic) -> Self {
        Self::Revolved { widest: profile.most_up_to(height.to_f64(true)), profile, direction, base, height }
    }
}

impl View {
    /// `degrees` is the angle at which the width of the image is seen.
    fn ahead(forward: Vector, up: &Vector, degrees: &Dyadic) -> Self {
        let right = cross(&forward, up);
        let [far, wide] = [&forward, &right].map(|of| dot(of, of).root(BITS, false));
        let [sin, cos] = place::sin_cos(&degrees.shifted(-1));
        let half = sin.divided(&cos, BITS, false);
        let up = times(&cross(&right, &forward), &half.divided(&wide, BITS, false));
        let right = times(&right, &half.mul(&far).divided(&wide, BITS, false));
        Self::Ahead(Box::new([forward, right, up]))
    }
}

#[derive(Clone, Copy)]
pub enum Operation {
    Union,
    Intersection,
    Difference,
}

/// The sides of a rectangle.
pub struct Sides {
    pub xdir: Vector,
    pub dimensions: [Dyadic; 2],
}

struct Attributes<'t>(HashMap<&'t str, Vec<&'t str>>);

impl Attributes<'_> {
    fn numbers(&self, name: &str) -> Option<Vec<Dyadic>> {
        let number =
            |word: &&str| Dyadic::from(word.parse().unwrap_or_else(|_| panic!("`{word}` of {name}")));
        self.0.get(name).map(|words| words.iter().map(number).collect())
    }

    fn vector_or(&self, name: &str, default: [i64; 3]) -> Vector {
        self.numbers(name).map_or(default.map(Dyadic::int), |all| all.try_into().expect("three numbers"))
    }

    fn vector(&self, name: &str) -> Vector {
        self.numbers(name).unwrap_or_else(|| panic!("no {name}")).try_into().expect("three numbers")
    }

    fn number(&self, name: &str) -> Dyadic {
        self.numbers(name).unwrap_or_else(|| panic!("no {name}"))[0].clone()
    }

    fn pair(&self, name: &str) -> [Dyadic; 2] {
        self.numbers(name).unwrap_or_else(|| panic!("no {name}")).try_into().expect("two numbers")
    }
}

/// Splits a text into words, braces and the contents of quotation marks.
fn words(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    for line in text.lines() {
        let mut rest = line.split('#').next().unwrap_or_default().trim_start();
        while !rest.is_empty() {
            let (word, after) = match rest.as_bytes()[0] {
                b'{' | b'}' => rest.split_at(1),
                b'"' => {
                    let (word, after) = rest[1..].split_once('"').expect("the end of what is quoted");
                    (word, after)
                }
                _ => rest.split_at(rest.find([' ', '\t', '{', '}']).unwrap_or(rest.len())),
            };
            found.push(word);
            rest = after.trim_start();
        }
    }
    found
}

/// The notes' profiles, in the order of their numbers.
const SURFERS: [&str; 4] = ["2 + sin(y)", "-4/6 * (y - 6)", "1 + 0.5 * cos(y)", "1 + 0.5 * sin(y)"];

const ATTRIBUTES: [&str; 43] = [
    "objects",
    "formula",
    "points",
    "open",
    "pixeldim",
    "worlddim",
    "viewpoint",
    "position",
    "target",
    "up",
    "angle",
    "samples",
    "ambient",
    "diffuse",
    "specular",
    "shininess",
    "transparency",
    "material",
    "normal",
    "point",
    "xdir",
    "dimensions",
    "vertex1",
    "vertex2",
    "vertex3",
    "center",
    "radius",
    "scale",
    "coefficients",
    "box",
    "surfer",
    "profile",
    "direction",
    "base",
    "height",
    "tube",
    "size",
    "shader",
    "file",
    "smooth",
    "object",
    "rotation",
    "translation",
];

/// Returns the faces of an OBJ file.
fn faces(text: &str) -> Vec<[Vector; 3]> {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split(' ');
        let kind = words.next();
        let mut three = || [0; 3].map(|_| words.next().expect("three numbers"));
        match kind {
            Some("v") => {
                points.push(three().map(|word| Dyadic::from(word.parse().expect("a number"))));
            }
            Some("f") => faces.push(three().map(|word| word.parse::<usize>().expect("an index") - 1)),
            _ => panic!("`{line}` is neither a vertex nor a face"),
        }
    }
    faces.into_iter().map(|face: [usize; 3]| face.map(|corner| points[corner].clone())).collect()
}

/// Returns the triangles of a convex polygon in x and z, extended from one height to another.
fn prism(corners: &[[Dyadic; 2]], [low, high]: [Dyadic; 2], is_open: bool) -> Vec<[Vector; 3]> {
    let count = corners.len();
    let at = |corner: usize, y: &Dyadic| {
        let [x, z] = &corners[corner % count];
        [x.clone(), y.clone(), z.clone()]
    };
    let mut faces = Vec::new();
    for corner in 0..count {
        let next = corner + 1;
        faces.push([at(corner, &low), at(corner, &high), at(next, &high)]);
        faces.push([at(corner, &low), at(next, &high), at(next, &low)]);
        if !is_open && corner > 0 && next < count {
            faces.push([at(0, &low), at(corner, &low), at(next, &low)]);
            faces.push([at(0, &high), at(next, &high), at(corner, &high)]);
        }
    }
    faces
}

impl Scene {
    /// Reads a scene; `mesh` is the text of its mesh's file.
    pub fn read(text: &str, mesh: &str) -> Self {
        let words = words(text);
        let mut named: HashMap<&str, (Rc<Shape>, bool)> = HashMap::new();
        let mut order = Vec::new();
        let mut scene = Self {
            pixels: [1, 1],
            view: View::Screen([8, 6].map(Dyadic::int)),
            eye: [4, 3, 6].map(Dyadic::int),
            objects: Vec::new(),
        };
        let mut at = 0;
        while at < words.len() {
            let kind = words[at];
            let name = words[at + 1];
            while words[at] != "{" {
                at += 1;
            }
            at += 1;
            let mut attributes = Attributes(HashMap::new());
            while words[at] != "}" {
                let name = words[at];
                assert!(ATTRIBUTES.contains(&name), "an attribute, not `{name}`");
                at += 1;
                let start = at;
                while words[at] != "}" && (at == start || !ATTRIBUTES.contains(&words[at])) {
                    at += 1;
                }
                attributes.0.insert(name, words[start..at].to_vec());
            }
            at += 1;
            let object = attributes.0.get("object").map(|object| {
                let (shape, is_seen) = named.get_mut(object[0]).expect("an object");
                *is_seen = false;
                shape.clone()
            });
            if let Some(names) = attributes.0.get("objects") {
                let one = |name: &&str| {
                    let (shape, is_seen) = named.get_mut(*name).expect("an object");
                    *is_seen = false;
                    shape.clone()
                };
                let shapes = names.iter().map(one).collect();
                let operation = match kind {
                    "union" => Operation::Union,
                    "intersection" => Operation::Intersection,
                    _ => Operation::Difference,
                };
                let is_one = attributes.0.contains_key("material");
                named.insert(name, (Rc::new(Shape::Combined { operation, shapes, is_one }), true));
                order.push(name);
            } else if let Some(shape) = scene.shape(kind, &attributes, mesh, object) {
                named.insert(name, (Rc::new(shape), true));
                order.push(name);
            }
        }
        scene.objects =
            order.iter().map(|name| &named[name]).filter(|of| of.1).map(|of| of.0.clone()).collect();
        scene
    }

    /// Returns the shape of an entity, if it is an object; `object` is the one that it refers to.
    fn shape(&mut self, kind: &str, a: &Attributes, mesh: &str, object: Option<Rc<Shape>>) -> Option<Shape> {
        Some(match kind {
            "camera" => {
                self.pixels = a.pair("pixeldim").map(|side| side.to_f64(false) as i64);
                self.view = View::Screen(a.pair("worlddim"));
                self.eye = a.vector("viewpoint");
                return None;
            }
            "look_at" => {
                self.pixels = a.pair("pixeldim").map(|side| side.to_f64(false) as i64);
                self.eye = a.vector("position");
                let forward = minus(&a.vector("target"), &self.eye);
                self.view = View::ahead(forward, &a.vector_or("up", [0, 1, 0]), &a.number("angle"));
                return None;
            }
            "material" | "light" => return None,
            "mesh" => Shape::Mesh { faces: faces(mesh) },
            "place" => Shape::Placed {
                shape: object.expect("an object"),
                place: Place::new(
                    a.vector_or("scale", [1, 1, 1]),
                    &a.vector_or("rotation", [0, 0, 0]),
                    a.vector_or("translation", [0, 0, 0]),
                ),
            },
            "plane" => Shape::Plane { normal: a.vector("normal"), point: a.vector("point"), sides: None },
            "fplane" => Shape::Plane {
                normal: a.vector("normal"),
                point: a.vector("point"),
                sides: Some(Sides { xdir: a.vector("xdir"), dimensions: a.pair("dimensions") }),
            },
            "triangle" => {
                Shape::Triangle { corners: ["vertex1", "vertex2", "vertex3"].map(|name| a.vector(name)) }
            }
            "sphere" | "psphere" | "ellipsoid" => Shape::Ball {
                center: a.vector("center"),
                radius: a.number("radius"),
                scale: a.vector_or("scale", [1, 1, 1]),
            },
            "quadric" => {
                let ends = a.numbers("box").unwrap_or_else(|| {
                    [-1, -1, -1, 1, 1, 1].map(|side| Dyadic::int(side * 1_000_000_000)).to_vec()
                });
                let corner = |from: usize| [0, 1, 2].map(|axis| ends[from + axis].clone());
                Shape::Quadric {
                    coefficients: a.numbers("coefficients").expect("coefficients"),
                    center: a.vector_or("center", [0, 0, 0]),
                    low: corner(0),
                    high: corner(3),
                }
            }
            "revsurf" => {
                let profile = match a.0.get("profile") {
                    Some(text) => Formula::read(text[0]),
                    None => Formula::read(SURFERS[a.number("surfer").to_f64(false) as usize]),
                };
                Shape::revolved(profile, a.vector("direction"), a.vector("base"), a.number("height"))
            }
            "torus" => Shape::Torus {
                center: a.vector("center"),
                direction: a.vector_or("direction", [0, 1, 0]),
                radius: a.number("radius"),
                tube: a.number("tube"),
            },
            "implicit" => {
                let ends = a.numbers("box").expect("a box");
                let kept = |end: usize| {
                    let variable = Formula::Variable(end % 3);
                    let inward = if end < 3 { variable } else { Formula::Neg(Box::new(variable)) };
                    inward.plus(if end < 3 { ends[end].neg() } else { ends[end].clone() })
                };
                let corner = |from: usize| [0, 1, 2].map(|axis| ends[from + axis].to_f64(true));
                let (low, high) = (corner(0), corner(3));
                let half = [0, 1, 2].map(|axis| 0.51 * (high[axis] - low[axis]));
                Shape::Formula {
                    own: a.vector_or("center", [0, 0, 0]),
                    axis: None,
                    formula: Formula::read(a.0["formula"][0]),
                    kept: (0..6).map(kept).collect(),
                    middle: [0, 1, 2].map(|axis| Dyadic::from(0.5 * (low[axis] + high[axis]))),
                    reach: half.iter().map(|side| side * side).sum::<f64>().sqrt(),
                }
            }
            "cylinder" | "capsule" | "disc" => {
                let [square, height] = [|| Formula::Variable(0), || Formula::Variable(1)];
                let radius = a.number("radius");
                let axis = a.vector_or(if kind == "disc" { "normal" } else { "direction" }, [0, 1, 0]);
                let length = if kind == "disc" { Dyadic::zero() } else { a.number("height") };
                let two =
                    |sign: char, one: Formula, other: Formula| Formula::Two(sign, Box::new([one, other]));
                let wall = square().plus(radius.square().neg());
                let above = height().plus(length.neg());
                let below = Formula::Neg(Box::new(above.clone()));
                let is_open = a.0.get("open").is_some_and(|open| open[0] == "yes");
                let (formula, kept) = match kind {
                    "disc" => (height(), vec![Formula::Neg(Box::new(wall))]),
                    "cylinder" if is_open => (wall, vec![height(), below]),
                    "cylinder" => {
                        (Formula::Call("max".to_owned(), vec![wall, two('*', height(), above)]), Vec::new())
                    }
                    _ => {
                        let zero = || Formula::Number(Dyadic::zero().into());
                        let under = Formula::Call("min".to_owned(), vec![height(), zero()]);
                        let over = Formula::Call("max".to_owned(), vec![above, zero()]);
                        let square = |of| Formula::Whole(Box::new(of), 2);
                        (two('+', wall, two('+', square(under), square(over))), Vec::new())
                    }
                };
                let along = 0.5 * length.to_f64(true);
                let lengths = axis.each_ref().map(|part| part.to_f64(false));
                let most = lengths.iter().map(|part| part * part).sum::<f64>().sqrt();
                Shape::Formula {
                    own: a.vector(if kind == "disc" { "center" } else { "base" }),
                    middle: lengths.map(|part| Dyadic::from(part / most * along)),
                    axis: Some(axis),
                    formula,
                    kept,
                    reach: 1.1 * (along + radius.to_f64(true)),
                }
            }
            "lathe" => {
                let points = a.numbers("points").expect("points");
                let points: Vec<_> = points.chunks(2).map(|two| [two[0].clone(), two[1].clone()]).collect();
                let profile = Formula::Spline(Spline::new(&points));
                let height = points[points.len() - 1][0].clone();
                Shape::revolved(profile, a.vector_or("direction", [0, 1, 0]), a.vector("base"), height)
            }
            "box" => {
                let (center, size) = (a.vector("center"), a.vector("size"));
                let end = |axis: usize, sign: i64| {
                    center[axis].add(&size[axis].shifted(-1).mul(&Dyadic::int(sign)))
                };
                let corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
                let corners = corners.map(|[x, z]| [end(0, x), end(2, z)]);
                Shape::Mesh { faces: prism(&corners, [end(1, -1), end(1, 1)], false) }
            }
            "polygon" => {
                let points = a.numbers("points").expect("points");
                let corner = |index: usize| [0, 1, 2].map(|axis: usize| points[3 * index + axis].clone());
                let faces = (1..points.len() / 3 - 1).map(|index| [0, index, index + 1].map(corner));
                Shape::Mesh { faces: faces.collect() }
            }
            "prism" => {
                let base = a.vector_or("base", [0, 0, 0]);
                let points = a.numbers("points").expect("points");
                let corners = points.chunks(2).map(|two| [two[0].add(&base[0]), two[1].add(&base[2])]);
                let ends = [base[1].clone(), base[1].add(&a.number("height"))];
                let is_open = a.0.get("open").is_some_and(|open| open[0] == "yes");
                Shape::Mesh { faces: prism(&corners.collect::<Vec<_>>(), ends, is_open) }
            }
            "heart" => Shape::Heart { center: a.vector("center"), size: a.number("size") },
            _ => panic!("no oracle for `{kind}`"),
        })
    }
}
