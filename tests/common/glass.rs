//! Shapes of glass, for tests of how light passes through them.

/// Closed shapes of glass, with their surroundings left out; `g` is the glass and `i` its inverse.
pub const SHAPES: [(&str, &str); 7] = [
    ("ball", "sphere a { material g center 0 0 0 radius 1 }"),
    (
        "hollow ball",
        "sphere a { material g center 0 0 0 radius 1 } sphere b { material i center 0 0 0 radius 0.8 }",
    ),
    ("cube", "box a { material g center 0 0 0 size 1.2 1.2 1.2 } place p { object a rotation 20 30 40 }"),
    ("heart", "heart a { material g center 0 0 0 size 1 }"),
    (
        "cup",
        "cylinder w { material g base 0 -0.8 0 direction 0 1 0 radius 0.8 height 1.6 }
             cylinder h { material g base 0 -0.6 0 direction 0 1 0 radius 0.6 height 1.6 }
             difference a { objects w h }",
    ),
    (
        "glass in a glass",
        "sphere a { material g center 0 0 0 radius 1 } sphere b { material g center 0.1 0 0 radius 0.5 }",
    ),
    (
        "lens",
        "sphere w { material g center 0 0 -0.6 radius 1 } sphere h { material g center 0 0 0.6 radius 1 }
              intersection a { objects w h }",
    ),
];

/// Returns a camera in front of the shapes, under the free rules, and their materials.
pub fn glass(index: f64) -> String {
    format!(
        "look_at eye {{ pixeldim 12 9 position 0.2 0.5 3 target 0 0 0 angle 45 rules free transfer linear }}
         glass g {{ index {index} }} glass i {{ index {} }}\n",
        1.0 / index
    )
}
