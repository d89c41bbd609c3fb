//! Meshes, and copies of shapes in other places.

use crate::falsify::random::{Point, Random, cross, dot, moved, turned};
use crate::falsify::scenes::{Aim, Question, numbers};
use std::fmt::Write;

/// Points, and triangles of them, counterclockwise as seen from outside.
struct Solid {
    points: Vec<Point>,
    faces: Vec<[usize; 3]>,
}

impl Solid {
    /// Returns a random closed and convex solid around the origin, about 1 in size.
    fn new(random: &mut Random) -> Self {
        match random.below(4) {
            0 => loop {
                let points: Vec<_> = (0..4).map(|_| random.direction()).collect();
                let solid = Self { points, faces: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]] };
                let depth = |face: &[usize; 3]| {
                    let [a, b, c] = face.map(|corner| solid.points[corner]);
                    dot(cross(a, b), c)
                };
                let depths: Vec<_> = solid.faces.iter().map(depth).collect();
                if depths.iter().all(|depth| *depth > 0.05) {
                    break solid;
                }
                if depths.iter().all(|depth| *depth < -0.05) {
                    break solid.turned_over();
                }
            },
            1 => {
                let points = (0..8).map(|of| [0, 1, 2].map(|axis| f64::from(of >> axis & 1) * 2.0 - 1.0));
                let sides =
                    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
                let faces = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
                Self { points: points.collect(), faces }
            }
            _ => {
                // Two pyramids on one base.
                let count = random.whole(3, 8) as usize;
                let height = random.power(-1.0, 0.5);
                let mut points = vec![[0.0, 0.0, height], [0.0, 0.0, -height]];
                points.extend((0..count).map(|of| {
                    let angle = std::f64::consts::TAU * of as f64 / count as f64;
                    [angle.cos(), angle.sin(), 0.0]
                }));
                let base = |of: usize| 2 + of % count;
                let faces = (0..count)
                    .flat_map(|of| [[0, base(of), base(of + 1)], [1, base(of + 1), base(of)]])
                    .collect();
                Self { points, faces }
            }
        }
    }

    fn turned_over(mut self) -> Self {
        self.faces.iter_mut().for_each(|face| face.swap(1, 2));
        self
    }

    fn map(&mut self, map: impl Fn(Point) -> Point) {
        self.points.iter_mut().for_each(|point| *point = map(*point));
    }

    /// Returns a random point, often near an edge or a vertex up to a small offset.
    fn spot(&self, random: &mut Random) -> Point {
        let face = self.faces[random.below(self.faces.len() as u64) as usize];
        let [a, b, c] = face.map(|corner| self.points[corner]);
        let between = |from: Point, to: Point, part: f64| {
            [0, 1, 2].map(|axis| from[axis] + part * (to[axis] - from[axis]))
        };
        let part = if random.once_in(3) { random.offset() } else { random.between(0.0, 1.0) };
        let depth = if random.once_in(4) { random.between(0.0, 1.0) } else { random.offset() };
        between(between(a, b, part), c, depth)
    }

    /// Adds some faces again, as they are or turned over.
    fn double(&mut self, random: &mut Random) {
        for _ in 0..random.whole(1, self.faces.len() as i64) as usize {
            let [a, b, c] = self.faces[random.below(self.faces.len() as u64) as usize];
            self.faces.push(if random.once_in(3) { [b, c, a] } else { [a, c, b] });
        }
    }

    /// Adds another solid.
    fn and(mut self, other: Self) -> Self {
        let first = self.points.len();
        self.points.extend(other.points);
        self.faces.extend(other.faces.into_iter().map(|face| face.map(|corner| first + corner)));
        self
    }

    /// Returns the text of an OBJ file.
    fn obj(&self) -> String {
        let mut text = String::new();
        for point in &self.points {
            writeln!(text, "v {}", numbers(*point)).expect("room");
        }
        for face in &self.faces {
            let [a, b, c] = face.map(|corner| corner + 1);
            writeln!(text, "f {a} {b} {c}").expect("room");
        }
        text
    }
}

fn aim(random: &mut Random, far: f64) -> Aim {
    if random.once_in(2) { Aim::new(random, far) } else { Aim::plain(random, far) }
}

fn mesh(random: &mut Random) -> String {
    format!("mesh file mesh.obj smooth {}", random.below(2))
}

