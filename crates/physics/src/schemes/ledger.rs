//! What changes energy and momentum, by name: powers and forces come from stages as totals, and the tail
//! of a state has their integrals.
//!
//! The tail begins with the work of each mechanism and the impulse of each source of momentum. Where kicks carry the
//! ledger, the rates of these integrals stand behind them, and then how fast each power grows in a kick.

use thiserror::Error;

use super::momentum::{MOST_COMPONENTS, add_moments, momentum_components};
use super::{Phase, Scheme};
use crate::Vector;
use crate::parallel::{Reduce, Sums};

/// Most mechanisms, and most sources of momentum, that a formulation may declare.
const MOST: usize = 16;

/// The ledger of a formulation: what may change its energy and its momentum, in the order of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Accounts {
    /// The mechanisms that give or take energy. Work done on the body is positive; what a dissipative
    /// mechanism takes is negative.
    pub mechanisms: &'static [&'static str],
    /// The ways in which momentum enters from outside.
    pub impulses: &'static [&'static str],
    /// Whether kicks carry the ledger, so that a state keeps its rates.
    pub is_kicked: bool,
}

/// A mechanism with the way by which its momentum enters, if it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    mechanism: usize,
    pub way: Option<usize>,
}

/// The sum over particles of what one mechanism does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Total {
    /// Power in W, or work in J of what is done at once.
    pub power: f64,
    /// How fast the power grows in a kick, W/s.
    pub growth: f64,
    /// Force with its moment, or impulse of what is done at once.
    pub force: [f64; MOST_COMPONENTS],
}

impl Total {
    /// That of a power, or a work, alone.
    pub fn of(power: f64) -> Self {
        Self { power, ..Self::default() }
    }

    /// That of a force in N on a particle.
    pub fn by<const D: usize>(
        position: &Vector<D>,
        velocity: &Vector<D>,
        force: &Vector<D>,
    ) -> Self {
        let mut total = Self::default();
        total.push(position, velocity, force);
        total
    }

    /// Adds a force in N on a particle.
    #[inline]
    pub fn push<const D: usize>(
        &mut self,
        position: &Vector<D>,
        velocity: &Vector<D>,
        force: &Vector<D>,
    ) {
        self.power += force.dot(velocity);
        add_moments(position, force, &mut self.force);
    }
}

impl Sums for Total {
    const NUMBERS: usize = 2 + MOST_COMPONENTS;

    fn each(&mut self, see: &mut impl FnMut(&mut f64)) {
        see(&mut self.power);
        see(&mut self.growth);
        self.force.iter_mut().for_each(see);
    }
}

impl Reduce for Total {
    const ZERO: Self = Self { power: 0.0, growth: 0.0, force: [0.0; MOST_COMPONENTS] };

    #[inline]
    fn add(&mut self, other: &Self) {
        self.power += other.power;
        self.growth += other.growth;
        self.force.add(&other.force);
    }
}

/// Which mechanisms have been filled, as bits, and which of them twice by one stage. Behind the bits of
/// rates stand those of what is done at once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Filled {
    once: u32,
    twice: u32,
}

impl Filled {
    fn fill(&mut self, bit: usize) {
        self.twice |= self.once & 1 << bit;
        self.once |= 1 << bit;
    }

    /// Those of both, which do not know of each other.
    pub(crate) fn join(&mut self, other: Self) {
        (self.once, self.twice) = (self.once | other.once, self.twice | other.twice);
    }
}

/// Powers and growths by mechanism, and forces by source of momentum.
type Slots = [Total; MOST];

fn fill(slots: &mut Slots, Entry { mechanism, way }: Entry, total: &Total) {
    slots[mechanism].power += total.power;
    slots[mechanism].growth += total.growth;
    if let Some(way) = way {
        slots[way].force.add(&total.force);
    }
}

/// What stages have found: rates, and what they have done at once.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    rates: Slots,
    done: Slots,
    pub filled: Filled,
}

/// Rates of the columns of a state, and the totals that go with them.
pub(crate) type Found<'a> = (&'a mut [f64], &'a mut Totals);

