//! Light in a box of matt walls, beside the radiosities of its patches: a finite-element solution that shares nothing with
//! the program (Goral et al., "Modeling the Interaction of Light Between Diffuse Surfaces", 1984).

use crate::common::model;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::TAU;
use tabray::geometry::ray::Ray;
use tabray::geometry::sight::Sight;
use tabray::render::plan::Plan;
use tabray::render::trace;
use tabray::world::sample::{Sample, Sampler};

const BOUNCES: usize = 6;

/// The patches of a wall that are compared, in each direction.
const COARSE: usize = 4;

/// The reflectivity and the emission of each wall of the unit cube: low and high x, y and z.
const WALLS: [[[f64; 3]; 2]; 6] = [
    [[0.7, 0.1, 0.1], [0.0, 0.0, 0.0]],
    [[0.1, 0.7, 0.1], [0.0, 0.0, 0.0]],
    [[0.6, 0.6, 0.6], [0.0, 0.0, 0.0]],
    [[0.3, 0.3, 0.8], [1.0, 0.5, 2.0]],
    [[0.8, 0.8, 0.8], [0.0, 0.0, 0.0]],
    [[0.2, 0.4, 0.6], [0.0, 0.1, 0.0]],
];

/// Returns the form factor from a point to a polygon above its tangent plane, by Lambert's formula (1760).
fn form_factor(normal: DVec3, corners: [DVec3; 4]) -> f64 {
    let edge = |index: usize| {
        let [from, to] = [corners[index].normalize(), corners[(index + 1) % 4].normalize()];
        let across = from.cross(to);
        across.length().atan2(from.dot(to)) * across.try_normalize().map_or(0.0, |across| across.dot(normal))
    };
    ((0..4).map(edge).sum::<f64>() / TAU).abs()
}

/// The form factors between the patches of a cube, which depend on their distances alone.
struct FormFactors {
    count: usize,
    /// For patches of facing walls, by the distances along both axes.
    facing: Vec<f64>,
    /// For patches of walls that meet: by the distance along their edge, and the distances of both from it.
    meeting: Vec<f64>,
}

impl FormFactors {
    fn new(count: usize) -> Self {
        let (size, half) = (1.0 / count as f64, 0.5 / count as f64);
        let square = |middle: DVec3, [u, v]: [DVec3; 2]| {
            [[-half, -half], [half, -half], [half, half], [-half, half]].map(|[x, y]| middle + x * u + y * v)
        };
        let place = |index: usize| (index as f64 + 0.5) * size;
        let (mut facing, mut meeting) = (Vec::new(), Vec::new());
        for index in 0..count * count {
            let [x, y] = [index / count, index % count].map(|steps| steps as f64 * size);
            facing.push(form_factor(DVec3::Z, square(DVec3::new(x, y, 1.0), [DVec3::X, DVec3::Y])));
        }
        for index in 0..count * count * count {
            let along = (index / count / count) as f64 * size;
            let [own, other] = [index / count % count, index % count].map(place);
            meeting.push(form_factor(DVec3::Z, square(DVec3::new(-own, along, other), [DVec3::Y, DVec3::Z])));
        }
        Self { count, facing, meeting }
    }

    /// Returns the factor from a patch of one wall to a patch of another.
    fn between(&self, (wall, patch): (usize, [usize; 2]), (other, its): (usize, [usize; 2])) -> f64 {
        let count = self.count;
        // The place of a patch along an axis in which its wall extends.
        let along = |wall: usize, patch: [usize; 2], axis: usize| patch[(axis + 2 - wall / 2) % 3];
        let (axis, its_axis) = (wall / 2, other / 2);
        if axis == its_axis {
            let [x, y] = [0, 1].map(|side| patch[side].abs_diff(its[side]));
            return self.facing[x * count + y];
        }
        let edge = 3 - axis - its_axis;
        let apart = along(wall, patch, edge).abs_diff(along(other, its, edge));
        let from_low = |side: usize, place: usize| if side == 0 { place } else { count - 1 - place };
        let own = from_low(other % 2, along(wall, patch, its_axis));
        let other = from_low(wall % 2, along(other, its, axis));
        self.meeting[(apart * count + own) * count + other]
    }
}

