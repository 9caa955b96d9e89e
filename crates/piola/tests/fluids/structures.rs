//! A fluid with solids in it.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use piola::case::{self, Case, LoadOptions, Session};
use piola::schemes::Behind;
use piola::time::{Failure, Outcome};

use super::escapes::run;

fn slab(set: &[&str]) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/coupled/slab/case.toml");
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    case::load(&path, &options).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Where the slab is at the end of a run.
fn end_of(case: &Case) -> f64 {
    let session = Session::new(case).unwrap_or_else(|problems| panic!("{problems}"));
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs");
    assert_eq!(finished.summary.outcome.summary(), "completed");
    let rows = finished.tables.probes.values("slab.displacement.y").expect("it is recorded");
    *rows.last().expect("there are rows")
}

/// What the systems do to each other is taken at the same two times by both, so that the step as a whole is
/// of second order: halving it takes three quarters of what it changes. The slab is soft enough for its own
/// steps to be as many at all three sizes, and another time in implicit steps. The amplitude is small and nothing
/// diffuses, as the drift of the fluid has terms of first order: it takes rates where particles begin.
#[test]
fn steps_of_both_together_are_of_second_order() {
    let implicit = "system.slab.time={ integrator = 'newmark' }";
    let explicit = "system.slab.time={ cfl = 0.9 }";
    let upwind = [
        "system.slab.scheme={ kind = 'upwind', smoothing_length = 0.7 }",
        "body.slab.material={ kind = 'linear', density = 1.0, bulk_modulus = 50.0 }",
    ];
    let midpoint = "system.slab.time={ integrator = 'implicit_midpoint' }";
    let methods: [&[&str]; 4] =
        [&[explicit], &[implicit], &upwind, &[upwind[0], upwind[1], midpoint]];
    for method in methods {
        let end = |step: f64| {
            let step = format!("time.step={step}");
            let common = [
                "parameters.n=8",
                "parameters.g=0",
                "parameters.kick=1e-6",
                "scheme.shifting='none'",
                "scheme.pressure_diffusion=0",
                "system.slab.scheme={ kind = 'dual_support' }",
                "body.slab.material={ kind = 'linear_elastic', density = 1.0, young_modulus = 50.0, poisson_ratio = 0.0 }",
                "time.end=0.2",
                "output.every=0.2",
                "output.table_every=0.2",
                &step,
            ];
            end_of(&slab(&[&common[..], method].concat()))
        };
        let [long, middle, short] = [2e-3, 1e-3, 5e-4].map(end);
        let order = ((long - middle) / (middle - short)).abs().log2();
        assert!((order - 2.0).abs() < 0.1, "{method:?}: order {order}");
    }
}

/// A solid that is held everywhere is a wall to the fluid, which slides along it or sticks to it: the same particles, the
/// same bits.
#[test]
fn a_held_solid_is_a_wall_to_the_bit() {
    let velocities = |extra: &[&str]| -> Vec<(u32, Vec<u64>)> {
        // Thick enough for no fluid to see through it, and a stream of water along it.
        let common = [
            "parameters.n=8",
            "parameters.thickness=0.75",
            "time.step=1e-3",
            "probe.slab=",
            "body.water.material.viscosity=0.01",
            "body.floor.material.viscosity=0.01",
            "body.water.initial.velocity=['0.1 * y', '-kick * y']",
        ];
        let case = slab(&[&common, extra].concat());
        let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
        session.run_until(0.1).expect("it runs");
        let velocity = session.column("velocity").expect("it is there").values;
        let bits = |v: &[f64]| v.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        let rows = session.ids().iter().zip(velocity.chunks_exact(2));
        // The water comes first in the order of creation.
        let mut rows: Vec<_> =
            rows.filter(|(id, _)| **id < 80).map(|(id, v)| (*id, bits(v))).collect();
        rows.sort_unstable();
        rows
    };
    let plain = ["plot.slab=", "check=", "output.fields=['velocity']"];
    let held = "boundary+={ name = 'held', body = 'slab', where = { kind = 'all' }, velocity = { x = '0', y = '0' } }";
    let kinds: [&[&str]; 3] = [
        &[],
        &[
            "system.slab.scheme={ kind='upwind', smoothing_length=0.7 }",
            "body.slab.material={ kind='linear', density=1.0, bulk_modulus=2500.0 }",
        ],
        &[
            "system.slab.scheme={ kind='transport_velocity' }",
            "body.slab.material={ kind='hypoelastic', density=1.0, young_modulus=2500.0, poisson_ratio=0.0 }",
        ],
    ];
    let walls = ["no", "free"].map(|slip| {
        let [of_wall, of_solid] = [
            format!("body.slab.wall={{ slip = '{slip}' }}"),
            format!("system.slab.slip='{slip}'"),
        ];
        let as_wall = [
            "body.slab.system=",
            "system=",
            "body.slab.material={ kind = 'weakly_compressible', density = 'rho', wave_speed = 'c', viscosity = 0.01 }",
            &of_wall,
            "variant=",
        ];
        let wall = velocities(&[&plain[..], &as_wall].concat());
        for kind in kinds {
            let solid = velocities(&[&plain[..], &[held, &of_solid], kind].concat());
            assert_eq!(solid.len(), 80);
            assert!(
                solid == wall,
                "the water around a held solid is not that around a wall: {slip}, {kind:?}"
            );
        }
        wall
    });
    assert!(walls[0] != walls[1], "walls with and without slip do the same");
}

