//! Ranges of numbers, their ticks, and numbers and units as text.

use super::{SMALL, font};

/// Largest number that is drawn; anything beyond is drawn there. Differences of such numbers and
/// their tenfold stay finite.
const LARGEST: f64 = 1e300;

/// Round numbers in a range.
#[derive(Clone, Debug, PartialEq)]
pub struct Ticks {
    pub values: Vec<f64>,
    pub labels: Vec<String>,
    /// Labels are in units of 10 to the power of this, a multiple of 3.
    pub exponent: i32,
}

impl Ticks {
    /// At most `most` (at least 2) ticks between `low` and `high`, at multiples of 1, 2 or 5 times
    /// a power of ten. The range has to be one that [`usable_range`] returned.
    pub fn new([low, high]: [f64; 2], most: usize) -> Self {
        let rough = (high - low) / most.max(2) as f64;
        let power = rough.log10().floor() as i32;
        let inside = |step: f64| {
            // A tick a hair outside is that of the range's end.
            let first = (low / step - 1e-6).ceil();
            let last = (high / step + 1e-6).floor();
            (first, last - first + 1.0)
        };
        let steps = [(1.0, power), (2.0, power), (5.0, power), (1.0, power + 1), (2.0, power + 1)];
        let (digit, power) = steps
            .into_iter()
            .find(|&(digit, power)| inside(digit * 10_f64.powi(power)).1 <= most.max(2) as f64)
            .unwrap_or((5.0, power + 1));
        let step = digit * 10_f64.powi(power);
        let (first, count) = inside(step);
        let exponent = exponent_of(low.abs().max(high.abs()));
        // The quotient of powers, not the power of a quotient: 1e-3 has no exact value.
        let values: Vec<f64> = (0..count as usize).map(|i| (first + i as f64) * step).collect();
        let decimals = (exponent - power).clamp(0, 17) as usize;
        let labels = values.iter().map(|value| {
            let scaled = value / 10_f64.powi(exponent);
            // Zero has no sign, and a minus is longer than a hyphen.
            let scaled = if scaled == 0.0 { 0.0 } else { scaled };
            format!("{scaled:.decimals$}").replace('-', "−")
        });
        Self { labels: labels.collect(), values, exponent }
    }

    /// The most ticks whose labels stand beside each other on `length` pixels without touching.
    pub fn beside_each_other(range: [f64; 2], length: f32) -> Self {
        let fits = |ticks: &Self| {
            let needed = (ticks.widest() + SMALL) * (ticks.values.len() as f32 - 1.0);
            let available = match (ticks.values.first(), ticks.values.last()) {
                (Some(first), Some(last)) => (last - first) / (range[1] - range[0]),
                _ => 0.0,
            };
            needed <= length * available as f32
        };
        let most = ((length / 60.0) as usize).clamp(2, 9);
        let candidates = (2..=most).rev().map(|most| Self::new(range, most));
        candidates.clone().find(fits).unwrap_or_else(|| Self::new(range, 2))
    }

    /// Ticks whose labels stand above each other on `length` pixels.
    pub fn above_each_other(range: [f64; 2], length: f32) -> Self {
        Self::new(range, ((length / (3.0 * SMALL)) as usize).clamp(2, 9))
    }

    /// Width of the widest label.
    pub fn widest(&self) -> f32 {
        self.labels.iter().map(|label| font::width(label, SMALL)).fold(0.0, f32::max)
    }
}

/// The exponent, a multiple of 3, of the unit in which numbers up to `largest` are short.
fn exponent_of(largest: f64) -> i32 {
    if largest == 0.0 || (1e-2..1e4).contains(&largest) {
        return 0;
    }
    // A hair more, so that 1000 is one thousand whatever its logarithm rounds to.
    ((largest.log10() + 1e-9).floor() as i32).div_euclid(3) * 3
}

/// The range from the smallest to the largest finite one of `values`, or from 0 to 1.
pub fn range_of(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let finite = values.filter(|value| value.is_finite());
    let range = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    });
    if range[0] <= range[1] { range } else { [0.0, 1.0] }
}

/// `range` in order, finite, and so wide that it can be divided: a single number becomes a range
/// around it.
pub fn usable_range(range: [f64; 2]) -> [f64; 2] {
    let [first, second] = range.map(|end| match end.is_nan() {
        true => 0.0,
        false => end.clamp(-LARGEST, LARGEST),
    });
    let (low, high) = (first.min(second), first.max(second));
    let largest = low.abs().max(high.abs());
    // Below this the digits of the ends no longer tell ticks apart.
    if high - low > 1e-9 * largest && high - low > 1e-290 {
        return [low, high];
    }
    let half = if largest > 1e-290 { 0.05 * largest } else { 1.0 };
    let middle = low + (high - low) / 2.0;
    [middle - half, middle + half]
}

