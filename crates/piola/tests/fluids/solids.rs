//! Solids: each term against manufactured fields, and what exactly holds for their sums.

use std::f64::consts::PI;

use piola::geometry::Particles;
use piola::schemes::transport_velocity::{
    Contact, Forces, Heat, PressureRule, Rates, Settings, Shifting, Solid, SolidRates, SolidsInput,
    TransportVelocityInput,
};
use piola::schemes::{Observation, Scheme};
use piola::{Tensor, Vector};
use piola_formulas::hypoelastic::{EquationOfState, PressureLaw, Strength};

use super::support::{Solids, change_matter, change_rows, rows, solids_in_box, unit_box};

const K: f64 = 2.0 * PI;

pub const SETTINGS: Settings =
    Settings { pressure: PressureRule::StateEquation, ..Settings::FLUID };

pub const SOLID: Solid = Solid {
    state: EquationOfState {
        density: 2.0,
        wave_speed: 10.0,
        law: PressureLaw::Linear,
        spall_strength: f64::INFINITY,
    },
    shear_modulus: 60.0,
    strength: Strength::Elastic,
    heat: Heat::NONE,
};

/// One that flows, if the stress is very large: all of its matter is carried.
const DUCTILE: Solid =
    Solid { strength: Strength::Linear { yield_stress: 1e9, hardening: 0.0 }, ..SOLID };

fn build<const D: usize>(
    solid: Solid,
    particles: Particles<D>,
    settings: Settings,
    contact: Contact,
    corrected: bool,
) -> Solids<D> {
    let bodies = 1 + particles.body.iter().copied().max().unwrap_or(0) as usize;
    let (input, solids) = solids_in_box(particles, settings, vec![solid; bodies]);
    let solids = SolidsInput { contact, corrected, ..solids };
    let smoothing_length = 1.3 * input.smoothing_length;
    Solids::new(TransportVelocityInput { smoothing_length, ..input }, solids)
        .expect("the solids can be built")
}

/// A field `mean + amplitude sin(k x + phase) cos(k y) cos(k z)` with its gradient.
#[derive(Clone, Copy)]
struct Field(f64, f64, f64);

impl Field {
    fn value<const D: usize>(self, x: &Vector<D>) -> f64 {
        let others: f64 = (1..D).map(|axis| (K * x[axis]).cos()).product();
        self.0 + self.1 * (K * x[0] + self.2).sin() * others
    }

    fn slope<const D: usize>(self, x: &Vector<D>, axis: usize) -> f64 {
        let factors = (0..D).map(|k| match (k, k == axis) {
            (0, false) => (K * x[0] + self.2).sin(),
            (0, true) => K * (K * x[0] + self.2).cos(),
            (_, false) => (K * x[k]).cos(),
            (_, true) => -K * (K * x[k]).sin(),
        });
        self.1 * factors.product::<f64>()
    }
}

const DENSITY: Field = Field(2.0, 0.1, 0.4);
const PRESSURE: Field = Field(0.0, 3.0, 1.1);

fn velocity(i: usize) -> Field {
    Field(0.3, 1.0, 0.7 + i as f64)
}

fn deviation(i: usize) -> Field {
    Field(-0.2, 0.4, 2.3 - i as f64)
}

/// Matter: deviatoric stress, plastic strain, temperature, energy. The trace of the stress is zero.
fn matter(k: usize) -> Field {
    match k {
        1 => Field(0.5, -3.0, 0.0),
        2 => Field(-1.0, 1.0, 0.0),
        _ => Field(0.5, 2.0 + k as f64, 0.3 * k as f64),
    }
}

/// The place of a component of the stress in the matter.
fn entry(i: usize, j: usize) -> usize {
    if i == j { i } else { 6 - i - j }
}

struct Found<const D: usize> {
    x: Vector<D>,
    rates: Rates,
    solid: SolidRates<D>,
    forces: Forces<D>,
}