/// Returns the radiosities of the coarse patches of all walls, from finer ones.
fn radiosities(count: usize) -> Vec<DVec3> {
    let factors = FormFactors::new(count);
    let patches: Vec<_> = (0..6 * count * count)
        .map(|index| (index / count / count, [index / count % count, index % count]))
        .collect();
    let [albedo, emission] = [0, 1].map(|which| move |wall: usize| DVec3::from(WALLS[wall][which]));
    let mut light: Vec<_> = patches.iter().map(|(wall, _)| emission(*wall)).collect();
    for _ in 0..BOUNCES {
        light = (0..patches.len())
            .into_par_iter()
            .map(|index| {
                let own = patches[index];
                let others = patches.iter().zip(&light).filter(|((wall, _), _)| *wall != own.0);
                let received: DVec3 =
                    others.map(|(other, light)| factors.between(own, *other) * *light).sum();
                emission(own.0) + albedo(own.0) * received
            })
            .collect();
    }
    let mut coarse = vec![DVec3::ZERO; 6 * COARSE * COARSE];
    let part = count / COARSE;
    for ((wall, [u, v]), light) in patches.iter().zip(&light) {
        coarse[(wall * COARSE + u / part) * COARSE + v / part] += *light / (part * part) as f64;
    }
    coarse
}

/// Returns the mean light of each coarse patch, as the program sees it from the middle of the cube.
fn traced(samples: u32) -> Vec<DVec3> {
    let text: String = WALLS
        .iter()
        .enumerate()
        .map(|(wall, [[r, g, b], [er, eg, eb]])| {
            let axis = DVec3::AXES[wall / 2];
            let (normal, point) = if wall % 2 == 0 { (axis, DVec3::ZERO) } else { (-axis, axis) };
            let [normal, point] = [normal, point].map(|at| format!("{} {} {}", at.x, at.y, at.z));
            format!(
                "material m{wall} {{ diffuse {r} {g} {b} emission {er} {eg} {eb} }}
                 plane w{wall} {{ material m{wall} normal {normal} point {point} }}\n"
            )
        })
        .collect();
    let model = model(&format!(
        "look_at eye {{ pixeldim 2 2 position 0.5 0.5 0.5 target 0.5 0.5 0 samples 2 bounces {BOUNCES} }}\n{text}"
    ));
    let plan = Plan::new(&model);
    (0..6 * COARSE * COARSE)
        .into_par_iter()
        .map(|patch| {
            let (wall, corner) = (
                patch / COARSE / COARSE,
                DVec2::new((patch / COARSE % COARSE) as f64, (patch % COARSE) as f64),
            );
            let light = |index: u32| {
                // A lattice of the plastic number (Roberts, 2018).
                let turn = |by: f64| (0.5 + by * f64::from(index)).fract();
                let within = DVec2::new(turn(0.754_877_666_246_692_8), turn(0.569_840_290_998_053_3));
                let [u, v] = ((corner + within) / COARSE as f64).to_array();
                let mut at = DVec3::splat((wall % 2) as f64);
                (at[(wall / 2 + 1) % 3], at[(wall / 2 + 2) % 3]) = (u, v);
                let origin = DVec3::splat(0.5);
                let sight = Sight::along(&Ray { origin, dir: (at - origin).normalize() });
                let sample = Sample { sampler: Sampler::Sobol, index, pixel: patch as u32 };
                trace::colour(&plan, &sight, Some(sample))
            };
            (0..samples).map(light).sum::<DVec3>() / f64::from(samples)
        })
        .collect()
}

/// Returns the largest and the mean relative error of all patches and channels.
fn errors(found: &[DVec3], right: &[DVec3]) -> [f64; 2] {
    let each = found.iter().zip(right).map(|(found, right)| ((found - right) / right).abs());
    let most = each.clone().fold(0.0, |most: f64, error| most.max(error.max_element()));
    [most, (each.map(|error| error.length_squared() / 3.0).sum::<f64>() / right.len() as f64).sqrt()]
}

/// Returns the mean light of each wall.
fn walls(patches: &[DVec3]) -> Vec<DVec3> {
    let of_wall = patches.chunks(COARSE * COARSE);
    of_wall.map(|patches| patches.iter().sum::<DVec3>() / patches.len() as f64).collect()
}

#[test]
fn walls_of_a_box_are_as_bright_as_their_radiosities() {
    let [rough, right] = [16, 32].map(radiosities);
    let [moved, _] = errors(&rough, &right);
    assert!(moved < 0.002, "the solution is not fine enough: {moved}");
    let [few, many] = [64, 4096].map(traced);
    let [[_, few_off], [_, off]] = [&few, &many].map(|found| errors(found, &right));
    // A root mean square of 288 numbers is itself known to about 4 %.
    assert!(off < 1.05 * few_off / 8.0, "{few_off} with 64 samples, {off} with 4096");
    let [most, _] = errors(&walls(&many), &walls(&right));
    assert!(most < 0.01, "{most}");
}

#[test]
#[ignore = "takes minutes; in .ci/nightly"]
fn patches_of_a_box_are_as_bright_as_their_radiosities() {
    let [most, off] = errors(&traced(1 << 16), &radiosities(32));
    println!("off by {most} at most, {off} in the mean");
    assert!(most < 0.01, "{most}");
}
