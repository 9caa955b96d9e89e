//! Stiff solids in a fluid, which take many own steps in one of the fluid.

use std::sync::atomic::AtomicBool;

use piola::case::{self, Finished, LoadOptions, Session};

/// A plate that is clamped below and holds back water that is at rest.
const DAM: &str = r#"
version = 1
title = "Dam"
dimension = 2
[parameters]
dx = 0.05
thickness = 0.15
pd = "0.05 / 3"
[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0], max = [0.5, 0.5] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 30.0 }
initial = { pressure = "1000 * 9.81 * (0.5 - y)" }
[[body]]
name = "tank"
shape = { kind = "difference", from = { kind = "box", min = [-0.2, -0.2], max = [1.2, 1.0] }, remove = [ { kind = "box", min = [0.0, 0.0], max = [1.0, 1.2] } ] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 30.0 }
wall = {}
[[body]]
name = "plate"
system = "plate"
shape = { kind = "box", min = [0.5, 0.0], max = ["0.5 + thickness", 0.8] }
spacing = "pd"
lattice = { on = "cells" }
material = { kind = "neo_hookean_logarithmic", density = 1100.0, young_modulus = 5e8, poisson_ratio = 0.3 }
[scheme]
kind = "transport_velocity"
free_surface = true
[[system]]
name = "plate"
scheme = { kind = "total_lagrangian" }
[[load]]
kind = "body_force"
acceleration = ["0", "-9.81"]
[[boundary]]
name = "foot"
body = "plate"
where = { kind = "half_space", point = [0.0, 0.06], normal = [0.0, -1.0] }
velocity = { x = "0", y = "0" }
[time]
end = 0.1
[output]
every = 0.1
table_every = 0.001
"#;

/// The same with implicit steps, one of which spans one of the water.
const IMPLICIT: &str = "system.plate.time={ integrator = 'newmark' }";

/// Vibrations stay as they are.
const INVISCID: &str = "system.plate.scheme.viscosity=0";

/// The same in space: an endless row of dams.
fn in_space() -> String {
    let mut text = DAM.to_owned();
    for (plane, space) in [
        ("dimension = 2", "dimension = 3"),
        ("[parameters]", "[domain]\nperiodic = { z = [0.0, 0.4] }\n[parameters]"),
        ("min = [0.0, 0.0]", "min = [0.0, 0.0, 0.0]"),
        ("min = [0.5, 0.0]", "min = [0.5, 0.0, 0.0]"),
        ("min = [-0.2, -0.2]", "min = [-0.2, -0.2, 0.0]"),
        ("max = [0.5, 0.5]", "max = [0.5, 0.5, 0.4]"),
        ("max = [1.2, 1.0]", "max = [1.2, 1.0, 0.4]"),
        ("max = [1.0, 1.2]", "max = [1.0, 1.2, 0.4]"),
        ("+ thickness\", 0.8]", "+ thickness\", 0.8, 0.4]"),
        ("[\"0\", \"-9.81\"]", "[\"0\", \"-9.81\", \"0\"]"),
        (
            "point = [0.0, 0.06], normal = [0.0, -1.0]",
            "point = [0.0, 0.06, 0.0], normal = [0.0, -1.0, 0.0]",
        ),
        ("y = \"0\" }", "y = \"0\", z = \"0\" }"),
    ] {
        assert!(text.contains(plane), "{plane}");
        text = text.replace(plane, space);
    }
    text
}

fn built(text: &str, set: &[&str]) -> Result<Session, String> {
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(text, "case.toml", &options);
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    Session::new(&case).map_err(|problems| problems.to_string())
}

fn session(set: &[&str]) -> Session {
    built(DAM, set).unwrap_or_else(|problems| panic!("{problems}"))
}

fn run(set: &[&str]) -> Finished {
    run_of(DAM, set)
}

fn run_of(text: &str, set: &[&str]) -> Finished {
    let session = built(text, set).unwrap_or_else(|problems| panic!("{problems}"));
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs");
    assert_eq!(finished.summary.outcome.summary(), "completed");
    finished
}

fn column(finished: &Finished, name: &str) -> Vec<f64> {
    finished.tables.energy.values(name).expect(name)
}

/// The largest energy of the plate in J.
fn most(finished: &Finished) -> f64 {
    let parts =
        ["plate.kinetic", "plate.strain", "plate.hourglass"].map(|name| column(finished, name));
    (0..parts[0].len()).map(|row| parts.iter().map(|part| part[row]).sum()).fold(0.0, f64::max)
}

