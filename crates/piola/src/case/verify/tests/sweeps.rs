//! Checks of the members of a sweep.

use super::*;

/// A sweep of the amplitude and of the kernel, from the variant whose amplitude is 4.
const SWEEP: &str = r#"
[[sweep]]
name = "size"
over = { "parameters.amplitude" = [1, 2, 4], "scheme.kernel" = ["cubic_spline", "lucy"] }
coarse = { "parameters.amplitude" = [1, 2, 4], "scheme.kernel" = ["lucy"] }
[[sweep]]
name = "small"
over = { "parameters.amplitude" = [1, "1 / 2"] }
when = "case"
"#;

/// A check of the largest value with these lines.
fn of_sweep(lines: &str) -> String {
    format!("[[check]]\n{X}reduce = \"maximum\"\nsource = \"s\"\n{lines}\n")
}

fn sweep_rows(lines: &str) -> Vec<CheckRow> {
    rows(&format!("{SWEEP}{}", of_sweep(lines)))
}

#[test]
fn each_member_of_a_sweep_is_checked_with_its_own_parameters() {
    let rows = sweep_rows("sweep = \"size\"\nexpected = \"amplitude\"\ntolerance = 0.0");
    assert_eq!(rows.len(), 6);
    assert!(rows.iter().all(|row| row.pass && row.check == 0), "{rows:?}");
    let run = "size.4 (parameters.amplitude=2, scheme.kernel=lucy)";
    assert_eq!((rows[3].run.as_deref(), rows[3].expected.as_str()), (Some(run), "2 m"));
    let rows = sweep_rows(
        "sweep = \"size\"\nmember = { parameters.amplitude = 4.0 }\nless_than = \"base\"",
    );
    assert_eq!(rows.len(), 2);
    assert!(rows.iter().all(|row| !row.pass && row.expected == "less than base (2 m)"));
}

#[test]
fn what_is_known_not_to_be_met_has_its_reason_and_is_to_be_unmarked_once_it_is() {
    let check = |at_most: f64| {
        let rows =
            sweep_rows(&format!("sweep = \"size\"\nat_most = {at_most:?}\nunmet = \"too large\""));
        let verdicts = rows.into_iter().map(|row| (row.pass, row.unmet.is_some(), row.reason));
        verdicts.collect::<Vec<_>>()
    };
    let (met, unmet) = ((true, false, None), (false, true, None));
    // Amplitudes 1, 2, 4 with two kernels each.
    let [one, two, four] = [met, unmet.clone(), unmet];
    let each = [one.clone(), one, two.clone(), two, four.clone(), four];
    assert_eq!(check(1.5), each);
    let marked = check(9.0);
    assert_eq!(marked.len(), 6);
    for (pass, excused, reason) in marked {
        assert!(!pass && !excused && reason.unwrap().contains("remove `unmet`"));
    }
}

