//! Searches of a hierarchy for the objects near a point, and for those with boxes that pass a test.

use crate::geometry::aabb::{Aabb, SLACK};
use crate::geometry::bvh::tree::Bvh;
use glam::DVec3;

impl Bvh {
    /// Visits the objects with boxes within a distance of a point, in world units, roughly nearest first. `visit`
    /// returns the distance beyond which objects no longer matter. A negative number ends the search. It is behind
    /// `dyn` to compile the search and its sorting only once.
    pub fn around(&self, at: DVec3, distance: f64, visit: &mut dyn FnMut(usize) -> f64) {
        let (mut limit, mut ahead) = (distance, Vec::new());
        if !self.nodes.is_empty() {
            ahead.push((0.0, true, 0));
        }
        while let Some((nearest, is_node, index)) = ahead.pop() {
            // Near the point, the boxes' own slack exceeds the rounding of distances. This slack is for distant boxes.
            if nearest * (1.0 - SLACK) > limit {
                continue;
            }
            if !is_node {
                limit = visit(self.object(index));
                continue;
            }
            let (node, start) = (&self.nodes[index as usize], ahead.len());
            for child in 0..node.len() {
                let Aabb { low, high } = node.bounds(child);
                let nearest = (low - at).max(at - high).max(DVec3::ZERO).length();
                if nearest * (1.0 - SLACK) <= limit {
                    let (is_node, index) = node.child(child as u32);
                    ahead.push((nearest, is_node, index));
                }
            }
            ahead[start..].sort_by(|one, other| other.0.total_cmp(&one.0));
        }
    }

    /// Visits the objects whose own box and enclosing boxes all pass a test.
    pub fn within(&self, mut enters: impl FnMut(&Aabb) -> bool, mut visit: impl FnMut(usize)) {
        let mut ahead: Vec<_> = self.nodes.first().into_iter().collect();
        while let Some(node) = ahead.pop() {
            for child in (0..node.len()).filter(|child| enters(&node.bounds(*child))) {
                match node.child(child as u32) {
                    (true, index) => ahead.push(&self.nodes[index as usize]),
                    (false, index) => visit(self.object(index)),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::bvh::packet::{PacketVisitor, visit};
    use crate::geometry::bvh::tree::Stack;
    use crate::geometry::ray::{Ray, RayError};
    use crate::geometry::ray_packet::RayPacket;
    use crate::simd::cpu::Cpu;
    use crate::simd::soa::{LANES, Vectors};
    use std::ops::Range;

    /// Returns boxes of size 0.5 at all integer coordinates from 0 to 9.
    fn boxes() -> Vec<Aabb> {
        let place = |index: u32| {
            DVec3::new(f64::from(index % 10), f64::from(index / 10 % 10), f64::from(index / 100))
        };
        (0..1000).map(|index| Aabb { low: place(index), high: place(index) + 0.5 }).collect()
    }

    #[test]
    fn objects_around_a_point_are_those_whose_boxes_are_near() {
        let boxes = boxes();
        let tree = Bvh::new(&boxes);
        for (at, distance) in
            [(DVec3::splat(4.2), 1.3), (DVec3::new(-3.0, 5.0, 20.0), 14.0), (DVec3::ZERO, 0.0)]
        {
            let away = |bounds: &Aabb| (bounds.low - at).max(at - bounds.high).max(DVec3::ZERO).length();
            let (mut visited, mut within) = (Vec::new(), Vec::new());
            tree.around(at, distance, &mut |object| {
                visited.push(object);
                distance
            });
            tree.within(|bounds| away(bounds) <= distance, |object| within.push(object));
            visited.sort_unstable();
            within.sort_unstable();
            let right: Vec<_> = (0..boxes.len()).filter(|index| away(&boxes[*index]) <= distance).collect();
            // Boxes are slightly larger in the tree.
            assert!(right.iter().all(|object| visited.contains(object) && within.contains(object)), "{at}");
            assert!(
                visited.iter().chain(&within).all(|object| away(&boxes[*object]) < distance + 0.2),
                "{at}"
            );
            let mut count = 0;
            tree.around(at, distance, &mut |_| {
                count += 1;
                -1.0
            });
            assert_eq!(count, usize::from(!right.is_empty()));
        }
    }

    #[test]
    fn a_drift_makes_rays_enter_what_others_within_it_enter() {
        #[derive(Default)]
        struct Visited(Vec<usize>);
        impl PacketVisitor for Visited {
            fn test(&mut self, object: usize, _: Range<usize>, _: &mut [f64]) {
                self.0.push(object);
            }
            fn test_one(&mut self, object: usize, _: usize, _: &mut [f64]) {
                self.0.push(object);
            }
        }
        let tree = Bvh::new(&boxes());
        // The ray passes beside the first box, at 0.51, through rows of boxes.
        let ray = Ray { origin: DVec3::new(0.51, 0.25, -2.0), dir: DVec3::Z };
        let (origin, dir) = (Vectors::<LANES>::of(ray.origin), Vectors::<LANES>::of(ray.dir));
        let rays = RayPacket::new(origin.view(LANES), dir.view(LANES), 0.0);
        for (drift, all) in [
            (RayError::NONE, 0),
            (RayError { origin: 0.02, dir: 0.0 }, 10),
            // This is enough from z = 6 on.
            (RayError { origin: 0.0, dir: 0.00126 }, 4),
        ] {
            for cpu in Cpu::all() {
                let (mut alone, mut together) = (Vec::new(), Visited::default());
                tree.closest_within(cpu, &mut Stack::default(), &ray, drift, 1e9, |object, t_max| {
                    alone.push(object);
                    t_max
                });
                visit(cpu, &tree, &mut Stack::default(), rays, drift, &mut [1e9; LANES], &mut together);
                for visited in [alone, together.0] {
                    let far = (10 - all..10).map(|z| 100 * z);
                    assert!(
                        far.into_iter().all(|object| visited.contains(&object)),
                        "{drift:?}: {visited:?}"
                    );
                    assert!(all > 0 || visited.is_empty(), "{visited:?}");
                }
            }
        }
    }
}
