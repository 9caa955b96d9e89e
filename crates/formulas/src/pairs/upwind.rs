//! Pair laws of the upwind formulation, on frozen lists. Paper: Upwind, equations (3.39) to (3.53).

use nalgebra::{SMatrix, SVector};

use super::{
    AreaPair, Areas, Components, Frozen, Of, One, PairLaw, Periods, Square, applied, difference,
    dot, record,
};
use crate::Number;
use crate::kernels::Needs;
use crate::riemann::Interface;

record! {
    /// What neighbours gather of a particle, in one place so that a neighbour costs one stretch of
    /// memory, which begins with a cache line so that it takes as few of them as can be.
    #[repr(align(64))]
    pub struct Side<D> in UpwindSide {
        /// Current position x in m.
        pub position: Components<D>,
        /// Reference position X in m.
        pub reference: Components<D>,
        /// Velocity v in m/s.
        pub velocity: Components<D>,
        /// Cofactor `H = det(F) F^-T` of the deformation gradient.
        pub cofactor: Square<D>,
        /// Pressure p(J) of the evolved J in Pa.
        pub pressure: One,
        /// Reference density in kg/m^3.
        pub density: One,
        /// Speed of the shock in the dissipation in m/s.
        pub wave_speed: One,
    }
}

record! {
    /// Least-squares gradients of the reconstructed fields with respect to X.
    ///
    /// The paper reconstructs the stress P; here it is the pressure, which with the averaged
    /// cofactor gives the same flux and takes one gradient instead of `D * D`.
    #[repr(align(64))]
    pub struct Slope<D> in UpwindSlope {
        /// Gradient of the velocity in 1/s.
        pub velocity: Square<D>,
        /// Gradient of the pressure in Pa/m.
        pub pressure: Components<D>,
    }
}

record! {
    /// What [`Exchange`] sums.
    pub struct ExchangeSums<D> in ExchangeSum {
        /// Internal force in N, without the particle's own share.
        pub internal_force: Components<D>,
        /// Rate of the deformation gradient times the volume, in m^D/s.
        pub volume_deformation_rate: Square<D>,
        /// Force of the full velocity dissipation in N.
        pub upwind_force: Components<D>,
        /// Volume rate of the full pressure dissipation in m^D/s.
        pub upwind_volume_rate: One,
    }
}

/// The sums of theory (8) to (10) over neighbours, without b = a in the first, and the exchanges of
/// theory (12) and (13) where `VELOCITY` or `PRESSURE` is dissipated. Terms that are off are not formed.
#[derive(Clone, Copy, Debug)]
pub struct Exchange<const D: usize, const VELOCITY: bool, const PRESSURE: bool>(pub Periods<D>);

impl<const D: usize, const VELOCITY: bool, const PRESSURE: bool> Exchange<D, VELOCITY, PRESSURE> {
    /// Adds the terms of a neighbour, with jumps that are reconstructed where there are slopes.
    #[inline(always)]
    fn add_with<T: Number>(
        &self,
        [me, other]: [&Side<T, D>; 2],
        pair: &Areas<T, D>,
        sums: &mut ExchangeSums<T, D>,
        slopes: Option<[&Slope<T, D>; 2]>,
    ) {
        let mut velocity_jump = difference(&other.velocity, &me.velocity);
        let mut pressure_jump = other.pressure - me.pressure;
        let internal_force = applied(&other.cofactor, &pair.transposed);
        for i in 0..D {
            sums.internal_force[i] += internal_force[i] * other.pressure;
            for j in 0..D {
                sums.volume_deformation_rate[(i, j)] += velocity_jump[i] * pair.area[j];
            }
        }
        if !(VELOCITY || PRESSURE) {
            return;
        }
        let current = self.0.way(&me.position, &other.position);
        let reference = self.0.way(&me.reference, &other.reference);
        if let Some([mine, theirs]) = slopes {
            let (mut half, mut velocity, mut pressure) = (reference, mine.velocity, mine.pressure);
            for i in 0..D {
                half[i] *= T::from(0.5);
                pressure[i] += theirs.pressure[i];
                for j in 0..D {
                    velocity[(i, j)] += theirs.velocity[(i, j)];
                }
            }
            velocity_jump = difference(&velocity_jump, &applied(&velocity, &half));
            pressure_jump -= dot(&pressure, &half);
        }
        // Mean density times the larger wave speed.
        let faster = other.wave_speed.less(me.wave_speed);
        let fastest = T::select(faster, me.wave_speed, other.wave_speed);
        let impedance = fastest * ((me.density + other.density) * 0.5);
        let interface = Interface::new(current, reference, impedance);
        if VELOCITY {
            let area = difference(&pair.area, &pair.transposed);
            let force = interface.force(&velocity_jump, &area);
            for i in 0..D {
                sums.upwind_force[i] += force[i];
            }
        }
        if PRESSURE {
            let cofactors = [&me.cofactor, &other.cofactor];
            let areas = [&pair.area, &pair.transposed];
            sums.upwind_volume_rate += interface.volume_rate(pressure_jump, cofactors, areas);
        }
    }
}

