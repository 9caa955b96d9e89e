//! Runs on a device have the bits of the processor, and what has no steps there is refused.
//!
//! They need a device, see `device`.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use piola::case::{self, Case, Finished, Level, LoadOptions, Problems, Session};
use piola::time::{Failure, Outcome};
use piola_device::{Language, Precision, cuda};

use super::device::device;

pub(super) fn load(name: &str, set: &[&str], device: &str) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
    let device = format!("compute.device='{device}'");
    let overrides = set.iter().map(|text| (*text).to_owned()).chain([device]).collect();
    let options = LoadOptions { overrides, level: Level::Coarse, ..LoadOptions::default() };
    case::load(&path.join("case.toml"), &options).unwrap_or_else(|problems| panic!("{problems}"))
}

pub(super) fn session(case: &Case) -> Session {
    Session::new(case).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The bits of all columns that a run ends with.
fn ends_with(session: &mut Session) -> Vec<u64> {
    let columns = ["position", "velocity", "pressure", "density", "transport_velocity"];
    let of = |name: &&str| session.column(name).expect("fluids have it").values;
    let values: Vec<f64> = columns.iter().flat_map(of).collect();
    values.into_iter().map(f64::to_bits).collect()
}

pub(super) fn finish(session: Session) -> Finished {
    session.run(&AtomicBool::new(false), &mut |_| {}).expect("no file is written")
}

/// Bits of all tables: energies, momentum, probes and limits.
pub(super) fn tables(finished: &Finished) -> Vec<u64> {
    let tables = finished.tables.all();
    let numbers = tables.iter().flat_map(|table| table.numbers());
    numbers.map(|number| number.to_bits()).collect()
}

/// Fluids in periodic boxes, between walls at rest and in motion, with free surfaces and body forces, in 2D and 3D.
const CASES: [(&str, &[&str]); 28] = [
    ("ctvf/taylor-green", &["time.end=0.1", "output.table_every=0.01"]),
    (
        "ctvf/taylor-green",
        &[
            "time.end=0.05",
            "scheme.corrections='gtvf'",
            "scheme.shifting='none'",
            "scheme.artificial_viscosity=0.1",
        ],
    ),
    (
        "ctvf/taylor-green",
        &["time.end=0.05", "scheme.corrections='paper'", "scheme.kernel='wendland_c2'"],
    ),
    ("ctvf/taylor-green", &["time.end=0.05", "scheme.kernel='gaussian'"]),
    ("ctvf/still-water", &["time.end=0.05", "scheme.shifting='none'"]),
    ("ctvf/still-water", &["time.end=0.05", "scheme.free_surface=false"]),
    (
        "ctvf/still-water",
        &["time.end=0.05", "load+={ kind = 'body_force', acceleration = ['sin(50 * t)', '0'] }"],
    ),
    ("ctvf/still-water", &["time.end=0.05", "scheme.escaped='remove'", SHAKEN]),
    ("ctvf/taylor-green-3d", &["time.end=0.05", "scheme.density='continuity'"]),
    ("ctvf/cavity", &["time.end=0.2", "output.table_every=0.05"]),
    ("ctvf/poiseuille", &["time.end=0.05"]),
    ("ctvf/still-water", &["time.end=0.1"]),
    ("ctvf/dam-break-3d", &["time.end=0.05"]),
    ("ctvf/dam-break", &["time.end=0.05"]),
    // Corrected gradients: without and with walls, surfaces, body forces and artificial viscosity.
    ("ctvf/taylor-green", &["time.end=0.05", CORRECTED]),
    ("ctvf/taylor-green-3d", &["time.end=0.05", CORRECTED, "scheme.shifting='none'"]),
    ("ctvf/cavity", &["time.end=0.1", CORRECTED, "scheme.artificial_viscosity=0.1"]),
    ("ctvf/dam-break-3d", &["time.end=0.05", CORRECTED, "scheme.artificial_viscosity=0.02"]),
    (
        "ctvf/taylor-green",
        &[
            "time.end=0.05",
            CORRECTED,
            "load+={ kind = 'body_force', acceleration = ['sin(50 * t)', '0'] }",
        ],
    ),
    // Pressures by the law of state, with densities that are sums or integrated, and that relax.
    ("ctvf/taylor-green", &["time.end=0.05", BY_LAW]),
    ("ctvf/taylor-green", &["time.end=0.05", BY_LAW, "scheme.density='continuity'"]),
    ("ctvf/dam-break", &["time.end=0.1", BY_LAW]),
    ("ctvf/dam-break", &["time.end=0.1", BY_LAW, CORRECTED]),
    ("ctvf/poiseuille", &["time.end=0.05", CORRECTED]),
    ("ctvf/cavity", &["time.end=0.1", PUSHED]),
    ("ctvf/cavity", &["time.end=0.1", PUSHED, CORRECTED]),
    ("ctvf/dam-break", &["time.end=0.1", PUSHED, BY_LAW]),
    ("ctvf/still-water", &["time.end=0.05", CORRECTED, SHAKEN]),
];

const SHAKEN: &str = "boundary+={ name = 'shake', body = 'tank', where = { kind = 'all' }, velocity = { x = '0.3 * sin(30 * t)', y = '0.1' } }";
const BY_LAW: &str = "scheme.pressure='state_equation'";
const PUSHED: &str = "scheme.shifting='background'";
const CORRECTED: &str = "scheme.corrected_gradients=true";

#[test]
fn a_device_has_the_bits_of_the_processor() {
    let Some(device) = device() else { return };
    for (name, set) in CASES {
        let [mut here, mut there] =
            ["processor", &device].map(|device| session(&load(name, set, device)));
        for session in [&mut here, &mut there] {
            session.run_until(0.5 * *session.case().time.end).expect("no file is written");
        }
        assert!(ends_with(&mut here) == ends_with(&mut there), "{name} {set:?}, half way");
        let [here, there] = [here, there].map(finish);
        assert_eq!(here.summary.steps, there.summary.steps, "{name} {set:?}");
        assert!(here.summary.steps > 10, "{name} takes {} steps only", here.summary.steps);
        assert!(tables(&here) == tables(&there), "{name} {set:?}");
    }
}

#[test]
fn a_run_goes_on_anywhere() {
    let Some(device) = device() else { return };
    for more in [&[][..], &[PUSHED, BY_LAW], &[CORRECTED]] {
        let set = [&["time.end=0.1", "output.table_every=0.02"], more].concat();
        let of = |device: &str| session(&load("ctvf/cavity", &set, device));
        let expected = tables(&finish(of("processor")));
        for (first, then) in [(device.as_str(), "processor"), ("processor", &device)] {
            let mut begun = of(first);
            begun.run_until(0.05).expect("no file is written");
            let checkpoint = begun.checkpoint();
            let mut resumed = of(then);
            resumed.resume(checkpoint).expect("it is of the same case");
            assert!(tables(&finish(resumed)) == expected, "{more:?} from {first} to {then}");
        }
    }
}

/// A wave in a periodic line of fluid, where corrections have a form of their own.
const LINE: &str = r#"
version = 1
title = "A wave in a line of fluid"
dimension = 1
domain = { periodic = { x = [0.0, 1.0] } }
body = [{ name = "water", shape = { kind = "box", min = [0.0], max = [1.0] }, spacing = 0.02, material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 10.0 }, initial = { velocity = ["0.2 * sin(2 * pi * x)"] } }]
scheme = { kind = "transport_velocity", density = "continuity", corrected_gradients = true }
time = { end = 0.05 }
output = { table_every = 0.01, every = 0.05 }
"#;

