//! Pair laws of the weakly compressible fluid with gradients that are exact for linear fields, and the forces that are
//! conjugate to them, theory (109) to (112).

use super::fluid::{
    FULL, FluidSide, ForceSum, ForceSums, Forces, RateConstants, RateSums, Side, Wall,
};
use super::{
    Components, MovingPair, Of, One, PairLaw, Square, add_moment, applied, difference, dot, record,
    solid, symmetric,
};
use crate::kernels::Needs;
use crate::{Number, fluid, tensor};

record! {
    /// What a particle shows besides its side.
    pub struct Gradients<D> in GradientSide {
        /// B of theory (109), symmetric; on walls the identity.
        pub correction: Square<D>,
        /// The velocity gradient in 1/s, theory (111); zero on walls.
        pub velocity: Square<D>,
    }
}

impl<T: Number, const D: usize> Gradients<T, D> {
    /// Those of a wall, and of a particle that none are known of yet.
    pub fn none() -> Self {
        let [one, zero] = [T::one(), T::zero()];
        let unit = |i, j| if i == j { one } else { zero };
        Self {
            correction: Of::<Square<D>, T>::from_fn(unit),
            velocity: Of::<Square<D>, T>::from_element(zero),
        }
    }
}

record! {
    /// What [`VelocityGradient`] and [`WallMoment`] sum, of moments the entries with `i <= j`.
    pub struct GradientSums<D> in GradientSum {
        /// `M = - sum V_b r_ab (x) grad W_ab` over the fluid.
        pub fluid: Square<D>,
        /// The same over walls.
        pub walls: Square<D>,
        /// `- sum V_b u_ab (x) grad W_ab` over the fluid, in 1/s.
        pub velocity: Square<D>,
    }
}

impl<T: Number, const D: usize> GradientSums<T, D> {
    /// The correction over fluid and walls, and the velocity gradient over the fluid.
    #[inline]
    pub fn gradients(&self) -> Gradients<T, D> {
        let mut all = self.fluid;
        for i in 0..D {
            for j in i..D {
                all[(i, j)] += self.walls[(i, j)];
            }
        }
        // With the correction of the pressure forces, which is weaker near surfaces, (112) would diffuse linear fields there.
        let velocity = self.velocity * solid::correction(&self.fluid);
        Gradients { correction: correction(&all), velocity }
    }
}

/// The correction of gradients for a moment M, of which the entries with `i <= j` are filled,
///
/// `B = (adj M + w I) / (det M + w)`,  `w = max(0, 1/2 - det M)`,  theory (109).
///
/// It is the inverse where `det M` is at least 1/2, continuous, and finite for all M: on a flat surface, where M is half of
/// the identity, it is 1.5 times the identity in 2D and 1.25 in 3D, and for a particle that has lost its neighbours the
/// identity. In 1D adj M is 1 where M is at least 1/2, and 2 M below.
#[inline]
pub fn correction<T: Number, const D: usize>(moment: &Of<Square<D>, T>) -> Of<Square<D>, T> {
    let moment = symmetric(moment);
    let determinant = tensor::determinant(&moment);
    let missing = T::from(LEAST) - determinant;
    let weight = T::select(missing.above(0.0), missing, T::zero());
    let divisor = determinant + weight;
    let mut adjugate = tensor::cofactor(&moment);
    if D == 1 {
        // Of a number it is 1, which does not vanish with it.
        let share = determinant / T::from(LEAST);
        adjugate[(0, 0)] = T::select(missing.above(0.0), share, T::one());
    }
    Of::<Square<D>, T>::from_fn(|i, j| {
        let unit = if i == j { weight } else { T::zero() };
        (adjugate[(i, j)] + unit) / divisor
    })
}

/// The determinant of the moment below which it is not inverted as it is.
const LEAST: f64 = 0.5;

/// Moments and velocity gradients over the fluid, theory (109) and (111).
#[derive(Clone, Copy, Debug)]
pub struct VelocityGradient<const D: usize>;

impl<const D: usize> PairLaw for VelocityGradient<D> {
    type Pair = MovingPair<D>;
    type Side = FluidSide<D>;
    type Sums = GradientSum<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        me: &Side<T, D>,
        other: &Side<T, D>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut GradientSums<T, D>,
    ) {
        let area = other.volume * pair.slope;
        add_moment(pair, area, &mut sums.fluid);
        let jump = difference(&me.velocity, &other.velocity);
        add_gradient(&jump, pair, area, &mut sums.velocity);
    }
}

