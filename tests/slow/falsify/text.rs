//! Scenes parsed from their text, without any code of the program.

use super::dyadic::Dyadic;
use super::formula::Formula;
use super::place::Place;
use std::collections::HashMap;
use std::rc::Rc;

/// A point or a direction.
pub type Vector = [Dyadic; 3];

/// The part of a scene that first hits depend on.
pub struct Scene {
    pub pixels: [i64; 2],
    pub screen: [Dyadic; 2],
    pub eye: Vector,
    /// The objects that are seen where they are, not only where they are placed.
    pub objects: Vec<Rc<Shape>>,
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
    /// Triangles, of a closed surface or not.
    Mesh {
        faces: Vec<[Vector; 3]>,
    },
    Placed {
        shape: Rc<Shape>,
        place: Place,
    },
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

const ATTRIBUTES: [&str; 35] = [
    "pixeldim",
    "worlddim",
    "viewpoint",
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

impl Scene {
    /// Reads a scene; `mesh` is the text of its mesh's file.
    pub fn read(text: &str, mesh: &str) -> Self {
        let words = words(text);
        let mut named: HashMap<&str, (Rc<Shape>, bool)> = HashMap::new();
        let mut order = Vec::new();
        let mut scene = Self {
            pixels: [1, 1],
            screen: [Dyadic::int(8), Dyadic::int(6)],
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
            if let Some(shape) = scene.shape(kind, &attributes, mesh, object) {
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
                self.screen = a.pair("worlddim");
                self.eye = a.vector("viewpoint");
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
                Shape::Revolved {
                    profile,
                    direction: a.vector("direction"),
                    base: a.vector("base"),
                    height: a.number("height"),
                }
            }
            "torus" => Shape::Torus {
                center: a.vector("center"),
                direction: a.vector_or("direction", [0, 1, 0]),
                radius: a.number("radius"),
                tube: a.number("tube"),
            },
            "heart" => Shape::Heart { center: a.vector("center"), size: a.number("size") },
            _ => panic!("no oracle for `{kind}`"),
        })
    }
}
