//! Overrides, variants and the coarse setting.

use super::*;

#[test]
fn overrides_set_keys_of_tables_and_elements_of_lists() {
    let case = read_with(
        FULL,
        &[
            "time.end=2.5",
            "body.0.spacing=0.125",
            "body.ring.material.poisson_ratio=0.25",
            "body.1.shape.from.of.1.outer = 4",
            "title=A new title, unquoted",
            "parameters.speed=\"3 / 2\"",
            "output.every=0.5",
            "domain.periodic.x=[0, 40]",
            "check.5=",
            "time.cfl=",
            "time.step=1e-3",
            "body.\"cloud\".spacing=[0.1, 0.2]",
            "scheme={kind=\"upwind\", smoothing_length=1.2}",
        ],
    )
    .unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(case.time.end.value, 2.5);
    assert_eq!(case.time.step.value, StepControl::Fixed(1e-3));
    assert_eq!(case.bodies[0].spacing.value, [0.125, 0.125]);
    assert_eq!(case.bodies[1].material.bulk_modulus(2), 1e6 / 1.5);
    assert_eq!(case.bodies[2].spacing.value, [0.1, 0.2]);
    assert_eq!(case.title, "A new title, unquoted");
    assert_eq!(case.parameter("twice"), Some(3.0));
    assert_eq!((case.output.every.value, case.checks.len()), (0.5, 9));
    let Scheme::Upwind(upwind) = &case.scheme.value else { panic!("the scheme is upwind") };
    assert_eq!((upwind.smoothing_length.value, upwind.tau_velocity), (1.2, 0.0));
}

#[test]
fn tables_that_the_file_lacks_are_made() {
    let text = FULL.replace("[output]", "[parameters.unused]").replace("[domain]\nperiodic", "#");
    let text = text.split("[parameters.unused]").next().unwrap();
    let case = read_with(text, &["output.every=0.5", "domain.periodic.y=[0, 1]"]).unwrap();
    assert_eq!(case.output.every.value, 0.5);
    assert!(case.domain.periodic[0].is_none() && case.domain.periodic[1].is_some());
}

#[test]
fn settings_are_applied_in_order() {
    let text = FULL.replace(
        "set = [\"scheme.tau_velocity=0\"]",
        "set = [\"time.end=1\", \"scheme.kernel=lucy\"]\ncoarse = [\"body.0.spacing=1\"]",
    );
    let read = |variant: Option<&str>, level| {
        let variant = variant.map(str::to_owned);
        let overrides = vec!["body.ring.spacing=0.75".to_owned()];
        let case = parse(
            &text,
            "case.toml",
            &LoadOptions { overrides, variant, level, ..LoadOptions::default() },
        )
        .unwrap();
        (case.time.end.value, case.bodies[0].spacing[0], case.bodies[1].spacing[0])
    };
    assert_eq!(read(None, Level::Case), (3.0, 0.25, 0.75));
    assert_eq!(read(None, Level::Coarse), (0.5, 0.5, 0.75));
    assert_eq!(read(Some("no-upwinding"), Level::Case), (1.0, 0.25, 0.75));
    assert_eq!(read(Some("no-upwinding"), Level::Coarse), (1.0, 1.0, 0.75));
}

fn shown(overrides: &[&str]) -> String {
    read_with(FULL, overrides).expect_err("a problem").to_string()
}

