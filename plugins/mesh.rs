//! A mesh of triangles from a file.

use std::path::PathBuf;
use std::sync::Arc;
use tabray::prelude::*;
use tabray::shapes::mesh::read::{self, Wanted};
use tabray::shapes::mesh::{Finished, Look, Mesh, Painted, Surface, ToWorld};

static FILE: Pparm<PathBuf> =
    Pparm::required("file", "an OBJ, PLY, STL or glTF file, relative to the scene's folder");
static SCALE: Pparm<DVec3> = Pparm::or("scale", "the scale factors along the file's x, y and z", DVec3::ONE)
    .must("other than 0 in each dimension", |scale: &DVec3| {
        scale.to_array().iter().all(|factor| *factor != 0.0)
    });
static ROTATION: Pparm<Rotation> = Pparm::or(
    "rotation",
    "the angles by which the scaled mesh is rotated around x, then y, then z, or an axis and the angle around it, counterclockwise",
    Rotation::NONE,
)
.must("around a nonzero axis", Rotation::has_axis);
static TRANSLATION: Pparm<DVec3> =
    Pparm::or("translation", "where the file's origin lies", DVec3::ZERO).unit("world coordinates");
static SMOOTH: Pparm<i64> =
    Pparm::or("smooth", "1 shades the mesh as if it were smooth, 0 shades each face flat", 0)
        .must("0 or 1", |smooth| (0..=1).contains(smooth));
static CREASE: Pparm<f64> =
    Pparm::or("crease", "the angle between faces up to which `smooth 1` shades across their edge", 30.0)
        .unit("degrees")
        .between(0.0, 180.0);
static NORMALS: Pparm<Normals> =
    Pparm::or("normals", "whose normals the mesh is shaded with", Normals::Faces).not_dumped();
static MATERIALS: Pparm<Materials> =
    Pparm::or("materials", "whose materials its faces have", Materials::Scene).not_dumped();
static SIDES: Pparm<Sides> = Pparm::or("sides", "which sides of its faces are lit", Sides::Both);

const TABLE: Table =
    &[&FILE, &SCALE, &ROTATION, &TRANSLATION, &SMOOTH, &CREASE, &NORMALS, &MATERIALS, &SIDES];

inventory::submit! {
    Entity::shape("mesh", "a surface of triangles from a file", &[TABLE], |args| {
        let surface = Arc::new(surface(args)?);
        let shape = match args.accuracy() {
            Accuracy::Strict => AnyShape::of_packets(Mesh::<Strict>::new(surface.clone(), args.accuracy())),
            _ => AnyShape::of_packets(Mesh::<Exact>::new(surface.clone(), args.accuracy())),
        };
        let told = |remark: &read::Remark| Warning {
            attribute: "file",
            message: remark.message.clone(),
            help: remark.help.to_owned(),
        };
        let mut warnings: Vec<_> = surface.remarks.iter().map(told).collect();
        let body = if surface.has_looks() {
            let finished = Finished::new(surface.clone());
            let (material, warning) = finished.material(&args.material());
            warnings.extend(warning);
            Body { material: material.map(Arc::new), ..Body::shaded(shape, finished) }
        } else if surface.materials.is_empty() || args.setting.only_rays || args.get(&MATERIALS) == Materials::File {
            Body::plain(shape)
        } else {
            let materials = surface.materials.iter().map(|name| args.setting.materials.get(name).cloned()).collect();
            let painted = Painted { surface: surface.clone(), materials };
            warnings.extend(painted.unknown_materials(&args.setting.materials));
            warnings.extend(painted.unlike_materials(&args.material()));
            Body::shaded(shape, painted)
        };
        let (files, bytes, accuracy) = (surface.files.clone(), surface.bytes(), args.accuracy());
        Ok(Body { warnings, files, bytes, boundary: Some(Box::new(move || surface.boundary(accuracy))), ..body })
    })
    .known_as(&["obj", "stl", "ply", "gltf", "glb", "model", "trimesh"])
}

/// Whose normals a mesh is shaded with.
#[derive(Clone, Copy, PartialEq)]
enum Normals {
    Faces,
    File,
}

/// Whose materials faces have.
#[derive(Clone, Copy, PartialEq)]
enum Materials {
    Scene,
    File,
}

/// Which sides of faces are lit.
#[derive(Clone, Copy, PartialEq)]
enum Sides {
    Both,
    One,
}

choices! {
    Normals, "choice of normals" {
        Faces => "faces", "those of its faces, as `smooth` and `crease` say";
        File => "file", "the file's; where it has none, those of its faces, smoothed except across creases";
    }
    Materials, "choice of materials" {
        Scene => "scene", "the scene's, by the names that the file gives";
        File => "file", "the file's, with its images and colours";
    }
    Sides, "choice of sides" {
        Both => "both", "both, after faces are turned to agree";
        One => "one", "of an open mesh the side from which the file's corners run counterclockwise";
    }
}

/// Reads and places the surface.
fn surface(args: &Args) -> Result<Surface, Refusal> {
    let file = args.get(&FILE);
    let refusal = |message, help| Refusal { attribute: Some("file"), message, help };
    let wanted = Wanted {
        normals: args.get(&NORMALS) == Normals::File,
        materials: (args.get(&MATERIALS) == Materials::File).then(|| args.setting.camera.display()),
    };
    let model =
        read::read(&args.setting.folder.join(&file), wanted, args.setting.memory).map_err(|broken| {
            let read::ReadError { at, message } = broken;
            let place = at.map_or(String::new(), |at| format!(", {at}"));
            refusal(
                format!("has a file that cannot be read, `{}`{place}: {message}", file.display()),
                "a mesh is an OBJ, PLY, STL or glTF file, and its name is relative to the scene's folder",
            )
        })?;
    let placement = ToWorld::new(args.get(&SCALE), args.get(&ROTATION), args.get(&TRANSLATION));
    let crease = (args.get(&SMOOTH) == 1 || wanted.normals).then(|| args.get(&CREASE));
    let look = Look { crease, is_two_sided: args.get(&SIDES) == Sides::Both };
    Surface::new(model, &placement, look).map_err(|error| {
        let (message, help) = error.message();
        refusal(message.to_owned(), help)
    })
}
