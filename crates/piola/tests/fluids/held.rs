//! Particles of solids that move as prescribed: where they go, and what that takes.

use piola::time::Outcome;

use super::escapes::{run, values};

/// A bar whose left end is moved.
const BAR: &str = r#"
version = 1
title = "A bar is shaken at its end"
dimension = 2

[parameters]
dx = 0.1

[[body]]
name = "bar"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 0.4] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "hypoelastic", density = 1000, bulk_modulus = 1e6, shear_modulus = 4e5 }

[scheme]
kind = "transport_velocity"
artificial_viscosity = 1.0

[[boundary]]
name = "end"
body = "bar"
where = { kind = "half_space", point = [0.3, 0.0], normal = [-1.0, 0.0] }
velocity = { x = "0.4", y = "3 * t" }

[time]
end = 0.05

[[probe]]
name = "end"
kind = "particle"
body = "bar"
at = [0.15, 0.15]
fields = ["position", "velocity"]

[[probe]]
name = "free"
kind = "particle"
body = "bar"
at = [0.95, 0.15]
fields = ["position"]

[output]
table_every = 0.005
"#;

const SHIFTINGS: [&str; 3] = ["spst", "ipst", "background"];

#[test]
fn held_particles_go_where_their_velocity_leads() {
    for shifting in SHIFTINGS {
        let finished = run(BAR, &[&format!("scheme.shifting='{shifting}'")]);
        assert_eq!(finished.summary.outcome, Outcome::Completed, "{shifting}");
        let columns = ["time", "end.position.x", "end.position.y", "end.velocity.y"];
        let [t, x, y, v] = columns.map(|name| values(&finished, name));
        // A drift takes the velocity half way, which is exact where it is linear in time.
        for (k, &t) in t.iter().enumerate() {
            assert!((x[k] - (0.15 + 0.4 * t)).abs() < 1e-14, "{shifting}: {} at {t}", x[k]);
            assert!((y[k] - (0.15 + 1.5 * t * t)).abs() < 1e-14, "{shifting}: {} at {t}", y[k]);
            assert!((v[k] - 3.0 * t).abs() < 1e-14, "{shifting}: {} at {t}", v[k]);
        }
        let free = values(&finished, "free.position.x");
        assert!(free.last() > Some(&0.955), "the other end follows");
    }
}

#[test]
fn the_ledger_is_exact_where_velocities_are_set() {
    let shaken = "boundary.end.velocity.y='0.3 * sin(200 * t)'";
    let corrected = "scheme.corrected_gradients=true";
    for set in [&[][..], &[shaken], &[shaken, corrected], &["scheme.shifting='ipst'"]] {
        let finished = run(BAR, set);
        assert_eq!(finished.summary.outcome, Outcome::Completed, "{set:?}");
        let largest =
            |name: &str| values(&finished, name).iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!(largest("energy.walls") > 1.0 && largest("energy.kinetic") > 1.0);
        let balance = largest("energy.balance");
        assert!(balance < 1e-11 * largest("energy.walls"), "{set:?}: {balance:e} J");
        // Stresses do not act along the line between two particles: angular momentum has no such balance.
        for component in ["linear.x", "linear.y"] {
            let impulse = largest(&format!("momentum.walls.{component}"));
            let balance = largest(&format!("momentum.balance.{component}"));
            assert_eq!(largest(&format!("momentum.removed.{component}")), 0.0, "{set:?}");
            assert!(balance < 1e-11 * impulse, "{set:?} {component}: {balance:e} of {impulse}");
        }
    }
}
