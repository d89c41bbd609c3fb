//! The notes' cone: 4 wide at its base, 6 high.

use crate::profile::Profile;

inventory::submit! {
    Profile::new("cone", "a cone 6 high, 4 wide at its base: -4/6 (y - 6)", |y| -4.0 / 6.0 * (y - 6.0), |_| -4.0 / 6.0).number(1)
}
