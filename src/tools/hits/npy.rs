//! NumPy arrays of rays and of answers.

use npyz::{DType, NpyFile, NpyReader, Order, TypeChar};
use std::io::BufRead;
use tabray_core::text::reason;

/// The origin, the direction and the end of a ray.
pub(super) type Numbers = ([f64; 6], Option<f64>);

/// The rows of an array of rays.
pub(super) struct Rows<'r> {
    numbers: NumberReader<'r>,
    columns: u64,
    count: u64,
}

enum NumberReader<'r> {
    F64(NpyReader<f64, Box<dyn BufRead + 'r>>),
    F32(NpyReader<f32, Box<dyn BufRead + 'r>>),
}

impl<'r> Rows<'r> {
    /// Reads the head of an array.
    pub fn new(input: Box<dyn BufRead + 'r>) -> Result<Self, String> {
        let file = NpyFile::new(input).map_err(|error| reason(&error))?;
        let [count, columns @ (6 | 7)] = *file.shape() else {
            let shape: Vec<_> = file.shape().iter().map(u64::to_string).collect();
            return Err(format!(
                "rays are an array of shape (n, 6) or (n, 7); this one's is ({})",
                shape.join(", ")
            ));
        };
        if file.order() == Order::Fortran && count > 1 {
            return Err(
                "its columns are stored one after the other; save `numpy.ascontiguousarray(rays)`".to_owned()
            );
        }
        let dtype = file.dtype();
        let is = |size| match &dtype {
            DType::Plain(of) => of.type_char() == TypeChar::Float && of.num_bytes() == Some(size),
            _ => false,
        };
        let numbers = match (is(8), is(4)) {
            (true, _) => file.data().ok().map(NumberReader::F64),
            (_, true) => file.data().ok().map(NumberReader::F32),
            _ => None,
        };
        let numbers =
            numbers.ok_or_else(|| format!("rays are of type `f8` or `f4`; these are {}", dtype.descr()))?;
        Ok(Self { numbers, columns, count })
    }

    /// Returns the number of rays.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the next ray; `None` at the end.
    pub fn next(&mut self) -> Option<Result<Numbers, (String, bool)>> {
        let mut ray = [0.0; 7];
        for number in &mut ray[..self.columns as usize] {
            let read = match &mut self.numbers {
                NumberReader::F64(numbers) => numbers.next()?,
                NumberReader::F32(numbers) => numbers.next()?.map(f64::from),
            };
            match read {
                Ok(read) => *number = read,
                Err(error) => return Some(Err((reason(&error), true))),
            }
        }
        let [a, b, c, d, e, f, end] = ray;
        Some(Ok(([a, b, c, d, e, f], (self.columns == 7 && end != f64::INFINITY).then_some(end))))
    }
}

/// An answer as a record of an array.
#[derive(npyz::AutoSerialize, npyz::Serialize)]
pub(super) struct Record {
    pub verdict: u8,
    pub proof: u8,
    pub object: i32,
    pub face: i32,
    pub t: f64,
    pub t_low: f64,
    pub t_high: f64,
    pub distance: f64,
    pub point: [f64; 3],
    pub normal: [f64; 3],
    pub uv: [f64; 2],
}
