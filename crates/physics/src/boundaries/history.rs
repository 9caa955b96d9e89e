//! A factor that a table gives over time.

use std::sync::Arc;

use super::SpaceTime;

/// A factor over time: straight lines between points, and the first and the last value before and
/// after them.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    times: Vec<f64>,
    factors: Vec<f64>,
}

impl History {
    /// The factor through points at ascending times in s; `None` if there is no point, or not a factor
    /// for each time, or the times do not ascend.
    pub fn new(times: Vec<f64>, factors: Vec<f64>) -> Option<Self> {
        let ascends = times.windows(2).all(|pair| pair[0] < pair[1]);
        let fits = !times.is_empty() && times.len() == factors.len() && ascends;
        fits.then_some(Self { times, factors })
    }

    /// The factor at time `t` in s.
    pub fn at(&self, t: f64) -> f64 {
        let next = self.times.partition_point(|time| *time <= t);
        match (next.checked_sub(1), self.times.get(next)) {
            (None, _) => self.factors[0],
            (Some(last), None) => self.factors[last],
            (Some(last), Some(_)) => self.factors[last] + self.slope(last) * (t - self.times[last]),
        }
    }

    /// Its rate in 1/s, at a point that of the line behind it.
    pub fn rate(&self, t: f64) -> f64 {
        let next = self.times.partition_point(|time| *time <= t);
        if next == 0 || next == self.times.len() { 0.0 } else { self.slope(next - 1) }
    }

    fn slope(&self, first: usize) -> f64 {
        let [rise, run] = [&self.factors, &self.times].map(|it| it[first + 1] - it[first]);
        rise / run
    }
}

/// A value times a factor by the distance from a point within a plane: a profile over the height of a channel, or
/// over the radius of a pipe.
pub struct Profiled {
    /// The value.
    pub value: Arc<dyn SpaceTime>,
    /// The factor, against the distance in m in place of the time.
    pub profile: Arc<History>,
    /// The point in m.
    pub from: [f64; 3],
    /// Unit normal of the plane.
    pub normal: [f64; 3],
}

impl Profiled {
    fn factor(&self, x: [f64; 3]) -> f64 {
        let way: [f64; 3] = std::array::from_fn(|axis| x[axis] - self.from[axis]);
        let along: f64 = way.iter().zip(&self.normal).map(|(x, n)| x * n).sum();
        let within = way.iter().zip(&self.normal).map(|(x, n)| x - along * n);
        self.profile.at(within.map(|x| x * x).sum::<f64>().sqrt())
    }
}

impl SpaceTime for Profiled {
    fn value(&self, x: [f64; 3], t: f64) -> f64 {
        self.value.value(x, t) * self.factor(x)
    }

    fn rate(&self, x: [f64; 3], t: f64) -> f64 {
        self.value.rate(x, t) * self.factor(x)
    }

    fn is_steady(&self) -> bool {
        self.value.is_steady()
    }
}

/// A value times a factor over time.
pub struct Scaled {
    /// The value.
    pub value: Arc<dyn SpaceTime>,
    /// The factor.
    pub history: Arc<History>,
}

impl SpaceTime for Scaled {
    fn value(&self, x: [f64; 3], t: f64) -> f64 {
        self.value.value(x, t) * self.history.at(t)
    }

    fn rate(&self, x: [f64; 3], t: f64) -> f64 {
        self.value.rate(x, t) * self.history.at(t) + self.value.value(x, t) * self.history.rate(t)
    }

    fn is_steady(&self) -> bool {
        false
    }

    fn is_uniform(&self) -> bool {
        self.value.is_uniform()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_history_is_straight_between_its_points_and_held_beyond_them() {
        let history = History::new(vec![1.0, 2.0, 4.0], vec![0.5, 1.0, -1.0]).unwrap();
        let cases = [
            (0.0, 0.5, 0.0),
            (1.0, 0.5, 0.5),
            (1.5, 0.75, 0.5),
            (2.0, 1.0, -1.0),
            (3.5, -0.5, -1.0),
            (4.0, -1.0, 0.0),
            (9.0, -1.0, 0.0),
        ];
        for (t, factor, rate) in cases {
            assert_eq!((history.at(t), history.rate(t)), (factor, rate), "at {t}");
        }
        assert_eq!(History::new(vec![1.0], vec![3.0]).unwrap().at(0.0), 3.0);
        assert_eq!(History::new(Vec::new(), Vec::new()), None);
        assert_eq!(History::new(vec![0.0, 0.0], vec![1.0, 2.0]), None);
        assert_eq!(History::new(vec![0.0, 1.0], vec![1.0]), None);
    }

    #[test]
    fn the_rate_of_a_product_is_that_of_both_factors() {
        struct Square;
        impl SpaceTime for Square {
            fn value(&self, _x: [f64; 3], t: f64) -> f64 {
                t * t
            }
            fn rate(&self, _x: [f64; 3], t: f64) -> f64 {
                2.0 * t
            }
            fn is_steady(&self) -> bool {
                false
            }
        }
        let history = Arc::new(History::new(vec![0.0, 4.0], vec![1.0, 3.0]).unwrap());
        let scaled = Scaled { value: Arc::new(Square), history };
        // t^2 (1 + t/2)
        assert_eq!(scaled.value([0.0; 3], 2.0), 8.0);
        assert_eq!(scaled.rate([0.0; 3], 2.0), 10.0);
    }
}