/// Asks for one pixel, for some or for a whole image.
fn asked(random: &mut Random, aim: &Aim, objects: &[String]) -> Question {
    match random.below(8) {
        0 => aim.many(random, objects),
        1 => aim.picture(objects),
        _ => aim.question(objects),
    }
}

/// Moves a spot of a solid of some size to where a ray is aimed.
fn aimed(random: &mut Random, aim: &Aim, solid: &mut Solid, size: f64) {
    let (spot, turn) = (solid.spot(random), Turn::new(random));
    solid.map(|point| {
        let from = turn.vector([0, 1, 2].map(|axis| point[axis] - spot[axis]));
        moved(aim.target, size, from)
    });
}

fn size(random: &mut Random, aim: &Aim) -> f64 {
    if random.once_in(2) { random.between(0.5, 4.0) } else { aim.far * random.power(-4.0, -0.5) }
}

/// Returns a scene of a closed mesh, an edge or a vertex of which the ray meets up to a small offset.
pub fn edges(random: &mut Random) -> Question {
    let aim = aim(random, 6.0);
    let mut solid = Solid::new(random);
    let size = size(random, &aim);
    aimed(random, &aim, &mut solid, size);
    let object = mesh(random);
    asked(random, &aim, &[object]).with_mesh(solid.obj())
}

/// Returns a scene of a mesh of slivers: a solid that is thin along one axis or two.
pub fn slivers(random: &mut Random) -> Question {
    let aim = aim(random, 3.0);
    let mut solid = Solid::new(random);
    let thin = [random.power(-7.0, -1.0), if random.once_in(2) { 1.0 } else { random.power(-6.0, 0.0) }, 1.0];
    solid.map(|point| [0, 1, 2].map(|axis| point[axis] * thin[axis]));
    let size = size(random, &aim);
    aimed(random, &aim, &mut solid, size);
    let object = mesh(random);
    asked(random, &aim, &[object]).with_mesh(solid.obj())
}

/// Returns a scene of a mesh some of whose faces are there twice, and turned over.
pub fn doubled(random: &mut Random) -> Question {
    let aim = aim(random, 3.0);
    let mut solid = Solid::new(random);
    solid.double(random);
    let size = size(random, &aim);
    aimed(random, &aim, &mut solid, size);
    let object = mesh(random);
    asked(random, &aim, &[object]).with_mesh(solid.obj())
}

/// Returns a scene of a mesh with a solid of 1e-6 where the ray is aimed, and one of 1e6 behind it.
pub fn sizes(random: &mut Random) -> Question {
    let aim = aim(random, 3.0);
    let [mut small, mut large] = [Solid::new(random), Solid::new(random)];
    let size = random.power(-7.0, -3.0);
    aimed(random, &aim, &mut small, size);
    let spot = large.spot(random);
    let size = random.power(4.0, 6.0);
    large.map(|point| {
        let from = [0, 1, 2].map(|axis| point[axis] - spot[axis]);
        moved(moved(aim.target, 3.0 * size, aim.u), size, from)
    });
    let object = mesh(random);
    asked(random, &aim, &[object]).with_mesh(small.and(large).obj())
}

/// Returns a scene of a tetrahedron one of whose edges is on the ray, or one of whose faces, up to a small offset.
pub fn along(random: &mut Random) -> Question {
    let middle = [0; 2].map(|_| random.whole(8, 40) / 8.0);
    let eye = [0, 1].map(|axis| middle[axis] + random.whole(-12, 12) / 4.0);
    let (eye, middle) = ([eye[0], eye[1], random.whole(4, 12)], [middle[0], middle[1], 0.0]);
    let aim = Aim::through(eye, middle, 2.0);
    let forward = [0, 1, 2].map(|axis| middle[axis] - eye[axis]);
    let away = [0; 3].map(|_| random.whole(-8, 8) / 4.0);
    let on_ray = |by: f64| moved(eye, by, forward);
    let (near, far) = (1.0 + random.whole(1, 4) / 8.0, 2.0 + random.whole(0, 8) / 8.0);
    let shift = if random.once_in(2) { 0.0 } else { random.offset() };
    let mut points = vec![on_ray(near), on_ray(far)];
    if random.once_in(2) {
        // The ray runs in the plane of the first three.
        points[1] = moved(points[1], random.whole(-4, 4) / 4.0, away);
    }
    let other = moved(on_ray(far), random.whole(1, 8) / 4.0, away);
    points.push(moved(other, shift, random.direction()));
    points.push(moved(on_ray(near), 1.0, [0; 3].map(|_| random.whole(-8, 8) / 4.0)));
    let [a, b, c, d] = [points[0], points[1], points[2], points[3]];
    let solid = Solid { points, faces: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]] };
    let from = |of: Point| [0, 1, 2].map(|axis| of[axis] - d[axis]);
    let is_inward = dot(cross(from(a), from(b)), from(c)) > 0.0;
    let solid = if is_inward { solid.turned_over() } else { solid };
    let object = mesh(random);
    let objects = [object, format!("plane normal 0 0 1 point 0 0 {}", -30.0 * forward[2].abs())];
    asked(random, &aim, &objects).with_mesh(solid.obj())
}

