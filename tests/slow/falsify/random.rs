//! Random numbers, the same in every run.

/// The generator SplitMix64 (Steele, Lea and Flood 2014).
pub struct Random(u64);

pub type Point = [f64; 3];

impl Random {
    pub fn new(class: &str, number: u64) -> Self {
        let seed = class.bytes().fold(14_695_981_039_346_656_037, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(1_099_511_628_211)
        });
        let mut random = Self(seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        random.next();
        random
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mix = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mix = (mix ^ mix >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mix ^ mix >> 31
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    pub fn below(&mut self, count: u64) -> u64 {
        self.next() % count
    }

    /// Returns true once in `count` times on average.
    pub fn once_in(&mut self, count: u64) -> bool {
        self.below(count) == 0
    }

    /// Returns 10 to a random power between `low` and `high`.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.between(low, high))
    }

    /// Returns a random integer from `low` to `high`.
    pub fn whole(&mut self, low: i64, high: i64) -> f64 {
        (low + self.below((high - low + 1) as u64) as i64) as f64
    }

    /// Returns a small factor of either sign, from 1e-16 to 1e-2 in magnitude, or sometimes 0.
    pub fn offset(&mut self) -> f64 {
        match self.below(16) {
            0 => 0.0,
            1 => self.sign() * 1e-16 * self.whole(1, 9),
            _ => self.sign() * self.power(-15.0, -2.0),
        }
    }

    pub fn sign(&mut self) -> f64 {
        if self.once_in(2) { -1.0 } else { 1.0 }
    }

    /// Returns a random unit vector, uniformly distributed.
    pub fn direction(&mut self) -> Point {
        loop {
            let at = [0; 3].map(|_| self.between(-1.0, 1.0));
            let square = dot(at, at);
            if (0.01..1.0).contains(&square) {
                return unit(at);
            }
        }
    }

    /// Returns a direction that is often the y axis or a vector of small integers. It need not have unit length.
    pub fn axis(&mut self) -> Point {
        match self.below(4) {
            0 => [0.0, 1.0, 0.0],
            1 => loop {
                let axis = [0; 3].map(|_| self.whole(-3, 3));
                if axis != [0.0; 3] {
                    break axis;
                }
            },
            _ => {
                let size = self.power(-2.0, 2.0);
                self.direction().map(|part| part * size)
            }
        }
    }
}

pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn unit(of: Point) -> Point {
    let length = dot(of, of).sqrt();
    of.map(|part| part / length)
}

pub fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns `at + by * along`.
pub fn moved(at: Point, by: f64, along: Point) -> Point {
    [0, 1, 2].map(|axis| at[axis] + by * along[axis])
}

/// Returns two unit vectors that are perpendicular to a vector and to each other.
pub fn across(of: Point) -> [Point; 2] {
    let least = (0..3).min_by(|a, b| of[*a].abs().total_cmp(&of[*b].abs())).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let one = unit(cross(of, other));
    [one, cross(unit(of), one)]
}

/// Returns a unit vector perpendicular to another vector, turned around it by an angle in radians.
pub fn turned(of: Point, angle: f64) -> Point {
    let [one, other] = across(of);
    moved(one.map(|part| part * angle.cos()), angle.sin(), other)
}
