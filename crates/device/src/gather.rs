//! The loop over neighbours as text.
//!
//! A gather sums pair laws over neighbours in the order of the processor's: eight lanes side by side,
//! neighbour k in lane k mod 8, added by halves, or one after the other. With CUDA eight threads work on
//! a particle, except where a term depends on the sums so far; elsewhere one.

use std::marker::PhantomData;

use piola_formulas::Number;
use piola_formulas::kernels::Kernel;
use piola_formulas::pairs::{self, Moving, MovingPair, Of, PairLaw, Record};

use crate::dialect::Dialect;
use crate::law::Law;
use crate::pass::{Pass, Use, counts, filled, flat, width};
use crate::record::Traced;

mod loops;
mod text;

pub use loops::Pairs;
use loops::{Loop, Met};

/// The space in which particles move.
#[derive(Clone, Debug)]
pub struct Space<const D: usize> {
    /// The kernel.
    pub kernel: Kernel,
    /// Its smoothing length in m.
    pub smoothing_length: f64,
    /// Lengths of periodic axes in m.
    pub periods: [Option<f64>; D],
    /// What neighbours are closer than in m.
    pub reach: f64,
}

impl<const D: usize> Space<D> {
    /// `distance` or the shorter way round a periodic axis, between two points inside its bounds.
    pub fn shorter_way(&self, axis: usize, distance: Traced) -> Traced {
        let Some(period) = self.periods[axis] else { return distance };
        let half = Traced::from(0.5 * period);
        let down = Traced::select(half.less(distance), distance - period, distance);
        Traced::select(distance.below(-0.5 * period), distance + period, down)
    }

    /// The length in m in which positions are counted, modulo `2^32`, where pairs are in single precision. It is as small
    /// as differences within the reach allow, and the length of a periodic axis is a multiple of `2^32` of it: the shorter way
    /// round comes by itself.
    pub fn unit(&self, axis: usize) -> f64 {
        let whole = 2.0_f64.powi(32);
        match self.periods[axis] {
            None => 4.0 * self.reach / whole,
            Some(mut period) => {
                while 0.5 * period >= 4.0 * self.reach {
                    period *= 0.5;
                }
                period / whole
            }
        }
    }

    /// The column of counts that gathers in single precision read.
    pub fn counts(&self) -> Use {
        counts(loops::COUNTS, loops::counted(D))
    }

    /// Its numbers of a position in m: see [`unit`](Self::unit). A position that is no number counts as any: lists have no
    /// neighbours of it.
    pub fn counted(&self, position: &[Traced]) -> Vec<Traced> {
        let count = |axis: usize| match position.get(axis) {
            Some(&place) => place * (1.0 / self.unit(axis)),
            None => Traced::from(0.0),
        };
        (0..self.counts().width).map(count).collect()
    }

    /// The pair of two particles of this separation.
    fn apart(&self, separation: &[Traced]) -> Moving<Traced, D> {
        let mut pair = MovingPair::<D>::zero();
        for (axis, &distance) in separation.iter().enumerate() {
            pair.separation[axis] = distance;
            let square = distance * distance;
            pair.square = if axis == 0 { square } else { pair.square + square };
        }
        let distance = pair.square.sqrt();
        pair.value = self.kernel.value(D, distance, self.smoothing_length);
        pair.slope = self.kernel.derivative_over_r(D, distance, self.smoothing_length);
        pair
    }
}

/// Which neighbours a term runs over, or which particles have sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Among {
    /// Those that are not passive.
    Active,
    /// Those that are.
    Passive,
    /// All of them, the passive ones last.
    All,
}

/// The order of the sums of a particle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Eight lanes side by side, added by halves.
    Lanes,
    /// One neighbour after the other. Terms are added to sums, and sums are only added to.
    Single,
    /// One neighbour after the other by one thread, so that a term may depend on the sums so far.
    Fold,
}

/// Who meets whom on a device, and what is known of each pair.
pub trait Meets {
    /// What is known of a pair.
    type Pair: Record;

    /// How a loop goes through the neighbours of the particles `over` which it runs.
    fn pairs(&self, over: Among) -> Pairs;

    /// What the numbers that a loop reads of a pair say of it.
    fn pair(&self, read: &[Traced]) -> Of<Self::Pair, Traced>;
}

impl<const D: usize> Meets for Space<D> {
    type Pair = MovingPair<D>;

    fn pairs(&self, over: Among) -> Pairs {
        let way = |x: &[Traced]| {
            let apart = |axis: usize| self.shorter_way(axis, x[axis] - x[D + axis]);
            (0..D).map(|axis| (format!("way_{axis}"), apart(axis))).collect()
        };
        let axes = |of: &'static str| (0..D).map(move |axis| format!("{of}_{axis}"));
        let separation =
            Box::new(Law::record("separation", axes("here").chain(axes("there")), way));
        let halves = self.periods.iter().map(|period| Some(0.5 * (*period)?)).collect();
        let units = (0..D).map(|axis| self.unit(axis)).collect();
        Pairs::Moving { dimension: D, over, separation, halves, units }
    }

    fn pair(&self, read: &[Traced]) -> Moving<Traced, D> {
        self.apart(read)
    }
}