/// How many steps the plate takes in one of the water.
fn own_steps(finished: &Finished) -> f64 {
    let [water, plate] = [0, 1].map(|number: usize| finished.own_steps[number].1);
    plate as f64 / water as f64
}

/// Water at rest does not set a plate into vibration, whatever the frequencies of the plate are in steps of the water:
/// impulses once a step would drive those with a whole number of periods in it, at 5e8 Pa to eighty times what the same
/// plate has in implicit steps. What those make of the vibrations with which the plate takes its load, all of which implicit
/// steps slow down, is a few percent.
#[test]
fn water_at_rest_does_not_drive_a_plate() {
    let thin = ["parameters.thickness=0.1", "parameters.pd=0.05"];
    let aluminium = "body.plate.material={ kind = 'neo_hookean_logarithmic', density = 2700.0, young_modulus = 67e9, poisson_ratio = 0.33 }";
    let light = "body.plate.material={ kind = 'neo_hookean_logarithmic', density = 300.0, young_modulus = 2e8, poisson_ratio = 0.3 }";
    let (short, soft) =
        (["time.end=0.05", "output.every=0.05"], "body.plate.material.young_modulus=2e8");
    let (space, thin_and_soft) = (in_space(), [thin[0], thin[1], soft]);
    let cases: [(&str, &[&str]); 7] = [
        (DAM, &[]),
        (DAM, &["body.plate.material.young_modulus=3e8"]),
        (DAM, &["time.cfl=0.2"]),
        (DAM, &thin_and_soft),
        (DAM, &[aluminium, "parameters.pd=0.05", short[0], short[1]]),
        (DAM, &[light]),
        (&space, &thin_and_soft),
    ];
    for (text, set) in cases {
        let [explicit, implicit] =
            [&[][..], &[IMPLICIT]].map(|more| run_of(text, &[set, more].concat()));
        assert!(own_steps(&explicit) > 4.0 && own_steps(&implicit) == 1.0, "{set:?}");
        let [own, reference] = [&explicit, &implicit].map(most);
        assert!(own < 1.1 * reference, "{set:?}: {own} {reference}");
        // Nothing moves the tank.
        let totals = column(&explicit, "total");
        let scale = totals.iter().fold(0.0, |most: f64, total| most.max(total.abs()));
        let balance = *column(&explicit, "balance").last().expect("there are rows");
        assert!(balance.abs() < 1e-3 * scale, "{set:?}: {balance} {scale}");
    }
}

/// `eta = tau (lambda + 2 mu)/2` with `tau/dt = 2/pi^3 (rho/rho_s) (c dt)^2/(dx d)`, theory (82), by hand: at the CFL number of
/// 0.25 the step is 0.25 dx/c, and d is dx.
#[test]
fn stiff_plates_are_as_viscous_as_they_need_to_be() {
    let notes = |set: &[&str]| session(set).plan().notes;
    let told = notes(&[]);
    let step = 0.25 * 0.05 / 30.0;
    let relaxation = step * 2.0 / std::f64::consts::PI.powi(3) / 1.1 * 0.25 * 0.25;
    let viscosity = 0.5 * relaxation * 5e8 * 0.7 / (1.3 * 0.4);
    assert!((viscosity - 514.0).abs() < 0.5, "{viscosity}");
    assert!(told.len() == 1 && told[0].starts_with("system `plate`: "), "{told:?}");
    assert!(told[0].contains("`scheme.viscosity` is 514 Pa s"), "{told:?}");
    // In plane stress waves have the modulus E/(1 - nu^2).
    let stress = notes(&["body.plate.material.plane='stress'"]);
    let viscosity = 0.5 * relaxation * 5e8 / (1.0 - 0.3 * 0.3);
    assert!((viscosity - 420.0).abs() < 0.5, "{viscosity}");
    assert!(stress[0].contains("`scheme.viscosity` is 420 Pa s"), "{stress:?}");
    // Shear relaxes within (1 - nu)/(1 - 2 nu) times 0.00366 of a step, of which 0.05 are allowed: 0.048 at nu 0.48, 0.093
    // at 0.49.
    let at = |nu: &str| notes(&[&format!("body.plate.material.poisson_ratio={nu}")]).concat();
    assert!(at("0.48").contains("`scheme.viscosity` is "), "{}", at("0.48"));
    assert!(at("0.49").contains("nothing damps its vibrations"), "{}", at("0.49"));
    // Whoever says it knows it; implicit steps and soft plates need none.
    let artificial = "system.plate.scheme.artificial_viscosity=[0.1, 1.0]";
    let soft = "body.plate.material.young_modulus=1e6";
    for set in [INVISCID, artificial, IMPLICIT, soft] {
        assert_eq!(notes(&[set]), [""; 0], "{set}");
    }
}