/// Moments over walls.
#[derive(Clone, Copy, Debug)]
pub struct WallMoment<const D: usize>;

impl<const D: usize> PairLaw for WallMoment<D> {
    type Pair = MovingPair<D>;
    type Side = FluidSide<D>;
    type Sums = GradientSum<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &Side<T, D>,
        other: &Side<T, D>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut GradientSums<T, D>,
    ) {
        add_moment(pair, other.volume * pair.slope, &mut sums.walls);
    }
}

/// Takes `f_ab (x) r_ab`, times an area, from a gradient.
#[inline(always)]
fn add_gradient<T: Number, const D: usize>(
    jump: &Of<Components<D>, T>,
    pair: &Of<MovingPair<D>, T>,
    area: T,
    gradient: &mut Of<Square<D>, T>,
) {
    for j in 0..D {
        let arm = pair.separation[j] * area;
        for i in 0..D {
            gradient[(i, j)] -= jump[i] * arm;
        }
    }
}

/// `(p_a / rho_a^2 B_a + p_b / rho_b^2 B_b) grad W_ab` of theory (110) with a multiple of the slope of the kernel.
#[inline(always)]
fn pressed<T: Number, const D: usize>(
    [(me, mine), (other, theirs)]: [(&Side<T, D>, &Of<Components<D>, T>); 2],
    slope: T,
) -> Of<Components<D>, T> {
    let mut push = *mine;
    let [own, foreign] = [slope * me.load, slope * other.load];
    for i in 0..D {
        push[i] = mine[i] * own + theirs[i] * foreign;
    }
    push
}

/// The accelerations of a fluid, as [`Forces`] has them, with pressure forces that are conjugate to corrected divergences,
/// theory (110), and the diffusion of what velocity differences have beyond their linear part, (112), which is summed
/// with the artificial viscosity.
///
/// It has the other terms, and nu_v of (111) in m^2/s.
#[derive(Clone, Copy, Debug)]
pub struct CorrectedForces<const D: usize, const ARTIFICIAL: bool, const CROWDING: bool>(
    pub Forces<D, FULL, ARTIFICIAL, CROWDING>,
    pub f64,
);

impl<const D: usize, const ARTIFICIAL: bool, const CROWDING: bool> PairLaw
    for CorrectedForces<D, ARTIFICIAL, CROWDING>
{
    type Pair = MovingPair<D>;
    type Side = (FluidSide<D>, GradientSide<D>);
    type Sums = ForceSum<D>;

    const NEEDS: Needs = <Forces<D, FULL, ARTIFICIAL, CROWDING> as PairLaw>::NEEDS;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (me, own): &Of<Self::Side, T>,
        (other, foreign): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut ForceSums<T, D>,
    ) {
        let slope = other.mass() * pair.slope;
        let mine = applied(&own.correction, &pair.separation);
        let theirs = applied(&foreign.correction, &pair.separation);
        let pressure = pressed([(me, &mine), (other, &theirs)], slope);
        let densities = me.density + other.density;
        let scale = fluid::exchange_scale(densities, pair.square, self.0.0.softening);
        let exchange = fluid::diffusion(self.1, pair.square, slope, scale);
        let jump = difference(&me.velocity, &other.velocity);
        let half = T::from(0.5);
        let [ahead, behind] = [own, foreign].map(|of| applied(&of.velocity, &pair.separation));
        for i in 0..D {
            sums.pressure[i] -= pressure[i];
            let rest = jump[i] - (ahead[i] + behind[i]) * half;
            sums.artificial_viscosity[i] += rest * exchange;
        }
        self.0.resist([me, other], pair, sums);
        self.0.carry([me, other], &mine, pair, sums);
    }
}

/// What walls do to a fluid, in the sums of its [`CorrectedForces`].
#[derive(Clone, Copy, Debug)]
pub struct CorrectedWallForces<const D: usize, const ARTIFICIAL: bool, const CROWDING: bool>(
    pub CorrectedForces<D, ARTIFICIAL, CROWDING>,
);

