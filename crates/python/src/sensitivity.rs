//! Derivatives of a state in equilibrium as arrays.

use piola::case::{SensitivityError, Session};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::display::seconds;
use crate::errors::sensitivity_error;
use crate::simulation::Simulation;

/// The derivatives of a state in equilibrium by a constant of a material, at the same loads; exact, as far as the
/// state is. It stays as it is when the run continues.
#[pyclass(module = "piola", frozen)]
pub struct Sensitivity {
    /// The key of the constant.
    #[pyo3(get)]
    key: String,
    /// The time in s of the state.
    #[pyo3(get)]
    time: f64,
    /// Of displacements, by the name of the body: arrays of the shape (particles, D), in m over the unit of the
    /// constant, with the rows of the fields of the body.
    #[pyo3(get)]
    displacement: Py<PyDict>,
    /// Of the forces of supports, as the field `reaction` has them, by the name of the body: arrays of the shape
    /// (particles, D), in N over the unit of the constant.
    #[pyo3(get)]
    reaction: Py<PyDict>,
    /// Of the columns of probes, by their names, as `head.reaction.x`: those of displacements, positions and
    /// reactions of the kinds `particle`, `sum` and `mean`.
    #[pyo3(get)]
    probes: Py<PyDict>,
}

/// All numbers of it: rows of displacements and reactions by body, and columns of probes.
type Found = (Vec<[Vec<f64>; 2]>, Vec<(String, f64)>);

impl Sensitivity {
    pub fn of(simulation: &Simulation, py: Python<'_>, key: String) -> PyResult<Self> {
        let (found, dimension, time) = simulation
            .with(py, |session| (find(session, &key), session.case().dimension, session.time()))?;
        let (bodies, probes) = found.map_err(|error| sensitivity_error(&error))?;
        let [displacement, reaction] = [PyDict::new(py), PyDict::new(py)];
        for (name, rows) in simulation.bodies.iter().zip(bodies) {
            for (dict, values) in [&displacement, &reaction].into_iter().zip(rows) {
                let shape = [values.len() / dimension, dimension];
                dict.set_item(name, array(py, values, &shape)?)?;
            }
        }
        let columns = PyDict::new(py);
        for (name, value) in probes {
            columns.set_item(name, value)?;
        }
        let [displacement, reaction, probes] = [displacement, reaction, columns].map(Bound::unbind);
        Ok(Self { key, time, displacement, reaction, probes })
    }
}

fn find(session: &mut Session, key: &str) -> Result<Found, SensitivityError> {
    let found = session.sensitivity(key)?;
    let probes = session.probe_sensitivities(&found);
    let dimension = session.case().dimension;
    let bodies = 0..session.case().bodies.len();
    let rows = bodies.map(|body| {
        let particles = session.particles_of(Some(body));
        [&found.displacement, &found.reaction].map(|all| {
            let row = |a: &usize| &all[a * dimension..(a + 1) * dimension];
            particles.iter().flat_map(row).copied().collect()
        })
    });
    Ok((rows.collect(), probes))
}

#[pymethods]
impl Sensitivity {
    fn __repr__(&self) -> String {
        format!("<Sensitivity to {} at t = {}>", self.key, seconds(self.time))
    }
}
