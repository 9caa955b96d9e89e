//! The generalised formulation (GTVF): the push of a background pressure, and gradients of the
//! transport velocity.

use piola::boundaries::PrescribedVelocity;
use piola::geometry::Particles;
use piola::schemes::Scheme;
use piola::schemes::transport_velocity::{
    Contact, Corrections, DensityRule, Fluid, Heat, Settings, Shifting, Slip, Solid, SolidsInput,
    TransportVelocityInput, Wall,
};
use piola::{Tensor, Vector};
use piola_formulas::hypoelastic::{EquationOfState, PressureLaw, Strength};
use piola_formulas::kernels::Kernel;

use super::solids::{self, two_blocks_with};
use super::support::{
    SETTINGS, Solids, change_rows, deviations, fluid_in_box, solids_in_box, unit_box,
};

const FLUID: Fluid = Fluid { density: 2.0, wave_speed: 10.0, viscosity: 0.0 };
const MOST: f64 = 0.5;
const STEP: f64 = 1e-3;

fn background(settings: Settings) -> Settings {
    let corrections = Corrections::GENERALISED;
    Settings { shifting: Shifting::Background { most: MOST }, corrections, ..settings }
}

/// Any numbers that are no function of place.
fn noise(k: usize) -> f64 {
    (k as f64 * 12.9898).sin()
}

/// Puts densities and pressures at random into a state, some pressures zero, and returns both.
fn scatter(scheme: &dyn Scheme, state: &mut [f64]) -> Vec<(f64, f64)> {
    let density = 2 * scheme.dimension();
    let mut both = Vec::new();
    change_rows(scheme, state, |number, row| {
        row[density] *= 1.0 + 0.02 * noise(3 * number);
        row[density + 1] = if number % 5 == 0 { 0.0 } else { 30.0 * noise(5 * number + 1) };
        both.push((row[density], row[density + 1]));
    });
    both
}

/// The deviations that a drift of [`STEP`] is made with.
fn drifted<const D: usize>(scheme: &mut dyn Scheme, mut state: Vec<f64>) -> Vec<Vector<D>> {
    scheme.split().expect("it can be split").drift(0.0, STEP, &mut state);
    deviations(scheme, &state)
}

/// `sum_b m_b grad W(r_ab, h/2)` over all other particles of the periodic unit box that are `own`.
fn pushes<const D: usize>(
    positions: &[Vector<D>],
    masses: &[f64],
    h: f64,
    own: impl Fn(usize, usize) -> bool,
) -> Vec<Vector<D>> {
    let count = positions.len();
    let of = |a: usize| {
        let mut sum = Vector::<D>::zeros();
        for b in (0..count).filter(|&b| b != a && own(a, b)) {
            let separation = (positions[a] - positions[b]).map(|x| x - x.round());
            let slope = Kernel::QuinticSpline.derivative(D, separation.norm(), 0.5 * h);
            sum += separation.normalize() * (masses[b] * slope);
        }
        sum
    };
    (0..count).map(of).collect()
}

fn compare<const D: usize>(
    found: &[Vector<D>],
    expected: impl Fn(usize) -> Vector<D>,
    of: &[usize],
) {
    let largest = of.iter().map(|&a| expected(a).norm()).fold(0.0, f64::max);
    assert!(largest > 1e-3, "they are pushed: {largest} m/s");
    for &a in of {
        let off = (found[a] - expected(a)).norm();
        assert!(off < 1e-12 * largest, "{D}D, particle {a}: off by {off:e} of {largest:e} m/s");
    }
}

fn is_that_of_all_pairs<const D: usize>(side: usize) {
    let particles = unit_box::<D>(side, 0.2, 5);
    let (positions, count) = (particles.position.clone(), particles.len());
    let (spacing, h) = (particles.spacing[0], 1.1);
    let start = |_: &Vector<D>| (Vector::zeros(), 0.0);
    let mut scheme = fluid_in_box(particles, background(SETTINGS), FLUID, h, start);
    let mut state = scheme.initial_state();
    let values = scatter(&scheme, &mut state);
    let found = drifted(&mut scheme, state);
    let masses = vec![FLUID.density * spacing.powi(D as i32); count];
    let sums = pushes(&positions, &masses, h * spacing, |_, _| true);
    let most = MOST * FLUID.density * FLUID.wave_speed * FLUID.wave_speed;
    let expected = |a: usize| {
        let (density, pressure) = values[a];
        sums[a] * (-0.5 * STEP * (10.0 * pressure.abs()).min(most) / (density * density))
    };
    assert!(values.iter().any(|(_, p)| 10.0 * p.abs() > most));
    compare(&found, expected, &(0..count).collect::<Vec<_>>());
    for (deviation, (_, pressure)) in found.iter().zip(&values) {
        assert!(*pressure != 0.0 || deviation.norm() == 0.0, "no pressure, no push");
    }
}

#[test]
fn the_push_is_the_sum_over_all_pairs() {
    is_that_of_all_pairs::<1>(24);
    is_that_of_all_pairs::<2>(14);
    is_that_of_all_pairs::<3>(8);
}

#[test]
fn a_particle_off_its_place_is_pushed_back_under_any_pressure() {
    let particles = unit_box::<2>(12, 0.0, 1);
    let off = Vector::<2>::new(0.03, -0.01);
    for pressure in [3.0, -3.0] {
        let mut particles = particles.clone();
        particles.position[77] += off;
        let start = |_: &Vector<2>| (Vector::zeros(), pressure);
        let settings = Settings { density: DensityRule::Continuity, ..background(SETTINGS) };
        let mut scheme = fluid_in_box(particles, settings, FLUID, 1.0, start);
        let state = scheme.initial_state();
        let found: Vec<Vector<2>> = drifted(&mut scheme, state);
        assert!(found[77].dot(&off) < -0.9 * found[77].norm() * off.norm(), "{}", found[77]);
        // Far away all is even.
        assert!(found[0].norm() < 1e-12 * found[77].norm(), "{}", found[0]);
    }
}