fn terms<const D: usize>(side: usize, jitter: f64, solid: Solid, corrected: bool) -> Vec<Found<D>> {
    let mut particles = unit_box::<D>(side, jitter, 3);
    for (x, volume) in particles.position.iter().zip(&mut particles.volume) {
        *volume *= DENSITY.value(x) / SOLID.state.density;
    }
    let positions = particles.position.clone();
    let settings = match solid.strength {
        Strength::Elastic => SETTINGS,
        _ => Settings { pressure: PressureRule::Edac { alpha: 0.0 }, ..SETTINGS },
    };
    let mut scheme = build(solid, particles, settings, Contact::Repulsive, corrected);
    let mut state = scheme.initial_state();
    change_rows(&scheme, &mut state, |number, row| {
        let x = &positions[number];
        for i in 0..D {
            row[i] = velocity(i).value(x);
            row[3 * D + 2 + i] = deviation(i).value(x);
        }
        row[2 * D] = DENSITY.value(x);
        row[2 * D + 1] = PRESSURE.value(x);
    });
    change_matter(&scheme, &mut state, |number, row| {
        let x = &positions[number];
        row.iter_mut().enumerate().for_each(|(k, value)| *value = matter(k).value(x));
    });
    let terms = scheme.terms(0.0, &state);
    let solid = scheme.solid_rates();
    let all = positions.into_iter().zip(terms).zip(solid);
    all.map(|((x, (rates, forces)), solid)| Found { x, rates, solid, forces }).collect()
}

/// Numbers of a particle as they are found and as they should be.
type Pairs<'a, const D: usize> = &'a dyn Fn(&Found<D>) -> Vec<(f64, f64)>;

/// Relative error over all particles of several numbers each.
fn error<const D: usize>(found: &[Found<D>], pair: Pairs<'_, D>) -> f64 {
    let (mut off, mut size) = (0.0, 0.0);
    for (got, expected) in found.iter().flat_map(pair) {
        off += (got - expected).powi(2);
        size += expected.powi(2);
    }
    (off / size).sqrt()
}

