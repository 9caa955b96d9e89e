//! The loop over steps, on a scheme small enough to know everything about: a pendulum with a clock
//! of its own, whose limits and health are functions of time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use piola::fields::FieldDescription;
use piola::schemes::{Health, Missed, NoSolution, Particle, Scheme, SchemeDescription, StepLimit};
use piola::time::{
    Executor, Failure, Integrator, IntegratorKind, Moment, ObserveError, Observer, Outcome,
    Schedule, StepControl, Summary,
};

/// `x' = v`, `v' = -sin x`, and `t' = 1` in one row.
struct Pendulum {
    limit: fn(f64) -> f64,
    ratio: fn(f64) -> f64,
}

const PENDULUM: Pendulum = Pendulum { limit: |_| 0.1, ratio: |_| 1.0 };

impl Scheme for Pendulum {
    fn description(&self) -> &'static SchemeDescription {
        &SchemeDescription {
            offers: &[piola::schemes::Capability::Rates],
            matter: None,
            name: "pendulum",
            fields: &[],
            energies: &[],
            ledger: piola::schemes::Accounts::NONE,
            figures: &[],
        }
    }

    fn dimension(&self) -> usize {
        1
    }

    fn particle_count(&self) -> usize {
        1
    }

    fn width(&self) -> usize {
        3
    }

    fn initial_state(&self) -> Vec<f64> {
        vec![2.0, 0.0, 0.0]
    }

    fn rates(&mut self, time: f64, state: &[f64], rate: &mut [f64]) {
        assert!((time - state[2]).abs() < 1e-9, "the clock of the integrator is the state's");
        rate.copy_from_slice(&[state[1], -state[0].sin(), 1.0]);
    }

    fn constrain(&self, _time: f64, _state: &mut [f64]) {}

    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        limits.clear();
        let step = (self.limit)(state[2]);
        let growth = f64::INFINITY;
        limits.push(StepLimit { name: "swing", step, particle: 0, scaled: true, growth });
        Health { smallest_ratio: (self.ratio)(state[2]), ..Health::NEUTRAL }
    }

    fn energies(&self, _state: &[f64], _energies: &mut [f64]) {}

    fn momentum(&self, _state: &[f64], _momentum: &mut [f64]) {}

    fn derive(&self, _: &[f64], _: &FieldDescription, _: &[u32], _: &mut Vec<f64>) {}

    fn mass(&self, _: usize) -> f64 {
        1.0
    }

    fn bodies(&self) -> &[u32] {
        &[0]
    }

    fn ids(&self) -> &[u32] {
        &[7]
    }

    fn particle(&self, _index: usize) -> Particle {
        Particle { id: 7, reference: vec![0.0] }
    }

    fn neighborhood(&self, _index: usize) -> Vec<u32> {
        Vec::new()
    }

    fn stability_advice(&self) -> &'static str {
        "oil the bearing"
    }

    fn collapse_advice(&self, _index: usize) -> String {
        "shorten the rod".into()
    }

    fn memory(&self) -> usize {
        0
    }
}

/// What an observer was shown.
#[derive(Clone, Debug, PartialEq)]
struct Shown {
    time: f64,
    step: u64,
    limiter: &'static str,
    state: Vec<f64>,
    last: bool,
}

type Notes = Arc<Mutex<Vec<Shown>>>;

struct Witness {
    schedule: Schedule,
    notes: Notes,
}

impl Observer for Witness {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn observe(&mut self, moment: &mut Moment) -> Result<(), ObserveError> {
        self.notes.lock().expect("no other thread").push(Shown {
            time: moment.now.time(),
            step: moment.step,
            limiter: moment.limiter,
            state: moment.now.state().to_vec(),
            last: moment.last,
        });
        Ok(())
    }
}

fn executor(mut scheme: Pendulum, control: StepControl, end: f64) -> Executor {
    let integrator = IntegratorKind::TvdRk2.build(&mut scheme).expect("it has rates");
    let mut executor = Executor::new(Box::new(scheme), integrator, control, end);
    executor.max_steps = 100_000;
    executor
}

fn watch(executor: &mut Executor, schedule: Schedule) -> Notes {
    let notes = Notes::default();
    executor.observe(Box::new(Witness { schedule, notes: notes.clone() }));
    notes
}

fn run(executor: &mut Executor) -> Summary {
    executor.run(&AtomicBool::new(false), &mut |_| {}).expect("the witnesses have no faults")
}

fn shown(notes: &Notes) -> Vec<Shown> {
    notes.lock().expect("no other thread").clone()
}

fn times(notes: &Notes) -> Vec<f64> {
    shown(notes).iter().map(|shown| shown.time).collect()
}

