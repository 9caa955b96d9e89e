//! What keeps buffers as full as they were at the start.

use super::{Common, OpenBoundary, Stored, WeaklyCompressible};
use crate::Vector;
use crate::neighbors::search;

/// A place of a buffer is empty if no particle is nearer, in spacings: on a lattice, wherever it has moved, one is, at
/// most half the diagonal of a cube away.
const EMPTY: f64 = 0.9;

/// Of particles that are nearer to each other, in spacings, one is too many.
const CROWDED: f64 = 0.5;

impl<const D: usize> WeaklyCompressible<D> {
    /// Takes particles out of buffers that are too near to others, and lets some in where places are empty at which
    /// the buffer had particles at the start. A stream that slows down pulls apart what went out
    /// before, which would come back with gaps, and one that grows faster piles it up. The fluid and its balances
    /// do not change: what is in buffers is no part of it.
    pub(super) fn even_out(&self, common: &Common<D>, state: &mut [f64], free: &mut Vec<u32>) {
        let spacing = common.particles.spacing[0];
        let domain = common.support.list().domain();
        for (role, boundary) in self.open.boundaries.all.iter().enumerate() {
            let sites = &self.open.sites[role];
            let mut numbers = self.occupants(common, (role, boundary), state);
            let at = common.columns(state);
            let places = numbers.iter().map(|&number| at.position[number as usize]);
            let points: Vec<Vector<D>> = places.chain(sites.iter().copied()).collect();
            // Points that cannot be searched are found where forces are.
            let Ok(near) = search(&points, &vec![EMPTY * spacing; points.len()], domain) else {
                continue;
            };
            let first = numbers.len();
            let depth = |a: usize| boundary.plane - points[a].dot(&boundary.normal);
            let mut is_there: Vec<bool> = (0..points.len()).map(|a| a < first).collect();
            for a in (0..first).filter(|&a| depth(a) >= 0.0) {
                // Of two that are too near the one stays that is nearer to the fluid.
                is_there[a] = !near.row(a).iter().map(|&other| other as usize).any(|other| {
                    let distance = domain.separation(&points[a], &points[other]).norm();
                    is_there[other]
                        && distance < CROWDED * spacing
                        && (depth(other), other) < (depth(a), a)
                });
                if !is_there[a] {
                    self.take_out(common, numbers[a] as usize, state);
                    free.push(numbers[a]);
                }
            }
            free.sort_unstable_by(|a, b| b.cmp(a));
            for site in first..points.len() {
                if near.row(site).iter().any(|&other| is_there[other as usize]) {
                    continue;
                }
                let far = |&a: &usize| domain.separation(&points[site], &points[a]).norm_squared();
                let present = (0..first).filter(|&a| is_there[a]);
                let nearest = present.min_by(|a, b| far(a).total_cmp(&far(b)));
                let Some((next, nearest)) = nearest.and_then(|a| Some((free.pop()?, a))) else {
                    break;
                };
                numbers.push(next);
                is_there[site] = true;
                self.let_in(
                    common,
                    numbers[nearest] as usize,
                    next as usize,
                    (role, points[site]),
                    state,
                );
            }
        }
    }

    /// The numbers of the particles of a buffer, and of the fluid less than a spacing in front of it.
    fn occupants(
        &self,
        common: &Common<D>,
        (role, boundary): (usize, &OpenBoundary<D>),
        state: &[f64],
    ) -> Vec<u32> {
        let at = common.columns(state);
        let opening = Stored::<D>::of(at.tail, common.particles.len()).opening;
        let spacing = common.particles.spacing[0];
        let is_wall = |number: usize| {
            common.is_wall[number] && self.open.roles[number] == 0 && !common.removed[number]
        };
        let counts = |&number: &usize| match opening[number] as usize {
            0 => {
                let depth = boundary.depth(&at.position[number], spacing);
                !is_wall(number)
                    && !Common::<D>::is_removed(at.density[number])
                    && depth.is_some_and(|depth| (-spacing..0.0).contains(&depth))
            }
            own => own == role + 1,
        };
        (0..opening.len()).filter(counts).map(|number| number as u32).collect()
    }
}