impl Totals {
    /// Fills in the power and the force of a mechanism.
    pub fn drive(&mut self, entry: Entry, total: &Total) {
        self.filled.fill(entry.mechanism);
        fill(&mut self.rates, entry, total);
    }

    /// Fills in how fast the power of a mechanism grows in a kick, W/s.
    pub fn grow(&mut self, entry: Entry, growth: f64) {
        self.rates[entry.mechanism].growth = growth;
    }

    /// Fills in the work and the impulse of a mechanism that a stage has done at once.
    pub fn book(&mut self, entry: Entry, total: &Total) {
        self.filled.fill(MOST + entry.mechanism);
        fill(&mut self.done, entry, total);
    }

    /// Fills in what one mechanism has in what is another's.
    pub fn part(&mut self, wholes: &[(Entry, Total)], part: Entry) {
        self.filled.fill(part.mechanism);
        for (whole, total) in wholes {
            fill(&mut self.rates, part, total);
            let rest = Total {
                power: -total.power,
                growth: -total.growth,
                force: total.force.map(|force| -force),
            };
            fill(&mut self.rates, *whole, &rest);
        }
    }

    /// Adds those of another stage.
    pub fn join(&mut self, other: &Self) {
        self.rates.add(&other.rates);
        self.done.add(&other.done);
        self.filled.join(other.filled);
    }
}