/// Water on both sides of a plate three particles thick that nothing moves.
const PARTED: &str = r#"
version = 1
title = "Water on both sides of a plate"
dimension = 2
[parameters]
dx = 0.05
[[body]]
name = "left"
shape = { kind = "box", min = [0.0, 0.0], max = [0.5, 0.5] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1.0, wave_speed = 10.0 }
initial = { velocity = ["0.2 * x", "-0.2 * y"] }
[[body]]
name = "plate"
system = "plate"
shape = { kind = "box", min = [0.5, -0.5], max = [0.65, 1.0] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "linear_elastic", density = 1.0, young_modulus = 1e3, poisson_ratio = 0.0 }
[[body]]
name = "right"
shape = { kind = "box", min = [0.65, 0.0], max = [1.15, 0.5] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1.0, wave_speed = 10.0 }
initial = { velocity = ["-3 * y", "1"], pressure = "10" }
[scheme]
kind = "transport_velocity"
shifting = "none"
[[system]]
name = "plate"
scheme = { kind = "elastodynamics" }
[[boundary]]
name = "held"
body = "plate"
where = { kind = "all" }
velocity = { x = "0", y = "0" }
[time]
end = 0.02
step = 5e-4
"#;

/// What is on one side of a thin plate takes nothing from what is on the other, not a bit: each side has wall
/// particles of its own.
#[test]
fn water_does_not_see_through_a_plate_of_three_particles() {
    let left = |set: &[&str]| -> Vec<u64> {
        let overrides = set.iter().map(|text| (*text).to_owned()).collect();
        let options = LoadOptions { overrides, ..LoadOptions::default() };
        let case = case::parse(PARTED, "parted.toml", &options);
        let case = case.unwrap_or_else(|problems| panic!("{problems}"));
        let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
        session.run_until(0.02).expect("it runs");
        let pressure = session.column("pressure").expect("it is there").values;
        let rows = session.ids().iter().zip(pressure);
        let mut rows: Vec<(u32, f64)> =
            rows.filter(|(id, _)| **id < 100).map(|(id, p)| (*id, p)).collect();
        rows.sort_unstable_by_key(|(id, _)| *id);
        rows.into_iter().map(|(_, p)| p.to_bits()).collect()
    };
    let (both, alone) = (left(&[]), left(&["body.right="]));
    assert_eq!(both.len(), 100);
    assert!(both == alone, "the water on the left feels that on the right");
    assert!(both.iter().any(|p| f64::from_bits(*p) != 0.0), "nothing happens");
}

/// A soft block that drifts through a bound of the box, without walls, in a box that is periodic both ways.
pub const DRIFTING: &str = r#"
version = 1
title = "A block in water"
dimension = 2
[domain]
periodic = { x = [0.0, 1.0], y = [0.0, 1.0] }
[[body]]
name = "water"
shape = { kind = "difference", from = { kind = "box", min = [0.0, 0.0], max = [1.0, 1.0] }, remove = [
  { kind = "box", min = [0.05, 0.4], max = [0.45, 0.6] },
] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1.0, wave_speed = 10.0 }
initial = { velocity = ["1 + 0.3 * sin(2 * pi * y)", "0.2 * cos(2 * pi * x)"], pressure = "5" }
[[body]]
name = "block"
system = "block"
shape = { kind = "box", min = [0.05, 0.4], max = [0.45, 0.6] }
spacing = 0.04
initial = { velocity = ["-1", "0"] }
material = { kind = "neo_hookean_logarithmic", density = 3.0, young_modulus = 200.0, poisson_ratio = 0.3 }
[scheme]
kind = "transport_velocity"
corrections = "none"
shifting = "none"
[[system]]
name = "block"
scheme = { kind = "elastodynamics" }
slip = "free"
[time]
end = 0.1
"#;

