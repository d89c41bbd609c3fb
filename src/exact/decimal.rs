//! Decimal numbers in human notation.

/// The reason why a word is not a finite number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DecimalFault {
    /// The word is a number other than 0 that would be rounded to 0.
    TooSmall,
    /// The word is a number that would be rounded to infinity.
    TooLarge,
    /// The word means infinity or "not a number".
    NotFinite,
    /// The word is not a number.
    NotANumber,
}

impl DecimalFault {
    /// Describes the word, to follow a noun.
    pub fn what(self) -> &'static str {
        match self {
            Self::TooSmall => "too small",
            Self::TooLarge => "too large",
            Self::NotFinite => "not a finite number",
            Self::NotANumber => "not a number",
        }
    }

    /// Returns a hint for a correction, if there is one.
    pub fn help(self) -> Option<&'static str> {
        let help = "numbers nearer to 0 than 5e-324 underflow to 0: write 0 if that is meant";
        (self == Self::TooSmall).then_some(help)
    }
}

/// Reads a finite number.
///
/// # Errors
/// Returns the reason why the word is not a finite number.
#[inline]
pub fn read(word: &str) -> Result<f64, DecimalFault> {
    match word.parse::<f64>() {
        Ok(0.0) if underflows(word) => Err(DecimalFault::TooSmall),
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) if word.contains(|c: char| c.is_ascii_digit()) => Err(DecimalFault::TooLarge),
        Ok(_) => Err(DecimalFault::NotFinite),
        Err(_) => Err(DecimalFault::NotANumber),
    }
}

/// Tells whether a word that is parsed as 0 stands for a nonzero number.
fn underflows(word: &str) -> bool {
    let mut digits = word.bytes().take_while(|byte| !byte.eq_ignore_ascii_case(&b'e'));
    digits.any(|byte| matches!(byte, b'1'..=b'9'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_that_underflows_is_not_read_as_0() {
        for word in ["1e-400", "-2.5E-330", "0.001e-9999"] {
            assert_eq!(read(word), Err(DecimalFault::TooSmall), "{word}");
        }
        for word in ["0", "-0.0", "0e-400", ".0e5", "0.000E+9"] {
            assert_eq!(read(word), Ok(0.0), "{word}");
        }
        assert_eq!(read("5e-324"), Ok(5e-324));
    }
}
