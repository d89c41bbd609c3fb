//! How closed shapes are combined into a solid: which of them a point must lie in.

use crate::geometry::aabb::Aabb;
use std::sync::Arc;

/// A way to combine solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// The points in any of the solids.
    Union,
    /// The points in all of the solids.
    Intersection,
    /// The points in the first solid and in none of the others.
    Difference,
}

/// A condition on the parts in which a point lies. Parts are given by their indices.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree {
    /// Holds everywhere (true) or nowhere (false).
    Known(bool),
    /// Holds for points in the part of this index.
    Part(usize),
    /// Combines several conditions by an operation.
    Combined(Operation, Arc<[Tree]>),
}

impl Tree {
    /// Tells whether the condition holds at a point; `None` where that is undecided. `inside` tells the same for the
    /// part of an index.
    pub fn holds(&self, inside: &mut dyn FnMut(usize) -> Option<bool>) -> Option<bool> {
        match self {
            Self::Known(known) => Some(*known),
            Self::Part(part) => inside(*part),
            Self::Combined(Operation::Union, of) => any(of, inside),
            Self::Combined(Operation::Intersection, of) => {
                let mut all = Some(true);
                for one in of.iter() {
                    match one.holds(inside) {
                        Some(true) => {}
                        Some(false) => return Some(false),
                        None => all = None,
                    }
                }
                all
            }
            Self::Combined(Operation::Difference, of) => {
                let Some((first, others)) = of.split_first() else { return Some(false) };
                let first = first.holds(inside);
                if first == Some(false) {
                    return first;
                }
                match any(others, inside) {
                    Some(true) => Some(false),
                    Some(false) => first,
                    None => None,
                }
            }
        }
    }

    /// Returns the same condition on parts whose indices are larger by `by`.
    pub fn moved(&self, by: usize) -> Self {
        match self {
            Self::Known(known) => Self::Known(*known),
            Self::Part(part) => Self::Part(part + by),
            Self::Combined(operation, of) => {
                Self::Combined(*operation, of.iter().map(|one| one.moved(by)).collect())
            }
        }
    }

    /// Returns the maximum number of operations nested in the condition.
    pub fn depth(&self) -> usize {
        match self {
            Self::Known(_) | Self::Part(_) => 0,
            Self::Combined(_, of) => 1 + of.iter().map(Self::depth).max().unwrap_or(0),
        }
    }

    /// Returns the condition for points that lie outside of some parts. Conditions that do not change are shared.
    pub fn without(&self, is_outside: &dyn Fn(usize) -> bool) -> Self {
        self.changed(is_outside).unwrap_or_else(|| self.clone())
    }

    /// Returns the condition that [`without`](Self::without) returns, or `None` if it is this condition itself.
    fn changed(&self, is_outside: &dyn Fn(usize) -> bool) -> Option<Self> {
        let (operation, all) = match self {
            Self::Part(part) => return is_outside(*part).then_some(Self::Known(false)),
            Self::Known(_) => return None,
            Self::Combined(operation, all) => (*operation, all),
        };
        let mut changed: Option<Vec<Self>> = None;
        for (index, one) in all.iter().enumerate() {
            match (one.changed(is_outside), &mut changed) {
                (Some(new), of) => of.get_or_insert_with(|| all[..index].to_vec()).push(new),
                (None, Some(of)) => of.push(one.clone()),
                (None, None) => {}
            }
        }
        let mut of = changed?;
        match operation {
            Operation::Union => of.retain(|one| *one != Self::Known(false)),
            Operation::Intersection if of.contains(&Self::Known(false)) => return Some(Self::Known(false)),
            Operation::Intersection => {}
            Operation::Difference if of.first() == Some(&Self::Known(false)) => {
                return Some(Self::Known(false));
            }
            Operation::Difference => {
                let first = of.remove(0);
                of.retain(|one| *one != Self::Known(false));
                of.insert(0, first);
            }
        }
        Some(match of.len() {
            0 => Self::Known(false),
            1 => of.remove(0),
            _ => Self::Combined(operation, of.into()),
        })
    }

