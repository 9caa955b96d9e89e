//! The tangent of a stage in its velocities, block by block.
//!
//! The force on a particle a is a sum over pairs of what sides, jumps and places say, and these are
//! linear in the velocities around but for the sides, which follow from the velocity gradient of one
//! particle. So the chain rule has derivatives of small functions inside, which dual numbers give
//! through the same bodies as the residual, and linear coefficients outside: theory (57).

use num_dual::Dual64;
use piola_formulas::pairs::upwind::{
    Exchange, ExchangeSum, Reconstructed, Side, UpwindSide, UpwindSlope,
};
use piola_formulas::pairs::{AreaPair, Areas, Of, PairLaw, Record};

use super::super::WaveSpeed;
use super::stage::{Fields, Stage};
use crate::{Tensor, Vector, parallel};

/// How what a particle shows follows its velocity gradient.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response<const D: usize> {
    /// `d(p H)/dL_jl` in Pa s, by j and l.
    stress: [[Tensor<D>; D]; D],
    /// `dc/dL_jl` in m.
    wave_speed: Tensor<D>,
    /// `dJ/dL_jl` in s.
    pub ratio: Tensor<D>,
}

impl<const D: usize> Response<D> {
    pub const ZERO: Self = {
        let zero = Tensor::from_array_storage(nalgebra::ArrayStorage([[0.0; D]; D]));
        Self { stress: [[zero; D]; D], wave_speed: zero, ratio: zero }
    };
}

/// Derivatives of the dissipative force of a pair.
struct Dissipation<const D: usize> {
    /// By the jump of the velocity, kg/s.
    jump: Tensor<D>,
    /// By the current separation, N/m.
    separation: Tensor<D>,
    /// By the wave speeds of both, kg/s.
    wave_speeds: [Vector<D>; 2],
}

/// Force by velocity gradient of one particle, `df_i/dL_jl` by j and l.
type ByGradient<const D: usize> = [[Vector<D>; D]; D];

