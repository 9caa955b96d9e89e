//! Passes over particles as text: what they read and write, and the law between.

use std::cell::{Cell, RefCell};
use std::fmt::Write;

use piola_formulas::pairs::{Of, Record};

use crate::dialect::Dialect;
use crate::law::{Function, Law};
use crate::record::Traced;
use crate::text::{Language, Precision};
use crate::work::{self, Work};

/// What a kernel is called with, in the order of its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// The number of rows.
    Rows,
    /// A number that is known at the start only, by its name.
    Scalar(&'static str),
    /// A column of numbers.
    Numbers(&'static str),
    /// A column of numbers in single precision.
    Singles(&'static str),
    /// A column of indices.
    Indices(&'static str),
    /// The number of rows of a column in planes, which have this many numbers.
    Height(&'static str, usize),
}

/// A kernel as text, and how it is started.
#[derive(Clone, Debug)]
pub struct Pass {
    /// The name of its kernel.
    pub name: &'static str,
    /// Laws and kernel, to stand behind the [prologue](Language::prologue).
    pub text: String,
    /// What it is called with.
    pub asks: Vec<Ask>,
    /// Threads a row.
    pub threads: usize,
    /// What it computes and touches.
    pub work: Work,
}

/// How a pass finds its row of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// The row of the same number.
    Own,
    /// The row that an index column names.
    Through(&'static str),
    /// The row of the same number, where all numbers of one component stand side by side.
    Spread,
}

/// A column that a pass reads or writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// Its name.
    pub column: &'static str,
    /// Numbers a row.
    pub width: usize,
    /// Its row.
    pub at: At,
    /// Whether laws of pairs take differences of it only.
    pub is_difference: bool,
    /// Whether its bits are those of whole numbers modulo `2^32`: the nearest to those that are written.
    pub is_counted: bool,
}

impl Use {
    const fn of(column: &'static str, width: usize, at: At) -> Self {
        Self { column, width, at, is_difference: false, is_counted: false }
    }
}

/// The row of the same number of a column.
pub const fn own(column: &'static str, width: usize) -> Use {
    Use::of(column, width, At::Own)
}

/// The row of a column that an index column names.
pub const fn through(index: &'static str, column: &'static str, width: usize) -> Use {
    Use::of(column, width, At::Through(index))
}

/// The row of the same number of a column whose components stand apart.
pub const fn spread(column: &'static str, width: usize) -> Use {
    Use::of(column, width, At::Spread)
}

/// The row of the same number of a column of which a law of pairs takes the difference between a neighbour and the particle
/// itself, and nothing else: where laws are in single precision, the difference is not.
pub const fn difference(column: &'static str, width: usize) -> Use {
    Use { is_difference: true, ..own(column, width) }
}

/// The row of the same number of a column in single precision, the bits of which are whole numbers modulo `2^32`: the nearest
/// to those that are written. Differences of such numbers are exact.
pub(crate) const fn counts(column: &'static str, width: usize) -> Use {
    Use { is_counted: true, ..own(column, width) }
}

impl Use {
    /// Whether both are the same numbers.
    pub(crate) fn is_of(&self, other: &Self) -> bool {
        (self.column, self.at) == (other.column, other.at)
    }

    /// Names of the numbers in the text.
    pub(crate) fn names(&self, prefix: &str) -> Vec<String> {
        (0..self.width).map(|i| format!("{prefix}{}_{i}", self.column)).collect()
    }

    /// Where number i of its row stands.
    pub(crate) fn place(&self, dialect: Dialect, i: usize) -> String {
        match self.at {
            At::Own => dialect.element(self.column, self.width, "a", i),
            At::Through(index) => {
                dialect.element(self.column, self.width, &format!("{index}_of_a"), i)
            }
            At::Spread => format!("{}[{i} * n + a]", self.column),
        }
    }

    /// Writes the numbers of this prefix to its row.
    pub(crate) fn write(&self, dialect: Dialect, prefix: &str, indent: &str, text: &mut String) {
        for (i, number) in self.names(prefix).iter().enumerate() {
            let place = self.place(dialect, i);
            let _ = match self.is_counted {
                true => writeln!(text, "{indent}{place} = p_counts({number});"),
                false => writeln!(text, "{indent}{place} = {number};"),
            };
        }
    }
}

/// The number of numbers of a record.
pub(crate) fn width<R: Record>() -> usize {
    let mut names = Vec::new();
    R::names("", &mut names);
    names.len()
}

/// A record of these numbers.
pub fn filled<R: Record>(numbers: &[Traced]) -> Of<R, Traced> {
    let next = Cell::new(0);
    R::map([&R::zero::<f64>()], &|[_]: [f64; 1]| numbers[next.replace(next.get() + 1)])
}

/// The numbers of a record.
pub fn flat<R: Record>(record: &Of<R, Traced>) -> Vec<Traced> {
    let all = RefCell::new(Vec::new());
    R::map([record], &|[number]: [Traced; 1]| {
        all.borrow_mut().push(number);
        number
    });
    all.into_inner()
}

/// A pass that looks at no neighbours: `law` takes the scalars, then the numbers of all columns that are
/// read, and gives those of all that are written.
pub fn local(
    dialect: impl Into<Dialect>,
    name: &'static str,
    scalars: &[&'static str],
    reads: &[Use],
    writes: &[Use],
    law: impl FnOnce(&[Traced]) -> Vec<Traced>,
) -> Pass {
    local_boxed(dialect.into(), name, scalars, [reads, writes], Box::new(law))
}

/// As [`local`], compiled once.
fn local_boxed(
    dialect: Dialect,
    name: &'static str,
    scalars: &[&'static str],
    [reads, writes]: [&[Use]; 2],
    law: Function<'_>,
) -> Pass {
    let inputs = scalars.iter().map(|name| name.to_string());
    let inputs: Vec<String> = inputs.chain(reads.iter().flat_map(|read| read.names(""))).collect();
    let outputs: Vec<String> = writes.iter().flat_map(|write| write.names("new_")).collect();
    let law = Law::record(format!("{name}_law"), inputs.clone(), |x| {
        let results = law(x);
        assert_eq!(results.len(), outputs.len(), "the pass `{name}` writes what it says");
        outputs.iter().cloned().zip(results).collect()
    });
    let mut arguments = Arguments::new(dialect);
    scalars.iter().for_each(|name| arguments.scalar(name));
    for column in reads.iter().chain(writes) {
        if let At::Through(index) = column.at {
            arguments.indices(index);
        }
    }
    reads.iter().for_each(|read| arguments.numbers(read, true));
    writes.iter().for_each(|write| arguments.numbers(write, false));
    let mut text = law.text(dialect.language, Precision::Double);
    let _ = writeln!(text, "KERNEL void {name}({})\n{{\n    EACH(a, n) {{", arguments.text());
    for index in arguments.asks.iter().filter_map(|ask| match ask {
        Ask::Indices(index) => Some(index),
        _ => None,
    }) {
        let _ = writeln!(text, "        const unsigned {index}_of_a = {index}[a];");
    }
    for read in reads {
        for (i, number) in read.names("").iter().enumerate() {
            let _ = writeln!(text, "        const real {number} = {};", read.place(dialect, i));
        }
    }
    let pointers = outputs.iter().map(|name| format!("&{name}"));
    let _ = writeln!(
        text,
        "        real {};\n        {}({});",
        outputs.join(", "),
        law.name,
        inputs.into_iter().chain(pointers).collect::<Vec<_>>().join(", ")
    );
    writes.iter().for_each(|write| write.write(dialect, "new_", "        ", &mut text));
    text += "    }\n}\n";
    let narrow = dialect.layout.narrow;
    let mut work = Work { operations: law.count(), narrow, ..Work::default() };
    work::join(&mut work.reads, reads);
    work::join(&mut work.writes, writes);
    work.take(law.taken(scalars.len(), reads));
    Pass { name, text, asks: arguments.asks, threads: 1, work }
}

/// Parameters of a kernel, each once. The first is the number of rows `n`.
pub(crate) struct Arguments {
    dialect: Dialect,
    pub asks: Vec<Ask>,
    text: Vec<(Ask, bool)>,
}

impl Arguments {
    pub fn new(dialect: Dialect) -> Self {
        Self { dialect, asks: vec![Ask::Rows], text: vec![(Ask::Rows, true)] }
    }

    pub fn scalar(&mut self, name: &'static str) {
        self.add(Ask::Scalar(name), true);
    }

    pub fn indices(&mut self, name: &'static str) {
        self.add(Ask::Indices(name), true);
    }

    /// A column that is written is not constant, though it is read, too.
    pub fn numbers(&mut self, column: &Use, is_constant: bool) {
        let name = column.column;
        if self.dialect.is_in_planes(name) {
            self.add(Ask::Height(name, column.width), true);
        }
        let ask = match self.dialect.is_narrow(name) {
            true => Ask::Singles(name),
            false => Ask::Numbers(name),
        };
        self.add(ask, is_constant);
    }

    fn add(&mut self, ask: Ask, is_constant: bool) {
        match self.text.iter_mut().find(|(known, _)| *known == ask) {
            Some((_, known)) => *known &= is_constant,
            None => {
                self.asks.push(ask);
                self.text.push((ask, is_constant));
            }
        }
    }

    pub fn text(&self) -> String {
        let is_cuda = self.dialect.language == Language::Cuda;
        let restrict = if is_cuda { "__restrict__ " } else { "" };
        let parameter = |(ask, is_constant): &(Ask, bool)| match *ask {
            Ask::Rows => "const int n".to_string(),
            Ask::Scalar(name) => format!("const real {name}"),
            Ask::Numbers(name) | Ask::Singles(name) => {
                let (real, constant) = (self.dialect.token(name), ["", "const "]);
                let constant = constant[usize::from(*is_constant)];
                format!("GLOBAL {constant}{real} *{restrict}{name}")
            }
            Ask::Indices(name) => format!("GLOBAL const unsigned *{restrict}{name}"),
            Ask::Height(name, _) => format!("const int {name}_rows"),
        };
        self.text.iter().map(parameter).collect::<Vec<_>>().join(", ")
    }
}
