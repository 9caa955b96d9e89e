//! Runs whose reserve of particles grows, compared with runs that had enough of them.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use piola::case::{self, LoadOptions};

use super::resume::{assert_same, cases, load, run};

/// A tank that is filled from an opening, with few particles in reserve and with enough from the start: no byte of any file
/// differs. Nor does it where that run was broken off before
/// and after.
#[test]
fn a_run_that_needs_more_particles_is_one_that_had_them() {
    let with = |reserve: usize| {
        let overrides = vec![format!("scheme.reserve={reserve}")];
        let options = LoadOptions { overrides, ..LoadOptions::default() };
        case::parse(FILLING, "filling.toml", &options)
            .unwrap_or_else(|problems| panic!("{problems}"))
    };
    let folder = tempfile::tempdir().unwrap();
    let [few, many, broken] = ["few", "many", "broken"].map(|name| folder.path().join(name));
    let whole = run(&with(400), &many, false, 1, u64::MAX);
    let made = run(&with(3), &few, false, 2, u64::MAX);
    assert_same(&many, &few, "a tank with few in reserve");
    assert!(
        whole.notes.is_empty() && made.notes[0].contains("the reserve ran out"),
        "{:?}",
        made.notes
    );
    let steps = whole.summary.steps;
    assert_eq!(made.summary.steps, steps);
    run(&with(3), &broken, false, 2, 20);
    run(&with(3), &broken, true, 1, steps / 2);
    run(&with(3), &broken, true, 2, u64::MAX);
    assert_same(&many, &broken, "a tank that was broken off");
}

/// Nor where a solid is in the fluid, whose particles come after those of the reserve.
#[test]
fn a_fluid_with_a_solid_that_needs_more_particles_is_one_that_had_them() {
    let all = cases();
    let beam = all.iter().find(|path| path.ends_with("turek-hron/case.toml")).unwrap();
    let closed = "body.outlet.opening={ normal = [-1.0, 0.0], velocity = ['0', '0'] }";
    let folder = tempfile::tempdir().unwrap();
    let [few, many] = [1, 3000].map(|reserve| {
        let case = load(beam, None, &[closed, &format!("scheme.reserve={reserve}")]);
        let results = folder.path().join(reserve.to_string());
        let finished = run(&case, &results, false, 2, u64::MAX);
        let is_made = finished.notes.iter().any(|note| note.contains("the reserve ran out"));
        assert_eq!(is_made, reserve == 1, "{:?}", finished.notes);
        results
    });
    assert_same(&many, &few, "a beam");
}

/// A tank with an opening through which fluid comes in all the time.
pub const FILLING: &str = r#"
version = 1
title = "A tank is filled"
dimension = 2
[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0], max = [0.8, 0.2] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 2.0, wave_speed = 40.0 }
initial = { pressure = "2 * 9.81 * (0.2 - y)" }
[[body]]
name = "source"
shape = { kind = "box", min = [-0.2, 0.0], max = [0.0, 0.2] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 2.0, wave_speed = 40.0 }
opening = { normal = [1.0, 0.0], velocity = ["1", "0"] }
[[body]]
name = "tank"
shape = { kind = "union", of = [
  { kind = "box", min = [-0.2, -0.2], max = [1.0, 0.0] },
  { kind = "box", min = [0.8, 0.0], max = [1.0, 1.0] },
  { kind = "box", min = [-0.2, 0.2], max = [0.0, 1.0] },
] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 2.0, wave_speed = 40.0 }
wall = { slip = "free" }
[[load]]
kind = "body_force"
acceleration = ["0", "-9.81"]
[scheme]
kind = "transport_velocity"
free_surface = true
[time]
end = 1.0
on_failure = "retry"
retries = 2
[output]
every = 0.25
table_every = 0.05
[[probe]]
name = "level"
kind = "gauge"
body = "water"
from = [0.4, 0.0]
to = [0.4, 1.0]
"#;
