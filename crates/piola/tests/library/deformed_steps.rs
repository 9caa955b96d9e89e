//! The step of total Lagrangian solids follows the deformation: its elastic part and its viscous one.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use std::sync::Arc;

use crate::support::{lattice, place};
use piola::boundaries::{PrescribedVelocity, SpaceTime};
use piola::operators::{Continuation, Mirror};
use piola::schemes::total_lagrangian::{
    Dissipation, Form, Material, Settings, TotalLagrangian, TotalLagrangianInput, Tractions,
};
use piola::schemes::{Ledger, Observation, Scheme, StepLimit};
use piola::time::IntegratorKind;
use piola::{Tensor, Vector};
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::StressState;

const CFL: f64 = 0.9;

/// Moduli of one, so that `rho c^2 = lambda + 2 mu` sets times.
fn constants(nu: f64) -> LameConstants {
    LameConstants::from_young(1.0, nu).unwrap()
}

/// A block between a plane at each lower side and one that is moved along x, its other sides free.
fn block<const D: usize>(
    intervals: [usize; D],
    nu: f64,
    settings: Settings<D>,
    speed: f64,
) -> TotalLagrangian<D> {
    let particles = lattice(intervals.map(|n| n as f64), intervals);
    let positions = particles.position.clone();
    let length = intervals[0] as f64;
    let state = match D {
        1 => StressState::UniaxialStrain,
        2 => StressState::PlaneStrain,
        _ => StressState::ThreeDimensional,
    };
    let law = Reduced::new(HyperelasticLaw::neo_hookean_logarithmic(constants(nu)), state).unwrap();
    let on = |axis: usize, place: f64| -> Vec<u32> {
        let all = 0..positions.len() as u32;
        all.filter(|&a| (positions[a as usize][axis] - place).abs() < 1e-9).collect()
    };
    let (mut prescribed, mut mirrors) = (Vec::new(), Vec::new());
    let mut plane = |axis: usize, place: f64, is_upper: bool, value: Arc<dyn SpaceTime>| {
        let particles = on(axis, place);
        if settings.form == Form::Adjoint {
            let mirror = Mirror { axis, place, is_upper, continuation: Continuation::Odd };
            mirrors.push((mirror, particles[0]));
        }
        let name = "plane".into();
        prescribed.push(PrescribedVelocity { name, particles, component: axis, value });
    };
    (0..D).for_each(|axis| plane(axis, 0.0, false, Arc::new(0.0)));
    plane(0, length, true, Arc::new(speed));
    let count = positions.len();
    let even =
        |x: &Vector<D>| Vector::from_fn(|i, _| if i == 0 { speed * x[0] / length } else { 0.0 });
    let (material, radius) = (Material { density: 1.0, law }, vec![2.5; count]);
    let kernel = Kernel::ModifiedMollifier;
    let velocity = positions.iter().map(even).collect();
    let bodies = TotalLagrangianInput::of_bodies(particles, &[material], (kernel, radius));
    let input = TotalLagrangianInput { settings, velocity, prescribed, mirrors, ..bodies };
    TotalLagrangian::new(input).unwrap()
}

fn limit(scheme: &mut dyn Scheme, state: &[f64]) -> StepLimit {
    let mut limits = Vec::new();
    scheme.inspect(state, &mut limits);
    limits[0]
}

/// Runs at the default CFL number; the state at the end, and the names of the bounds on the way.
fn run(scheme: &mut dyn Scheme, end: f64) -> (Vec<f64>, Vec<&'static str>) {
    let start = scheme.initial_state();
    run_at(scheme, start, end, CFL)
}

/// The same from a state, at a share of the limit, with steps that grow as the limit lets them.
fn run_at(
    scheme: &mut dyn Scheme,
    mut state: Vec<f64>,
    end: f64,
    share: f64,
) -> (Vec<f64>, Vec<&'static str>) {
    let mut integrator = IntegratorKind::KickDriftKick.build(scheme).expect("it moves the scheme");
    let (mut new, mut names, mut time) = (state.clone(), Vec::new(), 0.0);
    let mut wanted = f64::INFINITY;
    while time < end {
        let limit = limit(scheme, &state);
        assert!(limit.step > 0.0 && limit.step.is_finite(), "at {time}: {limit:?}");
        if !names.contains(&limit.name) {
            names.push(limit.name);
        }
        wanted = (share * limit.step).min(wanted * limit.growth);
        let step = wanted.min(end - time);
        integrator.step(scheme, time, step, &state, &mut new).unwrap();
        std::mem::swap(&mut state, &mut new);
        time = if step == end - time { end } else { time + step };
        assert!(state.iter().all(|value| value.is_finite()), "not finite at {time}");
    }
    (state, names)
}

/// The stretch across at which sides are free of stress, by bisection of the law's own formula.
fn across<const D: usize>(nu: f64, along: f64) -> f64 {
    let LameConstants { lambda, mu } = constants(nu);
    let (mut low, mut high) = (0.01_f64, 1.0_f64);
    for _ in 0..100 {
        let l = 0.5 * (low + high);
        let volume = along * l.powi(D as i32 - 1);
        let stress = mu * (l - 1.0 / l) + lambda * volume.ln() / l;
        if stress > 0.0 { high = l } else { low = l }
    }
    0.5 * (low + high)
}

