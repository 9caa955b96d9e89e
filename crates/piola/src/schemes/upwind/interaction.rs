//! What a particle gets from one neighbour.

use piola_formulas::riemann::Interface;

use super::local::Side;
use super::reconstruction::Slope;
use crate::Vector;

/// The sums of a particle over its neighbours, or the terms of one of them: `T` is `f64`, or
/// [`Lanes`](super::pairs::Lanes) of it while sums grow.
#[derive(Clone, Copy)]
pub(super) struct Gathered<T, const D: usize> {
    /// Internal force in N.
    pub internal: [T; D],
    /// Rate of the deformation gradient, times the volume, in m^D/s.
    pub deformation_rate: [[T; D]; D],
    /// Force of the full velocity dissipation in N.
    pub upwind_force: [T; D],
    /// Volume rate of the full pressure dissipation in m^D/s.
    pub upwind_volume_rate: T,
}

impl<T: Copy, const D: usize> Gathered<T, D> {
    /// All sums at `value`.
    #[inline(always)]
    pub fn uniform(value: T) -> Self {
        Self {
            internal: [value; D],
            deformation_rate: [[value; D]; D],
            upwind_force: [value; D],
            upwind_volume_rate: value,
        }
    }
}

/// A particle a, its neighbour b, and where they stand to each other.
pub(super) struct Pair<'a, const D: usize> {
    /// Particle a.
    pub me: &'a Side<D>,
    /// Particle b.
    pub other: &'a Side<D>,
    /// Area `V_a G_ab` in m^(D-1).
    pub area: Vector<D>,
    /// Area `V_b G_ba` in m^(D-1).
    pub transposed: Vector<D>,
    /// Current separation `x_b - x_a` in m.
    pub current: Vector<D>,
    /// Reference separation `X_b - X_a` in m.
    pub reference: Vector<D>,
    /// Slopes at a and b where states are reconstructed at the interface.
    pub slopes: Option<[&'a Slope<D>; 2]>,
}

impl<const D: usize> Pair<'_, D> {
    /// The terms of b in the sums of a, with the dissipation of velocity and of pressure, theory
    /// (12) and (13), or without. Its antisymmetric areas let b lose what a receives.
    #[inline(always)]
    pub fn terms<const VELOCITY: bool, const PRESSURE: bool>(&self) -> Gathered<f64, D> {
        let (me, other) = (self.me, self.other);
        let mut terms = Gathered::uniform(0.0);
        let mut velocity_jump = other.velocity - me.velocity;
        let mut pressure_jump = other.pressure - me.pressure;
        let other_area = other.cofactor * self.transposed;
        terms.internal = (other_area * other.pressure).into();
        for i in 0..D {
            terms.deformation_rate[i] = (self.area * velocity_jump[i]).into();
        }
        if let Some([mine, theirs]) = self.slopes {
            velocity_jump -= (mine.velocity + theirs.velocity) * self.reference * 0.5;
            pressure_jump -= (mine.pressure + theirs.pressure).dot(&self.reference) * 0.5;
        }
        if VELOCITY || PRESSURE {
            let impedance = 0.5
                * (me.density + other.density)
                * if me.wave_speed > other.wave_speed { me.wave_speed } else { other.wave_speed };
            let interface = Interface::new(self.current, self.reference);
            if VELOCITY {
                let area = self.area - self.transposed;
                terms.upwind_force = interface.force(impedance, &velocity_jump, &area).into();
            }
            if PRESSURE {
                let mine = me.cofactor.tr_mul(&self.current);
                let theirs = other.cofactor.tr_mul(&self.current);
                let d2 = self.current.norm_squared();
                let k = 1.0 / (d2 * self.reference.norm() * impedance * 4.0);
                terms.upwind_volume_rate = -(pressure_jump
                    * k
                    * (mine + theirs).dot(&self.reference)
                    * (mine.dot(&self.area) - self.current.dot(&other_area)));
            }
        }
        terms
    }
}
