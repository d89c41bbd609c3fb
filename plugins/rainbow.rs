//! The notes' continuously modulated shading: colours that change with the angle around a point.

use super::tiles::Wall;
use tabray::prelude::*;

pub static FREQUENCY: Pparm<WholePerChannel> =
    Pparm::or("frequency", "how often the hues repeat, or red, green and blue each", WholePerChannel([2; 3]))
        .must("from 1 to 64", |each| each.0.iter().all(|frequency| (1..=64).contains(frequency)));
pub static PHASE: Pparm<Phases> = Pparm::or(
    "phase",
    "the angle by which the hues are shifted, or the phases of red, green and blue: 0, 2/3 pi and 4/3 pi in the notes",
    Phases::Shifted(0.0),
)
.unit("radians");
static BRIGHTNESS: Pparm<f64> = Pparm::or("brightness", "half of the strongest colour", 6.0)
    .must("0 or more", |brightness| *brightness >= 0.0);
static ON: Pparm<Wall> = Pparm::or("on", "the wall along which the hues lie", Wall::Backwall);

const TABLE: Table = &[&FREQUENCY, &PHASE, &BRIGHTNESS, &ON];

inventory::submit! {
    Entity::shader("rainbow", "hues around a point, independent of the material", &[TABLE], |args| {
        let (hues, axes) = (CosinePalette::new(args, args.get(&BRIGHTNESS)), args.get(&ON).axes());
        Ok(if hues.are_of_the_notes() && axes == [0, 1] {
            Paint::new(move |anchor| Rainbow::<true> { hues, axes, anchor })
        } else {
            Paint::new(move |anchor| Rainbow::<false> { hues, axes, anchor })
        })
    })
    .on_plane(1)
}

/// Hues around a point: the notes', which is quicker, or any.
struct Rainbow<const OF_THE_NOTES: bool> {
    hues: CosinePalette,
    axes: [usize; 2],
    anchor: Anchor,
}

impl<const OF_THE_NOTES: bool> Shader for Rainbow<OF_THE_NOTES> {
    #[inline]
    fn ambient(&self, _material: &Material, at: &SurfacePoint) -> Rgb {
        let from = at.position - self.anchor.origin;
        let toward =
            if OF_THE_NOTES { from.truncate() } else { DVec2::from(self.axes.map(|axis| from[axis])) };
        self.hues.colour::<OF_THE_NOTES>(toward)
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let from = |axis: usize| at.position[axis] - Interval::constant(self.anchor.origin[axis]);
        Some(LookBounds { ambient: self.hues.enclose(self.axes.map(from)), ..material.into() })
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.hues.brightest(material)
    }
}

/// The phases of red, green and blue: the notes', all shifted by an angle, or one for each.
#[derive(Clone, Copy)]
pub enum Phases {
    Shifted(f64),
    Each([f64; 3]),
}

impl Value for Phases {
    const TYPE: Type = Type::Number;
    const ARITY: Counts = Counts::Of(&[1, 3]);

    fn to_datum(&self) -> Datum {
        match self {
            Self::Shifted(angle) => angle.to_datum(),
            Self::Each(phases) => phases.to_datum(),
        }
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        f64::from_datum(datum).map(Self::Shifted).or_else(|| Value::from_datum(datum).map(Self::Each))
    }
}

/// Red, green and blue for a direction of the angle t: `1 + cos(frequency t + phase)` for each channel, times the
/// brightness.
#[derive(Clone, Copy)]
pub struct CosinePalette {
    hues: [Hue; 3],
    brightness: f64,
}

/// A channel, whose phase is an angle and a number of thirds of a turn.
#[derive(Clone, Copy)]
struct Hue {
    frequency: i64,
    phase: f64,
    thirds: usize,
    /// The cosine and the sine of the angle.
    turn: DVec2,
}

