//! Tables of a run.

use piola::observe::{self, Series};
use piola::output::{self, DIGITS, significant};
use piola_cli::count;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::display::escape;

/// Rows that a notebook shows of each end of a table.
const SHOWN: usize = 5;

/// The names of the tables against time, in the order of `observe::Tables::all`.
const NAMES: [&str; 4] = ["probes", "energy", "momentum", "steps"];

/// What was recorded: the tables `probes`, `energy`, `momentum` and `steps` against time, and the last profile along
/// each line by the name of its probe. A copy.
#[pyclass(module = "piola", frozen, mapping)]
pub struct Tables {
    tables: observe::Tables,
}

impl Tables {
    pub fn new(tables: observe::Tables) -> Self {
        Self { tables }
    }

    /// Names of lines are what stands before the first point in the columns of their tables.
    fn line(table: &output::Table) -> Option<&str> {
        table.columns().iter().find_map(|column| Some(column.name.split_once('.')?.0))
    }

    fn named(&self) -> impl Iterator<Item = (&str, &output::Table)> {
        let lines = self.tables.profiles.iter();
        let lines = lines.filter_map(|table| Some((Self::line(table)?, table)));
        NAMES.into_iter().zip(self.tables.all()).chain(lines)
    }
}

#[pymethods]
impl Tables {
    fn __getitem__(&self, name: &str) -> PyResult<Table> {
        let found = self.named().find(|(known, _)| *known == name);
        found.map(|(_, table)| Table { table: table.clone() }).ok_or_else(|| {
            let known = self.keys().join("`, `");
            PyKeyError::new_err(format!("there is no table `{name}`; there are `{known}`"))
        })
    }

    fn __len__(&self) -> usize {
        self.named().count()
    }

    fn __contains__(&self, name: &str) -> bool {
        self.named().any(|(known, _)| known == name)
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(self.keys().into_pyobject(py)?.try_iter()?.into_any())
    }

    /// The names of the tables.
    fn keys(&self) -> Vec<String> {
        self.named().map(|(name, _)| name.to_owned()).collect()
    }

    /// The names that `curve` accepts.
    fn curves(&self) -> Vec<String> {
        self.tables.names()
    }

    /// A history against time in s, or a profile against the distance from the start of its line in m, by its name in
    /// checks and plots of a case, such as `top.displacement.y` or `energy.total`: both as arrays.
    ///
    /// Raises KeyError.
    fn curve<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let Some(Series::Curve { abscissa, values, .. }) = self.tables.curve(name) else {
            let message = format!("there is no history or profile `{name}`; `curves()` lists them");
            return Err(PyKeyError::new_err(message));
        };
        let shape = [values.len()];
        Ok((array(py, abscissa, &shape)?, array(py, values, &shape)?))
    }

    fn __repr__(&self) -> String {
        format!("<Tables {}>", self.keys().join(", "))
    }
}

/// A table of numbers with named columns. `table["total"]` is a column as an array, a copy.
#[pyclass(module = "piola", frozen, mapping)]
pub struct Table {
    table: output::Table,
}

#[pymethods]
impl Table {
    /// The names of the columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.table.columns().iter().map(|column| column.name.clone()).collect()
    }

    /// The SI unit of each column.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let units = PyDict::new(py);
        for column in self.table.columns() {
            units.set_item(&column.name, &column.unit)?;
        }
        Ok(units)
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let values = self.table.values(name).ok_or_else(|| {
            let known = self.columns().join("`, `");
            PyKeyError::new_err(format!("there is no column `{name}`; there are `{known}`"))
        })?;
        let shape = [values.len()];
        array(py, values, &shape)
    }

    fn __contains__(&self, name: &str) -> bool {
        self.table.index(name).is_some()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(self.columns().into_pyobject(py)?.try_iter()?.into_any())
    }

    /// Number of rows.
    fn __len__(&self) -> usize {
        self.table.len()
    }

    /// The names of the columns.
    fn keys(&self) -> Vec<String> {
        self.columns()
    }

    /// All numbers, with the shape (rows, columns): a copy.
    #[getter]
    fn array<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let shape = [self.table.len(), self.table.columns().len()];
        array(py, self.table.numbers().to_vec(), &shape)
    }

    /// The table as a pandas DataFrame; pandas has to be installed.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let options = PyDict::new(py);
        options.set_item("columns", self.columns())?;
        py.import("pandas")?.call_method("DataFrame", (self.array(py)?,), Some(&options))
    }

    fn __repr__(&self) -> String {
        let rows = count(self.table.len() as u64, "row");
        format!("<Table of {rows}: {}>", self.columns().join(", "))
    }

    fn _repr_html_(&self) -> String {
        let cells = |row: &mut dyn Iterator<Item = String>, tag: &str| {
            let cells: String =
                row.map(|cell| format!("<{tag}>{}</{tag}>", escape(&cell))).collect();
            format!("<tr>{cells}</tr>")
        };
        let head = cells(&mut self.table.columns().iter().map(output::Column::header), "th");
        let length = self.table.len();
        let mut rows = String::new();
        for (number, row) in self.table.rows().enumerate() {
            if number < SHOWN || number + SHOWN >= length {
                rows += &cells(&mut row.iter().map(|value| significant(*value, DIGITS)), "td");
            } else if number == SHOWN {
                rows += &cells(&mut self.table.columns().iter().map(|_| "…".to_owned()), "td");
            }
        }
        format!("<table>{head}{rows}</table>")
    }
}
