//! Particles that act on each other wherever they are, as those of rigid bodies and of springs: each of several ranks gets
//! what all of them have.

use std::sync::Arc;

use super::{Solid, TotalLagrangian};
use crate::Vector;
use crate::parallel::Team;
use crate::schemes::Part;

/// Those particles of all ranks, with the whole solid.
pub(super) struct Group<const D: usize> {
    solid: Arc<Solid<D>>,
    team: Team,
    /// In ascending order.
    particles: Vec<u32>,
}

impl<const D: usize> Group<D> {
    /// That of a rank of a solid, of which none has all; nothing where no particles act on each other in this way.
    pub fn of(whole: &TotalLagrangian<D>, part: &Part, team: &Team) -> Option<Arc<Self>> {
        let springs = whole.loads.springs.iter().flat_map(|spring| &spring.particles);
        let mut particles: Vec<u32> = whole.rigid.particles().chain(springs).copied().collect();
        particles.sort_unstable();
        particles.dedup();
        let (solid, team) = (whole.solid.clone(), team.clone());
        let is_there = !(part.is_whole() || particles.is_empty());
        is_there.then(|| Arc::new(Self { solid, team, particles }))
    }

    /// Those that this rank has of so many, by number among all and here.
    fn own(&self, count: usize) -> impl Iterator<Item = (usize, usize)> {
        let own = move |&a: &u32| Some((a as usize, self.team.own(a as usize, count)?));
        self.particles.iter().filter_map(own)
    }

    /// A field with the values of all of them, and zeros elsewhere.
    fn spread(&self, field: &[Vector<D>]) -> Vec<Vector<D>> {
        let own = self.own(field.len()).map(|(_, here)| field[here]).collect();
        let mut all = vec![Vector::zeros(); self.solid.len()];
        let values = self.team.rows_of_all(own);
        self.particles.iter().zip(values).for_each(|(a, value)| all[*a as usize] = value);
        all
    }
}

impl<const D: usize> TotalLagrangian<D> {
    /// Calls `body` with the solid and fields of all particles that it may look at, the first ones to read and the others to
    /// change: all there are, or those of the group.
    pub(super) fn with_group<const N: usize, const M: usize, R>(
        &self,
        read: [&[Vector<D>]; N],
        mut written: [&mut [Vector<D>]; M],
        body: impl FnOnce(&Solid<D>, [&[Vector<D>]; N], [&mut [Vector<D>]; M]) -> R,
    ) -> R {
        let Some(group) = &self.group else { return body(&self.solid, read, written) };
        let seen = read.map(|field| group.spread(field));
        let mut changed = written.each_ref().map(|field| group.spread(field));
        let fields = changed.each_mut().map(Vec::as_mut_slice);
        let result = body(&group.solid, seen.each_ref().map(Vec::as_slice), fields);
        for (field, changed) in written.iter_mut().zip(&changed) {
            for (a, here) in group.own(field.len()) {
                field[here] = changed[a];
            }
        }
        result
    }

    /// The masses of all particles in kg, those of other ranks among them where they act on each other.
    pub(super) fn masses(&self) -> &[f64] {
        self.group.as_ref().map_or(&self.solid.mass, |group| &group.solid.mass)
    }
}