/// `name [unit]` with the exponent that ticks left out: `pressure [10³ Pa]`.
pub fn label(name: &str, unit: &str, exponent: i32) -> String {
    let unit = if unit == "1" { String::new() } else { pretty(unit) };
    let power = if exponent == 0 { String::new() } else { format!("10{}", raised(exponent)) };
    match format!("{power} {unit}").trim() {
        "" => name.to_owned(),
        unit => format!("{name} [{unit}]").trim_start().to_owned(),
    }
}

/// `value` with at most 6 digits: `0.3`, `1.25×10⁻⁷`.
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    // Rounded to 6 digits, then the shortest text of the result.
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) {
        return rounded.to_string().replace('-', "−");
    }
    let text = format!("{rounded:e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent = exponent.parse().unwrap_or(0);
    format!("{}×10{}", digits.replace('-', "−"), raised(exponent))
}

/// A unit with raised exponents and points between its factors: `kg*m/s^2` is `kg·m/s²`.
fn pretty(unit: &str) -> String {
    let mut text = String::new();
    let mut rest = unit;
    while let Some((before, after)) = rest.split_once('^') {
        text += before;
        let digits = after.strip_prefix('-').unwrap_or(after);
        let end =
            after.len() - digits.trim_start_matches(|letter: char| letter.is_ascii_digit()).len();
        match after[..end].parse() {
            Ok(exponent) => text += &raised(exponent),
            Err(_) => text += &format!("^{}", &after[..end]),
        }
        rest = &after[end..];
    }
    (text + rest).replace('*', "·")
}

fn raised(exponent: i32) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |letter: char| letter.to_digit(10).map_or('⁻', |digit| digits[digit as usize]);
    exponent.to_string().chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ticks_are_round() {
        let ticks = |low, high, most| {
            let ticks = Ticks::new([low, high], most);
            (ticks.labels, ticks.exponent)
        };
        assert_eq!(ticks(0.0, 1.0, 6).0, ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(ticks(-0.3, 0.3, 3).0, ["−0.2", "0.0", "0.2"]);
        let thousands = (["0", "20", "40"].map(String::from).to_vec(), 3);
        assert_eq!(ticks(0.0, 4.5e4, 4), thousands);
        assert_eq!(ticks(0.0, 2.1e-7, 3), (["0", "100", "200"].map(String::from).to_vec(), -9));
        assert_eq!(ticks(1000.0, 1000.5, 6).0[..2], ["1000.0", "1000.1"]);
    }

    #[test]
    fn numbers_and_units_read_well() {
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!(number(-1.25e-7), "−1.25×10⁻⁷");
        assert_eq!(number(0.0), "0");
        assert_eq!(number(123456.7), "123457");
        assert_eq!(number(f64::NAN), "NaN");
        assert_eq!(label("density", "kg/m^3", 0), "density [kg/m³]");
        assert_eq!(label("force", "kg*m*s^-2", 3), "force [10³ kg·m·s⁻²]");
        assert_eq!(label("stretch", "1", 0), "stretch");
        assert_eq!(label("stretch", "1", -3), "stretch [10⁻³]");
        assert_eq!(label("odd", "m^", 0), "odd [m^]");
        assert_eq!(label("odd", "^é^-", 0), "odd [^é^-]");
    }

    proptest! {
        #[test]
        fn ticks_lie_in_any_range(a in any::<f64>(), b in any::<f64>(), most in 0_usize..12) {
            for range in [[a, b], [a, a], [a, a + a.abs() * 1e-8]] {
                let range = usable_range(range);
                prop_assert!(range[0] < range[1]);
                let ticks = Ticks::new(range, most);
                prop_assert!(ticks.values.len() <= most.max(2));
                let slack = 1e-5 * (range[1] - range[0]);
                for value in &ticks.values {
                    prop_assert!((range[0] - slack..=range[1] + slack).contains(value));
                }
                let mut labels = ticks.labels.clone();
                labels.dedup();
                prop_assert_eq!(labels.len(), ticks.labels.len(), "{:?}", ticks);
            }
        }

        #[test]
        fn any_unit_is_written(unit in "\\PC{0,12}", exponent in any::<i32>()) {
            label("x", &unit, exponent);
        }
    }
}
