//! A template: a cup 4 high, with rings around it. Describe it here.

use tabray::prelude::*;

// Its name in scenes, its meaning, and the distance from the axis as a formula in the height y, made of numbers,
// + - * / ^, parentheses and functions such as sin, exp and sqrt.
inventory::submit! {
    Profile::new("template", "a cup 4 high, with rings", "1 + y^2/16 + 0.1 * sin(6*y)")
}
