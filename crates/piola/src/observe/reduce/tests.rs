use std::f64::consts::{PI, TAU};

use proptest::prelude::*;

use super::*;

/// The history of `value` at `rows` rows from `start` to `end`.
fn sampled(start: f64, end: f64, rows: usize, value: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let step = (end - start) / (rows - 1) as f64;
    let time: Vec<f64> = (0..rows).map(|row| start + step * row as f64).collect();
    let values = time.iter().map(|&time| value(time)).collect();
    (time, values)
}

fn reduce(reduction: Reduction, (time, values): &(Vec<f64>, Vec<f64>)) -> f64 {
    reduction.apply(time, values).unwrap()
}

fn refused(reduction: Reduction, (time, values): &(Vec<f64>, Vec<f64>)) -> ReduceError {
    reduction.apply(time, values).unwrap_err()
}

#[track_caller]
fn assert_near(got: f64, expected: f64, tolerance: f64) {
    assert!((got - expected).abs() <= tolerance, "got {got}, expected {expected} +- {tolerance}");
}

/// Numbers in [-1, 1] without pattern, the same in every run.
fn noise(index: usize) -> f64 {
    let mut bits = (index as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (bits ^ (bits >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
}

fn with_noise((time, mut values): (Vec<f64>, Vec<f64>), size: f64) -> (Vec<f64>, Vec<f64>) {
    values.iter_mut().enumerate().for_each(|(row, value)| *value += size * noise(row));
    (time, values)
}

/// Every reduction, with arguments that suit two periods of a sine.
fn all() -> Vec<Reduction> {
    let curve = Curve { abscissa: vec![0.0, 1.0], ordinate: vec![0.0, 1.0] };
    vec![
        Reduction::Maximum,
        Reduction::Minimum,
        Reduction::MaximumTime,
        Reduction::MinimumTime,
        Reduction::Final,
        Reduction::Initial,
        Reduction::At(0.5),
        Reduction::Mean,
        Reduction::Range,
        Reduction::Middle,
        Reduction::Amplitude,
        Reduction::Period,
        Reduction::Frequency,
        Reduction::CycleMean,
        Reduction::Extremum(1),
        Reduction::ExtremumTime(1),
        Reduction::ZeroTime(1),
        Reduction::ZeroPlace(1),
        Reduction::LargestRise,
        Reduction::Growth,
        Reduction::Integral,
        Reduction::Centroid,
        Reduction::Curve(curve.clone()),
        Reduction::CurveRms(curve),
    ]
}

#[test]
fn every_registered_name_belongs_to_one_reduction() {
    let names: Vec<&str> = all().iter().map(Reduction::name).collect();
    let registered: Vec<&str> = REDUCTIONS.iter().map(|entry| entry.name).collect();
    assert_eq!(names, registered);
    for (reduction, entry) in all().into_iter().zip(REDUCTIONS) {
        assert_eq!(ReductionEntry::from_name(reduction.name()), Some(entry));
        let plain = Reduction::<Curve>::plain(entry.name);
        assert_eq!(plain.is_some(), entry.argument == Argument::None, "{}", entry.name);
        assert!(plain.is_none_or(|plain| plain == reduction));
        assert_eq!(reduction.reference().is_some(), entry.argument == Argument::Reference);
        assert_eq!(reduction.try_map(|curve| Ok::<_, ()>(curve.clone())), Ok(reduction));
    }
    assert_eq!(ReductionEntry::from_name("Maximum"), None);
}

#[test]
fn a_pulse_has_an_integral_and_a_time_at_which_it_passes() {
    // A triangle of height 3 and width 2 about 1.5, in a window that cuts rows.
    let (time, values) = ([0.0, 0.5, 1.5, 2.5, 4.0], [0.0, 0.0, 3.0, 0.0, 0.0]);
    let of = |window, reduction: Reduction| {
        Reduction::Within(window, Box::new(reduction)).apply(&time, &values)
    };
    assert_eq!(of([0.25, 3.0], Reduction::Integral), Ok(3.0));
    assert_eq!(of([0.25, 3.0], Reduction::Centroid), Ok(1.5));
    assert_eq!(of([1.5, 2.5], Reduction::Integral), Ok(1.5));
    assert_eq!(of([3.0, 4.0], Reduction::Centroid), Err(ReduceError::NoPulse));
    let outside = ReduceError::TimeOutside { time: 5.0, first: 0.0, last: 4.0 };
    assert_eq!(of([1.0, 5.0], Reduction::Integral), Err(outside));
    let within = Reduction::<Curve>::Within([0.0, 1.0], Box::new(Reduction::Integral));
    assert_eq!((within.unit("Pa"), within.name()), ("Pa s".into(), "integral"));
    assert_eq!(within.label(), "integral from 0 to 1 s");
}

#[test]
fn an_oscillation_that_sets_in_is_judged_in_a_window() {
    // 2 + 3 sin at 1.6 per second, after a start that is far from it.
    let value = |t: f64| if t < 2.0 { 40.0 * (2.0 - t) } else { 2.0 + 3.0 * (TAU * 1.6 * t).sin() };
    let history = sampled(0.0, 10.0, 20_001, value);
    // Of 4.65 periods four are whole, and nearly three quarters of one are left over.
    let of = |reduction| {
        reduce(Reduction::Within([3.0, 3.0 + 4.65 / 1.6], Box::new(reduction)), &history)
    };
    assert_near(of(Reduction::Frequency), 1.6, 1e-5);
    assert_near(of(Reduction::Amplitude), 3.0, 1e-5);
    assert_near(of(Reduction::CycleMean), 2.0, 1e-5);
    assert!((of(Reduction::Mean) - 2.0).abs() > 0.01);
    assert!((reduce(Reduction::Amplitude, &history) - 3.0).abs() > 30.0);
    let short = Reduction::Within([3.0, 3.5], Box::new(Reduction::CycleMean));
    assert!(matches!(refused(short, &history), ReduceError::NoPeriod { .. }));
}

#[test]
fn a_moving_mean_takes_away_what_is_faster() {
    // A sine of 1.6 per second with noise of 50 per second, whose mean over 0.04 s is zero, in uneven rows.
    let noise = |t: f64| 0.5 * (TAU * 50.0 * t).sin();
    let sine = |t: f64| 2.0 + 3.0 * (TAU * 1.6 * t).sin();
    let (time, values) = sampled(0.0, 5.0, 20_001, |t| sine(t) + noise(t));
    let keep = |row: usize| row % 7 != 3;
    let kept = |all: &[f64]| (0..all.len()).filter(|&row| keep(row)).map(|row| all[row]).collect();
    let history: (Vec<f64>, Vec<f64>) = (kept(&time), kept(&values));
    let smooth = |width, reduction| Reduction::Smoothed(width, Box::new(reduction));
    let phase = PI * 1.6 * 0.04;
    assert_near(
        reduce(smooth(0.04, Reduction::Amplitude), &history),
        3.0 * phase.sin() / phase,
        1e-4,
    );
    assert_near(reduce(smooth(0.04, Reduction::Frequency), &history), 1.6, 1e-4);
    assert!((reduce(Reduction::Maximum, &history) - 5.5).abs() < 0.1);
    // Straight lines are their own mean, as far as it reaches.
    let line = (vec![0.0, 1.0, 2.0, 4.0], vec![0.0, 2.0, 4.0, 8.0]);
    assert_near(reduce(smooth(2.0, Reduction::Initial), &line), 2.0, 1e-14);
    assert_near(reduce(smooth(2.0, Reduction::Final), &line), 4.0, 1e-14);
    let narrow = refused(smooth(1.0, Reduction::Mean), &line);
    assert_eq!(narrow, ReduceError::TooNarrow { width: 1.0, apart: 4.0 / 3.0 });
    let wide = refused(smooth(4.5, Reduction::Mean), &line);
    assert_eq!(wide, ReduceError::TooWide { width: 4.5, covered: 4.0 });
    let windowed = Reduction::<Curve>::Within([0.0, 1.0], Box::new(smooth(0.5, Reduction::Mean)));
    assert_eq!(windowed.label(), "mean of the moving mean over 0.5 s from 0 to 1 s");
    assert_eq!((windowed.unit("Pa"), windowed.name()), ("Pa".into(), "mean"));
}

#[test]
fn plain_figures_of_a_few_rows() {
    let rows = (vec![0.0, 1.0, 3.0, 4.0], vec![2.0, -1.0, 5.0, 4.0]);
    for (reduction, expected) in [
        (Reduction::Maximum, 5.0),
        (Reduction::Minimum, -1.0),
        (Reduction::Final, 4.0),
        (Reduction::Initial, 2.0),
        (Reduction::Range, 6.0),
        (Reduction::Middle, 2.0),
        (Reduction::Amplitude, 3.0),
        (Reduction::Integral, 9.0),
        (Reduction::LargestRise, 6.0),
        (Reduction::Growth, 1.0),
        (Reduction::At(0.0), 2.0),
        (Reduction::At(1.5), 0.5),
        (Reduction::At(3.0), 5.0),
        (Reduction::At(4.0), 4.0),
        // Areas of the trapezia: 0.5, 4 and 4.5 over 4 s.
        (Reduction::Mean, 2.25),
    ] {
        assert_eq!(reduce(reduction.clone(), &rows), expected, "{reduction:?}");
    }
    let falling = (vec![0.0, 1.0, 2.0], vec![3.0, 1.0, 0.5]);
    assert_eq!(reduce(Reduction::LargestRise, &falling), -0.5);
}

#[test]
fn a_time_outside_of_the_table_is_refused_but_round_off_is_not() {
    let rows = (vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 4.0]);
    assert_eq!(reduce(Reduction::At(2.0 + 1e-12), &rows), 4.0);
    for time in [2.001, -0.001, f64::NAN, f64::INFINITY] {
        let error = refused(Reduction::At(time), &rows);
        assert!(matches!(error, ReduceError::TimeOutside { first: 0.0, last: 2.0, .. }));
    }
}

#[test]
fn extrema_of_a_sine_are_found_between_rows() {
    // 37 rows a period: a row is up to 1/74 of a period off the extremum, where the sine is lower
    // by 3.6e-3. What a parabola leaves is of fourth order in the step in value, below
    // (2 pi / 37)^4 / 24 = 3.5e-5, and of third order in time.
    let wave = sampled(0.0, 3.0, 112, |t| 2.0 + (TAU * t + 0.4).sin());
    for number in 1..=5 {
        let time = (0.5 * PI - 0.4 + PI * (number as f64 - 1.0)) / TAU;
        let value = if number % 2 == 1 { 3.0 } else { 1.0 };
        assert_near(reduce(Reduction::ExtremumTime(number), &wave), time, 2e-4);
        assert_near(reduce(Reduction::Extremum(number), &wave), value, 3.5e-5);
    }
    for (wanted, found) in [(7, 6), (0, 6)] {
        let error = refused(Reduction::Extremum(wanted), &wave);
        assert_eq!(error, ReduceError::NoSuchExtremum { wanted, found });
    }
}

#[test]
fn the_largest_value_has_a_time_of_its_own() {
    // The first maximum is not the largest, and the largest is there twice.
    let rows = (vec![0.0, 0.5, 1.5, 2.0, 3.0, 4.0], vec![0.0, 2.0, -1.0, 3.0, 3.0, -1.0]);
    assert_eq!(reduce(Reduction::MaximumTime, &rows), 2.0);
    assert_eq!(reduce(Reduction::MinimumTime, &rows), 1.5);
    assert!(reduce(Reduction::ExtremumTime(1), &rows) < 1.0);
}

#[test]
fn a_parabola_through_uneven_rows_is_exact() {
    let time = vec![0.0, 0.3, 1.1, 1.25, 2.0];
    let values = time.iter().map(|t| 4.0 - 3.0 * (t - 0.9_f64).powi(2)).collect();
    let rows = (time, values);
    assert_near(reduce(Reduction::ExtremumTime(1), &rows), 0.9, 1e-14);
    assert_near(reduce(Reduction::Extremum(1), &rows), 4.0, 1e-14);
}

#[test]
fn wiggles_are_no_extrema() {
    // Noise of +-1 % of the range: a wiggle is at most 2 %, below the 5 % that are ignored.
    let wave = with_noise(sampled(0.0, 3.0, 2000, |t| (TAU * t).cos()), 0.02);
    let error = refused(Reduction::Extremum(6), &wave);
    assert_eq!(error, ReduceError::NoSuchExtremum { wanted: 6, found: 5 });
    for number in 1..=5 {
        let value = if number % 2 == 1 { -1.0 } else { 1.0 };
        assert_near(reduce(Reduction::Extremum(number), &wave), value, 0.03);
        // The highest noisy row lies where the cosine is lower by 0.04 at most.
        let flat = (1.0_f64 - 0.04).acos() / TAU;
        assert_near(reduce(Reduction::ExtremumTime(number), &wave), 0.5 * number as f64, flat);
    }
    // The first movement is smaller than a wiggle and in the other direction.
    let dip = (vec![0.0, 1.0, 2.0, 3.0, 4.0], vec![0.0, -0.04, 1.0, 0.5, 0.52]);
    let error = refused(Reduction::Extremum(2), &dip);
    assert_eq!(error, ReduceError::NoSuchExtremum { wanted: 2, found: 1 });
}

#[test]
fn a_plateau_is_one_extremum() {
    let rows = (vec![0.0, 1.0, 2.0, 3.0, 4.0], vec![0.0, 1.0, 1.0, 1.0, 0.0]);
    let error = refused(Reduction::Extremum(2), &rows);
    assert_eq!(error, ReduceError::NoSuchExtremum { wanted: 2, found: 1 });
    // The parabola through 0, 1, 1 has its vertex half a row on, at 9/8.
    assert_eq!(reduce(Reduction::ExtremumTime(1), &rows), 1.5);
    assert_eq!(reduce(Reduction::Extremum(1), &rows), 1.125);
}

#[test]
fn the_period_of_an_asymmetric_wave() {
    // Harmonics shift the mid-range off the mean and make rise and fall unequal, the decay moves
    // the level: none of it changes the time between crossings in the same direction.
    let wave = |t: f64| 0.3 + (TAU * t / 0.7).sin() + 0.3 * (2.0 * TAU * t / 0.7 + 1.0).sin();
    for phase in [0.0, 0.1, 0.33, 0.5] {
        let rows = sampled(0.0, 3.0, 400, |t| wave(t + phase));
        assert_near(reduce(Reduction::Period, &rows), 0.7, 1e-4);
    }
}

#[test]
fn the_period_of_a_noisy_wave() {
    // Noise of 2 % of the range crosses the level up to several times at each passage.
    let wave = with_noise(sampled(0.0, 5.0, 4000, |t| 7.0 + 0.1 * (TAU * t / 0.9).cos()), 0.004);
    assert_near(reduce(Reduction::Period, &wave), 0.9, 0.003);
    let clean = sampled(0.0, 5.0, 4000, |t| 7.0 + 0.1 * (TAU * t / 0.9).cos());
    assert_near(reduce(Reduction::Period, &clean), 0.9, 1e-6);
}

#[test]
fn less_than_one_oscillation_has_no_period() {
    let wave = sampled(0.0, 0.7, 100, |t| (TAU * t).sin());
    assert_eq!(refused(Reduction::Period, &wave), ReduceError::NoPeriod { crossings: 1 });
    // Round-off of a value at rest does not oscillate.
    let rest = sampled(0.0, 1.0, 100, |t| 1.0 + f64::EPSILON * (TAU * 10.0 * t).sin().round());
    assert_eq!(refused(Reduction::Period, &rest), ReduceError::NoPeriod { crossings: 0 });
    let error = refused(Reduction::Extremum(1), &rest);
    assert_eq!(error, ReduceError::NoSuchExtremum { wanted: 1, found: 0 });
}

#[test]
fn changes_of_sign() {
    let wave = sampled(0.0, 2.0, 400, |t| (TAU * t).sin());
    // It starts at 0, which is no change.
    for number in 1..=3 {
        assert_near(reduce(Reduction::ZeroTime(number), &wave), 0.5 * number as f64, 1e-6);
    }
    let error = refused(Reduction::ZeroTime(4), &wave);
    assert_eq!(error, ReduceError::NoSuchZero { wanted: 4, found: 3 });
    let touching = sampled(-1.0, 1.0, 201, |t| t * t);
    let error = refused(Reduction::ZeroTime(1), &touching);
    assert_eq!(error, ReduceError::NoSuchZero { wanted: 1, found: 0 });
    // Of rows at zero itself the first counts.
    let flat = (vec![0.0, 1.0, 2.0, 3.0, 4.0], vec![-1.0, 0.0, 0.0, 0.0, 1.0]);
    assert_eq!(reduce(Reduction::ZeroTime(1), &flat), 1.0);
    let noisy = with_noise(sampled(0.0, 2.0, 4000, |t| (TAU * t).cos()), 0.02);
    for number in 1..=4 {
        let expected = 0.5 * number as f64 - 0.25;
        assert_near(reduce(Reduction::ZeroTime(number), &noisy), expected, 0.02 / TAU);
    }
}

#[test]
fn differences_to_a_reference_curve() {
    let rows = (vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 2.0]);
    // The reference lies above by 1 at t = 0.5 and is equal elsewhere; nothing at the row times
    // shows it. The square of the difference integrates to 1/3 over 2 s.
    let bump = Curve {
        abscissa: vec![-1.0, 0.0, 0.5, 1.0, 2.0, 9.0],
        ordinate: vec![7.0, 0.0, 1.5, 1.0, 2.0, -50.0],
    };
    assert_eq!(reduce(Reduction::Curve(bump.clone()), &rows), 1.0);
    assert_near(reduce(Reduction::CurveRms(bump), &rows), (1.0_f64 / 6.0).sqrt(), 1e-15);

    let touching = Curve { abscissa: vec![2.0, 3.0], ordinate: vec![1.5, 0.0] };
    assert_eq!(reduce(Reduction::Curve(touching.clone()), &rows), 0.5);
    assert_eq!(reduce(Reduction::CurveRms(touching), &rows), 0.5);

    let apart = Curve { abscissa: vec![2.5, 3.0], ordinate: vec![0.0, 0.0] };
    let error = ReduceError::NoOverlap { history: [0.0, 2.0], reference: [2.5, 3.0] };
    assert_eq!(refused(Reduction::Curve(apart.clone()), &rows), error);
    assert_eq!(refused(Reduction::CurveRms(apart), &rows), error);

    let empty = Curve { abscissa: vec![], ordinate: vec![] };
    assert!(matches!(refused(Reduction::Curve(empty), &rows), ReduceError::Reference(_)));
}

#[test]
fn the_rms_of_a_sine_against_nothing() {
    let wave = sampled(0.0, 1.0, 401, |t| (TAU * t).sin());
    let zero = Curve { abscissa: vec![0.0, 1.0], ordinate: vec![0.0, 0.0] };
    // Chords lie inside the sine by up to (2 pi / 400)^2 / 8 = 3.1e-5.
    assert_near(reduce(Reduction::CurveRms(zero), &wave), 0.5_f64.sqrt(), 3.1e-5);
}

#[test]
fn no_reduction_passes_over_what_is_not_finite() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for row in [0, 50, 99] {
            let mut wave = sampled(0.0, 2.0, 100, |t| (TAU * t).sin());
            wave.1[row] = bad;
            for reduction in all() {
                let error = refused(reduction, &wave);
                assert!(matches!(error, ReduceError::NotFinite { row: r, .. } if r == row + 1));
            }
        }
    }
}

