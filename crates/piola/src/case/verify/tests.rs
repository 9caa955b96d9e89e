use std::f64::consts::TAU;

use super::*;
use crate::case::Level;
use crate::case::{LoadOptions, parse};
use crate::output::Column;
use crate::schemes::Particle;
use crate::time::Failure;

mod sweeps;

/// A case with two variants, without checks.
const BASE: &str = r#"
version = 1
id = "T1"
title = "A bar"
dimension = 1
[parameters]
amplitude = 2.0
[[body]]
name = "bar"
shape = { kind = "box", min = [0.0], max = [1.0] }
spacing = 0.1
material = { kind = "linear", density = 1.0, bulk_modulus = 1.0 }
[scheme]
kind = "upwind"
smoothing_length = 0.7
[time]
end = 1.0
cfl = 0.3
[[probe]]
name = "top"
kind = "particle"
at = [1.0]
fields = ["displacement"]
[coarse]
set = ["body.bar.spacing=0.2"]
[[variant]]
name = "double"
set = ["parameters.amplitude=4.0"]
[[variant]]
name = "broken"
"#;

/// A run without simulation: `top.displacement.x` is a sine of one period, NaN where asked for.
struct Fake {
    outcome: Outcome,
    amplitude: f64,
    bad_row: Option<usize>,
}

impl RunResults for Fake {
    fn ending(&self) -> Ending {
        Ending::from(&self.outcome)
    }

    fn quantity(&self, name: &str) -> Option<Series> {
        let time: Vec<f64> = (0..=400).map(|row| f64::from(row) / 400.0).collect();
        match name {
            "top.displacement.x" => {
                let mut values: Vec<f64> =
                    time.iter().map(|t| self.amplitude * (TAU * t).sin()).collect();
                if let Some(row) = self.bad_row {
                    values[row] = f64::NAN;
                }
                Some(Series::Curve {
                    against: Column::new("time", "s"),
                    abscissa: time,
                    values,
                    unit: "m".into(),
                })
            }
            "run.steps" => Some(Series::Number { value: 400.0, unit: "1" }),
            "run.first_step" => Some(Series::Number { value: f64::NAN, unit: "s" }),
            "run.outcome" => Some(Series::Text(self.outcome.summary())),
            _ => None,
        }
    }
}

fn inverted() -> Outcome {
    Outcome::Failed(Failure::Inverted {
        index: 7,
        particle: Particle { id: 7, reference: vec![0.7] },
        ratio: -0.1,
        step: 9,
        time: 0.25,
        advice: "raise `scheme.tau_velocity`".into(),
    })
}

fn completed(amplitude: f64) -> Fake {
    Fake { outcome: Outcome::Completed, amplitude, bad_row: None }
}

/// The case with `checks`, and its rows when each variant gives what `result` says.
fn rows_of(
    checks: &str,
    level: Level,
    result: impl Fn(Option<&str>, &Case) -> Result<Fake, String>,
) -> Vec<CheckRow> {
    let text = format!("{BASE}{checks}");
    let load = |variant: Option<&str>| {
        let options =
            LoadOptions { variant: variant.map(str::to_owned), level, ..Default::default() };
        parse(&text, "case.toml", &options).unwrap_or_else(|problems| panic!("{problems}"))
    };
    verify(&load(None), &mut |variant| {
        let case = load(variant);
        Ok(VariantRun { run: result(variant, &case)?, case })
    })
}

/// The rows in the case as it stands with a run whose amplitude is the parameter's.
fn rows(checks: &str) -> Vec<CheckRow> {
    rows_of(checks, Level::Case, |_, case| Ok(completed(case.parameter("amplitude").unwrap())))
}

/// The only row of one check, whose lines are given.
fn row(lines: &str) -> CheckRow {
    let mut rows = rows(&format!("[[check]]\nsource = \"none\"\n{lines}\n"));
    assert_eq!(rows.len(), 1);
    rows.remove(0)
}

const X: &str = "quantity = \"top.displacement.x\"\n";

