//! Trends along a key of a sweep: order of convergence, monotonicity, ratios.

use super::format::list;
use super::{Got, TrendData};
use crate::case::model::Trend;
use crate::output::significant;

/// Orders beyond this are not looked for.
const STEEPEST: f64 = 20.0;

/// Whether a trend is as expected, and what it is.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Verdict {
    pub pass: bool,
    pub got: Got,
    /// The results of the members, if they are not as expected.
    pub reason: Option<String>,
}

/// Compares what the members gave with a trend, or says why that cannot be done.
pub(super) fn judge(trend: Trend, data: &TrendData) -> Result<Verdict, String> {
    let error_of = |index: usize| data.points[index].error;
    let numbers: Vec<f64> = (0..data.points.len())
        .map(|index| error_of(index).filter(|_| data.of_error).unwrap_or(data.points[index].value))
        .collect();
    let within = |value: f64, [lower, upper]: [f64; 2]| value >= lower && value <= upper;
    let rises = |up: bool| {
        numbers.windows(2).all(|pair| if up { pair[0] < pair[1] } else { pair[0] > pair[1] })
    };
    let listed = || Got::Text(list(&numbers, &data.unit));
    let (pass, got) = match trend {
        Trend::Increasing => (rises(true), listed()),
        Trend::Decreasing => (rises(false), listed()),
        Trend::Ratio(bounds) => {
            let ratios = ratios(&numbers)?;
            let pass = ratios.iter().all(|ratio| within(*ratio, bounds));
            (pass, Got::Text(list(&ratios, "1")))
        }
        Trend::Order(bounds) => {
            let keys = data.points.iter().map(|point| {
                let number = point.key.filter(|key| *key > 0.0 && key.is_finite());
                number
                    .ok_or_else(|| format!("{} = {} is not a number above 0", data.key, point.text))
            });
            let keys = keys.collect::<Result<Vec<f64>, _>>()?;
            let order = match data.of_error {
                true => order_of_errors(&keys, &numbers)?,
                false => order_of_differences(&keys, &numbers)?,
            };
            (within(order, bounds), Got::Number(order, "1".to_owned()))
        }
    };
    let reason = (!pass).then(|| {
        let each = data
            .points
            .iter()
            .zip(&numbers)
            .map(|(point, number)| format!("{} at {}", significant(*number, 6), point.text));
        let what = if data.of_error { "errors" } else { "values" };
        format!("{what} along {}: {}", data.key, each.collect::<Vec<_>>().join(", "))
    });
    Ok(Verdict { pass, got, reason })
}

/// The ratio of each number to the previous one.
///
/// # Errors
/// A number to divide by is zero.
pub fn ratios(numbers: &[f64]) -> Result<Vec<f64>, String> {
    let each = numbers.windows(2).map(|pair| match pair[0] == 0.0 {
        true => Err("a member gives 0, over which there is no ratio".to_owned()),
        false => Ok(pair[1] / pair[0]),
    });
    each.collect()
}

/// The order of convergence from errors: the slope of the straight line through (log key, log
/// error), by least squares over all members. 2 if the error is C key^2.
///
/// # Errors
/// Fewer than two members, an error that is not above 0, or keys that are all the same.
pub fn order_of_errors(keys: &[f64], errors: &[f64]) -> Result<f64, String> {
    if keys.len() < 2 || keys.len() != errors.len() {
        return Err("an order needs two members or more".to_owned());
    }
    if let Some(bad) = errors.iter().find(|error| !(**error > 0.0 && error.is_finite())) {
        return Err(format!("a member has the error {bad}, and an order needs errors above 0"));
    }
    let count = keys.len() as f64;
    let mean = |numbers: &[f64]| numbers.iter().map(|number| number.ln()).sum::<f64>() / count;
    let (x, y) = (mean(keys), mean(errors));
    let products = keys.iter().zip(errors).map(|(key, error)| (key.ln() - x) * (error.ln() - y));
    let squares: f64 = keys.iter().map(|key| (key.ln() - x).powi(2)).sum();
    let slope = products.sum::<f64>() / squares;
    if slope.is_finite() { Ok(slope) } else { Err("all members have the same key".to_owned()) }
}

