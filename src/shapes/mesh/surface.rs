//! The surface of a mesh: its vertices, its faces, and the bounding volume hierarchy.

use super::creases::Normals;
use super::edges::Edges;
use super::face;
use super::read::{AtCorners, Attributes, Finish, Map, Model, Remark, in_order_of_use};
use super::to_world::ToWorld;
use super::winding::{self, Openness};
use glam::DVec3;
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::mem::take;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::bvh::Bvh;
use tabray_world::parallel;
use tabray_world::scene::attribute::MAX_LENGTH;
use tabray_world::simd::soa::{LANES, Vectors};
use tabray_world::text;

/// The maximum number of faces.
const MAX_FACES: usize = 1 << 28;

/// The number of surfaces made so far.
static SURFACES: AtomicU64 = AtomicU64::new(0);

/// The winding number just outside of a face. On its inner side, it is greater by 1. It is `None` if unknown, and for a
/// face that meets others beyond shared edges and corners, because it may differ from point to point there.
pub(super) type Depth = Option<i32>;

/// The triangles of a mesh in world space.
///
/// Vertices are placed and rounded once. The triangles of the rounded vertices are the surface, and so faces with a
/// common edge share it exactly.
pub struct Surface {
    /// A number that is unique in this process, and not 0.
    pub(super) id: u64,
    /// The vertices in world coordinates, without duplicates.
    pub(super) vertices: Vec<DVec3>,
    /// Whether the vertices were computed from those of a file or of the scene, and rounded.
    pub are_rounded: bool,
    /// The corners of each face, in the order of the tree, counterclockwise as seen from the outside.
    pub(super) faces: Vec<[u32; 3]>,
    /// For each face, its index in the file, or that of the flat polygon that it is a part of.
    pub(super) order: Vec<u32>,
    /// For each face, the index of its material plus 1, or 0 for none. It is empty if no face has a material.
    pub(super) slots: Vec<u16>,
    /// The normals at the corners of faces of a smoothed mesh.
    pub(super) normals: Normals,
    /// The texture coordinates and the colours at the corners of faces, if they are read.
    pub(super) uv: AtCorners<[f32; 2]>,
    pub(super) colours: AtCorners<[f32; 4]>,
    pub(super) tree: Bvh,
    /// A bounding box of the vertices, in world coordinates.
    pub(super) bounds: Aabb,
    /// The planes of the faces, if the mesh is convex and has few. Found on first use.
    pub(super) planes: OnceLock<Option<Box<[[DVec3; 2]]>>>,
    /// The winding numbers before the faces of a closed mesh, unless the faces are the boundary of its inside. Found on
    /// first use.
    pub(super) depths: OnceLock<Option<Arc<[Depth]>>>,
    /// The edges that keep the surface from being closed.
    pub why_not_closed: Openness,
    /// Whether both sides of an open surface are lit.
    pub(super) is_two_sided: bool,
    /// Deviations from what the file says.
    pub remarks: Vec<Remark>,
    /// The names of the file's materials.
    pub materials: Vec<String>,
    /// The materials of the file, if they are read.
    pub(super) finishes: Vec<Option<Finish>>,
    /// The files that the mesh's file names, whether they exist or not.
    pub files: Vec<PathBuf>,
}

/// What faces have beside their corners, in the order of the faces.
struct Faces {
    order: Vec<u32>,
    slots: Vec<u16>,
    normals: Normals,
    uv: AtCorners<[f32; 2]>,
    colours: AtCorners<[f32; 4]>,
}

/// Options for making a surface from triangles.
#[derive(Clone, Copy, Debug, Default)]
pub struct Look {
    /// The maximum angle between faces, in degrees, at which their edge is smoothed, or `None` for flat faces. With
    /// normals from a file, it applies to corners without one.
    pub crease: Option<f64>,
    /// Whether faces are reoriented consistently, and lit on both sides. Otherwise, an open surface is lit on the side
    /// from which the corners of a face run counterclockwise.
    pub is_two_sided: bool,
}

/// The reason why the triangles of a file do not make a surface.
pub enum SurfaceError {
    /// A coordinate is so large that its square overflows.
    TooLarge,
    /// There are more faces than the tree can hold.
    TooMany,
    /// No face has an area.
    NoArea,
}

