//! The notes' cone: 4 wide at its base, 6 high.

use crate::prelude::*;

inventory::submit! {
    Profile::new("cone", "a cone of height 6 and base radius 4", "-4/6 * (y - 6)").number(1)
}
