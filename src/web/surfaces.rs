//! Named surfaces, as scenes to start from.

use serde::Serialize;
use tabray_core::text;

/// A surface, in a table.
#[derive(Serialize)]
pub struct Surface {
    /// The name in addresses.
    name: &'static str,
    /// The name for people.
    title: &'static str,
    /// A few words about it.
    about: &'static str,
    #[serde(skip)]
    formula: &'static str,
    /// The definitions of the numbers and functions in the formula.
    #[serde(skip)]
    lets: &'static [&'static str],
    /// The radius of the ball that clips the surface.
    #[serde(skip)]
    size: f64,
}

macro_rules! surfaces {
    ($($name:literal $title:literal $size:literal $formula:literal [$($given:literal),*] $about:literal)*) => {
        &[$(Surface { name: $name, title: $title, about: $about, formula: $formula, lets: &[$($given),*], size: $size }),*]
    };
}

/// The words at the beginning of a scene whose surface has no name.
const UNNAMED: &str = "a surface by its formula";

/// All surfaces. The first one is shown first.
const SURFACES: &[Surface] = surfaces! {
    "barth-6" "Barth's sextic" 1.9
        "(1 + 2*P)*(x^2 + y^2 + z^2 - w)^2 - 4*(P^2*x^2 - y^2)*(P^2*y^2 - z^2)*(P^2*z^2 - x^2)"
        ["let P \"(1 + sqrt(5))/2\"", "let w 1"]
        "65 nodes, the most that a surface of degree 6 can have"
    "barth-10" "Barth's decic" 2.1
        "8*(x^2 - P^4*y^2)*(y^2 - P^4*z^2)*(z^2 - P^4*x^2)*(x^4 + y^4 + z^4 - 2*x^2*y^2 - 2*x^2*z^2 - 2*y^2*z^2) + (3 + 5*P)*(x^2 + y^2 + z^2 - 1)^2*(x^2 + y^2 + z^2 - 2 + P)^2"
        ["let P \"(1 + sqrt(5))/2\""]
        "degree 10, 345 nodes"
    "endrass-8" "Endrass's octic" 2.1
        "64*(x^2 - 1)*(y^2 - 1)*((x + y)^2 - 2)*((x - y)^2 - 2) - (-4*(1 + s)*(x^2 + y^2)^2 + (8*(2 + s)*z^2 + 2*(2 + 7*s))*(x^2 + y^2) - 16*z^4 + 8*(1 - 2*s)*z^2 - (1 + 12*s))^2"
        ["let s \"sqrt(2)\""]
        "degree 8, 168 nodes"
    "chmutov-6" "Chmutov's sextic" 1.15
        "t(x) + t(y) + t(z) - level"
        ["let t(u) \"32*u^6 - 48*u^4 + 18*u^2 - 1\"", "let level 0"]
        "a Chebyshev polynomial along each axis"
    "clebsch" "Clebsch's diagonal cubic" 2.4
        "81*(x^3 + y^3 + z^3) - 189*(x^2*y + x^2*z + y^2*x + y^2*z + z^2*x + z^2*y) + 54*x*y*z + 126*(x*y + x*z + y*z) - 9*(x^2 + y^2 + z^2) - 9*(x + y + z) + 1"
        []
        "a smooth cubic whose 27 lines are all real"
    "cayley" "Cayley's cubic" 1.4
        "4*(x^2 + y^2 + z^2) + 16*x*y*z - 1"
        []
        "four nodes, the most that a cubic can have"
    "kummer" "Kummer's quartic" 2.2
        "(x^2 + y^2 + z^2 - m^2)^2 - (3*m^2 - 1)/(3 - m^2)*((1 - z)^2 - 2*x^2)*((1 + z)^2 - 2*y^2)"
        ["let m 1.3"]
        "sixteen nodes, the most that a quartic can have"
    "heart" "Heart" 1.5
        "(x^2 + 9/4*z^2 + y^2 - 1)^3 - x^2*y^3 - 9/80*z^2*y^3"
        []
        "Taubin's sextic heart"
    "goursat" "Tangle cube" 3.4
        "x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + a"
        ["let a 11.8"]
        "a quartic of Goursat's; its holes close as a grows"
    "gyroid" "Gyroid" 5.0
        "sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x) - level"
        ["let level 0"]
        "close to Schoen's minimal surface, without straight lines"
    "schwarz-p" "Schwarz P" 5.0
        "cos(x) + cos(y) + cos(z) - level"
        ["let level 0"]
        "close to Schwarz's primitive minimal surface"
    "schwarz-d" "Schwarz D" 5.0
        "sin(x)*sin(y)*sin(z) + sin(x)*cos(y)*cos(z) + cos(x)*sin(y)*cos(z) + cos(x)*cos(y)*sin(z)"
        []
        "close to Schwarz's diamond minimal surface"
    "neovius" "Neovius" 5.0
        "3*(cos(x) + cos(y) + cos(z)) + 4*cos(x)*cos(y)*cos(z)"
        []
        "close to the minimal surface of Neovius"
    "scherk" "Scherk's tower" 4.0
        "sin(z) - sinh(x)*sinh(y)"
        []
        "a minimal surface exactly: planes that cross, desingularized"
    "torus" "Torus" 1.6
        "(sqrt(x^2 + z^2) - R)^2 + y^2 - r0^2"
        ["let R 1", "let r0 0.4"]
        "all points at one distance from a circle"
    "two-holes" "Double torus" 1.2
        "(x^2*(1 - x^2) - y^2)^2 + z^2 - w^2"
        ["let w 0.18"]
        "a tube around a figure of eight: genus 2"
    "cyclide" "Dupin's cyclide" 4.2
        "(x^2 + y^2 + z^2 + b^2 - d^2)^2 - 4*((a*x - sqrt(a^2 - b^2)*d)^2 + b^2*y^2)"
        ["let a 2", "let b 1.9", "let d 1"]
        "all its lines of curvature are circles"
    "klein" "Klein bottle" 4.4
        "(x^2 + y^2 + z^2 + 2*y - 1)*((x^2 + y^2 + z^2 - 2*y - 1)^2 - 8*z^2) + 16*x*z*(x^2 + y^2 + z^2 - 2*y - 1)"
        []
        "a sextic that meets itself: it has one side"
    "roman" "Steiner's Roman surface" 1.5
        "x^2*y^2 + y^2*z^2 + z^2*x^2 - 2*x*y*z"
        []
        "the real projective plane, with a triple point"
    "whitney" "Whitney's umbrella" 1.4
        "x^2 - z^2*y"
        []
        "a pinch point at the end of a line of self-intersection"
    "ding-dong" "Ding-dong" 1.6
        "x^2 + z^2 - (1 - y)*y^2"
        []
        "a cubic bell with a node"
    "hunt" "Hunt's surface" 5.6
        "4*(x^2 + y^2 + z^2 - 13)^3 + 27*(3*x^2 + y^2 - 4*z^2 - 12)^2"
        []
        "a sextic with cusps along a curve"
    "superquadric" "Superquadric" 1.45
        "abs(x)^p + abs(y)^p + abs(z)^p - 1"
        ["let p 2.6"]
        "an octahedron for p = 1, a ball for p = 2, towards a cube beyond"
    "hyperboloid" "Hyperboloid" 2.2
        "x^2 + z^2 - y^2 - c"
        ["let c 0.3"]
        "of one sheet, a cone for c = 0, and of two sheets below"
    "monkey" "Monkey saddle" 1.5
        "y - (x^3 - 3*x*z^2)/3"
        []
        "a saddle for two legs and a tail"
    "fermat" "Fermat's quartic" 1.45
        "x^4 + y^4 + z^4 - 1"
        []
        "a K3 surface that looks like a cushion"
    "balls" "Melting balls" 1.6
        "1 - a/((x - 0.7)^2 + y^2 + z^2) - a/((x + 0.7)^2 + y^2 + z^2)"
        ["let a 0.4"]
        "two poles of a field; they join as a grows"
    "ripples" "Ripples" 3.0
        "y - h*cos(k*sqrt(x^2 + z^2))"
        ["let h 0.2", "let k 5"]
        "a wave around a centre"
};

