//! How the history of a quantity becomes one number.
//!
//! A history is a column of a table against its times. Between rows it is assumed to be a straight line; local
//! extrema are refined by a parabola.
//!
//! Extrema and crossings ignore wiggles: variations of less than [`WIGGLE`] times the range (largest minus smallest
//! value) of the history, or of its part in a window, are ignored.

use thiserror::Error;

use crate::output::{Curve, DIGITS, significant};
use history::History;

mod history;
mod oscillation;
mod reference;
#[cfg(test)]
mod tests;

/// Variations below this fraction of a history's range are wiggles, neither extrema nor crossings.
pub const WIGGLE: f64 = 0.05;

/// A reduction with its arguments. `Reference` is what stands for a reference curve: the curve
/// itself, or before it is read the name of its file.
#[derive(Clone, Debug, PartialEq)]
pub enum Reduction<Reference = Curve> {
    /// The largest value.
    Maximum,
    /// The smallest value.
    Minimum,
    /// The time in s of the largest value.
    MaximumTime,
    /// The time in s of the smallest value.
    MinimumTime,
    /// The last value.
    Final,
    /// The first value.
    Initial,
    /// The value at a time in s.
    At(f64),
    /// The mean over time.
    Mean,
    /// Largest minus smallest value.
    Range,
    /// Halfway between largest and smallest value.
    Middle,
    /// Half of the range.
    Amplitude,
    /// The period of the oscillation about the mid-range in s.
    Period,
    /// One over the period, in 1/s.
    Frequency,
    /// The mean over whole periods.
    CycleMean,
    /// The value at the local extremum of this number, counted from 1.
    Extremum(usize),
    /// The time in s of the local extremum of this number, counted from 1.
    ExtremumTime(usize),
    /// The time in s of the change of sign of this number, counted from 1.
    ZeroTime(usize),
    /// The position along a line in m of the change of sign of this number, counted from 1.
    ZeroPlace(usize),
    /// The largest increase from one row to the next.
    LargestRise,
    /// Last value divided by first value, minus 1.
    Growth,
    /// The integral over time.
    Integral,
    /// The time in s about which the integral is balanced.
    Centroid,
    /// The largest absolute difference to a reference curve.
    Curve(Reference),
    /// The root mean square over time of the difference to a reference curve.
    CurveRms(Reference),
    /// Another reduction of the history between two times in s.
    Within([f64; 2], Box<Self>),
    /// Another reduction of the moving mean over this many seconds.
    Smoothed(f64, Box<Self>),
}

/// What a reduction needs besides the history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// Nothing.
    None,
    /// A time in s: the key `at`.
    Time,
    /// A number counted from 1: the key `number`.
    Number,
    /// A reference curve: the key `reference`.
    Reference,
}

/// A reduction by name, without its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReductionEntry {
    /// Name in a case file.
    pub name: &'static str,
    /// What it needs besides the history.
    pub argument: Argument,
    /// One line of explanation for the generated reference.
    pub meaning: &'static str,
}

macro_rules! registry {
    ($($name:literal, $argument:ident, $pattern:pat, $meaning:literal;)*) => {
        /// All reductions, in the order of the reference.
        pub const REDUCTIONS: &[ReductionEntry] = &[$(ReductionEntry {
            name: $name,
            argument: Argument::$argument,
            meaning: $meaning,
        },)*];

        impl<Reference> Reduction<Reference> {
            /// Name in a case file.
            pub fn name(&self) -> &'static str {
                match self {
                    $($pattern => $name,)*
                    Self::Within(_, inner) | Self::Smoothed(_, inner) => inner.name(),
                }
            }
        }
    };
}

