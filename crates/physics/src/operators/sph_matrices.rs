//! The SPH matrices W, X, Y and Z.

use super::error::OperatorError;
use super::sparse::SparseOperator;
use super::stencil::{Cover, GradientForm, stencils};

/// The matrices that interpolate a field and take its derivatives, Elastodynamics (2.31), (2.33) and
/// (2.34), sparse: `<f> = W f`, `<df/dx> = X f` and so on, theory (58).
///
/// Columns are particles, and behind them the ghosts of the cover, which have no rows.
#[derive(Clone, Debug, PartialEq)]
pub struct SphMatrices<const D: usize> {
    /// W: entries `V_q W_pq`.
    pub value: SparseOperator,
    /// X, Y and Z: entries `V_q dW_pq/dx`, in 1/m.
    pub gradient: [SparseOperator; D],
}

impl<const D: usize> SphMatrices<D> {
    /// The matrices of particles under their cover functions, with the kernel weights of the
    /// particles for the volumes.
    ///
    /// # Errors
    /// [`OperatorError`] for positions or supports without neighbours, two particles at one place,
    /// and particles without a corrected gradient.
    pub fn new(cover: &Cover<'_, D>, form: GradientForm) -> Result<Self, OperatorError> {
        let stencils = stencils(cover, form)?;
        let width = stencils.len() + cover.images.len();
        let value = SparseOperator::from_rows(
            stencils.iter().enumerate().map(|(a, stencil)| {
                let others = stencil.entries.iter().map(|it| (it.neighbor as u32, it.value));
                others.chain([(a as u32, stencil.own)])
            }),
            width,
        );
        let gradient = std::array::from_fn(|axis| {
            SparseOperator::from_rows(
                stencils.iter().enumerate().map(|(a, stencil)| {
                    let others =
                        stencil.entries.iter().map(|it| (it.neighbor as u32, it.gradient[axis]));
                    others.chain([(a as u32, stencil.diagonal[axis])])
                }),
                width,
            )
        });
        Ok(Self { value, gradient })
    }
}