fn solid(density: f64, wave_speed: f64) -> Solid {
    let state = EquationOfState {
        density,
        wave_speed,
        law: PressureLaw::Linear,
        spall_strength: f64::INFINITY,
    };
    Solid { state, shear_modulus: 60.0, strength: Strength::Elastic, heat: Heat::NONE }
}

/// Two bodies and a wall side by side; some of the first body are held.
#[test]
fn solids_are_pushed_by_their_own_body_and_walls() {
    let mut particles: Particles<2> = unit_box(14, 0.2, 9);
    for (body, position) in particles.body.iter_mut().zip(&particles.position) {
        *body = u32::from(position[0] > 0.4) + u32::from(position[0] > 0.8);
    }
    let (positions, bodies) = (particles.position.clone(), particles.body.clone());
    let (count, spacing) = (particles.len(), particles.spacing[0]);
    let held: Vec<u32> =
        (0..count as u32).filter(|&a| a % 7 == 0 && bodies[a as usize] == 0).collect();
    let is_held = |a: &usize| held.contains(&(*a as u32));
    let materials = vec![solid(2.0, 10.0), solid(3.0, 5.0), solid(2.0, 10.0)];
    let condition = |component| PrescribedVelocity {
        name: "held".into(),
        particles: held.clone(),
        component,
        value: std::sync::Arc::new(0.0_f64),
    };
    let settings = background(Settings { free_surface: true, ..solids::SETTINGS });
    let (input, solids) = solids_in_box(particles, settings, materials.clone());
    let held_by = vec![condition(0), condition(1)];
    let input = TransportVelocityInput { walls: vec![Wall { body: 2, slip: Slip::No }], ..input };
    let solids = SolidsInput { held: held_by, ..solids };
    let mut scheme = Solids::new(input, solids).expect("the solids can be built");
    let mut state = scheme.initial_state();
    let values = scatter(&scheme, &mut state);
    let found = drifted(&mut scheme, state);
    let material = |a: usize| materials[bodies[a] as usize].state;
    // A wall fills its cell at any density.
    let of_walls = |a: usize| (bodies[a] == 2).then_some(values[a].0);
    let density = |a: usize| of_walls(a).unwrap_or(material(a).density);
    let masses: Vec<f64> = (0..count).map(|a| density(a) * spacing * spacing).collect();
    let own = |a: usize, b: usize| bodies[b] == bodies[a] || bodies[b] == 2;
    let sums = pushes(&positions, &masses, spacing, own);
    let expected = |a: usize| {
        let (density, pressure) = values[a];
        let most = MOST * material(a).density * material(a).wave_speed.powi(2);
        sums[a] * (-0.5 * STEP * (10.0 * pressure.abs()).min(most) / (density * density))
    };
    let free: Vec<usize> = (0..count).filter(|a| bodies[*a] < 2 && !is_held(a)).collect();
    compare(&found, expected, &free);
    let others = (0..count).filter(|a| bodies[*a] == 2 || is_held(a));
    assert!(others.clone().count() > 10);
    assert!(others.into_iter().all(|a| found[a].norm() == 0.0));
}

#[test]
fn gradients_and_contact_of_solids_are_those_of_the_transport_velocity() {
    let gradient = [[0.3, -0.7], [1.1, 0.4]];
    let carried = [[-0.2, 0.5], [0.1, 0.6]];
    let at = |m: [[f64; 2]; 2], x: f64, y: f64, i: usize| m[i][0] * x + m[i][1] * y;
    // Velocity and deviation, or their sum and no deviation.
    let rates = |corrections, apart: bool| {
        let settings = Settings { corrections, shifting: Shifting::None, ..solids::SETTINGS };
        let (mut scheme, mut state, _) = two_blocks_with::<2>(Contact::Repulsive, true, settings);
        change_rows(&scheme, &mut state, |_, row| {
            let (x, y) = (row[2], row[3]);
            for i in 0..2 {
                let (u, d) = (at(gradient, x, y, i), at(carried, x, y, i));
                (row[i], row[8 + i]) = if apart { (u, d) } else { (u + d, 0.0) };
            }
        });
        let terms = scheme.terms(0.0, &state);
        let divergences: Vec<f64> = terms.iter().map(|(rates, _)| rates.divergence).collect();
        (scheme.solid_rates(), divergences)
    };
    for (corrections, with) in [(Corrections::GENERALISED, 1.0), (Corrections::FULL, 0.0)] {
        let (found, divergences) = rates(corrections, true);
        let expected = Tensor::<2>::from_fn(|i, j| gradient[i][j] + with * carried[i][j]);
        for rates in &found {
            assert!((rates.gradient - expected).norm() < 1e-12, "{}", rates.gradient);
        }
        let (_, together) = rates(corrections, false);
        let pairs = divergences.iter().zip(&together);
        let off = pairs.map(|(one, two)| (one - two).abs()).fold(0.0, f64::max);
        assert_eq!(off < 1e-10, with == 1.0, "{off}");
        // Where the bodies touch, what comes from the other one is in it.
        let beyond = divergences.iter().map(|div| (div - expected.trace()).abs());
        assert!(beyond.fold(0.0, f64::max) > 0.1);
    }
}