/// What the viscosity takes is less than the plate has got.
#[test]
fn viscosity_is_booked() {
    let finished = run(&[]);
    let work = *column(&finished, "plate.viscosity").last().expect("there are rows");
    assert!(work < 0.0 && work > -most(&finished), "{work}");
    let none = run(&[INVISCID]);
    assert_eq!(column(&none, "plate.viscosity").last(), Some(&0.0));
}

/// Water that hits the lower part of a plate with nothing else around. What the plate gets the water gives, pair by pair: its
/// linear momentum to round-off in any number of own steps, its angular momentum to round-off in one, theory (82), and to
/// second order in the step in many: 1.9e-5 and 5.3e-6 of 23 kg m2/s.
#[test]
fn what_a_plate_gets_the_water_gives_in_any_number_of_own_steps() {
    let free = [
        "load=",
        "boundary=",
        "body.tank=",
        "body.water.initial={ velocity = [2.0, 0.0] }",
        "time.end=0.02",
        "output.every=0.02",
    ];
    // The largest of what the plate gets, and of what is lost on the way.
    let exchanged = |set: &[&str], least: f64| {
        let finished = run(&[&free[..], set].concat());
        assert!(own_steps(&finished) >= least, "{}", own_steps(&finished));
        ["linear.x", "linear.y", "angular.z"].map(|component| {
            let column = |part: &str| {
                let name = format!("{part}.{component}");
                finished.tables.momentum.values(&name).expect("it is booked").to_vec()
            };
            let (gained, given) = (column("plate.interface"), column("walls"));
            let most = |values: &mut dyn Iterator<Item = f64>| {
                values.fold(0.0, |most: f64, value| most.max(value.abs()))
            };
            let lost = most(&mut gained.iter().zip(&given).map(|(one, other)| one + other));
            [most(&mut gained.into_iter()), lost]
        })
    };
    let rigid = "body.plate.material={ kind = 'rigid', density = 1100.0 }";
    let [one, coarse, fine] = [(rigid, 1.0), ("time.cfl=0.25", 10.0), ("time.cfl=0.125", 5.0)]
        .map(|(set, least)| exchanged(&[set], least));
    for all in [&one, &coarse, &fine] {
        assert!(all[0][0] > 50.0 && all[2][0] > 10.0, "the water hits it: {all:?}");
        assert!(all[..2].iter().all(|[_, lost]| *lost < 1e-10), "{all:?}");
    }
    let [one, coarse, fine] = [one, coarse, fine].map(|all| all[2][1]);
    assert!(one < 1e-10 && coarse < 1e-4 && fine < 0.35 * coarse, "{one} {coarse} {fine}");
}

/// A plate of two spacings of the water is told of, one of half a spacing refused, and so is one whose thickness is no multiple
/// of the spacing: by the name of the plate.
#[test]
fn what_is_wrong_with_the_size_of_a_plate_names_it() {
    let warned = |set: &[&str]| {
        let warnings = session(set).plan().warnings;
        warnings
            .iter()
            .any(|text| text.contains("the solid `plate` is 2.00 spacings of the fluid thick"))
    };
    assert!(warned(&["parameters.thickness=0.1", "parameters.pd=0.05"]));
    assert!(!warned(&[]));
    let refused = |set: &[&str]| built(DAM, set).err().expect("it is refused");
    let thin = refused(&["parameters.thickness=0.025", "parameters.pd=0.025"]);
    assert!(thin.contains("the solid `plate` is 0.50 spacings of the fluid thick"), "{thin}");
    // Across its own axes, however it is turned.
    let turned = "body.plate.shape={ kind = 'turned', angle = 0.5, about = [0.7, 0.4], of = { kind = 'box', min = [0.6, 0.2], max = [0.625, 0.8] } }";
    let turned = refused(&[turned, "parameters.pd=0.025"]);
    assert!(turned.contains("the solid `plate` is 0.50 spacings of the fluid thick"), "{turned}");
    let uneven = refused(&["parameters.thickness=0.17", "parameters.pd=0.01"]);
    assert!(uneven.contains("to the fluid `water` the solid is a wall"), "{uneven}");
    assert!(uneven.contains("body `plate`"), "{uneven}");
}