impl SurfaceError {
    /// Returns the error, phrased to follow the mesh's name, and its correction.
    pub fn message(&self) -> (&'static str, &'static str) {
        match self {
            Self::TooLarge => (
                "has coordinates so large that their squares overflow",
                "the coordinates in the world must not exceed 1e152",
            ),
            Self::TooMany => ("has more than 2^28 faces", "split it into several meshes"),
            Self::NoArea => ("has no face with an area", "the corners of a face must not lie on one line"),
        }
    }
}

impl Surface {
    /// Makes the surface of a file's triangles.
    ///
    /// # Errors
    /// Returns the reason why there is no surface.
    pub fn new(model: Model, placement: &ToWorld, look: Look) -> Result<Self, SurfaceError> {
        if model.faces.len() > MAX_FACES {
            return Err(SurfaceError::TooMany);
        }
        let Model {
            vertices,
            mut faces,
            materials,
            slots,
            sides,
            finishes,
            mut attributes,
            mut remarks,
            files,
            staging: _,
        } = model;
        let vertices = merge(vertices, &mut faces, placement);
        attributes.turn(|_| placement.is_mirrored());
        let is_far = |at: DVec3| !at.is_finite() || at.abs().max_element() > MAX_LENGTH;
        if parallel::find_first(vertices.len(), |vertex| is_far(vertices[vertex])).is_some() {
            return Err(SurfaceError::TooLarge);
        }
        let mut order: Vec<u32> = (0..faces.len() as u32).collect();
        let has_area =
            |face: &u32| face::has_area(faces[*face as usize].map(|corner| vertices[corner as usize]));
        let total = order.len();
        order =
            parallel::map_ranges(total, 2, &|range| order[range].iter().copied().filter(has_area).collect());
        if order.is_empty() {
            return Err(SurfaceError::NoArea);
        }
        remarks.extend(degenerate(total - order.len()));
        let mut kept: Vec<_> = order.iter().map(|face| faces[*face as usize]).collect();
        attributes.keep(&order);
        if attributes.is_empty() {
            drop(take(&mut faces));
        }
        let mut edges = Edges::of(&kept, vertices.len());
        if look.is_two_sided {
            let count = winding::turn(&vertices, &mut kept, &edges);
            remarks.extend(turned(count, kept.len()));
            if count > 0 {
                edges = Edges::of(&kept, vertices.len());
                attributes.turn(|face| kept[face] != faces[order[face] as usize]);
            }
        }
        drop(take(&mut faces));
        let why_not_closed = winding::why_not_closed(&edges);
        let Attributes { normals, uv, colours } = attributes;
        let of_faces = |crease| Normals::of(&vertices, &kept, &edges, crease);
        let normals = if normals.is_empty() {
            look.crease.map_or_else(Normals::default, of_faces)
        } else {
            let others = || of_faces(look.crease.unwrap_or(0.0));
            let (normals, refused) = Normals::given(normals, &vertices, &kept, placement, others);
            remarks.extend(unfit(refused));
            normals
        };
        drop(edges);
        let slots = match slots[..] {
            [] => slots,
            _ => order.iter().map(|face| slots[*face as usize]).collect(),
        };
        if !sides.is_empty() {
            order.iter_mut().for_each(|face| *face = sides[*face as usize]);
        }
        Ok(Self {
            are_rounded: !placement.is_identity(),
            why_not_closed,
            is_two_sided: look.is_two_sided,
            remarks,
            materials,
            finishes,
            files,
            ..Self::sorted(&vertices, &kept, Faces { order, slots, normals, uv, colours })
        })
    }

