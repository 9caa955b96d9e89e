//! Which particles are found on free surfaces, CTVF section 3.4.

use std::f64::consts::PI;

use piola::Vector;
use piola::boundaries::BodyForce;
use piola::geometry::{Faces, Particles};
use piola::neighbors::Domain;
use piola::schemes::transport_velocity::{
    DensityRule, Fluid, Gradients, Settings, Shifting, TransportVelocity, TransportVelocityInput,
};
use piola::schemes::{Initial, Ledger, Observation, Scheme};
use piola_formulas::kernels::Kernel;

use super::fields::{Counted, fields_are_complete};
use super::support::{SETTINGS, change_rows, rows, run, session, values};

const SPACING: f64 = 0.1;

/// A fluid at rest in open space.
fn at_rest<const D: usize>(positions: Vec<Vector<D>>) -> TransportVelocity<D> {
    under(positions, Vec::new())
}

fn under<const D: usize>(
    positions: Vec<Vector<D>>,
    body_forces: Vec<BodyForce<D>>,
) -> TransportVelocity<D> {
    of_kernel((Kernel::QuinticSpline, 1.0), SETTINGS, positions, body_forces)
}

/// With a kernel and its smoothing length in spacings.
fn of_kernel<const D: usize>(
    (kernel, width): (Kernel, f64),
    settings: Settings,
    positions: Vec<Vector<D>>,
    body_forces: Vec<BodyForce<D>>,
) -> TransportVelocity<D> {
    let count = positions.len();
    let particles = Particles {
        position: positions,
        volume: vec![SPACING.powi(D as i32); count],
        weight: vec![SPACING.powi(D as i32); count],
        spacing: vec![SPACING; count],
        body: vec![0; count],
        id: (0..count as u32).collect(),
        ..Particles::default()
    };
    let fluid = Fluid { density: 1000.0, wave_speed: 10.0, viscosity: 0.0 };
    let input = TransportVelocityInput {
        particles,
        domain: Domain::open(),
        kernel,
        smoothing_length: width * SPACING,
        settings: Settings { free_surface: true, ..settings },
        initial: Initial { velocity: vec![Vector::zeros(); count], pressure: vec![0.0; count] },
        walls: Vec::new(),
        faces: vec![Faces::default(); count],
        motion: Vec::new(),
        sliding: Vec::new(),
        body_forces,
        open: Default::default(),
        damping: None,
    };
    TransportVelocity::new(input, fluid).expect("the fluid can be built")
}

fn sample<const D: usize>(positions: Vec<Vector<D>>, field: &str) -> Vec<f64> {
    let all: Vec<u32> = (0..positions.len() as u32).collect();
    let mut scheme = at_rest(positions);
    let state = scheme.initial_state();
    Observation::new(&mut scheme, 0.0, &state).values(field, &all)
}

#[test]
fn every_described_field_has_values() {
    let counted = Counted::default();
    let mut scheme = under(block::<2>(9), vec![counted.force()]);
    let state = scheme.initial_state();
    fields_are_complete(&mut scheme, &state, &counted);
}

fn is_found<const D: usize>(positions: &[Vector<D>]) -> Vec<bool> {
    sample(positions.to_vec(), "surface").iter().map(|&found| found == 1.0).collect()
}

fn block<const D: usize>(side: usize) -> Vec<Vector<D>> {
    let axis = |number: usize, axis: u32| (number / side.pow(axis) % side) as f64 * SPACING;
    (0..side.pow(D as u32)).map(|n| Vector::from_fn(|k, _| axis(n, k as u32))).collect()
}

/// Concentric rings between two radii, one spacing apart.
fn rings(inner: usize, outer: usize) -> Vec<Vector<2>> {
    let mut positions = Vec::new();
    for ring in inner..=outer {
        let count = (2.0 * PI * ring as f64).round() as usize;
        for k in 0..count {
            let angle = 2.0 * PI * k as f64 / count as f64;
            let radius = ring as f64 * SPACING;
            positions.push(Vector::<2>::new(radius * angle.cos(), radius * angle.sin()));
        }
    }
    positions
}

#[test]
fn the_faces_of_a_square_and_of_a_cube_are_found() {
    let on_face = |coordinate: f64, side: usize| {
        coordinate < 0.5 * SPACING || coordinate > (side as f64 - 1.5) * SPACING
    };
    let square = block::<2>(20);
    for (x, found) in square.iter().zip(is_found(&square)) {
        assert_eq!(found, x.iter().any(|&c| on_face(c, 20)), "{x:?}");
    }
    let cube = block::<3>(11);
    for (x, found) in cube.iter().zip(is_found(&cube)) {
        assert_eq!(found, x.iter().any(|&c| on_face(c, 11)), "{x:?}");
    }
}