/// The order of convergence without an exact value, after Richardson: the p with which the
/// differences of successive members are closest to `C (key_i^p - key_(i+1)^p)`, by least squares of
/// their logarithms. With keys of one constant ratio this is the slope of log difference against
/// log key; with three members the fit is exact.
///
/// # Errors
/// Fewer than three members, two successive members with the same value or key, or no order below
/// 20 that fits.
pub fn order_of_differences(keys: &[f64], values: &[f64]) -> Result<f64, String> {
    if keys.len() < 3 || keys.len() != values.len() {
        return Err("an order without an expected value needs three members or more".to_owned());
    }
    let mut pairs = Vec::new();
    for (key, value) in keys.windows(2).zip(values.windows(2)) {
        let (difference, step) = ((value[0] - value[1]).abs().ln(), (key[1] / key[0]).ln());
        if !difference.is_finite() || step == 0.0 || !step.is_finite() {
            return Err("two successive members are the same: there is no order".to_owned());
        }
        pairs.push(((key[0] / keys[0]).ln(), step, difference));
    }
    let misfit = |order: f64| -> f64 {
        let residuals: Vec<f64> = pairs
            .iter()
            .map(|(key, step, difference)| difference - order * key - log_of_step(order, *step))
            .collect();
        let mean = residuals.iter().sum::<f64>() / residuals.len() as f64;
        residuals.iter().map(|residual| (residual - mean).powi(2)).sum()
    };
    let steps = 800;
    let order_at = |number: i32| STEEPEST * f64::from(number) / f64::from(steps);
    let best = (-steps..=steps)
        .min_by(|one, other| misfit(order_at(*one)).total_cmp(&misfit(order_at(*other))))
        .filter(|number| number.abs() < steps)
        .ok_or_else(|| format!("the differences show no order below {STEEPEST}"))?;
    let (mut low, mut high) = (order_at(best - 1), order_at(best + 1));
    for _ in 0..100 {
        let third = (high - low) / 3.0;
        if misfit(low + third) < misfit(high - third) { high -= third } else { low += third }
    }
    Ok(0.5 * (low + high))
}

