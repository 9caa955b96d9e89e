//! Which integrator moves which scheme.

use super::*;
use crate::schemes::{Capability, SchemeDescription};
use crate::time::IntegratorKind;

/// A block that stands on its lowest particles, of a material and a scheme.
fn block(material: &str, scheme: &str, integrator: IntegratorKind) -> String {
    let needs_step =
        integrator.needs() == Capability::Newmark || integrator.needs() == Capability::Theta;
    let step = if needs_step { "step = 1e-5" } else { "" };
    let (support, end) = match integrator.is_static() {
        true => ("displacement = { x = \"0\", y = \"0\" }", 1.0),
        false => ("velocity = { x = \"0\", y = \"0\" }", 1e-4),
    };
    // The strong form takes particles on its edges.
    let (lattice, floor) = match scheme.contains("strong") {
        true => ("lattice = { on = \"boundary\" }\n", 0.0),
        false => ("", 0.05),
    };
    let held = match scheme.contains("transport_velocity") {
        true => String::new(),
        false => format!(
            "[[boundary]]\nname = \"floor\"\n\
             where = {{ kind = \"plane\", point = [0.0, {floor}], normal = [0.0, 1.0] }}\n{support}\n"
        ),
    };
    format!(
        "version = 1\ntitle = \"A block\"\ndimension = 2\n\
         [[body]]\nname = \"block\"\nshape = {{ kind = \"box\", min = [0.0, 0.0], max = [1.0, 1.0] }}\n\
         spacing = 0.1\n{lattice}material = {{ {material} }}\n{held}\n\
         [[load]]\nkind = \"body_force\"\nacceleration = [\"0\", \"-t\"]\n\
         [scheme]\n{scheme}\n[time]\nend = {end}\nintegrator = \"{}\"\n{step}\n",
        integrator.name()
    )
}

/// Every pair is either served, from the reader of cases to the end of a run, or refused when the
/// case is read, at the name of the integrator, with the list of those that can.
#[test]
fn every_pair_is_served_or_refused_in_its_place() {
    const ALL: &str =
        "tvd_rk2 ssp_rk3 kick_drift_kick newmark hht_alpha generalised_alpha static arc_length";
    let linear = "kind = \"linear\", density = 1000.0, bulk_modulus = 1e5";
    let rubber =
        "kind = \"neo_hookean\", density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3";
    let fluid = "kind = \"weakly_compressible\", density = 1000.0, wave_speed = 10.0";
    let upwind = "kind = \"upwind\"\nsmoothing_length = 1.0\ntau_velocity";
    let schemes = [
        (
            linear,
            format!("{upwind} = 0.5"),
            "tvd_rk2 ssp_rk3 backward_euler crank_nicolson theta implicit_midpoint",
        ),
        (
            linear,
            format!("{upwind} = 0.0"),
            "tvd_rk2 ssp_rk3 kick_drift_kick backward_euler crank_nicolson theta implicit_midpoint",
        ),
        (fluid, "kind = \"transport_velocity\"".to_owned(), "kick_drift_kick"),
        (rubber, "kind = \"total_lagrangian\"".to_owned(), ALL),
        (rubber, "kind = \"dual_support\"".to_owned(), ALL),
        (rubber, "kind = \"elastodynamics\"".to_owned(), ALL),
        (rubber, "kind = \"elastodynamics\"\nform = \"strong\"".to_owned(), "kick_drift_kick"),
    ];
    for (material, scheme, expected) in &schemes {
        let mut served = Vec::new();
        for kind in IntegratorKind::ALL {
            let text = block(material, scheme, kind);
            match read_with(&text, &[]) {
                Ok(case) => {
                    served.push(kind.name());
                    let built = Session::new(&case);
                    let built =
                        built.unwrap_or_else(|problems| panic!("{scheme}, {kind:?}: {problems}"));
                    let run = built.run(&Default::default(), &mut |_| {}).unwrap();
                    assert_eq!(run.summary.outcome.summary(), "completed", "{scheme}, {kind:?}");
                    assert!(run.summary.steps > 0, "{scheme}, {kind:?}");
                }
                Err(problems) => {
                    let message = problems.to_string();
                    let line =
                        text.lines().position(|line| line.starts_with("integrator")).unwrap() + 1;
                    let name = format!("the integrator `{}` cannot move the scheme", kind.name());
                    let able: Vec<String> =
                        expected.split(' ').map(|it| format!("`{it}`")).collect();
                    for part in able.iter().chain([&name, &format!("case.toml:{line}:14")]) {
                        assert!(message.contains(part), "{scheme}, {kind:?}: {message}");
                    }
                }
            }
        }
        assert_eq!(served.join(" "), *expected, "{scheme}");
    }
    // What is interpolated does not move, so that its cases have no clock.
    let tested: Vec<&str> = SchemeDescription::ALL.iter().map(|it| it.name).collect();
    let covered = |name: &&str| schemes.iter().any(|(_, scheme, _)| scheme.contains(*name));
    assert_eq!(tested.iter().filter(|name| !covered(name)).collect::<Vec<_>>(), [&"interpolation"]);
}
