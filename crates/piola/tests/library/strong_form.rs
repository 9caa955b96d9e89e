//! The strong form in two dimensions: growth of its modes, frequencies, long runs and large stretches.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::support::{lattice, place};
use piola::boundaries::{PrescribedVelocity, SpaceTime, Traction};
use piola::schemes::total_lagrangian::{
    Form, Hole, Material, Settings, TotalLagrangian, TotalLagrangianInput,
};
use piola::schemes::{Ledger, Observation, Scheme};
use piola::time::IntegratorKind;
use piola::{Tensor, Vector};
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::StressState;

type Law = fn(LameConstants) -> HyperelasticLaw;
type Shape = Box<dyn Fn(&Vector<2>) -> [f64; 2]>;

/// A sheet of spacings of one, of a modulus and a density at which strain waves have a speed of one.
struct Sheet {
    intervals: [usize; 2],
    ratio: f64,
    law: Law,
    cover: f64,
}

const NEO_HOOKEAN: Law = HyperelasticLaw::neo_hookean_logarithmic;

impl Sheet {
    fn constants(&self) -> LameConstants {
        let nu = self.ratio;
        LameConstants::from_young((1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu), nu).unwrap()
    }

    fn input(&self) -> TotalLagrangianInput<2> {
        let particles = lattice(self.intervals.map(|n| n as f64), self.intervals);
        let count = particles.len();
        let law = Reduced::new((self.law)(self.constants()), StressState::PlaneStrain).unwrap();
        let supports = (Kernel::ModifiedMollifier, vec![self.cover; count]);
        let material = Material { density: 1.0, law };
        let settings = Settings { form: Form::Strong, ..Settings::default() };
        let bodies = TotalLagrangianInput::of_bodies(particles, &[material], supports);
        TotalLagrangianInput { settings, ..bodies }
    }

    /// Particles on the lower or upper edge across an axis.
    fn edge(&self, axis: usize, is_upper: bool) -> Vec<u32> {
        let place = if is_upper { self.intervals[axis] } else { 0 };
        let width = self.intervals[0] + 1;
        let all = 0..(width * (self.intervals[1] + 1)) as u32;
        let index = |a: u32| [a as usize % width, a as usize / width][axis];
        all.filter(|&a| index(a) == place).collect()
    }

    fn traction(&self, axis: usize, is_upper: bool, value: Arc<dyn SpaceTime>) -> Traction<2> {
        let particles = self.edge(axis, is_upper);
        let mut values: [Arc<dyn SpaceTime>; 2] = [Arc::new(0.0), Arc::new(0.0)];
        values[axis] = value;
        let areas = vec![1.0; particles.len()];
        Traction { name: "pull".into(), particles, areas, places: vec![], value: values }
    }

    fn held(&self, axis: usize, is_upper: bool, speed: f64) -> PrescribedVelocity {
        let particles = self.edge(axis, is_upper);
        PrescribedVelocity {
            name: "held".into(),
            particles,
            component: axis,
            value: Arc::new(speed),
        }
    }

    /// The first Piola-Kirchhoff stress of principal stretches.
    fn stress(&self, stretches: [f64; 2]) -> Tensor<2> {
        let law =
            Reduced::<2>::new((self.law)(self.constants()), StressState::PlaneStrain).unwrap();
        law.stress(&(Tensor::from_diagonal(&stretches.into()) - Tensor::identity()))
    }

    /// The stretch across at which a stretch along has free sides.
    fn across(&self, along: f64) -> f64 {
        let (mut low, mut high) = (0.01, 1.0);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            let is_pulled = self.stress([along, middle])[(1, 1)] > 0.0;
            (low, high) = if is_pulled { (low, middle) } else { (middle, high) };
        }
        low
    }
}

