//! Bodies that touch themselves.

use piola::Vector;
use piola::geometry::Particles;
use piola::schemes::Scheme;
use piola::schemes::transport_velocity::{
    Contact, Forces, Settings, Shifting, SolidsInput, TransportVelocityError,
    TransportVelocityInput,
};

use super::solids::{SETTINGS, SOLID};
use super::support::{Solids, change_matter, change_rows, solids_in_box, unit_box};

const SIDE: usize = 20;
const CUT: f64 = 0.5;
/// How far the part beyond the cut is away at the start.
const AWAY: Vector<2> = Vector::<2>::new(0.0, 0.45);

struct Choice {
    contact: Contact,
    corrected: bool,
    shifting: Shifting,
    /// Whether the parts are bodies of their own.
    are_bodies: bool,
    /// Whether the part beyond the cut begins far away.
    begins_away: bool,
    self_contact: Option<f64>,
}

fn input(choice: &Choice) -> (TransportVelocityInput<2>, SolidsInput, Particles<2>) {
    let now: Particles<2> = unit_box(SIDE, 0.1, 4);
    let mut particles = now.clone();
    for (body, position) in particles.body.iter_mut().zip(&mut particles.position) {
        let is_beyond = position[0] > CUT;
        *body = u32::from(choice.are_bodies && is_beyond);
        if choice.begins_away && is_beyond {
            *position += AWAY;
        }
    }
    let settings = Settings { free_surface: true, artificial_viscosity: 0.7, ..SETTINGS };
    let settings = Settings { shifting: choice.shifting, ..settings };
    let (input, solids) = solids_in_box(particles, settings, vec![SOLID; 2]);
    let Choice { contact, corrected, self_contact, .. } = *choice;
    (input, SolidsInput { contact, corrected, self_contact, ..solids }, now)
}

/// Accelerations, deviations and all that a state has after both parts have come together.
fn together(choice: &Choice) -> (Vec<Forces<2>>, Vec<f64>) {
    let (input, solids, now) = input(choice);
    let mut scheme = Solids::new(input, solids).expect("the solids can be built");
    let mut state = scheme.initial_state();
    let noise = |k: usize| (k as f64 * 12.9898).sin();
    change_rows(&scheme, &mut state, |number, row| {
        row[..2].iter_mut().enumerate().for_each(|(i, u)| *u = noise(7 * number + i));
        row[2..4].copy_from_slice(now.position[number].as_slice());
        row[4] *= 1.0 + 0.02 * noise(3 * number);
    });
    change_matter(&scheme, &mut state, |number, row| {
        (0..6).for_each(|k| row[k] = 4.0 * noise(11 * number + k));
    });
    let forces = scheme.terms(0.0, &state).into_iter().map(|(_, forces)| forces).collect();
    let split = scheme.split().expect("it can be split");
    split.accelerate(0.0, &mut state);
    split.drift(0.0, 1e-4, &mut state);
    (forces, state)
}

const IPST: Shifting = Shifting::Iterative { tolerance: 1e-9, most_passes: 3 };
const SPST: Shifting = Shifting::Sun { factor: 1.0 };

#[test]
fn parts_that_began_apart_touch_as_bodies_do() {
    let spring = Contact::Penalty { stiffness: 1.0 };
    for (contact, corrected, shifting) in [
        (Contact::Repulsive, false, SPST),
        (Contact::Repulsive, true, IPST),
        (spring, true, SPST),
        (spring, false, Shifting::Background { most: 1.0 }),
    ] {
        let bodies = Choice {
            contact,
            corrected,
            shifting,
            are_bodies: true,
            begins_away: true,
            self_contact: None,
        };
        let (forces, state) = together(&bodies);
        let parts = Choice { are_bodies: false, self_contact: Some(0.2), ..bodies };
        let (found, after) = together(&parts);
        assert!(found == forces && after == state, "{contact:?}, {corrected}, {shifting:?}");
        // Which is not what a whole body does, nor one that never was apart.
        let (whole, _) = together(&Choice { self_contact: None, ..parts });
        assert!(whole != forces);
        let (always, _) = together(&Choice { begins_away: false, ..parts });
        assert!(always == whole);
        let full = Choice { contact: Contact::Full, ..parts };
        let (full_and_whole, _) = together(&Choice { self_contact: None, ..full });
        assert!(together(&full).0 == full_and_whole);
    }
}

#[test]
fn what_are_neighbors_at_the_start_cannot_touch() {
    let bodies = Choice {
        contact: Contact::Repulsive,
        corrected: false,
        shifting: SPST,
        are_bodies: false,
        begins_away: false,
        self_contact: Some(0.149),
    };
    let (input, solids, _) = input(&bodies);
    let refused = Solids::new(input, solids).map(|_| ());
    let Err(error @ TransportVelocityError::SelfContact { distance, support }) = refused else {
        panic!("{refused:?}");
    };
    assert!(distance == 0.149 && (support - 0.15).abs() < 1e-12, "{error}");
    assert!(error.to_string().contains("1.490e-1 m apart"), "{error}");
}
