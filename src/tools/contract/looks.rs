//! The contracts of everything that is neither a shape nor a camera: shaders, lights, materials, profiles and dumps.

use super::draw::Draw;
use super::promise::{Fault, Promise};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::path::Path;
use tabray_core::geometry::ray::Side;
use tabray_core::scene::model::Model;
use tabray_core::scene::profile::Profile;
use tabray_core::shapes::revolution::{Refinement, Revolution};
use tabray_core::simd::cpu::Cpu;
use tabray_core::simd::soa::{LANES, Vectors};
use tabray_core::world::background::EnclosedBackground;
use tabray_core::world::body::ShaderFactory;
use tabray_core::world::emitter::{EnclosedEmitter, LightSample};
use tabray_core::world::hittable::Curvature;
use tabray_core::world::interface::Crossing;
use tabray_core::world::material::{Look, Material, Reflectivity, Rgb};
use tabray_core::world::packets::light::PacketLight;
use tabray_core::world::packets::light::{LightSamples, ShadingPoints};
use tabray_core::world::packets::shader::{PacketShader, SurfacePoints};
use tabray_core::world::patch::Patch;
use tabray_core::world::rules::Rules;
use tabray_core::world::shader::Anchor;
use tabray_core::world::surface_point::SurfacePoint;
use tabray_exact::interval::Interval;
use tabray_lang::dump;
use tabray_lang::reader;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// The number of points at which lights and procedural shaders are evaluated.
const PLACES: usize = 100;

/// Checks that a dumped scene loads again, in a syntax.
pub fn dump(registry: &Registry, folder: &Path, model: &Model, syntax: Syntax) -> Result<(), Fault> {
    let name = if syntax == Syntax::Notes { "dump.ray" } else { "dump.toml" };
    let text = dump::scene(model, syntax);
    let fault = |found: String| Promise::DumpLoadsAgain.fault(found);
    let again = reader::read(registry, name, folder, text.as_bytes(), None);
    let again = again.map_err(|report| fault(report.to_string()))?.model;
    if dump::scene(&again, syntax) != text || dump::notes(&again) != dump::notes(model) {
        return Err(fault(format!("the dump is different, of\n{text}")));
    }
    Ok(())
}

/// Checks a shader's reflectivities and normals at a point, for single rays and in packets.
pub fn shader(shader: &dyn PacketShader, at: &SurfacePoint) -> Result<(), Fault> {
    let material = Material {
        ambient: Rgb::new(0.1, 0.5, 3.0),
        emission: Rgb::ZERO,
        highlight: Rgb::ZERO,
        diffuse: Rgb::new(2.0, 0.7, 0.0),
        specular: Rgb::splat(0.3),
        shininess: 10.0,
        transparency: 0.2,
        interface: None,
    };
    let one = Reflectivity::ALL.map(|of| shader.colour_at(of, &material, at));
    let found = |what: String| format!("{what} at {}", at.position);
    for (colour, what) in one.iter().zip(["ambient", "diffuse", "specular"]) {
        if !colour.is_finite() || colour.min_element() < 0.0 {
            return Err(Promise::ReflectivityIsSound.fault(found(format!("`{what}` is {colour}"))));
        }
    }
    let covered = shader.coverage_at(at);
    if shader.covers_in_part() && !(0.0..=1.0).contains(&covered) {
        return Err(Promise::ReflectivityIsSound.fault(found(format!("`coverage` is {covered}"))));
    }
    if let Some(Look { ambient, diffuse, specular }) = shader.uniform(&material)
        && one != [ambient, diffuse, specular]
    {
        let even = [ambient, diffuse, specular];
        return Err(
            Promise::PacketsAgree.fault(found(format!("`uniform` is {even:?}, and it returns {one:?}")))
        );
    }
    if let Some(Look { ambient, diffuse, specular }) = shader.brightest(&material)
        && let limit = [ambient, diffuse, specular]
        && one.iter().zip(limit).any(|(colour, limit)| !colour.abs().cmple(limit.abs()).all())
    {
        let found = found(format!("`brightest` is {limit:?}, and it returns {one:?}"));
        return Err(Promise::ReflectivityIsSound.fault(found));
    }
    let bent = shader.normal_at(at);
    if shader.bends() && (bent.length() - 1.0).abs() > 1e-9 {
        return Err(
            Promise::NormalIsUnit.fault(found(format!("`bend` is {bent}, of length {}", bent.length())))
        );
    }
    let (positions, seen) = (Vectors::<LANES>::of(at.position), [*at; LANES]);
    let points = SurfacePoints { positions: positions.view(LANES), seen: &seen };
    for cpu in Cpu::all() {
        let mut many = [const { Vectors::<LANES>::ZERO }; 3];
        let [ambient, diffuse, specular] = &mut many;
        shader.ambient_and_specular(
            cpu,
            &material,
            points,
            ambient.view_mut(LANES),
            specular.view_mut(LANES),
        );
        shader.diffuses(cpu, &material, points, diffuse.view_mut(LANES));
        let many = many.map(|colours| colours.get(LANES - 1));
        if !many.iter().zip(&one).all(|(many, one)| same_bits(*many, *one)) {
            return Err(Promise::PacketsAgree.fault(found(format!("{many:?} in packets ({cpu}), {one:?}"))));
        }
    }
    Ok(())
}