/// Returns a scene of a closed mesh around the viewer, out of which no ray can see.
pub fn inside(random: &mut Random) -> Question {
    let aim = Aim::new(random, 4.0);
    let mut solid = Solid::new(random);
    if random.once_in(2) {
        let thin = [1.0, random.power(-4.0, 0.0), random.power(-2.0, 0.0)];
        solid.map(|point| [0, 1, 2].map(|axis| point[axis] * thin[axis]));
    }
    if random.once_in(3) {
        solid.double(random);
    }
    let (turn, size) = (Turn::new(random), random.power(-1.0, 5.0));
    let corner = solid.points[random.below(solid.points.len() as u64) as usize];
    let part = random.between(0.0, 0.9);
    solid.map(|point| moved(aim.eye, size, turn.vector(moved(point, -part, corner))));
    let object = mesh(random);
    let objects = [object];
    let question = if random.once_in(4) { aim.picture(&objects) } else { aim.many(random, &objects) };
    question.with_mesh(solid.obj())
}

/// A rotation around x, y and z in degrees, and its matrix, roughly.
struct Turn {
    degrees: Point,
    columns: [Point; 3],
}

impl Turn {
    fn new(random: &mut Random) -> Self {
        let kind = random.below(4);
        let degrees = [0; 3].map(|_| match kind {
            0 => 0.0,
            1 => 90.0 * random.whole(-4, 4),
            2 => 15.0 * random.whole(-24, 24),
            _ => random.between(-360.0, 360.0),
        });
        let turned = |mut of: Point| {
            for axis in 0..3 {
                let (sin, cos) = degrees[axis].to_radians().sin_cos();
                let (one, other) = ((axis + 1) % 3, (axis + 2) % 3);
                (of[one], of[other]) = (cos * of[one] - sin * of[other], cos * of[other] + sin * of[one]);
            }
            of
        };
        Self { degrees, columns: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(turned) }
    }

    fn vector(&self, of: Point) -> Point {
        let [x, y, z] = self.columns;
        moved(moved(x.map(|part| part * of[0]), of[1], y), of[2], z)
    }
}

/// A copy's rotation, its scale and the attributes that say so.
pub struct Copy {
    turn: Turn,
    scale: Point,
}

impl Copy {
    pub fn new(random: &mut Random, far: f64) -> Self {
        let turn = Turn::new(random);
        let scale = match random.below(4) {
            0 => [1.0; 3],
            1 => [random.power(-far, far); 3],
            2 => [2_f64.powf(random.whole(-8, 8)); 3],
            _ => [0; 3].map(|_| random.power(-1.0, 1.0)),
        };
        Self { turn, scale }
    }

    fn vector(&self, of: Point) -> Point {
        self.turn.vector([0, 1, 2].map(|axis| of[axis] * self.scale[axis]))
    }

    /// Returns the attributes of a copy of an object that puts a point of it somewhere.
    pub fn attributes(&self, object: &str, point: Point, at: Point) -> String {
        let translation = moved(at, -1.0, self.vector(point));
        format!(
            "object {object} scale {} rotation {} translation {}",
            numbers(self.scale),
            numbers(self.turn.degrees),
            numbers(translation)
        )
    }
}

pub const PATTERN: &str = "material own { ambient 1 1 1 }\n";

