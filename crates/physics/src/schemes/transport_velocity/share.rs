//! The part of a rank.
//!
//! Which particles a rank has does not change. Where they are and which others it sees does, so that copies are planned
//! anew with each list of neighbours.

use std::ops::Range;

use piola_formulas::pairs::Record;
use piola_formulas::pairs::fluid::FluidSide;

use super::stages::Pass;
use super::{Continuum, TransportVelocity};
use crate::operators::Slots;
use crate::schemes::{Part, RankRefusal, RankRows, RankShare};

impl<const D: usize, M: Continuum<D>> TransportVelocity<D, M> {
    /// What a rank has at the start.
    fn slots(&self, own: Range<usize>, bounds: &[usize]) -> Slots {
        let rank = |b: usize| bounds.partition_point(|&bound| bound <= b) - 1;
        let list = self.common.support.list();
        let rows = list.places()[own.clone()].iter().flat_map(|&place| list.row(place as usize));
        let others = rows.map(|&place| list.numbers()[place as usize] as usize);
        let mut others: Vec<usize> = others.filter(|b| !own.contains(b)).collect();
        others.sort_unstable();
        others.dedup();
        let copies = others.into_iter().map(|b| (rank(b), b)).collect();
        Slots::new(own, Vec::new(), copies)
    }

    /// How many numbers of a particle those who have a copy of it are told in a step.
    fn told(&self) -> usize {
        let (settings, side) = (&self.common.settings, FluidSide::<D>::NUMBERS);
        let shows = |pass: &Pass<M::Own>| match pass {
            Pass::Load | Pass::Push | Pass::Walls => side,
            Pass::State if settings.sets_state() => side,
            Pass::Sharpen | Pass::Surfaces => D + 1,
            _ => 0,
        };
        let passes = self.drift.passes().iter().chain(self.accelerate.passes());
        D + passes.map(|pass| shows(pass) + M::shows(*pass)).sum::<usize>()
    }

    /// What ranks would have at the start whose particles begin and end where `bounds` has it.
    pub(crate) fn planned(&self, bounds: &[usize]) -> Vec<RankShare> {
        Part::planned(self, bounds, self.told(), |own| self.slots(own, bounds))
    }

    /// The particles of a rank. What does not change of particles it knows of all.
    pub(crate) fn shared(&self, part: &Part) -> Result<Self, RankRefusal> {
        let team = part.team(&Slots::default())?;
        let rows = RankRows::of(self, &part.bounds);
        let start = rows.part(part.ranks.rank(), &self.start);
        let common = self.common.part(team, part.own().len(), rows);
        Ok(Self {
            matter: self.matter.part(&common),
            common,
            start,
            drift: self.drift.clone(),
            accelerate: self.accelerate.clone(),
        })
    }
}