/// Tells whether two vectors are equal to the last bit.
pub fn same_bits(a: DVec3, b: DVec3) -> bool {
    a.to_array().map(f64::to_bits) == b.to_array().map(f64::to_bits)
}

/// Checks a shader around its anchor, and at the anchor's origin, on surfaces with and without u, v and faces.
pub fn paint(paint: &ShaderFactory, draw: &mut Draw) -> Result<(), Fault> {
    for unit in [1.0, 0.3, 7.0] {
        let anchor = Anchor { origin: DVec3::new(4.0, 3.0, -2.5), unit };
        let made = paint.on(anchor);
        let all: Vec<_> = places(anchor.origin, draw).collect();
        for (index, position) in all.into_iter().enumerate() {
            let (normal, has_more) = (draw.direction(), index % 2 == 0);
            let uv = has_more.then(|| DVec2::new(draw.part(), draw.part()));
            let face = has_more.then_some(index as u32);
            let side = if index % 3 == 0 { Side::Inside } else { Side::Outside };
            let ends = uv.map(|uv| [uv - draw.part(), uv + draw.part()]);
            let sides = [draw.part() * draw.direction(), draw.part() * draw.direction()];
            let patch = (index % 3 == 1).then_some(Patch { sides, pixel: 2.0, uv: ends });
            let tangents = has_more.then(|| normal.any_orthonormal_pair().into());
            let curvature = has_more.then_some(Curvature { gradient: 1.5, mean: -0.5, gauss: 0.25 });
            let point = SurfacePoint { position, normal, side, uv, face, tangents, curvature, patch };
            shader(&*made, &point)?;
        }
    }
    Ok(())
}

/// Checks a background's colours and their bounds in many directions.
pub fn background(background: &dyn EnclosedBackground, draw: &mut Draw) -> Result<(), Fault> {
    /// The largest rounding error of a colour, as a part of the brightest one.
    const ROUNDING: f64 = 1e-12;
    let most = background.brightest();
    let error = ROUNDING * most.max_element();
    for size in [0.0, 1e-6, 1e-3, 0.3] {
        for _ in 0..PLACES {
            let toward = draw.direction();
            let colour = background.colour_toward(toward);
            if !colour.is_finite() || colour.min_element() < 0.0 {
                return Err(Promise::BackgroundIsSound.fault(format!("toward {toward} it is {colour}")));
            }
            if !colour.cmple(most + error).all() {
                let found = format!("`brightest` is {most}, and toward {toward} it is {colour}");
                return Err(Promise::BackgroundIsSound.fault(found));
            }
            // A box of directions around one, which is not in the middle.
            let at = toward.to_array();
            let (below, above) = (size * draw.part(), size * draw.part());
            let bounds =
                background.colours_toward(at.map(|at| Interval { low: at - below, high: at + above }));
            let is_within = |channel: usize| {
                bounds[channel].low - error <= colour[channel]
                    && colour[channel] <= bounds[channel].high + error
            };
            if !(0..3).all(is_within) {
                let found = format!("toward {toward} it is {colour}, and in a box around that, {bounds:?}");
                return Err(Promise::BackgroundIsSound.fault(found));
            }
        }
    }
    Ok(())
}