/// Returns a scene of copies of a sphere or an ellipsoid, to one of which the ray is tangent up to a small offset.
pub fn placed_spheres(random: &mut Random) -> Question {
    let aim = aim(random, 6.0);
    let (center, radius) = ([0; 3].map(|_| random.between(-2.0, 2.0)), random.power(-1.0, 1.0));
    let pattern = if random.once_in(2) {
        format!("sphere own {{ material own center {} radius {radius:?} }}\n", numbers(center))
    } else {
        let scale = [0; 3].map(|_| random.power(-1.0, 1.0));
        let scale = numbers(scale);
        format!(
            "ellipsoid own {{ material own center {} radius {radius:?} scale {scale} }}\n",
            numbers(center)
        )
    };
    let mut objects = Vec::new();
    for _ in 0..random.whole(1, 3) as usize {
        let copy = Copy::new(random, 4.0);
        let side = turned(aim.u, aim.angle(random));
        let by = if random.once_in(3) { random.between(0.0, 1.0) } else { 1.0 + random.offset() };
        let at = moved(aim.target, by * radius * copy.scale[0], side);
        objects.push(format!("place {}", copy.attributes("own", center, at)));
    }
    asked(random, &aim, &objects).with_patterns(&format!("{PATTERN}{pattern}"))
}

/// Returns a scene of copies of a mesh, an edge or a vertex of which the ray meets up to a small offset.
pub fn placed_meshes(random: &mut Random) -> Question {
    let aim = aim(random, 6.0);
    let mut solid = Solid::new(random);
    if random.once_in(4) {
        solid.double(random);
    }
    if random.once_in(2) {
        let by = [0; 3].map(|_| random.between(-4.0, 4.0));
        solid.map(|point| moved(point, 1.0, by));
    }
    let mut objects = Vec::new();
    for _ in 0..random.whole(1, 3) as usize {
        let (copy, spot) = (Copy::new(random, 4.0), solid.spot(random));
        objects.push(format!("place {}", copy.attributes("own", spot, aim.target)));
    }
    let pattern = format!("{PATTERN}mesh own {{ material own file mesh.obj smooth {} }}\n", random.below(2));
    asked(random, &aim, &objects).with_mesh(solid.obj()).with_patterns(&pattern)
}

/// Returns a scene of a copy of a copy of a mesh or a sphere, up to four deep.
pub fn placed_places(random: &mut Random) -> Question {
    let aim = aim(random, 6.0);
    let solid = Solid::new(random);
    let is_mesh = random.once_in(2);
    let mut patterns = PATTERN.to_owned();
    patterns += if is_mesh {
        "mesh own0 { material own file mesh.obj }\n"
    } else {
        "sphere own0 { material own center 0 0 0 radius 1 }\n"
    };
    let mut spot =
        if is_mesh { solid.spot(random) } else { moved([0.0; 3], 1.0 + random.offset(), random.direction()) };
    let depth = random.whole(1, 3) as usize;
    for level in 0..depth {
        let (copy, at) = (Copy::new(random, 1.0), [0; 3].map(|_| random.between(-3.0, 3.0)));
        let attributes = copy.attributes(&format!("own{level}"), spot, at);
        writeln!(patterns, "place own{} {{ material own {attributes} }}", level + 1).expect("room");
        spot = at;
    }
    let copy = Copy::new(random, 2.0);
    let object = format!("place {}", copy.attributes(&format!("own{depth}"), spot, aim.target));
    let question = asked(random, &aim, &[object]).with_patterns(&patterns);
    if is_mesh { question.with_mesh(solid.obj()) } else { question }
}

/// Returns a scene of a copy of a closed mesh around the viewer, out of which no ray can see.
pub fn placed_inside(random: &mut Random) -> Question {
    let aim = Aim::new(random, 4.0);
    let mut solid = Solid::new(random);
    if random.once_in(3) {
        solid.double(random);
    }
    let corner = solid.points[random.below(solid.points.len() as u64) as usize];
    let part = random.between(0.0, 0.9);
    let within = corner.map(|of| part * of);
    let copy = Copy::new(random, 5.0);
    let objects = [format!("place {}", copy.attributes("own", within, aim.eye))];
    let pattern = format!("{PATTERN}mesh own {{ material own file mesh.obj }}\n");
    let question = if random.once_in(4) { aim.picture(&objects) } else { aim.many(random, &objects) };
    question.with_mesh(solid.obj()).with_patterns(&pattern)
}
