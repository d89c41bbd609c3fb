//! Colours by the angle of a direction: each channel is a cosine.

use glam::DVec2;
use tabray_exact::scalar::{Scalar, per_axis};
use tabray_world::material::{Look, Material, Rgb};
use tabray_world::number::Number;

/// The red, green and blue of a direction at the angle t: `1 + cos(frequency t + phase)` for each channel, times the
/// brightness.
#[derive(Clone, Copy)]
pub struct CosinePalette {
    /// Red, green and blue.
    pub hues: [Hue; 3],
    /// Half of the brightest possible channel value.
    pub brightness: f64,
}

/// A channel. Its phase is an angle plus a number of thirds of a turn.
#[derive(Clone, Copy)]
pub struct Hue {
    frequency: i64,
    phase: f64,
    thirds: usize,
    /// The cosine and the sine of the angle.
    turn: DVec2,
}

impl CosinePalette {
    /// Tells whether the palette is that of the notes: frequency 2, with phases a third of a turn apart.
    pub fn are_of_the_notes(&self) -> bool {
        let is_of_the_notes =
            |(channel, hue): (usize, &Hue)| (hue.frequency, hue.phase, hue.thirds) == (2, 0.0, channel);
        self.hues.iter().enumerate().all(is_of_the_notes)
    }

    /// Returns the colour in a direction. The angle itself is not computed, which avoids the rounding of `acos` and
    /// arguments outside of its domain.
    #[inline]
    pub fn colour<const OF_THE_NOTES: bool, N: Number>(&self, [x, y]: [N; 2]) -> [N; 3] {
        let n = N::constant;
        let within = |of: N| of.max(n(-1.0)).min(n(1.0));
        let plain = x.plain().zip(y.plain()).map(|(x, y)| DVec2::new(x, y));
        let channels = if let Some(toward) = plain {
            // The point itself has no direction, and cosine and sine count as 0.
            let DVec2 { x, y } = (toward / toward.abs().max_element()).try_normalize().unwrap_or(DVec2::ZERO);
            if OF_THE_NOTES {
                let twice = (x * x - y * y, 2.0 * x * y);
                per_axis(|thirds| n(channel(thirds, twice)))
            } else {
                per_axis(|at| {
                    let hue = &self.hues[at];
                    let multiple = hue.multiple((x, y), |part| part);
                    n(channel(hue.thirds, turned(multiple, hue.turn.into(), |part| part)))
                })
            }
        } else {
            let square = x.powi(2) + y.powi(2);
            if OF_THE_NOTES || self.are_of_the_notes() {
                let twice = (within((x.powi(2) - y.powi(2)) / square), within(n(2.0) * x * y / square));
                per_axis(|thirds| channel(thirds, twice))
            } else {
                let (x, y) = (within(x / square.sqrt()), within(y / square.sqrt()));
                per_axis(|at| {
                    let hue = &self.hues[at];
                    let turn = (n(hue.phase).cos(), n(hue.phase).sin());
                    channel(hue.thirds, turned(hue.multiple((x, y), within), turn, within))
                })
            }
        };
        per_axis(|at| n(self.brightness) * channels[at])
    }

    /// Bounds the reflectivities of a shader with these ambient colours and the material's other reflectivities.
    pub fn brightest(&self, material: &Material) -> Option<Look> {
        // The largest sum of 1 and a cosine is 2, up to a few ulps, far less than 1e-6.
        let ambient = Rgb::splat(2.000001 * self.brightness);
        Some(Look { ambient, ..material.brightest_times(Rgb::ONE)? })
    }
}

impl Hue {
    /// Makes a channel. Its phase is `phase`, in radians, plus a number of thirds of a turn.
    pub fn new(frequency: i64, phase: f64, thirds: usize) -> Self {
        Self { frequency, phase, thirds, turn: DVec2::new(libm::cos(phase), libm::sin(phase)) }
    }

    /// Returns the cosine and the sine of an angle times the frequency.
    fn multiple<N: Scalar>(&self, angle: (N, N), within: impl Fn(N) -> N) -> (N, N) {
        (1..self.frequency).fold(angle, |multiple, _| turned(multiple, angle, &within))
    }
}

/// Returns the cosine and the sine of the sum of two angles.
fn turned<N: Scalar>((cos, sin): (N, N), (x, y): (N, N), within: impl Fn(N) -> N) -> (N, N) {
    (within(cos * x - sin * y), within(cos * y + sin * x))
}

/// Returns 1 plus the cosine of the sum of an angle and some thirds of a turn.
fn channel<N: Scalar>(thirds: usize, (cos, sin): (N, N)) -> N {
    let (one, half) = (N::constant(1.0), N::constant(0.5));
    let half_root_3 = half * N::constant(3.0).sqrt();
    match thirds {
        0 => one + cos,
        1 => one - half * cos - half_root_3 * sin,
        _ => one - half * cos + half_root_3 * sin,
    }
}
