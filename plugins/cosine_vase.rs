//! A vase with a wide mouth and a wide foot.

use tabray::prelude::*;

inventory::submit! {
    Profile::new("cosine_vase", "a vase with a wide foot", "1 + 0.5 * cos(y)").number(2)
}
