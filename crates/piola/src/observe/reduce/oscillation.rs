//! Crossings, period and local extrema, without wiggles.

use super::history::History;
use super::{ReduceError, WIGGLE};

/// A history whose range is below this share of its largest value is constant up to round-off.
const ROUND_OFF: f64 = 1e-12;

/// Where a history passes a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    pub time: f64,
    pub upward: bool,
}

/// A local extremum between two rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LocalExtremum {
    pub time: f64,
    pub value: f64,
}

impl History<'_> {
    /// The smallest movement that is seen.
    fn smallest_movement(&self) -> f64 {
        let [low, high] = self.range();
        (WIGGLE * (high - low)).max(ROUND_OFF * low.abs().max(high.abs()))
    }

    /// Where the history passes `level`: from below a band around it to above, or back. The time
    /// is the middle between the first and the last crossing of the level itself on the way.
    pub fn crossings(&self, level: f64) -> Vec<Crossing> {
        let half_band = 0.5 * self.smallest_movement();
        let mut crossings = Vec::new();
        // The side of the band where the history was last, and its crossings since.
        let mut side = None;
        let mut since: Option<[f64; 2]> = None;
        for (row, &value) in self.values.iter().enumerate() {
            let above = value - level;
            if row > 0 {
                let before = self.values[row - 1] - level;
                if (before >= 0.0) != (above >= 0.0) {
                    let start = self.time[row - 1];
                    let time = start + (self.time[row] - start) * (before / (before - above));
                    since = Some([since.map_or(time, |[first, _]| first), time]);
                }
            }
            if above.abs() <= half_band {
                continue;
            }
            let upward = above > 0.0;
            if let (Some([first, last]), true) = (since, side == Some(!upward)) {
                crossings.push(Crossing { time: 0.5 * (first + last), upward });
            }
            side = Some(upward);
            since = None;
        }
        crossings
    }

    /// The time of change of sign `number`, from 1.
    pub fn zero_time(&self, number: usize) -> Result<f64, ReduceError> {
        let crossings = self.crossings(0.0);
        let found = crossings.len();
        match number.checked_sub(1).and_then(|index| crossings.get(index)) {
            Some(crossing) => Ok(crossing.time),
            None => Err(ReduceError::NoSuchZero { wanted: number, found }),
        }
    }

    /// Where the history passes the middle between smallest and largest value.
    fn middle_crossings(&self) -> Vec<Crossing> {
        let [low, high] = self.range();
        self.crossings(0.5 * low + 0.5 * high)
    }

    /// The first and the last time at which it rises through that middle, one period or more apart.
    pub fn cycles(&self) -> Result<[f64; 2], ReduceError> {
        let crossings = self.middle_crossings();
        let rises: Vec<f64> = crossings
            .iter()
            .filter(|crossing| crossing.upward)
            .map(|crossing| crossing.time)
            .collect();
        match rises[..] {
            [first, .., last] => Ok([first, last]),
            _ => Err(ReduceError::NoPeriod { crossings: crossings.len() }),
        }
    }

    /// The period of the oscillation about the middle between smallest and largest value.
    pub fn period(&self) -> Result<f64, ReduceError> {
        let crossings = self.middle_crossings();
        // Least squares of time against number, with one slope and two offsets.
        let (mut covariance, mut variance) = (0.0, 0.0);
        for upward in [true, false] {
            let same = crossings.iter().filter(|crossing| crossing.upward == upward);
            let times: Vec<f64> = same.map(|crossing| crossing.time).collect();
            let count = times.len() as f64;
            let mean_time = times.iter().sum::<f64>() / count;
            let mean_number = 0.5 * (count - 1.0);
            for (number, time) in times.iter().enumerate() {
                let distance = number as f64 - mean_number;
                covariance += distance * (time - mean_time);
                variance += distance * distance;
            }
        }
        if variance > 0.0 {
            Ok(covariance / variance)
        } else {
            Err(ReduceError::NoPeriod { crossings: crossings.len() })
        }
    }

    /// Local extremum `number`, from 1.
    pub fn extremum(&self, number: usize) -> Result<LocalExtremum, ReduceError> {
        let rows = self.extremal_rows();
        match number.checked_sub(1).and_then(|index| rows.get(index)) {
            Some(&row) => Ok(self.vertex(row)),
            None => Err(ReduceError::NoSuchExtremum { wanted: number, found: rows.len() }),
        }
    }

    /// Rows from which the value moves away far enough on both sides. They alternate between
    /// largest and smallest; of rows with the same value the first counts.
    fn extremal_rows(&self) -> Vec<usize> {
        let movement = self.smallest_movement();
        let values = self.values;
        let mut rows = Vec::new();
        // Largest and smallest row since the last extremum, and where the history is heading:
        // unknown until it has moved far enough from the first rows.
        let (mut largest, mut smallest) = (0, 0);
        let mut rising = None;
        for (row, &value) in values.iter().enumerate() {
            if value > values[largest] {
                largest = row;
            }
            if value < values[smallest] {
                smallest = row;
            }
            if rising != Some(true) && value - values[smallest] > movement {
                rows.extend((rising == Some(false)).then_some(smallest));
                rising = Some(true);
                largest = row;
            } else if rising != Some(false) && values[largest] - value > movement {
                rows.extend((rising == Some(true)).then_some(largest));
                rising = Some(false);
                smallest = row;
            }
        }
        rows
    }

    /// The vertex of the parabola through an extremal row and its neighbours.
    fn vertex(&self, row: usize) -> LocalExtremum {
        let [t, v] = [self.time, self.values].map(|all| [all[row - 1], all[row], all[row + 1]]);
        // With s = time - t[1]: value = v[1] + linear s + quadratic s^2.
        let (before, after) = (t[0] - t[1], t[2] - t[1]);
        let (slope_before, slope_after) = ((v[0] - v[1]) / before, (v[2] - v[1]) / after);
        let quadratic = (slope_after - slope_before) / (after - before);
        let linear = slope_before - quadratic * before;
        let shift = -0.5 * linear / quadratic;
        let refined = LocalExtremum { time: t[1] + shift, value: v[1] + 0.5 * linear * shift };
        // Three equal values have no vertex.
        if refined.time.is_finite() && refined.value.is_finite() {
            refined
        } else {
            LocalExtremum { time: t[1], value: v[1] }
        }
    }
}
