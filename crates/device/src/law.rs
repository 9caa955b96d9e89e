//! A recorded law.

use piola_formulas::Number;

use crate::pass::Use;
use crate::record::{Binary, Operation, Tape, Traced, Unary, recorded};
use crate::work::Operations;

/// What makes results of numbers, once.
pub(crate) type Function<'a, Y = Vec<Traced>> = Box<dyn FnOnce(&[Traced]) -> Y + 'a>;

/// Results of a law with their names.
pub type Outputs<T> = Vec<(String, T)>;

/// A function of some numbers as the list of its operations, none of them done twice or for nothing.
#[derive(Clone, Debug)]
pub struct Law {
    /// Its name, which the text has, too.
    pub name: String,
    /// Names of what it takes.
    pub inputs: Vec<String>,
    /// Names of what it gives.
    pub outputs: Vec<String>,
    pub(crate) tape: Tape,
    /// Places of the results.
    pub(crate) results: Vec<u32>,
    /// Which operations are needed.
    pub(crate) needed: Vec<bool>,
    /// The loop that an operation belongs to.
    pub(crate) inside: Vec<Option<u32>>,
}

impl Law {
    /// Records a function, which is called once, with numbers of these names.
    pub fn record(
        name: impl Into<String>,
        inputs: impl IntoIterator<Item = impl Into<String>>,
        function: impl FnOnce(&[Traced]) -> Outputs<Traced>,
    ) -> Self {
        let inputs = inputs.into_iter().map(Into::into).collect();
        Self::record_boxed(name.into(), inputs, Box::new(function))
    }

    fn record_boxed(
        name: String,
        inputs: Vec<String>,
        function: Function<'_, Outputs<Traced>>,
    ) -> Self {
        let (results, tape) = recorded(|| {
            let numbers: Vec<Traced> = (0..inputs.len()).map(Traced::input).collect();
            function(&numbers)
        });
        let (outputs, results): (Vec<_>, Vec<_>) =
            results.into_iter().map(|(name, number)| (name, number.0)).unzip();
        let needed = needed(&tape, &results);
        let inside = inside(&tape);
        Self { name, inputs, outputs, tape, results, needed, inside }
    }

    /// Places of the operations that are needed, in order.
    pub(crate) fn places(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.needed.len() as u32).filter(|place| self.needed[*place as usize])
    }

    /// Its operations by kind, without inputs and constants; those of a loop count once.
    pub fn count(&self) -> Operations {
        let mut count = Operations::default();
        for place in self.places() {
            let kind = match self.tape.operations[place as usize] {
                Operation::Input(_)
                | Operation::Constant(_)
                | Operation::State(..)
                | Operation::Final(..) => continue,
                Operation::Binary(Binary::Add | Binary::Subtract, ..) => &mut count.sums,
                Operation::Binary(Binary::Multiply, ..) => &mut count.products,
                Operation::Binary(Binary::Divide, ..) => &mut count.quotients,
                Operation::Unary(Unary::Sqrt, _) => &mut count.roots,
                Operation::Unary(Unary::Negate | Unary::Abs, _)
                | Operation::Less(..)
                | Operation::AtMost(..)
                | Operation::And(..)
                | Operation::Or(..)
                | Operation::Not(_)
                | Operation::Select(..) => &mut count.choices,
                Operation::Unary(..) | Operation::Binary(Binary::Power | Binary::Atan2, ..) => {
                    &mut count.functions
                }
            };
            *kind += 1;
        }
        count
    }

    /// Number of operations, without inputs and constants; those of a loop count once.
    pub fn operations(&self) -> usize {
        self.count().all()
    }

    /// Whether results depend on an input.
    pub(crate) fn takes(&self, input: usize) -> bool {
        let is = |place| self.tape.operations[place as usize] == Operation::Input(input as u32);
        self.places().any(is)
    }

    /// What of some columns it takes, whose numbers are its inputs from the `first` on.
    pub(crate) fn taken(&self, first: usize, columns: &[Use]) -> Vec<Use> {
        let mut next = first;
        let of = |column: &Use| {
            let own = next..next + column.width;
            next = own.end;
            Use { width: own.filter(|&input| self.takes(input)).count(), ..*column }
        };
        columns.iter().map(of).collect()
    }

    /// Whether a result is an input as it came.
    pub(crate) fn passes_on(&self, result: usize, input: usize) -> bool {
        let place = self.results[result] as usize;
        self.tape.operations[place] == Operation::Input(input as u32)
    }

    /// The law of some numbers: each operation by that of the number type.
    ///
    /// # Panics
    /// When there are fewer numbers than the law takes.
    pub fn run<T: Number<Mask = bool>>(&self, inputs: &[T]) -> Vec<T> {
        assert!(inputs.len() >= self.inputs.len(), "the law `{}` takes more numbers", self.name);
        let size = self.tape.operations.len();
        let mut machine = Machine {
            law: self,
            inputs,
            values: vec![T::zero(); size],
            truths: vec![false; size],
            states: self.tape.loops.iter().map(|l| vec![T::zero(); l.start.len()]).collect(),
            done: vec![false; self.tape.loops.len()],
        };
        for place in self.places().filter(|place| self.inside[*place as usize].is_none()) {
            machine.execute(place);
        }
        self.results.iter().map(|place| machine.values[*place as usize]).collect()
    }
}

