//! A loop over neighbours with its laws.

use std::ops::Range;

use super::{Among, Order, Rows};
use crate::dialect::Dialect;
use crate::law::{Function, Law};
use crate::pass::{Pass, Use, own};
use crate::record::Traced;
use crate::work::{self, Operations, Work};

/// The column of positions by slot.
pub(super) const POSITION: &str = "place";
/// That of positions modulo a length, in [units](Pairs::Moving::units): what pairs in single precision are made of.
pub(super) const COUNTS: &str = "spot";

/// The numbers of a row of these counts: those of all axes are read in one piece.
pub(super) const fn counted(dimension: usize) -> usize {
    dimension.next_power_of_two()
}

/// How a loop goes through neighbours.
pub enum Pairs {
    /// Those of particles that move.
    Moving {
        /// Number of dimensions.
        dimension: usize,
        /// The particles that have sums.
        over: Among,
        /// What is between two of them, of the places of both.
        separation: Box<Law>,
        /// Half of the lengths of periodic axes in m.
        halves: Vec<Option<f64>>,
        /// The lengths in m in which axes are [counted](super::Space::unit).
        units: Vec<f64>,
    },
    /// Those of rows that do not change.
    Frozen(Rows),
}

/// A loop over neighbours, of whatever sums: the part of a [`Gather`](super::Gather) that is compiled once.
pub(super) struct Loop {
    pub dialect: Dialect,
    pub name: &'static str,
    pub pairs: Pairs,
    pub order: Order,
    pub terms: Vec<Term>,
    pub start: Option<(Law, Vec<Use>)>,
    pub only: Option<&'static str>,
    /// Names of the sums, and of what a term makes of them.
    pub sums: [Vec<String>; 2],
}

/// A term of the sums.
pub(super) struct Term {
    pub law: Law,
    /// Columns of the particle and of the neighbour.
    pub mine: Vec<Use>,
    pub others: Vec<Use>,
    pub among: Among,
    /// The number of inputs of the law before those of the particle itself.
    first: usize,
}

/// The numbers of which a term is made.
pub(super) struct Met<'a> {
    /// What is known of the pair: what is between both, or the numbers of a row.
    pub pair: &'a [Traced],
    pub slots: [Traced; 2],
    pub me: &'a [Traced],
    pub other: &'a [Traced],
    pub sums: &'a [Traced],
}

/// What is added to the sums.
type OfTerm<'a> = Box<dyn FnOnce(&Met<'_>) -> Vec<Traced> + 'a>;
/// What is made of the sums and of some columns.
type OfSums<'a> = Box<dyn FnOnce(&[Traced], &[Traced]) -> Vec<Traced> + 'a>;

fn names(prefix: &str, columns: &[Use]) -> Vec<String> {
    columns.iter().flat_map(|column| column.names(prefix)).collect()
}

impl Term {
    /// Names of what both show; nothing of columns of the particle itself that its law does not take.
    pub fn shown(&self) -> [Vec<String>; 2] {
        let mine = self.mine.iter().enumerate().flat_map(|(column, of)| {
            let is_taken = self.takes(column);
            of.names("my_").into_iter().map(move |name| if is_taken { name } else { "0".into() })
        });
        [mine.collect(), names("its_", &self.others)]
    }

    /// Columns of the particle itself that its law takes.
    pub fn taken(&self) -> impl Iterator<Item = &Use> {
        let columns = self.mine.iter().enumerate().filter(|(column, _)| self.takes(*column));
        columns.map(|(_, column)| column)
    }

    fn takes(&self, column: usize) -> bool {
        let before: usize = self.mine[..column].iter().map(|column| column.width).sum();
        let numbers = self.first + before..self.first + before + self.mine[column].width;
        numbers.into_iter().any(|number| self.law.takes(number))
    }

    /// Where the numbers of a column stand among those of a neighbour.
    ///
    /// # Panics
    /// When the neighbour does not show it: that is a fault of whoever declared a difference.
    pub fn other(&self, column: &Use) -> Range<usize> {
        let place = self.others.iter().position(|other| other.is_of(column));
        let place = place.expect("a difference is one of both particles of a pair");
        let first: usize = self.others[..place].iter().map(|other| other.width).sum();
        first..first + column.width
    }

    /// Whether it adds nothing to a sum.
    pub fn passes_on(&self, sum: usize) -> bool {
        let sums = self.law.outputs.len();
        self.law.passes_on(sum, self.law.inputs.len() - sums + sum)
    }
}

impl Loop {
    pub fn new(
        dialect: Dialect,
        name: &'static str,
        pairs: Pairs,
        order: Order,
        sums: [Vec<String>; 2],
    ) -> Self {
        let (terms, start, only) = (Vec::new(), None, None);
        Self { dialect, name, pairs, order, terms, start, only, sums }
    }