#[test]
fn a_line_of_fluid_has_the_bits_of_the_processor() {
    let Some(device) = device() else { return };
    for more in ["scheme.artificial_viscosity=0.1", BY_LAW, PUSHED] {
        let [here, there] = ["processor", &device].map(|device| {
            let overrides = vec![format!("compute.device='{device}'"), more.to_owned()];
            let options = LoadOptions { overrides, ..LoadOptions::default() };
            let case = case::parse(LINE, "line.toml", &options);
            finish(session(&case.unwrap_or_else(|problems| panic!("{problems}"))))
        });
        assert!(here.summary.steps > 10, "{more}: {} steps", here.summary.steps);
        assert!(tables(&here) == tables(&there), "{more}");
    }
}

#[test]
fn what_is_set_from_outside_reaches_the_device() {
    let Some(device) = device() else { return };
    let ends = ["processor", &device].map(|device| {
        let mut session = session(&load("ctvf/taylor-green", &["time.end=0.05"], device));
        session.run_until(0.02).expect("no file is written");
        let mut velocity = session.column("velocity").expect("fluids have it").values;
        velocity.iter_mut().for_each(|component| *component *= 0.5);
        session.set("velocity", &velocity).expect("it may be set");
        session.run_until(0.04).expect("no file is written");
        ends_with(&mut session)
    });
    assert!(ends[0] == ends[1]);
}

/// A fault of a run is the same on a device, with the same particle, and the run ends before it.
#[test]
fn a_run_that_breaks_up_ends_as_on_the_processor() {
    let Some(device) = device() else { return };
    let set = ["time.end=0.2", "time.max_speed=0.3", "time.on_failure='retry'", "time.retries=1"];
    let ends = ["processor", &device].map(|device| {
        let finished = finish(session(&load("ctvf/dam-break-3d", &set, device)));
        (finished.summary.outcome.clone(), tables(&finished), finished.summary.trace)
    });
    assert!(matches!(&ends[0].0, Outcome::Failed(Failure::TooFast { .. })), "{:?}", ends[0].0);
    assert_eq!(ends[0].0, ends[1].0);
    assert!(ends[0] == ends[1]);
}

fn refusal(name: &str, set: &[&str], device: &str) -> String {
    let refused: Result<Session, Problems> = Session::new(&load(name, set, device));
    refused.err().unwrap_or_else(|| panic!("{name} is no case for devices")).to_string()
}

