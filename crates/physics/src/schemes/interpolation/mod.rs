//! Interpolation of a known function: what the SPH sums of a cloud make of it and of its gradients.
//! Paper: Elastodynamics, 2.7 to 2.9.
//!
//! Nothing moves. The sums are those of the matrices W and X of theory (58) over the particles of a
//! body and ghosts around it, `<f> = W f`, `<grad f> = X f` and, as a formulation of second order in
//! space takes it, the gradient of that, `<grad grad f> = X <grad f>`, theory (77). How far these are
//! off on a lattice is theory (78).

mod boundary;
mod scheme;

use piola_formulas::kernels::Kernel;
use thiserror::Error;

pub use boundary::Boundary;
pub use scheme::DESCRIPTION;

use crate::boundaries::padded;
use crate::coordinates;
use crate::geometry::{GeometryError, Particles};
use crate::neighbors::Domain;
use crate::operators::{
    BoundaryValueError, Cover, GradientForm, OperatorError, SparseOperator, SphMatrices,
};
use crate::{Tensor, Vector};

use boundary::{Cloud, Outcome};

/// A function of space with its gradient.
pub trait Field<const D: usize> {
    /// Its value at `x` in m, padded with zeros to three components.
    fn value(&self, x: [f64; 3]) -> f64;

    /// Its gradient there.
    fn gradient(&self, x: [f64; 3]) -> Vector<D>;
}

/// All that a study of interpolation needs.
pub struct InterpolationInput<'a, const D: usize> {
    /// The particles, in the order in which they shall lie in memory.
    pub particles: Particles<D>,
    /// Particles around them, none for sums that end where the body does.
    pub ghosts: Particles<D>,
    /// The cover function.
    pub kernel: Kernel,
    /// Its support radius in m.
    pub radius: f64,
    /// What kernel gradients are made into.
    pub form: GradientForm,
    /// The box and its periodic axes.
    pub domain: Domain<D>,
    /// What ghosts do.
    pub boundary: Boundary,
    /// What is interpolated.
    pub function: &'a dyn Field<D>,
}

/// A study that is impossible.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum InterpolationError {
    /// Too many particles.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The matrices do not exist.
    #[error(transparent)]
    Operator(#[from] OperatorError),
    /// Boundary values cannot be met.
    #[error(transparent)]
    Boundary(#[from] BoundaryValueError),
    /// The function has no value.
    #[error(
        "the function or its gradient is not finite at {at} m, where {what} lies",
        at = coordinates(position)
    )]
    NotFinite {
        /// Where.
        position: Vec<f64>,
        /// A particle or a ghost.
        what: &'static str,
    },
}

/// A cloud with the sums of a function over it.
pub struct Interpolation<const D: usize> {
    particles: Particles<D>,
    /// W, over particles and behind them ghosts.
    value: SparseOperator,
    /// At particles and ghosts.
    function: Vec<f64>,
    approximation: Vec<f64>,
    gradient: Vec<Vector<D>>,
    second_gradient: Vec<Tensor<D>>,
    outcome: Outcome,
}

impl<const D: usize> Interpolation<D> {
    /// Takes all sums.
    ///
    /// # Errors
    /// [`InterpolationError`] for a cloud without matrices, a function that is not finite, and
    /// boundary values that cannot be met.
    #[inline(never)]
    pub fn new(input: InterpolationInput<'_, D>) -> Result<Self, InterpolationError> {
        let InterpolationInput { particles, ghosts, kernel, radius, form, domain, .. } = input;
        let count = particles.len();
        let mut all = particles.clone();
        if !ghosts.is_empty() {
            all.append(ghosts, 0)?;
        }
        let radius = vec![radius; all.len()];
        let cover =
            Cover { particles: &all, group: &[], images: &[], kernel, radius: &radius, domain };
        let matrices = SphMatrices::new(&cover, form)?;
        let (function, slopes) = sample(&all, count, input.function)?;

        let cloud = Cloud::new(&all, count, &matrices, [&function, &slopes[0]]);
        let mut outcome = Outcome::default();
        let field = cloud.field(input.boundary, input.function, &mut outcome)?;
        let scale =
            (input.boundary == Boundary::Scaled).then(|| sums(&matrices, &vec![1.0; all.len()]));
        let sums = |field: &[f64]| match &scale {
            Some(of_one) => scaled(sums(&matrices, field), of_one),
            None => sums(&matrices, field),
        };
        let (approximation, mut gradient) = sums(&field);
        cloud.meet_gradients(input.boundary, &slopes, &mut gradient, &mut outcome)?;
        outcome.error = match input.boundary {
            Boundary::Slope => cloud.error(&slopes, &gradient),
            _ => cloud.error(&[&function], &[&approximation]),
        };
        let second = gradient.each_ref().map(|component| sums(component).1);
        Ok(Self {
            gradient: (0..count).map(|a| Vector::from_fn(|i, _| gradient[i][a])).collect(),
            second_gradient: (0..count).map(|a| Tensor::from_fn(|i, j| second[i][j][a])).collect(),
            value: matrices.value,
            particles,
            function,
            approximation,
            outcome,
        })
    }

    /// The condition number of the modified matrix, if there is one, with the smallest and the largest
    /// value on a ghost that it made.
    pub fn condition(&self) -> Option<(f64, [f64; 2])> {
        let Outcome { condition, ghosts, .. } = self.outcome;
        (condition > 0.0).then_some((condition, ghosts))
    }
}

/// `W f` and `X f`.
fn sums<const D: usize>(matrices: &SphMatrices<D>, field: &[f64]) -> (Vec<f64>, [Vec<f64>; D]) {
    (matrices.value.apply(field), matrices.gradient.each_ref().map(|matrix| matrix.apply(field)))
}

/// `<f> = W f / W 1` and its gradient, `(X f - <f> X 1) / W 1`, with the sums of one.
fn scaled<const D: usize>(
    (mut value, mut slopes): (Vec<f64>, [Vec<f64>; D]),
    (share, share_slopes): &(Vec<f64>, [Vec<f64>; D]),
) -> (Vec<f64>, [Vec<f64>; D]) {
    value.iter_mut().zip(share).for_each(|(value, share)| *value /= share);
    for (slope, of_one) in slopes.iter_mut().zip(share_slopes) {
        let rest = value.iter().zip(share.iter().zip(of_one));
        let both = slope.iter_mut().zip(rest);
        both.for_each(|(slope, (value, (share, of_one)))| {
            *slope = (*slope - value * of_one) / share
        });
    }
    (value, slopes)
}

/// A function and the components of its gradient at particles, the last ones of which are ghosts.
fn sample<const D: usize>(
    all: &Particles<D>,
    count: usize,
    field: &dyn Field<D>,
) -> Result<(Vec<f64>, [Vec<f64>; D]), InterpolationError> {
    let at: Vec<[f64; 3]> = all.position.iter().map(padded).collect();
    let values: Vec<f64> = at.iter().map(|x| field.value(*x)).collect();
    let gradients: Vec<Vector<D>> = at.iter().map(|x| field.gradient(*x)).collect();
    let is_finite =
        |a: &usize| values[*a].is_finite() && gradients[*a].iter().all(|slope| slope.is_finite());
    if let Some(a) = (0..all.len()).find(|a| !is_finite(a)) {
        return Err(InterpolationError::NotFinite {
            position: all.position[a].iter().copied().collect(),
            what: if a < count { "a particle" } else { "a ghost" },
        });
    }
    let slopes = std::array::from_fn(|axis| gradients.iter().map(|slope| slope[axis]).collect());
    Ok((values, slopes))
}