impl CosinePalette {
    /// Makes the palette of an entity whose table has [`FREQUENCY`] and [`PHASE`].
    pub fn new(args: &Args, brightness: f64) -> Self {
        let (WholePerChannel(frequencies), phases) = (args.get(&FREQUENCY), args.get(&PHASE));
        let hues = [0, 1, 2].map(|channel| {
            let (phase, thirds) = match phases {
                Phases::Shifted(phase) => (phase, channel),
                Phases::Each(phases) => (phases[channel], 0),
            };
            let turn = DVec2::new(libm::cos(phase), libm::sin(phase));
            Hue { frequency: frequencies[channel], phase, thirds, turn }
        });
        Self { hues, brightness }
    }

    /// Tells whether the hues come around as the notes' do, twice.
    pub fn are_of_the_notes(&self) -> bool {
        let is_of_the_notes =
            |(channel, hue): (usize, &Hue)| (hue.frequency, hue.phase, hue.thirds) == (2, 0.0, channel);
        self.hues.iter().enumerate().all(is_of_the_notes)
    }

    /// Returns the colour in a direction. The angle itself is not computed, which avoids the rounding of `acos` and
    /// arguments outside of its domain.
    #[inline]
    pub fn colour<const OF_THE_NOTES: bool>(&self, toward: DVec2) -> Rgb {
        // At the point itself there is no direction: cosine and sine count as 0.
        let DVec2 { x, y } = (toward / toward.abs().max_element()).try_normalize().unwrap_or(DVec2::ZERO);
        let channels = if OF_THE_NOTES {
            [0, 1, 2].map(|thirds| channel(thirds, (x * x - y * y, 2.0 * x * y)))
        } else {
            self.hues.map(|hue| {
                let multiple = hue.multiple((x, y), |part| part);
                channel(hue.thirds, turned(multiple, hue.turn.into(), |part| part))
            })
        };
        self.brightness * Rgb::from(channels)
    }

    /// Encloses [`colour`](Self::colour).
    pub fn enclose<F: Precise>(&self, [x, y]: [Interval<F>; 2]) -> [Interval<F>; 3] {
        let n = Interval::<F>::constant;
        let within = |of: Interval<F>| of.max(n(-1.0)).min(n(1.0));
        let square = x.powi(2) + y.powi(2);
        let channels = if self.are_of_the_notes() {
            let twice = (within((x.powi(2) - y.powi(2)) / square), within(n(2.0) * x * y / square));
            [0, 1, 2].map(|thirds| channel(thirds, twice))
        } else {
            let (x, y) = (within(x / square.sqrt()), within(y / square.sqrt()));
            self.hues.map(|hue| {
                let turn = (n(hue.phase).cos(), n(hue.phase).sin());
                channel(hue.thirds, turned(hue.multiple((x, y), within), turn, within))
            })
        };
        channels.map(|channel| n(self.brightness) * channel)
    }

    /// Bounds the reflectivities of a shader whose ambient colours are these, and whose others are the material's.
    pub fn brightest(&self, material: &Material) -> Option<Look> {
        let Material { diffuse, specular, .. } = *material;
        let is_sound = diffuse.min_element() >= 0.0;
        // The largest colour is 2, up to a few ulps; 1e-6 is far more than those.
        is_sound.then_some(Look { ambient: Rgb::splat(2.000001 * self.brightness), diffuse, specular })
    }
}

impl Hue {
    /// Returns the cosine and the sine of the multiple of an angle.
    fn multiple<N: Scalar>(&self, angle: (N, N), within: impl Fn(N) -> N) -> (N, N) {
        (1..self.frequency).fold(angle, |multiple, _| turned(multiple, angle, &within))
    }
}

/// Returns the cosine and the sine of the sum of two angles.
fn turned<N: Scalar>((cos, sin): (N, N), (x, y): (N, N), within: impl Fn(N) -> N) -> (N, N) {
    (within(cos * x - sin * y), within(cos * y + sin * x))
}

/// Returns 1 + the cosine of an angle and some thirds of a turn.
fn channel<N: Scalar>(thirds: usize, (cos, sin): (N, N)) -> N {
    let (one, half) = (N::constant(1.0), N::constant(0.5));
    let half_root_3 = half * N::constant(3.0).sqrt();
    match thirds {
        0 => one + cos,
        1 => one - half * cos - half_root_3 * sin,
        _ => one - half * cos + half_root_3 * sin,
    }
}
