//! Bodies: the results of objects' constructors.

use crate::any_shape::AnyShape;
use crate::cutout::Cutout;
use crate::material::Material;
use crate::packets::light::PacketLight;
use crate::packets::shader::PacketShader;
use crate::shader::{Anchor, Plain, Shader};
use crate::solid::{Operation, Tree};
use glam::DVec3;
use std::fmt;
use std::mem::take;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock, OnceLock};

/// Any [`Shader`]: `Arc::new(shader)` makes one.
pub type AnyShader = Arc<dyn PacketShader>;

/// The value of a shader entity: a function that makes the shader of each object that names the entity.
#[derive(Clone)]
pub struct ShaderFactory(Arc<dyn Fn(Anchor) -> AnyShader + Send + Sync>);

impl ShaderFactory {
    /// Makes a factory from a function. The function is called for each object, with the origin and the unit of length
    /// of the pattern on it.
    pub fn new<S: Shader + 'static>(make: impl Fn(Anchor) -> S + Send + Sync + 'static) -> Self {
        Self(Arc::new(move |anchor| Arc::new(make(anchor))))
    }

    /// Makes the shader of one object.
    pub fn on(&self, anchor: Anchor) -> AnyShader {
        (self.0)(anchor)
    }
}

/// The factory that leaves an object with the reflectivities of its material.
impl Default for ShaderFactory {
    fn default() -> Self {
        Self::new(|_| Plain)
    }
}

/// All factories are equal: a scene tells them apart by their names.
impl PartialEq for ShaderFactory {
    fn eq(&self, _other: &Self) -> bool {
        true
    }
}

impl fmt::Debug for ShaderFactory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("ShaderFactory")
    }
}

/// Any [`Light`](crate::light::Light): `Box::new(light)` makes one.
pub type AnyLight = Box<dyn PacketLight>;

/// The body of a named object, for other entities that refer to it. It is empty until the object is made, and stays
/// empty if the object has an error.
#[derive(Clone, Default)]
pub struct NamedBody(Arc<OnceLock<Arc<Body>>>);

impl NamedBody {
    /// Returns the body, if the object is made.
    pub fn get(&self) -> Option<&Arc<Body>> {
        self.0.get()
    }

    /// Sets the body, once.
    pub fn set(&self, body: Body) {
        let _ = self.0.set(Arc::new(body));
    }
}

/// All named bodies are equal: a scene tells them apart by their names.
impl PartialEq for NamedBody {
    fn eq(&self, _other: &Self) -> bool {
        true
    }
}

impl fmt::Debug for NamedBody {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("NamedBody")
    }
}

/// Wraps a shader so that it sees points of a copied object in the coordinates of the original.
pub type ToObjectSpace = Box<dyn Fn(AnyShader) -> AnyShader + Send + Sync>;

/// Makes the boundary of an object's inside, where the boundary differs from the object's shape.
pub type MakeBoundary = Box<dyn Fn() -> Option<AnyShape> + Send + Sync>;

/// What an object's constructor returns: the object's shape and its shader.
pub struct Body {
    /// The object's geometry.
    pub shape: AnyShape,
    /// The object's reflectivities.
    pub shader: AnyShader,
    /// The origin and the unit of length of patterns on the object; `None` to take them from its bounding box.
    pub anchor: Option<Anchor>,
    /// Wraps a shader so that it sees points in the coordinates of the original, if the object is a copy.
    pub to_object_space: Option<ToObjectSpace>,
    /// Makes the object's shape without the parts that lie inside of it. Solids and refracted rays use this boundary
    /// instead of the shape. `None` for an object that has no such parts.
    pub boundary: Option<MakeBoundary>,
    /// What the user should know about the object, although it can be rendered.
    pub warnings: Vec<Warning>,
    /// The files that the object was read from besides those that its attributes name, whether they exist or not.
    pub files: Vec<PathBuf>,
    /// The memory that the object takes in addition to the scene, in bytes.
    pub bytes: u64,
    /// The number of objects nested in it: 1 for a copy of a shape, 2 for a copy of a copy.
    pub depth: u32,
    /// The name that the scene gives the object, if others refer to it.
    pub name: Option<Arc<str>>,
    /// The name of its entity type, if others refer to it.
    pub entity: Option<&'static str>,
    /// The material, if it differs from that of the entity that the body is made for.
    pub material: Option<Arc<Material>>,
    /// The parts of a solid, if the object is one.
    pub solid: Option<Box<Solid>>,
    /// Further bodies that are seen together with this one.
    pub more: Vec<Body>,
    /// The parts of its surface with different materials, which are seen in place of the whole; empty where one material
    /// does for all. Solids are made of the whole.
    pub faces: Vec<Arc<Body>>,
    /// Texts at places of the object, for drawings over the image.
    pub labels: Vec<Label>,
    /// Whether it keeps its own look when the object that it is seen with is given a shader.
    pub keeps_look: bool,
}

/// A text at a place of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The text.
    pub text: String,
    /// The middle of the text, in world coordinates.
    pub at: DVec3,
    /// The vector from the foot of its digits to their head, in world units.
    pub up: DVec3,
}

/// A solid that is made of closed shapes.
#[derive(Clone)]
pub struct Solid {
    /// Its parts.
    pub parts: Vec<Part>,
    /// The condition on the parts in which a point lies. It decides whether the point lies in the solid.
    pub tree: Tree,
    /// Whether it is cut open: only the surface of its first part is seen, and it has no inside.
    pub is_open: bool,
}

