//! Sweeps and the checks that speak of them.

use super::*;
use crate::case::model::{Expectation, Trend};

fn read(variant: Option<&str>, level: Level) -> Case {
    let variant = variant.map(str::to_owned);
    parse(FULL, "case.toml", &LoadOptions { variant, level, ..LoadOptions::default() })
        .unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn a_sweep_is_read_with_its_values_at_both_settings() {
    let case = full();
    let sweep = &case.sweeps[0];
    assert_eq!((sweep.name.as_str(), sweep.set.len()), ("steps", 1));
    assert_eq!(sweep.variant.as_ref().map(|name| name.as_str()), Some("no-upwinding"));
    assert_eq!((sweep.count(Level::Case), sweep.count(Level::Coarse)), (6, 4));
    let numbers = |level| -> Vec<_> {
        sweep.keys(level)[0].values.iter().map(|value| value.number).collect()
    };
    assert_eq!(numbers(Level::Case), [Some(0.4), Some(0.2), Some(0.1)]);
    assert_eq!(numbers(Level::Coarse), [Some(0.4), Some(0.2)]);
    assert_eq!(sweep.keys(Level::Case)[1].values[1].number, None);
    assert_eq!(sweep.label(3, Level::Case), "time.cfl=0.1 * twice, scheme.kernel=lucy");
    let spacing = &case.sweeps[1];
    assert_eq!((spacing.count(Level::Case), spacing.count(Level::Coarse)), (2, 0));
    assert_eq!(*spacing.keys(Level::Case)[0].path, "body.column.spacing");
}

#[test]
fn a_member_is_the_case_with_its_values() {
    for (name, level, cfl, kernel, end) in [
        ("steps.1", Level::Case, 0.4, "cubic_spline", 2.0),
        ("steps.4", Level::Case, 0.2, "lucy", 2.0),
        ("steps.5", Level::Case, 0.1, "cubic_spline", 2.0),
        ("steps.4", Level::Coarse, 0.2, "lucy", 2.0),
    ] {
        let case = read(Some(name), level);
        let Scheme::Upwind(upwind) = &case.scheme.value else { panic!("the scheme is upwind") };
        assert_eq!(case.time.step.value, StepControl::Cfl(cfl), "{name}");
        assert_eq!((upwind.kernel.as_str(), upwind.tau_velocity), (kernel, 0.0));
        assert_eq!((case.time.end.value, case.variant.as_deref()), (end, Some(name)));
        let spacing = if level == Level::Coarse { 0.5 } else { 0.25 };
        assert_eq!(case.bodies[0].spacing[0], spacing);
    }
    assert_eq!(read(Some("spacing.1"), Level::Case).bodies[0].spacing[0], 0.5);
}

#[test]
fn members_that_are_not_there_are_refused() {
    for (name, level, parts) in [
        ("steps.7", Level::Case, ["no member number 7", "`steps.1` to `steps.6`"]),
        ("steps.5", Level::Coarse, ["no member number 5", "`steps.1` to `steps.4`"]),
        ("stops.1", Level::Case, ["no sweep `stops`", "did you mean `steps`?"]),
        ("steps", Level::Case, ["no variant `steps`", "it is a sweep, with members `steps.1`"]),
        ("steps.0", Level::Case, ["no variant `steps.0`", ""]),
        ("steps.99999999999999999999", Level::Case, ["no variant", ""]),
    ] {
        let options =
            LoadOptions { variant: Some(name.to_owned()), level, ..LoadOptions::default() };
        let problems = parse(FULL, "case.toml", &options).expect_err(name).to_string();
        assert!(parts.iter().all(|part| problems.contains(part)), "{name}: {problems}");
    }
}

#[test]
fn checks_of_sweeps_choose_members() {
    let case = full();
    let checks: Vec<_> = case.checks.iter().filter(|check| check.members.is_some()).collect();
    let lines = |index: usize, level: Level| {
        let members = checks[index].members.as_ref().unwrap();
        members.lines(&case.sweeps[*members.sweep], level)
    };
    // The last key goes fastest, so that the kernels alternate.
    assert_eq!(lines(0, Level::Case), [vec![0, 2, 4], vec![1, 3, 5]]);
    assert_eq!(lines(1, Level::Case), [vec![1]]);
    assert_eq!(lines(2, Level::Case), [vec![1, 3, 5]]);
    assert_eq!(lines(2, Level::Coarse), [vec![1, 3]]);
    assert_eq!(lines(3, Level::Case), [vec![0, 1]]);
    let order = Expectation::Trend { trend: Trend::Order([2.8, 3.2]), expected: Some(0.0) };
    assert_eq!(checks[0].expectation, order);
    // A sweep that is there in the case as it stands only is checked at that only.
    assert_eq!(checks[3].when, When::At(Level::Case));
}

#[test]
fn sweeps_have_a_bounded_number_of_members() {
    let wide = |count: usize| {
        let values: Vec<String> = (1..=count).map(|number| format!("{number}")).collect();
        let list = values.join(", ");
        format!(
            "{FULL}\n[[sweep]]\nname = \"wide\"\nover = {{ time.max_steps = [{list}], time.end = [{list}] }}\n"
        )
    };
    let problems = read_with(&wide(17), &[]).expect_err("289 members").to_string();
    assert!(problems.contains("the sweep has 289 members, at most 256 are allowed"), "{problems}");
    let problems = read_with(&wide(100_000), &[]).expect_err("many members").to_string();
    assert!(problems.contains("members, at most 256"), "{problems}");
    let many: String = (0..5)
        .map(|number| wide(15).split_off(FULL.len()).replace("wide", &format!("wide-{number}")))
        .collect();
    let problems = read_with(&format!("{FULL}{many}"), &[]).expect_err("1125 members").to_string();
    assert!(problems.contains("more than 1000 members together"), "{problems}");
}

#[test]
fn the_case_as_run_of_a_member_is_the_same_case() {
    let case = read(Some("steps.4"), Level::Case);
    let again = read_with(&case.as_run, &[]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!((again.time.step.value, again.time.end.value), (StepControl::Cfl(0.2), 2.0));
}
