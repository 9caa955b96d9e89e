//! Particles that act on each other wherever they are, as those of rigid bodies and of springs: each of several ranks gets
//! what all of them have.

use std::ops::Range;
use std::sync::Arc;

use super::{Solid, TotalLagrangian};
use crate::Vector;
use crate::parallel::Team;
use crate::schemes::Part;

/// These particles, wherever they are, with the whole solid.
pub(super) struct Group<const D: usize> {
    solid: Arc<Solid<D>>,
    team: Team,
    /// In ascending order.
    particles: Vec<u32>,
    /// The particles of this rank among all, and those of them that belong to the group.
    own: Range<usize>,
    members: Range<usize>,
}

impl<const D: usize> Group<D> {
    /// That of a rank of a solid, of which none has all; nothing where no particles act on each other in this way.
    pub fn of(whole: &TotalLagrangian<D>, part: &Part, team: &Team) -> Option<Arc<Self>> {
        let springs = whole.loads.springs.iter().flat_map(|spring| &spring.particles);
        let mut particles: Vec<u32> = whole.rigid.particles().chain(springs).copied().collect();
        particles.sort_unstable();
        particles.dedup();
        if part.is_whole() || particles.is_empty() {
            return None;
        }
        let own = part.own();
        let place = |bound: usize| particles.partition_point(|&a| (a as usize) < bound);
        let members = place(own.start)..place(own.end);
        let (solid, team) = (whole.solid.clone(), team.clone());
        Some(Arc::new(Self { solid, team, particles, own, members }))
    }

    /// How many of them other ranks have, where one has those from `own.start` to `own.end`.
    pub fn elsewhere(whole: &TotalLagrangian<D>, own: &Range<usize>) -> usize {
        let springs = whole.loads.springs.iter().flat_map(|spring| &spring.particles);
        let all = whole.rigid.particles().chain(springs);
        all.filter(|&&a| !own.contains(&(a as usize))).count()
    }

    /// Those that this rank has, by number among all and here.
    fn members(&self) -> impl Iterator<Item = (usize, usize)> {
        let members = self.particles[self.members.clone()].iter();
        members.map(|&a| (a as usize, a as usize - self.own.start))
    }

    /// Fields with the values of all of them, and zeros elsewhere, which takes one message to each of the others.
    fn spread<const N: usize>(&self, fields: [&[Vector<D>]; N]) -> [Vec<Vector<D>>; N] {
        debug_assert!(fields.iter().all(|field| field.len() == self.own.len()), "own rows alone");
        let own = self.members().flat_map(|(_, here)| fields.map(|field| field[here])).collect();
        let values = self.team.rows_of_all(own);
        std::array::from_fn(|field| {
            let mut all = vec![Vector::zeros(); self.solid.len()];
            let values = values.iter().skip(field).step_by(N.max(1));
            self.particles.iter().zip(values).for_each(|(a, value)| all[*a as usize] = *value);
            all
        })
    }
}

impl<const D: usize> TotalLagrangian<D> {
    /// Calls `body` with the solid and with fields, the first ones to read and the others to change: as they are, or on
    /// several ranks with the values of the particles of the group, which are all that it may look at.
    pub(super) fn with_group<const N: usize, const M: usize, R>(
        &self,
        read: [&[Vector<D>]; N],
        mut written: [&mut [Vector<D>]; M],
        body: impl FnOnce(&Solid<D>, [&[Vector<D>]; N], [&mut [Vector<D>]; M]) -> R,
    ) -> R {
        let Some(group) = &self.group else { return body(&self.solid, read, written) };
        let seen = group.spread(read);
        let mut changed = group.spread(written.each_ref().map(|field| &**field));
        let fields = changed.each_mut().map(Vec::as_mut_slice);
        let result = body(&group.solid, seen.each_ref().map(Vec::as_slice), fields);
        for (field, changed) in written.iter_mut().zip(&changed) {
            group.members().for_each(|(a, here)| field[here] = changed[a]);
        }
        result
    }

    /// The masses of all particles in kg, those of other ranks among them where they act on each other.
    pub(super) fn masses(&self) -> &[f64] {
        self.group.as_ref().map_or(&self.solid.mass, |group| &group.solid.mass)
    }
}
