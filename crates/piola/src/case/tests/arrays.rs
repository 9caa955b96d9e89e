//! Arrays from outside in place of initial fields.

use std::sync::Arc;

use super::super::*;
use super::at_a_tenth;

fn options(arrays: &[(&str, Vec<f64>)]) -> LoadOptions {
    let mut known = Arrays::default();
    for (name, values) in arrays {
        known.insert(*name, Arc::from(values.as_slice()));
    }
    LoadOptions { arrays: known, level: Level::Coarse, ..LoadOptions::default() }
}

fn column(velocity: &str) -> String {
    template::new_case("a column").replace("\"-speed\"", velocity)
}

#[test]
fn arrays_give_the_bits_of_expressions() {
    let [plain, given] = ["\"0.25 * x * y\"", "\"@down\""].map(column);
    let plain = parse(&plain, "case.toml", &options(&[])).unwrap();
    let values = plain.positions(0).unwrap();
    let values = values.chunks_exact(2).map(|x| 0.25 * x[0] * x[1]).collect();
    let given = parse(&given, "case.toml", &options(&[("down", values)])).unwrap();
    assert!(plain.positions(1).unwrap().is_empty());
    assert_eq!(at_a_tenth(&plain), at_a_tenth(&given));
}

#[test]
fn arrays_of_another_length_are_refused_where_the_case_names_them() {
    let text = column("\"@down\"");
    let case = parse(&text, "case.toml", &options(&[("down", vec![0.0; 7])])).unwrap();
    let problems = Session::new(&case).err().unwrap();
    let problem = problems.iter().next().unwrap();
    let expected = "the array for `velocity` of the body `column` has 7 rows, expected 66: one for each of its particles, \
                    in the order of creation";
    assert_eq!((problems.len(), problem.message.as_str()), (1, expected));
    assert_eq!(&text[problem.place.unwrap().span()], "{ velocity = [\"0\", \"@down\"] }");
}

#[test]
fn arrays_stand_in_initial_states_alone() {
    let named = [("down", vec![0.0; 66])];
    let text =
        column("\"0\"") + "\n[[load]]\nkind = \"body_force\"\nacceleration = [\"@down\", \"0\"]\n";
    let problems = parse(&text, "case.toml", &options(&named)).unwrap_err();
    assert_eq!(problems.iter().next().unwrap().message, "there is no function `@down`");
    // What is left of a run has the name alone.
    let case = parse(&column("\"@down\""), "case.toml", &options(&named)).unwrap();
    assert!(case.as_run.contains("@down") && recorded(&case.as_run, None).is_ok());
}

#[test]
fn what_flows_in_has_no_row() {
    let text = include_str!("../../../../../cases/open/channel/case.toml");
    let overrides = vec!["body.water.initial.velocity=['@all', '@all']".to_owned()];
    let case =
        parse(text, "case.toml", &LoadOptions { overrides, ..options(&[("all", vec![0.0])]) });
    let problems = Session::new(&case.unwrap()).err().unwrap().to_string();
    assert!(
        problems.contains("no values for the particles in the buffers of openings"),
        "{problems}"
    );
}
