//! The edges of a mesh, and the faces beside each edge.

/// The sides of all faces, sorted by edge.
pub(super) struct Edges {
    /// For each vertex, the index of the first side with this vertex as its lower end. The number of all sides follows.
    starts: Vec<u32>,
    /// The upper end, the face, and whether the side starts at the upper end.
    sides: Vec<Side>,
}

/// A side of a face.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side(u64);

impl Side {
    /// Returns the face.
    pub fn face(self) -> usize {
        (self.0 >> 1) as usize & ((1 << 28) - 1)
    }

    /// Tells whether the side starts at the end with the higher index.
    pub fn is_back(self) -> bool {
        self.0 & 1 == 1
    }
}

impl Edges {
    /// Sorts the sides of faces between `vertices` vertices. There are at most 2^28 faces, and 2^31 vertices.
    pub fn of(faces: &[[u32; 3]], vertices: usize) -> Self {
        let sides_of = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)];
        let mut starts = vec![0_u32; vertices + 1];
        for (from, to) in faces.iter().flat_map(|face| sides_of(*face)) {
            starts[from.min(to) as usize] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        // Each range is filled from its end, which leaves its start in `starts`.
        let mut sides = vec![Side(0); 3 * faces.len()];
        for (face, corners) in faces.iter().enumerate().rev() {
            for (from, to) in sides_of(*corners) {
                let start = &mut starts[from.min(to) as usize];
                *start -= 1;
                let other = u64::from(from.max(to));
                sides[*start as usize] = Side(other << 29 | (face as u64) << 1 | u64::from(from > to));
            }
        }
        for pair in starts.windows(2) {
            sides[pair[0] as usize..pair[1] as usize].sort_unstable();
        }
        Self { starts, sides }
    }

    /// Returns the sides on each edge, in the order of their faces.
    pub fn iter(&self) -> impl Iterator<Item = &[Side]> {
        let around = self.starts.windows(2).map(|pair| &self.sides[pair[0] as usize..pair[1] as usize]);
        around.flat_map(|around| around.chunk_by(|one, other| one.0 >> 29 == other.0 >> 29))
    }
}
