//! An upper bound on the mean of numbers of any distribution, some of which have been drawn at random.
//!
//! A gambler who believes that the mean is at least `m` is offered bets whose stakes grow where smaller numbers are
//! drawn. If the mean is at least `m`, the probability that the bets ever multiply the money by `1 / doubt` is at
//! most `doubt` (Ville's inequality). So bets that win that much refute the mean. The bets are about the numbers that
//! are left, since none is drawn twice (I. Waudby-Smith and A. Ramdas, "Estimating means of bounded random variables
//! by betting", 2024).

/// Numbers of at most 1, drawn at random from `all` of them without replacement.
pub(super) struct Drawn<'d> {
    pub numbers: &'d [f64],
    pub all: usize,
}

/// The number of halvings by which the bound is found.
const HALVINGS: usize = 40;

impl Drawn<'_> {
    /// Bounds the mean of all numbers: it is greater than the bound with a probability of at most `doubt`. If all
    /// numbers are known, the bound is their mean.
    pub fn bound(&self, doubt: f64) -> f64 {
        let count = self.numbers.len();
        let mean = self.numbers.iter().sum::<f64>() / count as f64;
        if count >= self.all {
            return mean;
        }
        let stakes = self.stakes(doubt);
        let (mut low, mut high) = (mean.max(0.0), 1.0);
        if !self.is_refuted(high, &stakes, doubt) {
            return high;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            *(if self.is_refuted(middle, &stakes, doubt) { &mut high } else { &mut low }) = middle;
        }
        high
    }

    /// Returns the part of the money that is staked on each number. It depends only on the numbers before.
    fn stakes(&self, doubt: f64) -> Vec<f64> {
        let wanted = -2.0 * libm::log(doubt) / self.numbers.len() as f64;
        let (mut sum, mut squares) = (0.0, 0.25);
        let stake = |(index, number): (usize, &f64)| {
            let count = index as f64 + 1.0;
            let stake = (wanted * count / squares).sqrt().min(1.0);
            sum += number;
            squares += (number - sum / count).powi(2);
            stake
        };
        self.numbers.iter().enumerate().map(stake).collect()
    }

    /// Tells whether the numbers drawn refute that the mean of all is at least this.
    fn is_refuted(&self, mean: f64, stakes: &[f64], doubt: f64) -> bool {
        let mut left = mean * self.all as f64;
        let (mut money, mut most) = (0.0, 0.0_f64);
        for (index, (number, stake)) in self.numbers.iter().zip(stakes).enumerate() {
            let expected = left / (self.all - index) as f64;
            if expected < 0.0 {
                // More than that has been drawn already.
                return false;
            }
            money += libm::log1p(stake * (expected - number));
            most = most.max(money);
            left -= number;
        }
        most >= -libm::log(doubt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_pcg::Pcg32;
    use rand_pcg::rand_core::Rng;

    const DOUBT: f64 = 0.05;

    /// Draws so many of the numbers, and bounds their mean; again and again.
    fn bounds(all: &[f64], count: usize, times: usize) -> Vec<f64> {
        let mut random = Pcg32::new(1, 2);
        let one = |_| {
            let mut all = all.to_vec();
            for index in 0..count {
                let other = index + random.next_u32() as usize % (all.len() - index);
                all.swap(index, other);
            }
            Drawn { numbers: &all[..count], all: all.len() }.bound(DOUBT)
        };
        (0..times).map(one).collect()
    }

    fn mean(numbers: &[f64]) -> f64 {
        numbers.iter().sum::<f64>() / numbers.len() as f64
    }

    #[test]
    fn the_bound_is_wrong_as_seldom_as_it_says_and_no_wider_than_it_must_be() {
        // Few numbers that make up the mean, as the errors of edges do; a few large ones; and many of one size.
        let edges: Vec<f64> = (0..4000).map(|index| if index % 20 == 0 { 0.01 } else { 0.0 }).collect();
        let rare: Vec<f64> = (0..4000).map(|index| if index % 500 == 0 { 0.9 } else { 0.0 }).collect();
        let even: Vec<f64> = (0..4000).map(|index| f64::from(index % 7) / 6.0).collect();
        for (all, most) in [(edges, 0.0035), (rare, 0.0075), (even, 0.56)] {
            let (bounds, mean) = (bounds(&all, 1000, 400), mean(&all));
            let wrong = bounds.iter().filter(|bound| **bound < mean).count();
            // 20 in the mean, and 34 with a probability of 1 in 1000.
            assert!(wrong <= 34, "{wrong} of 400 are below {mean}");
            let wide = self::mean(&bounds);
            assert!(wide < most, "{wide} for {mean}");
        }
    }

    #[test]
    fn what_is_never_drawn_is_bounded_by_the_probability_of_missing_it() {
        // Of 10,000 numbers, 4000 are drawn: n ones are all missed with a probability of about 0.6^n.
        let bound = Drawn { numbers: &[0.0; 4000], all: 10_000 }.bound(DOUBT);
        let least = libm::log(DOUBT) / libm::log(0.6) / 10_000.0;
        assert!(bound > 0.99 * least && bound < 1.1 * least, "{bound} against {least}");
        assert_eq!(Drawn { numbers: &[0.25; 8], all: 8 }.bound(DOUBT), 0.25);
    }
}