/// A mechanism whose ledger is wrong.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum LedgerFault {
    /// No stage fills it.
    #[error("no stage has filled the mechanism `{0}`, which the ledger declares")]
    NeverFilled(&'static str),
    /// A stage fills it twice.
    #[error("a stage has filled the mechanism `{0}` twice")]
    FilledTwice(&'static str),
}

impl Accounts {
    /// Without anything.
    pub const NONE: Self = Self { mechanisms: &[], impulses: &[], is_kicked: false };

    /// The mechanism of a name, with the source of momentum of the same name, if there is one.
    pub(crate) const fn entry(&self, name: &str) -> Entry {
        self.entry_by(name, name)
    }

    /// The mechanism of a name, with the source of momentum of another.
    pub(crate) const fn entry_by(&self, name: &str, way: &str) -> Entry {
        assert!(self.mechanisms.len() <= MOST && self.impulses.len() <= MOST, "too many");
        let mechanism = place(self.mechanisms, name).expect("the mechanism is declared");
        Entry { mechanism, way: place(self.impulses, way) }
    }

    /// Where a mechanism stands; behind all of them if it is none.
    pub(crate) fn place_of(&self, name: &str) -> usize {
        place(self.mechanisms, name).unwrap_or(self.mechanisms.len())
    }

    /// What is wrong with the ledger of a formulation whose stages have run.
    pub fn faults(&self, phases: &[&Phase]) -> Vec<LedgerFault> {
        let mut filled = Filled::default();
        phases.iter().for_each(|phase| filled.join(phase.filled));
        let is_in = |bits: u32, k: usize| (bits | bits >> MOST) & 1 << k != 0;
        let fault = |(k, name)| match (is_in(filled.once, k), is_in(filled.twice, k)) {
            (false, _) => Some(LedgerFault::NeverFilled(name)),
            (true, true) => Some(LedgerFault::FilledTwice(name)),
            (true, false) => None,
        };
        self.mechanisms.iter().copied().enumerate().filter_map(fault).collect()
    }

    /// The integrals, or their rates, as a tail has them.
    fn values(&self, dimension: usize, slots: &Slots) -> impl Iterator<Item = f64> {
        let components = momentum_components(dimension).len();
        let powers = slots[..self.mechanisms.len()].iter().map(|total| total.power);
        let forces = slots[..self.impulses.len()].iter();
        powers.chain(forces.flat_map(move |total| total.force.into_iter().take(components)))
    }

    /// Number of the integrals.
    pub(crate) fn integrals(&self, dimension: usize) -> usize {
        self.mechanisms.len() + self.impulses.len() * momentum_components(dimension).len()
    }

    /// Numbers of the ledger in a state.
    pub(crate) fn length(&self, dimension: usize) -> usize {
        let integrals = self.integrals(dimension);
        if self.is_kicked { 2 * integrals + self.mechanisms.len() } else { integrals }
    }

    /// What a formulation keeps in a tail behind the ledger.
    pub(crate) fn behind<'a>(&self, dimension: usize, tail: &'a [f64]) -> &'a [f64] {
        &tail[self.length(dimension)..]
    }

    /// The same, to be changed.
    pub(crate) fn behind_mut<'a>(&self, dimension: usize, tail: &'a mut [f64]) -> &'a mut [f64] {
        &mut tail[self.length(dimension)..]
    }

    /// Writes the tail of the rates of a state.
    pub(crate) fn write(&self, dimension: usize, totals: &Totals, tail: &mut [f64]) {
        tail.fill(0.0);
        let rates = self.values(dimension, &totals.rates);
        tail.iter_mut().zip(rates).for_each(|(slot, rate)| *slot = rate);
    }

    /// Adds what has been done at once to the integrals in the tail of a state.
    pub(crate) fn add(&self, dimension: usize, totals: &Totals, tail: &mut [f64]) {
        let done = self.values(dimension, &totals.done);
        tail.iter_mut().zip(done).for_each(|(sum, done)| *sum += done);
    }

    /// Adds what has been done at once, and keeps the rates for the kicks to come.
    pub(crate) fn keep(&self, dimension: usize, totals: &Totals, tail: &mut [f64]) {
        self.add(dimension, totals, tail);
        let kept = tail[self.integrals(dimension)..].iter_mut();
        let growths = totals.rates[..self.mechanisms.len()].iter().map(|total| total.growth);
        let rates = self.values(dimension, &totals.rates).chain(growths);
        kept.zip(rates).for_each(|(slot, rate)| *slot = rate);
    }

    /// As [`Self::keep`] at the end of an implicit step in s, whose works are known: impulses are the
    /// mean of the forces at both ends times the step.
    pub(crate) fn finish(&self, dimension: usize, step: f64, totals: &Totals, tail: &mut [f64]) {
        let (sums, kept) = tail.split_at_mut(self.integrals(dimension));
        let rates = kept.iter().zip(self.values(dimension, &totals.rates));
        let impulses = sums.iter_mut().zip(rates).skip(self.mechanisms.len());
        impulses.for_each(|(sum, (before, after))| *sum += 0.5 * step * (before + after));
        self.keep(dimension, totals, tail);
    }

    /// Carries the ledger on through a kick of `duration` s. Of a power that grows evenly, that half
    /// way is the mean: work is the change of the kinetic energy to round-off, theory (35).
    pub(crate) fn kick(&self, dimension: usize, duration: f64, tail: &mut [f64]) {
        let (sums, kept) = tail.split_at_mut(self.integrals(dimension));
        let (rates, growths) = kept.split_at_mut(sums.len());
        let (works, impulses) = sums.split_at_mut(self.mechanisms.len());
        let (powers, forces) = rates.split_at_mut(works.len());
        for ((work, power), growth) in works.iter_mut().zip(powers).zip(growths) {
            *work += duration * (*power + 0.5 * duration * *growth);
            *power += duration * *growth;
        }
        for (impulse, force) in impulses.iter_mut().zip(forces) {
            *impulse += duration * *force;
        }
    }

    /// Sets the integrals to nothing.
    pub(crate) fn clear(&self, dimension: usize, tail: &mut [f64]) {
        tail[..self.integrals(dimension)].fill(0.0);
    }
}

/// Where a name stands in a list.
const fn place(names: &[&str], name: &str) -> Option<usize> {
    const fn same(one: &[u8], other: &[u8]) -> bool {
        match (one, other) {
            ([a, one @ ..], [b, other @ ..]) => *a == *b && same(one, other),
            _ => one.is_empty() && other.is_empty(),
        }
    }
    let mut k = 0;
    while k < names.len() && !same(names[k].as_bytes(), name.as_bytes()) {
        k += 1;
    }
    if k < names.len() { Some(k) } else { None }
}