/// Pulled to six times its length with Kelvin and Voigt's viscosity and free sides: the run goes
/// through at the default CFL number, and ends at the stretch across of the law but for what viscosity
/// holds back, `eta d` of 0.5 % of the modulus.
fn pull<const D: usize>(intervals: [usize; D], nu: f64) {
    let LameConstants { lambda, mu } = constants(nu);
    let (speed_of_waves, length) = ((lambda + 2.0 * mu).sqrt(), intervals[0] as f64);
    let transit = length / speed_of_waves;
    let form = if D == 1 { Form::Strong } else { Form::Adjoint };
    let viscosity = 0.05 * speed_of_waves * length;
    let settings = Settings {
        form,
        hourglass: if D == 1 { 0.0 } else { 0.05 },
        tractions: Tractions::Layers,
        dissipation: Dissipation { viscosity, ..Dissipation::default() },
        ..Settings::default()
    };
    let stop = 30.0 * transit;
    let mut scheme = block(intervals, nu, settings, 5.0 * length / stop);
    let (state, names) = run(&mut scheme, stop);
    assert!(names.contains(&"dissipation"), "{names:?}");
    let all: Vec<u32> = (0..scheme.particle_count() as u32).collect();
    let gradients =
        Observation::new(&mut scheme, stop, &state).values("deformation_gradient", &all);
    for gradient in gradients.chunks_exact(D * D) {
        let gradient = Tensor::<D>::from_row_slice(gradient);
        for axis in 0..D {
            let along = if D == 1 { 1.0 + 5.0 * 1.017_973_483 } else { 6.0 };
            let exact = if axis == 0 { along } else { across::<D>(nu, 6.0) };
            let got = gradient[(axis, axis)];
            assert!((got / exact - 1.0).abs() < 0.02, "nu {nu}, axis {axis}: {got}, not {exact}");
        }
    }
}

#[test]
fn a_viscous_bar_is_pulled_to_six_at_the_default_cfl_number() {
    [0.3, 0.45, 0.48].into_iter().for_each(|nu| pull([14], nu));
    [0.3, 0.45, 0.49].into_iter().for_each(|nu| pull([14, 6], nu));
    [0.45, 0.49].into_iter().for_each(|nu| pull([5, 3, 3], nu));
}

/// Pulled at once from rest without any dissipation, at the default CFL number and just below the limit:
/// the run goes through, and what comes in is stored to 1 %, where steps up to two a period gave energy
/// to the fastest vibrations until particles turned inside out.
#[test]
fn undamped_blocks_are_pulled_near_the_limit() {
    let settings = || Settings { hourglass: 0.05, ..Settings::default() };
    for (nu, stretch, share) in
        [(0.25, 4.0, CFL), (0.35, 3.0, 0.98), (0.42, 6.0, CFL), (0.45, 6.0, 0.95)]
    {
        let (intervals, LameConstants { lambda, mu }) = ([20, 8], constants(nu));
        let stop = 30.0 * 20.0 / (lambda + 2.0 * mu).sqrt();
        let mut scheme = block(intervals, nu, settings(), (stretch - 1.0) * 20.0 / stop);
        let mut start = scheme.initial_state();
        let velocity = place(&scheme, "velocity", 0, 0);
        start[velocity..][..2 * scheme.particle_count()].fill(0.0);
        scheme.constrain(0.0, &mut start);
        let (state, names) = run_at(&mut scheme, start, stop, share);
        assert_eq!(names, ["eigenvalue"]);
        let mut energies = [0.0; 3];
        scheme.energies(&state, &mut energies);
        let stored: f64 = energies.iter().sum();
        let work: f64 = Ledger::of(&scheme, &state).work.iter().sum();
        assert!((work / stored - 1.0).abs() < 0.01, "nu {nu}, to {stretch}: {work}, {stored}");
    }
}

/// An evenly stretched row has the elastic eigenvalue at rest times the growth of `dP/dF`, and the
/// viscous one times J/l^2.
#[test]
fn the_bound_is_that_of_the_deformed_body() {
    let plain = || Settings { form: Form::Strong, ..Settings::default() };
    let nu = 0.3;
    let LameConstants { lambda, mu } = constants(nu);
    let dissipation = Dissipation { viscosity: 3.0, ..Dissipation::default() };
    let stiff = || Settings { dissipation, ..plain() };
    for pulled in [0.4_f64, 2.5] {
        // Plain sums have 1.018 of a gradient under this cover.
        let stretch = 1.0 + 1.017_973_483 * (pulled - 1.0);
        let modulus =
            mu * (1.0 + stretch.powi(-2)) + lambda * (1.0 - stretch.ln()) / stretch.powi(2);
        let stiffening = modulus / (lambda + 2.0 * mu);
        let at = |settings: Settings<1>, pulled: f64| {
            let mut scheme = block([60], nu, settings, 0.0);
            let mut state = scheme.initial_state();
            let displacement = place(&scheme, "displacement", 0, 0);
            (0..61).for_each(|a| state[displacement + a] = (pulled - 1.0) * a as f64);
            limit(&mut scheme, &state)
        };
        let (rest, deformed) = (at(plain(), 1.0), at(plain(), pulled));
        assert!((rest.step / deformed.step / stiffening.sqrt() - 1.0).abs() < 1e-6);
        assert_eq!(deformed.name, "eigenvalue");
        // As solved in theory (67) for the viscous eigenvalue at rest, which grows with J/l^2 = 1/l.
        let step = at(stiff(), 1.0).step;
        // Without dissipation the limit is that of three steps a period.
        let squared = |plain: StepLimit| 3.0 / plain.step.powi(2);
        let viscous = 2.0 / step - 0.5 * step * squared(rest);
        let (growth, elastic) = (viscous / stretch, squared(deformed));
        let expected = 4.0 / (growth + (growth * growth + 4.0 * elastic).sqrt());
        let got = at(stiff(), pulled);
        assert!((got.step / expected - 1.0).abs() < 1e-3, "{got:?}, not {expected}");
        assert_eq!(got.name, "dissipation");
    }
}
