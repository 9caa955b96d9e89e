//! Clouds of points from arrays.

use std::sync::Arc;

use piola::geometry::PointCloud;
use piola_cli::count;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{array, floats, numbers, shape_text};
use crate::errors::guard;

/// Points with their volumes, from which a body is made:
/// `case.set("body.water.shape", piola.Cloud(positions, volumes))`.
///
/// Cloud(positions, volumes)
///
/// positions: array of shape (particles, D) in m.
/// volumes: array of shape (particles,) in m^D, or one number for all.
///
/// Arrays are copied; integers and 32-bit floats are converted, and any memory layout is accepted. A body made from a
/// cloud has no key `spacing`. Its particles are reordered in memory: `body.ids - body.ids.min()`, taken at the start,
/// gives the row of each in these arrays.
///
/// Raises ValueError for a wrong shape, NaN or infinity, a volume that is not above 0 and coincident points, with the
/// number of the particle, and TypeError for other types.
///
/// >>> import piola
/// >>> piola.Cloud([[0.0, 0.0], [1.0, 0.0]], 1.0)
/// <Cloud of 2 particles in 2D>
#[pyclass(module = "piola", frozen)]
pub struct Cloud {
    pub cloud: Arc<PointCloud>,
}

#[pymethods]
impl Cloud {
    #[new]
    fn new(positions: &Bound<'_, PyAny>, volumes: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (points, shape) = floats("`positions`", positions)?;
        let [count, dimension] = shape[..] else {
            let shape = shape_text(&shape);
            let message = format!("`positions` has the shape (particles, D), not {shape}");
            return Err(PyValueError::new_err(message));
        };
        let volumes = match floats("`volumes`", volumes)? {
            (one, shape) if shape.is_empty() => vec![one[0]; count],
            _ => numbers("`volumes`", volumes, &[count])?,
        };
        let cloud = guard(positions.py(), || PointCloud::new(dimension, points, volumes))?;
        let cloud = cloud.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(Self { cloud: Arc::new(cloud) })
    }

    /// Positions in m, of shape (particles, D): a copy.
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.cloud.positions().to_vec(), &[self.__len__(), self.cloud.dimension()])
    }

    /// Volumes in m^D, of shape (particles,): a copy.
    #[getter]
    fn volumes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.cloud.volumes().to_vec(), &[self.__len__()])
    }

    fn __len__(&self) -> usize {
        self.cloud.volumes().len()
    }

    fn __repr__(&self) -> String {
        let particles = count(self.__len__() as u64, "particle");
        format!("<Cloud of {particles} in {}D>", self.cloud.dimension())
    }
}
