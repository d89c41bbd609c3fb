//! The notes' gold vase.

use tabray::prelude::*;

inventory::submit! {
    Profile::new("vase", "a vase with a wide body", "2 + sin(y)").number(0)
}
