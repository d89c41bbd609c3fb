//! The notes' continuously modulated shading: colours that change with the angle around a point.

use super::tiles::Wall;
use crate::prelude::*;

pub static FREQUENCY: Pparm<i64> = Pparm::or("frequency", "how often the hues repeat", 2).between(1.0, 64.0);
pub static PHASE: Pparm<f64> =
    Pparm::or("phase", "the angle by which the hues are shifted", 0.0).unit("radians");
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

/// Red, green and blue for a direction of the angle t: `1 + cos(frequency t + phase + k/3)` for channel k, with k/3 in
/// turns, times the brightness.
#[derive(Clone, Copy)]
pub struct CosinePalette {
    frequency: i64,
    phase: f64,
    /// The cosine and the sine of the phase.
    turn: DVec2,
    brightness: f64,
}

impl CosinePalette {
    /// Makes the palette of an entity whose table has [`FREQUENCY`] and [`PHASE`].
    pub fn new(args: &Args, brightness: f64) -> Self {
        let (frequency, phase) = (args.get(&FREQUENCY), args.get(&PHASE));
        Self { frequency, phase, turn: DVec2::new(libm::cos(phase), libm::sin(phase)), brightness }
    }

    /// Tells whether the hues come around as the notes' do, twice.
    pub fn are_of_the_notes(&self) -> bool {
        self.frequency == 2 && self.phase == 0.0
    }

    /// Returns the colour in a direction. The angle itself is not computed, which avoids the rounding of `acos` and
    /// arguments outside of its domain.
    #[inline]
    pub fn colour<const OF_THE_NOTES: bool>(&self, toward: DVec2) -> Rgb {
        // At the point itself there is no direction, and all channels are equal.
        let DVec2 { x, y } = (toward / toward.abs().max_element()).try_normalize().unwrap_or(DVec2::ZERO);
        let (cos, sin) = if OF_THE_NOTES { (x * x - y * y, 2.0 * x * y) } else { self.multiple(x, y) };
        let half_root_3 = 0.5 * 3.0_f64.sqrt();
        let red_to_blue =
            Rgb::new(1.0 + cos, 1.0 - 0.5 * cos - half_root_3 * sin, 1.0 - 0.5 * cos + half_root_3 * sin);
        self.brightness * red_to_blue
    }

    /// Returns the cosine and the sine of the multiple of an angle, turned on by the phase.
    fn multiple(&self, x: f64, y: f64) -> (f64, f64) {
        let (mut cos, mut sin) = (x, y);
        for _ in 1..self.frequency {
            (cos, sin) = (cos * x - sin * y, cos * y + sin * x);
        }
        (cos * self.turn.x - sin * self.turn.y, cos * self.turn.y + sin * self.turn.x)
    }

    /// Encloses [`colour`](Self::colour).
    pub fn enclose<F: Precise>(&self, [x, y]: [Interval<F>; 2]) -> [Interval<F>; 3] {
        let n = Interval::<F>::constant;
        let within = |of: Interval<F>| of.max(n(-1.0)).min(n(1.0));
        let square = x.powi(2) + y.powi(2);
        let (cos, sin) = if self.are_of_the_notes() {
            (within((x.powi(2) - y.powi(2)) / square), within(n(2.0) * x * y / square))
        } else {
            let (x, y) = (within(x / square.sqrt()), within(y / square.sqrt()));
            let turned = |(cos, sin), (x, y)| (within(cos * x - sin * y), within(cos * y + sin * x));
            let multiple = (1..self.frequency).fold((x, y), |angle, _| turned(angle, (x, y)));
            turned(multiple, (n(self.phase).cos(), n(self.phase).sin()))
        };
        let (half, half_root_3) = (n(0.5), n(0.5) * n(3.0).sqrt());
        let colour =
            [n(1.0) + cos, n(1.0) - half * cos - half_root_3 * sin, n(1.0) - half * cos + half_root_3 * sin];
        colour.map(|channel| n(self.brightness) * channel)
    }

    /// Bounds the reflectivities of a shader whose ambient colours are these, and whose others are the material's.
    pub fn brightest(&self, material: &Material) -> Option<Look> {
        let Material { diffuse, specular, .. } = *material;
        let is_sound = diffuse.min_element() >= 0.0;
        // The largest colour is 2, up to a few ulps; 1e-6 is far more than those.
        is_sound.then_some(Look { ambient: Rgb::splat(2.000001 * self.brightness), diffuse, specular })
    }
}
