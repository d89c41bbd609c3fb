//! Colours by a number: a formula chooses the place on a ramp of colours.

use tabray::prelude::*;

static BY: Pparm<SurfaceField> = Pparm::required("by", "the number that is shown at each point");
static FROM: Pparm<f64> =
    Pparm::or("from", "the number that the first colour stands for, and all smaller ones", -1.0);
static TO: Pparm<f64> =
    Pparm::or("to", "the number that the last colour stands for, and all larger ones", 1.0);
static COLOURS: Pparm<Option<List<Rgb, 2, 256>>> = Pparm::or(
    "colours",
    "the factors of the ambient and diffuse colours, equally far apart; by default, from blue through white to red",
    None,
)
.alias(&["colors"])
.must("0 or more in each channel", |colours: &Option<List<Rgb, 2, 256>>| {
    colours.iter().flat_map(|List(colours)| colours).all(|colour| colour.min_element() >= 0.0)
});

const TABLE: Table = &[&BY, &FROM, &TO, &COLOURS];

/// Blue, white and red: values above the middle differ in hue from values below it, and values far from the middle are
/// darker.
const DIVERGING: [Rgb; 3] = [Rgb::new(0.03, 0.13, 0.75), Rgb::new(0.9, 0.9, 0.9), Rgb::new(0.72, 0.03, 0.03)];

inventory::submit! {
    Entity::shader("ramp", "colours by a number that a formula gives", &[TABLE], |args| {
        let (from, to) = (args.get(&FROM), args.get(&TO));
        if from >= to {
            return Err(Refusal {
                attribute: Some("to"),
                message: "has a ramp that ends where it begins, or before".to_owned(),
                help: "`to` is larger than `from`; to turn the colours round, list them in the other order",
            });
        }
        let colours = args.get(&COLOURS).map_or(DIVERGING.to_vec(), |List(colours)| colours);
        let ramp = Ramp { by: args.get(&BY), from, to, colours };
        Ok(ShaderFactory::new(move |_| ramp.clone()))
    })
}

#[derive(Clone)]
struct Ramp {
    by: SurfaceField,
    from: f64,
    to: f64,
    colours: Vec<Rgb>,
}

impl Ramp {
    /// Returns the index of the last colour.
    fn last(&self) -> usize {
        self.colours.len() - 1
    }

    /// Returns the factor of the colours at a point; NaN counts as the smallest value.
    fn factor(&self, at: &SurfacePoint) -> Rgb {
        let part = (self.by.at(at.variables()) - self.from) / (self.to - self.from);
        let place = (if part > 0.0 { part.min(1.0) } else { 0.0 }) * self.last() as f64;
        let index = (place as usize).min(self.last() - 1);
        between(self.colours[index], self.colours[index + 1], place - index as f64)
    }
}

impl Shader for Ramp {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::of(&self.by)
    }

    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        material.ambient * self.factor(at)
    }

    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        material.diffuse * self.factor(at)
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let n = Interval::<F>::constant;
        let last = n(self.last() as f64);
        let part = (at.value(&self.by)? - n(self.from)) / (n(self.to) - n(self.from));
        let place = (part * last).max(n(0.0)).min(last);
        // For each two neighbouring colours, the blend between them at these places.
        let of = |index: usize| {
            let along = (place - n(index as f64)).max(n(0.0)).min(n(1.0));
            let (one, next) = (self.colours[index], self.colours[index + 1]);
            per_axis(|channel| n(one[channel]) + along * (n(next[channel]) - n(one[channel])))
        };
        let meets = |index: &usize| {
            let range = place.coarse();
            range.low <= (index + 1) as f64 && *index as f64 <= range.high
        };
        let hull = |one: [Interval<F>; 3], other: [Interval<F>; 3]| {
            per_axis(|channel| one[channel].hull(other[channel]))
        };
        let factor = (0..self.last()).filter(meets).map(of).reduce(hull)?;
        let times = |own: [Interval<F>; 3]| per_axis(|channel| own[channel] * factor[channel]);
        let look = LookBounds::from(material);
        Some(LookBounds { ambient: times(look.ambient), diffuse: times(look.diffuse), ..look })
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        let most = self.colours.iter().fold(Rgb::ZERO, |most, colour| most.max(*colour));
        let is_sound = diffuse.min_element() >= 0.0;
        is_sound.then(|| Look { ambient: ambient * most, diffuse: diffuse * most, specular })
    }
}
