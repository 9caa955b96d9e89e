//! The state that an implicit step asks for, as a function of its velocities.

use nalgebra::{SMatrix, SVector};
use piola_formulas::Scalar;

use super::super::Upwind;
use super::super::gather::{Sums, at};
use super::super::local::{Side, Unknowns};
use super::super::pair::{Pair, applied};
use super::super::reconstruction::Slope;
use crate::operators::LANES;
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
pub(super) struct Fields<T, const D: usize> {
    /// v in m/s: an unknown.
    pub velocity: Vec<SVector<T, D>>,
    /// J, where it is an unknown.
    pub ratio: Vec<T>,
    /// What follows for particles alone.
    pub locals: Vec<Local<T, D>>,
    /// Slopes, zero without reconstruction.
    pub slopes: Vec<Slope<T, D>>,
    /// What particles do to each other.
    pub exchanges: Vec<Exchange<T, D>>,
}

/// What follows from velocities for a particle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local<T, const D: usize> {
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
pub(super) struct Exchange<T, const D: usize> {
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
            side: Side::default(),
        };
        let slope = Slope { velocity: SMatrix::zeros(), pressure: SVector::zeros() };
        let exchange = Exchange { force: SVector::zeros(), volume_rate: T::zero() };
        Self {
            velocity: vec![SVector::zeros(); count],
            ratio: vec![T::zero(); count],
            locals: vec![local; count],
            slopes: vec![slope; count],
            exchanges: vec![exchange; count],
        }
    }
}

/// Calls a pair law with the terms that are on.
type Terms<T, const D: usize> = fn(&Pair<'_, T, D>, usize, &mut Sums<[T; 1], D>);

impl<const D: usize> Stage<'_, D> {
    /// The neighbours of a with their areas `V_a G_ab` and `V_b G_ba`.
    pub fn pairs(&self, a: usize) -> impl Iterator<Item = (usize, Vector<D>, Vector<D>)> {
        let blocks = self.scheme.areas.row(a);
        self.scheme.support.list.row(a).iter().enumerate().map(move |(entry, &b)| {
            let (block, lane) = (&blocks[entry / LANES], entry % LANES);
            (b as usize, at(&block.forward, lane), at(&block.adjoint, lane))
        })
    }

    /// `dF_a/dt`, theory (10).
    pub fn velocity_gradient<T: Scalar>(
        &self,
        velocity: &[SVector<T, D>],
        a: usize,
    ) -> SMatrix<T, D, D> {
        let mut sum = SMatrix::<T, D, D>::zeros();
        for (b, area, _) in self.pairs(a) {
            let jump = velocity[b] - velocity[a];
            for j in 0..D {
                for i in 0..D {
                    sum[(i, j)] += jump[i] * area[j];
                }
            }
        }
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

    /// Slopes of velocity and pressure at a, theory (4).
    fn slope<T: Scalar>(&self, locals: &[Local<T, D>], a: usize) -> Slope<T, D> {
        let mut slope = Slope { velocity: SMatrix::zeros(), pressure: SVector::zeros() };
        let Some(least_squares) = &self.scheme.least_squares else { return slope };
        let me = &locals[a].side;
        for &b in self.scheme.support.list.row(a) {
            let coefficient = least_squares.coefficient(a, &self.reference(a, b as usize));
            let other = &locals[b as usize].side;
            let velocity_jump = other.velocity - me.velocity;
            let pressure_jump = other.pressure - me.pressure;
            for j in 0..D {
                for i in 0..D {
                    slope.velocity[(i, j)] += velocity_jump[i] * coefficient[j];
                }
                slope.pressure[j] += pressure_jump * coefficient[j];
            }
        }
        slope
    }

    /// `X_b - X_a`.
    pub fn reference(&self, a: usize, b: usize) -> Vector<D> {
        self.scheme.support.separation(&self.scheme.particles.position, a, b as u32)
    }

    /// `x_b - x_a`, the shortest way round in a periodic box.
    pub fn current<T: Scalar>(&self, a: &Side<T, D>, b: &Side<T, D>) -> SVector<T, D> {
        let separation = b.position - a.position;
        let plain = separation.map(|component| component.re());
        let mut shortest: [[f64; 1]; D] = std::array::from_fn(|i| [plain[i]]);
        self.scheme.support.domain.shorten(&mut shortest);
        SVector::from_fn(|i, _| separation[i] + (shortest[i][0] - plain[i]))
    }

    /// What a gets from its neighbours, theory (8) and (9), by the pair laws of the explicit passes.
    fn exchange<T: Scalar>(
        &self,
        locals: &[Local<T, D>],
        slopes: &[Slope<T, D>],
        a: usize,
    ) -> Exchange<T, D> {
        let settings = &self.scheme.settings;
        let (velocity, pressure) = (settings.tau_velocity > 0.0, settings.tau_pressure != 0.0);
        let add_terms: Terms<T, D> = match (velocity, pressure, settings.reconstruction) {
            (false, false, _) => {
                |pair, lane, sums| pair.add_terms::<false, false, false, 1>(lane, sums)
            }
            (true, false, false) => {
                |pair, lane, sums| pair.add_terms::<true, false, false, 1>(lane, sums)
            }
            (true, false, true) => {
                |pair, lane, sums| pair.add_terms::<true, false, true, 1>(lane, sums)
            }
            (_, _, false) => |pair, lane, sums| pair.add_terms::<true, true, false, 1>(lane, sums),
            (_, _, true) => |pair, lane, sums| pair.add_terms::<true, true, true, 1>(lane, sums),
        };
        let me = &locals[a].side;
        let mut sums = Sums::zero();
        for (b, area, transposed) in self.pairs(a) {
            let other = &locals[b].side;
            let current = self.current(me, other);
            let reference = self.reference(a, b);
            let slopes = [&slopes[a], &slopes[b]];
            let pair = Pair { me, other, area, transposed, current, reference, slopes };
            add_terms(&pair, 0, &mut sums);
        }
        let own = applied(&me.cofactor, &self.scheme.areas.diagonal(a));
        let force = SVector::from_fn(|i, _| {
            let [internal, upwind] = [sums.internal_force[i][0], sums.upwind_force[i][0]];
            internal + own[i] * me.pressure + upwind * settings.tau_velocity
        });
        Exchange { force, volume_rate: sums.upwind_volume_rate[0] * settings.tau_pressure }
    }

    /// Fills all that follows from velocities, and volume ratios where they are unknowns.
    pub fn fill<T: Scalar + Send + Sync>(&self, fields: &mut Fields<T, D>) {
        let Fields { velocity, ratio, locals, slopes, exchanges } = fields;
        parallel::for_each_chunk(locals, |first, locals| {
            for (offset, local) in locals.iter_mut().enumerate() {
                let a = first + offset;
                *local = self.local(velocity, ratio[a], a);
            }
        });
        let locals = &*locals;
        if self.scheme.settings.reconstruction {
            parallel::for_each_chunk(slopes, |first, slopes| {
                for (offset, slope) in slopes.iter_mut().enumerate() {
                    *slope = self.slope(locals, first + offset);
                }
            });
        }
        let slopes = &*slopes;
        parallel::for_each_chunk(exchanges, |first, exchanges| {
            for (offset, exchange) in exchanges.iter_mut().enumerate() {
                *exchange = self.exchange(locals, slopes, first + offset);
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
