//! Attributes of the corners of faces: normals, texture coordinates and colours.

use std::sync::Arc;

/// The index of a corner without a value.
pub const NO_VALUE: u32 = u32::MAX;

/// Values of one kind at the corners of faces.
#[derive(Clone, Debug, PartialEq)]
pub struct AtCorners<T> {
    /// The values.
    pub values: Vec<T>,
    /// For each face, the indices of the values at its corners, or [`NO_VALUE`]. It is empty if no corner has a value.
    /// Values of several kinds often have the same indices, which are then [shared](Self::share).
    pub faces: Arc<Vec<[u32; 3]>>,
}

impl<T> Default for AtCorners<T> {
    fn default() -> Self {
        Self { values: Vec::new(), faces: Arc::default() }
    }
}

impl<T: Copy> AtCorners<T> {
    /// Makes the values at the corners of faces from one value for each vertex. Without values, no corner has one.
    pub fn of_vertices(values: Vec<T>, faces: &[[u32; 3]]) -> Self {
        let faces = if values.is_empty() { Vec::new() } else { faces.to_vec() };
        Self { values, faces: faces.into() }
    }

    /// Tells whether no corner has a value.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Returns the values at the corners of a face, or `None` if one of them has none.
    #[inline]
    pub fn at(&self, face: usize) -> Option<[T; 3]> {
        let [a, b, c] = self.faces.get(face)?.map(|corner| self.values.get(corner as usize).copied());
        Some([a?, b?, c?])
    }

    /// Counts the corners with a value.
    pub fn count(&self) -> usize {
        self.faces.iter().flatten().filter(|corner| **corner != NO_VALUE).count()
    }

    /// Returns the values of these faces, with all values.
    pub fn part(&self, faces: &[usize]) -> Self {
        match self.is_empty() {
            true => Self::default(),
            false => Self {
                values: self.values.clone(),
                faces: faces.iter().map(|face| self.faces[*face]).collect::<Vec<_>>().into(),
            },
        }
    }

    /// Sorts faces into this order, and values by their first use.
    pub fn sorted(self, order: &[u32]) -> Self {
        if self.is_empty() {
            return self;
        }
        let mut faces: Vec<_> = order.iter().map(|face| self.faces[*face as usize]).collect();
        Self { values: in_order_of_use(&self.values, &mut faces), faces: faces.into() }
    }

    /// Shares the list of indices with another attribute if both are equal, to store it once.
    pub fn share(&mut self, other: &Arc<Vec<[u32; 3]>>) {
        if self.faces == *other {
            self.faces = other.clone();
        }
    }

    fn extend(&mut self, other: Self) {
        self.values.extend(other.values);
        Arc::make_mut(&mut self.faces).extend(&*other.faces);
    }

    fn drop_unused(&mut self) {
        if self.values.is_empty() {
            self.faces = Arc::default();
        }
    }

    /// Returns the memory of the values in bytes. The memory of [shared](Self::share) indices is divided equally.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..]) + size_of_val(&self.faces[..]) / Arc::strong_count(&self.faces)
    }
}

/// All attributes of the corners of faces. An attribute that is unwanted or missing in the file is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes {
    /// Normals of any length, in the file's own coordinates.
    pub normals: AtCorners<[f32; 3]>,
    /// Texture coordinates, counted from the left and from the bottom.
    pub uv: AtCorners<[f32; 2]>,
    /// Colours, as linear light, and the fractions that they cover of what is behind them.
    pub colours: AtCorners<[f32; 4]>,
}

impl Attributes {
    /// Tells whether no corner has an attribute.
    pub fn is_empty(&self) -> bool {
        self.normals.is_empty() && self.uv.is_empty() && self.colours.is_empty()
    }

    /// Returns the lists of the attributes that are not empty, with an entry for each face.
    pub fn lists(&mut self) -> impl Iterator<Item = &mut Vec<[u32; 3]>> {
        let lists = [&mut self.normals.faces, &mut self.uv.faces, &mut self.colours.faces];
        lists.into_iter().map(Arc::make_mut).filter(|list| !list.is_empty())
    }

    /// Appends the attributes of further faces.
    pub fn extend(&mut self, Self { normals, uv, colours }: Self) {
        self.normals.extend(normals);
        self.uv.extend(uv);
        self.colours.extend(colours);
    }

    /// Drops the lists of attributes without values.
    pub fn drop_unused(&mut self) {
        self.normals.drop_unused();
        self.uv.drop_unused();
        self.colours.drop_unused();
    }

    /// Keeps only these faces.
    pub fn keep(&mut self, kept: &[u32]) {
        for list in self.lists() {
            *list = kept.iter().map(|face| list[*face as usize]).collect();
        }
    }

    /// Reverses the faces that `is_turned` selects.
    pub fn turn(&mut self, is_turned: impl Fn(usize) -> bool) {
        for list in self.lists() {
            let faces = list.iter_mut().enumerate().filter(|(face, _)| is_turned(*face));
            faces.for_each(|(_, corners)| corners.swap(1, 2));
        }
    }
}

/// Sorts values by their first use at the corners of faces, which keeps the values for a node of the tree close
/// together in memory. Drops unused values.
pub fn in_order_of_use<T: Copy>(all: &[T], faces: &mut [[u32; 3]]) -> Vec<T> {
    let (mut places, mut sorted) = (vec![u32::MAX; all.len()], Vec::with_capacity(all.len()));
    for corner in faces.iter_mut().flatten().filter(|corner| **corner != NO_VALUE) {
        let place = &mut places[*corner as usize];
        if *place == u32::MAX {
            *place = sorted.len() as u32;
            sorted.push(all[*corner as usize]);
        }
        *corner = *place;
    }
    sorted
}
