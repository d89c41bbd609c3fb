//! glTF 2.0, as JSON and in the binary container GLB. Read are the triangles of the file's default scene, where its
//! nodes place them, the materials, and for a new scene the first camera and the lights. Skins, morph targets and
//! animations are not read.

mod buffers;
mod json;
mod looks;
mod meshopt;
mod staging;

use super::at_corners::{AtCorners, NO_VALUE};
use super::model::{MAX_VERTICES, MemoryBudget, Model, ReadError, Remark, shown};
use super::textures::first_of;
use buffers::{Buffers, Elements};
use glam::{DMat3, DMat4, DQuat, DVec3};
use json::{Gltf, InstanceAttributes, Node, Primitive};
use memchr::memchr_iter;
use std::path::Path;
use std::sync::Arc;
use tabray_world::text;

/// The first bytes of a GLB.
pub const MAGIC: &[u8] = b"glTF";

/// The supported extensions among those that a file may require.
const EXTENSIONS: [&str; 13] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_materials_pbrSpecularGlossiness",
    // The default materials are shown.
    "KHR_materials_variants",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_materials_unlit",
    "KHR_materials_emissive_strength",
    "KHR_materials_transmission",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_lights_punctual",
];

/// The beginnings of the names of extensions that change nothing, or whose uses are told where they are.
const UNSEEN: [&str; 7] = [
    "KHR_materials_",
    "KHR_animation",
    "KHR_xmp",
    "KHR_audio",
    "EXT_structural_metadata",
    "EXT_mesh_features",
    "CESIUM_",
];

/// The maximum memory of an object of the JSON, in bytes.
const OBJECT: u64 = 512;

/// Reads the bytes of a file in a folder.
pub fn read(bytes: &[u8], folder: &Path, budget: &MemoryBudget) -> Result<Model, ReadError> {
    let (text, own) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
    let is_text = own.is_none();
    if memchr_iter(b'{', text).count() as u64 * OBJECT > budget.left() {
        return Err(ReadError::file("not enough memory for its objects"));
    }
    let json: Gltf = serde_json::from_slice(text).map_err(|error| {
        let message = format!("its JSON is not glTF: {}", shown(error.to_string().as_bytes()));
        if is_text && error.line() > 0 {
            ReadError::line(error.line(), message)
        } else {
            ReadError::file(message)
        }
    })?;
    model(&json, own, folder, budget).map_err(ReadError::file)
}

/// Returns the JSON of a GLB and its binary chunk.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), ReadError> {
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    let early = || ReadError::byte(bytes.len(), "the file ends early");
    let version = word(4).ok_or_else(early)?;
    if version != 2 {
        return Err(ReadError::byte(
            4,
            format!("it is a GLB of version {version}, and only version 2 is read"),
        ));
    }
    if word(8).is_none_or(|length| length as usize > bytes.len()) {
        return Err(early());
    }
    let chunk = |at: usize| {
        let (length, kind) = (word(at)? as usize, word(at + 4)?);
        let end = at.checked_add(8)?.checked_add(length)?;
        Some((kind, bytes.get(at + 8..end)?, end))
    };
    const JSON: u32 = u32::from_le_bytes(*b"JSON");
    const BIN: u32 = u32::from_le_bytes(*b"BIN\0");
    let (kind, text, end) = chunk(12).ok_or_else(early)?;
    if kind != JSON {
        return Err(ReadError::byte(12, "a GLB begins with its JSON"));
    }
    if end >= bytes.len() {
        return Ok((text, Some(&[])));
    }
    let (kind, own, _) = chunk(end).ok_or_else(early)?;
    Ok((text, Some(if kind == BIN { own } else { &[] })))
}

