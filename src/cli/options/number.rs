//! Options whose value is a whole number.

use std::ops::RangeInclusive;

/// Returns a parser of whole numbers in a range; its error names the range.
pub fn whole<N: TryFrom<u32>>(range: RangeInclusive<u32>) -> impl Fn(&str) -> Result<N, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number)).map(N::try_from);
        let (first, last) = (range.start(), range.end());
        number.and_then(Result::ok).ok_or_else(|| format!("give a whole number from {first} to {last}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_of_the_range_is_told_the_range() {
        let threads = whole::<u16>(1..=1024);
        assert_eq!([threads("1"), threads("1024")], [Ok(1), Ok(1024)]);
        for wrong in ["0", "1025", "-1", "1.5", "1e3", "", "many", "99999999999999999999"] {
            assert_eq!(threads(wrong), Err("give a whole number from 1 to 1024".to_owned()), "{wrong}");
        }
        assert_eq!(whole::<u8>(0..=300)("256"), Err("give a whole number from 0 to 300".to_owned()));
    }
}