#[test]
fn members_follow_each_other_along_a_key() {
    let lines = "sweep = \"size\"\nalong = \"parameters.amplitude\"\n";
    for (trend, pass) in [
        ("monotone = \"increasing\"", true),
        ("monotone = \"decreasing\"", false),
        ("ratio = [1.9, 2.1]", true),
        ("ratio = [2.1, 2.2]", false),
        // Amplitudes 1, 2, 4 differ by 1, 2: of first order in the amplitude.
        ("order = [0.9, 1.1]", true),
        ("order = [1.1, 1.2]", false),
        // The errors to 0 are the amplitudes themselves.
        ("expected = 0\norder = [0.99, 1.01]", true),
        // To 5 they are 4, 3, 1.
        ("expected = 5\nmonotone = \"decreasing\"", true),
        ("expected = 5\nratio = [0.33, 0.75]", true),
        ("expected = 5\norder = [0.9, 1.1]", false),
        // Each member has its own expected value: there is no error, and no order.
        ("expected = \"amplitude\"\norder = [0.9, 1.1]", false),
    ] {
        let rows = sweep_rows(&format!("{lines}{trend}"));
        assert_eq!(rows.len(), 2, "one for each kernel");
        for (row, kernel) in rows.iter().zip(["cubic_spline", "lucy"]) {
            assert_eq!(row.pass, pass, "{trend}: {row:?}");
            assert_eq!(row.run, Some(format!("sweep size (scheme.kernel={kernel})")));
            assert!(row.expected.ends_with(" along parameters.amplitude"));
            assert_eq!(row.reason.is_none(), pass);
        }
    }
    let row = &sweep_rows(&format!("{lines}expected = 5\nmonotone = \"decreasing\""))[0];
    assert_eq!(row.quantity, "error of top.displacement.x maximum");
    assert_eq!(row.got, Some(Got::Text("4, 3, 1 m".into())));
    let points = &row.trend.as_ref().unwrap().points;
    assert_eq!(points[2].member, "size.5");
    assert_eq!((points[2].key, points[2].value, points[2].error), (Some(4.0), 4.0, Some(1.0)));
    // The kernels are no numbers, but members still follow each other.
    let rows = sweep_rows(
        "sweep = \"size\"\nalong = \"scheme.kernel\"\nratio = [0.99, 1.01]\nwhen = \"case\"",
    );
    assert_eq!((rows.len(), rows.iter().all(|row| row.pass)), (3, true));
}

#[test]
fn each_member_runs_once_and_only_where_it_is_needed() {
    let checks = [
        of_sweep("sweep = \"small\"\nmonotone = \"decreasing\""),
        of_sweep(
            "sweep = \"size\"\nalong = \"scheme.kernel\"\nratio = [0.9, 1.1]\nwhen = \"case\"",
        ),
        of_sweep("sweep = \"size\"\nmember = { scheme.kernel = \"lucy\" }\nat_most = 9"),
    ];
    let checks = format!("{SWEEP}{}", checks.concat());
    for (level, count) in [(Level::Coarse, 3), (Level::Case, 8)] {
        let ran = std::cell::RefCell::new(Vec::new());
        let rows = rows_of(&checks, level, |variant, case| {
            ran.borrow_mut().push(variant.unwrap().to_owned());
            Ok(completed(case.parameter("amplitude").unwrap()))
        });
        let mut ran = ran.into_inner();
        assert_eq!(ran.len(), count);
        ran.sort();
        ran.dedup();
        assert_eq!(ran.len(), count, "a member ran twice");
        assert!(rows.iter().all(|row| row.pass), "{rows:?}");
        assert_eq!(rows.len(), if level == Level::Coarse { 3 } else { 1 + 3 + 3 });
    }
}

#[test]
fn a_member_that_fails_fails_the_rows_that_need_it() {
    let checks = format!(
        "{SWEEP}{}{}",
        of_sweep("sweep = \"small\"\nmonotone = \"decreasing\""),
        of_sweep("sweep = \"small\"\nat_most = 9")
    );
    let rows = rows_of(&checks, Level::Case, |variant, _| match variant {
        Some("small.2") => Ok(Fake { outcome: inverted(), ..completed(1.0) }),
        _ => Ok(completed(1.0)),
    });
    let passed: Vec<bool> = rows.iter().map(|row| row.pass).collect();
    assert_eq!(passed, [false, true, false]);
    let reason = rows[0].reason.as_ref().unwrap();
    assert!(reason.starts_with("small.2 (parameters.amplitude=1 / 2): the run failed"), "{reason}");
    // A failure that a check announces is a result.
    let announced = "[[check]]\nquantity = \"run.outcome\"\nsweep = \"small\"\nsource = \"s\"\n\
                     member = { parameters.amplitude = \"1 / 2\" }\nexpected = \"failed: inverted\"\n";
    let rows = rows_of(&format!("{checks}{announced}"), Level::Case, |variant, _| match variant {
        Some("small.2") => Ok(Fake { outcome: inverted(), ..completed(0.5) }),
        _ => Ok(completed(1.0)),
    });
    assert!(rows.iter().all(|row| row.pass), "{rows:?}");
}