/// Steps of 0.07 s divide nothing, and yet every due time is met to the bit, once.
#[test]
fn due_times_are_met_exactly() {
    let mut executor = executor(PENDULUM, StepControl::Cfl(0.7), 1.0);
    let every = watch(&mut executor, Schedule::Every(0.3));
    let listed = watch(&mut executor, Schedule::at(vec![0.777, 0.25, 0.333]));
    let end = watch(&mut executor, Schedule::End);
    let summary = run(&mut executor);
    assert_eq!(summary.outcome, Outcome::Completed);
    assert_eq!(summary.time, 1.0);
    assert_eq!(times(&every), [0.0, 0.3, 0.6, 3.0 * 0.3, 1.0]);
    assert_eq!(times(&listed), [0.25, 0.333, 0.777, 1.0]);
    assert_eq!(times(&end), [1.0]);
    for notes in [every, listed, end] {
        let shown = shown(&notes);
        let (last, before) = shown.split_last().expect("something was shown");
        assert!(last.last && before.iter().all(|shown| !shown.last));
        for shown in shown {
            assert!((shown.state[2] - shown.time).abs() < 1e-14, "{shown:?}");
            let expected = if shown.step == 0 { "start" } else { "output" };
            assert_eq!(shown.limiter, expected);
        }
    }
    assert!(summary.step_range[1] <= 0.7 * 0.1 && summary.step_range[0] > 0.01, "{summary:?}");
    assert_eq!((summary.first_step, summary.evaluations), (0.7 * 0.1, 2 * summary.steps));
}

/// They are the multiples of the interval, not a sum of steps.
#[test]
fn many_due_times_do_not_drift() {
    let mut executor = executor(PENDULUM, StepControl::Cfl(0.37), 20.0);
    let every = watch(&mut executor, Schedule::Every(0.1));
    run(&mut executor);
    let expected: Vec<f64> = (0..=200).map(|count| f64::from(count) * 0.1).collect();
    assert_eq!(times(&every), expected);
}

/// Where the run ends does not depend on who looks, but for the error of the integrator, whose
/// order is two whether steps are clipped or not.
#[test]
fn clipped_steps_keep_the_order() {
    let solve = |number: f64, schedule: Schedule| {
        let mut executor = executor(PENDULUM, StepControl::Cfl(number), 2.0);
        let notes = watch(&mut executor, schedule);
        run(&mut executor);
        let state = shown(&notes).pop().expect("the end is shown").state;
        [state[0], state[1]]
    };
    let exact = solve(0.002, Schedule::End);
    for schedule in [Schedule::End, Schedule::Every(0.0317), Schedule::at(vec![0.5, 1.01, 1.9])] {
        let error = |number: f64| {
            let found = solve(number, schedule.clone());
            (found[0] - exact[0]).hypot(found[1] - exact[1])
        };
        let [coarse, fine] = [0.4, 0.1].map(error);
        let order = (coarse / fine).log2() / 2.0;
        assert!((1.8..2.2).contains(&order), "{schedule:?}: {order}, {coarse} {fine}");
    }
}

/// The state that broke is shown to nobody; the one before it is, and marked as the last.
#[test]
fn a_failed_run_shows_its_last_good_state() {
    let sinking = Pendulum { ratio: |t| 0.52 - t, ..PENDULUM };
    let mut executor = executor(sinking, StepControl::Cfl(0.5), 1.0);
    let often = watch(&mut executor, Schedule::Every(0.05));
    let end = watch(&mut executor, Schedule::End);
    let summary = run(&mut executor);
    let Outcome::Failed(Failure::Inverted { particle, ratio, step, time, advice, .. }) =
        &summary.outcome
    else {
        panic!("{:?}", summary.outcome)
    };
    assert_eq!((particle.id, *step, advice.as_str()), (7, 11, "shorten the rod"));
    assert!((time - 0.55).abs() < 1e-14 && (ratio + 0.03).abs() < 1e-14);
    assert_eq!(summary.outcome.summary(), "failed: inverted");
    assert_eq!((summary.steps, summary.time), (10, 0.5));
    assert!((summary.worst.smallest_ratio - 0.02).abs() < 1e-14);
    let last = shown(&end);
    assert_eq!((last.len(), last[0].step, last[0].last), (1, 10, true));
    assert!((last[0].state[2] - 0.5).abs() < 1e-14);
    // Who had seen it already sees it again, marked as the last.
    let often = shown(&often);
    assert_eq!(often.len(), 12);
    assert_eq!(
        (often[10].step, often[10].last, often[11].step, often[11].last),
        (10, false, 10, true)
    );
    assert_eq!(often[10].state, often[11].state);
}