fn model(json: &Gltf, own: Option<&[u8]>, folder: &Path, budget: &MemoryBudget) -> Result<Model, String> {
    if !json.asset.version.starts_with("2.") {
        return Err(match &json.asset.version[..] {
            "" => "it is JSON, but not glTF: it has no `asset` with a version".to_owned(),
            version => format!("it is glTF {}, and only glTF 2 is read", shown(version.as_bytes())),
        });
    }
    let unread = json.extensions_required.iter().find(|name| !EXTENSIONS.contains(&&name[..]));
    if let Some(name) = unread {
        let cure = match &name[..] {
            "KHR_draco_mesh_compression" => "decompress it first, as `gltf-transform cp a.glb b.glb` does",
            "KHR_texture_basisu" => "save its images as PNG",
            _ => "export it without, or as OBJ",
        };
        let name = shown(name.as_bytes());
        return Err(format!("it requires the extension `{name}`, which is not read: {cure}"));
    }
    let buffers = Buffers::read(json, own, folder, budget)?;
    let source = Source { json, buffers: &buffers, budget };
    let mut reading = Reading { source, model: Model::default(), left_out: 0, posed: 0 };
    for (node, placement) in placed(json)? {
        reading.add(node, placement)?;
        staging::add(&mut reading.model.staging, json, node, placement);
    }
    let Reading { mut model, left_out, posed, .. } = reading;
    model.attributes.drop_unused();
    model.files = buffers::files(json, folder);
    looks::furnish(&mut model, json, &buffers, folder, budget)?;
    let is_told = |name: &&String| {
        !EXTENSIONS.contains(&&name[..]) && !UNSEEN.iter().any(|begin| name.starts_with(begin))
    };
    let untold: Vec<_> = json.extensions_used.iter().filter(is_told).collect();
    if !untold.is_empty() {
        let names: Vec<_> = untold.iter().map(|name| format!("`{}`", shown(name.as_bytes()))).collect();
        let message = format!("has extensions in its file that are not read: {}", first_of(&names));
        model.remarks.push(Remark { message, help: "what the file has without them is shown" });
    }
    if left_out > 0 {
        let message =
            format!("leaves out lines or points of its file: {}", text::count(left_out, "primitive"));
        model.remarks.push(Remark { message, help: "only triangles are shown" });
    }
    if posed > 0 {
        let message = format!("shows meshes of its file as they were modelled, without a pose: {posed}");
        model.remarks.push(Remark { message, help: "skins and morph targets are not read" });
    }
    Ok(model)
}

/// Returns the nodes of the default scene, each with its matrix to world space.
fn placed(json: &Gltf) -> Result<Vec<(&Node, DMat4)>, String> {
    let roots = match json.scenes.get(json.scene.unwrap_or(0)) {
        Some(scene) => scene.nodes.clone(),
        None if json.scene.is_some() => {
            return Err("there is no scene of the index that `scene` gives".to_owned());
        }
        // Without scenes, all nodes are used.
        None => {
            let mut is_child = vec![false; json.nodes.len()];
            let children = json.nodes.iter().flat_map(|node| &node.children);
            children
                .for_each(|child| is_child.get_mut(*child).into_iter().for_each(|is_child| *is_child = true));
            (0..json.nodes.len()).filter(|node| !is_child[*node]).collect()
        }
    };
    let (mut is_met, mut found) = (vec![false; json.nodes.len()], Vec::new());
    let mut left: Vec<_> = roots.into_iter().rev().map(|node| (node, DMat4::IDENTITY)).collect();
    while let Some((index, above)) = left.pop() {
        let node = json.nodes.get(index).ok_or_else(|| format!("there is no node {index}"))?;
        if std::mem::replace(&mut is_met[index], true) {
            return Err(format!("node {index} can be reached in two ways, but nodes must form a tree"));
        }
        let placement = above * own(node);
        left.extend(node.children.iter().rev().map(|child| (*child, placement)));
        found.push((node, placement));
    }
    Ok(found)
}

/// Returns the matrix from a node to its parent.
fn own(node: &Node) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        return DMat4::from_cols_array(matrix);
    }
    let rotation = DQuat::from_array(node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
    let length = rotation.length();
    let rotation = if length > 0.0 { rotation * length.recip() } else { DQuat::IDENTITY };
    let [scale, translation] =
        [node.scale.unwrap_or([1.0; 3]), node.translation.unwrap_or([0.0; 3])].map(DVec3::from);
    DMat4::from_translation(translation) * DMat4::from_quat(rotation) * DMat4::from_scale(scale)
}

/// The sources of a model.
#[derive(Clone, Copy)]
struct Source<'f> {
    json: &'f Gltf,
    buffers: &'f Buffers<'f>,
    budget: &'f MemoryBudget,
}

