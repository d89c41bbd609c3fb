//! A maximum error of colours, as options take it: in levels of 255, or in percent of white.

use std::fmt;
use std::str::FromStr;
use tabray_core::text::{short, shortest};

/// The number of levels from black to white.
pub const LEVELS: f64 = 255.0;

/// The least number of levels that is taken as such: a smaller number is more likely meant as a part of white.
const LEAST: f64 = 0.1;

/// A maximum error of colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaxError {
    /// The number that was given: of levels, or percent.
    number: f64,
    is_percent: bool,
}

impl MaxError {
    /// Returns the error, where 1 is white.
    pub fn of_white(self) -> f64 {
        self.number / if self.is_percent { 100.0 } else { LEVELS }
    }
}

impl FromStr for MaxError {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let percent = text.strip_suffix('%');
        let number = percent.unwrap_or(text).trim_end().parse().ok();
        let error = number.map(|number| Self { number, is_percent: percent.is_some() });
        let Some(error) = error.filter(|error| error.number > 0.0 && error.of_white() < 1.0) else {
            return Err("give levels of 255 as `2` or `0.5`, or percent of white as `0.5%`; both are above 0, and below \
                        255 or 100%"
                .to_owned());
        };
        if !error.is_percent && error.number < LEAST {
            let [meant, taken] = [100.0 * error.number, 100.0 * error.of_white()].map(short);
            return Err(format!(
                "did you mean `{meant}%` of white? A number without `%` counts levels of 255, and this one would be `{taken}%`"
            ));
        }
        Ok(error)
    }
}

impl fmt::Display for MaxError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = shortest(self.number);
        match self.is_percent {
            true => write!(f, "{number} % of white ({})", levels(self.of_white())),
            false => {
                let noun = if self.number == 1.0 { "level" } else { "levels" };
                write!(f, "{number} {noun} of 255 ({} % of white)", short(100.0 * self.of_white()))
            }
        }
    }
}

/// Writes an error, where 1 is white, in levels.
pub fn levels(of_white: f64) -> String {
    format!("{} levels of 255", short(LEVELS * of_white))
}

/// Writes an error, where 1 is white, as the options take it.
pub fn option(of_white: f64) -> String {
    let levels = LEVELS * of_white;
    if levels < LEAST { format!("{}%", short(100.0 * of_white)) } else { short(levels) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> Result<MaxError, String> {
        text.parse()
    }

    #[test]
    fn an_error_is_in_levels_or_a_part_of_white_and_says_so() {
        for (text, of_white, said) in [
            ("51", 0.2, "51 levels of 255 (20 % of white)"),
            ("1", 1.0 / 255.0, "1 level of 255 (0.392 % of white)"),
            ("254.9", 254.9 / 255.0, "254.9 levels of 255 (99.961 % of white)"),
            ("20%", 0.2, "20 % of white (51 levels of 255)"),
            ("1 %", 0.01, "1 % of white (2.55 levels of 255)"),
            ("0.004%", 0.00004, "0.004 % of white (0.01 levels of 255)"),
        ] {
            let error = error(text).expect(text);
            assert!((error.of_white() - of_white).abs() < 1e-15, "{text}");
            assert_eq!(error.to_string(), said);
        }
    }

    #[test]
    fn an_error_of_white_or_more_or_nothing_is_refused() {
        for wrong in [
            "", "%", "0", "0%", "-1", "255", "256", "100%", "100 %", "101%", "nan", "inf", "1e999",
            "2 levels",
        ] {
            assert!(error(wrong).is_err_and(|said| said.starts_with("give levels")), "{wrong}");
        }
    }

    #[test]
    fn a_small_number_may_be_meant_as_a_part_of_white() {
        for (text, asked) in [("0.01", "did you mean `1%` of white?"), ("0.004", "`0.4%`"), ("0.05", "`5%`")]
        {
            assert!(error(text).is_err_and(|said| said.contains(asked)), "{text}");
        }
        assert!(error("0.1").is_ok() && error("0.00001%").is_ok());
    }

    #[test]
    fn an_error_that_is_written_as_an_option_is_taken_again() {
        for of_white in [1e-9, 0.00004, 0.004, 0.01, 0.5] {
            let read = error(&option(of_white)).expect("an error").of_white();
            assert!((read / of_white - 1.0).abs() < 0.01, "{of_white}: {read}");
        }
    }
}