/// `log |(1 - r^p) / p|` with `log r` given, which has a limit at p = 0.
fn log_of_step(order: f64, log_ratio: f64) -> f64 {
    let factor = match order.abs() < 1e-12 {
        true => log_ratio,
        false => (order * log_ratio).exp_m1() / order,
    };
    factor.abs().ln()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::verify::TrendPoint;

    fn data(of_error: bool, numbers: &[(f64, f64)]) -> TrendData {
        let points = numbers.iter().map(|&(key, value)| TrendPoint {
            member: "s.1".into(),
            text: key.to_string(),
            key: Some(key),
            value,
            error: of_error.then_some(value),
        });
        TrendData { key: "d".into(), unit: "m".into(), of_error, points: points.collect() }
    }

    #[test]
    fn the_order_of_errors_is_the_slope_of_their_logarithms() {
        // 3 h^2 and 5 h^-1.5, at keys without a constant ratio.
        let keys = [1.0, 0.5, 0.2, 0.04];
        let square: Vec<f64> = keys.iter().map(|h: &f64| 3.0 * h * h).collect();
        assert!((order_of_errors(&keys, &square).unwrap() - 2.0).abs() < 1e-12);
        let growing: Vec<f64> = keys.iter().map(|h: &f64| 5.0 * h.powf(-1.5)).collect();
        assert!((order_of_errors(&keys, &growing).unwrap() + 1.5).abs() < 1e-12);
        // By hand: errors 1, 1, 1/4 at 1, 1/2, 1/4; logarithms to base 2 are 0, 0, -2 at 0, -1, -2,
        // the slope is the mean of (x - mean) y over that of (x - mean)^2: 2 / 2.
        let slope = order_of_errors(&[1.0, 0.5, 0.25], &[1.0, 1.0, 0.25]).unwrap();
        assert!((slope - 1.0).abs() < 1e-12, "{slope}");
    }

    #[test]
    fn what_has_no_order_says_so() {
        for errors in [[0.0, 1.0], [f64::NAN, 1.0], [-1.0, 1.0], [f64::INFINITY, 1.0]] {
            assert!(order_of_errors(&[1.0, 2.0], &errors).is_err(), "{errors:?}");
        }
        assert!(order_of_errors(&[1.0, 1.0], &[1.0, 2.0]).is_err());
        assert!(order_of_errors(&[1.0], &[1.0]).is_err());
        assert!(order_of_differences(&[1.0, 0.5], &[1.0, 2.0]).is_err());
        assert!(order_of_differences(&[1.0, 0.5, 0.25], &[1.0, 1.0, 2.0]).is_err());
        assert!(order_of_differences(&[1.0, 1.0, 0.25], &[1.0, 3.0, 2.0]).is_err());
        assert!(order_of_differences(&[1.0, 0.5, 0.25], &[1.0, f64::NAN, 2.0]).is_err());
    }

    #[test]
    fn the_order_of_differences_needs_no_exact_value() {
        for keys in [&[1.0, 0.5, 0.25][..], &[1.0, 0.7, 0.3, 0.1], &[0.1, 0.2, 0.7]] {
            for order in [-1.0, 0.5, 1.0, 2.0, 3.5] {
                // 7 + 3 h^p: the value that it converges to is not told.
                let values: Vec<f64> =
                    keys.iter().map(|h: &f64| 7.0 + 3.0 * h.powf(order)).collect();
                let found = order_of_differences(keys, &values).unwrap();
                assert!((found - order).abs() < 1e-6, "{keys:?} {order}: {found}");
            }
        }
        // By hand: differences 4 and 1 at a ratio of 2 are of order 2, with either sign.
        for values in [[5.0, 1.0, 0.0], [0.0, 4.0, 3.0]] {
            let found = order_of_differences(&[1.0, 0.5, 0.25], &values).unwrap();
            assert!((found - 2.0).abs() < 1e-6, "{found}");
        }
    }

    #[test]
    fn monotone_is_strict_and_goes_by_the_order_of_the_members() {
        let pass =
            |trend, numbers: &[(f64, f64)]| judge(trend, &data(false, numbers)).unwrap().pass;
        let falling = [(1.0, 3.0), (2.0, 2.0), (3.0, 1.0)];
        assert!(pass(Trend::Decreasing, &falling) && !pass(Trend::Increasing, &falling));
        let level = [(1.0, 3.0), (2.0, 3.0)];
        assert!(!pass(Trend::Decreasing, &level) && !pass(Trend::Increasing, &level));
        let back = [(1.0, 1.0), (2.0, 3.0), (3.0, 2.0)];
        assert!(!pass(Trend::Decreasing, &back) && !pass(Trend::Increasing, &back));
        let verdict = judge(Trend::Increasing, &data(false, &back)).unwrap();
        assert_eq!(verdict.got, Got::Text("1, 3, 2 m".into()));
        assert_eq!(verdict.reason.as_deref(), Some("values along d: 1 at 1, 3 at 2, 2 at 3"));
    }

    #[test]
    fn every_ratio_has_to_be_within_the_bounds() {
        let halves = [(1.0, 8.0), (2.0, 4.0), (3.0, 2.2)];
        let verdict = |bounds| judge(Trend::Ratio(bounds), &data(true, &halves)).unwrap();
        assert!(verdict([0.5, 0.55]).pass);
        assert!(!verdict([0.5, 0.54]).pass && !verdict([0.51, 0.6]).pass);
        assert_eq!(verdict([0.0, 1.0]).got, Got::Text("0.5, 0.55".into()));
        assert!(judge(Trend::Ratio([0.0, 1.0]), &data(true, &[(1.0, 0.0), (2.0, 1.0)])).is_err());
    }

    #[test]
    fn orders_are_compared_with_their_bounds() {
        let square = [(1.0, 1.0), (0.5, 0.25), (0.25, 0.0625)];
        let verdict = |bounds| judge(Trend::Order(bounds), &data(true, &square)).unwrap();
        assert!(verdict([1.9, 2.1]).pass && !verdict([2.1, 3.0]).pass && !verdict([1.0, 1.9]).pass);
        let mut bad = data(true, &square);
        bad.points[1].key = None;
        assert!(judge(Trend::Order([1.0, 3.0]), &bad).unwrap_err().contains("d = 0.5"));
    }
}