impl<'f> Source<'f> {
    /// Returns the elements of an attribute, one for each vertex, if the primitive has the attribute.
    fn attribute(
        self,
        primitive: &Primitive,
        name: &str,
        widths: &[usize],
    ) -> Result<Option<Elements<'f>>, String> {
        let Some(index) = primitive.attributes.get(name) else { return Ok(None) };
        let elements = self.buffers.elements(*index, widths, self.budget)?;
        let vertices = primitive.attributes.get("POSITION").and_then(|index| self.json.accessors.get(*index));
        match vertices {
            Some(vertices) if vertices.count != elements.count => Err(format!(
                "a primitive has {} of `POSITION` and {} of `{name}`",
                vertices.count, elements.count
            )),
            _ => Ok(Some(elements)),
        }
    }
}

impl Source<'_> {
    /// Returns the matrices of the copies of a mesh.
    fn copies(self, attributes: &InstanceAttributes) -> Result<Vec<DMat4>, String> {
        let InstanceAttributes { translation, rotation, scale } = *attributes;
        let of = |index: Option<usize>, width| {
            index.map(|index| self.buffers.elements(index, &[width], self.budget)).transpose()
        };
        let (translation, rotation, scale) = (of(translation, 3)?, of(rotation, 4)?, of(scale, 3)?);
        let all = [&translation, &rotation, &scale].map(|elements| elements.as_ref().map(|all| all.count));
        let count = all.into_iter().flatten().min().unwrap_or(1);
        let matrix = |index: usize| {
            own(&Node {
                translation: translation.as_ref().map(|all| all.get(index)),
                rotation: rotation.as_ref().map(|all| all.get(index)),
                scale: scale.as_ref().map(|all| all.get(index)),
                ..Node::default()
            })
        };
        Ok((0..count).map(matrix).collect())
    }
}

/// A model in construction.
struct Reading<'f> {
    source: Source<'f>,
    model: Model,
    /// The number of skipped primitives: lines or points.
    left_out: usize,
    /// The number of meshes that other programs show in another pose.
    posed: usize,
}

