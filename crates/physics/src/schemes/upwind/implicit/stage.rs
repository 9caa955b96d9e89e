//! The state that an implicit step asks for, as a function of its velocities.

use std::ops::Range;

use nalgebra::{SMatrix, SVector};
use piola_formulas::kernels::Needs;
use piola_formulas::pairs::upwind::{
    Exchange, Gradient, Reconstructed, Side, Slope, Slopes, UpwindSide, UpwindSlope,
};
use piola_formulas::pairs::{AreaPair, Areas, Frozen, Of, PairLaw, Record};
use piola_formulas::{Number, Scalar};

use super::super::Upwind;
use super::super::local::Unknowns;
use super::super::reconstruction::solved;
use crate::operators::{Among, Row, sum_at, visit};
use crate::{Vector, parallel};

/// `s = b + k f(s)` with a known base b and weight k, theory (55), of a formulation. Position and
/// deformation gradient of s follow from its velocities alone, and so does the volume ratio unless it
/// is an unknown of its own.
///
/// Its bodies are generic over the number type, so that dual numbers give the exact tangent through
/// the pair laws of the explicit passes.
pub(super) struct Stage<'a, const D: usize> {
    pub scheme: &'a Upwind<D>,
    /// k in s.
    pub weight: f64,
    /// Unknowns of the base b.
    pub base: &'a [Unknowns<f64, D>],
    /// Whether the volume ratio is an unknown.
    pub keeps_ratio: bool,
}

/// All that a stage consists of, particle by particle.
#[derive(Clone, Debug)]
pub(super) struct Fields<T: Number, const D: usize> {
    /// v in m/s: an unknown.
    pub velocity: Vec<SVector<T, D>>,
    /// J, where it is an unknown.
    pub ratio: Vec<T>,
    /// What follows for particles alone.
    pub locals: Vec<Local<T, D>>,
    /// Slopes, zero without reconstruction.
    pub slopes: Vec<Slope<T, D>>,
    /// What particles do to each other.
    pub exchanges: Vec<Exchanged<T, D>>,
}

/// What follows from velocities for a particle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local<T: Number, const D: usize> {
    /// dF/dt in 1/s.
    pub gradient: SMatrix<T, D, D>,
    /// H : dF/dt in 1/s.
    pub dilatation: T,
    /// J.
    pub ratio: T,
    /// What it shows its neighbours.
    pub side: Side<T, D>,
}

/// What a particle gets from its neighbours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exchanged<T, const D: usize> {
    /// Internal force with dissipation in N.
    pub force: SVector<T, D>,
    /// Volume rate of the pressure dissipation in m^D/s.
    pub volume_rate: T,
}

impl<T: Scalar, const D: usize> Fields<T, D> {
    /// Room for some particles.
    pub fn new(count: usize) -> Self {
        let local = Local {
            gradient: SMatrix::zeros(),
            dilatation: T::zero(),
            ratio: T::zero(),
            side: UpwindSide::zero(),
        };
        let exchange = Exchanged { force: SVector::zeros(), volume_rate: T::zero() };
        Self {
            velocity: vec![SVector::zeros(); count],
            ratio: vec![T::zero(); count],
            locals: vec![local; count],
            slopes: vec![UpwindSlope::zero(); count],
            exchanges: vec![exchange; count],
        }
    }
}

