//! Implicit steps of the scheme `upwind`.

use super::read_with;
use crate::case::model::{Case, StepControl};
use crate::case::template;
use crate::schemes::{ImplicitRule, Theta};
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
        assert_eq!(
            (time.rule, time.step.value),
            (Some(ImplicitRule::Theta(rule)), StepControl::AtMost(0.5)),
            "{name}"
        );
    }
    let solver = "integrator = \"theta\"\nstep = 0.5\ntolerance = 1e-9\nlinear_solver = \"krylov\"";
    let time = read(solver).unwrap_or_else(|problems| panic!("{problems}")).time;
    assert_eq!((time.tolerance, time.linear_solver), (Some(1e-9), LinearMethod::Krylov));
    let case = read("integrator = \"theta\"\ntheta = 0.75\nstep = 0.5\non_failure = \"retry\"");
    let rule = case.unwrap_or_else(|problems| panic!("{problems}")).time.rule;
    assert_eq!(rule, Theta::new(0.75).ok().map(ImplicitRule::Theta));
}

#[test]
fn what_has_no_meaning_is_refused() {
    let time = "integrator = \"newmark\"\nstep = 0.1\nerror = 1e-3";
    assert!(read(time).is_err_and(|message| !message.contains("`error`")));
    let time = "integrator = \"crank_nicolson\"\nstep = 0.1\nerror = 1e-3";
    assert_eq!(read(time).map(|case| case.time.error), Ok(Some(1e-3)));
    let probe = "error = 1e-3\n[[probe]]\nname = \"tangent\"\nkind = \"tangent\"\nstep = 0.1";
    let message = read(&format!("integrator = \"tvd_rk2\"\n{probe}")).expect_err("explicit");
    assert!(message.contains("which the integrator `tvd_rk2` does not have"), "{message}");
    let message = read("error = 1e-3").expect_err("explicit");
    assert!(message.contains("`error` has no meaning without implicit steps"), "{message}");

    for (time, parts) in [
        ("integrator = \"crank_nicolson\"", ["`step` is missing", "multiples of the stable"]),
        ("integrator = \"theta\"\nstep = 0.1\ntheta = 0.4", ["`theta`", "0.5"]),
        ("cfl = 0.3\ntheta = 0.6", ["`theta` has no meaning", "with this integrator"]),
        (
            "integrator = \"newmark\"\nstep = 0.1",
            ["cannot move the scheme `upwind`", "`crank_nicolson`"],
        ),
    ] {
        let message = read(time).expect_err(time);
        for part in parts {
            assert!(message.contains(part), "{time}: {message}");
        }
    }
}
