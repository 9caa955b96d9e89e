//! Reading good cases. Faulty ones are in `faults`, overrides and settings in `settings`.

use crate::fields::Component;
use std::path::PathBuf;

use super::model::*;
use super::*;

mod arrays;
mod clouds;
mod devices;
mod faults;
mod functions;
mod hostile;
mod implicit;
mod integrators;
mod overlaps;
mod overrides;
mod solids;
mod sweeps;
mod systems;
mod warnings;

/// A case that uses every table and nearly every key.
pub(super) const FULL: &str = include_str!("tests/full.toml");

pub(super) fn read_with(text: &str, overrides: &[&str]) -> Result<Case, Problems> {
    let overrides = overrides.iter().map(|text| (*text).to_owned()).collect();
    parse(text, "case.toml", &LoadOptions { overrides, ..LoadOptions::default() })
}

/// Positions and energies of a case at 0.1 s, where something has moved.
fn at_a_tenth(case: &Case) -> (Vec<f64>, Vec<(&'static str, f64)>) {
    let mut session = Session::new(case).unwrap();
    session.run_until(0.1).unwrap();
    let position = session.column("position").unwrap().values;
    assert!(position.iter().any(|number| *number != 0.0));
    (position, session.energies())
}

fn full() -> Case {
    read_with(FULL, &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn the_template_is_a_good_case() {
    for level in [Level::Case, Level::Coarse] {
        let options = LoadOptions { level, ..LoadOptions::default() };
        let case = parse(&template::new_case("a \"new\" case"), "case.toml", &options)
            .unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(case.title, "a new case");
        assert_eq!(case.bodies[0].spacing.value[0], if level == Level::Coarse { 0.2 } else { 0.1 });
    }
}

#[test]
fn reads_the_frame_of_a_case() {
    let case = full();
    assert_eq!((case.id.as_deref(), case.dimension), (Some("U10"), 2));
    assert_eq!(case.title, "A column of fluid hits a wall");
    assert_eq!(case.parameter("speed"), Some(1.0));
    assert_eq!(case.parameter("twice"), Some(2.0));
    let periodic: Vec<_> =
        case.domain.periodic.iter().map(|axis| axis.as_ref().map(|ends| ends.value)).collect();
    assert_eq!(periodic, [Some([-10.0, 10.0]), None]);
    assert_eq!((case.variant.as_deref(), case.level), (None, Level::Case));
    assert_eq!(case.coarse, ["body.column.spacing=0.5", "time.end=0.5"]);
    let paper = case.paper.as_ref().unwrap();
    assert_eq!(
        (&paper.set[..], paper.is_long),
        (&["body.column.spacing=0.05".to_owned()][..], true)
    );
    assert_eq!(case.variants[0].traits, RunTraits::default());
    assert_eq!(case.sweeps[1].traits, RunTraits { is_paper: true, is_long: true });
    assert_eq!(case.traits_of(Some("spacing.1")), case.sweeps[1].traits);
    assert_eq!(case.traits_of(None), RunTraits::default());
    let last = case.checks.last().unwrap();
    assert_eq!((case.checks[0].against, last.against), (None, Some(Against::Exact)));
    assert_eq!(last.reason.as_deref(), Some("first order"));
    let time = &case.time;
    assert_eq!((time.end.value, time.integrator.as_str()), (3.0, "tvd_rk2"));
    assert_eq!(time.step.value, StepControl::Cfl(0.3));
    assert_eq!((time.max_steps, time.min_step), (Some(1_000_000), Some(1e-9)));
    let Scheme::Upwind(upwind) = &case.scheme.value else { panic!("the scheme is upwind") };
    assert_eq!((upwind.kernel.as_str(), upwind.smoothing_length.value), ("cubic_spline", 0.7));
    assert_eq!(upwind.correction.value, crate::operators::Correction::Gradient);
    assert_eq!(upwind.weights, Weights::Lattice);
    assert_eq!((upwind.tau_velocity, upwind.tau_pressure), (0.5, 0.0));
    assert!(upwind.reconstruction);
    assert_eq!(upwind.wave_speed, crate::schemes::upwind::WaveSpeed::Stretch);
}

#[test]
fn reads_bodies() {
    let case = full();
    let [column, ring, cloud] = &case.bodies[..] else { panic!("three bodies") };
    assert_eq!(*column.name, "column");
    assert_eq!(column.shape.value, Shape::Box { min: vec![0.0, 0.0], max: vec![3.0, 5.0] });
    assert_eq!(column.spacing.value, [0.25, 0.25]);
    assert_eq!(
        column.lattice,
        Lattice {
            kind: LatticeKind::Square,
            on: LatticeOrigin::Boundary,
            jitter: 0.1,
            seed: 7,
            relax: 0
        }
    );
    let material = column.material.value.clone();
    assert_eq!(material.density(), 1000.0);
    // Upwind (6.31) with c = 10: kappa = 1000 * 100 / 7.
    assert_eq!(material.bulk_modulus(2), 1e5 / 7.0);
    assert_eq!(column.initial.velocity[1].as_constant(), Some(-1.0));
    assert_eq!(column.initial.velocity[0].eval([3.0, 2.0, 0.0], 0.0), 6.0);
    assert_eq!(column.initial.pressure.as_constant(), Some(0.0));

    assert_eq!(ring.spacing.value, [0.5, 0.25]);
    assert_eq!(ring.lattice.kind, LatticeKind::Hexagonal);
    // Plane stress: E / (2 (1 - nu)).
    assert_eq!(ring.material.bulk_modulus(2), 1e6 / (2.0 * 0.7));
    let Shape::Difference { from, remove } = &ring.shape.value else { panic!("a difference") };
    let Shape::Union(parts) = &from.value else { panic!("a union") };
    assert_eq!(parts[0].value, Shape::Ball { center: vec![20.0, 0.0], radius: 2.0 });
    let annulus = Shape::Annulus { center: vec![20.0, 0.0], inner: 1.0, outer: 3.0 };
    assert_eq!(parts[1].value, annulus);
    assert!(matches!(remove[0].value, Shape::Intersection(ref of) if of.len() == 2));

    let file = PathBuf::from("cloud.csv");
    assert!(matches!(&cloud.shape.value, Shape::Points { file: found } if found.value == file));
    assert_eq!(cloud.initial.velocity.len(), 2);
    let curve = PathBuf::from("curve.csv");
    let files: Vec<_> = case.files().into_iter().map(|file| file.value).collect();
    assert_eq!(files, [file, curve]);
    assert_eq!((case.body_index("ring"), case.body_index("rings")), (Some(1), None));
}

#[test]
fn reads_loads_boundaries_and_regions() {
    let case = full();
    let [gravity, traction] = &case.loads[..] else { panic!("two loads") };
    assert_eq!(gravity.kind.components()[1].as_constant(), Some(-9.81));
    assert!(gravity.body.is_none());
    assert_eq!(traction.body.as_ref().map(|body| body.value), Some(0));
    assert_eq!(traction.kind.components()[1].eval([0.0; 3], 2.0), -2000.0);
    let LoadKind::Traction { region, .. } = &traction.kind else { panic!("a traction") };
    assert_eq!(region.value, Region::Plane { point: vec![0.0, 5.0], normal: vec![0.0, 1.0] });

    let [floor, driver] = &case.boundaries[..] else { panic!("two boundaries") };
    assert!(floor.velocity[0].is_none());
    assert_eq!(floor.velocity[1].as_ref().and_then(Expression::as_constant), Some(0.0));
    // The normal [3, -4] is scaled to length 1.
    assert_eq!(
        driver.region.value,
        Region::HalfSpace { point: vec![0.0, 0.0], normal: vec![0.6, -0.8] }
    );
    let moving = driver.velocity[0].as_ref().unwrap();
    assert_eq!((moving.eval([0.0; 3], 2.0), moving.rate([0.0; 3], 2.0)), (4.0, 4.0));
    assert_eq!(case.expressions().count(), 3 * 5 + 4 + 3);
}

#[test]
fn reads_observers() {
    let case = full();
    let [top, toe] = &case.probes[..] else { panic!("two probes") };
    let ProbeKind::Particle { at, fields, .. } = &top.kind else { panic!("a particle") };
    assert_eq!(at.value, [1.5, 5.0]);
    assert_eq!(
        fields.iter().map(|field| field.name).collect::<Vec<_>>(),
        ["displacement", "pressure"]
    );
    let ProbeKind::Extremum { field, of, region, inside } = &toe.kind else {
        panic!("an extremum")
    };
    assert_eq!((field.name(2).as_str(), *of, inside), ("position.x", Extremum::Largest, &None));
    assert_eq!((field.value.value(&[4.0, 9.0]), region.value.clone()), (4.0, Region::All));
    assert_eq!((case.output.every.value, case.output.table_every.value), (0.1, 0.01));
    assert_eq!(case.output.fields.len(), 2);
    assert_eq!(case.output.compression, Compression::None);
    assert!(!case.output.report);
    let [pressure, speed, shear] = &case.pictures[..] else { panic!("three pictures") };
    assert_eq!(pressure.field.component, Component::Whole);
    assert_eq!(pressure.times.iter().map(|time| time.value).collect::<Vec<_>>(), [0.1, 0.5]);
    assert_eq!(pressure.range, Some([-1e4, 1e4]));
    assert_eq!((speed.field.component, speed.times[0].value), (Component::Magnitude, 3.0));
    assert_eq!(speed.field.value.value(&[3.0, 4.0]), 5.0);
    assert_eq!(shear.field.name(2), "deformation_gradient.yx");
    assert_eq!(shear.field.component, Component::Entry(2));
    let names: Vec<_> = case.plots[0].curves.iter().map(|curve| curve.name()).collect();
    assert_eq!(names, ["top.displacement.y", "energy.total", "toe.position.x"]);
}

#[test]
fn reads_variants_and_checks() {
    let case = full();
    let variant = &case.variants[0];
    assert_eq!((variant.name.as_str(), variant.title.as_deref()), ("no-upwinding", Some("plain")));
    assert_eq!(variant.set, ["scheme.tau_velocity=0"]);
    let value =
        |expected, tolerance, absolute| Expectation::Value { expected, tolerance, absolute };
    let bounds = |at_least, at_most| Expectation::Bounds { at_least, at_most };
    let expected = [
        (Reduction::Maximum, value(0.2, 0.01, false), When::Always),
        (Reduction::At(0.25), value(0.0, 1e-3, true), When::At(Level::Case)),
        (Reduction::Extremum(2), bounds(Some(-1.0), Some(6.0)), When::Always),
        (Reduction::Final, Expectation::Outcome("completed".to_owned()), When::At(Level::Coarse)),
        (Reduction::Final, Expectation::LessThan(None), When::Always),
    ];
    for (check, (reduce, expectation, when)) in case.checks.iter().zip(expected) {
        assert_eq!((&check.reduce, &check.expectation, check.when), (&reduce, &expectation, when));
    }
    let last = &case.checks[5];
    assert!(matches!(last.reduce, Reduction::CurveRms(_)));
    assert_eq!(
        last.quantity.value,
        Quantity::Probe { probe: "toe".to_owned(), column: "position.x".to_owned() }
    );
    assert_eq!(case.checks[0].variant.as_deref().map(String::as_str), Some("no-upwinding"));
    assert_eq!(case.checks[4].quantity.value, Quantity::Energy("total".to_owned()));
}

#[test]
fn plane_states_have_the_moduli_of_isotropic_elasticity() {
    // From the Lame constants: kappa = lambda + 2 mu / D without strain across, and for D = 2
    // without stress across with lambda replaced by 2 lambda mu / (lambda + 2 mu).
    let (e, nu) = (3.0, 0.2);
    let mu = e / (2.0 * (1.0 + nu));
    let lambda = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let flat = 2.0 * lambda * mu / (lambda + 2.0 * mu);
    for (dimension, state, expected) in [
        (1, PlaneState::Strain, lambda + 2.0 * mu),
        (2, PlaneState::Strain, lambda + mu),
        (3, PlaneState::Strain, lambda + 2.0 * mu / 3.0),
        (3, PlaneState::Stress, lambda + 2.0 * mu / 3.0),
        (2, PlaneState::Stress, flat + mu),
        (1, PlaneState::Stress, e),
    ] {
        let got = state.bulk_modulus(e, nu, dimension);
        assert!((got - expected).abs() < 1e-14 * expected, "{dimension} {state:?}: {got}");
    }
}

#[test]
fn a_value_can_be_refused_after_reading() {
    let case = full();
    let place = case.boundaries[0].region.place;
    let problem = case.problem_at(place, "the boundary `floor` selects no particle", "empty", None);
    let shown = case.refuse(vec![problem]).to_string();
    let (line, text) = FULL.lines().enumerate().find(|(_, line)| line.contains("-1.0] }")).unwrap();
    assert!(shown.contains(&format!("case.toml:{}:9", line + 1)), "{shown}");
    assert!(shown.contains(text) && shown.contains("^^^ empty"), "{shown}");
}

#[test]
fn the_case_as_run_is_the_same_case() {
    let options = LoadOptions {
        variant: Some("no-upwinding".to_owned()),
        overrides: vec!["time.end=2".to_owned()],
        level: Level::Coarse,
        ..LoadOptions::default()
    };
    let case = parse(FULL, "case.toml", &options).unwrap();
    let again = read_with(&case.as_run, &[]).unwrap();
    assert_eq!(again.time.end.value, 2.0);
    assert_eq!(again.bodies[0].spacing.value, [0.5, 0.5]);
    assert_eq!(again.as_run, case.as_run);
}

#[test]
fn the_case_as_run_keeps_parameters_above_those_that_use_them() {
    let text = FULL.replace("[parameters]\n", "[parameters]\nzeta = 1.0\nalpha = \"2 * zeta\"\n");
    let case = parse(&text, "case.toml", &LoadOptions::default()).unwrap();
    let again = read_with(&case.as_run, &[]).unwrap();
    assert_eq!(again.parameter("alpha"), Some(2.0));
}

#[test]
fn the_reference_names_every_table_and_function() {
    let page = reference::markdown();
    for text in [
        "## Top level",
        "## `[[body]]`",
        "### `kind = \"annulus\"` (2D and 3D only)",
        "| `smoothing_length` | number above 0 | spacings | required |",
        "`wendland_c6`",
        "| `jitter` | number from 0 to 0.5 | spacings | `0.0` |",
        "| `atan2(a, b)` |",
    ] {
        assert!(page.contains(text), "{text}");
    }
    for line in page.lines().filter(|line| line.starts_with('|')) {
        assert!(matches!(line.matches('|').count(), 3 | 6), "{line}");
    }
}
