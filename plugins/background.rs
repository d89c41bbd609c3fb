//! A background of one colour.

use tabray::prelude::*;

static COLOUR: Pparm<Rgb> =
    Pparm::required("colour", "the red, green and blue of every ray that hits nothing, where 1 is white")
        .alias(&["color"])
        .must("0 or more in each channel", |colour| colour.min_element() >= 0.0);

const TABLE: Table = &[&COLOUR];

inventory::submit! {
    Entity::background("background", "one colour where there is no object", &[TABLE], |args| {
        Ok(Box::new(Uniform(args.get(&COLOUR))))
    })
}

struct Uniform(Rgb);

impl Background for Uniform {
    fn colour<N: Number>(&self, _toward: [N; 3]) -> [N; 3] {
        constants(self.0)
    }

    fn brightest(&self) -> Rgb {
        self.0
    }
}
