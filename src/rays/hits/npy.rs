//! NumPy arrays of rays, in NumPy's own format ("NPY format", versions 1 to 3). The crates that read
//! it bring a parser of Python's literals that needs a C compiler.

use std::io::{self, BufRead, Read};
use tabray_core::output::npy::MAGIC;
use tabray_core::text::reason;

/// The origin, the direction and the end of a ray.
pub(super) type Numbers = ([f64; 6], Option<f64>);

/// The maximum length of a header, in bytes.
const LONGEST: usize = 1 << 12;

/// The rows of an array of rays.
pub(super) struct Rows<'r> {
    input: Box<dyn BufRead + 'r>,
    /// The size of a number in bytes, 4 or 8, and whether numbers are little-endian.
    size: usize,
    is_little: bool,
    columns: usize,
    count: u64,
    left: u64,
}

impl<'r> Rows<'r> {
    /// Reads the header of an array.
    pub fn new(mut input: Box<dyn BufRead + 'r>) -> Result<Self, String> {
        let head = head(&mut input).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof | io::ErrorKind::InvalidData => "it is not a NumPy array".to_owned(),
            _ => reason(&error),
        })?;
        let (is_little, size) = match value(&head, "descr") {
            Some("'<f8'") => (true, 8),
            Some("'<f4'") => (true, 4),
            Some("'>f8'") => (false, 8),
            Some("'>f4'") => (false, 4),
            other => {
                let other = other.unwrap_or("of another one");
                return Err(format!("rays are of type `f8` or `f4`; these are {other}"));
            }
        };
        let shape = value(&head, "shape").unwrap_or_default();
        let sides: Vec<Option<u64>> =
            shape.trim_matches(['(', ')', ',']).split(',').map(|side| side.trim().parse().ok()).collect();
        let (count, columns) = match sides[..] {
            [Some(count), Some(columns @ (6 | 7))] => (count, columns as usize),
            _ => return Err(format!("rays are an array of shape (n, 6) or (n, 7); this one's is {shape}")),
        };
        if value(&head, "fortran_order") == Some("True") && count > 1 {
            return Err(
                "its columns are stored one after the other; save `numpy.ascontiguousarray(rays)`".to_owned()
            );
        }
        Ok(Self { input, size, is_little, columns, count, left: count })
    }

    /// Returns the number of rays.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the next ray; `None` at the end.
    pub fn next(&mut self) -> Option<Result<Numbers, (String, bool)>> {
        self.left = self.left.checked_sub(1)?;
        let mut bytes = [0; 7 * 8];
        let bytes = &mut bytes[..self.columns * self.size];
        if let Err(error) = self.input.read_exact(bytes) {
            return Some(Err(unread(&error)));
        }
        let mut ray = [f64::INFINITY; 7];
        if self.size == 4 {
            let read = if self.is_little { f32::from_le_bytes } else { f32::from_be_bytes };
            for (number, bytes) in ray.iter_mut().zip(bytes.as_chunks().0) {
                *number = f64::from(read(*bytes));
            }
        } else {
            let read = if self.is_little { f64::from_le_bytes } else { f64::from_be_bytes };
            for (number, bytes) in ray.iter_mut().zip(bytes.as_chunks().0) {
                *number = read(*bytes);
            }
        }
        let [a, b, c, d, e, f, end] = ray;
        Some(Ok(([a, b, c, d, e, f], (end != f64::INFINITY).then_some(end))))
    }
}

/// Returns why a row cannot be read. It is the last one.
pub(super) fn unread(error: &io::Error) -> (String, bool) {
    let is_short = error.kind() == io::ErrorKind::UnexpectedEof;
    (if is_short { "the array ends before it".to_owned() } else { reason(error) }, true)
}

