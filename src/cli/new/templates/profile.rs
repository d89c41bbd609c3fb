//! A template: a cup 4 high, with rings around it. Say here what it is.

use crate::prelude::*;

// What scenes call it, what it is, and the distance from the axis as a formula in the height y: numbers,
// + - * / ^ and parentheses, functions such as sin, exp and sqrt.
inventory::submit! {
    Profile::new("template", "a cup 4 high, with rings", "1 + y^2/16 + 0.1 * sin(6*y)")
}
