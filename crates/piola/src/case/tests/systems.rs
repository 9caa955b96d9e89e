//! Several systems in a case file.

use super::*;
use crate::case::Session;

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
            "scheme = { kind = \"elastodynamics\" }",
            "scheme = { kind = \"dual_support\" }\ntime = { integrator = \"static\" }",
            "nothing moves with this integrator, and a fluid does",
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
            "overlaps another",
        ),
    ];
    for (from, to, expected) in faults {
        let said = said(from, to);
        assert!(said.contains(expected) && said.contains("case.toml:"), "for {to}\n{said}");
    }
}