#[test]
fn what_a_device_cannot_do_is_refused_by_name() {
    let text = refusal("ctvf/taylor-green", &[], "cuda:99");
    assert!(text.contains("there is no device `cuda:99`"), "{text}");
    let Some(device) = device() else { return };
    for (name, set, what) in [
        (
            "upwind/stiff-column",
            &[][..],
            "the integrator `backward_euler` does not run on devices with this formulation: use \
             `kick_drift_kick`, `tvd_rk2` or `ssp_rk3`",
        ),
        (
            "dual-support/tension",
            &[],
            "a solid in statics or implicit steps does not run on devices yet: take explicit steps",
        ),
        (
            "elastodynamics/biaxial",
            &["scheme.form='strong'", "body.sheet.initial.velocity=['0', '0']"],
            "the strong form does not run on devices yet: choose `form = \"adjoint\"`",
        ),
        (
            "total-lagrangian/presets",
            &[
                "load+={ kind = 'spring', where = { kind = 'plane', point = ['L', 0.0], normal = [1.0, 0.0] }, to = ['2 * L', 0.0], \
               stiffness = 10 }",
            ],
            "a spring does not run on devices yet: leave it out",
        ),
        (
            "total-lagrangian/presets",
            &["body.strip.material={ kind = 'rigid', density = 1000.0 }", "boundary=[]"],
            "a rigid body does not run on devices yet: leave it out",
        ),
        (
            "total-lagrangian/presets",
            &["body.strip.material.plane='stress'"],
            "a material that is free across, as in plane stress, does not run on devices yet: choose `plane = \
             \"strain\"`",
        ),
        ("coupled/plate", &[], "several systems in one case do not run on devices yet"),
        (
            "ctvf/still-water",
            &["load=[{ kind = 'body_force', acceleration = ['0', '-9.81 * (1 + x)'] }]"],
            "a body force that depends on position does not run on devices yet: use one that is the same everywhere",
        ),
        (
            "ctvf/couette",
            &[],
            "a wall that moves along a periodic axis does not run on devices yet: let it slide",
        ),
        (
            "ctvf/taylor-green",
            &["scheme.shifting='ipst'"],
            "the stage `iterate` does not run on devices yet: use `scheme.shifting = \"spst\"`, \"background\" or \"none\"",
        ),
        ("open/channel", &[], "an open boundary does not run on devices"),
        (
            "ctvf/taylor-green",
            &[
                "scheme.refine=[{ kind = 'box', min = [0.25, 0.25], max = [0.75, 0.75] }]",
                "scheme.density='continuity'",
            ],
            "a fluid with regions of finer spacing does not run on devices",
        ),
        ("ctvf/still-water", &["scheme.damping='x'", CORRECTED], "damping does not run on devices"),
    ] {
        let text = refusal(name, set, &device);
        assert!(text.contains(what), "{name}: {text}");
    }
}

/// The text of all passes of a case for CUDA.
fn cuda_text(name: &str, set: &[&str], of_pairs: Precision) -> String {
    let mut case = load(name, set, "processor");
    case.precision = of_pairs;
    let stages = session(&case).device_stages(Language::Cuda).unwrap_or_else(|e| panic!("{e}"));
    let mut passes: Vec<_> = stages.into_iter().flat_map(|stage| stage.passes).collect();
    passes.sort_by_key(|pass| pass.name);
    passes.dedup_by_key(|pass| pass.name);
    let text: String = passes.into_iter().map(|pass| pass.text).collect();
    Language::Cuda.prologue(Precision::Double) + &text
}

/// No GPU is needed for that. In double precision no products and sums are contracted.
#[test]
fn all_passes_of_all_formulations_compile_for_cuda() {
    if !cuda::has_compiler() {
        assert!(std::env::var_os("PIOLA_NVRTC_REQUIRED").is_none(), "there is no NVRTC");
        eprintln!("NOT RUN: there is no NVRTC on this machine");
        return;
    }
    let cases: [(&str, &[&str]); 9] = [
        ("ctvf/taylor-green", &[]),
        ("ctvf/dam-break-3d", &[CORRECTED]),
        ("ctvf/dam-break", &[PUSHED, BY_LAW]),
        ("ctvf/dam-break-3d", &["scheme.escaped='remove'"]),
        ("ctvf/rings", &["scheme.self_contact=10.0", PUSHED]),
        ("ctvf/compression", &[]),
        ("total-lagrangian/presets", &["scheme.artificial_viscosity=[1, 2]", "scheme.damping=0.1"]),
        ("elastodynamics/wave-3d", &[]),
        ("upwind/column-impact", &["scheme.reconstruction=true"]),
    ];
    for (name, set) in cases {
        for precision in [Precision::Double, Precision::Single] {
            let text = cuda_text(name, set, precision);
            let module = cuda::compile(&text, precision, "compute_80");
            let module = module.unwrap_or_else(|error| panic!("{name} {precision:?}: {error}"));
            let is_fused = module.text().contains("fma.");
            assert!(precision == Precision::Single || !is_fused, "{name}: an operation is fused");
        }
    }
}
