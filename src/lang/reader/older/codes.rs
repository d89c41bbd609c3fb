//! The meanings of the codes in a scene of numbers, and the lines after each code.

/// The meaning of a code.
pub struct Code {
    pub number: u32,
    /// The name in messages.
    pub name: &'static str,
    /// The corresponding entity type.
    pub entity: &'static str,
    /// The lines after the code.
    pub lines: &'static [Line],
    /// How it is drawn otherwise than by the programs of the time: as if it had no file.
    pub drawn: Option<&'static str>,
}

/// A line, or several, after a code.
#[derive(Clone, Copy)]
pub enum Line {
    /// The lines of a material.
    Material,
    /// Numbers.
    Numbers(Numbers),
    /// The name of a file.
    File,
}

/// A line of numbers.
#[derive(Clone, Copy)]
pub struct Numbers {
    /// The name in messages.
    pub name: &'static str,
    /// The number of numbers.
    pub count: usize,
    /// The corresponding attribute, or an empty string if there is none with the same numbers.
    pub attribute: &'static str,
    pub rule: Rule,
}

/// The rule for the numbers of a line.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// Any numbers.
    Any,
    /// A point, counted from the middle of the screen.
    Point,
    /// Not all zero.
    Direction,
    /// Positive.
    Lengths,
    /// From 0 to 1.
    Fraction,
    /// Degrees above 0 and up to 180.
    Angle,
    /// 1 or 2.
    Mode,
}

const fn line(name: &'static str, count: usize, attribute: &'static str, rule: Rule) -> Line {
    Line::Numbers(Numbers { name, count, attribute, rule })
}

const EMISSIVITY: Line = line("emissivity", 3, "emissivity", Rule::Any);
const LOCATION: Line = line("location", 3, "location", Rule::Point);
const CENTRE: Line = line("centre", 3, "center", Rule::Point);
const RADIUS: Line = line("radius", 1, "radius", Rule::Lengths);
const NORMAL: Line = line("normal", 3, "normal", Rule::Direction);
const POINT: Line = line("point", 3, "point", Rule::Point);
const XDIR: Line = line("xdir", 3, "xdir", Rule::Direction);
const SIZE: Line = line("size", 2, "dimensions", Rule::Lengths);
const SHADER: Line = line("shader", 1, "", Rule::Any);
const BASE: Line = line("centre of the base", 3, "base", Rule::Point);
const AXIS: Line = line("axis", 3, "direction", Rule::Direction);
const RADIUS_AND_HEIGHT: Line = line("radius and height", 2, "", Rule::Lengths);

const ROUND: &[Line] = &[Line::Material, BASE, AXIS, RADIUS_AND_HEIGHT];
const BALL: &[Line] = &[Line::Material, CENTRE, RADIUS];

const fn code(number: u32, name: &'static str, entity: &'static str, lines: &'static [Line]) -> Code {
    Code { number, name, entity, lines, drawn: None }
}

/// The meaning of a code that is drawn as a plain sphere.
const fn plain(number: u32, name: &'static str, lines: &'static [Line], drawn: &'static str) -> Code {
    Code { number, name, entity: "sphere", lines, drawn: Some(drawn) }
}

/// The codes with a single meaning.
const CODES: [Code; 15] = [
    code(10, "light", "light", &[EMISSIVITY, LOCATION]),
    code(
        11,
        "spotlight",
        "spotlight",
        &[
            EMISSIVITY,
            LOCATION,
            line("aimed-at point", 3, "point", Rule::Point),
            line("half angle", 1, "theta", Rule::Angle),
        ],
    ),
    code(13, "sphere", "sphere", BALL),
    code(14, "plane", "plane", &[Line::Material, NORMAL, POINT]),
    code(15, "finite plane", "fplane", &[Line::Material, NORMAL, POINT, XDIR, SIZE]),
    code(
        16,
        "tiled plane",
        "tiled_plane",
        &[
            Line::Material,
            NORMAL,
            POINT,
            XDIR,
            line("tile size", 2, "dimensions", Rule::Lengths),
            Line::Material,
        ],
    ),
    code(
        17,
        "textured plane",
        "texplane",
        &[Line::Material, NORMAL, POINT, XDIR, SIZE, Line::File, line("mode", 1, "", Rule::Mode)],
    ),
    code(19, "procedural sphere", "sphere", &[Line::Material, CENTRE, RADIUS, SHADER]),
    code(20, "procedural plane", "plane", &[Line::Material, NORMAL, POINT, SHADER]),
    code(21, "paraboloid", "revsurf", ROUND),
    code(22, "cylinder", "cylinder", ROUND),
    code(23, "cone", "revsurf", ROUND),
    code(26, "textured sphere", "sphere", &[Line::Material, CENTRE, RADIUS, Line::File]),
    plain(
        28,
        "displaced sphere",
        &[Line::Material, CENTRE, RADIUS, Line::File],
        "a displaced sphere is drawn as a plain one",
    ),
    plain(25, "lens", BALL, "a lens is drawn as a sphere"),
];