#[test]
fn the_inner_and_the_outer_ring_are_found() {
    let positions = rings(10, 20);
    for (x, found) in positions.iter().zip(is_found(&positions)) {
        let ring = (x.norm() / SPACING).round() as usize;
        assert_eq!(found, ring == 10 || ring == 20, "{x:?}");
    }
}

/// Concentric spheres between two radii, one spacing apart, each with its points on a spiral: as many
/// as squares of the spacing cover it.
fn spheres(inner: usize, outer: usize) -> Vec<Vector<3>> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let mut positions = Vec::new();
    for sphere in inner..=outer {
        let count = (4.0 * PI * (sphere * sphere) as f64).round();
        for k in 0..count as usize {
            let z = 1.0 - (2 * k + 1) as f64 / count;
            let (across, angle) = ((1.0 - z * z).sqrt(), golden * k as f64);
            let direction = Vector::<3>::new(across * angle.cos(), across * angle.sin(), z);
            positions.push(direction * (sphere as f64 * SPACING));
        }
    }
    positions
}

#[test]
fn the_outside_of_a_ball_and_both_sides_of_a_hollow_one_are_found() {
    for inner in [1, 6] {
        let positions = spheres(inner, 11);
        for (x, found) in positions.iter().zip(is_found(&positions)) {
            let sphere = (x.norm() / SPACING).round() as usize;
            assert_eq!(found, sphere == 11 || sphere == 6 && inner == 6, "{x:?}");
        }
    }
}

#[test]
fn normals_point_out_of_the_fluid() {
    let positions = rings(10, 20);
    let normals = sample(positions.clone(), "surface_normal");
    for (x, normal) in positions.iter().zip(normals.chunks_exact(2)) {
        let ring = (x.norm() / SPACING).round() as usize;
        let outward = Vector::<2>::new(normal[0], normal[1]).dot(x) / x.norm();
        if ring == 10 || ring == 20 {
            let expected = if ring == 20 { 1.0 } else { -1.0 };
            assert!((outward - expected).abs() < 0.01, "{outward} at {x:?}");
        }
    }
}

#[test]
fn a_particle_alone_is_its_own_surface() {
    let mut positions = block::<2>(8);
    positions.push(Vector::<2>::new(3.0, 3.0));
    assert_eq!(is_found(&positions).last(), Some(&true));
}

#[test]
fn the_block_at_rest_is_not_shifted_at_its_surface() {
    // A speed somewhere makes the deviation of SPST work; on the surface there must be none.
    let positions = block::<2>(16);
    let mut scheme = at_rest(positions);
    let mut state = scheme.initial_state();
    change_rows(&scheme, &mut state, |_, row| row[0] = 1.0);
    let split = scheme.split().expect("it can be split");
    split.accelerate(0.0, &mut state);
    for row in rows(&scheme, &state) {
        let on = |x: f64| !(0.5 * SPACING..14.5 * SPACING).contains(&x);
        let deviation = row[8].hypot(row[9]);
        assert!(deviation < 1e-12 || !(on(row[2]) || on(row[3])), "{row:?}");
    }
}

/// Pressures in Pa, and the energy of compression over what is booked of relaxation, after a step of a block at rest whose
/// particles are `closer` together than their density says.
fn relaxed<const D: usize>(
    (side, closer, kernel): (usize, f64, (Kernel, f64)),
    settings: Settings,
) -> (Vec<(Vector<D>, f64)>, f64) {
    let positions: Vec<_> = block::<D>(side).into_iter().map(|x| x * closer).collect();
    let mut scheme = of_kernel(kernel, settings, positions.clone(), Vec::new());
    let mut state = scheme.initial_state();
    scheme.split().expect("it can be split").drift(0.0, STEP, &mut state);
    let mut energies = [0.0; 3];
    scheme.energies(&state, &mut energies);
    let (work, accounts) = (Ledger::of(&scheme, &state).work, scheme.description().ledger);
    let place = accounts.mechanisms.iter().position(|it| *it == "density_relaxation");
    let booked = work[place.expect("it has a row")] / energies.iter().sum::<f64>();
    let rows = rows(&scheme, &state).into_iter().map(|row| {
        let [density, pressure] = [row[2 * D], row[2 * D + 1]];
        let follows = (density - 1000.0 - pressure / 100.0).abs() < 1e-9;
        assert!(follows || settings.density == DensityRule::Summation, "{row:?}");
        pressure
    });
    (positions.into_iter().zip(rows).collect(), booked)
}

