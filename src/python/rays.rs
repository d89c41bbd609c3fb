//! Rays as arrays.

use crate::arrays::{Rows, Vectors, View, numbers};
use crate::hits::Hits;
use glam::DVec3;
use numpy::PyReadonlyArray1;
use numpy::ndarray::ArrayView1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use tabray_core::query::{Query, QueryRay};
use tabray_rays::hits::Ray;

/// The rays of a query.
pub struct Rays<'py> {
    count: usize,
    origins: Rows<'py>,
    directions: Rows<'py>,
    ends: Option<PyReadonlyArray1<'py, f64>>,
    leaves: Option<[PyReadonlyArray1<'py, i32>; 2]>,
}

/// A view of the rays, for other threads.
pub struct RayView<'a> {
    /// The number of rays.
    pub count: usize,
    origins: View<'a>,
    directions: View<'a>,
    ends: Option<ArrayView1<'a, f64>>,
    /// The objects and the surfaces that the rays leave.
    leaves: Option<[ArrayView1<'a, i32>; 2]>,
}

impl<'py> Rays<'py> {
    /// Takes the arrays of rays.
    pub fn of(
        origins: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        t_max: Option<&Bound<'py, PyAny>>,
        leaves: Option<&Bound<'py, Hits>>,
    ) -> PyResult<Self> {
        let [from, along] = [Vectors::of(origins, "origins")?, Vectors::of(directions, "directions")?];
        let count = match (from.count(), along.count()) {
            (Some(one), Some(other)) if one != other => {
                return Err(PyValueError::new_err(format!(
                    "there are {one} origins and {other} directions: give as many of both, or one for all"
                )));
            }
            (one, other) => one.or(other).unwrap_or(1),
        };
        let leaves = leaves.map(|hits| hits.get().starts(hits.py(), count)).transpose()?;
        let ends = t_max.map(|ends| numbers(ends, "t_max", count)).transpose()?;
        Ok(Self { count, origins: from.rows(count)?, directions: along.rows(count)?, ends, leaves })
    }

    /// Returns a view of the rays.
    pub fn view(&self) -> RayView<'_> {
        let ends = self.ends.as_ref().map(|ends| ends.as_array());
        let leaves = self.leaves.as_ref().map(|leaves| leaves.each_ref().map(PyReadonlyArray1::as_array));
        let (origins, directions) = (self.origins.view(), self.directions.view());
        RayView { count: self.count, origins, directions, ends, leaves }
    }
}

impl RayView<'_> {
    /// Returns a ray with the t of its end, or a message about its fault.
    pub fn ray(&self, query: &Query, index: usize) -> Result<Ray, String> {
        let (origin, dir) = (self.origins.row(index), self.directions.row(index));
        let ray = QueryRay::new(origin, dir).ok_or_else(|| match dir == DVec3::ZERO {
            true => format!("the direction of ray {index} is 0: a ray goes somewhere"),
            false => format!("ray {index} is not finite: its origin is {origin}, and its direction {dir}"),
        })?;
        let ray = match self.leaves {
            None => ray,
            Some(leaves) => {
                let [object, surface] = leaves.map(|of| usize::try_from(of[index]).ok());
                let start = object.zip(surface).and_then(|(object, surface)| query.start(object, surface));
                ray.leaving(start.ok_or_else(|| {
                    format!("`leaves` has no proven hit for ray {index}: take those that hit, as in `hits[hits.verdict == 1]`")
                })?)
            }
        };
        let end = self.ends.map_or(f64::INFINITY, |ends| ends[index]);
        if end > 0.0 {
            Ok((ray, end))
        } else {
            Err(format!("`t_max` of ray {index} is {end}: give a positive number"))
        }
    }
}
