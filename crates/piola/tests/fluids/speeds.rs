//! The speed that shifting takes for that of a solid.

use piola::Vector;
use piola::schemes::Scheme;
use piola::schemes::transport_velocity::{PressureRule, Settings, Shifting};

use super::solids::{SETTINGS, SOLID};
use super::support::{self, Solids, change_matter, change_rows, solids_in_box, unit_box};

/// In m/s, a twentieth of the wave speed.
const SPEED: f64 = 0.5;
const STEP: f64 = 1e-3;

/// What a particle has, each in units of what has the energy of [`SPEED`].
#[derive(Clone, Copy, Default)]
struct Has {
    velocity: f64,
    pressure: f64,
    shear: f64,
}

const SPST: Shifting = Shifting::Sun { factor: 1.0 };
const IPST: Shifting = Shifting::Iterative { tolerance: 1e-9, most_passes: 1 };

/// The deviations of a disordered block at rest, some of whose particles have something.
fn deviations<const D: usize>(shifting: Shifting, some: &[(usize, Has)]) -> Vec<Vector<D>> {
    // The pressure is integrated, so that it is there without a density that changes volumes.
    let pressure = PressureRule::Edac { alpha: 0.0 };
    let side = if D == 3 { 8 } else { 12 };
    let settings = Settings { shifting, pressure, ..SETTINGS };
    let (input, solids) = solids_in_box(unit_box::<D>(side, 0.2, 5), settings, vec![SOLID]);
    let mut scheme = Solids::new(input, solids).expect("the solid can be built");
    let mut state = scheme.initial_state();
    let (density, wave_speed) = (SOLID.state.density, SOLID.state.wave_speed);
    for (number, has) in some {
        change_rows(&scheme, &mut state, |other, row| {
            if other == *number {
                row[D - 1] = SPEED * has.velocity;
                row[2 * D + 1] = -density * wave_speed * SPEED * has.pressure;
            }
        });
        // s : s = 2 G rho u^2, half of it by two normal components and half by shear.
        let stress = has.shear * SPEED * (2.0 * SOLID.shear_modulus * density).sqrt();
        change_matter(&scheme, &mut state, |other, row| {
            if other == *number {
                (row[0], row[2], row[5]) = (0.5 * stress, -0.5 * stress, 0.5 * stress);
            }
        });
    }
    let split = scheme.split().expect("it can be split");
    match shifting {
        Shifting::Sun { .. } => split.accelerate(0.0, &mut state),
        _ => split.drift(0.0, STEP, &mut state),
    }
    support::deviations(&scheme, &state)
}

/// The deviations of particles 100 on.
fn far<const D: usize>(shifting: Shifting, some: &[(usize, Has)]) -> Vec<Vector<D>> {
    deviations(shifting, some).split_off(100)
}

fn energy_counts_however_it_is_held<const D: usize>(shifting: Shifting) {
    let (all, none) = (Has { velocity: 1.0, ..Has::default() }, Has::default());
    let by_velocity = far::<D>(shifting, &[(7, all)]);
    let size = |found: &[Vector<D>]| found.iter().map(|d| d.norm()).fold(0.0, f64::max);
    assert!(size(&by_velocity) > 1e-3 * SPEED, "{}", size(&by_velocity));
    assert_eq!(size(&far::<D>(shifting, &[(7, none)])), 0.0);
    let others: [&[(usize, Has)]; 4] = [
        &[(7, Has { pressure: 1.0, ..none })],
        &[(7, Has { shear: 1.0, ..none })],
        &[(7, Has { velocity: 0.48, pressure: 0.6, shear: 0.64 })],
        // The particle that has most of it, not their sum.
        &[(7, Has { shear: -1.0, ..none }), (8, Has { velocity: 0.9, ..none })],
    ];
    for (k, some) in others.into_iter().enumerate() {
        let found = far::<D>(shifting, some);
        let apart: Vec<_> = found.iter().zip(&by_velocity).map(|(one, two)| one - two).collect();
        assert!(size(&apart) < 1e-12 * size(&by_velocity), "{k}: {:e}", size(&apart));
    }
}

#[test]
fn a_solid_is_shifted_as_fast_as_all_of_its_energy_would_move_it() {
    for shifting in [SPST, IPST] {
        energy_counts_however_it_is_held::<2>(shifting);
        energy_counts_however_it_is_held::<3>(shifting);
    }
}
