//! Plain sums over moving neighbours: density, gradients, normals, and what shifting needs.
//!
//! Where a side ends in a number, it is 1 for neighbours of the same continuum and walls and 0 for others,
//! which add nothing.

use super::fluid::{FluidSide, Side};
use super::{Components, MovingPair, Of, One, PairLaw, Square, difference};
use crate::kernels::{Kernel, Needs};
use crate::power::integer_power;
use crate::{Number, fluid};

/// A side, and whether it counts.
type OwnSide<const D: usize> = (FluidSide<D>, One);

/// `sum_b m_b W_ab` in kg/m^3, without the particle itself.
#[derive(Clone, Copy, Debug)]
pub struct Density<const D: usize>;

impl<const D: usize> PairLaw for Density<D> {
    type Pair = MovingPair<D>;
    type Side = FluidSide<D>;
    type Sums = One;

    const NEEDS: Needs = Needs::Value;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &Of<Self::Side, T>,
        other: &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sum: &mut T,
    ) {
        *sum += other.mass() * pair.value;
    }
}

/// `- sum V_b grad W_ab` in 1/m of CTVF (42), which leads out of a free surface.
#[derive(Clone, Copy, Debug)]
pub struct Opening<const D: usize>;

impl<const D: usize> PairLaw for Opening<D> {
    type Pair = MovingPair<D>;
    type Side = OwnSide<D>;
    type Sums = Components<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &Of<Self::Side, T>,
        (other, own): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sum: &mut Of<Components<D>, T>,
    ) {
        let weight = other.volume * pair.slope * *own;
        for i in 0..D {
            sum[i] -= pair.separation[i] * weight;
        }
    }
}

/// The velocity gradient `d u_i / d x_j = - sum V_b u_ab (x) grad W_ab` in 1/s, CTVF (31).
#[derive(Clone, Copy, Debug)]
pub struct VelocityGradient<const D: usize>;

impl<const D: usize> PairLaw for VelocityGradient<D> {
    type Pair = MovingPair<D>;
    type Side = FluidSide<D>;
    type Sums = Square<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        me: &Of<Self::Side, T>,
        other: &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut Of<Square<D>, T>,
    ) {
        let jump = difference(&me.velocity, &other.velocity);
        for i in 0..D {
            for j in 0..D {
                sums[(i, j)] -= other.volume * jump[i] * (pair.separation[j] * pair.slope);
            }
        }
    }
}

/// Density in kg/m^3, and the smoothed normal of CTVF (43): `sum V_b n_b W_ab` of the sharp normals n
/// beside the sides; without the particle itself.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceNormal<const D: usize>;

impl<const D: usize> PairLaw for SurfaceNormal<D> {
    type Pair = MovingPair<D>;
    type Side = (OwnSide<D>, Components<D>);
    type Sums = (One, Components<D>);

    const NEEDS: Needs = Needs::Value;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &Of<Self::Side, T>,
        ((other, own), sharp): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        (density, normal): &mut Of<Self::Sums, T>,
    ) {
        *density += other.mass() * pair.value * *own;
        let weight = other.volume * pair.value * *own;
        for i in 0..D {
            normal[i] += sharp[i] * weight;
        }
    }
}

/// The sum of CTVF (35) in 1/m with the gradient of a kernel of another smoothing length than that of
/// values, which stands beside the side of the particle itself, in m.
///
/// The gradients keep the size that they have with the full support: a kernel that is scaled down to a
/// unit integral pushes without bounds once it holds but a neighbour or two.
#[derive(Clone, Copy, Debug)]
pub struct CrowdingWithin<const D: usize> {
    /// The kernel.
    pub kernel: Kernel,
    /// Smoothing length of values in m.
    pub smoothing_length: f64,
    /// `1 / W(dx)` in m^D.
    pub crowding: f64,
}

impl<const D: usize> PairLaw for CrowdingWithin<D> {
    type Pair = MovingPair<D>;
    type Side = ((One, One), One);
    type Sums = Components<D>;