registry! {
    "maximum", None, Self::Maximum, "the largest value";
    "minimum", None, Self::Minimum, "the smallest value";
    "maximum_time", None, Self::MaximumTime, "the time in s of the first row with the largest value";
    "minimum_time", None, Self::MinimumTime, "the time in s of the first row with the smallest value";
    "final", None, Self::Final, "the last value";
    "initial", None, Self::Initial, "the first value";
    "at", Time, Self::At(_), "the value at a time, or at a distance along a line, interpolated between rows";
    "mean", None, Self::Mean, "the mean over time";
    "range", None, Self::Range, "largest minus smallest value";
    "middle", None, Self::Middle, "midpoint between largest and smallest value";
    "amplitude", None, Self::Amplitude, "half of the difference between largest and smallest value";
    "period", None, Self::Period,
        "the period in s of the oscillation about the midpoint between largest and smallest value";
    "frequency", None, Self::Frequency, "one over that period, in 1/s";
    "cycle_mean", None, Self::CycleMean,
        "the mean over whole periods, from the first to the last upward crossing of that midpoint";
    "extremum", Number, Self::Extremum(_),
        "the value at the local extremum with this number; fluctuations below 5 % of the range are ignored";
    "extremum_time", Number, Self::ExtremumTime(_), "the time of that extremum in s";
    "zero_time", Number, Self::ZeroTime(_),
        "the time in s of the change of sign with this number; fluctuations are ignored";
    "zero_place", Number, Self::ZeroPlace(_),
        "the distance from the start of a line to the change of sign with this number; fluctuations are ignored";
    "largest_rise", None, Self::LargestRise,
        "the largest increase from one row to the next, negative if all rows fall";
    "growth", None, Self::Growth, "last value over first value, minus 1";
    "integral", None, Self::Integral,
        "the integral over time; the ratio for two stress pulses is a coefficient of reflection or transmission";
    "centroid", None, Self::Centroid,
        "the mean time weighted by the value: the time at which a pulse passes";
    "curve", Reference, Self::Curve(_), "the largest absolute difference from a reference curve";
    "curve_rms", Reference, Self::CurveRms(_),
        "the root mean square over time, or along a line, of the difference from a reference curve";
}

impl ReductionEntry {
    /// The reduction called `name`.
    pub fn from_name(name: &str) -> Option<&'static Self> {
        REDUCTIONS.iter().find(|entry| entry.name == name)
    }
}

impl<Reference> Reduction<Reference> {
    /// The reduction called `name` if it needs no argument.
    pub fn plain(name: &str) -> Option<Self> {
        let all = [
            Self::Maximum,
            Self::Minimum,
            Self::MaximumTime,
            Self::MinimumTime,
            Self::Final,
            Self::Initial,
            Self::Mean,
            Self::Range,
            Self::Middle,
            Self::Amplitude,
            Self::Period,
            Self::Frequency,
            Self::CycleMean,
            Self::LargestRise,
            Self::Growth,
            Self::Integral,
            Self::Centroid,
        ];
        all.into_iter().find(|reduction| reduction.name() == name)
    }

    /// The name with its argument, for tables: `at 0.5 s`, `extremum 2`.
    pub fn label(&self) -> String {
        match self {
            Self::At(time) => format!("{} {} s", self.name(), significant(*time, DIGITS)),
            Self::Within(ends, inner) => {
                let [first, last] = ends.map(|end| significant(end, DIGITS));
                format!("{} from {first} to {last} s", inner.label())
            }
            Self::Smoothed(width, inner) => {
                let width = significant(*width, DIGITS);
                format!("{} of the moving mean over {width} s", inner.label())
            }
            Self::Extremum(number)
            | Self::ExtremumTime(number)
            | Self::ZeroTime(number)
            | Self::ZeroPlace(number) => format!("{} {number}", self.name()),
            _ => self.name().to_owned(),
        }
    }

    /// The unit of the result for a quantity in `unit`.
    pub fn unit(&self, unit: &str) -> String {
        match self {
            Self::Period | Self::ExtremumTime(_) | Self::ZeroTime(_) | Self::Centroid => "s".into(),
            Self::MaximumTime | Self::MinimumTime => "s".into(),
            Self::ZeroPlace(_) => "m".into(),
            Self::Frequency => "1/s".into(),
            Self::Integral if unit == "1" => "s".into(),
            Self::Integral => format!("{unit} s"),
            Self::Within(_, inner) | Self::Smoothed(_, inner) => inner.unit(unit),
            Self::Growth => "1".into(),
            _ => unit.into(),
        }
    }

    /// The reference curve, if this reduction has one.
    pub fn reference(&self) -> Option<&Reference> {
        match self {
            Self::Curve(reference) | Self::CurveRms(reference) => Some(reference),
            Self::Within(_, inner) | Self::Smoothed(_, inner) => inner.reference(),
            _ => None,
        }
    }

    /// The reference curve, mutably.
    pub fn reference_mut(&mut self) -> Option<&mut Reference> {
        match self {
            Self::Curve(reference) | Self::CurveRms(reference) => Some(reference),
            Self::Within(_, inner) | Self::Smoothed(_, inner) => inner.reference_mut(),
            _ => None,
        }
    }

