//! Python functions of place and time, as loads, boundary values and initial fields.
//!
//! A run asks for values from many threads, each of which takes the GIL for a call. What was asked before is
//! remembered where that can be of use: a function without t by place, one without coordinates by time.

use std::cell::Cell;
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, Once, PoisonError, RwLock};
use std::thread;

use piola::boundaries::SpaceTime;
use piola::case::{Arrays, Clouds, Functions};
use piola::geometry::PointCloud;
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rayon::{ThreadBuilder, ThreadPoolBuilder};

use crate::simulation::inside;

/// What a function may be of, in the order of a place and a time.
const VARIABLES: [&str; 4] = ["x", "y", "z", "t"];
/// The position of t among them.
const TIME: usize = 3;
/// Values of a function that are remembered. Beyond, all are forgotten.
const REMEMBERED: usize = 1 << 20;
/// The step of the difference by time, as a share of the length of the run.
const STEP: f64 = 1e-6;

thread_local! {
    /// Whether this thread calls a function for a run.
    static IS_CALLING: Cell<bool> = const { Cell::new(false) };
}

/// Refuses what cannot be done by a function that a run waits for, with the threads that it would take.
pub fn refuse_inside() -> PyResult<()> {
    match IS_CALLING.get() {
        false => Ok(()),
        true => Err(PyRuntimeError::new_err(
            "a load, boundary value or initial field can neither access a simulation nor start \
             one: its own is waiting for the value",
        )),
    }
}

/// Makes the threads of all loops over particles, such as Python knows from their start: to be made known for each call
/// takes several times as long as the call. Not to be called with the GIL in hand, for which they wait.
pub fn make_threads() {
    static MADE: Once = Once::new();
    MADE.call_once(|| {
        let spawn = |worker: ThreadBuilder| {
            let work = || Python::attach(|py| py.detach(|| worker.run()));
            thread::Builder::new().spawn(work).map(|_| ())
        };
        // Where there are threads already, calls take longer.
        let _ = ThreadPoolBuilder::new().spawn_handler(spawn).build_global();
    });
}

/// What the functions of one run share.
#[derive(Default)]
pub struct Shared {
    /// Whether one has raised.
    has_raised: AtomicBool,
    /// What the first one raised.
    raised: Mutex<Option<PyErr>>,
    /// How long the run is in s, as bits.
    end: AtomicU64,
}

impl Shared {
    /// Tells how long the run is in s.
    pub fn set_end(&self, end: f64) {
        self.end.store(end.to_bits(), Ordering::SeqCst);
    }

    pub fn has_raised(&self) -> bool {
        self.has_raised.load(Ordering::SeqCst)
    }

    /// What a function has raised since this was asked.
    pub fn take(&self) -> Option<PyErr> {
        self.has_raised.store(false, Ordering::SeqCst);
        inside(&self.raised).take()
    }

    /// Raises what a function has raised.
    pub fn sound(&self) -> PyResult<()> {
        self.take().map_or(Ok(()), Err)
    }

    fn keep(&self, error: PyErr) {
        inside(&self.raised).get_or_insert(error);
        self.has_raised.store(true, Ordering::SeqCst);
    }
}

/// The functions, clouds and arrays of a case, in the order in which they came.
#[derive(Default)]
pub struct Registry {
    functions: Vec<Arc<Given>>,
    pub clouds: Clouds,
    pub arrays: Arrays,
}

/// A function as it was given.
struct Given {
    name: String,
    /// The variables that it takes, in its order.
    takes: Vec<usize>,
    function: Py<PyAny>,
}

impl Registry {
    /// Takes a function in, and returns what stands for it in the text of the case.
    ///
    /// # Errors
    /// It takes something else than a place and a time.
    pub fn add(&mut self, function: &Bound<'_, PyAny>) -> PyResult<String> {
        let py = function.py();
        let signature = py.import("inspect")?.call_method1("signature", (function,))?;
        let parameters = signature.getattr("parameters")?;
        let mut takes = Vec::new();
        for name in parameters.try_iter()? {
            let name: String = name?.extract()?;
            let Some(variable) = VARIABLES.iter().position(|known| *known == name) else {
                let message = format!(
                    "a function in a case takes some of x, y, z (in m) and t (in s), by these names, not `{name}`"
                );
                return Err(PyTypeError::new_err(message));
            };
            takes.push(variable);
        }
        let name = function.getattr_opt("__name__")?.and_then(|name| name.extract::<String>().ok());
        let name = name.unwrap_or_else(|| "function".to_owned());
        let plain: String = name.chars().filter(|c| c.is_alphanumeric() || *c == '_').collect();
        let name = format!("{plain}_{}", self.functions.len());
        let text = format!("@{name}");
        self.functions.push(Arc::new(Given { name, takes, function: function.clone().unbind() }));
        Ok(text)
    }

