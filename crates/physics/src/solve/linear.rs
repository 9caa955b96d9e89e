//! One face for direct and iterative solution.

use std::time::{Duration, Instant};

use thiserror::Error;

use super::coarse::Coarse;
use super::jacobi::BlockJacobi;
use super::krylov::{Outcome, conjugate_gradients, gmres};
use super::{Factor, FactorError, Reduction, SparseMatrix, dissect, irregular};
use crate::parallel::{self, Team};
use crate::{Tensor, Vector};

/// The derivative of what a scheme's rows resist with, at the state it was made for.
pub trait Tangent<const D: usize>: Sync {
    /// Rows that row a shares a block with, itself among them.
    fn coupled(&self, a: usize) -> Vec<u32>;

    /// Calls `add(b, block)` for the blocks of row a, which add up where b comes again. What is not
    /// symmetric in the tangent enters with its symmetric part.
    fn add_row(&self, a: usize, add: &mut dyn FnMut(u32, &Tensor<D>));

    /// `product = K direction`, with what is not symmetric in it.
    fn apply(&mut self, direction: &[Vector<D>], product: &mut [Vector<D>]);

    /// The blocks on the diagonal.
    fn diagonal(&self) -> Vec<Tensor<D>>;

    /// Whether the tangent is symmetric.
    fn is_symmetric(&self) -> bool;
}

/// How linear equations are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearMethod {
    /// Directly up to a number of unknowns that a factorisation is quick for, else iteratively.
    #[default]
    Automatic,
    /// By `L D L^T`.
    Direct,
    /// By conjugate gradients, GMRES where the tangent is not symmetric. The preconditioner is
    /// the blocks on the diagonal and a coarse correction by the motions of parts as rigid bodies.
    Krylov,
}

impl LinearMethod {
    /// Whether a system is to be factorised: factors grow with the number of unknowns to the power
    /// of 1, about 1 and 4/3 in 1D, 2D and 3D, the work with that of 1, 3/2 and 2.
    fn is_direct<const D: usize>(self, unknowns: usize) -> bool {
        let most = [1_000_000, 150_000, 3_000][D - 1];
        match self {
            Self::Automatic => unknowns > 0 && unknowns <= most,
            // Nothing can be factorised where all is held.
            Self::Direct => unknowns > 0,
            Self::Krylov => false,
        }
    }
}

/// Whether energy rises in all directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// It rises, as far as was looked.
    Stable,
    /// It falls in some: in as many as the number says where they were counted.
    Unstable(Option<usize>),
    /// There is no energy: the tangent is not symmetric.
    Unknown,
}

/// What a solution took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearReport {
    /// Steps of the Krylov method, 0 for a direct solution.
    pub steps: usize,
    /// What was added to the diagonal to make the matrix positive definite.
    pub shift: f64,
    /// Whether the tangent as it is was found to be indefinite.
    pub indefinite: bool,
}

/// What all solutions so far took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Costs {
    /// Whether a matrix is factorised; else a Krylov method solves alone.
    pub direct: bool,
    /// Entries of the lower triangle that is factorised, of the coarse one where it is iterated.
    pub entries: usize,
    /// Entries of its factors.
    pub factor_entries: usize,
    /// Steps of Krylov methods.
    pub steps: u64,
    /// Wall time for entries and blocks.
    pub assembly: Duration,
    /// Wall time for factors.
    pub factorisation: Duration,
    /// Wall time for solutions.
    pub solution: Duration,
}

/// Linear equations without a solution.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum LinearError {
    /// No factors.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// A Krylov method that does not get on.
    #[error(
        "the linear equations were not solved in {steps} steps, a residual of {residual:.1e} is \
         left; use the `direct` solver, or smaller load steps"
    )]
    NoConvergence {
        /// Steps taken.
        steps: usize,
        /// What is left of the right-hand side.
        residual: f64,
    },
}

/// Least reduction of a residual that a Krylov method may give up with.
const POOREST: f64 = 0.5;
/// Steps of a Krylov method that are always allowed; a slender body needs many.
const LEAST_STEPS: usize = 5000;
/// First shift of an indefinite matrix over its largest diagonal entry; each further one is ten
/// times as large. Entries of nearly incompressible materials are of the size of the bulk modulus, and eigenvalues
/// along motions without a change of volume a small part of the shear modulus: at a Poisson's ratio of 0.4999 a part in
/// 10^6. A shift that is much larger than these makes Newton's method crawl.
const FIRST_SHIFT: f64 = 1e-6;

/// Steps of a Krylov method that are allowed for a number of unknowns.
pub fn most_steps(unknowns: usize) -> usize {
    LEAST_STEPS + unknowns / 20
}

