//! Solids on a device have the bits of the processor.
//!
//! They need a device, see `device`.

use piola::case::Session;

use super::device::device;
use super::devices::{finish, load, session, tables};

/// The bits of the columns that a run ends with, whatever the formulation.
fn ends_with(session: &mut Session) -> Vec<u64> {
    let columns = ["position", "velocity", "displacement", "acceleration"];
    let of = |name: &&str| session.column(name).expect("solids have it").values;
    let values: Vec<f64> = columns.iter().flat_map(of).collect();
    values.into_iter().map(f64::to_bits).collect()
}

const PULL: &str = "load+={ kind = 'body_force', acceleration = ['sin(90 * t)', '-9.81 * x'] }";
const PRESS: &str = "load+={ kind = 'pressure', where = { kind = 'plane', point = [0.0, 'H'], \
                     normal = [0.0, 1.0] }, pressure = '1e3 * t' }";
const LOAD: &str = "load+={ kind = 'traction', where = { kind = 'plane', point = ['L', 0.0], \
                    normal = [1.0, 0.0] }, traction = ['1e3 * t', '-40'] }";

/// Solids of every formulation, with what may act on them.
const CASES: [(&str, &[&str]); 22] = [
    ("dual-support/free-vibration", &["parameters.dx=1"]),
    ("dual-support/free-vibration", &["parameters.dx=1", "scheme.viscosity=1e4"]),
    ("dual-support/free-vibration", &["parameters.dx=1", "scheme.artificial_viscosity=[1, 2]"]),
    (
        "dual-support/free-vibration",
        &[
            "parameters.dx=1",
            "scheme.damping=3",
            "load+={ kind = 'body_force', acceleration = ['0', '-9.81 * t', 'x'] }",
        ],
    ),
    ("total-lagrangian/presets", &[]),
    ("total-lagrangian/presets", &["scheme.kind='elastodynamics'"]),
    ("total-lagrangian/presets", &["scheme.gradients='patch_consistent'", "scheme.hourglass=0.1"]),
    ("total-lagrangian/presets", &[PULL, PRESS, LOAD]),
    ("elastodynamics/hole", &[]),
    ("elastodynamics/wave-2d", &[]),
    ("elastodynamics/wave-3d", &[]),
    ("elastodynamics/pulse-3d", &[]),
    ("elastodynamics/reflection-3d", &[]),
    ("upwind/bar-sine", &[]),
    ("upwind/bar-sine", &["scheme.tau_velocity=0.5", "scheme.tau_pressure=0.5"]),
    ("upwind/piston", &[]),
    ("upwind/piston", &["time.integrator='ssp_rk3'"]),
    ("upwind/bar-step", &["time.integrator='tvd_rk2'"]),
    ("upwind/column-impact", &["scheme.reconstruction=true"]),
    ("upwind/dam-break", &[]),
    ("upwind/column-impact-3d", &[]),
    ("upwind/drop-3d", &["scheme.wave_speed='stretch'"]),
];

const NO_SLIP: &str = "body.wall.wall.slip='no'";
const LEAD: &str = "body.wall.material={ kind = 'hypoelastic', density = 11340, young_modulus = 16e9, poisson_ratio = 0.44 }";
const SWING: &str = "boundary.clamp.velocity.y='0.1 * x * sin(100 * t)'";
const PUMP: &str = "boundary.piston.velocity.y='-10 * sin(1e5 * t)'";
const SPALL: &str = "body.projectile.material.spall_strength=1e8";

/// Hypoelastic solids: alone, in contact of each kind, at walls, with what flows, tears and heats.
const HYPOELASTIC: [(&str, &[&str]); 16] = [
    ("ctvf/swinging-plate", &["scheme.pressure='edac'", "scheme.corrected_gradients=false"]),
    (
        "ctvf/swinging-plate",
        &[
            "scheme.corrections='gtvf'",
            "load+={ kind = 'body_force', acceleration = ['0', '9 * sin(40 * t)'] }",
            SWING,
        ],
    ),
    ("ctvf/swinging-plate-3d", &["parameters.across=4"]),
    ("ctvf/rings", &[]),
    ("ctvf/rings", &["scheme.self_contact=10.0", "scheme.free_surface=false"]),
    ("ctvf/impact", &[SPALL, "scheme.pressure='edac'"]),
    ("ctvf/taylor-bar", &["parameters.across=6"]),
    ("ctvf/taylor-bar", &["parameters.across=6", NO_SLIP, LEAD]),
    ("ctvf/compression", &["scheme.corrected_gradients=true", PUMP]),
    ("ctvf/rings", &["scheme.shifting='background'", "scheme.self_contact=10.0"]),
    // What is clamped there is not pushed.
    ("ctvf/swinging-plate", &["scheme.shifting='background'"]),
    ("ctvf/contact", &["scheme.shifting='background'", "body.left.material.bulk_modulus=4e7"]),
    ("ctvf/contact", &[]),
    ("ctvf/contact", &["scheme.contact='repulsive'", "body.left.material.bulk_modulus=4e7"]),
    ("ctvf/johnson-cook", &[]),
    ("ctvf/plane-shock", &[]),
];