impl<const D: usize, const VELOCITY: bool, const PRESSURE: bool> PairLaw
    for Exchange<D, VELOCITY, PRESSURE>
{
    type Pair = Frozen<AreaPair<D>>;
    type Side = UpwindSide<D>;
    type Sums = ExchangeSum<D>;

    const NEEDS: Needs = Needs::Nothing;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        me: &Side<T, D>,
        other: &Side<T, D>,
        (pair, _): &Of<Self::Pair, T>,
        sums: &mut ExchangeSums<T, D>,
    ) {
        self.add_with([me, other], pair, sums, None);
    }
}

/// An [`Exchange`] of jumps that are reconstructed at the middle of a pair from the slopes beside the
/// sides, Upwind (3.50).
#[derive(Clone, Copy, Debug)]
pub struct Reconstructed<L>(pub L);

impl<const D: usize, const VELOCITY: bool, const PRESSURE: bool> PairLaw
    for Reconstructed<Exchange<D, VELOCITY, PRESSURE>>
{
    type Pair = Frozen<AreaPair<D>>;
    type Side = (UpwindSide<D>, UpwindSlope<D>);
    type Sums = ExchangeSum<D>;

    const NEEDS: Needs = Needs::Nothing;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (me, mine): &Of<Self::Side, T>,
        (other, theirs): &Of<Self::Side, T>,
        (pair, _): &Of<Self::Pair, T>,
        sums: &mut ExchangeSums<T, D>,
    ) {
        self.0.add_with([me, other], pair, sums, Some([mine, theirs]));
    }
}

/// `sum_b (u_b - u_a) (x) d_ab / |d_ab|^2` of velocity and pressure, theory (4), which inverse moments turn
/// into their slopes.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<const D: usize>(pub Periods<D>);

impl<const D: usize> PairLaw for Slopes<D> {
    type Pair = Frozen<AreaPair<D>>;
    type Side = UpwindSide<D>;
    type Sums = UpwindSlope<D>;

    const NEEDS: Needs = Needs::Nothing;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        me: &Side<T, D>,
        other: &Side<T, D>,
        (_, counts): &Of<Self::Pair, T>,
        sums: &mut Slope<T, D>,
    ) {
        let separation = self.0.way(&me.reference, &other.reference);
        let weight = *counts / dot(&separation, &separation);
        let velocity_jump = difference(&other.velocity, &me.velocity);
        let pressure_jump = other.pressure - me.pressure;
        for j in 0..D {
            let weighted = separation[j] * weight;
            for i in 0..D {
                sums.velocity[(i, j)] += velocity_jump[i] * weighted;
            }
            sums.pressure[j] += weighted * pressure_jump;
        }
    }
}

/// `sum_b (v_b - v_a) (x) V_a G_ab`, the gradient of a vector times the volume, theory (10).
#[derive(Clone, Copy, Debug)]
pub struct Gradient<const D: usize>;

impl<const D: usize> PairLaw for Gradient<D> {
    type Pair = Frozen<AreaPair<D>>;
    type Side = Components<D>;
    type Sums = Square<D>;

    const NEEDS: Needs = Needs::Nothing;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        me: &SVector<T, D>,
        other: &SVector<T, D>,
        (pair, _): &Of<Self::Pair, T>,
        sums: &mut SMatrix<T, D, D>,
    ) {
        let jump = difference(other, me);
        for j in 0..D {
            for i in 0..D {
                sums[(i, j)] += jump[i] * pair.area[j];
            }
        }
    }
}

/// `sum_b S_b V_b G_ba`, the adjoint of [`Gradient`]: the force of a stress, theory (8), without b = a.
#[derive(Clone, Copy, Debug)]
pub struct Divergence<const D: usize>;

impl<const D: usize> PairLaw for Divergence<D> {
    type Pair = Frozen<AreaPair<D>>;
    type Side = Square<D>;
    type Sums = Components<D>;

    const NEEDS: Needs = Needs::Nothing;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &SMatrix<T, D, D>,
        other: &SMatrix<T, D, D>,
        (pair, _): &Of<Self::Pair, T>,
        sums: &mut SVector<T, D>,
    ) {
        let force = applied(other, &pair.transposed);
        for i in 0..D {
            sums[i] += force[i];
        }
    }
}
