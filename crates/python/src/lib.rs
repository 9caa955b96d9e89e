//! The Python package `piola`: its part in Rust, the module `piola._piola`.
//!
//! Everything goes through `piola::case`. Steps are taken without the GIL; `simulation` documents which thread waits
//! for which.

use std::ffi::OsString;

use pyo3::prelude::*;

mod arrays;
mod bodies;
mod case;
mod cloud;
mod display;
mod errors;
mod field;
mod functions;
mod initial;
mod moment;
mod plan;
mod run;
mod sensitivity;
mod simulation;
mod stepping;
mod tables;
mod toml;

/// Runs the program `piola` with its name and its arguments, and returns its exit code.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    errors::guard(py, || piola_cli::main(arguments))
}

#[pymodule]
fn _piola(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("CaseError", py.get_type::<errors::CaseError>())?;
    module.add("RunError", py.get_type::<errors::RunError>())?;
    module.add_class::<errors::Fault>()?;
    module.add_class::<case::Case>()?;
    module.add_class::<cloud::Cloud>()?;
    module.add_class::<plan::Plan>()?;
    module.add_class::<simulation::Simulation>()?;
    module.add_class::<sensitivity::Sensitivity>()?;
    module.add_class::<moment::Moment>()?;
    module.add_class::<moment::Every>()?;
    module.add_class::<bodies::Bodies>()?;
    module.add_class::<bodies::Body>()?;
    module.add_class::<field::Field>()?;
    module.add_function(wrap_pyfunction!(field::field_of, module)?)?;
    module.add_class::<tables::Tables>()?;
    module.add_class::<tables::Table>()?;
    module.add_class::<run::Run>()?;
    module.add_function(wrap_pyfunction!(main, module)?)
}
