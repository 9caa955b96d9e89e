//! Steps that are as long as their error allows.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

use piola::Vector;
use piola::schemes::{ImplicitRule, Theta, boxed};
use piola::time::{
    Executor, IntegratorKind, Moment, ObserveError, Observer, Outcome, Schedule, StepControl,
    Summary,
};

use super::problems::{gamma, implicit};
use crate::support::{Choice, PLAIN, lattice};

/// Keeps the last state.
#[derive(Clone, Default)]
struct Last(Arc<Mutex<Vec<f64>>>);

impl Observer for Last {
    fn schedule(&self) -> &Schedule {
        &Schedule::End
    }

    fn observe(&mut self, moment: &mut Moment) -> Result<(), ObserveError> {
        *self.0.lock().expect("no other thread") = moment.now.state().to_vec();
        Ok(())
    }
}

/// A bar of the gamma law that swings in its first mode, with errors of steps below `error`.
fn swing(rule: Theta, kind: IntegratorKind, error: f64) -> (Summary, Vec<f64>) {
    let choice = Choice::new(lattice([10.0], [20]), gamma()).fix(0, |x| x[0] < 1e-9);
    let mut scheme =
        implicit(choice, PLAIN).build(|x| Vector::<1>::new(0.4 * (0.157 * x[0]).sin()));
    let rule = ImplicitRule::Theta(rule);
    let integrator =
        kind.build_with(rule, Some(error), &mut scheme).expect("it was built for that");
    let last = Last::default();
    let control = StepControl::AtMost(10.0);
    let mut executor = Executor::new(boxed(scheme), integrator, control, 4.0);
    executor.observe(Box::new(last.clone()));
    let summary =
        executor.run(&AtomicBool::new(false), &mut |_| {}).expect("nothing is written anywhere");
    assert_eq!(summary.outcome, Outcome::Completed);
    let state = last.0.lock().expect("the run has ended").clone();
    (summary, state)
}

/// An error a step of h^(p+1) leaves steps that fall as its (p+1)th root, and what is off at the end
/// falls as the pth power of these.
#[test]
fn errors_follow_what_is_asked_for() {
    for (rule, kind, order, error) in [
        (Theta::CRANK_NICOLSON, IntegratorKind::CrankNicolson, 2.0, 1e-6),
        (Theta::MIDPOINT, IntegratorKind::ImplicitMidpoint, 2.0, 1e-6),
        (Theta::BACKWARD_EULER, IntegratorKind::BackwardEuler, 1.0, 1e-4),
    ] {
        let (_, exact) = swing(Theta::CRANK_NICOLSON, IntegratorKind::CrankNicolson, 1e-10);
        let off = |error: f64| {
            let (summary, state) = swing(rule, kind, error);
            let rows = 21 * 4;
            let squares = state[..rows].iter().zip(&exact).map(|(a, b)| (a - b) * (a - b));
            (summary, squares.sum::<f64>().sqrt())
        };
        let ((coarse, far), (fine, near)) = (off(error), off(0.01 * error));
        let ratio = fine.steps as f64 / coarse.steps as f64;
        let expected = 100.0_f64.powf(1.0 / (order + 1.0));
        assert!((ratio / expected - 1.0).abs() < 0.25, "{rule:?}: {ratio}, not {expected}");
        let (fall, expected) = (far / near, expected.powf(order));
        assert!((0.6..1.6).contains(&(fall / expected)), "{rule:?}: {fall}, not {expected}");
        let [smallest, largest] = fine.step_range;
        assert!(largest < 10.0 && smallest > 0.0 && fine.retries.is_empty());
    }
}
