//! Implicit steps of the scheme `upwind`.

use super::read_with;
use crate::case::model::{Case, StepControl};
use crate::case::template;
use crate::schemes::Theta;
use crate::solve::LinearMethod;

/// The template with other keys in place of its CFL number.
fn read(time: &str) -> Result<Case, String> {
    let text = template::new_case("a column");
    assert!(text.contains("cfl = 0.3 "), "{text}");
    read_with(&text.replacen("cfl = 0.3 ", &format!("{time}\n# "), 1), &[])
        .map_err(|problems| problems.to_string())
}

#[test]
fn each_rule_has_its_name_and_steps_of_any_size() {
    for (name, rule) in [
        ("backward_euler", Theta::BACKWARD_EULER),
        ("crank_nicolson", Theta::CRANK_NICOLSON),
        ("implicit_midpoint", Theta::MIDPOINT),
        ("theta", Theta::DAMPED),
    ] {
        let case = read(&format!("integrator = \"{name}\"\nstep = 0.5"));
        let time = case.unwrap_or_else(|problems| panic!("{problems}")).time;
        assert_eq!((time.theta, time.step.value), (Some(rule), StepControl::AtMost(0.5)), "{name}");
        assert_eq!(time.newmark, None);
    }
    let solver = "integrator = \"theta\"\nstep = 0.5\ntolerance = 1e-9\nlinear_solver = \"krylov\"";
    let time = read(solver).unwrap_or_else(|problems| panic!("{problems}")).time;
    assert_eq!((time.tolerance, time.linear_solver), (Some(1e-9), LinearMethod::Krylov));
    let case = read("integrator = \"theta\"\ntheta = 0.75\nstep = 0.5\non_failure = \"retry\"");
    let rule = case.unwrap_or_else(|problems| panic!("{problems}")).time.theta;
    assert_eq!(rule, Theta::new(0.75).ok());
}

#[test]
fn what_has_no_meaning_is_refused() {
    for (time, parts) in [
        ("integrator = \"crank_nicolson\"", ["`step` is missing", "multiples of the stable"]),
        ("integrator = \"theta\"\nstep = 0.1\ntheta = 0.4", ["`theta`", "0.5"]),
        ("cfl = 0.3\ntheta = 0.6", ["`theta` has no meaning", "with this integrator"]),
        (
            "integrator = \"newmark\"\nstep = 0.1",
            ["implicit steps of this kind", "`crank_nicolson`"],
        ),
    ] {
        let message = read(time).expect_err(time);
        for part in parts {
            assert!(message.contains(part), "{time}: {message}");
        }
    }
}