    /// Returns the surface that consists of these faces, in the order of a tree. It is taken for a closed one.
    fn sorted(vertices: &[DVec3], corners: &[[u32; 3]], of_faces: Faces) -> Self {
        let Faces { order, slots, normals, uv, colours } = of_faces;
        let mut tree = Bvh::of(corners.len(), |face| {
            Aabb::around(&corners[face].map(|corner| vertices[corner as usize]))
        });
        let sorted = tree.take_order();
        let mut faces: Vec<_> = sorted.iter().map(|face| corners[*face as usize]).collect();
        let vertices = in_order_of_use(vertices, &mut faces);
        let (normals, mut uv, mut colours) =
            (normals.sorted(&sorted), uv.sorted(&sorted), colours.sorted(&sorted));
        uv.share(&normals.faces);
        colours.share(if uv.is_empty() { &normals.faces } else { &uv.faces });
        let slots = match slots[..] {
            [] => slots,
            _ => sorted.iter().map(|face| slots[*face as usize]).collect(),
        };
        Self {
            id: 1 + SURFACES.fetch_add(1, Ordering::Relaxed),
            bounds: Aabb::around(&vertices),
            vertices,
            are_rounded: false,
            faces,
            order: sorted.iter().map(|face| order[*face as usize]).collect(),
            slots,
            normals,
            uv,
            colours,
            tree,
            planes: OnceLock::new(),
            depths: OnceLock::new(),
            why_not_closed: Openness::default(),
            is_two_sided: false,
            remarks: Vec::new(),
            materials: Vec::new(),
            finishes: Vec::new(),
            files: Vec::new(),
        }
    }

    /// Returns the part of the surface that consists of the faces whose slots are kept; `None` without any. Faces keep
    /// their numbers, and the sides that are lit.
    pub fn part(&self, is_kept: impl Fn(u16) -> bool) -> Option<Self> {
        let slot = |face: usize| self.slots.get(face).copied().unwrap_or(0);
        let kept: Vec<_> = (0..self.face_count()).filter(|face| is_kept(slot(*face))).collect();
        let faces: Vec<_> = kept.iter().map(|face| self.faces[*face]).collect();
        let of_faces = Faces {
            order: kept.iter().map(|face| self.order[*face]).collect(),
            slots: kept.iter().map(|face| slot(*face)).collect(),
            normals: self.normals.part(&kept),
            uv: self.uv.part(&kept),
            colours: self.colours.part(&kept),
        };
        (!kept.is_empty()).then(|| Self {
            are_rounded: self.are_rounded,
            why_not_closed: winding::why_not_closed(&Edges::of(&faces, self.vertices.len())),
            is_two_sided: self.is_two_sided || self.is_closed(),
            materials: self.materials.clone(),
            finishes: self.finishes.clone(),
            ..Self::sorted(&self.vertices, &faces, of_faces)
        })
    }

    /// Tells whether the file gives the appearance of its faces, as far as this is read.
    pub fn has_looks(&self) -> bool {
        !self.colours.is_empty() || self.finishes.iter().any(Option::is_some)
    }

    /// Returns a material of the file, given by its index plus 1.
    pub(super) fn finish(&self, slot: u16) -> Option<&Finish> {
        self.finishes.get(usize::from(slot).checked_sub(1)?)?.as_ref()
    }

    /// Returns the images of the materials. An image that is used several times is repeated.
    fn maps(&self) -> impl Iterator<Item = &Map> {
        self.finishes.iter().flatten().flat_map(Finish::maps)
    }

    /// Tells whether each edge joins faces in pairs of consistent orientation.
    #[inline]
    pub fn is_closed(&self) -> bool {
        self.why_not_closed == Openness::default()
    }

    /// Returns the low and the high corner of a box around the surface, in world coordinates.
    pub fn bounds(&self) -> [DVec3; 2] {
        [self.bounds.low, self.bounds.high]
    }

    /// Counts the parts of the surface. Faces of a part are connected by edges of two faces.
    pub fn count_parts(&self) -> usize {
        winding::count_parts(&self.faces, self.vertices.len())
    }

    /// Returns the number of faces.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Returns the memory of the surface, in bytes.
    pub fn bytes(&self) -> u64 {
        let Self { vertices, faces, order, slots, normals, uv, colours, tree, .. } = self;
        let arrays = [
            size_of_val(&vertices[..]),
            size_of_val(&faces[..]),
            size_of_val(&order[..]),
            size_of_val(&slots[..]),
            normals.bytes(),
            uv.bytes(),
            colours.bytes(),
        ];
        let textures: BTreeMap<_, _> =
            self.maps().map(|map| (Arc::as_ptr(&map.texture), map.texture.bytes())).collect();
        (arrays.iter().sum::<usize>() + tree.bytes()) as u64 + textures.values().sum::<u64>()
    }