impl Reading<'_> {
    /// Adds the mesh of a node, if it has one.
    fn add(&mut self, node: &Node, placement: DMat4) -> Result<(), String> {
        let Some(index) = node.mesh else { return Ok(()) };
        let copies = match &node.extensions.instances {
            Some(instances) => self.source.copies(&instances.attributes)?,
            None => vec![DMat4::IDENTITY],
        };
        let mesh = self.source.json.meshes.get(index).ok_or_else(|| format!("there is no mesh {index}"))?;
        let is_posed =
            node.skin.is_some() || mesh.primitives.iter().any(|primitive| !primitive.targets.is_empty());
        self.posed += usize::from(is_posed);
        for copy in copies {
            for primitive in &mesh.primitives {
                self.primitive(primitive, placement * copy)
                    .map_err(|message| format!("in mesh {index}, {message}"))?;
            }
        }
        Ok(())
    }

    fn primitive(&mut self, primitive: &Primitive, placement: DMat4) -> Result<(), String> {
        let mode = primitive.mode.unwrap_or(4);
        if mode < 4 {
            self.left_out += 1;
            return Ok(());
        }
        let source = self.source;
        let Source { json, buffers, budget } = source;
        let Some(positions) = source.attribute(primitive, "POSITION", &[3])? else { return Ok(()) };
        let indices = match primitive.indices {
            None => None,
            Some(index) => Some(buffers.elements(index, &[1], budget)?),
        };
        let count = indices.as_ref().map_or(positions.count, |indices| indices.count);
        let (before, vertices) = (self.model.faces.len(), self.model.vertices.len());
        let triangles = match mode {
            4 => count / 3,
            5 | 6 => count.saturating_sub(2),
            _ => return Err(format!("a primitive has mode {mode}, which glTF does not have")),
        };
        budget.holds(vertices + positions.count, before + triangles)?;
        if vertices + positions.count > MAX_VERTICES {
            return Err("there are more than 2^31 vertices".to_owned());
        }
        let corner = |at: usize| {
            let index = indices.as_ref().map_or(at, |indices| indices.get::<1>(at)[0] as usize);
            if index < positions.count {
                Ok(index as u32)
            } else {
                Err(format!("a face refers to vertex {index}, and there are {}, from 0", positions.count))
            }
        };
        let is_mirrored = DMat3::from_mat4(placement).determinant() < 0.0;
        let mut faces = Vec::with_capacity(triangles);
        for triangle in 0..triangles {
            let [a, b, c] = match mode {
                4 => [3 * triangle, 3 * triangle + 1, 3 * triangle + 2],
                5 => [triangle, triangle + 1 + triangle % 2, triangle + 2 - triangle % 2],
                _ => [triangle + 1, triangle + 2, 0],
            };
            let [b, c] = if is_mirrored { [c, b] } else { [b, c] };
            faces.push([corner(a)?, corner(b)?, corner(c)?]);
        }
        let placed = |at: usize| placement.transform_point3(DVec3::from(positions.get::<3>(at)));
        self.model.vertices.extend((0..positions.count).map(placed));
        if let Some(vertex) = self.model.vertices[vertices..].iter().position(|at| !at.is_finite()) {
            return Err(format!("vertex {vertex} is not finite"));
        }
        let wanted = budget.wanted;
        let of = |is_wanted: bool, name, widths| {
            if is_wanted { source.attribute(primitive, name, widths) } else { Ok(None) }
        };
        let normals = of(wanted.normals, "NORMAL", &[3])?;
        let uv = of(wanted.materials.is_some(), "TEXCOORD_0", &[2])?;
        let colours = of(wanted.materials.is_some(), "COLOR_0", &[3, 4])?;
        let upright = DMat3::from_mat4(placement).inverse().transpose();
        let attributes = &mut self.model.attributes;
        let normal = |normal: [f64; 3]| {
            (upright * DVec3::from(normal)).normalize_or_zero().to_array().map(|part| part as f32)
        };
        add(&mut attributes.normals, wanted.normals, &faces, normals, normal);
        // In glTF, v counts from the upper row of texels.
        add(&mut attributes.uv, wanted.materials.is_some(), &faces, uv, |[u, v]: [f64; 2]| {
            [u as f32, (1.0 - v) as f32]
        });
        let blends =
            |index: usize| json.materials.get(index)?.alpha_mode.as_deref().map(|mode| mode == "BLEND");
        let covers_in_part = wanted.covers_in_part() && primitive.material.and_then(blends) == Some(true);
        let has_alpha = covers_in_part && colours.as_ref().is_some_and(|colours| colours.width == 4);
        let colour = |[red, green, blue, alpha]: [f64; 4]| {
            let [red, green, blue] =
                [red, green, blue].map(|channel| if channel > 0.0 { channel.min(1e6) as f32 } else { 0.0 });
            [red, green, blue, if has_alpha { alpha.clamp(0.0, 1.0) as f32 } else { 1.0 }]
        };
        add(&mut attributes.colours, wanted.materials.is_some(), &faces, colours, colour);
        let slot = match primitive.material {
            None => 0,
            Some(index) if index < json.materials.len() => {
                u16::try_from(index + 1).map_err(|_| "there are more than 65535 materials")?
            }
            Some(index) => return Err(format!("there is no material {index}")),
        };
        let model = &mut self.model;
        model.faces.extend(faces.iter().map(|face| face.map(|corner| corner + vertices as u32)));
        model.slots.resize(model.faces.len(), slot);
        Ok(())
    }
}

/// Adds the attributes of the vertices of faces to the values at corners. Without `elements`, the corners have no
/// value.
fn add<const N: usize, T: Copy>(
    to: &mut AtCorners<T>,
    is_wanted: bool,
    faces: &[[u32; 3]],
    elements: Option<Elements<'_>>,
    value: impl Fn([f64; N]) -> T,
) {
    if !is_wanted {
        return;
    }
    let (before, list) = (to.values.len() as u32, Arc::make_mut(&mut to.faces));
    match elements {
        None => list.extend(faces.iter().map(|_| [NO_VALUE; 3])),
        Some(elements) => {
            to.values.extend((0..elements.count).map(|index| value(elements.get(index))));
            list.extend(faces.iter().map(|face| face.map(|corner| before + corner)));
        }
    }
}