#[test]
fn a_row_says_what_was_compared() {
    let row = row(&format!("{X}reduce = \"maximum\"\nexpected = \"amplitude\"\ntolerance = 0.01"));
    assert_eq!(
        row,
        CheckRow {
            check: 0,
            id: Some("T1".into()),
            run: None,
            quantity: "top.displacement.x maximum".into(),
            got: Some(Got::Number(2.0, "m".into())),
            expected: "2 m".into(),
            tolerance: "1 %".into(),
            deviation: "0 %".into(),
            against: None,
            source: "none".into(),
            bound: None,
            level: Level::Case,
            runs: vec![None],
            is_long: false,
            pass: true,
            unmet: None,
            reason: None,
            trend: None,
        }
    );
    assert_eq!(row.got.unwrap().to_string(), "2 m");
}

#[test]
fn tolerances_are_met_from_both_sides() {
    for (expected, tolerance, absolute, pass) in [
        (2.0, 0.0, false, true),
        (2.1, 0.05, false, true),
        (1.9, 0.05, false, false), // 0.1 off, 0.095 allowed
        (2.1, 0.04, false, false),
        (1.9, 0.1001, true, true),
        (2.1, 0.1001, true, true),
        (2.2, 0.1, true, false),
        (1.8, 0.1, true, false),
        (0.0, 2.0, true, true),
        (-2.0, 0.5, false, false),
    ] {
        let row = row(&format!(
            "{X}reduce = \"maximum\"\nexpected = {expected:?}\ntolerance = {tolerance:?}\n\
             absolute = {absolute}"
        ));
        assert_eq!(row.pass, pass, "{row:?}");
        assert_eq!(row.reason, None);
    }
}

#[test]
fn bounds_hold_both() {
    for (lines, pass, expected) in [
        ("at_most = 2.0", true, "at most 2 m"),
        ("at_most = 1.99", false, "at most 1.99 m"),
        ("at_least = 2.0", true, "at least 2 m"),
        ("at_least = 2.01", false, "at least 2.01 m"),
        ("at_least = 1.0\nat_most = 3.0", true, "at least 1 m, at most 3 m"),
        ("at_least = 1.0\nat_most = 1.5", false, "at least 1 m, at most 1.5 m"),
    ] {
        let row = row(&format!("{X}reduce = \"maximum\"\n{lines}"));
        assert_eq!((row.pass, row.expected.as_str()), (pass, expected));
    }
}

#[test]
fn a_variant_brings_its_own_parameters() {
    let row = row(&format!(
        "{X}variant = \"double\"\nreduce = \"maximum\"\nexpected = \"amplitude\"\ntolerance = 0.0"
    ));
    assert!(row.pass, "{row:?}");
    assert_eq!((row.run.as_deref(), row.expected.as_str()), (Some("double"), "4 m"));
}

/// What is expected of a variant that was left out, too.
#[test]
fn a_variant_that_was_not_run_brings_its_own_parameters() {
    let check = format!(
        "[[check]]\nsource = \"none\"\n{X}variant = \"double\"\nreduce = \"maximum\"\nexpected = \"amplitude\"\n\
         tolerance = 0.0\n"
    );
    let text = format!("{BASE}{check}");
    let load = |variant: Option<&str>| {
        let options = LoadOptions { variant: variant.map(str::to_owned), ..Default::default() };
        parse(&text, "case.toml", &options).unwrap_or_else(|problems| panic!("{problems}"))
    };
    let rows = verify::<Fake>(&load(None), &mut |variant| {
        Err(NotRun { case: Some(Box::new(load(variant))), reason: "it takes long".to_owned() })
    });
    assert_eq!(rows[0].expected, "4");
    assert_eq!(rows[0].reason.as_deref(), Some("it takes long"));
}

