//! The notes' cone: base radius 4, height 6.

use tabray::prelude::*;

inventory::submit! {
    Profile::new("cone", "a cone of height 6 and base radius 4", "-4/6 * (y - 6)").number(1)
}
