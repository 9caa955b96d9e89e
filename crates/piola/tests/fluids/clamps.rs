//! Walls that bear the stress of solids, CTVF (53), theory (72): a block of uniform stress between two
//! platens.

use piola::Vector;
use piola::geometry::{Faces, Particles};
use piola::neighbors::Domain;
use piola::schemes::transport_velocity::{Forces, Slip, SolidsInput, TransportVelocityInput, Wall};
use piola::schemes::{Initial, Observation, Scheme};

use super::solids::{SETTINGS, SOLID};
use super::support::{Solids, change_matter, solids_in_box, unit_box};

const SIDE: usize = 16;
/// Layers of each platen, as many as the support of the kernel reaches.
const LAYERS: f64 = 3.0;

/// Numbers of the stress: pressure, then s as xx, yy, zz, yz, xz, xy, in Pa.
type Stress = (f64, [f64; 6]);

/// A block, periodic along x, between platens below and above; with the forces of a uniform stress and
/// the masses.
fn between_platens(
    slip: Slip,
    stress: Stress,
    corrected: bool,
) -> (Particles<2>, Vec<(Forces<2>, f64)>) {
    let mut particles = unit_box::<2>(SIDE, 0.0, 1);
    let thick = LAYERS / SIDE as f64;
    let mut faces = Vec::new();
    for (body, position) in particles.body.iter_mut().zip(&particles.position) {
        let (below, above) = (position[1] < thick, position[1] > 1.0 - thick);
        *body = u32::from(below || above);
        let normal = Vector::<2>::new(0.0, if below { 1.0 } else { -1.0 });
        let depth = thick - position[1].min(1.0 - position[1]);
        let is_clamp = *body == 1;
        faces.push(if is_clamp { Faces::new(vec![normal], depth) } else { Faces::default() });
    }
    let (kept, count) = (particles.clone(), particles.len());
    let (pressure, deviator) = stress;
    let (input, solids) = solids_in_box(particles, SETTINGS, vec![SOLID; 2]);
    let h = kept.spacing[0];
    let of_block = kept.body.iter().map(|body| if *body == 0 { pressure } else { 0.0 });
    let input = TransportVelocityInput {
        smoothing_length: h,
        faces,
        domain: Domain::new([Some([0.0, 1.0]), None]).expect("the bounds are in order"),
        walls: vec![Wall { body: 1, slip }],
        initial: Initial { pressure: of_block.collect(), ..input.initial },
        ..input
    };
    let solids = SolidsInput { corrected, ..solids };
    let mut scheme = Solids::new(input, solids).expect("the block can be built");
    let mut state = scheme.initial_state();
    change_matter(&scheme, &mut state, |number, row| {
        if kept.body[number] == 0 {
            row[..6].copy_from_slice(&deviator);
        }
    });
    let terms = scheme.terms(0.0, &state);
    let numbers: Vec<u32> = (0..count as u32).collect();
    let masses = Observation::new(&mut scheme, 0.0, &state).values("mass", &numbers);
    (kept, terms.into_iter().map(|(_, forces)| forces).zip(masses).collect())
}

const PRESSED: Stress = (7e-3, [1e-3, -3e-3, 2e-3, 0.0, 0.0, 0.0]);
const SHEARED: Stress = (7e-3, [1e-3, -3e-3, 2e-3, 0.0, 0.0, 4e-3]);

/// What a particle of the block is pushed with in all, against the largest push from walls.
fn unbalanced(slip: Slip, stress: Stress, corrected: bool) -> f64 {
    let (particles, forces) = between_platens(slip, stress, corrected);
    let of_block = || forces.iter().zip(&particles.body).filter(|(_, body)| **body == 0);
    let most = |size: &dyn Fn(&Forces<2>) -> f64| {
        of_block().map(|((forces, _), _)| size(forces)).fold(0.0, f64::max)
    };
    most(&|forces| forces.total().norm()) / most(&|forces| forces.walls.norm())
}

#[test]
fn a_block_in_uniform_stress_is_at_rest_between_platens() {
    for (slip, stress) in [(Slip::No, PRESSED), (Slip::Free, PRESSED), (Slip::No, SHEARED)] {
        let plain = unbalanced(slip, stress, false);
        assert!(plain < 1e-13, "{slip:?}: {plain:e}");
        // Sums over a whole lattice are exact to half a percent, and walls are not corrected.
        let corrected = unbalanced(slip, stress, true);
        assert!(corrected < 0.01, "{slip:?}, corrected: {corrected}");
    }
    // A platen that lets slide does not hold a shear stress.
    assert!(unbalanced(Slip::Free, SHEARED, false) > 0.1);
}

#[test]
fn platens_bear_the_stress_and_no_shear_where_they_let_slide() {
    for (slip, stress) in [(Slip::No, SHEARED), (Slip::Free, SHEARED)] {
        let (particles, forces) = between_platens(slip, stress, false);
        let upper = |a: &usize| particles.body[*a] == 1 && particles.position[*a][1] > 0.5;
        let of_upper = (0..forces.len()).filter(upper);
        let force: Vector<2> = of_upper.map(|a| forces[a].0.walls * forces[a].1).sum();
        // Of a width of 1 m: the block pulls with sigma . n, n towards it.
        let (pressure, deviator) = stress;
        let (shear, normal) = (-deviator[5], -(deviator[1] - pressure));
        assert!((force[1] / normal - 1.0).abs() < 0.01, "{slip:?}: {} for {normal} N", force[1]);
        match slip {
            Slip::No => assert!((force[0] / shear - 1.0).abs() < 0.01, "{} for {shear}", force[0]),
            Slip::Free => assert!(force[0].abs() < 1e-13 * normal, "{} N", force[0]),
        }
    }
}