#[test]
fn variants_are_compared_with_each_other() {
    for (own, relation, pass) in [
        ("base", "less_than = \"double\"", true),
        ("base", "more_than = \"double\"", false),
        ("double", "more_than = \"base\"", true),
        ("double", "less_than = \"base\"", false),
        ("double", "more_than = \"broken\"", true),
        // The same value is neither less nor more.
        ("base", "less_than = \"broken\"", false),
        ("base", "more_than = \"broken\"", false),
        ("base", "equal_to = \"broken\"\ntolerance = 0.0", true),
        ("base", "equal_to = \"double\"\ntolerance = 0.49", false),
        ("base", "equal_to = \"double\"\ntolerance = 0.51", true),
        ("double", "equal_to = \"base\"\nabsolute = true\ntolerance = 2.0", true),
    ] {
        let row = row(&format!("{X}variant = \"{own}\"\nreduce = \"maximum\"\n{relation}"));
        assert_eq!(row.pass, pass, "{row:?}");
    }
    let row = row(&format!("{X}reduce = \"maximum\"\nless_than = \"double\""));
    assert_eq!(row.expected, "less than double (4 m)");
    let row =
        self::row(&format!("{X}reduce = \"maximum\"\nequal_to = \"double\"\ntolerance = 0.1"));
    assert_eq!((row.expected.as_str(), row.tolerance.as_str()), ("equal to double (4 m)", "10 %"));
    assert_eq!(row.deviation, "-50 %");
}

#[test]
fn each_needed_variant_runs_once_and_no_other() {
    let checks = format!(
        "[[check]]\n{X}source = \"a\"\nvariant = \"double\"\nat_most = 9.0\n\
         [[check]]\n{X}source = \"b\"\nless_than = \"double\"\n\
         [[check]]\n{X}source = \"c\"\nvariant = \"broken\"\nwhen = \"case\"\nat_most = 9.0\n\
         [[check]]\n{X}source = \"d\"\nwhen = \"coarse\"\nat_most = 9.0\n"
    );
    for (level, sources, variants) in [
        (Level::Coarse, ["a", "b", "d"], vec![Some("double"), None]),
        (Level::Case, ["a", "b", "c"], vec![Some("double"), None, Some("broken")]),
    ] {
        let ran = std::cell::RefCell::new(Vec::new());
        let rows = rows_of(&checks, level, |variant, case| {
            assert_eq!(case.level, level);
            ran.borrow_mut().push(variant.map(str::to_owned));
            Ok(completed(1.0))
        });
        assert_eq!(
            ran.into_inner(),
            variants.iter().map(|v| v.map(str::to_owned)).collect::<Vec<_>>()
        );
        assert_eq!(rows.iter().map(|row| row.source.as_str()).collect::<Vec<_>>(), sources);
    }
}

#[test]
fn outcomes_are_compared_as_text() {
    let check = |expected: &str| {
        format!(
            "[[check]]\nquantity = \"run.outcome\"\nsource = \"s\"\nexpected = \"{expected}\"\n"
        )
    };
    assert!(rows(&check("completed"))[0].pass);
    let fails = |_: Option<&str>, _: &Case| Ok(Fake { outcome: inverted(), ..completed(1.0) });
    assert!(rows_of(&check("failed: inverted"), Level::Case, fails)[0].pass);
    let other = &rows_of(&check("completed"), Level::Case, fails)[0];
    assert!(!other.pass);
    assert_eq!(other.got, Some(Got::Text("failed: inverted".into())));
    // The failure itself says more than its kind.
    assert!(other.reason.as_ref().unwrap().contains("particle 7"), "{other:?}");
}

#[test]
fn a_failed_run_passes_no_check_unless_the_failure_is_expected() {
    let number = format!("[[check]]\n{X}source = \"s\"\nreduce = \"maximum\"\nat_most = 9.0\n");
    let fails = |_: Option<&str>, _: &Case| Ok(Fake { outcome: inverted(), ..completed(1.0) });
    let failed = &rows_of(&number, Level::Case, fails)[0];
    assert!(!failed.pass && failed.got.is_none());
    assert!(failed.reason.as_ref().unwrap().starts_with("the run failed: particle 7"));

    let outcome = |variant: &str, text: &str| {
        format!(
            "[[check]]\nquantity = \"run.outcome\"\nvariant = \"{variant}\"\nsource = \"s\"\n\
             expected = \"{text}\"\n"
        )
    };
    for (announced, pass) in [
        (outcome("base", "failed: inverted"), true),
        (outcome("base", "failed: not_finite"), false),
        (outcome("base", "completed"), false),
        (outcome("broken", "failed: inverted"), false),
    ] {
        let rows = rows_of(&format!("{number}{announced}"), Level::Case, fails);
        assert_eq!(rows[0].pass, pass, "{announced}");
    }
    // What cannot be evaluated for a failure that is known is known as well, and nothing else is.
    let known = "unmet = \"it breaks up\"\n";
    let with = |outcome: String| {
        let rows = rows_of(&format!("{number}{known}{outcome}"), Level::Case, fails);
        rows[0].unmet.is_some()
    };
    assert!(with(outcome("base", "completed") + known));
    assert!(!with(outcome("base", "completed")));
    assert!(!with(outcome("broken", "completed") + known));
    // An interruption is no result, whatever is expected.
    let stops =
        |_: Option<&str>, _: &Case| Ok(Fake { outcome: Outcome::Interrupted, ..completed(1.0) });
    let announced = outcome("base", "interrupted");
    let rows = rows_of(&format!("{number}{announced}"), Level::Case, stops);
    assert!(!rows[0].pass);
}

