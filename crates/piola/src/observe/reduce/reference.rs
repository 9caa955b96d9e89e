//! The difference between a history and a reference curve.

use super::ReduceError;
use super::history::History;
use crate::output::Curve;

/// A difference at a time.
type Point = (f64, f64);

impl History<'_> {
    pub fn largest_difference(&self, reference: &Curve) -> Result<f64, ReduceError> {
        let points = self.difference(reference)?;
        Ok(points.iter().fold(0.0, |largest, (_, difference)| difference.abs().max(largest)))
    }

    pub fn rms_difference(&self, reference: &Curve) -> Result<f64, ReduceError> {
        let points = self.difference(reference)?;
        let duration = points[points.len() - 1].0 - points[0].0;
        if duration == 0.0 {
            return Ok(points[0].1.abs());
        }
        // The mean of the square of a straight line from a to b is (a^2 + a b + b^2) / 3.
        let parts = points.windows(2).map(|pair| {
            let [(start, a), (end, b)] = [pair[0], pair[1]];
            (a * a + a * b + b * b) / 3.0 * ((end - start) / duration)
        });
        Ok(parts.sum::<f64>().sqrt())
    }

    /// The difference at all rows and all points of the reference in the time that both cover.
    /// Between two of them it is a straight line, so they show all there is. At least one.
    fn difference(&self, reference: &Curve) -> Result<Vec<Point>, ReduceError> {
        let reference = History::new(&reference.abscissa, &reference.ordinate)
            .map_err(|error| ReduceError::Reference(Box::new(error)))?;
        let (ours, theirs) = (self.span(), reference.span());
        let (first, last) = (ours[0].max(theirs[0]), ours[1].min(theirs[1]));
        if first > last {
            return Err(ReduceError::NoOverlap { history: ours, reference: theirs });
        }
        let covered = |time: &f64| (first..=last).contains(time);
        let times = self.time.iter().chain(reference.time).copied().filter(covered);
        let mut times: Vec<f64> = times.collect();
        times.sort_by(f64::total_cmp);
        let difference = |time: f64| (time, self.interpolate(time) - reference.interpolate(time));
        Ok(times.into_iter().map(difference).collect())
    }
}