impl<const D: usize> Stage<'_, D> {
    /// Shows the neighbours of particle a.
    pub fn pairs(&self, a: usize, mut look: impl FnMut(usize, &Areas<f64, D>)) {
        let needs = Needs::Nothing;
        let pairs = &self.scheme.areas.pairs;
        visit(pairs, a, Among::All, needs, &mut Row::default(), |b, (pair, _)| look(b, pair));
    }

    /// What a law sums over the neighbours of particle a.
    pub fn sum<T: Number, L: PairLaw<Pair = Frozen<AreaPair<D>>>>(
        &self,
        law: &L,
        a: usize,
        show: impl Fn(usize) -> Of<L::Side, T>,
    ) -> Of<L::Sums, T> {
        sum_at(&self.scheme.areas.pairs, law, a, show)
    }

    /// `dF_a/dt`, theory (10).
    pub fn velocity_gradient<T: Scalar>(
        &self,
        velocity: &[SVector<T, D>],
        a: usize,
    ) -> SMatrix<T, D, D> {
        let sum = self.sum(&Gradient, a, |b| velocity[b]);
        sum.map(|entry| entry / self.scheme.particles.volume[a])
    }

    /// The unknowns of particle a with a velocity and its gradient, and `H : dF/dt`; with the volume
    /// ratio that follows from them.
    pub fn unknowns<T: Scalar>(
        &self,
        a: usize,
        velocity: &SVector<T, D>,
        gradient: &SMatrix<T, D, D>,
    ) -> (Unknowns<T, D>, T) {
        let (base, weight) = (&self.base[a], self.weight);
        let position = SVector::from_fn(|i, _| velocity[i] * weight + T::from(base.position[i]));
        let deformation =
            SMatrix::from_fn(|i, j| gradient[(i, j)] * weight + T::from(base.deformation[(i, j)]));
        let cofactor = piola_formulas::tensor::cofactor(&deformation);
        let mut dilatation = T::zero();
        for j in 0..D {
            for i in 0..D {
                dilatation += cofactor[(i, j)] * gradient[(i, j)];
            }
        }
        let ratio = dilatation * weight + T::from(base.ratio);
        (Unknowns { velocity: *velocity, ratio, position, deformation }, dilatation)
    }

    fn local<T: Scalar>(&self, velocity: &[SVector<T, D>], ratio: T, a: usize) -> Local<T, D> {
        let gradient = self.velocity_gradient(velocity, a);
        let (mut unknowns, dilatation) = self.unknowns(a, &velocity[a], &gradient);
        if self.keeps_ratio {
            unknowns.ratio = ratio;
        }
        let side = self.scheme.side(a, &unknowns);
        Local { gradient, dilatation, ratio: unknowns.ratio, side }
    }

    /// `X_b - X_a`.
    pub fn reference(&self, a: usize, b: usize) -> Vector<D> {
        self.scheme.support.separation(&self.scheme.particles.position, a, b as u32)
    }

    /// What a gets from its neighbours, theory (8) and (9), by the pair laws of the explicit passes.
    fn exchange<T: Scalar>(
        &self,
        locals: &[Local<T, D>],
        slopes: &[Slope<T, D>],
        a: usize,
    ) -> Exchanged<T, D> {
        let (settings, way) = (&self.scheme.settings, self.scheme.periods());
        let (velocity, pressure) = (settings.tau_velocity > 0.0, settings.tau_pressure != 0.0);
        let side = |b: usize| locals[b].side;
        let both = |b: usize| (locals[b].side, slopes[b]);
        let sums = match (velocity, pressure, settings.reconstruction) {
            (false, false, _) => self.sum(&Exchange::<D, false, false>(way), a, side),
            (true, false, false) => self.sum(&Exchange::<D, true, false>(way), a, side),
            (_, _, false) => self.sum(&Exchange::<D, true, true>(way), a, side),
            (true, false, _) => self.sum(&Reconstructed(Exchange::<D, true, false>(way)), a, both),
            _ => self.sum(&Reconstructed(Exchange::<D, true, true>(way)), a, both),
        };
        let (me, diagonal) = (&locals[a].side, self.scheme.areas.diagonal(a));
        let force = SVector::from_fn(|i, _| {
            let mut own = me.cofactor[(i, 0)] * diagonal[0];
            for j in 1..D {
                own += me.cofactor[(i, j)] * diagonal[j];
            }
            let upwind = sums.upwind_force[i] * settings.tau_velocity;
            sums.internal_force[i] + own * me.pressure + upwind
        });
        Exchanged { force, volume_rate: sums.upwind_volume_rate * settings.tau_pressure }
    }

    /// Fills all that follows from velocities, and volume ratios where they are unknowns; what particles do to each other
    /// only for these `rows`.
    pub fn fill<T: Scalar + Send + Sync>(&self, fields: &mut Fields<T, D>, rows: Range<usize>) {
        let Fields { velocity, ratio, locals, slopes, exchanges } = fields;
        parallel::for_each_chunk(locals, |first, locals| {
            for (offset, local) in locals.iter_mut().enumerate() {
                let a = first + offset;
                *local = self.local(velocity, ratio[a], a);
            }
        });
        let locals = &*locals;
        if let Some(least_squares) = &self.scheme.least_squares {
            let law = Slopes(self.scheme.periods());
            parallel::for_each_chunk(slopes, |first, slopes| {
                for (offset, slope) in slopes.iter_mut().enumerate() {
                    let moments = self.sum(&law, first + offset, |b| locals[b].side);
                    *slope = solved(&moments, least_squares.inverse(first + offset));
                }
            });
        }
        let slopes = &*slopes;
        let begin = rows.start;
        parallel::for_each_chunk(&mut exchanges[rows], |first, exchanges| {
            for (offset, exchange) in exchanges.iter_mut().enumerate() {
                *exchange = self.exchange(locals, slopes, begin + first + offset);
            }
        });
    }

    /// What the equations of particle a leave: `k f - m (v - b)` in kg m/s, with what acts from
    /// `outside` in N, and `b + k dJ/dt - J`, theory (56).
    pub fn left<T: Scalar>(
        &self,
        fields: &Fields<T, D>,
        a: usize,
        outside: &Vector<D>,
    ) -> (SVector<T, D>, T) {
        let (base, mass, weight) = (&self.base[a], self.scheme.mass(a), self.weight);
        let (local, exchange) = (&fields.locals[a], &fields.exchanges[a]);
        let momentum = SVector::from_fn(|i, _| {
            let gained = (fields.velocity[a][i] - base.velocity[i]) * mass;
            (exchange.force[i] + outside[i]) * weight - gained
        });
        let rate = local.dilatation + exchange.volume_rate / self.scheme.particles.volume[a];
        (momentum, rate * weight + base.ratio - local.ratio)
    }
}