/// Second order on lattices, and small on disordered ones: the bounds of the terms of fluids,
/// with the same kernel and fields.
fn second_order<const D: usize>(solid: Solid, corrected: bool) {
    let fine = if D == 3 { 20 } else { 32 };
    let lattices = [(fine / 2, 0.0), (fine, 0.0), (fine, 0.1)]
        .map(|(side, jitter)| terms::<D>(side, jitter, solid, corrected));
    let carried = |f: &Found<D>, field: Field| -> f64 {
        (0..D).map(|j| deviation(j).value(&f.x) * field.slope(&f.x, j)).sum()
    };
    let gradient = |f: &Found<D>| {
        let pairs = (0..D).flat_map(|i| (0..D).map(move |j| (i, j)));
        pairs.map(|(i, j)| (f.solid.gradient[(i, j)], velocity(i).slope(&f.x, j))).collect()
    };
    // What is elastic carries its stress alone, and its pressure follows the density.
    let is_elastic = solid.strength == Strength::Elastic;
    let is_carried = |k: &usize| !((is_elastic && *k >= 6) || (D == 2 && (*k == 3 || *k == 4)));
    let transport = |f: &Found<D>| {
        let carried = |k: usize| (f.solid.transport[k], carried(f, matter(k)));
        (0..9).filter(is_carried).map(carried).collect::<Vec<_>>()
    };
    for found in lattices.iter().flatten() {
        let others = (0..9).filter(|k| !is_carried(k)).map(|k| found.solid.transport[k]);
        assert!(others.into_iter().all(|rate| rate == 0.0), "{:?}", found.solid.transport);
        assert!(!is_elastic || found.rates.pressure_transport == 0.0);
    }
    let force = |f: &Found<D>| {
        (0..D)
            .map(|i| {
                let stress: f64 = (0..D).map(|j| matter(entry(i, j)).slope(&f.x, j)).sum();
                let total = (stress - PRESSURE.slope(&f.x, i)) / DENSITY.value(&f.x);
                (f.forces.pressure[i], total)
            })
            .collect()
    };
    let divergence =
        |f: &Found<D>| vec![(f.rates.divergence, (0..D).map(|i| velocity(i).slope(&f.x, i)).sum())];
    let density = |f: &Found<D>| vec![(f.solid.density_transport, carried(f, DENSITY))];
    let pressure = |f: &Found<D>| vec![(f.rates.pressure_transport, carried(f, PRESSURE))];
    let checks: [(&str, Pairs<'_, D>); 6] = [
        ("grad u", &gradient),
        ("d . grad matter", &transport),
        ("div sigma / rho", &force),
        ("div u", &divergence),
        ("d . grad rho", &density),
        ("d . grad p", &pressure),
    ];
    let (largest, disorder, order) = if D == 3 { (0.25, 0.3, 2.5) } else { (0.1, 0.2, 3.2) };
    for (what, check) in checks.into_iter().take(if is_elastic { 5 } else { 6 }) {
        let [coarse, fine, disordered] = [0, 1, 2].map(|k: usize| error(&lattices[k], check));
        println!("{what} in {D}D, corrected {corrected}: {coarse:.4} {fine:.4} {disordered:.4}");
        assert!(fine < largest, "{what} in {D}D: {fine}");
        assert!((order..4.6).contains(&(coarse / fine)), "{what} in {D}D: {coarse} to {fine}");
        // Sums of pairs of stresses do not vanish for constants where particles are out of order.
        let disorder = if what.starts_with("div sigma") { 0.3 } else { disorder };
        assert!(disordered < disorder, "{what} in {D}D: {disordered}");
    }
}

#[test]
fn every_term_of_solids_has_its_sign_and_order_in_2d() {
    second_order::<2>(SOLID, false);
    second_order::<2>(SOLID, true);
    second_order::<2>(DUCTILE, false);
    second_order::<2>(DUCTILE, true);
}

#[test]
fn every_term_of_solids_has_its_sign_and_order_in_3d() {
    second_order::<3>(SOLID, false);
    second_order::<3>(DUCTILE, true);
}

/// A block of the unit box in open space around it, in two bodies left and right of the middle, with
/// values at random.
fn two_blocks<const D: usize>(
    contact: Contact,
    corrected: bool,
    artificial_viscosity: f64,
) -> (Solids<D>, Vec<f64>, usize) {
    let settings =
        Settings { artificial_viscosity, free_surface: true, shifting: Shifting::None, ..SETTINGS };
    two_blocks_with(contact, corrected, settings)
}

pub fn two_blocks_with<const D: usize>(
    contact: Contact,
    corrected: bool,
    settings: Settings,
) -> (Solids<D>, Vec<f64>, usize) {
    let mut particles = unit_box::<D>(if D == 3 { 8 } else { 16 }, 0.1, 7);
    for position in &mut particles.position {
        *position *= 0.5;
    }
    for a in 0..particles.len() {
        particles.volume[a] *= 0.5_f64.powi(D as i32);
        particles.spacing[a] *= 0.5;
        particles.body[a] = u32::from(particles.position[a][0] > 0.25);
    }
    let count = particles.len();
    let scheme = build(SOLID, particles, settings, contact, corrected);
    let mut state = scheme.initial_state();
    // Any numbers that are no function of place.
    let noise = |k: usize| (k as f64 * 12.9898).sin();
    change_rows(&scheme, &mut state, |number, row| {
        row[..D].iter_mut().enumerate().for_each(|(i, u)| *u = noise(7 * number + i));
        row[2 * D] *= 1.0 + 0.02 * noise(3 * number);
        row[2 * D + 1] = 5.0 * noise(5 * number + 1);
    });
    change_matter(&scheme, &mut state, |number, row| {
        (0..6).for_each(|k| row[k] = 4.0 * noise(11 * number + k));
    });
    (scheme, state, count)
}

fn momentum_and_power<const D: usize>(contact: Contact, corrected: bool) {
    let (mut scheme, state, count) = two_blocks::<D>(contact, corrected, 0.7);
    let terms = scheme.terms(0.0, &state);
    let numbers: Vec<u32> = (0..count as u32).collect();
    let masses = Observation::new(&mut scheme, 0.0, &state).values("mass", &numbers);
    let (mut total, mut size) = (Vector::<D>::zeros(), 0.0);
    for ((_, forces), mass) in terms.iter().zip(&masses) {
        let force = (forces.pressure + forces.artificial_viscosity) * *mass;
        total += force;
        size += force.norm();
    }
    assert!(total.norm() < 1e-13 * size, "{contact:?} in {D}D: {total} of {size}");
    assert!(terms.iter().any(|(_, forces)| forces.artificial_viscosity.norm() > 0.0));
}

#[test]
fn forces_of_solids_come_in_pairs() {
    let contacts = [Contact::Repulsive, Contact::Full, Contact::Penalty { stiffness: 1.0 }];
    for contact in contacts {
        for corrected in [false, true] {
            momentum_and_power::<2>(contact, corrected);
            momentum_and_power::<3>(contact, corrected);
        }
    }
}

/// The corrected momentum equation is conjugate to the corrected gradient: without viscosity the
/// power of the forces is what the stresses take, `sum m a . u = - sum V sigma : L`, to round-off.
fn conjugate<const D: usize>() {
    let (mut scheme, state, count) = two_blocks::<D>(Contact::Full, true, 0.0);
    let terms = scheme.terms(0.0, &state);
    let rates = scheme.solid_rates();
    let numbers: Vec<u32> = (0..count as u32).collect();
    let mut sampled =
        |name: &str| Observation::new(&mut scheme, 0.0, &state).values(name, &numbers);
    let (masses, stresses) = (sampled("mass"), sampled("cauchy_stress"));
    let (mut power, mut taken, mut size) = (0.0, 0.0, 0.0);
    for (number, row) in rows(&scheme, &state).iter().enumerate() {
        let acceleration = terms[number].1.pressure;
        let mine: f64 = (0..D).map(|i| masses[number] * acceleration[i] * row[i]).sum();
        let volume = masses[number] / row[2 * D];
        let own: f64 = (0..D * D)
            .map(|k| volume * stresses[number * D * D + k] * rates[number].gradient[(k / D, k % D)])
            .sum();
        power += mine;
        taken += own;
        size += mine.abs() + own.abs();
    }
    assert!((power + taken).abs() < 1e-13 * size, "{power} and {taken} of {size}");
}

#[test]
fn corrected_forces_are_conjugate_to_corrected_gradients() {
    conjugate::<2>();
    conjugate::<3>();
}

#[test]
fn corrected_gradients_are_exact_for_linear_fields() {
    let (mut scheme, mut state, _) = two_blocks::<2>(Contact::Repulsive, true, 0.0);
    let gradient = [[0.3, -0.7], [1.1, 0.4]];
    change_rows(&scheme, &mut state, |_, row| {
        let (x, y) = (row[2], row[3]);
        row[0] = gradient[0][0] * x + gradient[0][1] * y;
        row[1] = gradient[1][0] * x + gradient[1][1] * y;
    });
    scheme.terms(0.0, &state);
    // At the faces of each of the bodies too, whatever the other one does.
    for rates in scheme.solid_rates() {
        let expected = Tensor::<2>::from_fn(|i, j| gradient[i][j]);
        assert!((rates.gradient - expected).norm() < 1e-12, "{}", rates.gradient);
    }
}

#[test]
fn bodies_push_and_never_pull() {
    for contact in [Contact::Repulsive, Contact::Penalty { stiffness: 1.0 }] {
        let (mut scheme, mut state, count) = two_blocks::<2>(contact, false, 0.0);
        change_matter(&scheme, &mut state, |_, row| row.fill(0.0));
        // Tension in both: each pulls itself together, and none the other.
        let mut force_on_the_left = |pressure: f64| {
            change_rows(&scheme, &mut state, |_, row| row[5] = pressure);
            let terms = scheme.terms(0.0, &state);
            let numbers: Vec<u32> = (0..count as u32).collect();
            let masses = Observation::new(&mut scheme, 0.0, &state).values("mass", &numbers);
            let left = (0..count).filter(|&a| scheme.bodies()[a] == 0);
            left.map(|a| terms[a].1.pressure[0] * masses[a]).sum::<f64>()
        };
        let (pulled, pushed) = (force_on_the_left(-5.0), force_on_the_left(5.0));
        match contact {
            Contact::Repulsive => {
                assert!(pulled.abs() < 1e-12, "{pulled}");
                // The pressure times the height of the face, less what is lost at its ends.
                assert!((-5.0 * 0.5..-5.0 * 0.3).contains(&pushed), "{pushed}");
            }
            _ => assert!(pulled <= 0.0 && (pulled - pushed).abs() < 1e-12, "{pulled} {pushed}"),
        }
    }
}