/// `d(acceleration)/d(displacement)` about displacements, in columns.
fn linearised(scheme: &mut TotalLagrangian<2>, about: &[Vector<2>], size: f64) -> DMatrix<f64> {
    let count = about.len();
    let [moved, speed] = ["displacement", "velocity"].map(|field| place(scheme, field, 0, 0));
    let mut state = scheme.initial_state();
    for (a, displacement) in about.iter().enumerate() {
        state[moved + 2 * a..][..2].copy_from_slice(displacement.as_slice());
    }
    let mut rate = state.clone();
    let mut matrix = DMatrix::zeros(2 * count, 2 * count);
    for column in 0..2 * count {
        let place = moved + column;
        let before = state[place];
        for sign in [1.0, -1.0] {
            state[place] = before + sign * size;
            scheme.rates(0.0, &state, &mut rate);
            for row in 0..2 * count {
                matrix[(row, column)] += sign * rate[speed + row] / (2.0 * size);
            }
        }
        state[place] = before;
    }
    matrix
}

/// Growth per time that a wave needs from particle to particle, and the highest frequency.
fn growth_and_frequency(matrix: DMatrix<f64>) -> [f64; 2] {
    let roots = matrix.complex_eigenvalues().map(|value| value.sqrt());
    [
        roots.iter().fold(0.0, |most: f64, root| most.max(root.re.abs())),
        roots.iter().fold(0.0, |most: f64, root| most.max(root.im.abs())),
    ]
}

/// No mode of a free sheet grows, at rest and pulled to one and a half times its length, and the step is
/// that of the highest frequency.
#[test]
fn modes_of_a_free_sheet_do_not_grow() {
    for cover in [2.5, 3.5] {
        let sheet = Sheet { intervals: [14, 6], ratio: 0.3, law: NEO_HOOKEAN, cover };
        let mut scheme = TotalLagrangian::new(sheet.input()).unwrap();
        let still = vec![Vector::zeros(); 15 * 7];
        let [growth, frequency] = growth_and_frequency(linearised(&mut scheme, &still, 1e-5));
        assert!(growth < 1e-4, "cover {cover}: {growth}");
        let mut limits = Vec::new();
        scheme.inspect(&scheme.initial_state(), &mut limits);
        // The law is not linear: three steps a period, not two.
        let bound = limits[0].step * frequency / 3.0_f64.sqrt();
        assert!(bound > 0.97 && bound < 1.0 + 1e-3, "cover {cover}: {bound}");

        let mut made = sheet.input();
        let across = sheet.across(1.5);
        let pull = sheet.stress([1.5, across])[(0, 0)];
        made.tractions = vec![
            sheet.traction(0, false, Arc::new(-pull)),
            sheet.traction(0, true, Arc::new(pull)),
        ];
        let positions = made.particles.position.iter();
        let stretched: Vec<_> =
            positions.map(|x| Vector::from([0.5 * x[0], (across - 1.0) * x[1]])).collect();
        let mut scheme = TotalLagrangian::new(made).unwrap();
        let [growth, _] = growth_and_frequency(linearised(&mut scheme, &stretched, 1e-5));
        assert!(growth < 1e-4, "cover {cover}: {growth}");
    }
}

