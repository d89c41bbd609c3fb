//! The notes' continuously modulated shading: colours that change with the angle around a point.

use super::tiles::Wall;
use tabray::prelude::*;
use tabray::shapes::cosine_palette::{CosinePalette, Hue};

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
        let (hues, axes) = (palette(args, args.get(&BRIGHTNESS)), args.get(&ON).axes());
        Ok(if hues.are_of_the_notes() && axes == [0, 1] {
            ShaderFactory::new(move |anchor| Rainbow::<true> { hues, axes, anchor })
        } else {
            ShaderFactory::new(move |anchor| Rainbow::<false> { hues, axes, anchor })
        })
    })
    .on_plane(1)
}

/// Makes the palette of an entity whose table has [`FREQUENCY`] and [`PHASE`].
pub fn palette(args: &Args, brightness: f64) -> CosinePalette {
    let (WholePerChannel(frequencies), phases) = (args.get(&FREQUENCY), args.get(&PHASE));
    let hue = |channel: usize| match phases {
        Phases::Shifted(phase) => Hue::new(frequencies[channel], phase, channel),
        Phases::Each(phases) => Hue::new(frequencies[channel], phases[channel], 0),
    };
    CosinePalette { hues: [hue(0), hue(1), hue(2)], brightness }
}

/// Hues around a point: the notes', which is quicker, or any.
struct Rainbow<const OF_THE_NOTES: bool> {
    hues: CosinePalette,
    axes: [usize; 2],
    anchor: Anchor,
}

impl<const OF_THE_NOTES: bool> Shader for Rainbow<OF_THE_NOTES> {
    #[inline(always)]
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let axes = if OF_THE_NOTES { [0, 1] } else { self.axes };
        let from = |axis: usize| at.position[axis] - N::constant(self.anchor.origin[axis]);
        Some(match of {
            Reflectivity::Ambient => self.hues.colour::<OF_THE_NOTES, N>([from(axes[0]), from(axes[1])]),
            _ => constants(material.reflectivity(of)),
        })
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
