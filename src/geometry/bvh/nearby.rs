//! Searches of a hierarchy for the objects near a point, and for those whose boxes pass any test.

use crate::geometry::aabb::{Aabb, SLACK};
use crate::geometry::bvh::tree::Bvh;
use glam::DVec3;

impl Bvh {
    /// Visits the objects whose boxes are within a distance of a point, in world units, roughly the nearer ones first.
    /// `visit` returns the distance beyond which no more need be visited; a negative number ends the search.
    pub fn around(&self, at: DVec3, distance: f64, mut visit: impl FnMut(usize) -> f64) {
        let (mut limit, mut ahead) = (distance, Vec::new());
        if !self.nodes.is_empty() {
            ahead.push((0.0, true, 0));
        }
        while let Some((nearest, is_node, index)) = ahead.pop() {
            // The boxes' own slack is more than the rounding of distances where the point is near; this is for others.
            if nearest * (1.0 - SLACK) > limit {
                continue;
            }
            if !is_node {
                limit = visit(self.objects[index as usize] as usize);
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

    /// Visits the objects that lie in boxes which a test lets pass, their own and those around it.
    pub fn within(&self, mut enters: impl FnMut(&Aabb) -> bool, mut visit: impl FnMut(usize)) {
        let mut ahead: Vec<_> = self.nodes.first().into_iter().collect();
        while let Some(node) = ahead.pop() {
            for child in (0..node.len()).filter(|child| enters(&node.bounds(*child))) {
                match node.child(child as u32) {
                    (true, index) => ahead.push(&self.nodes[index as usize]),
                    (false, index) => visit(self.objects[index as usize] as usize),
                }
            }
        }
    }
}
