//! Models as files of each format, plainly written.

use super::Model;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

impl Model {
    pub fn obj(&self) -> String {
        let vertices = self.vertices.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        let face = |face: &Vec<usize>| {
            let corners: String = face.iter().map(|corner| format!(" {}", corner + 1)).collect();
            format!("f{corners}\n")
        };
        vertices.chain(self.faces.iter().map(face)).collect()
    }

    fn ply_header(&self, format: &str) -> String {
        let (vertices, faces) = (self.vertices.len(), self.faces.len());
        format!(
            "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
             element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
        )
    }

    pub fn ply(&self) -> String {
        let vertices: String = self.vertices.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
        let face = |face: &Vec<usize>| {
            let corners: String = face.iter().map(|corner| format!(" {corner}")).collect();
            format!("{}{corners}\n", face.len())
        };
        self.ply_header("ascii") + &vertices + &self.faces.iter().map(face).collect::<String>()
    }

    pub fn ply_bytes(&self, is_big: bool) -> Vec<u8> {
        let order = if is_big { "binary_big_endian" } else { "binary_little_endian" };
        let four = |bits: u32| if is_big { bits.to_be_bytes() } else { bits.to_le_bytes() };
        let mut bytes = self.ply_header(order).into_bytes();
        self.vertices.iter().flatten().for_each(|part| bytes.extend(four(part.to_bits())));
        for face in &self.faces {
            bytes.push(face.len() as u8);
            face.iter().for_each(|corner| bytes.extend(four(*corner as u32)));
        }
        bytes
    }

    /// The faces must be triangles.
    pub fn stl(&self) -> String {
        let facet = |face: &Vec<usize>| {
            let vertex = |corner: &usize| {
                let [x, y, z] = self.vertices[*corner];
                format!("vertex {x} {y} {z}\n")
            };
            let vertices: String = face.iter().map(vertex).collect();
            format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
        };
        format!("solid cube\n{}endsolid cube\n", self.faces.iter().map(facet).collect::<String>())
    }

    /// The faces must be triangles. The file says that there are `announced`.
    pub fn stl_bytes(&self, title: &str, announced: u32, spare: &[u8]) -> Vec<u8> {
        let mut bytes = title.as_bytes().to_vec();
        bytes.resize(80, 0);
        bytes.extend(announced.to_le_bytes());
        for face in &self.faces {
            bytes.extend([0; 12]);
            let parts = face.iter().flat_map(|corner| self.vertices[*corner]);
            parts.for_each(|part| bytes.extend(part.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        [bytes, spare.to_vec()].concat()
    }

    /// Returns the text of a glTF file and the bytes of its buffer: the coordinates, and the corners of triangles in 16 bits.
    /// `nodes` are those of the scene, all of which are shown, `primitive` says more of the mesh 0, and a buffer without
    /// `uri` is that of a GLB.
    pub fn gltf_parts(&self, nodes: &[&str], primitive: &str, uri: Option<&str>) -> (String, Vec<u8>) {
        let (vertices, corners) = (self.vertices.len(), self.faces.iter().flatten().count());
        let mut bytes = Vec::new();
        self.vertices.iter().flatten().for_each(|part| bytes.extend(part.to_le_bytes()));
        let start = bytes.len();
        self.faces.iter().flatten().for_each(|corner| bytes.extend((*corner as u16).to_le_bytes()));
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let shown: Vec<_> = (0..nodes.len()).map(|node| node.to_string()).collect();
        let uri = uri.map_or(String::new(), |uri| format!(r#","uri":"{uri}""#));
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}{primitive}}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":{vertices},"type":"VEC3"}},
                {{"bufferView":1,"componentType":5123,"count":{corners},"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":0,"byteLength":{start}}},
                {{"buffer":0,"byteOffset":{start},"byteLength":{}}}],
            "buffers":[{{"byteLength":{}{uri}}}]}}"#,
            shown.join(","),
            nodes.join(","),
            2 * corners,
            bytes.len(),
        );
        (text, bytes)
    }

    /// Returns a glTF file whose buffer is in its text.
    pub fn gltf(&self, nodes: &[&str], primitive: &str) -> String {
        let (text, bytes) = self.gltf_parts(nodes, primitive, Some("BUFFER"));
        text.replace("BUFFER", &format!("data:application/octet-stream;base64,{}", STANDARD.encode(bytes)))
    }

    pub fn glb(&self, nodes: &[&str], primitive: &str) -> Vec<u8> {
        let (mut text, bytes) = self.gltf_parts(nodes, primitive, None);
        text += &" ".repeat(text.len().next_multiple_of(4) - text.len());
        let length = 12 + 8 + text.len() + 8 + bytes.len();
        let four = |number: usize| (number as u32).to_le_bytes().to_vec();
        [
            b"glTF".to_vec(),
            four(2),
            four(length),
            four(text.len()),
            b"JSON".to_vec(),
            text.into_bytes(),
            four(bytes.len()),
            b"BIN\0".to_vec(),
            bytes,
        ]
        .concat()
    }
}