    /// Returns the path to a part through the condition, and whether the solid lies on the outer side of the part;
    /// `None` if the condition does not name the part. The path has, for each operation from the innermost one outward,
    /// the index of the operand that contains the part.
    pub fn path_to(&self, part: usize) -> Option<(Vec<usize>, bool)> {
        let (operation, of) = match self {
            Self::Known(_) => return None,
            Self::Part(own) => return (*own == part).then_some((Vec::new(), false)),
            Self::Combined(operation, of) => (*operation, of),
        };
        let (index, (mut path, is_outer)) =
            of.iter().enumerate().find_map(|(index, one)| Some((index, one.path_to(part)?)))?;
        path.push(index);
        Some((path, is_outer != (operation == Operation::Difference && index > 0)))
    }

    /// Tells whether a point on the surface of the part at the end of a [path](Self::path_to) lies on the surface of
    /// the solid; `None` where that is undecided. `inside` tells whether the point lies in another part.
    pub fn is_on_solid(&self, path: &[usize], inside: &mut dyn FnMut(usize) -> Option<bool>) -> Option<bool> {
        let (Self::Combined(operation, of), Some((own, inner))) = (self, path.split_last()) else {
            return Some(true);
        };
        let mut all = of[*own].is_on_solid(inner, inside);
        if all == Some(false) {
            return all;
        }
        for (other, one) in of.iter().enumerate().filter(|(other, _)| other != own) {
            let must_hold = match operation {
                Operation::Union => false,
                Operation::Intersection => true,
                Operation::Difference => other == 0,
            };
            match one.holds(inside) {
                Some(holds) if holds == must_hold => {}
                Some(_) => return Some(false),
                None => all = None,
            }
        }
        all
    }

    /// Returns a box that contains all points for which the condition holds; `None` if there is no such box.
    pub fn bounds(&self, of_part: &dyn Fn(usize) -> Option<Aabb>) -> Option<Aabb> {
        match self {
            Self::Known(true) => None,
            Self::Known(false) => Some(Aabb::EMPTY),
            Self::Part(part) => of_part(*part),
            Self::Combined(Operation::Union, of) => {
                of.iter().try_fold(Aabb::EMPTY, |all, one| Some(all.and(&one.bounds(of_part)?)))
            }
            Self::Combined(Operation::Intersection, of) => {
                of.iter().fold(None, |all, one| common(all, one.bounds(of_part)))
            }
            Self::Combined(Operation::Difference, of) => of.first()?.bounds(of_part),
        }
    }

    /// Returns the part whose surface is that of the solid at a point; `None` if the point does not lie on the solid's
    /// surface. `one` and `other` tell for each part whether it contains the points beside the point, on either side of
    /// the surface. If several parts have a surface there, the first part whose surface alone is that of the solid
    /// counts.
    pub fn owner(&self, one: &[bool], other: &[bool]) -> Option<usize> {
        let holds = |inside: &[bool]| self.holds(&mut |part| Some(inside[part]));
        if holds(one) == holds(other) {
            return None;
        }
        let crossed = || (0..one.len()).filter(|part| one[*part] != other[*part]);
        let decides = |part: &usize| {
            [one, other].into_iter().any(|side| {
                let mut without = side.to_vec();
                without[*part] = !side[*part];
                holds(&without) != holds(side)
            })
        };
        crossed().find(decides).or_else(|| crossed().next())
    }
}

fn any(of: &[Tree], inside: &mut dyn FnMut(usize) -> Option<bool>) -> Option<bool> {
    let mut any = Some(false);
    for one in of {
        match one.holds(inside) {
            Some(false) => {}
            Some(true) => return Some(true),
            None => any = None,
        }
    }
    any
}

/// Returns the intersection of two boxes; `None` stands for all of space.
pub fn common(one: Option<Aabb>, other: Option<Aabb>) -> Option<Aabb> {
    let (Some(one), Some(other)) = (one, other) else { return one.or(other) };
    Some(Aabb { low: one.low.max(other.low), high: one.high.min(other.high) })
}