    /// Names of what is known of a pair.
    pub fn pair_names(&self) -> Vec<String> {
        let axes = |of: &'static str, dimension: usize| {
            (0..dimension).map(move |axis| format!("{of}_{axis}"))
        };
        match &self.pairs {
            Pairs::Moving { dimension, .. } => axes("way", *dimension).collect(),
            Pairs::Frozen(rows) => axes("pair", rows.kept.len()).collect(),
        }
    }

    /// Adds a term of columns of a particle and of its neighbours.
    pub fn term(&mut self, [mine, others]: [&[Use]; 2], among: Among, f: OfTerm<'_>) {
        let [sums, results] = &self.sums;
        let (my, its) = (names("my_", mine), names("its_", others));
        let (pair, wide, count) = (self.pair_names(), my.len(), sums.len());
        let known = pair.len();
        let slots = vec!["slot_a".to_string(), "slot_b".to_string()];
        let inputs = [pair, slots, my, its, sums.clone()];
        let name = format!("{}_pair_{}", self.name, self.terms.len());
        let law = Law::record(name, inputs.concat(), |x| {
            let (pair, x) = x.split_at(known);
            let (slots, x) = x.split_at(2);
            let (me, x) = x.split_at(wide);
            let (other, sums) = x.split_at(x.len() - count);
            let met = Met { pair, slots: [slots[0], slots[1]], me, other, sums };
            results.iter().cloned().zip(f(&met)).collect()
        });
        let (mine, others) = (mine.to_vec(), others.to_vec());
        self.terms.push(Term { law, mine, others, among, first: known + 2 });
    }

    /// What sums begin with.
    pub fn start(&mut self, columns: &[Use], f: Function<'_>) {
        assert!(self.order != Order::Lanes, "lanes of `{}` begin with nothing", self.name);
        let law = Law::record(format!("{}_start", self.name), names("my_", columns), |x| {
            self.sums[1].iter().cloned().zip(f(x)).collect()
        });
        self.start = Some((law, columns.to_vec()));
    }

    /// The pass, with what is made of the sums and some columns.
    pub fn close(
        self,
        scalars: &[&'static str],
        [columns, writes]: [&[Use]; 2],
        f: OfSums<'_>,
    ) -> Pass {
        let (name, sums) = (self.name, &self.sums[0]);
        let outputs = names("new_", writes);
        let inputs = sums.iter().cloned().chain(scalars.iter().map(|name| name.to_string()));
        let inputs: Vec<String> = inputs.chain(names("my_", columns)).collect();
        let law = Law::record(format!("{name}_close"), inputs, |x| {
            let (sums, x) = x.split_at(sums.len());
            let results = f(sums, x);
            assert_eq!(results.len(), outputs.len(), "the pass `{name}` writes what it says");
            outputs.iter().cloned().zip(results).collect()
        });
        self.write(&law, scalars, [columns, writes])
    }

    /// What it computes and touches, with what is made of the sums and of columns, the last inputs of a law.
    pub fn work(&self, close: &Law, columns: &[Use], writes: &[Use]) -> Work {
        // Of rows the numbers of pairs are read, not the places of particles.
        let (place, of_pair) = match &self.pairs {
            Pairs::Moving { dimension, .. } => (Some(self.place(*dimension)), None),
            Pairs::Frozen(rows) => {
                (None, Some(own(rows.numbers, rows.kept.iter().flatten().count())))
            }
        };
        let (start, started) = self
            .start
            .as_ref()
            .map_or((Operations::default(), &[][..]), |(law, columns)| (law.count(), columns));
        let mut work = Work {
            operations: start + close.count(),
            of_pairs: of_pair.into_iter().collect(),
            narrow: self.dialect.layout.narrow,
            ..Work::default()
        };
        let only = self.only.map(|only| own(only, 1));
        work::join(&mut work.reads, only.iter().chain(&place).chain(started).chain(columns));
        work::join(&mut work.gathers, &place);
        work::join(&mut work.writes, writes);
        let width = |columns: &[Use]| columns.iter().map(|column| column.width).sum::<usize>();
        work.take(only.iter().chain(&place).copied());
        work.take(close.taken(close.inputs.len() - width(columns), columns));
        if let Some((law, columns)) = &self.start {
            work.take(law.taken(0, columns));
        }
        for term in &self.terms {
            work.by_neighbor.push(term.law.count());
            work.take(term.law.taken(term.first, &term.mine));
            work.take(term.law.taken(term.first + width(&term.mine), &term.others));
            work::join(&mut work.reads, &term.mine);
            work::join(&mut work.gathers, &term.others);
        }
        work
    }
}
