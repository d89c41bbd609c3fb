//! Normals given by a mesh file.

use super::creases::{Normals, flat_normal};
use super::read::NO_VALUE;
use super::to_world::ToWorld;
use glam::DVec3;
use std::sync::Arc;

impl Normals {
    /// Takes the normals that a file gives for the corners of faces. Where a normal is missing, 0, not finite or not
    /// within 90 degrees of the face's own, that of `others` replaces it. If the sum of a face's normals points to the
    /// other side of the face, they are reversed. Returns the number of corners whose normals were not taken.
    pub(super) fn given(
        given: Self,
        vertices: &[DVec3],
        faces: &[[u32; 3]],
        placement: &ToWorld,
        others: impl FnOnce() -> Self,
    ) -> (Self, usize) {
        let Self { mut values, faces: corners } = given;
        let mut corners = Arc::unwrap_or_clone(corners);
        values.iter_mut().for_each(|normal| *normal = placed(*normal, placement));
        // The index of each reversed normal, by the index of the original.
        let mut turned = Vec::new();
        let (mut left, mut refused, count) = (Vec::new(), 0, values.len());
        for (face, indices) in corners.iter_mut().enumerate() {
            let flat = flat_normal(vertices, faces[face]);
            let cosines = indices.map(|index| {
                let normal = values.get(index as usize).copied().unwrap_or_default();
                DVec3::from(normal.map(f64::from)).dot(flat)
            });
            let is_turned = cosines.iter().sum::<f64>() < 0.0;
            for (side, index) in indices.iter_mut().enumerate() {
                let cosine = if is_turned { -cosines[side] } else { cosines[side] };
                if cosine <= 0.0 {
                    refused += usize::from(*index != NO_VALUE);
                    left.push((face, side));
                } else if is_turned {
                    turned.resize(count, NO_VALUE);
                    let place = &mut turned[*index as usize];
                    if *place == NO_VALUE {
                        *place = values.len() as u32;
                        values.push(values[*index as usize].map(|part| -part));
                    }
                    *index = *place;
                }
            }
        }
        if !left.is_empty() {
            let (others, before) = (others(), values.len() as u32);
            values.extend(others.values);
            for (face, side) in left {
                corners[face][side] = before + others.faces[face][side];
            }
        }
        (Self { values, faces: corners.into() }, refused)
    }
}

/// Transforms a normal to world space, and normalizes it. A normal without a direction becomes 0.
fn placed(normal: [f32; 3], placement: &ToWorld) -> [f32; 3] {
    let placed = placement.place_normal(DVec3::from(normal.map(f64::from)));
    let unit = if placed.is_finite() { placed.normalize_or_zero() } else { DVec3::ZERO };
    unit.to_array().map(|part| part as f32)
}

#[cfg(test)]
mod tests {
    use crate::mesh::read::{AtCorners, Attributes, Model, NO_VALUE};
    use crate::mesh::tests::closed;
    use crate::mesh::{Look, Surface, ToWorld};
    use glam::DVec3;
    use std::sync::Arc;
    use tabray_world::geometry::placement::Rotation;

    /// Returns a ball with vertex normals that a function computes from the positions.
    fn ball(normal: impl Fn(DVec3) -> DVec3) -> Model {
        let Model { vertices, faces, .. } = closed(&[1.0], 8);
        let values = vertices.iter().map(|at| normal(*at).to_array().map(|part| part as f32)).collect();
        let normals = AtCorners::of_vertices(values, &faces);
        Model {
            vertices,
            faces,
            attributes: Attributes { normals, ..Attributes::default() },
            ..Model::default()
        }
    }

    fn surface(model: Model, scale: DVec3) -> Surface {
        let placement = ToWorld::new(scale, Rotation::NONE, DVec3::new(3.0, 1.0, 2.0));
        let look = Look { crease: Some(0.0), is_two_sided: true };
        Surface::new(model, &placement, look).unwrap_or_else(|_| panic!("a surface"))
    }

    /// Asserts that normals are those of an ellipsoid with these half axes.
    #[track_caller]
    fn is_round(surface: &Surface, scale: DVec3) {
        for face in 0..surface.face_count() {
            for (at, normal) in surface.corners(face).into_iter().zip(surface.corner_normals(face)) {
                let right = ((at - DVec3::new(3.0, 1.0, 2.0)) / (scale * scale)).normalize();
                assert!((DVec3::from(normal) - right).length() < 1e-6, "{normal:?} {right}");
            }
        }
    }

    #[test]
    fn normals_of_a_file_are_placed_with_it_and_agree_with_the_side_of_faces() {
        for scale in [DVec3::ONE, DVec3::new(1.0, 3.0, 0.5), DVec3::new(-1.0, 1e-3, 20.0)] {
            is_round(&surface(ball(|at| 7.0 * at), scale), scale);
            // Normals may point inward, and faces may be reversed while their normals stay.
            is_round(&surface(ball(|at| -at), scale), scale);
            let mut model = ball(|at| at);
            model.faces.iter_mut().step_by(3).for_each(|face| face.swap(0, 1));
            Arc::make_mut(&mut model.attributes.normals.faces)
                .iter_mut()
                .step_by(3)
                .for_each(|face| face.swap(0, 1));
            is_round(&surface(model, scale), scale);
        }
    }

    #[test]
    fn normals_that_are_of_no_use_are_those_of_faces() {
        for bad in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, -DVec3::Y] {
            let model = ball(|at| if at == DVec3::Y { bad } else { at });
            let surface = surface(model, DVec3::ONE);
            assert_eq!(surface.remarks[0].message, "does not use the file's normals at 16 corners", "{bad}");
            for face in 0..surface.face_count() {
                let [a, b, c] = surface.corners(face);
                let flat = (b - a).cross(c - a).normalize();
                for (at, normal) in [a, b, c].into_iter().zip(surface.corner_normals(face)) {
                    let is_top = (at - DVec3::new(3.0, 2.0, 2.0)).length() < 1e-9;
                    assert!(!is_top || (DVec3::from(normal) - flat).length() < 1e-6);
                }
            }
        }
        let mut model = ball(|at| at);
        Arc::make_mut(&mut model.attributes.normals.faces)[5] = [NO_VALUE; 3];
        assert!(surface(model, DVec3::ONE).remarks.is_empty());
    }
}
