//! When an observer wants to look.

/// Times at which something is due.
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// At 0 and then at intervals of this many seconds; at 0 only if that number is not positive.
    Every(f64),
    /// At the given times, ascending.
    At(Vec<f64>),
    /// At no time but the end.
    End,
}

/// Times closer than this fraction of an interval are the same time.
const SAME: f64 = 1e-9;

impl Schedule {
    /// The given times in ascending order, without those that are not finite.
    pub fn at(mut times: Vec<f64>) -> Self {
        times.retain(|time| time.is_finite());
        times.sort_by(f64::total_cmp);
        Self::At(times)
    }

    /// First due time after `time`, if there is one.
    pub fn next_after(&self, time: f64) -> Option<f64> {
        match self {
            Self::Every(interval) if *interval > 0.0 => {
                Some(((time / interval + SAME).floor() + 1.0) * interval)
            }
            Self::Every(_) => None,
            Self::At(times) => times.iter().copied().find(|&due| due > time * (1.0 + SAME)),
            Self::End => None,
        }
    }

    /// Whether `now` is the first due time after `time`, or past it.
    pub fn is_due(&self, time: f64, now: f64) -> bool {
        self.next_after(time).is_some_and(|due| now >= due * (1.0 - SAME))
    }

    /// Whether the start, at time 0, is due.
    pub fn includes_start(&self) -> bool {
        match self {
            Self::Every(_) => true,
            Self::At(times) => times.iter().any(|&time| time <= 0.0),
            Self::End => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_do_not_drift() {
        let schedule = Schedule::Every(0.1);
        let (mut time, mut count) = (0.0, 0);
        while let Some(next) = schedule.next_after(time).filter(|&next| next <= 100.0 + 1e-9) {
            count += 1;
            assert_eq!(next, f64::from(count) * 0.1);
            time = next;
        }
        assert_eq!(count, 1000);
    }

    #[test]
    fn lists_are_sorted_and_each_time_comes_once() {
        let schedule = Schedule::at(vec![0.5, f64::NAN, 0.25, 0.0]);
        assert!(schedule.includes_start());
        assert_eq!(schedule.next_after(0.0), Some(0.25));
        assert_eq!(schedule.next_after(0.25), Some(0.5));
        assert_eq!(schedule.next_after(0.5), None);
        assert!(schedule.is_due(0.0, 0.25) && schedule.is_due(0.25, 0.6));
        assert!(!schedule.is_due(0.0, 0.2) && !schedule.is_due(0.5, 0.9));
    }
}