#[test]
fn what_cannot_be_evaluated_fails_with_a_reason() {
    // A column that the reader accepts and this run does not have.
    let row1 = row("quantity = \"energy.kinetic\"\nreduce = \"maximum\"\nat_most = 9.0");
    assert!(!row1.pass && row1.reason.unwrap().contains("energy.kinetic"));
    let row2 = row(&format!("{X}reduce = \"extremum\"\nnumber = 3\nat_most = 9.0"));
    assert!(!row2.pass && row2.reason.unwrap().contains("number 3: only 2 were found"));
    let row3 = row("quantity = \"run.first_step\"\nat_least = 0.0");
    assert!(!row3.pass && row3.reason.unwrap().contains("NaN"));
    let row4 =
        row(&format!("{X}reduce = \"curve\"\nreference = \"/nowhere/curve.csv\"\nat_most = 1.0"));
    assert!(!row4.pass && row4.reason.unwrap().contains("/nowhere/curve.csv"));

    let any = format!("[[check]]\n{X}source = \"s\"\nreduce = \"maximum\"\nat_most = 9.0\n");
    let cannot = |_: Option<&str>, _: &Case| Err("the disk is full".to_owned());
    let row5 = &rows_of(&any, Level::Case, cannot)[0];
    assert!(!row5.pass && row5.reason.as_deref() == Some("the disk is full"));
    for bad_row in [0, 100, 400] {
        let nan = |_: Option<&str>, _: &Case| Ok(Fake { bad_row: Some(bad_row), ..completed(1.0) });
        let row = &rows_of(&any, Level::Case, nan)[0];
        assert!(!row.pass && row.reason.as_ref().unwrap().contains("NaN"), "{row:?}");
    }
    // The other variant of a comparison cannot be had.
    let compare = format!("[[check]]\n{X}source = \"s\"\nless_than = \"double\"\n");
    let half = |variant: Option<&str>, _: &Case| match variant {
        None => Ok(completed(1.0)),
        Some(_) => Ok(Fake { outcome: inverted(), ..completed(9.0) }),
    };
    let row6 = &rows_of(&compare, Level::Case, half)[0];
    assert!(!row6.pass && row6.reason.as_ref().unwrap().starts_with("the variant `double`"));
}

#[test]
fn what_is_expected_has_its_unit_where_the_run_gives_nothing() {
    let row = row(&format!(
        "{X}reduce = \"zero_time\"\nnumber = 9\nexpected = 4.5\ntolerance = 0.1\nabsolute = true"
    ));
    assert!(!row.pass && row.got.is_none() && row.reason.is_some(), "{row:?}");
    assert_eq!((row.expected.as_str(), row.tolerance.as_str()), ("4.5 s", "0.1 s"));
}

#[test]
fn reference_curves_are_read_from_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.csv");
    std::fs::write(&path, "time [s],value [m]\n0,0.5\n0.25,2.5\n").unwrap();
    let reference = path.to_str().unwrap().replace('\\', "/");
    for (at_most, pass) in [(0.76, true), (0.4, false)] {
        let row = row(&format!(
            "{X}reduce = \"curve\"\nreference = \"{reference}\"\nat_most = {at_most}"
        ));
        assert_eq!(row.pass, pass, "{row:?}");
        // The ends are 0.5 off; between them the sine lies above its chord and comes nearer.
        let Some(Got::Number(value, unit)) = row.got else { panic!("no number") };
        assert!((value - 0.5).abs() < 1e-12 && unit == "m", "{value} {unit}");
    }
}