/// Checks a light, seen from points around it and from its own position.
pub fn light(light: &dyn PacketLight, draw: &mut Draw) -> Result<(), Fault> {
    let (location, size) = (light.location(), light.size());
    if !location.is_finite() || !size.is_finite() || size < 0.0 {
        return Err(Promise::LightIsFinite.fault(format!("it is at {location}, its size is {size}")));
    }
    for toward in places(location, draw) {
        let one = Rgb::from(light.sends(toward.to_array()));
        if !one.is_finite() {
            return Err(Promise::LightIsFinite.fault(format!("toward {toward} it emits {one}")));
        }
        if let Some(even) = light.uniform()
            && one != even
        {
            let found = format!("`uniform` is {even}, and toward {toward} it emits {one}");
            return Err(Promise::PacketsAgree.fault(found));
        }
        if let Some(limit) = light.brightest()
            && !one.abs().cmple(limit.abs()).all()
        {
            let found = format!("`brightest` is {limit}, and toward {toward} it emits {one}");
            return Err(Promise::LightIsFinite.fault(found));
        }
        if light.emitter().is_some() {
            continue;
        }
        let all = |of: DVec3| Vectors::<LANES> { x: [of.x; LANES], y: [of.y; LANES], z: [of.z; LANES] };
        // The light is in front of each point, except for the point at its own position.
        let (points, normals) = (all(toward), all((location - toward).normalize_or_zero()));
        let (points, normals) = (points.view(LANES), normals.view(LANES));
        for cpu in Cpu::all() {
            let (mut dir, mut emissivity) = (Vectors::<LANES>::ZERO, Vectors::<LANES>::ZERO);
            let (mut strengths, mut t_max, mut shines) = ([0.0; LANES], [0.0; LANES], [2; LANES]);
            let facing = LightSamples {
                toward: dir.view_mut(LANES),
                emissivity: emissivity.view_mut(LANES),
                strengths: &mut strengths,
                t_max: &mut t_max,
                shines: &mut shines,
            };
            light.sample(
                cpu,
                &ShadingPoints { points, normals, lights: None, rules: Rules::Notes, slack: 0.0 },
                facing,
            );
            let many = light.uniform().unwrap_or(emissivity.get(LANES - 1));
            let does_shine = one != Rgb::ZERO && toward != location;
            if !same_bits(many, one) || shines[LANES - 1] != u64::from(does_shine) {
                let found = format!("{many} in packets ({cpu}), {one} toward {toward}");
                return Err(Promise::PacketsAgree.fault(found));
            }
        }
    }
    for _ in 0..PLACES {
        if let Some(emitter) = light.emitter() {
            samples(light, emitter, location + draw.direction() * 10.0 * draw.part(), draw)?;
        }
    }
    Ok(())
}

