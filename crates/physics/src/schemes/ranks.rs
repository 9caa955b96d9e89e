//! What a formulation offers to ranks that compute it together.

use std::ops::Range;
use std::sync::Arc;

use piola_ranks::{Alone, RankError, Ranks};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::Scheme;
use crate::operators::Slots;
use crate::parallel::{self, Halo, Team};

/// The particles of each rank: those from `bounds[k]` to `bounds[k + 1]` in memory.
#[derive(Clone)]
pub struct Part {
    /// One rank, and through it the others.
    pub ranks: Arc<dyn Ranks>,
    /// Where the particles of each rank begin, and where those of the last end.
    pub bounds: Vec<usize>,
}

impl Part {
    /// That of the only rank of `count` particles.
    pub fn whole(count: usize) -> Self {
        Self { ranks: Arc::new(Alone), bounds: vec![0, count] }
    }

    /// Where the particles of each of `size` ranks begin, and where those of the last end: whole chunks, with about the
    /// same cost. Of several systems they are those of the one that ranks [divide](Scheme::divided).
    ///
    /// # Errors
    /// There are fewer chunks than ranks.
    pub fn bounds(scheme: &dyn Scheme, size: usize) -> Result<Vec<usize>, RankRefusal> {
        let scheme = scheme.divided().unwrap_or(scheme);
        let count = scheme.particle_count();
        let length = parallel::chunk(count);
        let chunks = count.div_ceil(length);
        if size > chunks {
            return Err(RankRefusal::TooMany { ranks: size, particles: count, length, chunks });
        }
        let cost = |chunk: usize| scheme.cost(chunk * length..((chunk + 1) * length).min(count));
        let costs: Vec<f64> = (0..chunks).map(cost).collect();
        Ok(cuts(&costs, size).into_iter().map(|chunk| (chunk * length).min(count)).collect())
    }

    /// What ranks would have whose particles begin and end where `bounds` has it, and which have these slots, and of a copy
    /// so many numbers in an evaluation.
    pub fn planned(
        scheme: &dyn Scheme,
        bounds: &[usize],
        numbers: usize,
        slots: impl Fn(Range<usize>) -> Slots,
    ) -> Vec<RankShare> {
        let own = || bounds.windows(2).map(|ends| ends[0]..ends[1]);
        let costs: Vec<f64> = own().map(|own| scheme.cost(own)).collect();
        let mean = (costs.iter().sum::<f64>() / costs.len() as f64).max(f64::MIN_POSITIVE);
        let share = |(own, cost): (Range<usize>, &f64)| {
            let (particles, slots) = (own.len(), slots(own));
            let (copies, partners) = (slots.copies.len(), slots.partners());
            let bytes = copies * numbers * size_of::<f64>();
            RankShare { particles, copies, partners, bytes, load: cost / mean }
        };
        own().zip(&costs).map(share).collect()
    }

    /// The particles of this rank.
    pub fn own(&self) -> Range<usize> {
        let rank = self.ranks.rank();
        self.bounds[rank]..self.bounds[rank + 1]
    }

    /// Whether there is one rank.
    pub fn is_whole(&self) -> bool {
        self.ranks.size() == 1
    }

    /// The team of this rank, which has these slots. All ranks call this together.
    ///
    /// # Errors
    /// A rank is lost.
    pub fn team(&self, slots: &Slots) -> Result<Team, RankError> {
        if self.is_whole() {
            return Ok(Team::default());
        }
        let place = |slot: usize| slots.place(slot as u32);
        let halo = Halo::agree(self.ranks.as_ref(), &slots.copies, place)?;
        Ok(Team::new(self.ranks.clone(), self.bounds.clone(), halo))
    }
}

/// Where the rows of each rank stand in a state of all.
pub struct RankRows {
    /// The stretches of each rank, one of each column.
    stretches: Vec<Vec<Range<usize>>>,
    /// Where that begins which stands behind all columns.
    tail: usize,
}

impl RankRows {
    /// Those of ranks whose particles begin and end where `bounds` has it. Of several systems, those that stand behind the
    /// one that ranks [divide](Scheme::divided) are behind all columns, and so is all that each rank
    /// [has](Scheme::is_whole_on_ranks).
    pub fn of(scheme: &dyn Scheme, bounds: &[usize]) -> Self {
        if scheme.is_whole_on_ranks() {
            return Self { stretches: vec![Vec::new(); bounds.len() - 1], tail: 0 };
        }
        let scheme = scheme.divided().unwrap_or(scheme);
        let of_rank = |ends: &[usize]| {
            let fields = scheme.description().fields.iter();
            fields.filter_map(|field| scheme.stretch(field, &(ends[0]..ends[1]))).collect()
        };
        Self { stretches: bounds.windows(2).map(of_rank).collect(), tail: scheme.ledger_start() }
    }

    /// What a rank has of a state: its rows of each column, and what stands behind all columns.
    pub fn part(&self, rank: usize, state: &[f64]) -> Vec<f64> {
        let rows = self.stretches[rank].iter().flat_map(|stretch| &state[stretch.clone()]);
        rows.chain(&state[self.tail..]).copied().collect()
    }

    /// What each rank has of a state.
    pub fn split(&self, state: &[f64]) -> Vec<Vec<f64>> {
        (0..self.stretches.len()).map(|rank| self.part(rank, state)).collect()
    }