impl Outcome {
    /// Writes the solution, unless hardly anything of the right-hand side is solved for; how many steps
    /// it took.
    ///
    /// # Errors
    /// [`LinearError::NoConvergence`].
    pub fn accept(self, solution: &mut [f64]) -> Result<usize, LinearError> {
        let Self { steps, residual, .. } = self;
        if !self.negative_curvature && residual > POOREST {
            return Err(LinearError::NoConvergence { steps, residual });
        }
        solution.copy_from_slice(&self.solution);
        Ok(steps)
    }
}

/// A linear solver bound to the pattern of a tangent.
///
/// Each of several ranks has one with all unknowns. They share what a tangent shares, and the coarse space.
#[derive(Clone)]
pub struct LinearSolver<const D: usize> {
    reduction: Reduction<D>,
    /// None for a Krylov method.
    direct: Option<(SparseMatrix, Factor)>,
    jacobi: BlockJacobi<D>,
    /// None for a direct method, and for few unknowns.
    coarse: Option<Coarse<D>>,
    shift: f64,
    /// Negative pivots of the tangent as it was loaded, in the coarse space without a direct method.
    negative: usize,
    /// Whether the coarse tangent is of another path of states.
    is_stale: bool,
    costs: Costs,
    team: Team,
}

impl<const D: usize> LinearSolver<D> {
    /// A solver for tangents that couple the same rows as `tangent`; `build` makes the reduction
    /// of an order of the rows at `points`.
    ///
    /// # Errors
    /// [`LinearError::Factor`] where the factors do not fit into memory.
    pub fn new<T: Tangent<D>>(
        method: LinearMethod,
        points: &[Vector<D>],
        tangent: &T,
        build: impl Fn(&[u32]) -> Reduction<D>,
    ) -> Result<Self, LinearError> {
        let plain: Vec<u32> = (0..points.len() as u32).collect();
        let mut reduction = build(&plain);
        let (mut direct, mut coarse) = (None, None);
        let mut coupled = vec![Vec::new(); points.len()];
        parallel::for_each_chunk(&mut coupled, |first, rows| {
            let rows = rows.iter_mut().enumerate();
            rows.for_each(|(offset, row)| *row = tangent.coupled(first + offset));
        });
        if method.is_direct::<D>(reduction.unknowns()) {
            reduction = build(&dissect(points, &coupled));
            let matrix = SparseMatrix::new(&reduction, &coupled);
            let factor = Factor::new(&matrix)?;
            direct = Some((matrix, factor));
        } else {
            coarse = Coarse::new(points, &reduction, &coupled)?;
        }
        let jacobi = BlockJacobi::default();
        let parts = direct.as_ref().map(|(matrix, factor)| (matrix, factor));
        let costs = match parts.or(coarse.as_ref().map(Coarse::parts)) {
            Some((matrix, factor)) => Costs {
                direct: direct.is_some(),
                entries: matrix.entries(),
                factor_entries: factor.entries(),
                ..Costs::default()
            },
            None => Costs::default(),
        };
        Ok(Self {
            reduction,
            direct,
            jacobi,
            coarse,
            shift: 0.0,
            negative: 0,
            is_stale: true,
            costs,
            team: Team::default(),
        })
    }

    /// Shares the work with a team, all of whom have the same tangents.
    pub(crate) fn share(&mut self, team: Team) {
        self.team = team;
        self.is_stale = true;
    }

    /// The unknowns it solves for.
    pub fn reduction(&self) -> &Reduction<D> {
        &self.reduction
    }

    /// What all solutions so far took.
    pub fn costs(&self) -> Costs {
        self.costs
    }

    /// Whether it factorises.
    pub fn is_direct(&self) -> bool {
        self.direct.is_some()
    }

    /// Whether the tangent that was loaded last was made positive definite by a shift.
    pub fn is_shifted(&self) -> bool {
        self.shift > 0.0
    }

    /// Begins anew: what is found next depends on nothing that was loaded before.
    pub fn restart(&mut self) {
        self.is_stale = true;
    }