const STEP: f64 = 1e-3;
const RELAXING: Settings =
    Settings { density: DensityRule::Continuity, density_relaxation: 0.02, ..SETTINGS };

/// Particles of a block that are 2 % closer together than their density says, theory (108): inside the density rises at
/// the rate of what it lacks, where a surface is within the support it does not, and all work is booked.
fn check_relaxation<const D: usize>(side: usize) {
    let closer = 0.98;
    let kernel = (Kernel::QuinticSpline, 1.0);
    let (pressures, booked) = relaxed::<D>((side, closer, kernel), RELAXING);
    assert!((booked - 1.0).abs() < 1e-12, "{booked}");
    let lacks = 1000.0 * (closer.powi(-(D as i32)) - 1.0);
    let gain = STEP * 0.02 * 1000.0 / SPACING * lacks;
    // The lattice sums of the kernel at the two spacings differ by less than 2e-4.
    let bound = 2e-4 * 1000.0 / lacks * gain;
    let depth = |x: f64| x.min((side - 1) as f64 * SPACING * closer - x);
    let mut inside = 0;
    for (x, pressure) in pressures {
        let is_inside = x.iter().all(|&x| depth(x) > 3.0 * SPACING);
        inside += usize::from(is_inside);
        match is_inside {
            true => assert!((pressure - gain).abs() <= bound, "{x:?}: {pressure} for {gain} Pa"),
            false => assert_eq!(pressure, 0.0, "{x:?}"),
        }
    }
    assert_eq!(inside, (side - 8).pow(D as u32));
}

#[test]
fn the_density_relaxes_to_that_of_the_places() {
    check_relaxation::<2>(20);
    check_relaxation::<3>(11);
}

/// Corrected gradients, theory (113): on and just below a surface the density relaxes, too, but only where it is too small
/// for the places, in spite of the neighbours that the sum lacks there. With a kernel sum of its own.
fn check_relaxation_at_surfaces<const D: usize>(side: usize) {
    let gradients = Gradients::Corrected { velocity_diffusion: 0.0 };
    let settings = Settings { gradients, ..RELAXING };
    let kernel = (Kernel::QuinticSpline, 1.0);
    let (pressures, booked) = relaxed::<D>((side, 0.98, kernel), settings);
    assert!((booked - 1.0).abs() < 1e-12, "{booked}");
    let kernel = |x: Vector<D>| Kernel::QuinticSpline.value(D, x.norm(), SPACING);
    // Over a lattice without end: the middle of a block that is wider than the support.
    let middle = Vector::from_element(4.0 * SPACING);
    let lattice: f64 = block::<D>(9).into_iter().map(|x| kernel(x - middle)).sum();
    let (mut raised, mut lacking) = (0, 0);
    for (x, pressure) in &pressures {
        let sum: f64 = pressures.iter().map(|(y, _)| kernel(x - y)).sum();
        let excess = 1000.0 * (sum / lattice - 1.0);
        let gain = STEP * 0.02 * 1000.0 / SPACING * excess.max(0.0);
        assert!((pressure - gain).abs() < 1e-9, "{x:?}: {pressure} for {gain} Pa");
        let inside = |&x: &f64| x.min((side - 1) as f64 * SPACING * 0.98 - x) > 3.0 * SPACING;
        raised += usize::from(excess > 0.0 && !x.iter().all(inside));
        lacking += usize::from(excess < 0.0);
    }
    // Only the three layers behind the first one, which lacks too much, can be raised.
    let outer = |layers: usize| side.pow(D as u32) - (side - 2 * layers).pow(D as u32);
    assert!(raised > 0 && raised <= outer(4) - outer(1), "{raised}");
    assert!(lacking >= outer(1), "{lacking}");
}

#[test]
fn just_below_a_surface_the_density_relaxes_upwards_only() {
    check_relaxation_at_surfaces::<2>(20);
    check_relaxation_at_surfaces::<3>(11);
}

/// A kernel with few neighbours sums to 1.018 over a square lattice, which is no excess.
#[test]
fn an_even_block_has_no_excess_whatever_the_kernel() {
    let block = (20, 1.0, (Kernel::WendlandC2, 1.2));
    let (pressures, _) = relaxed::<2>(block, RELAXING);
    assert!(pressures.iter().all(|(_, pressure)| pressure.abs() < 1e-9), "{pressures:?}");
}

#[test]
fn the_density_relaxes_only_where_it_is_to() {
    let block = (16, 0.98, (Kernel::QuinticSpline, 1.0));
    for settings in [
        Settings { density_relaxation: 0.0, ..RELAXING },
        Settings { density: DensityRule::Summation, ..RELAXING },
        Settings { shifting: Shifting::None, ..RELAXING },
    ] {
        let (pressures, _) = relaxed::<2>(block, settings);
        assert!(pressures.iter().all(|(_, pressure)| *pressure == 0.0), "{settings:?}");
    }
}