/// Lists the surfaces.
pub fn all() -> &'static [Surface] {
    SURFACES
}

impl Surface {
    /// Returns the words at the beginning of its scene.
    fn heading(&self) -> String {
        format!("{}: {}", self.title, self.about)
    }
}

/// Returns the scene of the surface of this name.
///
/// # Errors
/// Returns what is wrong with the name.
pub fn scene(name: &str) -> Result<String, String> {
    let Some(surface) = SURFACES.iter().find(|surface| surface.name == name) else {
        let near = text::nearest(name, SURFACES.iter().map(|surface| surface.name));
        let cure = near.map_or_else(
            || "choose one from the list beside the formula".to_owned(),
            |near| format!("did you mean `{near}`?"),
        );
        return Err(format!("there is no surface `{}`: {cure}", text::visible(name)));
    };
    Ok(of_formula(&surface.heading(), surface.formula, surface.size, surface.lets))
}

/// Returns the words at the beginning of a scene with this formula.
pub fn heading(formula: &str) -> String {
    let known = SURFACES.iter().find(|surface| surface.formula == formula);
    known.map_or_else(|| UNNAMED.to_owned(), Surface::heading)
}

/// Tells whether the beginning of a scene is one of [`heading`].
pub fn is_heading(words: &str) -> bool {
    words == UNNAMED || SURFACES.iter().any(|surface| surface.heading() == words)
}

/// Returns the scene of a formula, clipped by a ball of radius `size`.
pub fn of_formula(title: &str, formula: &str, size: f64, lets: &[&str]) -> String {
    let [x, y, z] = [2.5, 1.7, 3.4].map(|side| rounded(side * size));
    let lets: String = lets.iter().map(|given| format!("{given}\n")).collect();
    format!(
        "# {title}\n{lets}\n\
         look_at eye {{ pixeldim 400 300  position {x} {y} {z}  target 0 0 0  angle 36 }}\n\
         background paper {{ colour 0.8 0.86 0.94 }}\n\
         sun key  {{ direction 0.5 0.9 0.6  emissivity 1 0.97 0.9 }}\n\
         sun fill {{ direction -0.8 0.2 0.4  emissivity 0.25 0.28 0.35 }}\n\
         material front {{ ambient 0.1 0.06 0.02  diffuse 0.8 0.46 0.12 }}\n\
         material back  {{ ambient 0.03 0.07 0.12  diffuse 0.2 0.48 0.75 }}\n\
         sides two {{ back back }}\n\
         sphere ball {{ material front  center 0 0 0  radius {size} }}\n\
         implicit surface {{\n    \
             material front  shader two  clip ball\n    \
             formula \"{formula}\"\n\
         }}\n"
    )
}

fn rounded(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}