    const NEEDS: Needs = Needs::Value;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (_, h): &Of<Self::Side, T>,
        ((volume, own), _): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sum: &mut Of<Components<D>, T>,
    ) {
        let distance = pair.square.sqrt();
        let size = integer_power(*h / T::from(self.smoothing_length), D as u32 + 1);
        let slope = self.kernel.derivative_over_r_within(D, distance, *h) * size;
        let weight = fluid::repulsion(pair.value * self.crowding) * slope * *volume * *own;
        for i in 0..D {
            sum[i] += pair.separation[i] * weight;
        }
    }
}

/// `sum W_ab` in m^-D and the displacement of IPST, CTVF (39): `sum V_b W(r_ab, h_b) r_ab / |r_ab|`,
/// both without the particle itself.
#[derive(Clone, Copy, Debug)]
pub struct Displacement<const D: usize> {
    /// The kernel.
    pub kernel: Kernel,
    /// Smoothing length h_b in m of displacements where it is not that of values; none of them where
    /// it is zero.
    pub smoothing_length: Option<f64>,
}

impl<const D: usize> PairLaw for Displacement<D> {
    type Pair = MovingPair<D>;
    type Side = OwnSide<D>;
    type Sums = (One, Components<D>);

    const NEEDS: Needs = Needs::Value;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &Of<Self::Side, T>,
        (other, own): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        (values, direction): &mut Of<Self::Sums, T>,
    ) {
        *values += pair.value * *own;
        let distance = pair.square.sqrt();
        let value = match self.smoothing_length {
            Some(h) if h > 0.0 => self.kernel.value(D, distance, h),
            Some(_) => T::zero(),
            None => pair.value,
        };
        let away = distance.above(0.0);
        let distance = T::select(away, distance, T::one());
        let weight = T::select(away, other.volume * value / distance, T::zero()) * *own;
        for i in 0..D {
            direction[i] += pair.separation[i] * weight;
        }
    }
}

/// The push of a background pressure, `sum m_b grad W(r_ab, h)` with a smoothing length of its own,
/// theory (79), in kg/m^(D+1).
#[derive(Clone, Copy, Debug)]
pub struct Background<const D: usize> {
    /// The kernel.
    pub kernel: Kernel,
    /// Its smoothing length in m.
    pub smoothing_length: f64,
}

impl<const D: usize> Background<D> {
    /// That of forces with a kernel and a smoothing length in m: it sees the nearest neighbours alone.
    pub fn of(kernel: Kernel, smoothing_length: f64) -> Self {
        Self { kernel, smoothing_length: 0.5 * smoothing_length }
    }

    /// What makes an acceleration of the sum, `-p0_a / rho_a^2` with `p0_a = min(10 |p_a|, f rho_0 c^2)`, of the side of a
    /// particle, of `f` and of `rho_0` in kg/m^3 and `c` in m/s at rest; in m^5/(kg s^2).
    #[inline]
    pub fn scale<T: Number>(side: &Side<T, D>, most: f64, [density, wave_speed]: [T; 2]) -> T {
        let bound = T::from(most) * (density * (wave_speed * wave_speed));
        let own = T::from(10.0) * side.pressure.abs();
        -T::select(own.less(bound), own, bound) / (side.density * side.density)
    }
}

impl<const D: usize> PairLaw for Background<D> {
    type Pair = MovingPair<D>;
    type Side = OwnSide<D>;
    type Sums = Components<D>;

    const NEEDS: Needs = Needs::Nothing;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &Of<Self::Side, T>,
        (other, own): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sum: &mut Of<Components<D>, T>,
    ) {
        let slope = self.kernel.derivative_over_r(D, pair.square.sqrt(), self.smoothing_length);
        let weight = other.mass() * slope * *own;
        for i in 0..D {
            sum[i] += pair.separation[i] * weight;
        }
    }
}
