//! Numbers as text for people.

/// Digits of numbers of a case and of results.
pub const DIGITS: usize = 6;

/// `value` rounded to `digits` significant digits: `0.374166`, `1.2e-9`, `250`.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits = digits.clamp(1, 17);
    // The exponent after rounding: 9.9999996 becomes 10.
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    match exponent.parse::<i32>() {
        Ok(exponent) if (-4..digits as i32).contains(&exponent) => {
            let decimals = (digits as i32 - 1 - exponent) as usize;
            trimmed(&format!("{value:.decimals$}"))
        }
        _ => format!("{}e{exponent}", trimmed(mantissa)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_significant_digits() {
        let values = [
            ("0", 0.0),
            ("0.374166", 0.374_165_738_677),
            ("250", 250.0),
            ("10", 9.999_999_96),
            ("1.2e-9", 1.2e-9),
            ("0.000125", 1.25e-4),
            ("-3.14159", -std::f64::consts::PI),
            ("123457", 123_456.7),
            ("1.23457e6", 1_234_567.0),
            ("1e300", 1e300),
            ("NaN", f64::NAN),
            ("inf", f64::INFINITY),
        ];
        for (text, value) in values {
            assert_eq!(significant(value, 6), text);
        }
        assert_eq!(significant(99.96, 3), "100");
        assert_eq!(significant(0.999_96, 3), "1");
    }
}