#[test]
fn a_device_has_the_bits_of_the_processor() {
    let Some(device) = device() else { return };
    for (name, set) in CASES.into_iter().chain(HYPOELASTIC) {
        let set: Vec<&str> = set.iter().copied().chain(["time.max_steps=60"]).collect();
        let [mut here, mut there] =
            ["processor", &device].map(|device| session(&load(name, &set, device)));
        for session in [&mut here, &mut there] {
            (0..20).for_each(|_| drop(session.step()));
        }
        assert!(ends_with(&mut here) == ends_with(&mut there), "{name} {set:?}, on the way");
        let [here, there] = [here, there].map(finish);
        assert_eq!(here.summary.steps, there.summary.steps, "{name} {set:?}");
        assert!(here.summary.steps >= 20, "{name} takes {} steps only", here.summary.steps);
        assert!(tables(&here) == tables(&there), "{name} {set:?}");
    }
}

/// A bar goes through its thin wall, and particles are taken out of it.
#[test]
fn a_solid_goes_on_without_what_has_been_removed() {
    let Some(device) = device() else { return };
    let set = [
        "parameters.across=6",
        "parameters.thick=1",
        "parameters.speed=4000",
        "scheme.escaped='remove'",
        "time.max_steps=80",
    ];
    let ends = ["processor", &device].map(|device| {
        let mut session = session(&load("ctvf/taylor-bar", &set, device));
        (0..75).for_each(|_| drop(session.step()));
        let density = session.column("density").expect("solids have it").values;
        assert!(density.contains(&0.0), "on {device} nothing has been removed");
        (ends_with(&mut session), tables(&finish(session)))
    });
    assert!(ends[0] == ends[1]);
}

/// What a step keeps for the next one: rates of places, viscous forces, planes that move, forces that change.
const KEPT: [(&str, &[&str]); 10] = [
    ("dual-support/free-vibration", &["parameters.dx=1", "scheme.artificial_viscosity=[1, 2]"]),
    ("total-lagrangian/presets", &[PULL, PRESS, LOAD]),
    ("elastodynamics/biaxial", &[]),
    (
        "upwind/bar-sine",
        &["scheme.tau_velocity=0", "scheme.tau_pressure=0", "time.integrator='kick_drift_kick'"],
    ),
    ("upwind/piston", &["time.integrator='ssp_rk3'"]),
    ("upwind/dam-break", &["load+={ kind = 'body_force', acceleration = ['sin(50 * t)', '0'] }"]),
    ("ctvf/swinging-plate", &[SWING]),
    ("ctvf/compression", &[PUMP]),
    ("ctvf/rings", &[]),
    ("ctvf/rings", &["scheme.shifting='background'"]),
];

/// A session of a case with 40 steps, and the bits of its tables at the end.
fn short(name: &str, set: &[&str], device: &str) -> Session {
    let set: Vec<&str> = set.iter().copied().chain(["time.max_steps=40"]).collect();
    session(&load(name, &set, device))
}

#[test]
fn a_run_goes_on_anywhere() {
    let Some(device) = device() else { return };
    for (name, set) in KEPT {
        let expected = tables(&finish(short(name, set, "processor")));
        for (first, then) in [(device.as_str(), "processor"), ("processor", &device)] {
            let mut begun = short(name, set, first);
            (0..17).for_each(|_| drop(begun.step()));
            let mut resumed = short(name, set, then);
            resumed.resume(begun.checkpoint()).expect("it is of the same case");
            let what = format!("{name} {set:?} from {first} to {then}");
            assert!(tables(&finish(resumed)) == expected, "{what}");
        }
    }
}

#[test]
fn what_is_set_from_outside_reaches_the_device() {
    let Some(device) = device() else { return };
    for (name, set) in KEPT {
        let ends = ["processor", &device].map(|device| {
            let mut session = short(name, set, device);
            (0..11).for_each(|_| drop(session.step()));
            let mut velocity = session.column("velocity").expect("solids have it").values;
            velocity.iter_mut().for_each(|component| *component *= 0.5);
            session.set("velocity", &velocity).expect("it may be set");
            (0..11).for_each(|_| drop(session.step()));
            ends_with(&mut session)
        });
        assert!(ends[0] == ends[1], "{name} {set:?}");
    }
}