#[test]
fn histories_that_make_no_sense_are_refused() {
    for reduction in all() {
        let error = reduction.apply(&[0.0, 1.0, 1.0], &[0.0, 1.0, 2.0]).unwrap_err();
        assert_eq!(error, ReduceError::TimeNotGrowing { row: 3, time: 1.0 });
        let error = reduction.apply(&[f64::NAN, 1.0], &[0.0, 1.0]).unwrap_err();
        assert!(matches!(error, ReduceError::TimeNotGrowing { row: 1, .. }));
        let error = reduction.apply(&[0.0], &[0.0, 1.0]).unwrap_err();
        assert_eq!(error, ReduceError::UnequalLengths { times: 1, values: 2 });
        let error = reduction.apply(&[], &[]).unwrap_err();
        assert!(matches!(error, ReduceError::TooFewRows { got: 0, .. }));
    }
    for reduction in [Reduction::Mean, Reduction::Range, Reduction::LargestRise, Reduction::Growth]
    {
        let error = refused(reduction, &(vec![0.0], vec![1.0]));
        assert_eq!(error, ReduceError::TooFewRows { needed: 2, got: 1 });
    }
    let error = refused(Reduction::Growth, &(vec![0.0, 1.0], vec![0.0, 1.0]));
    assert_eq!(error, ReduceError::GrowthFromZero);
}