    /// The same reduction with its reference turned into another by `change`, for example a file
    /// name into the curve read from it.
    ///
    /// # Errors
    /// That of `change`.
    pub fn try_map<Other, Error>(
        &self,
        change: impl FnOnce(&Reference) -> Result<Other, Error>,
    ) -> Result<Reduction<Other>, Error> {
        Ok(match self {
            Self::Maximum => Reduction::Maximum,
            Self::Minimum => Reduction::Minimum,
            Self::MaximumTime => Reduction::MaximumTime,
            Self::MinimumTime => Reduction::MinimumTime,
            Self::Final => Reduction::Final,
            Self::Initial => Reduction::Initial,
            Self::At(time) => Reduction::At(*time),
            Self::Mean => Reduction::Mean,
            Self::Range => Reduction::Range,
            Self::Middle => Reduction::Middle,
            Self::Amplitude => Reduction::Amplitude,
            Self::Period => Reduction::Period,
            Self::Frequency => Reduction::Frequency,
            Self::CycleMean => Reduction::CycleMean,
            Self::Extremum(number) => Reduction::Extremum(*number),
            Self::ExtremumTime(number) => Reduction::ExtremumTime(*number),
            Self::ZeroTime(number) => Reduction::ZeroTime(*number),
            Self::ZeroPlace(number) => Reduction::ZeroPlace(*number),
            Self::LargestRise => Reduction::LargestRise,
            Self::Growth => Reduction::Growth,
            Self::Integral => Reduction::Integral,
            Self::Centroid => Reduction::Centroid,
            Self::Curve(reference) => Reduction::Curve(change(reference)?),
            Self::CurveRms(reference) => Reduction::CurveRms(change(reference)?),
            Self::Within(window, inner) => {
                Reduction::Within(*window, Box::new(inner.try_map(change)?))
            }
            Self::Smoothed(width, inner) => {
                Reduction::Smoothed(*width, Box::new(inner.try_map(change)?))
            }
        })
    }
}

impl Reduction {
    /// Reduces the history `values` at the times `time` in s.
    ///
    /// - `mean` is the integral of the straight lines between rows over the time they span.
    /// - `period` is the slope of a straight line fitted to the times of the crossings of the
    ///   mid-range against their number, one line for the upward and one for the downward ones
    ///   with a common slope. So neither an asymmetric shape nor an offset matters.
    /// - `cycle_mean` is the mean from the first to the last upward one of these crossings.
    /// - `extremum` counts rows from which the value moves away by [`WIGGLE`] of the range on
    ///   both sides, so the first and the last row never count, and refines each by the parabola
    ///   through it and its two neighbours.
    /// - `zero_time` and `zero_place` count changes of sign that go beyond half of [`WIGGLE`] of the range on
    ///   both sides; of rows at zero the first counts. Where noise crosses more than once, the
    ///   middle between the first and the last crossing is taken; the same holds for `period`.
    /// - `curve` and `curve_rms` compare the straight lines between rows with those between the
    ///   points of the reference, over the time that both cover, without error of sampling.
    /// - A window keeps the rows between its times, and adds interpolated ones at them.
    /// - The moving mean is that of the straight lines over a width about each row that has half of it on both sides.
    ///   An oscillation of frequency f keeps the fraction sin(pi f w) / (pi f w) of its amplitude.
    ///
    /// # Errors
    /// A history with values that are not finite, times that do not increase, or not enough rows; and what each
    /// reduction cannot find, see [`ReduceError`].
    pub fn apply(&self, time: &[f64], values: &[f64]) -> Result<f64, ReduceError> {
        let history = History::new(time, values)?;
        match self {
            Self::Maximum => Ok(history.range()[1]),
            Self::Minimum => Ok(history.range()[0]),
            Self::MaximumTime => Ok(history.first_time(history.range()[1])),
            Self::MinimumTime => Ok(history.first_time(history.range()[0])),
            Self::Final => Ok(history.last()),
            Self::Initial => Ok(history.first()),
            Self::At(time) => history.at(*time),
            Self::Mean => Ok(history.needs(2)?.mean()),
            Self::Range => history.needs(2).map(|history| history.range()[1] - history.range()[0]),
            Self::Middle => {
                let [low, high] = history.range();
                Ok(0.5 * low + 0.5 * high)
            }
            Self::Amplitude => {
                history.needs(2).map(|history| 0.5 * (history.range()[1] - history.range()[0]))
            }
            Self::Period => history.needs(3)?.period(),
            Self::Frequency => Ok(1.0 / history.needs(3)?.period()?),
            Self::CycleMean => {
                let window = history.needs(3)?.cycles()?;
                let (time, values) = history.between(window)?;
                Ok(History::new(&time, &values)?.mean())
            }
            Self::Extremum(number) => Ok(history.needs(3)?.extremum(*number)?.value),
            Self::ExtremumTime(number) => Ok(history.needs(3)?.extremum(*number)?.time),
            Self::ZeroTime(number) | Self::ZeroPlace(number) => {
                history.needs(2)?.zero_time(*number)
            }
            Self::LargestRise => Ok(history.needs(2)?.largest_rise()),
            Self::Growth => history.needs(2)?.growth(),
            Self::Integral => Ok(history.needs(2)?.moments()[0]),
            Self::Centroid => {
                let [integral, moment] = history.needs(2)?.moments();
                if integral == 0.0 { Err(ReduceError::NoPulse) } else { Ok(moment / integral) }
            }
            Self::Curve(curve) => history.largest_difference(curve),
            Self::CurveRms(curve) => history.rms_difference(curve),
            Self::Within(window, inner) => {
                let (time, values) = history.between(*window)?;
                inner.apply(&time, &values)
            }
            Self::Smoothed(width, inner) => {
                let (time, values) = history.moving_mean(*width)?;
                inner.apply(&time, &values)
            }
        }
    }
}

