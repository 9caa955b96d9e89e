//! What a run will do.

use piola::case::{self, PlannedLimit};
use piola_cli::count;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::display::table;

/// What a run will do: the output of `piola check`, which `str(plan)` returns.
#[pyclass(module = "piola", frozen)]
pub struct Plan {
    plan: case::Plan,
    text: String,
    rows: Vec<[String; 2]>,
    /// What the case shows, in one line.
    #[pyo3(get)]
    title: String,
}

impl Plan {
    pub fn new(case: &case::Case, plan: case::Plan) -> Self {
        let text = piola_cli::plan_text(case, &plan);
        Self { text, rows: piola_cli::plan_rows(case, &plan), title: case.title.clone(), plan }
    }
}

/// Bounds on a step as dicts, smallest first: name, step in s, number and reference position (in m) of the
/// particle that sets it.
pub fn limits<'py>(py: Python<'py>, limits: &[PlannedLimit]) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for limit in limits {
        let entry = PyDict::new(py);
        entry.set_item("name", limit.name)?;
        entry.set_item("step", limit.step)?;
        entry.set_item("particle", limit.particle.id)?;
        entry.set_item("place", limit.particle.reference.clone())?;
        list.append(entry)?;
    }
    Ok(list)
}

#[pymethods]
impl Plan {
    /// A dict for each body: name, particles, volume in m^D, exact_volume (None where it is not known), spacing
    /// in m along each axis, and finest: how many times smaller that is in the finest region.
    #[getter]
    fn bodies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for body in &self.plan.bodies {
            let entry = PyDict::new(py);
            entry.set_item("name", &body.name)?;
            entry.set_item("particles", body.particles)?;
            entry.set_item("volume", body.volume)?;
            entry.set_item("exact_volume", body.exact_volume)?;
            entry.set_item("spacing", body.spacing.clone())?;
            entry.set_item("finest", body.finest)?;
            list.append(entry)?;
        }
        Ok(list)
    }

    /// A dict with the `least`, `mean` and `most` neighbours of a particle.
    #[getter]
    fn neighbors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = &self.plan.neighbors;
        let neighbors = PyDict::new(py);
        neighbors.set_item("least", found.least)?;
        neighbors.set_item("mean", found.mean)?;
        neighbors.set_item("most", found.most)?;
        Ok(neighbors)
    }

    /// Bounds on the first step, smallest first: dicts of name, step in s, particle, place in m.
    #[getter]
    fn limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        limits(py, &self.plan.limits)
    }

    /// The first step in s.
    #[getter]
    fn step(&self) -> f64 {
        self.plan.step
    }

    /// What limits the first step.
    #[getter]
    fn limiter(&self) -> &str {
        &self.plan.limiter
    }

    /// Number of steps to the end if all are as long as the first.
    #[getter]
    fn steps(&self) -> u64 {
        self.plan.steps
    }

    /// Wall time of the run in s at the speed measured here, without output.
    #[getter]
    fn seconds(&self) -> f64 {
        self.plan.seconds
    }

    /// Particle evaluations per second, as measured here.
    #[getter]
    fn evaluations_per_second(&self) -> f64 {
        self.plan.evaluations_per_second
    }

    /// Memory of states and neighbour lists in bytes.
    #[getter]
    fn memory(&self) -> usize {
        self.plan.memory
    }

    /// A dict for each rank, by number, where the case has several (`compute.ranks`): its particles; the copies of particles
    /// of others that it keeps, and of how many ranks (partners) they are; bytes of copies that come with an evaluation of the
    /// rates (bytes) and in a step (step_bytes); load, what it computes over an even share; and efficiency, the share of its time
    /// in which it computes, as predicted for a network with 1.5 µs a message and 12 GB/s.
    #[getter]
    fn ranks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for rank in &self.plan.ranks {
            let entry = PyDict::new(py);
            entry.set_item("particles", rank.share.particles)?;
            entry.set_item("copies", rank.share.copies)?;
            entry.set_item("partners", rank.share.partners)?;
            entry.set_item("bytes", rank.share.bytes)?;
            entry.set_item("step_bytes", rank.step_bytes)?;
            entry.set_item("load", rank.share.load)?;
            entry.set_item("efficiency", rank.efficiency)?;
            list.append(entry)?;
        }
        Ok(list)
    }

    /// The speed of all ranks over that of as many with even shares that tell each other nothing, as predicted for the
    /// network of `ranks`; 1 without ranks.
    #[getter]
    fn efficiency(&self) -> f64 {
        self.plan.efficiency
    }

    /// What will be written, one line each.
    #[getter]
    fn outputs(&self) -> Vec<String> {
        self.plan.outputs.clone()
    }

    /// Warnings, one sentence each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.plan.warnings.clone()
    }

    /// What it has been given without being asked for, such as the viscosity of a stiff solid in a fluid, one sentence
    /// each.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.plan.notes.clone()
    }

    fn __str__(&self) -> &str {
        &self.text
    }

    fn __repr__(&self) -> String {
        let particles: usize = self.plan.bodies.iter().map(|body| body.particles).sum();
        let particles = count(particles as u64, "particle");
        format!("<Plan of {particles}, {}>", count(self.plan.steps, "step"))
    }

    fn _repr_html_(&self) -> String {
        table(&self.title, self.rows.iter().map(|row| row.each_ref().map(String::as_str)))
    }
}
