//! Files of meshes.

use super::closed::SurfaceMesh;
use glam::DVec3;
use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;
use tabray_core::named;

/// A format of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Binary STL: triangles that share no vertices.
    Stl,
    /// Wavefront's text.
    Obj,
    /// Binary PLY, little-endian.
    Ply,
}

named!(Format { Stl => "stl", Obj => "obj", Ply => "ply" });

impl Format {
    /// Returns the format that a file's extension names.
    pub fn of_name(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?;
        [(Self::Stl, "stl"), (Self::Obj, "obj"), (Self::Ply, "ply")]
            .into_iter()
            .find(|(_, known)| ending.eq_ignore_ascii_case(known))
            .map(|(format, _)| format)
    }

    /// Writes a mesh; `name` is that of the object.
    ///
    /// # Errors
    /// Returns the errors of the writer.
    pub fn write(self, mesh: &SurfaceMesh, name: &str, out: &mut impl Write) -> io::Result<()> {
        match self {
            Self::Stl => stl(mesh, out),
            Self::Obj => obj(mesh, name, out),
            Self::Ply => ply(mesh, out),
        }
    }
}

fn bytes(of: DVec3) -> [u8; 12] {
    let mut bytes = [0; 12];
    for (axis, number) in of.as_vec3().to_array().into_iter().enumerate() {
        bytes[4 * axis..4 * axis + 4].copy_from_slice(&number.to_le_bytes());
    }
    bytes
}

fn stl(mesh: &SurfaceMesh, out: &mut impl Write) -> io::Result<()> {
    let mut head = [b' '; 80];
    let title = b"a mesh of tabray";
    head[..title.len()].copy_from_slice(title);
    out.write_all(&head)?;
    out.write_all(&(mesh.faces.len() as u32).to_le_bytes())?;
    for face in &mesh.faces {
        let [a, b, c] = face.map(|corner| mesh.vertices[corner as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for at in [normal, a, b, c] {
            out.write_all(&bytes(at))?;
        }
        out.write_all(&[0; 2])?;
    }
    Ok(())
}

fn obj(mesh: &SurfaceMesh, name: &str, out: &mut impl Write) -> io::Result<()> {
    let mut text = String::new();
    let _ = writeln!(text, "o {}", name.replace(|c: char| !(c.is_ascii_alphanumeric() || c == '_'), "_"));
    for at in &mesh.vertices {
        let [x, y, z] = at.as_vec3().to_array();
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    out.write_all(text.as_bytes())?;
    text.clear();
    for face in &mesh.faces {
        let [a, b, c] = face.map(|corner| corner + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    out.write_all(text.as_bytes())
}

fn ply(mesh: &SurfaceMesh, out: &mut impl Write) -> io::Result<()> {
    let (vertices, faces) = (mesh.vertices.len(), mesh.faces.len());
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {faces}\nproperty list uchar uint vertex_indices\nend_header\n"
    )?;
    for at in &mesh.vertices {
        out.write_all(&bytes(*at))?;
    }
    for face in &mesh.faces {
        out.write_all(&[3])?;
        for corner in face {
            out.write_all(&corner.to_le_bytes())?;
        }
    }
    Ok(())
}
