//! Functions from outside in place of expressions.

use std::sync::Arc;

use super::super::*;
use super::at_a_tenth;
use crate::boundaries::SpaceTime;

/// `a x + b sin(t)`, as `a * x + b * sin(t)` of a case.
struct Push {
    a: f64,
    b: f64,
}

impl SpaceTime for Push {
    fn value(&self, x: [f64; 3], t: f64) -> f64 {
        self.a * x[0] + self.b * t.sin()
    }

    fn rate(&self, _x: [f64; 3], t: f64) -> f64 {
        self.b * t.cos()
    }

    fn is_steady(&self) -> bool {
        self.b == 0.0
    }

    fn is_uniform(&self) -> bool {
        self.a == 0.0
    }
}

/// A column that is pushed, with a floor that moves.
fn text(initial: &str, push: &str, floor: &str) -> String {
    template::new_case("a column").replace("\"-speed\"", initial).replace("y = \"0\"", floor)
        + &format!("\n[[load]]\nkind = \"body_force\"\nacceleration = [{push}, \"0\"]\n")
}

fn options(functions: Functions) -> LoadOptions {
    LoadOptions { functions, level: Level::Coarse, ..LoadOptions::default() }
}

fn known() -> Functions {
    let mut functions = Functions::default();
    for (name, a, b) in [("start", 0.25, 0.0), ("push", 2.0, 3.0), ("floor", 0.0, 0.5)] {
        functions.insert(name, Arc::new(Push { a, b }));
    }
    functions
}

#[test]
fn functions_give_the_bits_of_expressions() {
    let [one, other] = [
        text("\"@start\"", "\"@push\"", "y = \"@floor\""),
        text("\"0.25 * x\"", "\"2 * x + 3 * sin(t)\"", "y = \"0.5 * sin(t)\""),
    ]
    .map(|text| at_a_tenth(&parse(&text, "case.toml", &options(known())).unwrap()));
    assert_eq!(one, other);
}

#[test]
fn functions_that_are_not_there_are_refused_with_their_place() {
    let text = text("\"0\"", "\"@pull\"", "y = \"0\"");
    let found = |functions| parse(&text, "case.toml", &options(functions)).unwrap_err();
    let problems = found(Functions::default());
    assert_eq!(problems.len(), 1);
    let problem = problems.iter().next().unwrap();
    assert_eq!(problem.message, "there is no function `@pull`");
    assert_eq!(&text[problem.place.unwrap().span()], "\"@pull\"");
    assert!(problem.help.as_ref().unwrap().contains("write an expression"));
    let help = found(known()).iter().next().unwrap().help.clone();
    assert_eq!(help.unwrap(), "functions are given by a program; there is `@start`");
}

#[test]
fn what_is_of_the_start_takes_no_function_of_time() {
    let text = text("\"@push\"", "\"0\"", "y = \"0\"");
    let problems = parse(&text, "case.toml", &options(known())).unwrap_err();
    let problem = problems.iter().next().unwrap();
    let expected = "`velocity` is the same at all times, and `@push` is a function of t";
    assert_eq!((problems.len(), problem.message.as_str()), (1, expected));
}

/// What is left of a run has the names alone.
#[test]
fn records_are_read_without_their_functions() {
    let text = text("\"@start\"", "\"@push\"", "y = \"@floor\"");
    let case = parse(&text, "case.toml", &options(known())).unwrap();
    assert!(case.as_run.contains("@push"));
    assert!(recorded(&case.as_run, None).is_ok());
    assert!(known() != known() && options(known()) != options(Functions::default()));
}

#[test]
fn derivatives_of_functions_are_theirs_or_quotients() {
    let push = Expression::outside("@push", Arc::new(Push { a: 2.0, b: 3.0 }));
    let place = [0.7, 0.0, 0.0];
    assert_eq!(push.eval(place, 0.2), 2.0 * 0.7 + 3.0 * 0.2_f64.sin());
    assert_eq!(push.rate(place, 0.2), 3.0 * 0.2_f64.cos());
    let slope = push.derivative(expression::Variable::X, place, 0.2);
    // Rounding of values of about 2 over steps of 1e-6.
    assert!((slope - 2.0).abs() < 1e-9, "{slope}");
    assert!(push.as_constant().is_none() && push.depends_on_position());
}