/// Water under a pressure on a floor, with a free surface far above.
const PRESSED: &str = r#"
version = 1
title = "Water on a floor, under pressure"
dimension = 2
[domain]
periodic = { x = [0.0, 0.5] }
[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0], max = [0.5, 1.0] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 10.0 }
initial = { pressure = "20" }
[[body]]
name = "floor"
shape = { kind = "box", min = [0.0, -0.2], max = [0.5, 0.0] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 10.0 }
wall = {}
[scheme]
kind = "transport_velocity"
free_surface = true
[time]
end = 1.0
"#;

/// A wall fills its lattice at any density: fluid that stands on the lattice which goes on in the floor neither moves nor
/// has an excess, theory (108), next to the floor as anywhere, and the floor bears the pressure. With masses at rest the
/// forces of the floor would be too small by `p/(rho c^2)`, 2 and 17 % here.
///
/// The sums of a particle cancel on the lattice, up to round-off. The floor bears `-sum_b V_b r_ab . grad W_ab / D` of the
/// pressure, which is 1 for an integral: within 1 % for sums over a support of three spacings of a smooth kernel.
#[test]
fn water_under_pressure_stands_on_a_floor() {
    for pressure in [2e3, 2e4] {
        let set = [format!("body.water.initial.pressure='{pressure}'")];
        let mut session =
            session(PRESSED, &[set[0].as_str()]).unwrap_or_else(|error| panic!("{error}"));
        let mut column = |name| session.column(name).expect("it is there").values;
        let [places, forces, accelerations] =
            ["position", "force", "acceleration"].map(&mut column);
        let floor = places.chunks_exact(2).zip(forces.chunks_exact(2));
        let floor: f64 = floor.filter(|(place, _)| place[1] < 0.0).map(|(_, force)| force[1]).sum();
        assert!((floor / (-0.5 * pressure) - 1.0).abs() < 0.01, "{pressure} Pa: {floor} N/m");
        let below = |place: &[f64]| (0.0..0.6).contains(&place[1]);
        let still = places.chunks_exact(2).zip(accelerations.chunks_exact(2));
        let still: Vec<_> = still.filter(|(place, _)| below(place)).collect();
        assert_eq!(still.len(), 120);
        for (place, acceleration) in still {
            let size = acceleration[0].hypot(acceleration[1]);
            assert!(
                size < 1e-12 * pressure / (1000.0 * 0.05),
                "{pressure} Pa: {size} m/s2 at {place:?}"
            );
        }
        session.step().expect("it can be made");
        let mut column = |name| session.column(name).expect("it is there").values;
        let [places, excess] = ["position", "excess"].map(&mut column);
        // What comes from the surface in a step gets a third of a spacing far.
        for (place, excess) in places.chunks_exact(2).zip(excess).filter(|(place, _)| below(place))
        {
            assert!(excess.abs() < 1e-12 * 1000.0, "{pressure} Pa: {excess} kg/m3 at {place:?}");
        }
    }
}

/// A square of water that turns in open space.
const TURNING: &str = r#"
version = 1
title = "A square of water turns"
dimension = 2
[[body]]
name = "water"
shape = { kind = "box", min = [-0.5, -0.5], max = [0.5, 0.5] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 20.0, viscosity = 0.01 }
initial = { velocity = ["-2*y", "2*x"] }
[scheme]
kind = "transport_velocity"
free_surface = true
artificial_viscosity = 0.1
[time]
end = 0.3
[output]
every = 0.3
table_every = 0.02
"#;

/// What acts on a particle comes in pairs or is booked. Corrected pressures do not act along the line between two
/// particles, theory (110), and are not booked: only they leave angular momentum over.
#[test]
fn the_momentum_of_a_square_that_turns_balances() {
    for (gradients, components) in
        [(false, &["linear.x", "linear.y", "angular.z"][..]), (true, &["linear.x", "linear.y"])]
    {
        let finished = run(TURNING, &[&format!("scheme.corrected_gradients={gradients}")]);
        let largest =
            |name: &str| values(&finished, name).iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let whole = largest("momentum.angular.z");
        // rho omega / 6 for each metre of length.
        assert!((whole / (2000.0 / 6.0) - 1.0).abs() < 0.01, "{whole}");
        for component in components {
            let balance = largest(&format!("momentum.balance.{component}"));
            assert!(balance < 1e-12 * whole, "{gradients}, {component}: {balance:e}");
        }
    }
}
