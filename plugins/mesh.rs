//! A mesh of triangles from a file.

use super::glass::Glass;
use super::metal::Metal;
use super::plastic::Plastic;
use std::path::PathBuf;
use std::sync::Arc;
use tabray::prelude::*;
use tabray::shapes::mesh::read::{self, Polish, Wanted};
use tabray::shapes::mesh::{self, Finished, Look, Mesh, Painted, Sort, Surface, ToWorld};
use tabray::world::coat::fresnel;
use tabray::world::interface::Gloss;

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
        let told = |remark: &read::Remark| Warning {
            attribute: "file",
            message: remark.message.clone(),
            help: remark.help.to_owned(),
        };
        let mut warnings: Vec<_> = surface.remarks.iter().map(told).collect();
        let (own, accuracy) = (args.material(), args.accuracy());
        let body = if surface.has_looks() {
            let finished = Finished::new(surface.clone());
            let mut sorts = mesh::sorts(&surface, |slot| finished.material(slot, &own, polish(args)));
            if own.interface.is_some() && sorts.as_ref().is_ok_and(|sorts| sorts.iter().any(|sort| sort.material != *own)) {
                sorts = Err(Warning {
                    attribute: "material",
                    message: "is of glass, metal or plastic, so its file's materials give their colours alone".to_owned(),
                    help: "a plain `material` leaves shininess and transparency to the file".to_owned(),
                });
            }
            sorted(args, &surface, sorts, &mut warnings, Finished::new)
        } else if surface.materials.is_empty() || args.setting.only_rays || args.get(&MATERIALS) == Materials::File {
            Body::plain(shape(&surface, accuracy))
        } else {
            let materials: Vec<_> =
                surface.materials.iter().map(|name| args.setting.materials.get(name).cloned()).collect();
            let paint = |surface| Painted { surface, materials: materials.clone() };
            let painted = paint(surface.clone());
            warnings.extend(painted.unknown_materials(&args.setting.materials));
            let sorts = mesh::sorts(&surface, |slot| painted.material_of(slot, &own));
            sorted(args, &surface, sorts, &mut warnings, paint)
        };
        // The parts with different materials take as much memory again.
        let bytes = if body.faces.is_empty() { surface.bytes() } else { 2 * surface.bytes() };
        let files = surface.files.clone();
        Ok(Body { warnings, files, bytes, boundary: Some(Box::new(move || surface.boundary(accuracy))), ..body })
    })
    .known_as(&["obj", "stl", "ply", "gltf", "glb", "model", "trimesh"])
}

/// Makes the shape of a surface.
fn shape(surface: &Arc<Surface>, accuracy: Accuracy) -> AnyShape {
    match accuracy {
        Accuracy::Strict => AnyShape::of_packets(Mesh::<Strict>::new(surface.clone(), accuracy)),
        _ => AnyShape::of_packets(Mesh::<Exact>::new(surface.clone(), accuracy)),
    }
}

/// Makes the body of a surface, with the faces of each sort of materials. `shader` makes the shader of a part of the
/// surface.
fn sorted<S: Shader + 'static>(
    args: &Args,
    surface: &Arc<Surface>,
    sorts: Result<Vec<Sort>, Warning>,
    warnings: &mut Vec<Warning>,
    shader: impl Fn(Arc<Surface>) -> S,
) -> Body {
    let accuracy = args.accuracy();
    let body = Body::shaded(shape(surface, accuracy), shader(surface.clone()));
    let mut sorts = sorts.unwrap_or_else(|warning| {
        warnings.push(warning);
        Vec::new()
    });
    match sorts.len() {
        0 => return body,
        1 => {
            let material = sorts.pop().map(|sort| Arc::new(sort.material));
            return Body { material: material.filter(|material| *material != args.material()), ..body };
        }
        _ if args.setting.only_rays => return body,
        _ => {}
    }
    let face = |Sort { material, slots }: Sort| {
        let surface = Arc::new(surface.part(|slot| slots.contains(&slot))?);
        let of_face = surface.clone();
        Some(Arc::new(Body {
            material: Some(Arc::new(material)),
            boundary: Some(Box::new(move || of_face.boundary(accuracy))),
            ..Body::shaded(shape(&surface, accuracy), shader(surface))
        }))
    };
    Body { faces: sorts.into_iter().filter_map(face).collect(), ..body }
}

/// Returns the function that gives a material the polish of a file.
fn polish(args: &Args) -> impl Fn(Material, &Polish) -> Material {
    // Lengths in the units of the file grow with the mesh.
    let size = libm::cbrt(args.get(&SCALE).abs().element_product());
    move |material, polish| {
        let (interface, specular) = match *polish {
            Polish::Glass { index, roughness, varies, left, at } => {
                let glass = Glass { index, medium: Medium::new(left, size * at), roughness };
                let any = if varies { AnyInterface::new(Varied(glass)) } else { AnyInterface::new(glass) };
                (any, material.specular)
            }
            Polish::Metallic => {
                // Where a shader of the scene knows no images, nothing is metal.
                let matt = Gloss { law: Law::metal(Rgb::ZERO, 0.0), roughness: 1.0 };
                (AnyInterface::new(Varied(matt)), material.specular)
            }
            Polish::Metal { colour, roughness } => (AnyInterface::new(Metal { colour, roughness }), colour),
            Polish::Coat { index, roughness } => {
                let coat = Plastic::new(index, roughness);
                (AnyInterface::new(coat), Rgb::splat(fresnel(index, 1.0)))
            }
        };
        Material { interface: Some(interface), specular, ..material }
    }
}

/// An interface that images change from point to point.
#[derive(PartialEq)]
struct Varied<I>(I);

impl<I: Interface> Interface for Varied<I> {
    fn absorbs(&self) -> bool {
        self.0.absorbs()
    }

    fn medium(&self) -> Option<Medium> {
        self.0.medium()
    }

    fn law(&self) -> Law {
        self.0.law()
    }

    fn roughness(&self) -> f64 {
        self.0.roughness()
    }

    fn varies(&self) -> bool {
        true
    }
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