/// What the fluid loses of momentum the solid gets: of nothing else is the sum of both kept. The two systems book
/// what they do by themselves, so this sees a force that is lost between them.
#[test]
fn water_and_block_keep_their_momentum() {
    let soft = "kind='neo_hookean_logarithmic', density=3, young_modulus=200, poisson_ratio=0.3";
    let (law, rates) = (
        "kind='gamma_law', density=3, bulk_modulus=200, gamma=2",
        "kind='hypoelastic', density=3, young_modulus=200, poisson_ratio=0.3",
    );
    let kinds: [(&str, &str, Option<&str>); 8] = [
        ("kind='elastodynamics'", soft, None),
        ("kind='elastodynamics'", "kind='rigid', density=3", None),
        ("kind='dual_support'", soft, None),
        ("kind='dual_support'", soft, Some("newmark")),
        ("kind='upwind', smoothing_length=0.7", law, None),
        (
            "kind='upwind', smoothing_length=0.7, tau_velocity=0.5, tau_pressure=0.5",
            law,
            Some("ssp_rk3"),
        ),
        ("kind='upwind', smoothing_length=0.7, tau_velocity=0.5", law, Some("backward_euler")),
        // Its corrections for transport lose momentum by themselves, and book it.
        ("kind='transport_velocity', corrections='none', shifting='none'", rates, None),
    ];
    for (scheme, material, integrator) in kinds {
        let mut overrides = vec![
            format!("system.block.scheme={{ {scheme} }}"),
            format!("body.block.material={{ {material} }}"),
        ];
        overrides.extend(integrator.map(|it| format!("system.block.time={{ integrator='{it}' }}")));
        keeps_momentum(overrides);
    }
}

/// The same holds if the surface of the block has a third of the spacing of the water or three times as much, and the water
/// slides or sticks.
#[test]
fn water_and_block_of_another_spacing_keep_their_momentum() {
    let place = "{ kind='box', min=[0.05, 0.3], max=[0.5, 0.75] }";
    for spacing in ["0.05 / 3", "0.15"] {
        for slip in ["no", "free"] {
            keeps_momentum(vec![
                format!("body.water.shape.remove=[{place}]"),
                format!("body.block.shape={place}"),
                format!("body.block.spacing='{spacing}'"),
                format!("system.block.slip='{slip}'"),
                "body.water.material.viscosity=0.01".into(),
            ]);
        }
    }
}

/// The same with the pressure forces of corrected gradients, theory (110), which do not act along the line between two
/// particles. Without shifting the corrections for it are zero.
#[test]
fn water_with_corrected_gradients_and_block_keep_their_momentum() {
    let scheme = "scheme={ kind='transport_velocity', shifting='none', corrected_gradients=true }";
    keeps_momentum(vec![scheme.into()]);
    keeps_momentum(vec![scheme.into(), "body.block.spacing='0.05 / 3'".into()]);
}

/// The same of a rigid head, which the water moves, with a soft tail.
#[test]
fn water_and_a_tail_on_a_moving_head_keep_their_momentum() {
    let head = "body+={ name='head', system='block', shape={ kind='box', min=[0.05, 0.4], max=[0.2, 0.6] }, \
                spacing=0.05, initial={ velocity=['-1', '0'] }, material={ kind='rigid', density=2 } }";
    keeps_momentum(vec![
        head.into(),
        "body.block.shape={ kind='box', min=[0.2, 0.4], max=[0.45, 0.6] }".into(),
        "body.block.spacing=0.05".into(),
        "system.block.scheme={ kind='elastodynamics', form='adjoint', joined=true }".into(),
    ]);
}

/// The momentum of the water and of what is in it.
pub fn momentum_of(session: &mut Session) -> [[f64; 2]; 2] {
    let velocity = session.column("velocity").expect("it is there").values;
    let masses: Vec<f64> = (0..velocity.len() / 2).map(|a| session.scheme().mass(a)).collect();
    let bodies = session.scheme().bodies().to_vec();
    let mut all = [[0.0; 2]; 2];
    for (a, v) in velocity.chunks_exact(2).enumerate() {
        (0..2).for_each(|i| all[bodies[a].min(1) as usize][i] += masses[a] * v[i]);
    }
    all
}

fn keeps_momentum(overrides: Vec<String>) {
    let what = overrides.join(", ");
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(DRIFTING, "drifting.toml", &options);
    let case = case.unwrap_or_else(|problems| panic!("{what}: {problems}"));
    let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let start = momentum_of(&mut session);
    session.run_until(0.1).expect("it runs");
    assert!(session.time() > 0.1 * (1.0 - 1e-9), "{what}: it ends at {} s", session.time());
    let end = momentum_of(&mut session);
    for axis in 0..2 {
        let [before, after] = [start, end].map(|all| all[0][axis] + all[1][axis]);
        assert!((after - before).abs() < 1e-12, "{what}, {axis}: {before} {after}");
    }
    let handed_over = end[1][0] - start[1][0];
    assert!(handed_over > 0.01, "{what}: the water pushes the block along: {handed_over}");
}