const TORUS: Code = code(
    25,
    "torus",
    "torus",
    &[Line::Material, CENTRE, AXIS, RADIUS, line("tube radius", 1, "tube", Rule::Lengths)],
);
const TRIANGLE: Code = code(
    27,
    "triangle",
    "triangle",
    &[
        Line::Material,
        line("first vertex", 3, "vertex1", Rule::Point),
        line("second vertex", 3, "vertex2", Rule::Point),
        line("third vertex", 3, "vertex3", Rule::Point),
    ],
);
const DISC: Code = code(27, "disc", "disc", &[Line::Material, CENTRE, RADIUS, NORMAL]);

/// Codes of the programs' headers without any scene that shows their lines.
pub const UNREAD: [(u32, &str); 3] = [
    (
        PROJECTOR,
        "12 stands for a projector, and in another numbering of these scenes for a plane: neither is read",
    ),
    (18, "18 stands in the headers of the programs of the time, but no scene shows the lines of its object"),
    (24, "24 stands in the headers of the programs of the time, but no scene shows the lines of its object"),
];

/// The code of a projector, or of a plane in another numbering.
pub const PROJECTOR: u32 = 12;

/// The code of a light.
pub const LIGHT: u32 = 10;

/// The first lines after the viewpoint that announce additional lines for each material.
pub const TRANSPARENCY: u32 = 9000;
pub const REFRACTION: u32 = 9001;

/// Tells whether a number is a known code.
pub fn is_known(number: u32) -> bool {
    number == TRIANGLE.number
        || CODES.iter().any(|code| code.number == number)
        || UNREAD.iter().any(|(unread, _)| *unread == number)
}

/// Returns the code for a type that a line names, beside a comment: `sphere`, `Finite_Plane:`, `light # a lamp`.
pub fn named(line: &str) -> Option<u32> {
    let end = line.find(['#', '%', ';']).or(line.find("//")).unwrap_or(line.len());
    let plain = |name: &str| name.replace([' ', '_', '-'], "").to_lowercase();
    let name = plain(line[..end].trim_end_matches([':', ' ', '\t']));
    let is_named = |code: &&Code| plain(code.name) == name || plain(code.entity) == name;
    CODES.iter().chain([&TORUS, &TRIANGLE, &DISC]).find(is_named).map(|code| code.number)
}

/// Returns the meaning of a code. Two codes have two meanings each. `second` gives the count of numbers on the second
/// line after those of the material, which decides between the meanings.
pub fn of(number: u32, second: impl Fn() -> usize) -> Option<&'static Code> {
    match number {
        25 if second() > 1 => Some(&TORUS),
        27 if second() > 1 => Some(&TRIANGLE),
        27 => Some(&DISC),
        _ => CODES.iter().find(|code| code.number == number),
    }
}

/// The first two lines, before any object.
pub const WORLD: Numbers =
    Numbers { name: "world size", count: 2, attribute: "worlddim", rule: Rule::Lengths };
pub const VIEWPOINT: Numbers =
    Numbers { name: "viewpoint", count: 3, attribute: "viewpoint", rule: Rule::Point };

/// The lines of a material. The last two occur only if a scene announces them.
pub const MATERIAL: [Numbers; 5] = [
    Numbers { name: "ambient colour", count: 3, attribute: "ambient", rule: Rule::Any },
    Numbers { name: "diffuse colour", count: 3, attribute: "diffuse", rule: Rule::Any },
    Numbers { name: "specular colour", count: 3, attribute: "specular", rule: Rule::Any },
    Numbers { name: "transparency", count: 1, attribute: "transparency", rule: Rule::Fraction },
    Numbers { name: "index of refraction", count: 1, attribute: "", rule: Rule::Any },
];

impl Code {
    /// Describes the lines after the code, and the count of numbers on each line. `of_material` is the number of lines
    /// of a material.
    pub fn usage(&self, of_material: usize) -> String {
        let mut lines = Vec::new();
        for line in self.lines {
            match line {
                Line::Material => lines.extend(MATERIAL[..of_material].iter().map(Numbers::usage)),
                Line::Numbers(numbers) => lines.push(numbers.usage()),
                Line::File => lines.push("file name".to_owned()),
            }
        }
        format!(
            "after {}, a {} has a line each, of so many numbers: {}",
            self.number,
            self.name,
            lines.join(", ")
        )
    }
}

impl Numbers {
    fn usage(&self) -> String {
        format!("{} {}", self.name, self.count)
    }
}
