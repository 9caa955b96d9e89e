//! Several systems in a case file.

use super::*;
use crate::case::Session;
use crate::case::model::Scheme;
use crate::schemes::transport_velocity::PressureRule;

const GOOD: &str = "\
version = 1
title = \"A block in water\"
dimension = 2

[[body]]
name = \"water\"
shape = { kind = \"box\", min = [0.0, 0.0], max = [1.0, 0.5] }
spacing = 0.1
lattice = { on = \"cells\" }
material = { kind = \"weakly_compressible\", density = 1000.0, wave_speed = 10.0 }

[[body]]
name = \"block\"
system = \"block\"
shape = { kind = \"box\", min = [0.0, 0.5], max = [1.0, 0.8] }
spacing = 0.1
lattice = { on = \"cells\" }
material = { kind = \"linear_elastic\", density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3 }

[scheme]
kind = \"transport_velocity\"

[[system]]
name = \"block\"
scheme = { kind = \"elastodynamics\" }

[[boundary]]
name = \"left\"
body = \"block\"
where = { kind = \"half_space\", point = [0.1, 0.0], normal = [-1.0, 0.0] }
velocity = { x = \"0\" }

[time]
end = 0.01

[[probe]]
name = \"block\"
kind = \"particle\"
body = \"block\"
at = [0.0, 0.5]
fields = [\"displacement\", \"von_mises\"]

[[probe]]
name = \"water\"
body = \"water\"
kind = \"extremum\"
of = \"largest\"
field = \"vorticity\"

[output]
fields = [\"velocity\", \"pressure\", \"determinant\"]

[[check]]
quantity = \"energy.block.interface\"
reduce = \"final\"
expected = 0.0
tolerance = 1.0
absolute = true
against = \"own\"
source = \"a test\"
reason = \"a test\"
";

/// What is said of the good case with `from` replaced by `to`, of its text or of its bodies.
fn said(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    let read = read_with(&GOOD.replacen(from, to, 1), &[]);
    let refused = read.and_then(|case| Session::new(&case).map(|_| ()));
    refused.expect_err(to).to_string()
}

#[test]
fn each_system_has_its_own_fields_bodies_and_steps() {
    let case = read_with(GOOD, &[]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(case.systems.len(), 1);
    assert_eq!(case.bodies.iter().map(|body| body.system).collect::<Vec<_>>(), [None, Some(0)]);
    assert_eq!(case.systems[0].time.integrator.value, "kick_drift_kick");
    let part = case.part(Some(0));
    assert_eq!((part.bodies.len(), part.probes.len(), part.boundaries.len()), (1, 1, 1));
    let fluid = case.part(None);
    assert!(fluid.bodies[1].wall.is_some() && fluid.boundaries.is_empty());
    let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    // Water and block, without the particles of the water that stand for the block.
    assert_eq!(session.ids().len(), 50 + 30);
    let all = session.column("determinant").expect("one of them has it").values;
    assert!(all[..50].iter().all(|value| value.is_nan()), "water has no determinant");
    assert!(all[50..].iter().all(|value| *value == 1.0));
    session.step().expect("it starts");
    assert_eq!(session.scheme().bodies()[50..], [1; 30]);
}

/// Scheme, material and fields of a block of each formulation that is no preset of the total Lagrangian solid.
const OTHERS: [[&str; 3]; 2] = [
    [
        "{ kind = \"upwind\", smoothing_length = 0.7 }",
        "{ kind = \"gamma_law\", density = 1000.0, bulk_modulus = 1e6, gamma = 2.0 }",
        "\"displacement\", \"volume_ratio\"",
    ],
    [
        "{ kind = \"transport_velocity\", contact = \"full\" }",
        "{ kind = \"hypoelastic\", density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3 }",
        "\"displacement\", \"von_mises\"",
    ],
];

/// The good case with a block of another formulation.
fn with_block([scheme, material, fields]: [&str; 3]) -> String {
    let old = [
        "{ kind = \"elastodynamics\" }",
        "{ kind = \"linear_elastic\", density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3 }",
        "\"displacement\", \"von_mises\"",
    ];
    let new = [scheme, material, fields];
    let text = GOOD.replace(", \"determinant\"]", "]");
    old.iter().zip(new).fold(text, |text, (old, new)| {
        assert!(text.contains(old), "{old}");
        text.replacen(old, new, 1)
    })
}

#[test]
fn solids_of_other_formulations_are_systems_with_settings_and_fields_of_their_own() {
    for block in OTHERS {
        let case =
            read_with(&with_block(block), &[]).unwrap_or_else(|problems| panic!("{problems}"));
        let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
        session.step().expect("it starts");
        // Both have a velocity; what the water does to the block is there whatever forces it knows itself.
        for name in ["velocity", "displacement", "force"] {
            let values = session.column(name).expect(name).values;
            let of_block = &values[2 * 50..];
            assert_eq!(of_block.len(), 2 * 30, "{name}");
            assert!(of_block.iter().all(|value| value.is_finite()), "{name} {block:?}");
        }
        assert_eq!(session.scheme().bodies()[50..], [1; 30]);
    }
    let case = read_with(&with_block(OTHERS[1]), &[]).expect("it is read");
    let settings = |scheme: &Scheme| match scheme {
        Scheme::TransportVelocity(own) => own.settings,
        other => panic!("{other:?}"),
    };
    let [water, block] = [settings(&case.scheme), settings(&case.systems[0].scheme)];
    assert!(matches!(water.pressure, PressureRule::Edac { .. }) && !water.free_surface);
    assert!(block.pressure == PressureRule::StateEquation && block.free_surface);
    let text = with_block(OTHERS[1]).replace(
        OTHERS[1][1],
        "{ kind = \"weakly_compressible\", density = 1000.0, wave_speed = 10.0 }",
    );
    let problems = read_with(&text, &[]).expect_err("two fluids").to_string();
    assert!(problems.contains("the body `block` belongs to a solid in the fluid"), "{problems}");
    assert!(problems.contains("use `hypoelastic`, or leave `system` out"), "{problems}");
}

/// What a scheme that is not known would not know is not told.
#[test]
fn a_scheme_of_a_system_that_is_not_known_is_told_once() {
    let said = said("kind = \"elastodynamics\"", "kind = \"elastodynamic\"");
    assert!(said.contains("did you mean `elastodynamics`?"), "{said}");
    assert_eq!(said.matches("error: ").count(), 1, "{said}");
}

#[test]
fn what_does_not_fit_together_is_named_in_its_place() {
    let faults = [
        ("system = \"block\"", "system = \"blok\"", "did you mean `block`?"),
        ("system = \"block\"\n", "", "no body belongs to this system"),
        (
            "kind = \"elastodynamics\"",
            "kind = \"interpolation\"",
            "the scheme `interpolation` has no surface that a fluid could follow",
        ),
        (
            "kind = \"elastodynamics\"",
            "kind = \"upwind\", smoothing_length = 0.7",
            "the scheme `upwind` does not know this material",
        ),
        (
            "scheme = { kind = \"elastodynamics\" }",
            "scheme = { kind = \"upwind\", smoothing_length = 0.7, tau_velocity = 0.5 }\ntime = { integrator = \"kick_drift_kick\" }",
            "cannot move the scheme `upwind` where it dissipates",
        ),
        (
            "scheme = { kind = \"elastodynamics\" }",
            "scheme = { kind = \"upwind\", smoothing_length = 0.7 }\ntime = { integrator = \"newmark\" }",
            "the integrator `newmark` cannot move the scheme `upwind`",
        ),
        ("kind = \"elastodynamics\"", "kind = \"transport_velocity\"", "use `hypoelastic`"),
        (
            "kind = \"elastodynamics\"",
            "kind = \"transport_velocity\", density = \"summation\"",
            "the density of solids is found by the continuity equation",
        ),
        (
            "kind = \"elastodynamics\"",
            "kind = \"transport_velocity\", escaped = \"remove\"",
            "`escaped` has no meaning for a solid in a fluid",
        ),
        (
            "scheme = { kind = \"elastodynamics\" }",
            "scheme = { kind = \"transport_velocity\" }\ntime = { integrator = \"tvd_rk2\" }",
            "the integrator `tvd_rk2` cannot move the scheme `transport_velocity`",
        ),
        (
            "[scheme]\nkind = \"transport_velocity\"",
            "[scheme]\nkind = \"transport_velocity\"\ncontact = \"full\"",
            "`contact` has no meaning for fluids",
        ),
        (
            "scheme = { kind = \"elastodynamics\" }",
            "scheme = { kind = \"dual_support\" }\ntime = { integrator = \"static\" }",
            "nothing moves with this integrator, but a fluid does",
        ),
        (
            "scheme = { kind = \"elastodynamics\" }",
            "scheme = { kind = \"elastodynamics\" }\ntime = { cfl = 0 }",
            "`cfl` must be above 0, got 0",
        ),
        (
            "system = \"block\"\n",
            "system = \"block\"\nwall = { slip = \"no\" }\n",
            "the body `block` belongs to a system, and is no wall",
        ),
        (
            "name = \"left\"\nbody = \"block\"\n",
            "name = \"left\"\n",
            "a boundary needs the key `body`",
        ),
        (
            "name = \"water\"\nbody = \"water\"\n",
            "name = \"water\"\n",
            "a probe needs the key `body`",
        ),
        ("field = \"vorticity\"", "field = \"von_mises_\"", "has no field `von_mises_`"),
        ("\"determinant\"]", "\"determinat\"]", "did you mean `determinant`?"),
        (
            "energy.block.interface",
            "energy.blok.interface",
            "did you mean `energy.block.interface`?",
        ),
        ("max = [1.0, 0.8] }\nspacing = 0.1", "max = [1.0, 0.8] }\nspacing = 0.025", "factor of 3"),
        (
            "min = [0.0, 0.5], max = [1.0, 0.8]",
            "min = [0.0, 0.4], max = [1.0, 0.7]",
            "the bodies of the system `block` and others overlap: particle",
        ),
        ("max = [1.0, 0.8]", "max = [1.0, 0.6]", "refine the spacing"),
    ];
    for (from, to, expected) in faults {
        let said = said(from, to);
        assert!(said.contains(expected) && said.contains("case.toml:"), "for {to}\n{said}");
    }
}

/// A wall, a periodic axis, or gravity.
#[test]
fn a_fluid_that_nothing_holds_is_warned_of() {
    let warns = |text: &str| {
        let case = read_with(text, &[]).unwrap_or_else(|problems| panic!("{problems}"));
        let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
        let warnings = session.plan().warnings;
        warnings.iter().any(|text| text.starts_with("nothing holds the fluid `water`"))
    };
    assert!(warns(GOOD), "a solid does not");
    let wall = GOOD[GOOD.find("[[body]]").expect("water")
        ..GOOD.find("[[body]]\nname = \"block\"").expect("block")]
        .replace("water", "floor")
        .replace("min = [0.0, 0.0], max = [1.0, 0.5]", "min = [0.0, -0.3], max = [1.0, 0.0]");
    for more in [
        format!("{wall}wall = {{ slip = \"no\" }}\n"),
        "[domain]\nperiodic = { x = [0.0, 1.0] }\n".to_owned(),
        "[[load]]\nkind = \"body_force\"\nacceleration = [\"0\", \"-9.81\"]\n".to_owned(),
    ] {
        assert!(!warns(&format!("{GOOD}{more}")), "{more}");
    }
}
