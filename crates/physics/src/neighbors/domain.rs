//! Space with or without periodic axes.

use super::NeighborError;
use super::error::axis_name;
use crate::Vector;

/// Space in which particles live: each axis is open, or periodic between two bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain<const D: usize> {
    periodic: [Option<[f64; 2]>; D],
}

impl<const D: usize> Default for Domain<D> {
    fn default() -> Self {
        Self::open()
    }
}

impl<const D: usize> Domain<D> {
    /// Space without periodic axes.
    pub const fn open() -> Self {
        Self { periodic: [None; D] }
    }

    /// Space in which axis `i` is periodic between the bounds `periodic[i]` in m, where given.
    ///
    /// # Errors
    /// [`NeighborError::PeriodicBounds`] where bounds are not finite or not in order.
    pub fn new(periodic: [Option<[f64; 2]>; D]) -> Result<Self, NeighborError> {
        for (axis, bounds) in periodic.iter().enumerate() {
            if let &Some([lower, upper]) = bounds
                && !(lower < upper && lower.is_finite() && (upper - lower).is_finite())
            {
                return Err(NeighborError::PeriodicBounds { axis: axis_name(axis), lower, upper });
            }
        }
        Ok(Self { periodic })
    }

    /// The bounds of each axis in m, `None` where it is open.
    pub fn periodic(&self) -> &[Option<[f64; 2]>; D] {
        &self.periodic
    }

    /// Whether no axis is periodic.
    pub fn is_open(&self) -> bool {
        self.periodic.iter().all(Option::is_none)
    }

    /// Period of each axis in m, infinite where it is open.
    pub(crate) fn periods(&self) -> [f64; D] {
        self.periodic.map(|ends| ends.map_or(f64::INFINITY, |[low, high]| high - low))
    }

    /// The bounds in m between which a point is farther than `margin` m from all periodic ones.
    pub(crate) fn within(&self, margin: f64) -> [[f64; 2]; D] {
        self.periodic.map(|ends| match ends {
            Some([low, high]) => [low + margin, high - margin],
            None => [f64::NEG_INFINITY, f64::INFINITY],
        })
    }

    /// Minimal image of `to - from` in m: along a periodic axis the shortest way round.
    ///
    /// Exchanging the points changes the sign of the result and nothing else, to the bit. Points
    /// exactly half a period apart keep the sign of their difference.
    #[inline]
    pub fn separation(&self, from: &Vector<D>, to: &Vector<D>) -> Vector<D> {
        let mut separation = to - from;
        for (distance, bounds) in separation.iter_mut().zip(&self.periodic) {
            if let &Some([lower, upper]) = bounds {
                *distance = shortest(*distance, upper - lower);
            }
        }
        separation
    }

    /// The image of `point` inside the bounds: at or above the lower, below the upper one.
    pub fn wrap(&self, point: &Vector<D>) -> Vector<D> {
        let mut wrapped = *point;
        for (x, bounds) in wrapped.iter_mut().zip(&self.periodic) {
            if let &Some([lower, upper]) = bounds
                && !(lower <= *x && *x < upper)
            {
                *x = lower + (*x - lower).rem_euclid(upper - lower);
                // The remainder can round up to the whole period.
                if *x >= upper {
                    *x = lower;
                }
            }
        }
        wrapped
    }
}

/// The shortest of `distance + n * period` over whole `n`.
#[inline]
pub(super) fn shortest(distance: f64, period: f64) -> f64 {
    let half = 0.5 * period;
    if distance.abs() <= half {
        return distance;
    }
    let rest = distance % period;
    if rest > half {
        rest - period
    } else if rest < -half {
        rest + period
    } else {
        rest
    }
}

/// [`shortest`] between points that are both inside the bounds of a period, without a branch.
#[inline(always)]
pub(crate) fn shorter_way(distance: f64, period: f64) -> f64 {
    let half = 0.5 * period;
    let down = if distance > half { distance - period } else { distance };
    if distance < -half { distance + period } else { down }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn unit() -> Domain<2> {
        Domain::new([Some([0.0, 1.0]), None]).unwrap()
    }

    #[test]
    fn separation_takes_the_shortest_way_round() {
        let from = Vector::<2>::new(0.1, 0.1);
        let to = Vector::<2>::new(0.9, 0.9);
        let expected = Vector::<2>::new(-0.2, 0.8);
        assert!((unit().separation(&from, &to) - expected).norm() < 1e-15);
        assert!((Domain::open().separation(&from, &to) - (to - from)).norm() == 0.0);
    }

    #[test]
    fn the_upper_bound_is_the_lower_one() {
        assert_eq!(unit().wrap(&Vector::<2>::new(1.0, 1.0)), Vector::<2>::new(0.0, 1.0));
        assert_eq!(unit().wrap(&Vector::<2>::new(-1e-300, 0.0)).x, 0.0);
    }

    #[test]
    fn bounds_that_are_no_interval_are_refused() {
        for bounds in
            [[1.0, 1.0], [1.0, 0.0], [f64::NAN, 1.0], [0.0, f64::INFINITY], [-1e308, 1e308]]
        {
            let error = Domain::<2>::new([None, Some(bounds)]).unwrap_err();
            assert!(error.to_string().contains("periodic in y"), "{error}");
        }
    }

    proptest! {
        #[test]
        fn separation_is_antisymmetric_short_and_right_modulo_the_period(
            from in -5.0..5.0f64, to in -5.0..5.0f64, lower in -3.0..3.0f64, length in 0.1..4.0f64,
        ) {
            let domain = Domain::<1>::new([Some([lower, lower + length])]).unwrap();
            let [from, to] = [Vector::<1>::new(from), Vector::<1>::new(to)];
            let there = domain.separation(&from, &to).x;
            prop_assert_eq!(there.to_bits(), (-domain.separation(&to, &from)).x.to_bits());
            prop_assert!(there.abs() <= 0.5 * length * (1.0 + 1e-12));
            let turns = (there - (to - from).x) / length;
            prop_assert!((turns - turns.round()).abs() < 1e-10);
        }

        #[test]
        fn wrapping_lands_inside_and_moves_by_whole_periods(
            x in -1e3..1e3f64, lower in -3.0..3.0f64, length in 0.1..4.0f64,
        ) {
            let domain = Domain::<1>::new([Some([lower, lower + length])]).unwrap();
            let wrapped = domain.wrap(&Vector::<1>::new(x));
            prop_assert!(lower <= wrapped.x && wrapped.x < lower + length);
            let turns = (wrapped.x - x) / length;
            prop_assert!((turns - turns.round()).abs() < 1e-9);
            prop_assert_eq!(domain.wrap(&wrapped), wrapped);
        }
    }
}
