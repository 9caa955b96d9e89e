//! A checked history and its plain figures.

use super::ReduceError;

/// Times within this share of the covered time outside of it count as its end: a clock that adds
/// steps misses its end by round-off.
const END_SLACK: f64 = 1e-9;

/// Values against growing times, all finite, at least one.
#[derive(Clone, Copy, Debug)]
pub(super) struct History<'a> {
    pub time: &'a [f64],
    pub values: &'a [f64],
}

impl<'a> History<'a> {
    pub fn new(time: &'a [f64], values: &'a [f64]) -> Result<Self, ReduceError> {
        if time.len() != values.len() {
            return Err(ReduceError::UnequalLengths { times: time.len(), values: values.len() });
        }
        let mut previous = f64::NEG_INFINITY;
        for (row, (&time, &value)) in (1..).zip(time.iter().zip(values)) {
            if !(time > previous && time.is_finite()) {
                return Err(ReduceError::TimeNotGrowing { row, time });
            }
            if !value.is_finite() {
                return Err(ReduceError::NotFinite { row, time, value });
            }
            previous = time;
        }
        Self { time, values }.needs(1)
    }

    /// The history itself if it has as many rows.
    pub fn needs(self, needed: usize) -> Result<Self, ReduceError> {
        match self.values.len() {
            got if got < needed => Err(ReduceError::TooFewRows { needed, got }),
            _ => Ok(self),
        }
    }

    pub fn first(&self) -> f64 {
        self.values[0]
    }

    pub fn last(&self) -> f64 {
        self.values[self.values.len() - 1]
    }

    /// First and last time.
    pub fn span(&self) -> [f64; 2] {
        [self.time[0], self.time[self.time.len() - 1]]
    }

    /// Smallest and largest value.
    pub fn range(&self) -> [f64; 2] {
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        self.values.iter().fold(start, |[low, high], &value| [low.min(value), high.max(value)])
    }

    /// The time of the first row with this value, or of the first row if there is none.
    pub fn first_time(&self, value: f64) -> f64 {
        let row = self.values.iter().position(|&other| other == value);
        self.time[row.unwrap_or(0)]
    }

    /// The value at `time`, which is moved to the nearer end where it lies outside.
    pub fn interpolate(&self, time: f64) -> f64 {
        let after = self.time.partition_point(|&row| row <= time);
        match (after.checked_sub(1), self.time.get(after)) {
            (None, _) => self.first(),
            (Some(row), Some(&next)) => {
                let share = (time - self.time[row]) / (next - self.time[row]);
                let (here, there) = (self.values[row], self.values[after]);
                here + (there - here) * share
            }
            (Some(_), None) => self.last(),
        }
    }

    pub fn at(&self, time: f64) -> Result<f64, ReduceError> {
        let [first, last] = self.span();
        let slack = END_SLACK * (last - first);
        if !(time >= first - slack && time <= last + slack) {
            return Err(ReduceError::TimeOutside { time, first, last });
        }
        Ok(self.interpolate(time))
    }

    pub fn mean(&self) -> f64 {
        let [first, last] = self.span();
        let rows = self.time.windows(2).zip(self.values.windows(2));
        // Each part is weighted before the sum, so that large values do not overflow.
        rows.map(|(t, v)| (0.5 * v[0] + 0.5 * v[1]) * ((t[1] - t[0]) / (last - first))).sum()
    }

    /// Times and values between two times, with interpolated rows at them.
    pub fn between(&self, [first, last]: [f64; 2]) -> Result<(Vec<f64>, Vec<f64>), ReduceError> {
        let ends = [(first, self.at(first)?), (last, self.at(last)?)];
        let rows = self.time.iter().copied().zip(self.values.iter().copied());
        let inside = rows.filter(|(time, _)| *time > first && *time < last);
        Ok([ends[0]].into_iter().chain(inside).chain([ends[1]]).unzip())
    }

    /// Means over `width` about the rows that have half of it on both sides.
    pub fn moving_mean(&self, width: f64) -> Result<(Vec<f64>, Vec<f64>), ReduceError> {
        let [first, last] = self.span();
        let apart = (last - first) / (self.time.len() - 1).max(1) as f64;
        if width < apart {
            return Err(ReduceError::TooNarrow { width, apart });
        }
        // From the first row to each.
        let mut integral = 0.0;
        let mut integrals = vec![0.0];
        for (t, v) in self.time.windows(2).zip(self.values.windows(2)) {
            integral += 0.5 * (t[1] - t[0]) * (v[0] + v[1]);
            integrals.push(integral);
        }
        let until = |time: f64| {
            let row = self.time.partition_point(|&row| row <= time).max(1) - 1;
            let rest = time - self.time[row];
            integrals[row] + 0.5 * rest * (self.values[row] + self.interpolate(time))
        };
        let slack = END_SLACK * (last - first);
        let inside = self.time.iter().filter(|&&time| {
            time - 0.5 * width >= first - slack && time + 0.5 * width <= last + slack
        });
        let mean = |&time: &f64| {
            let ends = [(time - 0.5 * width).max(first), (time + 0.5 * width).min(last)];
            (time, (until(ends[1]) - until(ends[0])) / (ends[1] - ends[0]))
        };
        match inside.map(mean).unzip() {
            (times, _) if Vec::is_empty(&times) => {
                Err(ReduceError::TooWide { width, covered: last - first })
            }
            rows => Ok(rows),
        }
    }

    /// Integrals of the value, and of the value times the time: exact for straight lines.
    pub fn moments(&self) -> [f64; 2] {
        let rows = self.time.windows(2).zip(self.values.windows(2));
        rows.fold([0.0; 2], |[value, moment], (t, v)| {
            let width = t[1] - t[0];
            let balance = v[0] * (2.0 * t[0] + t[1]) + v[1] * (t[0] + 2.0 * t[1]);
            [value + 0.5 * width * (v[0] + v[1]), moment + width * balance / 6.0]
        })
    }

    pub fn largest_rise(&self) -> f64 {
        let rises = self.values.windows(2).map(|pair| pair[1] - pair[0]);
        rises.fold(f64::NEG_INFINITY, f64::max)
    }

    pub fn growth(&self) -> Result<f64, ReduceError> {
        match self.first() {
            0.0 => Err(ReduceError::GrowthFromZero),
            first => Ok(self.last() / first - 1.0),
        }
    }
}