/// Checks the samples of an extended light, as a place sees them.
fn samples(
    light: &dyn PacketLight,
    emitter: &dyn EnclosedEmitter,
    at: DVec3,
    draw: &mut Draw,
) -> Result<(), Fault> {
    let (normal, numbers) = (draw.direction(), DVec2::new(draw.part(), draw.part()));
    let Some(sample) = emitter.sample_at(at, normal, numbers) else { return Ok(()) };
    let LightSample { toward, distance, light: sent } = sample;
    let cosine = if emitter.has_highlights() { 1.0 } else { toward.dot(normal).max(0.0) };
    let is_bounded =
        light.brightest().is_none_or(|most| (cosine * sent).abs().cmple((1.0 + 1e-9) * most.abs()).all());
    let (density, radiance) = (emitter.density(at, toward, distance), Rgb::from(light.sends(at.to_array())));
    let is_dark = |radiance: Rgb| light.brightest().is_none_or(|most| radiance.abs().cmple(most.abs()).all());
    let agrees = density.is_none_or(|density| {
        let slack = 1e-4 * radiance.abs().max_element();
        is_dark(radiance) && (PI * density * sent).abs_diff_eq(radiance, slack)
    });
    if toward.is_normalized() && distance >= 0.0 && sent.is_finite() && is_bounded && agrees {
        return Ok(());
    }
    let most = light.brightest();
    let found = format!(
        "{at}, with the normal {normal}, sees it at {numbers} as {sample:?}; `brightest` is {most:?}, and `density` \
         {density:?}"
    );
    Err(Promise::LightIsFinite.fault(found))
}

/// Draws points around a point, the point itself among them.
fn places(middle: DVec3, draw: &mut Draw) -> impl Iterator<Item = DVec3> {
    let axes = DVec3::AXES.into_iter().flat_map(move |axis| [middle + axis, middle - axis]);
    [middle]
        .into_iter()
        .chain(axes)
        .chain((0..PLACES).map(move |_| middle + draw.direction() * 10.0 * draw.part()))
}

/// Checks that a material consists of finite numbers, and that its interface continues rays as it must.
pub fn material(material: &Material, draw: &mut Draw) -> Result<(), Fault> {
    let Material { ambient, emission, diffuse, specular, highlight, shininess, transparency, interface } =
        material;
    let is_finite = [ambient, emission, diffuse, specular, highlight].iter().all(|colour| colour.is_finite());
    if !is_finite
        || emission.min(*highlight).min_element() < 0.0
        || !shininess.is_finite()
        || !(0.0..=1.0).contains(transparency)
    {
        return Err(Promise::ReflectivityIsSound.fault(format!("it is {material:?}")));
    }
    let Some(interface) = interface else { return Ok(()) };
    for _ in 0..PLACES {
        let (dir, normal) = (draw.direction(), draw.direction());
        let normal = if dir.dot(normal) > 0.0 { -normal } else { normal };
        let passed = material.coat().map_or(Some(1.0), |coat| coat.passes(-dir.dot(normal)));
        if !passed.is_some_and(|part| (0.0..=1.0).contains(&part)) {
            let found =
                format!("its coat lets pass {passed:?} of the light along {dir} to a normal {normal}");
            return Err(Promise::LightGoesOn.fault(found));
        }
        for side in [Side::Outside, Side::Inside] {
            let crossing = interface.cross(dir, normal, side);
            let Crossing { reflected, onward } = crossing;
            let is_through = |onward: DVec3| onward.is_normalized() && onward.dot(normal) <= 0.0;
            let is_fraction = reflected.to_array().iter().all(|part| (0.0..=1.0).contains(part));
            let is_sound = is_fraction && onward.is_none_or(is_through);
            if !is_sound {
                let found = format!("a ray along {dir} goes on from a normal {normal} as {crossing:?}");
                return Err(Promise::LightGoesOn.fault(found));
            }
        }
    }
    Ok(())
}

/// Checks a profile, turned into a surface of revolution of height 4.
pub fn profile(profile: &Profile) -> Result<(), Fault> {
    let line = profile.line();
    let fault = |found: String| Promise::ProfileIsFinite.fault(found);
    Revolution::new(&line.radius, 4.0, Refinement::Root)
        .map_err(|none| fault(format!("it is one {}", none.message().0)))?;
    let mut heights = (0..=400).map(|part| f64::from(part) / 100.0);
    match heights.find(|y| !line.slope_at(*y).is_finite()) {
        Some(y) => Err(fault(format!("its slope is {} at y = {y}", line.slope_at(y)))),
        None => Ok(()),
    }
}