#[test]
fn problems_of_overrides_underline_the_override() {
    for (text, expected) in [
        (
            "time.end=-1",
            "\
error: `end` must be above 0, got -1
  --> command line:1:16
  |
1 | --set time.end=-1
  |                ^^ must be above 0
",
        ),
        (
            "time.ende=1",
            "\
error: [time] has no key `ende`
  --> command line:1:12
  |
1 | --set time.ende=1
  |            ^^^^ unknown key
  = help: did you mean `end`?
",
        ),
        (
            "body.colum.spacing=1",
            "\
error: the list has no element `colum`
  --> command line:1:12
  |
1 | --set body.colum.spacing=1
  |            ^^^^^ not there
  = help: did you mean `column`?
",
        ),
        (
            "load.7.kind=1",
            "\
error: the list has no element `7`
  --> command line:1:12
  |
1 | --set load.7.kind=1
  |            ^ not there
  = help: its elements are `lid`, or numbers from 0
",
        ),
        (
            "time.end.x=1",
            "\
error: there is no `x` in the number 3
  --> command line:1:16
  |
1 | --set time.end.x=1
  |                ^ not there
",
        ),
        (
            "time.end",
            "\
error: an override has the form path.to.key=value
  --> command line:1:7
  |
1 | --set time.end
  |       ^^^^^^^^ no `=`
  = help: for example `time.end=0.5` or `body.0.spacing=0.1`
",
        ),
        (
            "time..end=1",
            "\
error: a part of the path is empty
  --> command line:1:12
  |
1 | --set time..end=1
  |            ^ a name is missing
  = help: an override has the form path.to.key=value
",
        ),
        (
            "time.cflx=",
            "\
error: there is no `cflx` to remove
  --> command line:1:12
  |
1 | --set time.cflx=
  |            ^^^^ not there
  = help: did you mean `cfl`?
",
        ),
        (
            "body.0.initial.velocity=[\"0\", \"2 * spede\"]",
            "\
error: `spede` is not known
  --> command line:1:42
  |
1 | --set body.0.initial.velocity=[\"0\", \"2 * spede\"]
  |                                          ^^^^^ not known here
  = help: did you mean `speed`?
",
        ),
        (
            "time.end=2 * spede",
            "\
error: `spede` is not known
  --> command line:1:20
  |
1 | --set time.end=2 * spede
  |                    ^^^^^ not known here
  = help: did you mean `speed`?
",
        ),
    ] {
        assert_eq!(shown(&[text]), expected);
    }
}

#[test]
fn problems_of_settings_underline_the_string_in_the_file() {
    let text = FULL.replace("scheme.tau_velocity=0", "scheme.tau_velocty=0");
    let shown = read_with(&text, &[]).unwrap_err().to_string();
    assert_eq!(
        shown,
        "\
error: [scheme] of kind `upwind` has no key `tau_velocty` (in the variant `no-upwinding`)
    --> case.toml:129:16
    |
129 | set = [\"scheme.tau_velocty=0\"]
    |                ^^^^^^^^^^^ unknown key
    = help: did you mean `tau_velocity`?
"
    );
    let text = FULL.replace("time.end=0.5", "time.end=-0.5");
    let shown = read_with(&text, &[]).unwrap_err().to_string();
    assert!(shown.starts_with("error: `end` must be above 0, got -0.5 (in the coarse setting)"));
    assert!(shown.contains("must be above 0\n") && shown.contains("^^^^"), "{shown}");
}

#[test]
fn an_unknown_variant_is_refused() {
    let options = LoadOptions { variant: Some("no-upwind".to_owned()), ..LoadOptions::default() };
    let problems = parse(FULL, "case.toml", &options).unwrap_err();
    assert_eq!(
        problems.to_string(),
        "\
error: the case has no variant `no-upwind`
   --> case.toml
   = help: did you mean `no-upwinding`?
"
    );
}

/// `cfl` and `step` exclude each other: an override of one takes the place of the other.
#[test]
fn one_way_to_choose_the_step_replaces_the_other() {
    let step = |overrides: &[&str]| {
        let case = read_with(FULL, overrides).unwrap_or_else(|problems| panic!("{problems}"));
        case.time.step.value
    };
    assert_eq!(step(&["time.step=0.001"]), StepControl::Fixed(0.001));
    assert_eq!(step(&["time.step=0.001", "time.cfl=0.2"]), StepControl::Cfl(0.2));
    assert_eq!(step(&["time.cfl=", "time.step=0.001"]), StepControl::Fixed(0.001));
    let overrides = ["time.step=0.001", "time.cfl="];
    let message = read_with(FULL, &overrides).expect_err("not there").to_string();
    assert!(message.contains("there is no `cfl` to remove"), "{message}");
}

#[test]
fn overrides_append_to_lists() {
    let case = read_with(
        FULL,
        &[
            "boundary+={ name = 'late', where = { kind = 'all' }, velocity = { x = 'speed' } }",
            "boundary.late.velocity.y=0",
            "load += { kind = \"body_force\", acceleration = [\"1\", \"0\"] }",
            "picture.0.times+=0.75",
        ],
    )
    .unwrap_or_else(|problems| panic!("{problems}"));
    let [.., late] = &case.boundaries[..] else { panic!("a third boundary") };
    assert_eq!((case.boundaries.len(), case.loads.len()), (3, 3));
    assert!(late.velocity.iter().all(Option::is_some));
    assert_eq!(case.pictures[0].times.len(), 3);
    let bare = FULL.replace("[output]", "[parameters.unused]");
    let bare = bare.split("[parameters.unused]").next().unwrap();
    let probe = "probe+={ name = 'new', kind = 'extremum', of = 'largest', field = 'pressure' }";
    let case = read_with(bare, &[probe]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(*case.probes[case.probes.len() - 1].name, "new");
}

#[test]
fn problems_of_what_is_appended_have_their_places() {
    for (text, expected) in [
        (
            "boundary+={ name = 'late', where = { kind = 'all' }, velocity = { x = '0' }, velocty = 1 }",
            "[[boundary]] has no key `velocty`\n  --> command line:1:84\n",
        ),
        (
            "time+={ end = 1 }",
            "`+=` appends to a list, and this is a table\n  --> command line:1:7\n",
        ),
        ("boundary+=", "there is nothing to append\n  --> command line:1:7\n"),
        ("load+={ kind = body_force }", "the table cannot be read\n  --> command line:1:13\n"),
        ("time.end=[1, ", "the list cannot be read\n  --> command line:1:16\n"),
    ] {
        let shown = shown(&[text]);
        assert!(shown.starts_with(&format!("error: {expected}")), "{shown}");
    }
}

/// What is said on the command line is said of the setting that runs.
#[test]
fn overrides_are_judged_for_the_setting_that_runs() {
    // The shape of the variant has no `max`, and its sweep steps of its own.
    let text = FULL.replace(
        "set = [\"scheme.tau_velocity=0\"]",
        "set = [\"body.column.shape={ kind = 'ball', center = [0.0, 2.0], radius = 1.0 }\"]",
    );
    let overrides = vec!["body.column.shape.max=[2.0, 4.0]".to_owned()];
    let read = |variant: Option<&str>| {
        let variant = variant.map(str::to_owned);
        let options =
            LoadOptions { overrides: overrides.clone(), variant, ..LoadOptions::default() };
        parse(&text, "case.toml", &options)
    };
    assert!(read(None).is_ok(), "{}", read(None).unwrap_err());
    let shown = read(Some("no-upwinding")).unwrap_err().to_string();
    assert!(shown.contains("`max`"), "{shown}");
}

#[test]
fn a_shorter_run_leaves_out_what_is_later_and_says_so() {
    let case = read_with(FULL, &["time.end=0.2"]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(case.pictures[0].times.len(), 1);
    assert_eq!(
        case.remarks,
        [
            "the run ends at 0.2 s, before the pictures at 0.5 s: they are left out",
            "the run ends at 0.2 s, before the checks at 0.25 s: they cannot be evaluated",
        ]
    );
    // So does a file that was changed, though its checks have to fit.
    let shorter = FULL.replacen("end = 3.0", "end = 0.3", 1);
    let case = read_with(&shorter, &[]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(case.remarks.len(), 1);
    // What the record of the run holds is read again.
    let again = crate::case::recorded(&read_with(FULL, &["time.end=0.2"]).unwrap().as_run, None);
    assert!(again.is_ok());
}

/// A misspelt parameter would change nothing without a word.
#[test]
fn a_new_parameter_that_nothing_depends_on_is_told() {
    let remarks = |overrides: &[&str]| {
        let case = read_with(FULL, overrides).unwrap_or_else(|problems| panic!("{problems}"));
        case.remarks
    };
    let said = "the case has no parameter `sped`, and nothing depends on it; did you mean `speed`?";
    assert_eq!(remarks(&["parameters.sped=3"]), [said]);
    assert!(remarks(&["parameters.speed=3"]).is_empty());
    assert!(remarks(&["parameters.last=2.5", "time.end='last'"]).is_empty());
}