    /// The state of all that these parts are of, where it has nothing but them.
    pub fn whole(&self, parts: &[Vec<f64>]) -> Vec<f64> {
        let own: usize = self.stretches.iter().flatten().map(Range::len).sum();
        let all: usize = parts.iter().map(Vec::len).sum();
        let behind = (all - own) / parts.len().max(1);
        let mut state = vec![0.0; self.tail + behind];
        self.join(parts, &mut state);
        state
    }

    /// Puts a state together, of which rank 0 has what stands behind all columns.
    pub fn join(&self, parts: &[Vec<f64>], state: &mut [f64]) {
        for (own, part) in self.stretches.iter().zip(parts) {
            let mut rest = part.as_slice();
            for stretch in own {
                let (rows, others) = rest.split_at(stretch.len());
                state[stretch.clone()].copy_from_slice(rows);
                rest = others;
            }
        }
        if let Some(first) = parts.first() {
            let tail = &mut state[self.tail..];
            tail.copy_from_slice(&first[first.len() - tail.len()..]);
        }
    }
}

/// Where each of `size` ranks begins in a row of chunks of which the costs are known, and the end: each has one at least,
/// and about the same cost.
fn cuts(costs: &[f64], size: usize) -> Vec<usize> {
    let (whole, mut sum) = (costs.iter().sum::<f64>(), 0.0);
    let mut cuts = vec![0];
    for (chunk, cost) in costs.iter().enumerate() {
        // A rank ends where it has its share, and leaves a chunk for each of those that follow.
        let next = cuts.len();
        let is_full = sum + 0.5 * cost >= whole * next as f64 / size as f64;
        let is_needed = costs.len() - chunk == size - next;
        if next < size && chunk > cuts[next - 1] && (is_full || is_needed) {
            cuts.push(chunk);
        }
        sum += cost;
    }
    cuts.push(costs.len());
    cuts
}

/// What a rank has of a run, and what others tell it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RankShare {
    /// Its particles.
    pub particles: usize,
    /// What its particles and their images see of other ranks.
    pub copies: usize,
    /// Ranks that have them.
    pub partners: usize,
    /// Bytes that come in an evaluation of the rates, or in a product where equations are solved.
    pub bytes: usize,
    /// What it computes over an even share of all that there is to compute.
    pub load: f64,
}

/// What has taken a rank's time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RankCosts {
    /// Its particles.
    pub particles: usize,
    /// Seconds in which it computed.
    pub computed: f64,
    /// Seconds in which it told others and waited for them.
    pub waited: f64,
    /// Messages that it sent.
    pub messages: u64,
    /// Bytes that it sent.
    pub bytes: u64,
}

/// Why a run cannot be shared among ranks.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RankRefusal {
    /// The formulation has no parts.
    #[error("the formulation `{0}` does not run on several ranks yet: leave out `--ranks`")]
    Formulation(&'static str),
    /// Something of the case has none.
    #[error("{what} on several ranks yet: {instead}, or leave out `--ranks`")]
    Feature {
        /// What does not run.
        what: &'static str,
        /// What a case has to be like instead.
        instead: &'static str,
    },
    /// The integrator is not known to ranks.
    #[error("the integrator `{0}` does not run on several ranks yet: leave out `--ranks`")]
    Integrator(&'static str),
    /// There is nothing for a rank to do.
    #[error(
        "{ranks} ranks are too many for {particles} particles, of which each rank needs at least a chunk of {length}: {}",
        fewer(*chunks)
    )]
    TooMany {
        /// Ranks asked for.
        ranks: usize,
        /// Particles of the run.
        particles: usize,
        /// Particles a chunk.
        length: usize,
        /// Chunks of them.
        chunks: usize,
    },
    /// The ranks.
    #[error(transparent)]
    Ranks(#[from] RankError),
}

impl RankRefusal {
    /// Factors are made by one.
    pub(crate) const DIRECT: Self = Self::Feature {
        what: "the direct linear solver does not run",
        instead: "set `time.linear_solver = \"krylov\"`",
    };
}

/// What to do where there are more ranks than chunks.
fn fewer(chunks: usize) -> String {
    match chunks {
        0 | 1 => "leave out `--ranks`".to_owned(),
        2 => "take 2 ranks".to_owned(),
        chunks => format!("take {chunks} ranks or fewer"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rank_has_a_chunk_and_about_its_share() {
        let even = vec![1.0; 100];
        // Chunks that are as costly as all others together, first, last and in the middle.
        let heavy = |at: usize| (0..20).map(|k| if k == at { 19.0 } else { 1.0 }).collect();
        let slope = (0..64).map(f64::from).collect();
        for costs in [even, heavy(0), heavy(19), heavy(7), slope, vec![0.0; 9], vec![2.0; 7]] {
            for size in 1..=7 {
                let cuts = cuts(&costs, size);
                assert_eq!((cuts.len(), cuts[0], cuts[size]), (size + 1, 0, costs.len()));
                assert!(cuts.windows(2).all(|ends| ends[0] < ends[1]), "{cuts:?}");
                let most = costs.iter().copied().fold(0.0, f64::max);
                let share = costs.iter().sum::<f64>() / size as f64;
                let own = cuts.windows(2).map(|ends| costs[ends[0]..ends[1]].iter().sum::<f64>());
                // Either end is off by half a chunk at most, and one by its whole where ranks need one each.
                assert!(
                    own.clone().all(|own| own <= share + most),
                    "{size}: {cuts:?} of {costs:?}"
                );
            }
        }
    }
}