#[test]
fn a_start_that_is_broken_fails_before_the_first_step() {
    let mut executor =
        executor(Pendulum { ratio: |_| -1.0, ..PENDULUM }, StepControl::Cfl(0.5), 1.0);
    let end = watch(&mut executor, Schedule::End);
    let summary = run(&mut executor);
    assert!(matches!(summary.outcome, Outcome::Failed(Failure::Inverted { step: 0, .. })));
    assert_eq!((summary.steps, shown(&end).len()), (0, 1));
}

/// The flag is seen after a whole step, and the state of that step is shown.
#[test]
fn a_stop_comes_after_a_whole_step() {
    let mut executor = executor(PENDULUM, StepControl::Cfl(1.0), 10.0);
    let end = watch(&mut executor, Schedule::End);
    let stop = AtomicBool::new(false);
    let summary = executor.run(&stop, &mut |progress| {
        assert_eq!((progress.end, progress.limiter), (10.0, "swing"));
        stop.store(progress.step == 3, Ordering::Relaxed);
    });
    let summary = summary.expect("the witness has no fault");
    assert_eq!((summary.outcome, summary.steps), (Outcome::Interrupted, 3));
    let last = shown(&end).pop().expect("the last state is shown");
    assert!(last.last && last.step == 3 && last.time == summary.time);
    assert!((last.state[2] - 0.3).abs() < 1e-14);
}

#[test]
fn a_fixed_step_that_is_too_large_is_refused_with_the_numbers() {
    let mut executor = executor(PENDULUM, StepControl::Fixed(0.2), 1.0);
    let end = watch(&mut executor, Schedule::End);
    let summary = run(&mut executor);
    assert_eq!(summary.steps, 0);
    let Outcome::Failed(failure) = summary.outcome else { panic!("{:?}", summary.outcome) };
    let Failure::FixedStepTooLarge { step, stable, limiter, time, .. } = &failure else {
        panic!("{failure:?}")
    };
    assert_eq!((*step, *stable, *limiter, *time), (0.2, 0.1, "swing", 0.0));
    let text = failure.to_string();
    assert!(text.contains("2.0000e-1") && text.contains("1.0000e-1"), "{text}");
    assert_eq!(times(&end), [0.0]);
}

/// It is checked at every step, not only at the first.
#[test]
fn a_fixed_step_that_becomes_too_large_ends_the_run() {
    let tightening = Pendulum { limit: |t| 0.1 - 0.1 * t, ..PENDULUM };
    let summary = run(&mut executor(tightening, StepControl::Fixed(0.05), 1.0));
    assert!(matches!(summary.outcome, Outcome::Failed(Failure::FixedStepTooLarge { .. })));
    assert!((summary.time - 0.5).abs() < 0.06, "{}", summary.time);
}

/// A fixed step meets its multiples exactly, and looks at other times after they have passed.
#[test]
fn a_fixed_step_is_never_shortened() {
    let mut executor = executor(PENDULUM, StepControl::Fixed(0.1), 1.0);
    let every = watch(&mut executor, Schedule::Every(0.25));
    let summary = run(&mut executor);
    assert_eq!((summary.steps, summary.step_range), (10, [0.1, 0.1]));
    let expected = [0.0, 3.0 * 0.1, 5.0 * 0.1, 8.0 * 0.1, 1.0];
    assert_eq!(times(&every), expected);
}

/// A step that shrinks without end stops the run at the floor, by default a millionth of the
/// first, whereas steps clipped to meet a due time may be smaller.
#[test]
fn a_vanishing_step_is_a_failure() {
    let closing = |floor: Option<f64>| {
        let scheme = Pendulum { limit: |t| 0.1 * (0.5 - t), ..PENDULUM };
        let mut executor = executor(scheme, StepControl::Cfl(0.5), 1.0);
        executor.min_step = floor;
        match run(&mut executor).outcome {
            Outcome::Failed(Failure::StepBelowFloor { size, floor, limiter, time, .. }) => {
                assert!(size < floor && size > 0.9 * floor, "{size} {floor}");
                assert_eq!(limiter, "swing");
                (floor, 0.05 * (0.5 - time))
            }
            other => panic!("{other:?}"),
        }
    };
    let (floor, size) = closing(None);
    assert!((floor - 1e-6 * 0.025).abs() < 1e-20 && size < floor);
    assert_eq!(closing(Some(1e-4)).0, 1e-4);

    let mut clipped = executor(PENDULUM, StepControl::Cfl(1.0), 0.2);
    clipped.min_step = Some(0.05);
    watch(&mut clipped, Schedule::at(vec![0.1 + 1e-4]));
    assert_eq!(run(&mut clipped).outcome, Outcome::Completed);
}

