//! The loop over neighbours as text.
//!
//! A gather sums pair laws over neighbours in the order of the processor's: eight lanes side by side,
//! neighbour k in lane k mod 8, added by halves, or one after the other. On a GPU eight threads work on
//! a particle, elsewhere one.

use std::fmt::Write;

use piola_formulas::Number;
use piola_formulas::kernels::Kernel;
use piola_formulas::pairs::{Moving, MovingPair, Of, PairLaw, Record};

use crate::law::Law;
use crate::pass::{Arguments, At, Pass, Use, filled, flat, width};
use crate::record::Traced;
use crate::text::{Language, Precision};

/// The space in which particles move.
#[derive(Clone, Debug)]
pub struct Space<const D: usize> {
    /// The kernel.
    pub kernel: Kernel,
    /// Its smoothing length in m.
    pub smoothing_length: f64,
    /// Lengths of periodic axes in m.
    pub periods: [Option<f64>; D],
}

impl<const D: usize> Space<D> {
    /// `distance` or the shorter way round a periodic axis, between two points inside its bounds.
    pub fn shorter_way(&self, axis: usize, distance: Traced) -> Traced {
        let Some(period) = self.periods[axis] else { return distance };
        let half = Traced::from(0.5 * period);
        let down = Traced::select(half.less(distance), distance - period, distance);
        Traced::select(distance.below(-0.5 * period), distance + period, down)
    }

    /// The pair of two positions.
    fn pair(&self, here: &[Traced], there: &[Traced]) -> Moving<Traced, D> {
        let mut pair = MovingPair::<D>::zero();
        for axis in 0..D {
            let distance = self.shorter_way(axis, here[axis] - there[axis]);
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

/// What a term of a fold is made of: the pair of two particles, what each of them shows, and their slots.
pub struct Meeting<'a, const D: usize> {
    /// The pair.
    pub pair: Moving<Traced, D>,
    /// Columns of the particle in the middle.
    pub me: &'a [Traced],
    /// Columns of its neighbour.
    pub other: &'a [Traced],
    /// Their slots.
    pub slots: [Traced; 2],
}

/// A pass over neighbours, put together term by term.
pub struct Gather<'a, R: Record, const D: usize> {
    language: Language,
    name: &'static str,
    space: &'a Space<D>,
    over: Among,
    order: Order,
    terms: Vec<Term>,
    start: Option<(Law, Vec<Use>)>,
    only: Option<&'static str>,
    sums: std::marker::PhantomData<R>,
}

struct Term {
    law: Law,
    mine: Vec<Use>,
    others: Vec<Use>,
    among: Among,
}

/// Columns of positions by slot, of numbers by slot, and of who is passive by number.
const POSITION: &str = "place";
const NUMBERS: &str = "numbers";
const PASSIVE: &str = "passive";
const ENTRIES: &str = "entries";

impl Among {
    /// The columns that say where rows begin and how long they are.
    fn rows(self) -> &'static [[&'static str; 2]] {
        const ROWS: [[&str; 2]; 2] = [["first", "active"], ["passive_first", "passive_count"]];
        match self {
            Self::Active => &ROWS[..1],
            Self::Passive => &ROWS[1..],
            Self::All => &ROWS,
        }
    }

    /// What holds for the column `passive` of those that are meant.
    fn condition(self) -> &'static str {
        match self {
            Self::Active => "== 0",
            Self::Passive => "!= 0",
            Self::All => ">= 0",
        }
    }
}

fn names<R: Record>(prefix: &str) -> Vec<String> {
    let mut names = Vec::new();
    R::names(prefix, &mut names);
    names
}

impl<'a, R: Record, const D: usize> Gather<'a, R, D> {
    /// A pass without terms.
    pub fn new(
        language: Language,
        name: &'static str,
        space: &'a Space<D>,
        over: Among,
        order: Order,
    ) -> Self {
        let (terms, start, sums) = (Vec::new(), None, std::marker::PhantomData);
        Self { language, name, space, over, order, terms, start, only: None, sums }
    }

    /// Only particles with something above one half in a column have sums; rows of the others stay.
    #[must_use]
    pub fn only(mut self, column: &'static str) -> Self {
        self.only = Some(column);
        self
    }