    /// Calls a function with all data that the surface was made from, as bytes.
    pub(super) fn bytes_of(&self, each: &mut dyn FnMut(&[u8])) {
        let Self { vertices, faces, order, slots, normals, uv, colours, materials, .. } = self;
        vertices.iter().flat_map(|at| at.to_array()).for_each(|part| each(&part.to_le_bytes()));
        faces.iter().flatten().chain(order).for_each(|index| each(&index.to_le_bytes()));
        slots.iter().for_each(|slot| each(&slot.to_le_bytes()));
        normals.values.iter().flatten().for_each(|part| each(&part.to_le_bytes()));
        colours.values.iter().flatten().for_each(|part| each(&part.to_le_bytes()));
        uv.values.iter().flatten().for_each(|part| each(&part.to_le_bytes()));
        for list in [&normals.faces, &uv.faces, &colours.faces] {
            list.iter().flatten().for_each(|index| each(&index.to_le_bytes()));
        }
        materials.iter().for_each(|name| each(name.as_bytes()));
        for finish in &self.finishes {
            each(&[u8::from(finish.is_some())]);
            finish.iter().for_each(|finish| finish.bytes_of(each));
        }
    }

    /// Returns the corners of a face in world coordinates.
    #[inline(always)]
    pub(super) fn corners(&self, face: usize) -> [DVec3; 3] {
        let [a, b, c] = self.faces[face];
        [self.vertices[a as usize], self.vertices[b as usize], self.vertices[c as usize]]
    }

    /// Returns the corners of eight faces in world coordinates: all first corners, all second ones, and all third ones.
    #[inline(always)]
    pub(super) fn corners_of(&self, faces: &[usize; LANES]) -> [Vectors<LANES>; 3] {
        let mut corners = [Vectors::ZERO, Vectors::ZERO, Vectors::ZERO];
        for lane in 0..LANES {
            let [a, b, c] = self.corners(faces[lane]);
            corners[0].set(lane, a);
            corners[1].set(lane, b);
            corners[2].set(lane, c);
        }
        corners
    }
}

/// Places the vertices of faces, and merges those at the same position. Drops vertices without a face.
fn merge(vertices: Vec<DVec3>, faces: &mut [[u32; 3]], placement: &ToWorld) -> Vec<DVec3> {
    const UNKNOWN: u32 = u32::MAX;
    let mut merged: Vec<DVec3> = Vec::with_capacity(vertices.len());
    let mut known = HashMap::with_capacity(vertices.len());
    let is_mirrored = placement.is_mirrored();
    let mut indices = vec![UNKNOWN; vertices.len()];
    for face in faces.iter_mut() {
        for corner in face.iter_mut() {
            let index = &mut indices[*corner as usize];
            if *index == UNKNOWN {
                let at = placement.place(vertices[*corner as usize]);
                *index = match known.entry(at.to_array().map(f64::to_bits)) {
                    Entry::Occupied(other) => *other.get(),
                    Entry::Vacant(free) => {
                        merged.push(at);
                        *free.insert(merged.len() as u32 - 1)
                    }
                };
            }
            *corner = *index;
        }
        if is_mirrored {
            face.swap(1, 2);
        }
    }
    merged.shrink_to_fit();
    merged
}

/// Returns a remark about faces without an area, if there are any.
fn degenerate(count: usize) -> Option<Remark> {
    (count > 0).then(|| Remark {
        message: format!("leaves out {} without an area", text::count(count, "face")),
        help: "the corners of such a face lie on one line: no ray hits it",
    })
}

/// Returns a remark about unused normals of the file, if there are any.
fn unfit(count: usize) -> Option<Remark> {
    (count > 0).then(|| Remark {
        message: format!("does not use the file's normals at {}", text::count(count, "corner")),
        help: "they are 0, or point away from the face's side: there, the normals are those of the faces, smoothed \
               except across creases",
    })
}

/// Returns a remark about reversed faces, if there are any.
fn turned(count: usize, all: usize) -> Option<Remark> {
    (count > 0).then(|| Remark {
        message: format!("turns {count} of {}", text::count(all, "face")),
        help: "its faces now agree, and those of closed parts face outward; `sides one` leaves them as the file has \
               them",
    })
}