/// A block that is pulled apart at its ends, of a kind whose particles change their neighbours.
const PULLED: [&str; 6] = [
    "body.water.shape.remove=[{ kind='box', min=[0.3, 0.4], max=[0.7, 0.6] }]",
    "body.block.shape={ kind='box', min=[0.3, 0.4], max=[0.7, 0.6] }",
    "body.block.spacing=0.05",
    "body.block.lattice={ on='cells' }",
    "body.block.initial={ velocity=['0', '0'] }",
    "time.end=0.2",
];

/// Its ends, 0.35 m apart, part with 2 m/s: at 0.175 s each row between them is twice as long, so that two neighbours of
/// the start in it are twice as far from each other or farther, however the particles have moved. Before the first
/// such row, all are nearer.
#[test]
fn a_run_ends_where_a_hypoelastic_solid_comes_apart() {
    let end = |side: &str, sign: &str, edge: &str| {
        format!(
            "boundary+={{ name='{side}', body='block', where={{ kind='half_space', point=[{edge}, 0], normal=[{sign}1, 0] }}, \
             velocity={{ x='{sign}1' }} }}"
        )
    };
    let mut overrides: Vec<String> = PULLED.map(str::to_owned).to_vec();
    overrides.push("system.block.scheme={ kind='transport_velocity' }".into());
    overrides.push(
        "body.block.material={ kind='hypoelastic', density=3, young_modulus=200, poisson_ratio=0.3, \
         strength={ kind='linear', yield_stress=10 } }"
            .into(),
    );
    overrides.extend([end("left", "-", "0.34"), end("right", "", "0.66")]);
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(DRIFTING, "pulled.toml", &options);
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    let session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs");
    let Outcome::Failed(Failure::Escaped { time, escape, particle, .. }) = finished.summary.outcome
    else {
        panic!("{:?}", finished.summary.outcome)
    };
    assert_eq!(escape.behind, Behind::Neighbors);
    // A row that is longer by no more than one spacing has no two neighbours twice as far apart.
    assert!((0.025..0.176).contains(&time), "{time}");
    assert!((0.3..0.7).contains(&particle.reference[0]), "{particle:?}");
    assert!(escape.advice.contains("total_lagrangian"), "{}", escape.advice);
}

/// A jet that is faster than the waves in it, and a thin plate that it goes through.
const THROUGH: &str = r#"
version = 1
title = "A jet goes through a plate"
dimension = 2
[[body]]
name = "jet"
shape = { kind = "box", min = [-0.45, 0.0], max = [-0.05, 0.2] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 1.0 }
initial = { velocity = ["3", "0"] }
[[body]]
name = "plate"
system = "plate"
shape = { kind = "box", min = [0.0, -0.4], max = [0.15, 0.6] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "neo_hookean_logarithmic", density = 20000.0, young_modulus = 1e6, poisson_ratio = 0.3 }
[scheme]
kind = "transport_velocity"
free_surface = true
[[system]]
name = "plate"
scheme = { kind = "dual_support" }
[time]
end = 0.2
"#;

/// What is behind the surface of a solid ends the run at once, by the name of the solid, with the particle, the place and the
/// time. The first layer of its walls stands 0.025 m behind the face. A particle is told of a tenth of a spacing later, 0.005 m,
/// in a step of at most 0.25 h u/(c + u) = 0.0094 m.
#[test]
fn what_goes_through_a_solid_is_named_at_once() {
    let finished = run(THROUGH, &[]);
    let Outcome::Failed(failure) = &finished.summary.outcome else {
        panic!("{:?}", finished.summary.outcome)
    };
    let Failure::Escaped { time, escape, particle, .. } = failure else { panic!("{failure}") };
    assert_eq!(escape.behind, Behind::Wall("plate".into()));
    assert!((0.025..0.0425).contains(&escape.position[0]), "{escape:?}");
    assert!((0.0..0.2).contains(&escape.position[1]), "{escape:?}");
    assert!((-0.45..-0.05).contains(&particle.reference[0]), "{particle:?}");
    // It has 0.1 m to go to the layer, at 3 m/s and less.
    assert!((0.033..0.1).contains(time), "{time}");
    let message = failure.to_string();
    for part in ["`plate`", "m/s"] {
        assert!(message.contains(part), "{message}");
    }
    let slow = run(THROUGH, &["body.jet.initial.velocity=['0.2', '0']", "time.end=0.6"]);
    assert_eq!(slow.summary.outcome, Outcome::Completed);
}