    /// Adds a law that is summed over some neighbours. The columns make up its side, in their order.
    #[must_use]
    pub fn term<L: PairLaw<Pair = MovingPair<D>, Sums = R>>(
        self,
        law: &L,
        columns: &[Use],
        among: Among,
    ) -> Self {
        assert_eq!(numbers(columns), width::<L::Side>(), "columns of `{}` are a side", self.name);
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
        f: impl FnOnce(&Meeting<'_, D>, &mut Of<R, Traced>),
    ) -> Self {
        let (wide, count) = (numbers(mine), width::<R>());
        let axes = |of: &str| (0..D).map(|axis| format!("{of}_{axis}")).collect::<Vec<_>>();
        let of = |prefix: &str, columns: &[Use]| -> Vec<String> {
            columns.iter().flat_map(|column| column.names(prefix)).collect()
        };
        let slots = vec!["slot_a".to_string(), "slot_b".to_string()];
        let sums = names::<R>("s");
        let inputs =
            [axes("here"), axes("there"), slots, of("my_", mine), of("its_", others), sums];
        let name = format!("{}_pair_{}", self.name, self.terms.len());
        let law = Law::record(name, inputs.concat(), |x| {
            let (here, x) = x.split_at(D);
            let (there, x) = x.split_at(D);
            let (slots, x) = x.split_at(2);
            let (me, x) = x.split_at(wide);
            let (other, x) = x.split_at(x.len() - count);
            let mut sums = filled::<R>(x);
            let pair = self.space.pair(here, there);
            f(&Meeting { pair, me, other, slots: [slots[0], slots[1]] }, &mut sums);
            names::<R>("d").into_iter().zip(flat::<R>(&sums)).collect()
        });
        let (mine, others) = (mine.to_vec(), others.to_vec());
        self.terms.push(Term { law, mine, others, among });
        self
    }

    /// What sums begin with, of columns of the particle itself, instead of zero.
    #[must_use]
    pub fn start(mut self, columns: &[Use], f: impl FnOnce(&[Traced]) -> Of<R, Traced>) -> Self {
        assert!(self.order != Order::Lanes, "lanes of `{}` begin with nothing", self.name);
        let columns = columns.to_vec();
        let inputs = columns.iter().flat_map(|column| column.names("my_"));
        let law = Law::record(format!("{}_start", self.name), inputs, |x| {
            names::<R>("d").into_iter().zip(flat::<R>(&f(x))).collect()
        });
        self.start = Some((law, columns));
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
        let count = width::<R>();
        let outputs: Vec<String> = writes.iter().flat_map(|write| write.names("new_")).collect();
        let inputs = names::<R>("s").into_iter().chain(scalars.iter().map(|name| name.to_string()));
        let inputs = inputs.chain(columns.iter().flat_map(|column| column.names("my_")));
        let inputs: Vec<String> = inputs.collect();
        let law = Law::record(format!("{}_close", self.name), inputs, |x| {
            let (sums, x) = x.split_at(count);
            let results = f(&filled::<R>(sums), x);
            assert_eq!(
                results.len(),
                outputs.len(),
                "the pass `{}` writes what it says",
                self.name
            );
            outputs.iter().cloned().zip(results).collect()
        });
        self.write(&law, scalars, columns, writes)
    }

    fn write(self, close: &Law, scalars: &[&'static str], columns: &[Use], writes: &[Use]) -> Pass {
        let (language, is_gpu) = (self.language, self.has_lanes());
        let mut arguments = Arguments::default();
        scalars.iter().for_each(|name| arguments.scalar(name));
        [NUMBERS, PASSIVE, ENTRIES].iter().for_each(|name| arguments.indices(name));
        for term in &self.terms {
            term.among.rows().iter().flatten().for_each(|name| arguments.indices(name));
        }
        arguments.numbers(POSITION, true);
        let started = self.start.iter().flat_map(|(_, columns)| columns);
        let mine = self.terms.iter().flat_map(|term| &term.mine).chain(started).chain(columns);
        let others = self.terms.iter().flat_map(|term| &term.others);
        for column in mine.chain(others) {
            if let At::Through(index) = column.at {
                arguments.indices(index);
            }
            arguments.numbers(column.column, true);
        }
        self.only.iter().for_each(|only| arguments.numbers(only, true));
        writes.iter().for_each(|write| arguments.numbers(write.column, false));

        let mut text = String::new();
        let laws = self.terms.iter().map(|term| &term.law);
        let laws = laws.chain(self.start.iter().map(|(law, _)| law)).chain([close]);
        laws.for_each(|law| text += &law.text(language, Precision::Double));
        let name = self.name;
        let _ = writeln!(text, "KERNEL void {name}({})\n{{", arguments.text(language));
        let wanted = self.over.condition();
        let wanted = match self.only {
            Some(only) => format!("{wanted} && {only}[a] > 0.5"),
            None => wanted.to_string(),
        };
        text += &match is_gpu {
            true => format!(
                "    const int thread = blockIdx.x * blockDim.x + threadIdx.x;\n    \
                 const int lane = thread % 8;\n    \
                 const unsigned group = 0xffu << (threadIdx.x & 24);\n    \
                 const int a = thread / 8 < n ? thread / 8 : 0;\n    \
                 const int is_on = thread / 8 < n && passive[numbers[a]] {wanted};\n    {{\n"
            ),
            false => format!("    EACH(a, n) if (passive[numbers[a]] {wanted}) {{\n"),
        };
        for axis in 0..D {
            let _ = writeln!(text, "    const real here_{axis} = {POSITION}[a * {D} + {axis}];");
        }
        let mut mine: Vec<Use> = Vec::new();
        let started = self.start.iter().flat_map(|(_, columns)| columns);
        let of_terms = self.terms.iter().flat_map(|term| &term.mine);
        for column in of_terms.chain(started).chain(columns) {
            if !mine.contains(column) {
                mine.push(*column);
                load(&mut text, "    ", column, "my_", "a");
            }
        }
        let sums = names::<R>("s");
        let is_laned = self.order == Order::Lanes && !is_gpu;
        for sum in &sums {
            let _ = match is_laned {
                true => writeln!(text, "    real l{sum}[8] = {{0, 0, 0, 0, 0, 0, 0, 0}};"),
                false => writeln!(text, "    real {sum} = 0;"),
            };
        }
        if let Some((law, columns)) = &self.start {
            let inputs = columns.iter().flat_map(|column| column.names("my_"));
            let pointers = sums.iter().map(|sum| format!("&{sum}"));
            let _ = writeln!(text, "    {}({});", law.name, join(inputs.chain(pointers)));
        }
        for term in &self.terms {
            for rows in term.among.rows() {
                self.write_term(term, *rows, &sums, &mut text);
            }
        }
        for sum in &sums {
            let _ = match (is_laned, self.order) {
                (true, _) => writeln!(
                    text,
                    "    const real {sum} = ((l{sum}[0] + l{sum}[4]) + (l{sum}[2] + l{sum}[6])) + \
                     ((l{sum}[1] + l{sum}[5]) + (l{sum}[3] + l{sum}[7]));"
                ),
                (false, Order::Lanes) => writeln!(
                    text,
                    "    {sum} += __shfl_down_sync(group, {sum}, 4, 8);\n    \
                     {sum} += __shfl_down_sync(group, {sum}, 2, 8);\n    \
                     {sum} += __shfl_down_sync(group, {sum}, 1, 8);"
                ),
                (false, Order::Single | Order::Fold) => Ok(()),
            };
        }
        if is_gpu {
            text += "    if (!is_on || lane > 0) return;\n";
        }
        let outputs: Vec<String> = writes.iter().flat_map(|write| write.names("new_")).collect();
        let inputs = sums.iter().cloned().chain(scalars.iter().map(|name| name.to_string()));
        let inputs = inputs.chain(columns.iter().flat_map(|column| column.names("my_")));
        let pointers = outputs.iter().map(|name| format!("&{name}"));
        let _ = writeln!(
            text,
            "    real {};\n    {}({});",
            outputs.join(", "),
            close.name,
            join(inputs.chain(pointers))
        );
        for write in writes {
            for (i, number) in write.names("new_").iter().enumerate() {
                let (column, width) = (write.column, write.width);
                let _ = writeln!(text, "    {column}[a * {width} + {i}] = {number};");
            }
        }
        text += "    }\n}\n";
        Pass { name, text, asks: arguments.asks, threads: if is_gpu { 8 } else { 1 } }
    }

    /// Whether eight threads work on a particle.
    fn has_lanes(&self) -> bool {
        self.language == Language::Cuda && self.order != Order::Fold
    }

    fn write_term(
        &self,
        term: &Term,
        [first, count]: [&str; 2],
        sums: &[String],
        text: &mut String,
    ) {
        let is_gpu = self.has_lanes();
        let _ = match (is_gpu, self.order) {
            (true, Order::Lanes) => writeln!(
                text,
                "    for (unsigned k = lane, end = is_on ? {count}[a] : 0, next = k < end ? \
                 {ENTRIES}[{first}[a] + k] : 0; k < end; k += 8) {{"
            ),
            (true, Order::Single) => writeln!(
                text,
                "    for (unsigned row = 0, end = is_on ? {count}[a] : 0; row < end; row += 8) {{\n        \
                 const unsigned k = row + lane < end ? row + lane : row;"
            ),
            (_, _) => {
                writeln!(text, "    for (unsigned k = 0, end = {count}[a]; k < end; ++k) {{")
            }
        };
        let _ = match (is_gpu, self.order) {
            // The place of the next neighbour is read ahead: what is read of it waits for nothing else.
            (true, Order::Lanes) => writeln!(
                text,
                "        const unsigned b = next;\n        \
                 next = k + 8 < end ? {ENTRIES}[{first}[a] + k + 8] : 0;"
            ),
            _ => writeln!(text, "        const unsigned b = {ENTRIES}[{first}[a] + k];"),
        };
        for axis in 0..D {
            let _ =
                writeln!(text, "        const real there_{axis} = {POSITION}[b * {D} + {axis}];");
        }
        for column in &term.others {
            load(text, "        ", column, "its_", "b");
        }
        let axes = |of: &str| (0..D).map(|axis| format!("{of}_{axis}")).collect::<Vec<_>>();
        let of = |prefix: &str, columns: &[Use]| -> Vec<String> {
            columns.iter().flat_map(|column| column.names(prefix)).collect()
        };
        let slots = vec!["(real)a".to_string(), "(real)b".to_string()];
        let (mine, others) = (of("my_", &term.mine), of("its_", &term.others));
        let is_single = is_gpu && self.order == Order::Single;
        let kept: Vec<String> = match (is_gpu, self.order) {
            (false, Order::Lanes) => sums.iter().map(|sum| format!("l{sum}[k % 8]")).collect(),
            _ if is_single => sums.iter().map(|_| "0".into()).collect(),
            _ => sums.to_vec(),
        };
        let given: Vec<String> = match is_single {
            true => sums.iter().map(|sum| format!("t{sum}")).collect(),
            false => kept.clone(),
        };
        if is_single {
            let _ = writeln!(text, "        real {};", given.join(", "));
        }
        let inputs = [axes("here"), axes("there"), slots, mine, others, kept].concat();
        let pointers = given.iter().map(|sum| format!("&{sum}"));
        let call = join(inputs.into_iter().chain(pointers));
        let _ = writeln!(text, "        {}({call});", term.law.name);
        if is_single {
            text.push_str("        for (int j = 0; j < 8; ++j) {\n");
            for (sum, term) in sums.iter().zip(&given) {
                let _ = writeln!(
                    text,
                    "            {{ const real t = __shfl_sync(group, {term}, j, 8); \
                     if (row + j < end) {sum} += t; }}"
                );
            }
            text.push_str("        }\n");
        }
        text.push_str("    }\n");
    }
}

fn join(all: impl Iterator<Item = String>) -> String {
    all.collect::<Vec<_>>().join(", ")
}

/// Numbers of some columns.
fn numbers(columns: &[Use]) -> usize {
    columns.iter().map(|column| column.width).sum()
}

/// Loads a row of a column, by pairs of numbers where rows are whole pairs.
fn load(text: &mut String, indent: &str, column: &Use, prefix: &str, row: &str) {
    let (name, width) = (column.column, column.width);
    let row = match column.at {
        At::Through(index) => format!("{index}[{row}]"),
        At::Own | At::Spread => row.to_string(),
    };
    let numbers = column.names(prefix);
    if width % 2 == 1 {
        for (i, number) in numbers.iter().enumerate() {
            let _ = writeln!(text, "{indent}const real {number} = {name}[{row} * {width} + {i}];");
        }
        return;
    }
    for (pair, numbers) in numbers.chunks(2).enumerate() {
        let both = format!("{prefix}{name}_pair_{pair}");
        let _ = writeln!(
            text,
            "{indent}const Pair {both} = ((GLOBAL const Pair *){name})[{row} * {} + {pair}];\n\
             {indent}const real {} = {both}.x, {} = {both}.y;",
            width / 2,
            numbers[0],
            numbers[1]
        );
    }
}
