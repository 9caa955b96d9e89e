//! What ghost particles of walls take from the particles around them. Paper: CTVF, section 2.4.

use super::fluid::FluidSide;
use super::solid::MATTER;
use super::{Components, Many, MovingPair, Of, One, PairLaw, difference, dot, record};
use crate::Number;
use crate::kernels::Needs;

record! {
    /// Sums of what is around a wall particle, weighted with the kernel.
    pub struct Around<D> in Surroundings {
        /// `sum W_ab` in m^-D.
        pub weight: One,
        /// `sum u_b W_ab`.
        pub velocity: Components<D>,
        /// `sum d_b W_ab`.
        pub deviation: Components<D>,
        /// `sum p_b W_ab`.
        pub pressure: One,
        /// `sum rho_b r_ab W_ab`.
        pub arm: Components<D>,
    }
}

/// What a wall particle takes from the fluid around it.
#[derive(Clone, Copy, Debug)]
pub struct Ghost<T: Number, const D: usize> {
    /// Deviation of the fluid there in m/s.
    pub carried: Of<Components<D>, T>,
    /// Its own velocity, that of the fluid reflected, in m/s.
    pub velocity: Of<Components<D>, T>,
    /// Its own deviation, the reflected transport velocity less that, in m/s.
    pub deviation: Of<Components<D>, T>,
    /// The velocity that viscous forces see at a wall that does not let slip, in m/s.
    pub dragged: Of<Components<D>, T>,
    /// Its pressure in Pa.
    pub pressure: T,
}

impl<T: Number, const D: usize> Around<T, D> {
    /// The ghost, CTVF (48) to (52), of a wall that moves with a velocity and slides with another one besides
    /// in m/s, under a body force less its own acceleration in m/s^2, with a unit normal. Without fluid around
    /// it is not a number.
    #[inline(always)]
    pub fn ghost(
        &self,
        [motion, sliding]: [&Of<Components<D>, T>; 2],
        lift: &Of<Components<D>, T>,
        normal: &Of<Components<D>, T>,
    ) -> Ghost<T, D> {
        let (velocity, carried) = (self.velocity / self.weight, self.deviation / self.weight);
        let two = T::from(2.0);
        // A surface that slides goes nowhere: at corners, where the normal is between two faces,
        // it must not push.
        let approach = difference(motion, &velocity);
        Ghost {
            carried,
            velocity: velocity + normal * (two * dot(&approach, normal)),
            // The reflected uhat less the reflected u, CTVF (49) less (48).
            deviation: difference(&carried, &(normal * (two * dot(&carried, normal)))),
            dragged: difference(&((motion + sliding) * two), &velocity),
            pressure: (self.pressure + dot(lift, &self.arm)) / self.weight,
        }
    }
}

/// The sums of CTVF (46), (47) and (52).
#[derive(Clone, Copy, Debug)]
pub struct Extrapolation<const D: usize>;

impl<const D: usize> PairLaw for Extrapolation<D> {
    type Pair = MovingPair<D>;
    type Side = FluidSide<D>;
    type Sums = Surroundings<D>;

    const NEEDS: Needs = Needs::Value;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &Of<Self::Side, T>,
        other: &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut Around<T, D>,
    ) {
        let weight = other.density * pair.value;
        sums.weight += pair.value;
        sums.pressure += other.pressure * pair.value;
        for i in 0..D {
            sums.velocity[i] += other.velocity[i] * pair.value;
            sums.deviation[i] += other.deviation[i] * pair.value;
            sums.arm[i] += pair.separation[i] * weight;
        }
    }
}

/// [`Extrapolation`] with the deviatoric stress of solids, `sum s_b W_ab`, CTVF (53).
#[derive(Clone, Copy, Debug)]
pub struct StressExtrapolation<const D: usize>;

impl<const D: usize> PairLaw for StressExtrapolation<D> {
    type Pair = MovingPair<D>;
    type Side = (FluidSide<D>, Many<MATTER>);
    type Sums = (Surroundings<D>, Many<6>);

    const NEEDS: Needs = Needs::Value;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (me, _): &Of<Self::Side, T>,
        (other, matter): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        (around, deviator): &mut Of<Self::Sums, T>,
    ) {
        Extrapolation.add(me, other, pair, around);
        for k in 0..6 {
            deviator[k] += pair.value * matter[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::*;

    /// Half way between a fluid and its ghost is the wall: it lets nothing through, and without slip
    /// nothing slides along it.
    #[test]
    fn a_wall_stands_between_a_fluid_and_its_ghost() {
        let (velocity, carried) = (Vector2::new(0.7, -0.4), Vector2::new(0.02, 0.05));
        let (motion, sliding) = (Vector2::new(0.1, 0.3), Vector2::new(-0.6, 0.2));
        let (normal, weight) = (Vector2::new(0.6, 0.8), 2.5);
        let around = Around {
            weight,
            velocity: velocity * weight,
            deviation: carried * weight,
            pressure: 40.0 * weight,
            arm: Vector2::new(0.0, -0.5) * 1000.0 * weight,
        };
        let ghost = around.ghost([&motion, &sliding], &Vector2::new(0.0, -9.0), &normal);
        let along = Vector2::new(-normal.y, normal.x);
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-13, "{a} {b}");
        near((ghost.velocity + velocity).dot(&normal), 2.0 * motion.dot(&normal));
        near(ghost.velocity.dot(&along), velocity.dot(&along));
        near((ghost.deviation + carried).dot(&normal), 0.0);
        near((ghost.dragged + velocity - (motion + sliding) * 2.0).norm(), 0.0);
        // Half a metre below fluid of 1000 kg/m^3 under 9 m/s^2.
        near(ghost.pressure, 40.0 + 4500.0);
        near((ghost.carried - carried).norm(), 0.0);
    }
}