/// A history cannot be reduced in this way.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ReduceError {
    /// The history is too short.
    #[error(
        "the table, or its window, has {got} rows where at least {needed} are needed; lower output.table_every, or give \
         a line more points"
    )]
    TooFewRows {
        /// Rows needed.
        needed: usize,
        /// Rows there are.
        got: usize,
    },
    /// There are not as many times as values.
    #[error("there are {times} times for {values} values")]
    UnequalLengths {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// A value is infinite or not a number.
    #[error("the value in row {row} (at {time}) is {value}, which is not a finite number")]
    NotFinite {
        /// Row, from 1.
        row: usize,
        /// Its time in s.
        time: f64,
        /// The value.
        value: f64,
    },
    /// A time is not finite or not later than the previous one.
    #[error("row {row} is at {time}, which is not after the previous row")]
    TimeNotGrowing {
        /// Row, from 1.
        row: usize,
        /// Its time in s.
        time: f64,
    },
    /// The time asked for is not covered.
    #[error("{time} is outside the table, which covers {first} to {last}")]
    TimeOutside {
        /// The time asked for in s.
        time: f64,
        /// First time of the history in s.
        first: f64,
        /// Last time of the history in s.
        last: f64,
    },
    /// The moving mean covers no more than one row.
    #[error(
        "a moving mean over {width} s is shorter than the time between two rows of the table, {apart} s on average: \
         lower output.table_every, or take a longer one"
    )]
    TooNarrow {
        /// Width of the mean in s.
        width: f64,
        /// Mean time between rows in s.
        apart: f64,
    },
    /// The moving mean is as wide as the whole history, or its window.
    #[error("a moving mean over {width} s leaves nothing of a history that covers {covered} s")]
    TooWide {
        /// Width of the mean in s.
        width: f64,
        /// What the history, or its window, covers in s.
        covered: f64,
    },
    /// There are fewer local extrema.
    #[error("there is no local extremum number {wanted}: only {found} were found")]
    NoSuchExtremum {
        /// Number asked for, from 1.
        wanted: usize,
        /// How many there are.
        found: usize,
    },
    /// There are fewer changes of sign.
    #[error("there is no change of sign number {wanted}: only {found} were found")]
    NoSuchZero {
        /// Number asked for, from 1.
        wanted: usize,
        /// How many there are.
        found: usize,
    },
    /// There is no whole oscillation.
    #[error(
        "there is no whole oscillation: the value crosses the middle of its range {crossings} \
         times, and two crossings in the same direction are needed"
    )]
    NoPeriod {
        /// Crossings in both directions.
        crossings: usize,
    },
    /// There is nothing to balance.
    #[error("the integral over this window is 0: no pulse passes in it")]
    NoPulse,
    /// Growth has no meaning.
    #[error("the growth over a first value of 0 is not defined")]
    GrowthFromZero,
    /// History and reference have no time in common.
    #[error(
        "the reference covers {} to {} and the table {} to {}: they do not overlap",
        reference[0], reference[1], history[0], history[1]
    )]
    NoOverlap {
        /// First and last time of the history in s.
        history: [f64; 2],
        /// First and last abscissa of the reference in s.
        reference: [f64; 2],
    },
    /// The reference curve itself cannot be used.
    #[error("the reference curve cannot be used: {0}")]
    Reference(Box<ReduceError>),
}