/// Neighbours that do not change, with what is known of each pair, where a device has them.
#[derive(Clone, Debug)]
pub struct Frozen<P> {
    /// The columns.
    pub rows: Rows,
    record: PhantomData<P>,
}

impl<P: Record> Frozen<P> {
    /// Those in columns whose names begin with that of `rows`.
    ///
    /// # Panics
    /// When the rows have other numbers: that is a fault of whoever declared them.
    pub fn new(rows: Rows) -> Self {
        assert_eq!(rows.kept.len(), P::NUMBERS, "`{}` has the numbers of its pairs", rows.numbers);
        Self { rows, record: PhantomData }
    }
}

impl<P: Record> Meets for Frozen<P> {
    type Pair = pairs::Frozen<P>;

    fn pairs(&self, _over: Among) -> Pairs {
        Pairs::Frozen(self.rows.clone())
    }

    /// What fills up the last eight on a processor is not gone through here.
    fn pair(&self, read: &[Traced]) -> Of<Self::Pair, Traced> {
        (filled::<P>(read), Traced::from(1.0))
    }
}

/// Columns of rows that do not change, in blocks of eight neighbours, number by number.
#[derive(Clone, Debug)]
pub struct Rows {
    /// The first block of each row.
    pub first: &'static str,
    /// The number of neighbours of each row.
    pub count: &'static str,
    /// The neighbours.
    pub neighbors: &'static str,
    /// What is known of pairs.
    pub numbers: &'static str,
    /// Where each number of a pair stands among those of a block; of those that are zero in all pairs nothing is there.
    pub kept: Vec<Option<usize>>,
}

/// What a term of a fold is made of: the pair of two particles, what each of them shows, and their slots.
pub struct Meeting<'a, P: Record> {
    /// The pair.
    pub pair: Of<P, Traced>,
    /// Columns of the particle in the middle.
    pub me: &'a [Traced],
    /// Columns of its neighbour.
    pub other: &'a [Traced],
    /// Their slots.
    pub slots: [Traced; 2],
}

/// A pass over neighbours, put together term by term.
pub struct Gather<'a, R: Record, M> {
    meets: &'a M,
    text: Loop,
    sums: PhantomData<R>,
}

fn names<R: Record>(prefix: &str) -> Vec<String> {
    let mut names = Vec::new();
    R::names(prefix, &mut names);
    names
}

impl<'a, R: Record, M: Meets> Gather<'a, R, M> {
    /// A pass without terms.
    pub fn new(
        dialect: impl Into<Dialect>,
        name: &'static str,
        meets: &'a M,
        over: Among,
        order: Order,
    ) -> Self {
        let sums = [names::<R>("s"), names::<R>("d")];
        let text = Loop::new(dialect.into(), name, meets.pairs(over), order, sums);
        Self { meets, text, sums: PhantomData }
    }

    /// Only particles with something above one half in a column have sums; rows of the others stay.
    #[must_use]
    pub fn only(mut self, column: &'static str) -> Self {
        self.text.only = Some(column);
        self
    }

    /// Adds a law that is summed over some neighbours. The columns make up its side, in their order.
    #[must_use]
    pub fn term<L: PairLaw<Pair = M::Pair, Sums = R>>(
        self,
        law: &L,
        columns: &[Use],
        among: Among,
    ) -> Self {
        let wide = columns.iter().map(|column| column.width).sum::<usize>();
        assert_eq!(wide, width::<L::Side>(), "columns of `{}` are a side", self.text.name);
        self.fold(columns, columns, among, |meeting, sums| {
            let [me, other] = [meeting.me, meeting.other].map(filled::<L::Side>);
            law.add(&me, &other, &meeting.pair, sums);
        })
    }

    /// Adds what a neighbour does to the sums, by a function of what both show.
    #[must_use]
    pub fn fold(
        mut self,
        mine: &[Use],
        others: &[Use],
        among: Among,
        f: impl FnOnce(&Meeting<'_, M::Pair>, &mut Of<R, Traced>),
    ) -> Self {
        let meets = self.meets;
        let term = |met: &Met<'_>| {
            let mut sums = filled::<R>(met.sums);
            let Met { me, other, slots, .. } = *met;
            f(&Meeting { pair: meets.pair(met.pair), me, other, slots }, &mut sums);
            flat::<R>(&sums)
        };
        self.text.term([mine, others], among, Box::new(term));
        self
    }

    /// What sums begin with, of columns of the particle itself, instead of zero.
    #[must_use]
    pub fn start(mut self, columns: &[Use], f: impl FnOnce(&[Traced]) -> Of<R, Traced>) -> Self {
        self.text.start(columns, Box::new(|x| flat::<R>(&f(x))));
        self
    }

    /// What is made of the sums and some columns of the particle itself, and where it is written.
    pub fn close(
        self,
        scalars: &[&'static str],
        columns: &[Use],
        writes: &[Use],
        f: impl FnOnce(&Of<R, Traced>, &[Traced]) -> Vec<Traced>,
    ) -> Pass {
        let close = Box::new(|sums: &[Traced], x: &[Traced]| f(&filled::<R>(sums), x));
        self.text.close(scalars, [columns, writes], close)
    }
}