/// Steps that lead nowhere end the run at once instead of never.
#[test]
fn steps_of_zero_or_of_no_number_are_failures() {
    let limits: [fn(f64) -> f64; 3] = [|_| 0.0, |_| f64::NAN, |_| -1.0];
    for limit in limits {
        let summary =
            run(&mut executor(Pendulum { limit, ..PENDULUM }, StepControl::Cfl(0.5), 1.0));
        let Outcome::Failed(failure) = summary.outcome else { panic!("{:?}", summary.outcome) };
        assert!(matches!(failure, Failure::StepBelowFloor { step: 0, .. }), "{failure}");
        let fixed =
            run(&mut executor(Pendulum { limit, ..PENDULUM }, StepControl::Fixed(0.5), 1.0));
        assert!(matches!(fixed.outcome, Outcome::Failed(Failure::FixedStepTooLarge { .. })));
    }
    for step in [0.0, f64::NAN, -0.01] {
        for control in [StepControl::Cfl(step), StepControl::Fixed(step)] {
            let summary = run(&mut executor(PENDULUM, control, 1.0));
            assert!(matches!(summary.outcome, Outcome::Failed(_)), "{control:?}");
            assert_eq!(summary.steps, 0);
        }
    }
    for interval in [0.0, -0.1, f64::NAN] {
        let mut executor = executor(PENDULUM, StepControl::Cfl(0.5), 1.0);
        let notes = watch(&mut executor, Schedule::Every(interval));
        assert_eq!(run(&mut executor).outcome, Outcome::Completed);
        assert_eq!(times(&notes), [0.0, 1.0], "{interval}");
    }
}

/// A scheme that sets no bound takes one step to each due time.
#[test]
fn without_a_bound_steps_reach_from_one_due_time_to_the_next() {
    let scheme = Pendulum { limit: |t| if t < 0.5 { f64::INFINITY } else { 0.25 }, ..PENDULUM };
    let mut executor = executor(scheme, StepControl::Cfl(1.0), 1.0);
    watch(&mut executor, Schedule::at(vec![0.5]));
    let summary = run(&mut executor);
    assert_eq!((summary.outcome, summary.steps), (Outcome::Completed, 3));
}

#[test]
fn the_number_of_steps_is_bounded() {
    let mut executor = executor(PENDULUM, StepControl::Cfl(0.5), 10.0);
    executor.max_steps = 5;
    let end = watch(&mut executor, Schedule::End);
    let summary = run(&mut executor);
    let Outcome::Failed(Failure::TooManySteps { steps: 5, time }) = summary.outcome else {
        panic!("{:?}", summary.outcome)
    };
    assert!((time - 0.25).abs() < 1e-14);
    assert_eq!(times(&end), [time]);
    let mut enough = self::executor(PENDULUM, StepControl::Cfl(0.5), 10.0);
    enough.max_steps = 200;
    assert_eq!(run(&mut enough).outcome, Outcome::Completed, "just as many as it takes");
}

/// Finds no state from 0.2 s to 0.3 s in steps above 0.06 s, and is quick elsewhere.
struct Picky;

impl Integrator for Picky {
    fn name(&self) -> &'static str {
        "picky"
    }

    fn evaluations(&self, _scheme: &mut dyn Scheme) -> u64 {
        1
    }

    fn step(
        &mut self,
        _scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        if (0.2..0.3).contains(&(time + 1e-9)) && step > 0.06 {
            let message = "too far".to_owned();
            let kind = Missed::NoConvergence;
            return Err(Failure::NoSolution(NoSolution { kind, time, reached: time, message }));
        }
        new.copy_from_slice(old);
        new[2] += step;
        Ok(())
    }

    fn was_quick(&self, _scheme: &dyn Scheme, _state: &[f64]) -> bool {
        true
    }
}

/// Steps that were cut where they had to be grow again where they may.
#[test]
fn cut_steps_grow_again() {
    let mut executor = executor(PENDULUM, StepControl::AtMost(0.1), 1.0);
    executor.integrator = Box::new(Picky);
    executor.retries = 2;
    let summary = run(&mut executor);
    assert_eq!(summary.outcome, Outcome::Completed);
    let factors: Vec<f64> = summary.retries.iter().map(|retry| retry.factor).collect();
    assert_eq!(factors, [0.5, 0.375]);
    let [smallest, largest] = summary.step_range;
    assert!((smallest - 0.0375).abs() < 1e-12 && (largest - 0.1).abs() < 1e-12);
    // In steps of 0.0375 s from there on it would have been 24.
    assert_eq!(summary.steps, 12);
}
