//! Recognises colours that are meant as 0 to 255.

use super::fault::Fault;
use tabray_core::scene::entity::Args;
use tabray_core::scene::value::Datum;
use tabray_core::text::short;

/// The minimum of the brightest channel of such a colour. Scenes with distant objects have colours of up to some tens.
const LEAST: f64 = 100.0;

/// Returns a warning if a material's colour has integer channels from 0 to 255, with the attribute of that colour.
pub fn warning(material: &Args) -> Option<(&'static str, Fault)> {
    let is_level = |number: &f64| number.fract() == 0.0 && (0.0..=255.0).contains(number);
    material.values().find_map(|(attribute, datum)| match datum {
        Datum::Numbers(numbers)
            if numbers.len() == 3
                && numbers.iter().all(is_level)
                && numbers.iter().any(|number| *number >= LEAST) =>
        {
            let right: Vec<_> = numbers.iter().map(|number| short(number / 255.0)).collect();
            let fault = Fault::warning(None, "colours do not range from 0 to 255")
                .label(format!("write `{}`", right.join(" ")))
                .help("1 is the brightest that an image can show, and such a material will look white");
            Some((attribute.name(), fault))
        }
        _ => None,
    })
}
