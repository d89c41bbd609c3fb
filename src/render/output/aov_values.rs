//! The numbers behind auxiliary images, pixel by pixel, for images that are assembled from parts: the colour that
//! shows a pixel may depend on all others.

use crate::output::aov::{self, Aov, Layer, PixelError, Setting};
use crate::plan::Plan;
use crate::trace::{self, PixelBound};
use glam::DVec3;

/// The numbers of a pixel. A number that an image does not need is 0, and a number that does not exist is NaN.
pub type Values = [f64; 3];

impl Aov {
    /// Computes the numbers of a pixel. `x` counts from the left and `y` from the bottom; `truth` is as in
    /// [`render`](Self::render).
    pub fn values(self, plan: &Plan, truth: &Plan, x: usize, y: usize) -> Values {
        match self {
            Self::Depth => [aov::depth_at(plan, x, y), 0.0, 0.0],
            Self::Normal => aov::normal_at(plan, x, y).map_or([f64::NAN; 3], |normal| normal.to_array()),
            Self::Object => [aov::object_at(plan, x, y).map_or(f64::NAN, f64::from), 0.0, 0.0],
            Self::Face => [aov::face_at(plan, x, y).map_or(f64::NAN, f64::from), 0.0, 0.0],
            Self::Colour => trace::pixel(plan, x, y).to_array(),
            Self::Cost => [aov::cost_at(plan, x, y) as f64, 0.0, 0.0],
            Self::Samples => {
                let (count, error) = trace::samples(plan, x, y);
                [f64::from(count), error.unwrap_or(f64::NAN), 0.0]
            }
            Self::Error if plan.camera.certain => {
                let PixelBound { error, is_certified, footprints } =
                    trace::bounded(plan, x, y).unwrap_or_default();
                [error, f64::from(u8::from(is_certified)), f64::from(footprints)]
            }
            Self::Error => {
                let PixelError { colour, distance, is_other } = PixelError::of(plan, truth, x, y);
                [colour, distance, f64::from(u8::from(is_other))]
            }
            Self::Undecided => [f64::from(u8::from(trace::is_undecided(plan, x, y))), 0.0, 0.0],
        }
    }

    /// Makes the image of all numbers, in rows from the top, each from the left: the image that
    /// [`render`](Self::render) makes.
    pub fn layer(self, values: &[Values], setting: &Setting) -> Layer {
        fn all<T>(values: &[Values], of: impl Fn(&Values) -> T) -> Vec<T> {
            values.iter().map(of).collect()
        }
        let is = |number: f64| number != 0.0;
        let index = |[index, ..]: &Values| (!index.is_nan()).then_some(*index as u32);
        match self {
            Self::Depth => aov::depth(&all(values, |[depth, ..]| *depth)),
            Self::Normal => {
                let normal = |numbers: &Values| DVec3::from_array(*numbers);
                aov::normal(&all(values, |numbers| (!numbers[0].is_nan()).then(|| normal(numbers))))
            }
            Self::Object => aov::indices("object", all(values, index)),
            Self::Face => aov::indices("face", all(values, index)),
            Self::Colour => {
                aov::colour(&all(values, |colour| DVec3::from_array(*colour)), &setting.display())
            }
            Self::Cost => aov::cost(&all(values, |[rays, ..]| *rays as u64), setting.size),
            Self::Samples => {
                let of = |[count, error, _]: &Values| (*count as u32, (!error.is_nan()).then_some(*error));
                aov::samples(&all(values, of), setting)
            }
            Self::Error if setting.certain => {
                let of = |[error, certified, footprints]: &Values| PixelBound {
                    error: *error,
                    is_certified: is(*certified),
                    footprints: *footprints as u32,
                };
                aov::bounds(&all(values, of), setting)
            }
            Self::Error => {
                let of = |[colour, distance, other]: &Values| PixelError {
                    colour: *colour,
                    distance: *distance,
                    is_other: is(*other),
                };
                aov::error(&all(values, of), setting.size)
            }
            Self::Undecided => aov::undecided(&all(values, |[undecided, ..]| is(*undecided))),
        }
    }
}