    /// The functions as one run has them: what they raise there, and the values that they are remembered to have, are
    /// nothing to other runs of the case.
    pub fn for_a_run(&self) -> (Functions, Arc<Shared>) {
        let (mut functions, shared) = (Functions::default(), Arc::<Shared>::default());
        for given in &self.functions {
            let function = Function {
                given: Arc::clone(given),
                shared: Arc::clone(&shared),
                known: RwLock::default(),
            };
            functions.insert(given.name.as_str(), Arc::new(function));
        }
        (functions, shared)
    }

    /// Takes points in, and returns what stands for them.
    pub fn add_cloud(&mut self, cloud: &Arc<PointCloud>) -> String {
        format!("@{}", self.clouds.add(cloud))
    }

    /// Takes a value for each particle in, and returns what stands for them.
    pub fn add_array(&mut self, values: Vec<f64>) -> String {
        format!("@{}", self.arrays.add(&values.into()))
    }
}

struct Function {
    given: Arc<Given>,
    shared: Arc<Shared>,
    /// Values by the bits of what they are of.
    known: RwLock<HashMap<[u64; 4], f64>>,
}

impl Function {
    fn takes_place(&self) -> bool {
        self.given.takes.iter().any(|variable| *variable != TIME)
    }

    fn takes_time(&self) -> bool {
        self.given.takes.contains(&TIME)
    }

    /// Calls it.
    fn call(&self, variables: [f64; 4]) -> PyResult<f64> {
        Python::attach(|py| {
            let outer = IS_CALLING.replace(true);
            let Given { name, takes, function } = &*self.given;
            let given = takes.iter().map(|variable| variables[*variable]);
            let value = PyTuple::new(py, given)
                .and_then(|given| function.bind(py).call1(given))
                .and_then(|value| {
                    value.extract::<f64>().map_err(|_| {
                        let shown = value.repr().map(|shown| shown.to_string()).unwrap_or_default();
                        PyTypeError::new_err(format!(
                            "the function `{name}` returned {shown}, where a number is needed"
                        ))
                    })
                });
            IS_CALLING.set(outer);
            let value = value?;
            if !value.is_finite() {
                let given = takes.iter().map(|&variable| {
                    format!("{} = {:?}", VARIABLES[variable], variables[variable])
                });
                let given = given.collect::<Vec<_>>().join(", ");
                let message = format!("the function `{name}` returned {value} for {given}");
                return Err(PyValueError::new_err(message));
            }
            Ok(value)
        })
    }

    fn at(&self, variables: [f64; 4]) -> f64 {
        let is_remembered = !(self.takes_place() && self.takes_time());
        let mut key = [0; 4];
        self.given.takes.iter().for_each(|&variable| key[variable] = variables[variable].to_bits());
        if is_remembered {
            let known = self.known.read().unwrap_or_else(PoisonError::into_inner);
            if let Some(value) = known.get(&key) {
                return *value;
            }
        }
        // What comes after a fault is of no use.
        if self.shared.has_raised() {
            return f64::NAN;
        }
        match self.call(variables) {
            Ok(value) if is_remembered => {
                let mut known = self.known.write().unwrap_or_else(PoisonError::into_inner);
                if known.len() >= REMEMBERED {
                    known.clear();
                }
                known.insert(key, value);
                value
            }
            Ok(value) => value,
            Err(error) => {
                self.shared.keep(error);
                f64::NAN
            }
        }
    }
}

impl SpaceTime for Function {
    fn value(&self, [x, y, z]: [f64; 3], t: f64) -> f64 {
        self.at([x, y, z, t])
    }

    /// A difference quotient, central but at the start.
    fn rate(&self, [x, y, z]: [f64; 3], t: f64) -> f64 {
        if !self.takes_time() {
            return 0.0;
        }
        let step = STEP * f64::from_bits(self.shared.end.load(Ordering::SeqCst));
        let before = (t - step).max(0.0);
        let [last, next] = [before, t + step].map(|t| self.at([x, y, z, t]));
        (next - last) / (t + step - before)
    }

    fn is_steady(&self) -> bool {
        !self.takes_time()
    }

    fn is_uniform(&self) -> bool {
        !self.takes_place()
    }
}