#[cfg(test)]
mod tests {
    use super::Operation::{Difference, Intersection, Union};
    use super::*;

    fn parts(operation: Operation, of: &[usize]) -> Tree {
        Tree::Combined(operation, of.iter().copied().map(Tree::Part).collect())
    }

    #[test]
    fn what_is_open_matters_only_where_it_decides() {
        let [none, yes, no] = [None, Some(true), Some(false)];
        for (operation, of, holds) in [
            (Union, [none, yes], yes),
            (Union, [none, no], none),
            (Intersection, [none, no], no),
            (Intersection, [none, yes], none),
            (Difference, [none, yes], no),
            (Difference, [no, none], no),
            (Difference, [yes, none], none),
            (Difference, [yes, no], yes),
        ] {
            assert_eq!(parts(operation, &[0, 1]).holds(&mut |part| of[part]), holds, "{operation:?} {of:?}");
        }
    }

    #[test]
    fn a_surface_is_the_solids_where_the_other_parts_allow_it() {
        let tree = Tree::Combined(Difference, [parts(Union, &[0, 1]), parts(Difference, &[2, 3])].into());
        for part in 0..4 {
            let (path, is_outer) = tree.path_to(part).expect("the part is there");
            assert_eq!(is_outer, part == 2, "{part}");
            for bits in 0..16_usize {
                let inside: Vec<_> = (0..4).map(|part| bits >> part & 1 == 1).collect();
                let mut beyond = inside.clone();
                beyond[part] = !inside[part];
                let holds = |inside: &[bool]| tree.holds(&mut |part| Some(inside[part]));
                let is_seen = tree.is_on_solid(&path, &mut |part| Some(inside[part])) == Some(true);
                assert_eq!(is_seen, holds(&inside) != holds(&beyond), "{part} {bits:b}");
                assert_eq!(tree.owner(&inside, &beyond).is_some(), is_seen, "{part} {bits:b}");
            }
        }
    }

    #[test]
    fn surfaces_that_coincide_are_those_of_one_part() {
        let (out, within) = (vec![false; 2], vec![true; 2]);
        assert_eq!(parts(Union, &[0, 1]).owner(&out, &within), Some(0));
        assert_eq!(parts(Intersection, &[0, 1]).owner(&out, &within), Some(0));
        assert_eq!(parts(Difference, &[0, 1]).owner(&out, &within), None);
        let (left, right) = (vec![true, false], vec![false, true]);
        assert_eq!(parts(Union, &[0, 1]).owner(&left, &right), None);
        assert_eq!(parts(Intersection, &[0, 1]).owner(&left, &right), None);
        assert_eq!(parts(Difference, &[0, 1]).owner(&left, &right), Some(0));
    }

    #[test]
    fn parts_far_away_are_left_out() {
        let tree = Tree::Combined(Difference, [parts(Union, &[0, 1]), Tree::Part(2)].into());
        assert_eq!(tree.without(&|part| part == 2), parts(Union, &[0, 1]));
        assert_eq!(tree.without(&|part| part > 0), Tree::Part(0));
        assert_eq!(tree.without(&|part| part < 2), Tree::Known(false));
    }

    #[test]
    fn what_stays_as_it_is_takes_no_memory_again() {
        let tree = Tree::Combined(Difference, [parts(Union, &[0, 1]), parts(Union, &[2, 3])].into());
        let shares = |one: &Tree, other: &Tree| match (one, other) {
            (Tree::Combined(_, one), Tree::Combined(_, other)) => Arc::ptr_eq(one, other),
            _ => false,
        };
        assert!(shares(&tree.without(&|_| false), &tree));
        let Tree::Combined(_, of) = &tree else { panic!("{tree:?}") };
        let Tree::Combined(_, left) = tree.without(&|part| part == 0) else { panic!("{tree:?}") };
        assert!(shares(&left[1], &of[1]) && left[0] == Tree::Part(1), "{left:?}");
    }
}
