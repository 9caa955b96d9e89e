//! What keeps buffers as full as they were at the start.

use super::{Common, Kept, OpenBoundary, Stored, WeaklyCompressible};
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
    /// do not change: what is in buffers is no part of it. Where a surface can fall, nothing is let in.
    pub(super) fn even_out(&self, common: &Common<D>, whole: &mut [f64], free: &mut Vec<u32>) {
        let spacing = common.particles.spacing[0];
        let domain = common.support.list().domain();
        for (role, boundary) in self.open.boundaries.all.iter().enumerate() {
            let sites = &self.open.sites[role];
            let (numbers, is_own) = self.occupants(common, (role, boundary), whole);
            let at = common.all_columns(whole);
            let places = numbers.iter().map(|&number| at.position[number as usize]);
            let points: Vec<Vector<D>> = places.chain(sites.iter().copied()).collect();
            // Points that cannot be searched are found where forces are.
            let Ok(near) = search(&points, &vec![EMPTY * spacing; points.len()], domain) else {
                continue;
            };
            let first = numbers.len();
            let is_crowded = |a: usize, is_there: &[bool]| {
                near.row(a).iter().map(|&other| other as usize).any(|other| {
                    let distance = domain.separation(&points[a], &points[other]).norm();
                    is_there[other] && distance < CROWDED * spacing
                })
            };
            // From the fluid on: what is taken out takes out no other.
            let depth = |a: usize| boundary.plane - points[a].dot(&boundary.normal);
            let mut own: Vec<usize> = (0..first).filter(|&a| is_own[a]).collect();
            own.sort_by(|&a, &b| depth(a).total_cmp(&depth(b)).then(a.cmp(&b)));
            let mut is_there = vec![false; points.len()];
            (0..first).for_each(|a| is_there[a] = !is_own[a]);
            for a in own {
                is_there[a] = !is_crowded(a, &is_there);
                if !is_there[a] {
                    self.take_out(common, numbers[a] as usize, whole);
                    free.push(numbers[a]);
                }
            }
            free.sort_unstable_by(|a, b| b.cmp(a));
            if common.settings.free_surface {
                continue;
            }
            for site in first..points.len() {
                if near.row(site).iter().any(|&other| is_there[other as usize]) {
                    continue;
                }
                let far = |&a: &usize| domain.separation(&points[site], &points[a]).norm_squared();
                let present = (0..first).filter(|&a| is_own[a] && is_there[a]);
                let Some(like) = present.min_by(|a, b| far(a).total_cmp(&far(b))) else { break };
                let Some(next) = free.pop() else {
                    Kept::of_all(common, whole).1.counts[1] += 1.0;
                    return;
                };
                is_there[site] = true;
                let place = (role, points[site]);
                self.let_in(common, numbers[like] as usize, next as usize, place, whole);
            }
        }
    }

    /// The numbers of all particles in a buffer and less than a spacing in front of it, and whether they belong to it.
    fn occupants(
        &self,
        common: &Common<D>,
        (role, boundary): (usize, &OpenBoundary<D>),
        whole: &[f64],
    ) -> (Vec<u32>, Vec<bool>) {
        let at = common.all_columns(whole);
        let opening = Stored::<D>::of(at.tail, common.particles.len()).opening;
        let spacing = common.particles.spacing[0];
        let counted = |number: usize| {
            if opening[number] as usize == role + 1 {
                return Some((number as u32, true));
            }
            let depth = boundary.depth(&at.position[number], spacing)?;
            let is_removed = Common::<D>::is_removed(at.density[number]);
            let is_near = (-spacing..boundary.length).contains(&depth);
            (is_near && !is_removed).then_some((number as u32, false))
        };
        (0..opening.len()).filter_map(counted).unzip()
    }
}