/// A part of a solid.
#[derive(Clone)]
pub struct Part {
    /// The name that the scene gives it.
    pub name: Arc<str>,
    /// The object; its shape is closed, unless it is clipped.
    pub body: Arc<Body>,
    /// The material.
    pub material: Arc<Material>,
    /// Whether other parts clip it: its box may cut its surface, so only the sign of its equation tells its inside.
    pub is_clipped: bool,
}

impl Solid {
    /// Combines solids.
    pub fn combined(operation: Operation, of: impl IntoIterator<Item = Self>) -> Self {
        let (mut parts, mut trees) = (Vec::new(), Vec::new());
        for one in of {
            trees.push(one.tree.moved(parts.len()));
            parts.extend(one.parts);
        }
        Self { parts, tree: Tree::Combined(operation, trees.into()), is_open: false }
    }
}

/// A warning about an object.
#[derive(Clone, Debug)]
pub struct Warning {
    /// The attribute to mark.
    pub attribute: &'static str,
    /// What may differ from what the user intended, phrased to follow the entity's name: "leaves out 3 faces".
    pub message: String,
    /// How to correct it, or what happens otherwise.
    pub help: String,
}

impl Body {
    /// Makes an object whose reflectivities are its material's.
    pub fn plain(shape: impl Into<AnyShape>) -> Self {
        // A scene may have millions of such objects.
        static PLAIN: LazyLock<AnyShader> = LazyLock::new(|| Arc::new(Plain));
        Self::with_shader(shape.into(), PLAIN.clone())
    }

    /// Makes an object with a shader of its own.
    pub fn shaded(shape: impl Into<AnyShape>, shader: impl Shader + 'static) -> Self {
        Self::with_shader(shape.into(), Arc::new(shader))
    }

    fn with_shader(shape: AnyShape, shader: AnyShader) -> Self {
        Self {
            shape,
            shader,
            anchor: None,
            to_object_space: None,
            boundary: None,
            warnings: Vec::new(),
            files: Vec::new(),
            bytes: 0,
            depth: 0,
            name: None,
            entity: None,
            material: None,
            solid: None,
            more: Vec::new(),
            faces: Vec::new(),
            labels: Vec::new(),
            keeps_look: false,
        }
    }

    /// Sets the origin and the unit of length of patterns on the object, in world units.
    pub fn anchored(self, origin: DVec3, unit: f64) -> Self {
        Self { anchor: Some(Anchor { origin, unit }), ..self }
    }

    /// Returns the origin and the unit of length of patterns on the object.
    pub fn anchor(&self) -> Anchor {
        let of_box = || {
            let bounds = self.shape.facts().bounds?;
            let unit = 2.0 * bounds.half_size().max_element();
            Some(Anchor { origin: bounds.middle(), unit })
        };
        let anywhere = Anchor { origin: DVec3::ZERO, unit: 1.0 };
        self.anchor.or_else(of_box).unwrap_or(anywhere)
    }

    /// Returns the boundary of the object's inside, where the boundary differs from the object's shape.
    pub fn boundary(&self) -> Option<AnyShape> {
        self.boundary.as_ref().and_then(|make| make())
    }

    /// Gives the object the look of a shader, instead of its own.
    pub fn painted(mut self, paint: &ShaderFactory) -> Self {
        let painted = |one: Self| if one.keeps_look { one } else { one.painted(paint) };
        self.more = self.more.into_iter().map(painted).collect();
        self.each_face(|face| face.painted(paint));
        let shader = paint.on(self.anchor());
        let shader = match &self.to_object_space {
            Some(to_object_space) => to_object_space(shader),
            None => shader,
        };
        let mut body = Self { shader, ..self };
        body.warn_of_what_it_lacks();
        body
    }

    /// Changes the parts of the surface with different materials, which no other body has.
    fn each_face(&mut self, change: impl Fn(Self) -> Self) {
        let changed = |face: Arc<Self>| Arc::into_inner(face).map(|face| Arc::new(change(face)));
        self.faces = take(&mut self.faces).into_iter().filter_map(changed).collect();
    }

    /// Removes the parts of the shape that the shader cuts out.
    pub fn cut_out(mut self) -> Self {
        if self.more.is_empty() && !self.shader.cuts_out() {
            return self;
        }
        self.each_face(Self::cut_out);
        let more = self.more.into_iter().map(Self::cut_out).collect();
        if !self.shader.cuts_out() {
            return Self { more, ..self };
        }
        let shape = Cutout::shape(self.shape, self.shader.clone()).into();
        Self { shape, solid: None, more, ..self }
    }

    /// Warns if the shader needs coordinates or faces that the shape does not have.
    fn warn_of_what_it_lacks(&mut self) {
        let (sees, at) = (self.shader.sees(), self.anchor().origin);
        let lacks = [
            (sees.uv && !self.shape.facts().has_uv && self.shape.uv(at).is_none()).then_some("u and v"),
            (sees.face && self.shape.face(at).is_none()).then_some("faces"),
            (sees.curvature && self.shape.curvature(at).is_none()).then_some("gradient and curvature"),
        ];
        for what in lacks.into_iter().flatten() {
            self.warnings.push(Warning {
                attribute: "shader",
                message: format!("has no {what}, which its shader uses"),
                help: format!("on a shape without {what}, the shader takes 0, or shows the material alone"),
            });
        }
    }
}
