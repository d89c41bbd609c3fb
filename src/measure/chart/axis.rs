//! Logarithmic axes: maps numbers to positions, and chooses the numbers to write beside them.

/// A logarithmic axis.
pub struct Axis {
    low: f64,
    high: f64,
    /// The positions of the axis's ends, in pixels.
    from: f64,
    to: f64,
}

impl Axis {
    /// Makes an axis for numbers above 0. `before` and `behind` are the fractions of the axis that stay free below the
    /// least and above the greatest number; `from` and `to` are the positions of its ends, in pixels.
    pub fn new(
        numbers: impl Iterator<Item = f64>,
        (before, behind): (f64, f64),
        (from, to): (f64, f64),
    ) -> Self {
        const LEAST: f64 = 1.2;
        let (low, high) = numbers
            .map(libm::log10)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), log| (log.min(low), log.max(high)));
        let (low, high) = if low <= high { (low, high) } else { (-1.0, 0.0) };
        let missing = (0.5 * (LEAST - (high - low))).max(0.0);
        let (low, high) = (low - missing, high + missing);
        let decades = (high - low) / (1.0 - before - behind);
        Self { low: low - before * decades, high: high + behind * decades, from, to }
    }

    /// Returns the position of a number, in pixels.
    pub fn at(&self, number: f64) -> f64 {
        self.from + (libm::log10(number) - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// Returns the positions of the tick marks, in pixels, and their labels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        const MAX_LABELS: f64 = 9.0;
        let decades = self.high - self.low;
        let step = (decades / MAX_LABELS).ceil().max(1.0) as i32;
        let steps: &[f64] = if decades < 3.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        (first..=last)
            .filter(|exponent| exponent.rem_euclid(step) == 0)
            .flat_map(|exponent| steps.iter().map(move |step| (*step, exponent)))
            .map(|(digit, exponent)| (digit * 10_f64.powi(exponent), written(digit, exponent)))
            .filter(|(number, _)| (self.low..=self.high).contains(&libm::log10(*number)))
            .collect()
    }
}

/// Writes a number of one digit times a power of ten.
fn written(digit: f64, exponent: i32) -> String {
    if (-3..=4).contains(&exponent) {
        let decimals = (-exponent).max(0) as usize;
        return format!("{:.decimals$}", digit * 10_f64.powi(exponent));
    }
    let raised = |letter: char| match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    let power: String = exponent.to_string().chars().map(raised).collect();
    if digit == 1.0 { format!("10{power}") } else { format!("{digit}·10{power}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(low: f64, high: f64) -> Vec<String> {
        let axis = Axis::new([low, high].into_iter(), (0.0, 0.0), (0.0, 100.0));
        axis.ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(ticks(40.0, 900.0), ["50", "100", "200", "500"]);
        assert_eq!(ticks(1e-16, 1e-1), ["10⁻¹⁶", "10⁻¹⁴", "10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "0.01"]);
        assert_eq!(ticks(0.09, 20_000.0), ["0.1", "1", "10", "100", "1000", "10000"]);
    }

    #[test]
    fn equal_ratios_are_equally_far_apart() {
        let axis = Axis::new([1.0, 100.0].into_iter(), (0.0, 0.0), (0.0, 100.0));
        assert_eq!([1.0, 10.0, 100.0].map(|number| axis.at(number).round()), [0.0, 50.0, 100.0]);
    }
}
