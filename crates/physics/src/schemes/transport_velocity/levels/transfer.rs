//! What one level of resolution takes from another.

use piola_formulas::kernels::Kernel;
use piola_formulas::pairs::Record;
use piola_formulas::pairs::fit::{Fit, Flow, FlowSide};

use crate::Vector;
use crate::neighbors::{Domain, NeighborError};
use crate::operators::{Among, MovingSupport, Term, gather};

/// A particle that others take from, or that takes from them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taken<const D: usize> {
    /// Where it is in m.
    pub position: Vector<D>,
    /// What it has.
    pub flow: Flow<f64, D>,
}

/// The neighbours of the particles of one level among those of another. Numbers are those of the level that gives, then
/// those of the one that takes.
pub(super) struct Transfer<const D: usize> {
    support: MovingSupport<D>,
    givers: usize,
    /// Who gives or takes: others have no neighbours and are none. By number.
    is_passive: Vec<bool>,
    is_out: Vec<bool>,
    /// By place, what is given and what is found.
    given: Vec<Flow<f64, D>>,
    found: Vec<Option<Flow<f64, D>>>,
}

impl<const D: usize> Transfer<D> {
    /// From the particles of a level with this smoothing length in m to those of another.
    ///
    /// # Errors
    /// When the search refuses the support.
    pub fn new(
        [giving, taking]: [&[Vector<D>]; 2],
        kernel: Kernel,
        smoothing_length: f64,
        domain: Domain<D>,
    ) -> Result<Self, NeighborError> {
        let positions = [giving, taking].concat();
        let count = positions.len();
        let passive = vec![true; count];
        Ok(Self {
            support: MovingSupport::new(&positions, passive, kernel, smoothing_length, domain)?,
            givers: giving.len(),
            is_passive: vec![true; count],
            is_out: vec![true; count],
            given: vec![FlowSide::zero(); count],
            found: vec![None; count],
        })
    }

    /// Says which particles of the two levels give and take.
    pub fn choose(&mut self, gives: impl Fn(usize) -> bool, takes: impl Fn(usize) -> bool) {
        let mut differs = false;
        for (number, (passive, out)) in self.is_passive.iter_mut().zip(&mut self.is_out).enumerate()
        {
            let (is_passive, is_out) = match number.checked_sub(self.givers) {
                None => (true, !gives(number)),
                Some(taker) => (false, !takes(taker)),
            };
            differs |= (*passive, *out) != (is_passive, is_out);
            (*passive, *out) = (is_passive, is_out);
        }
        if differs {
            self.support.exclude(&self.is_passive, &self.is_out);
        }
    }

    /// Finds what those that take have at their places, theory (95): `of` has both levels, with the number of the particle there
    /// and whether it gives. Places that are no numbers leave what was found before; whoever has them ends the run.
    pub fn find(&mut self, of: impl Fn(bool, usize) -> Taken<D> + Sync) {
        let givers = self.givers;
        let taken = self.support.update_with(&mut self.given, |number, given| {
            let it = match number.checked_sub(givers) {
                None => of(true, number),
                Some(taker) => of(false, taker),
            };
            *given = it.flow;
            it.position
        });
        if taken.is_err() {
            return;
        }
        let (list, is_out) = (self.support.list(), &self.is_out);
        let takes = |place: usize| {
            let number = list.numbers()[place] as usize;
            (number >= givers && !is_out[number]).then_some(place)
        };
        let sum = Term { law: Fit::<D>, source: self.given.as_slice(), among: Among::Passive };
        gather(&self.support, &sum, &mut self.found, takes, |_, sums, row| {
            *row = sums.at_centre();
        });
    }

    /// What was found for a particle that takes, by its number in its level; nothing without anybody near.
    pub fn found(&self, taker: usize) -> Option<&Flow<f64, D>> {
        let place = self.support.list().places()[self.givers + taker] as usize;
        self.found[place].as_ref()
    }

    /// Bytes that it holds.
    pub fn memory(&self) -> usize {
        let particle = size_of::<Flow<f64, D>>() + size_of::<Option<Flow<f64, D>>>() + 2;
        self.support.memory() + self.given.len() * particle
    }
}
