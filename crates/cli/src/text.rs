//! Numbers and durations for people.

pub use piola::output::significant;

/// A duration in words: `0.8 s`, `42 s`, `3 min 20 s`, `2 h 05 min`.
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "unknown".to_owned();
    }
    if seconds < 9.95 {
        return format!("{} s", significant(seconds.max(0.0), 2));
    }
    // Above, whole seconds; a float beyond the largest integer becomes the largest integer.
    let whole = seconds.round() as u64;
    match whole {
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {:02} s", whole / 60, whole % 60),
        3600..172_800 => format!("{} h {:02} min", whole / 3600, whole / 60 % 60),
        _ => format!("{} days", whole / 86_400),
    }
}

/// A number with a word for its size: `950`, `12 thousand`, `4.1 million`.
pub fn large(number: f64) -> String {
    for (size, word) in [(1e9, "billion"), (1e6, "million"), (1e3, "thousand")] {
        if number >= size {
            return format!("{} {word}", significant(number / size, 3));
        }
    }
    significant(number, 3)
}

/// Bytes with a unit: `512 B`, `1.5 MB`.
pub fn bytes(count: usize) -> String {
    let count = count as f64;
    for (size, unit) in [(1e9, "GB"), (1e6, "MB"), (1e3, "kB")] {
        if count >= size {
            return format!("{} {unit}", significant(count / size, 3));
        }
    }
    format!("{count} B")
}

/// A count with its noun: `1 step`, `20 steps`.
pub fn count(number: u64, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations() {
        for (seconds, text) in [
            (0.0, "0 s"),
            (0.0123, "0.012 s"),
            (9.4, "9.4 s"),
            (59.4, "59 s"),
            (59.6, "1 min 00 s"),
            (3599.9, "1 h 00 min"),
            (7500.0, "2 h 05 min"),
            (1e6, "11 days"),
            (f64::INFINITY, "unknown"),
            (-1.0, "0 s"),
        ] {
            assert_eq!(duration(seconds), text, "{seconds}");
        }
        duration(1e300);
    }

    #[test]
    fn sizes() {
        assert_eq!(large(999.0), "999");
        assert_eq!(large(4.123e6), "4.12 million");
        assert_eq!(bytes(1_500_000), "1.5 MB");
        assert_eq!(bytes(12), "12 B");
        assert_eq!(count(1, "step"), "1 step");
        assert_eq!(count(0, "step"), "0 steps");
    }
}
