//! What a particle gets from one neighbour.

use nalgebra::{SMatrix, SVector};
use piola_formulas::Number;
use piola_formulas::riemann::Interface;

use super::gather::Sums;
use super::local::Side;
use super::reconstruction::Slope;
use crate::Vector;

/// A particle a, its neighbour b, and where they stand to each other, in numbers `T`: `f64`, or dual
/// numbers for the tangent of implicit steps.
pub(super) struct Pair<'a, T, const D: usize> {
    /// Particle a.
    pub me: &'a Side<T, D>,
    /// Particle b.
    pub other: &'a Side<T, D>,
    /// Area `V_a G_ab` in m^(D-1).
    pub area: Vector<D>,
    /// Area `V_b G_ba` in m^(D-1).
    pub transposed: Vector<D>,
    /// Current separation `x_b - x_a` in m.
    pub current: SVector<T, D>,
    /// Reference separation `X_b - X_a` in m.
    pub reference: Vector<D>,
    /// Slopes at a and b.
    pub slopes: [&'a Slope<T, D>; 2],
}

impl<T: Number, const D: usize> Pair<'_, T, D> {
    /// Adds the terms of b in the sums of a to those of one lane: the exchanges of theory (12) and
    /// (13) where dissipation of velocity or pressure is on, with reconstructed jumps if asked.
    ///
    /// It is always inlined: a loop over lanes without calls and conditions is what the compiler
    /// turns into operations on vectors. Terms that are off are not formed at all, and the slopes
    /// not read without reconstruction.
    #[inline(always)]
    pub fn add_terms<
        const VELOCITY: bool,
        const PRESSURE: bool,
        const RECONSTRUCTION: bool,
        const N: usize,
    >(
        &self,
        lane: usize,
        sums: &mut Sums<[T; N], D>,
    ) {
        let (me, other) = (self.me, self.other);
        let mut velocity_jump = other.velocity - me.velocity;
        let mut pressure_jump = other.pressure - me.pressure;
        let internal_force = applied(&other.cofactor, &self.transposed);
        for i in 0..D {
            sums.internal_force[i][lane] += internal_force[i] * other.pressure;
            for j in 0..D {
                sums.volume_deformation_rate[i][j][lane] += velocity_jump[i] * self.area[j];
            }
        }
        if !(VELOCITY || PRESSURE) {
            return;
        }
        if RECONSTRUCTION {
            let [mine, theirs] = self.slopes;
            let half = self.reference * 0.5;
            velocity_jump -= applied(&(mine.velocity + theirs.velocity), &half);
            pressure_jump -= along(&(mine.pressure + theirs.pressure), &half);
        }
        let interface = Interface::new(self.current, self.reference, self.impedance());
        if VELOCITY {
            let force = interface.force(&velocity_jump, &(self.area - self.transposed));
            for i in 0..D {
                sums.upwind_force[i][lane] += force[i];
            }
        }
        if PRESSURE {
            let cofactors = [&me.cofactor, &other.cofactor];
            let areas = [&self.area, &self.transposed];
            sums.upwind_volume_rate[lane] += interface.volume_rate(pressure_jump, cofactors, areas);
        }
    }

    /// Mean density times the larger wave speed. A plain comparison is one operation on vectors,
    /// which `f64::max` with its care for NaN is not.
    #[inline(always)]
    fn impedance(&self) -> T {
        let [mine, theirs] = [self.me.wave_speed, self.other.wave_speed];
        let fastest = T::select(theirs.less(mine), mine, theirs);
        fastest * (0.5 * (self.me.density + self.other.density))
    }
}

/// `matrix vector`.
#[inline(always)]
pub(super) fn applied<T: Number, const D: usize>(
    matrix: &SMatrix<T, D, D>,
    vector: &Vector<D>,
) -> SVector<T, D> {
    SVector::from_fn(|i, _| {
        let mut sum = matrix[(i, 0)] * vector[0];
        for j in 1..D {
            sum += matrix[(i, j)] * vector[j];
        }
        sum
    })
}

/// `a . b`.
#[inline(always)]
fn along<T: Number, const D: usize>(a: &SVector<T, D>, b: &Vector<D>) -> T {
    let mut sum = a[0] * b[0];
    for i in 1..D {
        sum += a[i] * b[i];
    }
    sum
}
