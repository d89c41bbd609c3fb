//! A vase with a wide body and a narrow neck.

use tabray::prelude::*;

inventory::submit! {
    Profile::new("sine_vase", "a vase with a narrow neck", "1 + 0.5 * sin(y)").number(3)
}