/// Reads the header of a file: the text of a Python dictionary.
pub(super) fn head(input: &mut dyn BufRead) -> io::Result<String> {
    let invalid = || io::Error::from(io::ErrorKind::InvalidData);
    let mut start = [0; 8];
    input.read_exact(&mut start)?;
    let is_known = matches!(start[6..], [1..=3, 0]);
    if !(start.starts_with(MAGIC) && is_known) {
        return Err(invalid());
    }
    let mut length = [0; 4];
    input.read_exact(&mut length[..if start[6] == 1 { 2 } else { 4 }])?;
    let length = usize::try_from(u32::from_le_bytes(length)).ok().filter(|length| *length <= LONGEST);
    let mut text = vec![0; length.ok_or_else(invalid)?];
    input.read_exact(&mut text)?;
    String::from_utf8(text).map_err(|_| invalid())
}

/// Returns the text of a value in a header.
pub(super) fn value<'h>(head: &'h str, key: &str) -> Option<&'h str> {
    let (_, rest) = head.split_once(&format!("'{key}':"))?;
    let rest = rest.trim_start();
    let end = if rest.starts_with('(') { rest.find(')')? + 1 } else { rest.find([',', '}'])? };
    Some(rest[..end].trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(head: &str, bytes: &[u8]) -> Vec<u8> {
        [MAGIC, &[1, 0], &(head.len() as u16).to_le_bytes(), head.as_bytes(), bytes].concat()
    }

    fn rows(array: &[u8]) -> Result<Rows<'_>, String> {
        Rows::new(Box::new(array))
    }

    #[test]
    fn numbers_of_any_size_and_order_of_bytes_are_read() {
        let numbers = [1.0, 2.0, 3.0, 0.0, 0.0, -1.5_f32];
        for (descr, bytes) in [
            ("<f4", numbers.map(f32::to_le_bytes).concat()),
            (">f4", numbers.map(f32::to_be_bytes).concat()),
            ("<f8", numbers.map(|number| f64::from(number).to_le_bytes()).concat()),
            (">f8", numbers.map(|number| f64::from(number).to_be_bytes()).concat()),
        ] {
            let head = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (1, 6), }}\n");
            let array = array(&head, &bytes);
            let mut rows = rows(&array).expect("an array");
            assert_eq!(rows.count(), 1);
            assert_eq!(rows.next(), Some(Ok((numbers.map(f64::from), None))), "{descr}");
            assert_eq!(rows.next(), None);
        }
    }

    #[test]
    fn a_cut_array_is_refused() {
        const LENGTHS: usize = 150;
        let head = "{'descr': '<f8', 'fortran_order': False, 'shape': (9, 6), }\n";
        let array = array(head, &[0; 9 * 6 * 8]);
        let is_read = |bytes: &[u8]| {
            rows(bytes).is_ok_and(|mut rows| std::iter::from_fn(|| rows.next()).all(|row| row.is_ok()))
        };
        assert!(is_read(&array));
        for cut in 0..LENGTHS {
            let length = array.len() * cut / LENGTHS;
            assert!(!is_read(&array[..length]), "{length} of {} bytes", array.len());
        }
    }

    #[test]
    fn what_is_no_array_of_rays_is_refused_with_the_reason() {
        for (head, says) in [
            ("{'descr': '<i8', 'fortran_order': False, 'shape': (1, 6), }", "these are '<i8'"),
            ("{'descr': '<f8', 'fortran_order': False, 'shape': (6,), }", "this one's is (6,)"),
            ("{'descr': '<f8', 'fortran_order': True, 'shape': (2, 6), }", "numpy.ascontiguousarray"),
            ("{}", "these are of another one"),
        ] {
            let said = rows(&array(head, &[])).err().expect("a reason");
            assert!(said.contains(says), "{said}");
        }
        for bytes in [
            &b"\x93NUMPY"[..],
            b"\x93NUMPY\x01\x00\xff\xff",
            b"\x93NUMPY\x03\x00\xff\xff\xff\xff",
            b"none of it",
        ] {
            assert_eq!(rows(bytes).err().as_deref(), Some("it is not a NumPy array"));
        }
        let short = array("{'descr': '<f8', 'fortran_order': False, 'shape': (9, 6), }", &[0; 47]);
        assert!(rows(&short).expect("a head").next().is_some_and(|row| row.is_err()));
    }
}