/// Which operations results depend on, through loops, too.
fn needed(tape: &Tape, results: &[u32]) -> Vec<bool> {
    let mut needed = vec![false; tape.operations.len()];
    let mut rest = results.to_vec();
    while let Some(place) = rest.pop() {
        if std::mem::replace(&mut needed[place as usize], true) {
            continue;
        }
        let operation = tape.operations[place as usize];
        rest.extend(operation.operands());
        if let Operation::Final(number, _) = operation {
            let body = &tape.loops[number as usize];
            rest.extend(body.start.iter().chain(&body.next).chain([&body.until]));
        }
    }
    needed
}

/// The loop whose state an operation depends on. Loops within loops are not recorded by any law.
fn inside(tape: &Tape) -> Vec<Option<u32>> {
    let mut inside: Vec<Option<u32>> = Vec::with_capacity(tape.operations.len());
    for operation in &tape.operations {
        let own = match operation {
            Operation::State(number, _) => Some(*number),
            _ => operation.operands().find_map(|place| inside[place as usize]),
        };
        inside.push(own);
    }
    inside
}

/// A law at work.
struct Machine<'a, T> {
    law: &'a Law,
    inputs: &'a [T],
    values: Vec<T>,
    truths: Vec<bool>,
    states: Vec<Vec<T>>,
    done: Vec<bool>,
}

impl<T: Number<Mask = bool>> Machine<'_, T> {
    fn execute(&mut self, place: u32) {
        let value = |at: u32| self.values[at as usize];
        let truth = |at: u32| self.truths[at as usize];
        let result = match self.law.tape.operations[place as usize] {
            Operation::Input(number) => self.inputs[number as usize],
            Operation::Constant(bits) => T::from(f64::from_bits(bits)),
            Operation::Unary(function, a) => unary(function, value(a)),
            Operation::Binary(function, a, b) => match function {
                Binary::Add => value(a) + value(b),
                Binary::Subtract => value(a) - value(b),
                Binary::Multiply => value(a) * value(b),
                Binary::Divide => value(a) / value(b),
                Binary::Power => match self.law.tape.operations[b as usize] {
                    Operation::Constant(bits) => value(a).powf(f64::from_bits(bits)),
                    _ => unreachable!("exponents are recorded as constants"),
                },
                Binary::Atan2 => value(a).atan2(value(b)),
            },
            Operation::Select(mask, yes, no) => T::select(truth(mask), value(yes), value(no)),
            Operation::State(number, i) => self.states[number as usize][i as usize],
            Operation::Final(number, i) => {
                self.finish(number);
                self.states[number as usize][i as usize]
            }
            Operation::Less(a, b) => return self.truths[place as usize] = value(a).less(value(b)),
            Operation::AtMost(a, b) => {
                return self.truths[place as usize] = value(a).at_most(value(b));
            }
            Operation::And(a, b) => return self.truths[place as usize] = truth(a) & truth(b),
            Operation::Or(a, b) => return self.truths[place as usize] = truth(a) | truth(b),
            Operation::Not(a) => return self.truths[place as usize] = !truth(a),
        };
        self.values[place as usize] = result;
    }

    /// Runs a loop, unless it has run.
    fn finish(&mut self, number: u32) {
        if std::mem::replace(&mut self.done[number as usize], true) {
            return;
        }
        let law = self.law;
        let body = &law.tape.loops[number as usize];
        self.states[number as usize] =
            body.start.iter().map(|place| self.values[*place as usize]).collect();
        let places: Vec<u32> =
            law.places().filter(|place| law.inside[*place as usize] == Some(number)).collect();
        for _ in 0..body.most {
            places.iter().for_each(|place| self.execute(*place));
            if self.truths[body.until as usize] {
                break;
            }
            self.states[number as usize] =
                body.next.iter().map(|place| self.values[*place as usize]).collect();
        }
    }
}

fn unary<T: Number>(function: Unary, x: T) -> T {
    match function {
        Unary::Negate => -x,
        Unary::Abs => x.abs(),
        Unary::Sqrt => x.sqrt(),
        Unary::Exp => x.exp(),
        Unary::ExpM1 => x.exp_m1(),
        Unary::Ln => x.ln(),
        Unary::Ln1p => x.ln_1p(),
        Unary::Sin => x.sin(),
        Unary::Cos => x.cos(),
        Unary::TwoTo | Unary::Exponent | Unary::Mantissa => {
            unreachable!("only the functions of the prologue take numbers apart")
        }
    }
}