impl<const D: usize, const ARTIFICIAL: bool, const CROWDING: bool> PairLaw
    for CorrectedWallForces<D, ARTIFICIAL, CROWDING>
{
    type Pair = MovingPair<D>;
    type Side = ((FluidSide<D>, Components<D>), GradientSide<D>);
    type Sums = ForceSum<D>;

    const NEEDS: Needs = <Forces<D, FULL, ARTIFICIAL, CROWDING> as PairLaw>::NEEDS;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        ((me, _), own): &Of<Self::Side, T>,
        ((other, shear), foreign): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut ForceSums<T, D>,
    ) {
        let wall = CorrectedWall(Wall::of(&self.0.0.0));
        let jump = difference(&me.velocity, shear);
        wall.act([(me, own), (other, foreign)], &jump, pair, &mut sums.walls);
        let mine = applied(&own.correction, &pair.separation);
        self.0.0.carry([me, other], &mine, pair, sums);
    }
}

/// What a fluid does to a wall particle, as [`Wall`] has it, with the pressure forces of theory (110).
#[derive(Clone, Copy, Debug)]
pub struct CorrectedWall<const D: usize>(pub Wall<D>);

impl<const D: usize> CorrectedWall<D> {
    /// Adds the force of another particle, one of the two of a wall, where velocities differ by a `jump` in m/s.
    #[inline(always)]
    pub fn act<T: Number>(
        &self,
        [(me, own), (other, foreign)]: [(&Side<T, D>, &Gradients<T, D>); 2],
        jump: &Of<Components<D>, T>,
        pair: &Of<MovingPair<D>, T>,
        sum: &mut Of<Components<D>, T>,
    ) {
        let mine = applied(&own.correction, &pair.separation);
        let theirs = applied(&foreign.correction, &pair.separation);
        let pressure = pressed([(me, &mine), (other, &theirs)], pair.slope);
        self.0.push([me, other], [jump, &pressure], pair, sum);
    }
}

impl<const D: usize> PairLaw for CorrectedWall<D> {
    type Pair = MovingPair<D>;
    type Side = ((FluidSide<D>, Components<D>), GradientSide<D>);
    type Sums = Components<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        ((me, shear), own): &Of<Self::Side, T>,
        ((other, _), foreign): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sum: &mut Of<Components<D>, T>,
    ) {
        let jump = difference(shear, &other.velocity);
        self.act([(me, own), (other, foreign)], &jump, pair, sum);
    }
}

/// The rates of the pressure, theory (21) with the corrected gradients of (109). `FALLS` says whether there are body
/// forces; beside a side stands half of the body force in m/s^2, as for [`Rates`](super::fluid::Rates).
#[derive(Clone, Copy, Debug)]
pub struct CorrectedRates<const D: usize, const FALLS: bool>(pub RateConstants);

record! {
    /// What [`CorrectedRates`] sums.
    pub struct CorrectedRateSums<D> in CorrectedRateSum {
        /// M of theory (109), the entries with `i <= j`.
        pub moment: Square<D>,
        /// `- sum V_b u_ab (x) grad W_ab` in 1/s.
        pub velocity: Square<D>,
        /// `sum V_b (p_b - p_a) grad W_ab` in Pa/m.
        pub pressure: Components<D>,
        /// Diffusion of the pressure in Pa/s.
        pub pressure_diffusion: One,
    }
}

impl<T: Number, const D: usize> CorrectedRateSums<T, D> {
    /// `div u`, `d . grad p` along the deviation d in m/s, and the diffusion.
    #[inline]
    pub fn rates(&self, deviation: &Of<Components<D>, T>) -> RateSums<T, D> {
        let correction = correction(&self.moment);
        let mut divergence = T::zero();
        for i in 0..D {
            for j in 0..D {
                divergence += self.velocity[(i, j)] * correction[(j, i)];
            }
        }
        let gradient = applied(&correction, &self.pressure);
        RateSums {
            divergence,
            pressure_transport: dot(deviation, &gradient),
            pressure_diffusion: self.pressure_diffusion,
        }
    }
}

impl<const D: usize, const FALLS: bool> PairLaw for CorrectedRates<D, FALLS> {
    type Pair = MovingPair<D>;
    type Side = (FluidSide<D>, Components<D>);
    type Sums = CorrectedRateSum<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (me, half_force): &Of<Self::Side, T>,
        (other, _): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut CorrectedRateSums<T, D>,
    ) {
        let area = other.volume * pair.slope;
        add_moment(pair, area, &mut sums.moment);
        let flow = difference(&me.velocity, &other.velocity);
        add_gradient(&flow, pair, area, &mut sums.velocity);
        let jump = other.pressure - me.pressure;
        for i in 0..D {
            sums.pressure[i] += pair.separation[i] * (area * jump);
        }
        sums.pressure_diffusion -= self.0.exchange::<FALLS, T, D>([me, other], half_force, pair);
    }
}
