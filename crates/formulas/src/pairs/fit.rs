//! A linear function that fits what neighbours have, and its value at a particle.

use super::{Components, MovingPair, Of, One, PairLaw, Square, record};
use crate::kernels::Needs;
use crate::{Number, tensor};

record! {
    /// What a particle of fluid has that another resolution takes from it.
    pub struct Flow<D> in FlowSide {
        /// Velocity in m/s.
        pub velocity: Components<D>,
        /// Pressure in Pa.
        pub pressure: One,
    }
}

record! {
    /// Moments of the kernel, with `r_ba = r_b - r_a`.
    pub struct Moments<D> in MomentSums {
        /// `sum W_ab` in m^-D.
        pub weight: One,
        /// `sum r_ba W_ab`.
        pub arm: Components<D>,
        /// `sum r_ba (x) r_ba W_ab`.
        pub spread: Square<D>,
        /// `sum u_b W_ab`.
        pub velocity: Components<D>,
        /// `sum u_b (x) r_ba W_ab`.
        pub velocity_arm: Square<D>,
        /// `sum p_b W_ab`.
        pub pressure: One,
        /// `sum p_b r_ba W_ab`.
        pub pressure_arm: Components<D>,
    }
}

/// The moments of [`Moments`], for particles of one size.
#[derive(Clone, Copy, Debug)]
pub struct LinearFit<const D: usize>;

impl<const D: usize> PairLaw for LinearFit<D> {
    type Pair = MovingPair<D>;
    type Side = FlowSide<D>;
    type Sums = MomentSums<D>;

    const NEEDS: Needs = Needs::Value;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &Of<Self::Side, T>,
        other: &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut Moments<T, D>,
    ) {
        sums.weight += pair.value;
        sums.pressure += other.pressure * pair.value;
        for i in 0..D {
            let arm = -pair.separation[i] * pair.value;
            sums.arm[i] += arm;
            sums.pressure_arm[i] += other.pressure * arm;
            sums.velocity[i] += other.velocity[i] * pair.value;
            for j in 0..D {
                sums.spread[(j, i)] -= pair.separation[j] * arm;
                sums.velocity_arm[(j, i)] += other.velocity[j] * arm;
            }
        }
    }
}

/// The smallest determinant of the spread about the mean, over that of particles all around with the same trace, of
/// which a linear function is told: less is a line of particles, or fewer than a line.
const LEAST: f64 = 1e-3;

impl<const D: usize> Moments<f64, D> {
    /// The value at `r_a` of the linear function that fits best with the weights W, theory (95); the mean where neighbours
    /// do not determine one, and nothing without any.
    pub fn at_centre(&self) -> Option<Flow<f64, D>> {
        if !(self.weight > 0.0) {
            return None;
        }
        let mean = self.arm / self.weight;
        let spread = self.spread - mean * self.arm.transpose();
        let even = (spread.trace() / D as f64).powi(D as i32);
        // What a function has at r_a is its mean less its slope times the mean arm.
        let slope = match tensor::determinant(&spread) > LEAST * even {
            true => tensor::inverse(&spread).map(|inverse| inverse * mean),
            false => None,
        };
        let slope = slope.unwrap_or_else(nalgebra::SVector::zeros);
        let (velocity, pressure) = (self.velocity / self.weight, self.pressure / self.weight);
        let of_velocity = self.velocity_arm - velocity * self.arm.transpose();
        let of_pressure = self.pressure_arm - self.arm * pressure;
        Some(Flow {
            velocity: velocity - of_velocity * slope,
            pressure: pressure - of_pressure.dot(&slope),
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Vector2, Vector3};

    use super::*;
    use crate::pairs::{Moving, Record};

    /// Moments of some neighbours at `places` round a particle at the origin.
    fn moments<const D: usize>(
        places: &[nalgebra::SVector<f64, D>],
        flow: impl Fn(&nalgebra::SVector<f64, D>) -> Flow<f64, D>,
    ) -> Moments<f64, D> {
        let mut sums = MomentSums::<D>::zero();
        for place in places {
            let square = place.norm_squared();
            let value = (1.0 - square).powi(2);
            let pair = Moving { separation: -*place, square, value, slope: 0.0 };
            LinearFit.add(&FlowSide::zero(), &flow(place), &pair, &mut sums);
        }
        sums
    }

    #[test]
    fn a_linear_flow_is_met_even_from_one_side() {
        let flow = |x: &Vector2<f64>| Flow {
            velocity: Vector2::new(1.0 + 2.0 * x.x - x.y, -0.5 + 0.3 * x.x + 4.0 * x.y),
            pressure: 7.0 - 3.0 * x.x + 5.0 * x.y,
        };
        let places = [(0.1, 0.2), (0.4, -0.3), (0.3, 0.5), (0.7, 0.1), (0.15, -0.6)];
        let places = places.map(|(x, y)| Vector2::new(x, y));
        let found = moments(&places, flow).at_centre().expect("there are neighbours");
        let exact = flow(&Vector2::zeros());
        assert!((found.velocity - exact.velocity).norm() < 1e-13);
        assert!((found.pressure - exact.pressure).abs() < 1e-12);

        let flow = |x: &Vector3<f64>| Flow {
            velocity: Vector3::new(x.x, 2.0 - x.z, 1.0 + x.y),
            pressure: 1.0 + x.sum(),
        };
        let places = [
            Vector3::new(0.2, 0.1, 0.3),
            Vector3::new(0.5, -0.2, 0.1),
            Vector3::new(0.3, 0.4, -0.2),
            Vector3::new(0.1, -0.4, -0.5),
            Vector3::new(0.6, 0.3, 0.3),
        ];
        let found = moments(&places, flow).at_centre().expect("there are neighbours");
        assert!((found.velocity - Vector3::new(0.0, 2.0, 1.0)).norm() < 1e-12);
        assert!((found.pressure - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_line_of_neighbours_gives_the_mean_and_none_gives_nothing() {
        let flow = |x: &Vector2<f64>| Flow { velocity: Vector2::new(x.x, x.y), pressure: x.x };
        let line = [Vector2::new(0.1, 0.1), Vector2::new(0.2, 0.2), Vector2::new(0.5, 0.5)];
        let sums = moments(&line, flow);
        let found = sums.at_centre().expect("there are neighbours");
        assert!((found.pressure - sums.pressure / sums.weight).abs() < 1e-15);
        assert!(moments(&[], flow).at_centre().is_none());
    }
}