/// The running integrals at the end of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ledger<'a> {
    /// Work so far in J, one number a mechanism.
    pub work: &'a [f64],
    /// Impulse so far, one row of momentum components for each source of momentum.
    pub impulses: &'a [f64],
}

impl<'a> Ledger<'a> {
    /// The integrals of `state`.
    pub fn of(scheme: &dyn Scheme, state: &'a [f64]) -> Self {
        let tail = &state[scheme.ledger_start()..];
        let accounts = &scheme.description().ledger;
        let integrals = &tail[..accounts.integrals(scheme.dimension())];
        let (work, impulses) = integrals.split_at(accounts.mechanisms.len());
        Self { work, impulses }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schemes::stages::{Stage, Stages};

    const LEDGER: Accounts = Accounts {
        mechanisms: &["inner", "traction", "transport"],
        impulses: &["corrections", "traction"],
        is_kicked: true,
    };
    const INNER: Entry = LEDGER.entry("inner");
    const TRACTION: Entry = LEDGER.entry("traction");
    const TRANSPORT: Entry = LEDGER.entry_by("transport", "corrections");

    /// What is found after stages that fill these mechanisms each.
    fn faults(stages: &[&[Entry]]) -> Vec<LedgerFault> {
        let stage = |_| Stage { name: "stage", reads: &[], gathers: &[], writes: &[], shows: &[] };
        let passes = (0..stages.len()).collect();
        let mut all = Stages::new("test", &[], passes, stage, (0, &[])).expect("nothing is read");
        all.run(|pass, totals| {
            stages[pass].iter().for_each(|entry| totals.drive(*entry, &Total::of(1.0)));
        });
        LEDGER.faults(&[all.phase()])
    }

    #[test]
    fn a_mechanism_that_nobody_fills_or_a_stage_twice_is_found() {
        assert_eq!(faults(&[&[INNER, TRACTION], &[TRANSPORT]]), []);
        // Two stages may have a part in a mechanism each.
        assert_eq!(faults(&[&[INNER, TRACTION], &[TRANSPORT, INNER]]), []);
        assert_eq!(faults(&[&[INNER], &[TRACTION]]), [LedgerFault::NeverFilled("transport")]);
        let twice = faults(&[&[INNER, TRACTION, INNER], &[TRANSPORT]]);
        assert_eq!(twice, [LedgerFault::FilledTwice("inner")]);
    }

    /// Of a mass of 2 kg that moves with 3 m/s and is pulled with 4 N at (1, 5) m, in plane.
    #[test]
    fn a_kick_carries_work_and_impulse_by_name_and_leaves_the_rest() {
        let (mass, force) = (2.0, Vector::from([4.0, 0.0]));
        let mut pull = Total { growth: force.norm_squared() / mass, ..Total::default() };
        pull.push(&Vector::from([1.0, 5.0]), &Vector::from([3.0, 0.0]), &force);
        let mut totals = Totals::default();
        totals.drive(TRACTION, &pull);
        totals.book(TRANSPORT, &Total { power: 7.0, growth: 0.0, force: [0.25; 6] });
        let mut tail = vec![0.0; LEDGER.length(2) + 1];
        LEDGER.behind_mut(2, &mut tail)[0] = 9.0;
        LEDGER.keep(2, &totals, &mut tail);
        LEDGER.kick(2, 0.5, &mut tail);
        LEDGER.kick(2, 0.5, &mut tail);
        // From 3 to 5 m/s in 1 s: 16 J. The moment about the origin is -5 m times 4 N.
        assert_eq!(tail[..3], [0.0, 16.0, 7.0]);
        assert_eq!(tail[3..9], [0.25, 0.25, 0.25, 4.0, 0.0, -20.0]);
        assert_eq!(LEDGER.behind(2, &tail), [9.0]);
        LEDGER.write(2, &totals, &mut tail);
        assert_eq!(tail[..3], [0.0, 12.0, 0.0]);
        assert_eq!(tail[6..], [[4.0, 0.0, -20.0].as_slice(), &[0.0; 13]].concat());
    }
}
