//! Steps that lead nowhere.

use std::sync::Arc;

use piola::Vector;
use piola::schemes::{Missed, Scheme, Theta, ThetaScheme};

use super::problems::{gamma, implicit};
use crate::support::{Choice, PLAIN, lattice, places, rows};

/// A wall that moves through the whole body in one step leaves no state to find: the message says
/// where and when, and that a smaller step may do; it does.
#[test]
fn a_step_without_a_state_is_named() {
    let build =
        || {
            let choice = Choice::new(lattice([1.0], [10]), gamma())
                .fix(0, |x| x[0] < 1e-9)
                .prescribe(0, Arc::new(-2.0), |x| x[0] > 1.0 - 1e-9);
            implicit(choice, PLAIN).build(|_| Vector::<1>::zeros())
        };
    let mut scheme = build();
    let mut old = scheme.initial_state();
    scheme.constrain(0.0, &mut old);
    let mut new = old.clone();
    let error = scheme
        .advance(&Theta::BACKWARD_EULER, 0.0, 1.0, &old, &mut new)
        .expect_err("the wall goes through");
    assert_eq!(error.kind, Missed::Inverted);
    for part in ["t = 1.000000 s", "particle", "is inverted", "`time.step`", "retry"] {
        assert!(error.message.contains(part), "{part}: {}", error.message);
    }
    scheme.advance(&Theta::BACKWARD_EULER, 0.0, 0.02, &old, &mut new).expect("a state exists");
}

/// A formulation that was not built for implicit steps does not offer them.
#[test]
fn implicit_steps_have_to_be_asked_for() {
    let mut scheme = Choice::new(lattice([1.0], [10]), gamma()).build(|_| Vector::<1>::zeros());
    assert!(scheme.theta().is_none());
}

/// Where all components are prescribed nothing is left to solve for, and the step is taken.
#[test]
fn a_body_that_is_held_everywhere_moves_as_it_is_told() {
    let choice = Choice::new(lattice([1.0], [10]), gamma()).prescribe(0, Arc::new(0.5), |_| true);
    let mut scheme = implicit(choice, PLAIN).build(|_| Vector::<1>::zeros());
    let mut old = scheme.initial_state();
    scheme.constrain(0.0, &mut old);
    let mut new = old.clone();
    for rule in [Theta::CRANK_NICOLSON, Theta::MIDPOINT] {
        scheme.advance(&rule, 0.0, 0.2, &old, &mut new).expect("a state exists");
        // v, J, x and F of the last particle.
        let row = rows(&places(&scheme)[10 * 4..], &new);
        for (value, expected) in row.iter().zip([0.5, 1.0, 1.1, 1.0]) {
            assert!((value - expected).abs() < 1e-14, "{rule:?}: {row:?}");
        }
    }
}