proptest! {
    /// Units and offset of the value change no time; they scale and shift values.
    #[test]
    fn reductions_follow_units(
        frequency in 1.0..5.0f64,
        phase in 0.0..TAU,
        scale in prop_oneof![-1e6..-1e-6f64, 1e-6..1e6f64],
        offset in -2.0..2.0f64,
    ) {
        let wave = |t: f64| (TAU * frequency * t + phase).sin();
        let plain = sampled(0.0, 3.0, 1200, wave);
        let other = sampled(0.0, 3.0, 1200, |t| scale * (wave(t) + offset));
        for reduction in [Reduction::Period, Reduction::ExtremumTime(3)] {
            let (a, b) = (reduce(reduction.clone(), &plain), reduce(reduction, &other));
            prop_assert!((a - b).abs() <= 1e-8, "{a} {b}");
        }
        for reduction in [Reduction::Mean, Reduction::At(1.234), Reduction::Extremum(2)] {
            let (a, b) = (reduce(reduction.clone(), &plain), reduce(reduction, &other));
            prop_assert!((scale * (a + offset) - b).abs() <= 1e-8 * scale.abs(), "{a} {b}");
        }
        // The chord's error moves a crossing by at most (step w)^2 / (8 w); the fit averages it.
        let bound = 3.0 / 1200.0 * 3.0 / 1200.0 * TAU * frequency / 4.0;
        prop_assert!((reduce(Reduction::Period, &plain) - 1.0 / frequency).abs() <= bound);
    }

    /// Whatever the numbers, there is an answer or an error, and bounds hold.
    #[test]
    fn no_input_panics(
        rows in prop::collection::vec((any::<f64>(), any::<f64>()), 0..8),
        steps in prop::collection::vec((1e-300..1e300f64, -1e300..1e300f64), 0..12),
    ) {
        let (time, values): (Vec<f64>, Vec<f64>) = rows.into_iter().unzip();
        let mut clock = 0.0;
        let (growing, finite): (Vec<f64>, Vec<f64>) = steps
            .into_iter()
            .map(|(step, value)| { clock += step; (clock, value) })
            .unzip();
        for reduction in all() {
            let _ = reduction.apply(&time, &values);
            let _ = reduction.apply(&growing, &finite);
        }
        if let Ok(mean) = Reduction::<Curve>::Mean.apply(&growing, &finite) {
            let low = finite.iter().copied().fold(f64::INFINITY, f64::min);
            let high = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let slack = 1e-12 * low.abs().max(high.abs());
            prop_assert!(mean >= low - slack && mean <= high + slack);
        }
    }
}
