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
}

impl Shader for Ramp {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::of(&self.by)
    }

    /// A formula without a value counts as the smallest.
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let (n, own): (_, [N; 3]) = (N::constant, constants(material.reflectivity(of)));
        if of == Reflectivity::Specular {
            return Some(own);
        }
        let part = (at.value(&self.by)? - n(self.from)) / (n(self.to) - n(self.from));
        let place = n(0.0).max(part).min(n(1.0)) * n(self.last() as f64);
        // Between each two neighbouring colours.
        let of = |index: usize| {
            let along = n(0.0).max(place - n(index as f64)).min(n(1.0));
            N::mean(constants(self.colours[index]), constants(self.colours[index + 1]), along)
        };
        let [first, last] = place.floors().map(|at| (at as usize).min(self.last() - 1));
        Some(product(own, (first..=last).map(of).reduce(hull)?))
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_times(self.colours.iter().fold(Rgb::ZERO, |most, colour| most.max(*colour)))
    }
}
