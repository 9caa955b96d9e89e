//! Fields of bodies at a moment, which do not change when the run continues: without a copy if the numbers are
//! contiguous in the state.

use std::ops::Range;
use std::sync::Arc;

use super::columns::ColumnError;
use super::session::Session;
use crate::fields::{FieldDescription, FieldKind};

/// The particles of a body, or of all, by index in memory.
#[derive(Clone, Debug)]
pub(super) enum Rows {
    /// Such as follow each other.
    Stretch(Range<usize>),
    Scattered(Arc<[u32]>),
}

impl Rows {
    fn of(particles: Vec<u32>) -> Self {
        match (particles.first(), particles.last()) {
            (Some(&first), Some(&last)) if (last - first) as usize + 1 == particles.len() => {
                Self::Stretch(first as usize..last as usize + 1)
            }
            _ => Self::Scattered(particles.into()),
        }
    }

    pub fn list(&self) -> Vec<u32> {
        match self {
            Self::Stretch(range) => (range.start as u32..range.end as u32).collect(),
            Self::Scattered(particles) => particles.to_vec(),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Stretch(range) => range.len(),
            Self::Scattered(particles) => particles.len(),
        }
    }
}

/// A field of a body, or of all particles, at a moment. It keeps its memory alive: the run writes its next states to
/// other memory as long as there is a view of this one.
#[derive(Clone, Debug)]
pub struct FieldView {
    description: FieldDescription,
    dimension: usize,
    particles: usize,
    memory: Arc<Vec<f64>>,
    stretch: Range<usize>,
    is_copy: bool,
}

impl FieldView {
    /// The description of the field.
    pub fn description(&self) -> &FieldDescription {
        &self.description
    }

    /// Number of particles, the length of the first axis.
    pub fn particles(&self) -> usize {
        self.particles
    }

    /// Whether the numbers are a copy: the field is not a column of the state, or the particles of the body are not
    /// contiguous in it.
    pub fn is_copy(&self) -> bool {
        self.is_copy
    }

    /// The numbers, particle by particle. [`strides`](Self::strides) gives the position of each component.
    pub fn numbers(&self) -> &[f64] {
        &self.memory[self.stretch.clone()]
    }

    /// The distance in numbers from a value to the next one along each axis of the
    /// [shape](crate::fields::FieldKind::shape).
    pub fn strides(&self) -> Vec<usize> {
        let components = self.description.kind.components(self.dimension);
        match self.description.kind {
            FieldKind::Scalar => vec![components],
            FieldKind::Vector | FieldKind::Symmetric => vec![components, 1],
            // States have tensors column by column.
            FieldKind::Tensor if self.is_copy => vec![components, self.dimension, 1],
            FieldKind::Tensor => vec![components, 1, self.dimension],
        }
    }

    /// The shape of the field: particles, and the axes of a value.
    pub fn shape(&self) -> Vec<usize> {
        self.description.kind.shape(self.particles, self.dimension)
    }
}

impl Session {
    /// The current values of a field of the body with this number in the case, or of all particles. Rows are the
    /// particles present, in the order of all columns.
    ///
    /// # Errors
    /// [`ColumnError::Unknown`].
    pub fn view(&mut self, name: &str, body: Option<usize>) -> Result<FieldView, ColumnError> {
        let description = *self.described(name)?;
        let rows = self.rows(body);
        let (dimension, particles) = (self.case.dimension, rows.len());
        let shared = self.executor.shared_state();
        let mut now = self.executor.now();
        let stretch = match &rows {
            Rows::Stretch(range) => now.scheme().stretch(&description, range),
            Rows::Scattered(_) => None,
        };
        let is_copy = stretch.is_none();
        let (memory, stretch) = stretch.map_or_else(
            || {
                let mut values = Vec::new();
                now.read(&description, &rows.list(), &mut values);
                let all = 0..values.len();
                (Arc::new(values), all)
            },
            |stretch| (shared, stretch),
        );
        Ok(FieldView { description, dimension, particles, memory, stretch, is_copy })
    }

    /// The particles of a body that are there at the moment, or all that are.
    pub(super) fn rows(&mut self, body: Option<usize>) -> Rows {
        let now = self.executor.now();
        let (scheme, state) = (now.scheme(), now.state());
        let all = 0..scheme.particle_count() as u32;
        if body.is_none() && scheme.is_closed() {
            return Rows::Stretch(0..all.len());
        }
        let find = |body: Option<usize>| {
            let of = |a: &u32| scheme.body_of(state, *a as usize);
            let is_there =
                |a: &u32| of(a).is_some_and(|of| body.is_none_or(|it| of as usize == it));
            Rows::of(all.clone().filter(is_there).collect())
        };
        match body {
            // They are the same at all times.
            Some(number) if scheme.is_closed() => {
                if self.rows_of_bodies.is_empty() {
                    let bodies = 0..self.case.bodies.len();
                    self.rows_of_bodies = bodies.map(|body| find(Some(body))).collect();
                }
                let known = self.rows_of_bodies.get(number).cloned();
                known.unwrap_or_else(|| Rows::of(Vec::new()))
            }
            other => find(other),
        }
    }
}