    /// Takes a tangent in. With `definite` a direct solver makes it positive definite by a shift of
    /// the diagonal where it is not, and the coarse space keeps the tangent of the first state since
    /// [`Self::restart`], as it serves for all that are near.
    ///
    /// # Errors
    /// [`LinearError::Factor`] for a singular matrix.
    pub fn load<T: Tangent<D>>(&mut self, tangent: &T, definite: bool) -> Result<(), LinearError> {
        (self.shift, self.negative) = (0.0, 0);
        let start = Instant::now();
        let Some((matrix, factor)) = &mut self.direct else {
            self.jacobi = BlockJacobi::new(&self.reduction, &tangent.diagonal());
            if let Some(coarse) = self.coarse.as_mut().filter(|_| self.is_stale || !definite) {
                self.is_stale = false;
                coarse.assemble(tangent, &self.team);
                self.costs.assembly += start.elapsed();
                let start = Instant::now();
                self.negative = coarse.factorise()?;
                self.costs.factorisation += start.elapsed();
            }
            return Ok(());
        };
        matrix.assemble(&self.reduction, tangent);
        self.costs.assembly += start.elapsed();
        let start = Instant::now();
        let mut negative = factor.factorise(matrix)?;
        self.negative = negative;
        let largest = matrix.diagonal().iter().fold(0.0_f64, |largest, d| largest.max(d.abs()));
        while definite && negative > 0 && self.shift < 1e3 * largest {
            let next = if self.shift == 0.0 { FIRST_SHIFT * largest } else { 10.0 * self.shift };
            matrix.add_to_diagonal(next - self.shift);
            self.shift = next;
            negative = factor.factorise(matrix)?;
        }
        self.costs.factorisation += start.elapsed();
        Ok(())
    }

    /// Solves with the tangent that was loaded last, which is given once more for products.
    ///
    /// # Errors
    /// [`LinearError::NoConvergence`].
    pub fn solve<T: Tangent<D>>(
        &mut self,
        tangent: &mut T,
        right: &[f64],
        tolerance: f64,
        solution: &mut [f64],
    ) -> Result<LinearReport, LinearError> {
        let (start, shift, mut steps) = (Instant::now(), self.shift, 0);
        let mut indefinite = tangent.is_symmetric() && self.negative > 0;
        if tangent.is_symmetric() && self.is_direct() {
            self.precondition(right, solution);
        } else {
            let outcome = self.iterate(tangent, right, tolerance);
            indefinite |= outcome.negative_curvature;
            steps = outcome.accept(solution)?;
        }
        self.costs.solution += start.elapsed();
        Ok(LinearReport { steps, shift, indefinite })
    }

    /// Whether the tangent that was loaded without a shift is positive definite. Iteratively this
    /// is what the coarse space shows, and as much as conjugate gradients meet on their way from a
    /// start without any order.
    pub fn stability<T: Tangent<D>>(&mut self, tangent: &mut T) -> Stability {
        if !tangent.is_symmetric() {
            return Stability::Unknown;
        }
        if self.is_direct() {
            return match self.negative {
                0 => Stability::Stable,
                negative => Stability::Unstable(Some(negative)),
            };
        }
        if self.negative > 0 {
            return Stability::Unstable(None);
        }
        let start: Vec<f64> = (0..self.reduction.unknowns()).map(irregular).collect();
        match self.iterate(tangent, &start, 1e-6).negative_curvature {
            true => Stability::Unstable(None),
            false => Stability::Stable,
        }
    }

    fn iterate<T: Tangent<D>>(
        &mut self,
        tangent: &mut T,
        right: &[f64],
        tolerance: f64,
    ) -> Outcome {
        let Self { reduction, direct, jacobi, coarse, costs, .. } = self;
        let rows = reduction.rows();
        let (mut full, mut image) = (vec![Vector::zeros(); rows], vec![Vector::zeros(); rows]);
        let symmetric = tangent.is_symmetric();
        let product = |direction: &[f64], product: &mut [f64]| {
            reduction.expand_free(direction, &mut full);
            tangent.apply(&full, &mut image);
            reduction.restrict(&image, product);
        };
        let precondition = |residual: &[f64], scaled: &mut [f64]| {
            precondition(reduction, direct, jacobi, coarse, residual, scaled);
        };
        let most = most_steps(right.len());
        let outcome = match symmetric {
            true => conjugate_gradients(product, precondition, right, tolerance, most),
            false => gmres(product, precondition, right, tolerance, most),
        };
        costs.steps += outcome.steps as u64;
        outcome
    }

    /// Solves roughly with the tangent that was loaded last where it iterates, and exactly with its
    /// symmetric half where it factorises: what a Krylov method of one's own is preconditioned with.
    pub fn precondition(&mut self, residual: &[f64], scaled: &mut [f64]) {
        let Self { reduction, direct, jacobi, coarse, .. } = self;
        precondition(reduction, direct, jacobi, coarse, residual, scaled);
    }
}

fn precondition<const D: usize>(
    reduction: &Reduction<D>,
    direct: &mut Option<(SparseMatrix, Factor)>,
    jacobi: &BlockJacobi<D>,
    coarse: &mut Option<Coarse<D>>,
    residual: &[f64],
    scaled: &mut [f64],
) {
    scaled.copy_from_slice(residual);
    if let Some((_, factor)) = direct {
        return factor.solve(scaled);
    }
    jacobi.apply(reduction, scaled);
    if let Some(coarse) = coarse {
        coarse.add(residual, scaled);
    }
}