/// A quarter of a sheet with a hole: no mode grows faster than half of the rate 2 c_s/L at which the case
/// E13 damps motion, at Poisson's ratios that it does not have.
#[test]
fn modes_around_a_hole_do_not_outgrow_the_damping_of_the_case() {
    for ratio in [0.2, 0.4] {
        let sheet = Sheet { intervals: [12, 11], ratio, law: NEO_HOOKEAN, cover: 2.5 };
        let mut made = sheet.input();
        let hole = Hole { center: Vector::zeros(), radius: 3.0 };
        let stays = |a: &u32| made.particles.position[*a as usize].norm() >= hole.radius - 1e-9;
        let left: Vec<u32> = (0..made.particles.len() as u32).filter(stays).collect();
        let all = std::mem::take(&mut made.particles);
        let place = |a: &u32| all.position[*a as usize];
        made.particles.position = left.iter().map(place).collect();
        made.particles.volume = left.iter().map(|&a| all.volume[a as usize]).collect();
        let count = left.len();
        made.particles.weight = vec![1.0; count];
        made.particles.spacing = vec![1.0; count];
        made.particles.body = vec![0; count];
        made.particles.id = (0..count as u32).collect();
        (made.radius, made.group, made.mixture) =
            (vec![2.5; count], vec![0; count], vec![0; count]);
        made.displacement = vec![Vector::zeros(); count];
        made.velocity = vec![Vector::zeros(); count];
        let positions = &made.particles.position;
        made.prescribed = (0..2)
            .map(|component| PrescribedVelocity {
                name: "held".into(),
                particles: (0..count as u32)
                    .filter(|&a| positions[a as usize][component] == 0.0)
                    .collect(),
                component,
                value: Arc::new(0.0),
            })
            .collect();
        made.holes = vec![hole];
        let mut scheme = TotalLagrangian::new(made).unwrap();
        let matrix = linearised(&mut scheme, &vec![Vector::zeros(); count], 1e-5);
        let [growth, _] = growth_and_frequency(matrix);
        let constants = sheet.constants();
        let shear_speed = constants.mu.sqrt();
        assert!(growth < shear_speed / 12.0, "nu {ratio}: {growth}");
    }
}

/// First bending and first longitudinal frequency of a free bar of 31 x 6 particles against quadratic
/// finite elements, within twice the second-order error of five particles across.
#[test]
fn a_free_bar_has_the_frequencies_of_finite_elements() {
    let sheet =
        Sheet { intervals: [30, 5], ratio: 0.3, law: HyperelasticLaw::linear_elastic, cover: 2.5 };
    let made = sheet.input();
    let positions = made.particles.position.clone();
    let mut scheme = TotalLagrangian::new(made).unwrap();
    let matrix = linearised(&mut scheme, &vec![Vector::zeros(); positions.len()], 1.0);
    let (length, number): (f64, f64) = (30.0, 4.730_040_745 / 30.0);
    let ratio = ((number * length).cosh() - (number * length).cos())
        / ((number * length).sinh() - (number * length).sin());
    let bending = move |x: f64| {
        let k = number * x;
        let deflection = k.cosh() + k.cos() - ratio * (k.sinh() + k.sin());
        let slope = number * (k.sinh() - k.sin() - ratio * (k.cosh() + k.cos()));
        [deflection, slope]
    };
    let shapes: [(f64, f64, Shape); 2] = [
        (
            0.029613,
            0.02,
            Box::new(move |x| {
                let [deflection, slope] = bending(x[0]);
                [-(x[1] - 2.5) * slope, deflection]
            }),
        ),
        (0.094412, 0.01, Box::new(move |x| [(std::f64::consts::PI * x[0] / length).cos(), 0.0])),
    ];
    for (expected, tolerance, shape) in shapes {
        let square = expected * expected;
        let count = 2 * positions.len();
        let shifted = (&matrix + DMatrix::identity(count, count) * square).lu();
        let mut mode =
            DVector::from_iterator(count, positions.iter().flat_map(|x| shape(x).into_iter()));
        for _ in 0..3 {
            mode = shifted.solve(&mode).unwrap().normalize();
        }
        let frequency = (-mode.dot(&(&matrix * &mode))).sqrt();
        assert!((frequency / expected - 1.0).abs() < tolerance, "{frequency}, not {expected}");
    }
}

fn energy(scheme: &dyn Scheme, state: &[f64]) -> f64 {
    let mut energies = [0.0; 3];
    scheme.energies(state, &mut energies);
    energies.iter().sum()
}

/// Steps at a share of the stable step until an end, with a look at each state.
fn march(
    scheme: &mut TotalLagrangian<2>,
    end: f64,
    mut show: impl FnMut(&dyn Scheme, f64, &[f64]),
) -> Vec<f64> {
    let mut integrator = IntegratorKind::KickDriftKick.build(scheme).expect("it moves the scheme");
    let (mut state, mut limits, mut time) = (scheme.initial_state(), Vec::new(), 0.0);
    let mut new = state.clone();
    while time < end {
        scheme.inspect(&state, &mut limits);
        let step = (0.9 * limits[0].step).min(end - time);
        assert!(step > 1e-9, "a step of {step} at {time}");
        integrator.step(scheme, time, step, &state, &mut new).unwrap();
        std::mem::swap(&mut state, &mut new);
        time += step;
        show(scheme, time, &state);
    }
    state
}

