//! The elements of a PLY as bytes of either order.

use super::at_corners::Attributes;
use super::model::{ENDS_EARLY, MemoryBudget, Model, ReadError};
use super::ply_section::{Field, Kind, Number, Section, Vertex, coordinates, normal, uv};
use super::polygons::Polygons;
use glam::DVec3;
use tabray_world::parallel;

/// Reads the elements after the header of a file. If `BIG`, numbers are big-endian.
pub(super) fn read<const BIG: bool>(
    file: &[u8],
    mut rest: &[u8],
    sections: &[Section],
    budget: &MemoryBudget,
) -> Result<(Model, Polygons), ReadError> {
    let (mut model, mut polygons) = (Model::default(), Polygons::default());
    let early = || ReadError::byte(file.len(), ENDS_EARLY);
    for section in sections {
        let place = |rest: &[u8]| file.len() - rest.len();
        if let Some(size) = section.size() {
            let length =
                size.checked_mul(section.count).filter(|length| *length <= rest.len()).ok_or_else(early)?;
            let (elements, after) = rest.split_at(length);
            if section.kind == Kind::Vertex {
                budget.holds(section.count, model.faces.len()).map_err(ReadError::file)?;
                let read = |index: usize| section.vertex::<BIG>(&elements[index * size..][..size]);
                let [has_normals, has_colours, has_uv] =
                    section.reads().map(|reads| if reads { section.count } else { 0 });
                let Attributes { normals, uv: at, colours } = &mut model.attributes;
                model.vertices = vec![DVec3::ZERO; section.count];
                normals.values = vec![[0.0; 3]; has_normals];
                colours.values = vec![[0.0; 4]; has_colours];
                at.values = vec![[0.0; 2]; has_uv];
                parallel::fill(&mut model.vertices, |index| coordinates(&read(index)));
                parallel::fill(&mut normals.values, |index| normal(&read(index)));
                parallel::fill(&mut colours.values, |index| section.colour(&read(index)));
                parallel::fill(&mut at.values, |index| uv(&read(index)));
                if let Some(index) =
                    parallel::find_first(section.count, |index| !model.vertices[index].is_finite())
                {
                    let message = format!("vertex {index} is not finite");
                    return Err(ReadError::byte(place(rest) + index * size, message));
                }
            }
            rest = after;
            continue;
        }
        let (mut given, mut corners, mut uv) = (Vec::new(), Vec::new(), Vec::new());
        for index in 0..section.count {
            let byte = place(rest);
            let error = |message| ReadError::byte(byte, message);
            let mut vertex = Vertex::default();
            given.clear();
            uv.clear();
            for field in &section.fields {
                match *field {
                    Field::Number(number) => drop(take(&mut rest, number.size()).ok_or_else(early)?),
                    Field::Vertex(place, number) => {
                        vertex[place] =
                            scalar::<BIG>(take(&mut rest, number.size()).ok_or_else(early)?, number);
                    }
                    Field::List(length, number)
                    | Field::Corners(length, number)
                    | Field::Uv(length, number) => {
                        let count = whole::<BIG>(take(&mut rest, length.size()).ok_or_else(early)?, length);
                        let count = usize::try_from(count)
                            .map_err(|_| error(format!("a list of {count} numbers makes no sense")))?;
                        let length = count.checked_mul(number.size()).ok_or_else(early)?;
                        let list = take(&mut rest, length).ok_or_else(early)?;
                        if matches!(field, Field::Uv(..)) {
                            budget.holds(section.vertices, model.faces.len() + count).map_err(error)?;
                            let numbers = list.chunks_exact(number.size());
                            uv.extend(numbers.map(|bytes| scalar::<BIG>(bytes, number) as f32));
                        }
                        if matches!(field, Field::Corners(..)) {
                            budget.holds(section.vertices, model.faces.len() + count).map_err(error)?;
                            given.clear();
                            given.extend(
                                list.chunks_exact(number.size()).map(|corner| whole::<BIG>(corner, number)),
                            );
                        }
                    }
                }
            }
            match section.kind {
                Kind::Vertex => {
                    if !coordinates(&vertex).is_finite() {
                        return Err(error(format!("vertex {index} is not finite")));
                    }
                    budget.holds(model.vertices.len(), model.faces.len()).map_err(error)?;
                    section.put(&vertex, &mut model.vertices, &mut model.attributes);
                }
                Kind::Face | Kind::Strips => {
                    let before = model.faces.len();
                    section
                        .add(index, &given, &mut corners, &mut model.faces, &mut polygons)
                        .map_err(error)?;
                    section.put_face(&vertex, &uv, (given.len(), before), &mut model);
                }
                Kind::Other => {}
            }
        }
    }
    Ok((model, polygons))
}

/// Takes `count` bytes, or returns `None` if there are fewer.
fn take<'b>(rest: &mut &'b [u8], count: usize) -> Option<&'b [u8]> {
    let (taken, after) = rest.split_at_checked(count)?;
    *rest = after;
    Some(taken)
}

impl Section {
    /// Returns the length of an element in bytes, if all elements have the same.
    fn size(&self) -> Option<usize> {
        let length = |field: &Field| match *field {
            Field::Number(number) | Field::Vertex(_, number) => Some(number.size()),
            Field::List(..) | Field::Corners(..) | Field::Uv(..) => None,
        };
        // An element without properties has no length.
        self.fields.iter().map(length).sum::<Option<usize>>().filter(|size| *size > 0)
    }

    /// Reads a vertex without lists.
    #[inline(always)]
    fn vertex<const BIG: bool>(&self, element: &[u8]) -> Vertex {
        let (mut vertex, mut start) = (Vertex::default(), 0);
        for field in &self.fields {
            let (Field::Number(number) | Field::Vertex(_, number)) = *field else { continue };
            if let Field::Vertex(place, _) = *field {
                vertex[place] = scalar::<BIG>(&element[start..start + number.size()], number);
            }
            start += number.size();
        }
        vertex
    }
}

/// Reads the bits of a number.
#[inline(always)]
fn bits<const BIG: bool>(bytes: &[u8]) -> u64 {
    match (BIG, bytes.try_into()) {
        (false, Ok(four)) => u32::from_le_bytes(four).into(),
        (true, Ok(four)) => u32::from_be_bytes(four).into(),
        (false, Err(_)) => bytes.iter().rev().fold(0, |bits, byte| bits << 8 | u64::from(*byte)),
        (true, Err(_)) => bytes.iter().fold(0, |bits, byte| bits << 8 | u64::from(*byte)),
    }
}

/// Reads a number of a type.
#[inline(always)]
fn scalar<const BIG: bool>(bytes: &[u8], number: Number) -> f64 {
    match number {
        Number::Float => f32::from_bits(bits::<BIG>(bytes) as u32).into(),
        Number::Double => f64::from_bits(bits::<BIG>(bytes)),
        Number::Signed(_) | Number::Unsigned(_) => whole::<BIG>(bytes, number) as f64,
    }
}

/// Reads a whole number.
#[inline(always)]
fn whole<const BIG: bool>(bytes: &[u8], number: Number) -> i64 {
    let bits = bits::<BIG>(bytes) as i64;
    let unused = 64 - 8 * bytes.len() as u32;
    if let Number::Signed(_) = number { bits << unused >> unused } else { bits }
}