impl<const D: usize> Stage<'_, D> {
    /// How pressure, cofactor and wave speed of particles follow their velocity gradients. Where the
    /// volume ratio is an unknown it is as if it were not, but at its own value.
    pub fn fill_responses(&self, fields: &Fields<f64, D>, responses: &mut [Response<D>]) {
        parallel::for_each_chunk(responses, |first, responses| {
            for (offset, response) in responses.iter_mut().enumerate() {
                *response = self.response(fields, first + offset);
            }
        });
    }

    fn response(&self, fields: &Fields<f64, D>, a: usize) -> Response<D> {
        let mut response = Response::ZERO;
        let (local, velocity) = (&fields.locals[a], fields.velocity[a].map(Dual64::from));
        for j in 0..D {
            for l in 0..D {
                let mut gradient = local.gradient.map(Dual64::from);
                gradient[(j, l)].eps = 1.0;
                let (mut unknowns, _) = self.unknowns(a, &velocity, &gradient);
                response.ratio[(j, l)] = unknowns.ratio.eps;
                unknowns.ratio.re = local.ratio;
                let side = self.scheme.side(a, &unknowns);
                response.stress[j][l] = side.cofactor.map(|entry| (entry * side.pressure).eps);
                response.wave_speed[(j, l)] = side.wave_speed.eps;
            }
        }
        response
    }

    /// Adds the blocks of row a of `m - k df/dv`, without the pressure dissipation, which has its
    /// part where the volume ratio is an unknown.
    pub fn add_row(
        &self,
        fields: &Fields<f64, D>,
        responses: &[Response<D>],
        a: usize,
        add: &mut dyn FnMut(u32, &Tensor<D>),
    ) {
        let settings = &self.scheme.settings;
        add(a as u32, &(Tensor::identity() * self.scheme.mass(a)));
        let mut own = through_area(&responses[a], &self.scheme.areas.diagonal(a));
        self.pairs(a, |b, pair| {
            let mut theirs = through_area(&responses[b], &pair.transposed);
            if settings.tau_velocity > 0.0 {
                let dissipation = self.dissipation(fields, a, b, pair);
                let by_velocity = dissipation.jump + dissipation.separation * self.weight;
                let block = by_velocity * self.weight;
                add(a as u32, &block);
                add(b as u32, &-block);
                let sides = [(&mut own, a), (&mut theirs, b)];
                for ((by_gradient, p), force) in sides.into_iter().zip(dissipation.wave_speeds) {
                    let wave_speed = &responses[p].wave_speed;
                    for (j, row) in by_gradient.iter_mut().enumerate() {
                        for (l, entry) in row.iter_mut().enumerate() {
                            *entry += force * wave_speed[(j, l)];
                        }
                    }
                }
                if settings.reconstruction {
                    let reference = self.reference(a, b);
                    self.add_slope(&dissipation.jump, &reference, a, add);
                    self.add_slope(&dissipation.jump, &reference, b, add);
                }
            }
            self.add_gradient(&theirs, b, add);
        });
        self.add_gradient(&own, a, add);
    }

    /// Adds `-k` times a force that follows the velocity gradient of particle p, theory (10).
    fn add_gradient(&self, force: &ByGradient<D>, p: usize, add: &mut dyn FnMut(u32, &Tensor<D>)) {
        let scale = -self.weight / self.scheme.particles.volume[p];
        let mut sum = Tensor::zeros();
        self.pairs(p, |c, pair| {
            let block = Tensor::from_fn(|i, j| {
                scale * (0..D).map(|l| force[j][l][i] * pair.area[l]).sum::<f64>()
            });
            sum += block;
            add(c as u32, &block);
        });
        add(p as u32, &-sum);
    }

    /// Adds what half the slope of particle p takes off the jump of a pair with a reference
    /// separation, theory (4).
    fn add_slope(
        &self,
        by_jump: &Tensor<D>,
        reference: &Vector<D>,
        p: usize,
        add: &mut dyn FnMut(u32, &Tensor<D>),
    ) {
        let Some(least_squares) = &self.scheme.least_squares else { return };
        let mut sum = Tensor::zeros();
        for &c in self.scheme.support.list.row(p) {
            let coefficient = least_squares.coefficient(p, &self.reference(p, c as usize));
            let block = by_jump * (0.5 * self.weight * coefficient.dot(reference));
            sum += block;
            add(c, &block);
        }
        add(p as u32, &-sum);
    }

    /// Derivatives of the dissipative force of a pair by dual numbers through the pair law.
    fn dissipation(
        &self,
        fields: &Fields<f64, D>,
        a: usize,
        b: usize,
        pair: &Areas<f64, D>,
    ) -> Dissipation<D> {
        let settings = &self.scheme.settings;
        let [me, other] = [a, b].map(|p| lifted::<UpwindSide<D>>(&fields.locals[p].side));
        let slopes = [a, b].map(|p| lifted::<UpwindSlope<D>>(&fields.slopes[p]));
        let pair = (lifted::<AreaPair<D>>(pair), Dual64::from(1.0));
        let law = Exchange::<D, true, false>(self.scheme.periods());
        let force = |me: Side<Dual64, D>, other: Side<Dual64, D>| -> Vector<D> {
            let mut sums = ExchangeSum::zero();
            match settings.reconstruction {
                true => {
                    let [mine, theirs] = slopes;
                    Reconstructed(law).add(&(me, mine), &(other, theirs), &pair, &mut sums);
                }
                false => law.add(&me, &other, &pair, &mut sums),
            }
            sums.upwind_force.map(|force| settings.tau_velocity * force.eps)
        };
        let mut result = Dissipation::<D> {
            jump: Tensor::zeros(),
            separation: Tensor::zeros(),
            wave_speeds: [Vector::zeros(); 2],
        };
        for i in 0..D {
            let mut moved = other;
            moved.velocity[i].eps = 1.0;
            result.jump.set_column(i, &force(me, moved));
            let mut farther = other;
            farther.position[i].eps = 1.0;
            result.separation.set_column(i, &force(me, farther));
        }
        if settings.wave_speed == WaveSpeed::Stretch {
            let (mut faster, mut other_faster) = (me, other);
            faster.wave_speed.eps = 1.0;
            other_faster.wave_speed.eps = 1.0;
            result.wave_speeds = [force(faster, other), force(me, other_faster)];
        }
        result
    }
}

/// Force of a stress through an area, by the velocity gradient that it follows.
fn through_area<const D: usize>(response: &Response<D>, area: &Vector<D>) -> ByGradient<D> {
    response.stress.map(|row| row.map(|stress| stress * area))
}

/// The same record in dual numbers without derivatives.
fn lifted<R: Record>(record: &Of<R, f64>) -> Of<R, Dual64> {
    R::map([record], &|[x]: [f64; 1]| Dual64::from(x))
}