struct Pulse;

impl SpaceTime for Pulse {
    fn value(&self, _x: [f64; 3], t: f64) -> f64 {
        if t < 12.0 { 1e-4 * (std::f64::consts::PI * t / 12.0).sin().powi(2) } else { 0.0 }
    }

    fn rate(&self, _x: [f64; 3], t: f64) -> f64 {
        let phase = std::f64::consts::PI / 12.0;
        if t < 12.0 { 1e-4 * phase * (2.0 * phase * t).sin() } else { 0.0 }
    }

    fn is_steady(&self) -> bool {
        false
    }
}

/// A pulse that runs to and fro for 40 transits of a bar with free sides keeps its energy to a tenth, in
/// which no mode of its that grows by more than 4e-5 of `c/dx` has room; the load has done it.
#[test]
fn forty_transits_of_a_stress_wave_stay_bounded() {
    let sheet = Sheet { intervals: [30, 5], ratio: 0.3, law: NEO_HOOKEAN, cover: 2.5 };
    let mut made = sheet.input();
    made.tractions = vec![sheet.traction(0, false, Arc::new(Pulse))];
    let mut scheme = TotalLagrangian::new(made).unwrap();
    let (mut loaded, mut range) = (None, [f64::INFINITY, 0.0_f64]);
    let end = march(&mut scheme, 40.0 * 30.0, |scheme, time, state| {
        if time > 12.0 {
            let energy = energy(scheme, state);
            loaded.get_or_insert(energy);
            range = [range[0].min(energy), range[1].max(energy)];
        }
    });
    let loaded = loaded.unwrap();
    assert!(range[0] > 0.9 * loaded && range[1] < 1.1 * loaded, "{loaded}, {range:?}");
    let work: f64 = Ledger::of(&scheme, &end).work.iter().sum();
    assert!((work / energy(&scheme, &end) - 1.0).abs() < 0.1, "{work}");
}

/// A sheet with free sides is pulled to six times its length in 120 transits, at once everywhere: the
/// stretch across and the stress are those of the law to the half a percent that E12 allows, at
/// Poisson's ratios, too, for which a sheet of held width loses its convexity on the way.
#[test]
fn a_sheet_with_free_sides_is_pulled_to_six_times_its_length() {
    for ratio in [0.3, 0.45, 0.49] {
        let sheet = Sheet { intervals: [30, 5], ratio, law: NEO_HOOKEAN, cover: 2.5 };
        let mut made = sheet.input();
        let end = 120.0 * 30.0;
        let speed = 5.0 * 30.0 / end;
        made.prescribed = vec![sheet.held(0, false, 0.0), sheet.held(0, true, speed)];
        made.velocity = (made.particles.position.iter())
            .map(|x| {
                let (rate, narrowing) = (speed / 30.0, ratio / (1.0 - ratio));
                Vector::from([rate * x[0], -rate * narrowing * (x[1] - 2.5)])
            })
            .collect();
        let mut scheme = TotalLagrangian::new(made).unwrap();
        let state = march(&mut scheme, end, |_, _, _| {});
        let middle = 15 + 31 * 2;
        let gradient =
            Observation::new(&mut scheme, end, &state).values("deformation_gradient", &[middle]);
        let stress = Observation::new(&mut scheme, end, &state).values("stress", &[middle]);
        let across = sheet.across(6.0);
        let expected = sheet.stress([6.0, across])[(0, 0)];
        assert!((gradient[3] / across - 1.0).abs() < 0.005, "{gradient:?}, not {across}");
        assert!((stress[0] / expected - 1.0).abs() < 0.005, "{stress:?}, not {expected}");
    }
}
