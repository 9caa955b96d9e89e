//! A function that fits what neighbours have, linear and curved alike along all axes, and its value at a particle.

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
        /// `sum r_ba^2 W_ab`.
        pub square: One,
        /// `sum r_ba^2 r_ba W_ab`.
        pub square_arm: Components<D>,
        /// `sum r_ba^4 W_ab`.
        pub fourth: One,
        /// `sum u_b r_ba^2 W_ab`.
        pub velocity_square: Components<D>,
        /// `sum p_b r_ba^2 W_ab`.
        pub pressure_square: One,
    }
}

/// The moments of [`Moments`], for particles of one size.
#[derive(Clone, Copy, Debug)]
pub struct Fit<const D: usize>;

impl<const D: usize> PairLaw for Fit<D> {
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
        let square = pair.square * pair.value;
        sums.weight += pair.value;
        sums.square += square;
        sums.fourth += pair.square * square;
        sums.pressure += other.pressure * pair.value;
        sums.pressure_square += other.pressure * square;
        for i in 0..D {
            let arm = -pair.separation[i] * pair.value;
            sums.arm[i] += arm;
            sums.pressure_arm[i] += other.pressure * arm;
            sums.velocity[i] += other.velocity[i] * pair.value;
            sums.velocity_square[i] += other.velocity[i] * square;
            sums.square_arm[i] += pair.square * arm;
            for j in 0..D {
                sums.spread[(j, i)] -= pair.separation[j] * arm;
                sums.velocity_arm[(j, i)] += other.velocity[j] * arm;
            }
        }
    }
}

/// The smallest determinant of the spread about the mean, over that of particles all around with the same trace, of
/// which a slope is told: less is a line of particles, or fewer than a line.
const LEAST: f64 = 1e-3;

/// The smallest spread about the mean, over that about the particle, of which a slope is told. Of one neighbour, or of several
/// in one place, it is round-off, 1e-16; where it is larger than this, round-off changes it by 1e-6 of itself at most.
const LEAST_SPREAD: f64 = 1e-10;

/// The smallest part of the squares of distances that a linear function of places may leave over if a curvature is to be
/// told: all around a particle it leaves nearly all of them.
const LEAST_CURVED: f64 = 0.1;

/// Moments of one number about its mean.
struct About<const D: usize> {
    mean: f64,
    /// With places.
    arm: nalgebra::SVector<f64, D>,
    /// With squares of distances.
    square: f64,
}

impl<const D: usize> Moments<f64, D> {
    /// The value at `r_a` of the function `f + g . r + c r^2` that fits best with the weights W, theory (95): without the
    /// curvature c, or without the slope g, where neighbours do not determine them, and nothing without any.
    pub fn at_centre(&self) -> Option<Flow<f64, D>> {
        if !(self.weight > 0.0) {
            return None;
        }
        let mean = self.arm / self.weight;
        let spread = self.spread - mean * self.arm.transpose();
        let even = (spread.trace() / D as f64).powi(D as i32);
        let is_spread = spread.trace() > LEAST_SPREAD * self.spread.trace()
            && tensor::determinant(&spread) > LEAST * even;
        let inverse = if is_spread { tensor::inverse(&spread) } else { None };
        let about = |sum: f64, arm: nalgebra::SVector<f64, D>, square: f64| {
            let mean = sum / self.weight;
            About { mean, arm: arm - self.arm * mean, square: square - self.square * mean }
        };
        let squares = about(self.square, self.square_arm, self.fourth);
        let solved = |arm: &nalgebra::SVector<f64, D>| match &inverse {
            Some(inverse) => inverse * arm,
            None => nalgebra::SVector::zeros(),
        };
        let (to_centre, of_squares) = (solved(&mean), solved(&squares.arm));
        let left = squares.square - squares.arm.dot(&of_squares);
        let is_curved = inverse.is_some() && left > LEAST_CURVED * squares.square;
        // What a linear fit of the squares of distances is at the centre, where they are zero.
        let offset = squares.mean - squares.arm.dot(&to_centre);
        let value = |of: &About<D>| {
            let curvature =
                if is_curved { (of.square - of.arm.dot(&of_squares)) / left } else { 0.0 };
            of.mean - of.arm.dot(&to_centre) - curvature * offset
        };
        let velocity = nalgebra::SVector::from_fn(|i, _| {
            let arm = self.velocity_arm.row(i).transpose();
            value(&about(self.velocity[i], arm, self.velocity_square[i]))
        });
        let pressure = value(&about(self.pressure, self.pressure_arm, self.pressure_square));
        Some(Flow { velocity, pressure })
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
            Fit.add(&FlowSide::zero(), &flow(place), &pair, &mut sums);
        }
        sums
    }

    #[test]
    fn a_linear_flow_is_met_even_from_one_side_and_one_that_is_curved_alike_along_all_axes() {
        let flow = |x: &Vector2<f64>| Flow {
            velocity: Vector2::new(
                1.0 + 2.0 * x.x - x.y,
                -0.5 + 4.0 * x.y + 3.0 * x.norm_squared(),
            ),
            pressure: 7.0 - 3.0 * x.x + 5.0 * x.y - 20.0 * x.norm_squared(),
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

    /// What is left of the spread about the mean is round-off, whose determinant may have any sign.
    #[test]
    fn one_neighbour_gives_what_it_has_however_far_away() {
        let flow = |_: &Vector2<f64>| Flow { velocity: Vector2::new(0.36, 0.02), pressure: 0.18 };
        for k in 0..10_000 {
            let angle = f64::from(k) * 0.01;
            // Down to weights of 4e-14.
            let distance = 1.0 - 10_f64.powf(-0.7 * f64::from(k % 11));
            let place = Vector2::new(angle.cos(), angle.sin()) * distance;
            let found = moments(&[place], flow).at_centre().expect("it is there");
            assert!((found.velocity - flow(&place).velocity).norm() < 1e-15, "{place}");
            assert!((found.pressure - 0.18).abs() < 1e-15, "{place}");
        }
    }

    /// Around a particle of a lattice what is curved otherwise, up and down, or is of third order, cancels.
    #[test]
    fn all_around_a_particle_the_fit_is_of_third_order() {
        let lattice = (-3..=3).flat_map(|i| (-3..=3).map(move |j| (f64::from(i), f64::from(j))));
        let places: Vec<Vector2<f64>> = lattice.map(|(i, j)| Vector2::new(i, j) * 0.3).collect();
        let near: Vec<_> = places.into_iter().filter(|x| x.norm() < 1.0).collect();
        let flow = |x: &Vector2<f64>| Flow {
            velocity: Vector2::new(1.0 + x.x * x.x, 2.0 + x.x * x.y),
            pressure: 3.0 + x.x.powi(3) - x.y * x.y,
        };
        let found = moments(&near, flow).at_centre().expect("there are neighbours");
        assert!((found.velocity - Vector2::new(1.0, 2.0)).norm() < 1e-14);
        assert!((found.pressure - 3.0).abs() < 1e-14);
    }
}
