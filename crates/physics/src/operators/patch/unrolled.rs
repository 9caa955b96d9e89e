//! Places of particles without the ends of periods.

use crate::Vector;
use crate::operators::DirectedSupport;

/// Particles followed from one to the next in each part that hangs together, across the ends of periods too: a body that
/// lies across them is in one piece.
pub(super) struct Unrolled<const D: usize> {
    pub places: Vec<Vector<D>>,
    /// The part of each particle.
    pub part_of: Vec<u32>,
    /// The axes along which each part goes on for ever. Places along them are as given.
    pub endless: Vec<[bool; D]>,
}

impl<const D: usize> Unrolled<D> {
    pub fn new(support: &DirectedSupport<D>, positions: &[Vector<D>]) -> Self {
        let part_of = support.list.parts();
        let count = part_of.iter().max().map_or(0, |&last| last as usize + 1);
        let (places, endless) = (positions.to_vec(), vec![[false; D]; count]);
        let mut unrolled = Self { places, part_of, endless };
        if !support.domain.is_open() {
            unrolled.follow(support, positions);
        }
        unrolled
    }

    fn follow(&mut self, support: &DirectedSupport<D>, positions: &[Vector<D>]) {
        let (domain, list) = (&support.domain, &support.list);
        let periods = domain.periodic().map(|bounds| bounds.map(|[lower, upper]| upper - lower));
        // How many periods further on `b` is than its position, as seen from `a`.
        let beyond = |a: usize, b: usize| {
            let direct = positions[b] - positions[a];
            let wound = domain.separation(&positions[a], &positions[b]) - direct;
            Vector::<D>::from_fn(|i, _| {
                periods[i].map_or(0.0, |period| (wound[i] / period).round())
            })
        };
        let mut turns = vec![Vector::<D>::zeros(); positions.len()];
        let mut is_known = vec![false; positions.len()];
        for first in 0..positions.len() {
            let mut pending = if is_known[first] { Vec::new() } else { vec![first] };
            is_known[first] = true;
            while let Some(a) = pending.pop() {
                for &b in list.row(a).iter().chain(support.dual.row(a)) {
                    let b = b as usize;
                    if !is_known[b] {
                        is_known[b] = true;
                        turns[b] = turns[a] + beyond(a, b);
                        pending.push(b);
                    }
                }
            }
        }
        for a in 0..positions.len() {
            for &b in list.row(a) {
                let gap = turns[b as usize] - turns[a] - beyond(a, b as usize);
                let endless = self.endless[self.part_of[a] as usize].iter_mut().zip(&gap);
                endless.for_each(|(endless, gap)| *endless |= *gap != 0.0);
            }
        }
        for (a, (place, turns)) in self.places.iter_mut().zip(&turns).enumerate() {
            for (axis, period) in periods.iter().enumerate() {
                let is_endless = self.endless[self.part_of[a] as usize][axis];
                place[axis] += period.filter(|_| !is_endless).map_or(0.0, |it| it * turns[axis]);
            }
        }
    }
}
