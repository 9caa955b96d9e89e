//! Solutions that are known, supports of all kinds, and what cannot be solved.

use std::sync::Arc;

use piola::boundaries::{BodyForce, PrescribedDisplacement, Tie};
use piola::schemes::InputError;
use piola::schemes::total_lagrangian::{StaticState, Statics, StaticsError, StaticsInput};
use piola::solve::{LinearMethod, LoadError, LoadSteps, Newton, NewtonError};
use piola::{Tensor, Vector};
use piola_formulas::hyperelastic::{HyperelasticLaw, Reduced};
use piola_formulas::volumetric::StressState;

use super::{body, constants, forces, growing, is_quadratic, moved, select};
use crate::clouds::{Cloud, some_gradient};

/// A homogeneous state with a displacement gradient, what holds it and how it is solved.
struct Uniform<'a, const D: usize> {
    cloud: &'a Cloud<D>,
    state: StressState,
    slope: Tensor<D>,
    prescribed: Vec<PrescribedDisplacement<D>>,
    method: LinearMethod,
    steps: Option<LoadSteps>,
}

impl<const D: usize> Uniform<'_, D> {
    fn solve(&self) -> Result<Vec<StaticState<D>>, StaticsError> {
        let law = HyperelasticLaw::neo_hookean(constants());
        let body = body(self.cloud, law.clone(), self.state);
        let stress = Reduced::<D>::new(law, self.state).unwrap().stress(&self.slope);
        let loads: Vec<Vector<D>> = self.cloud.areas.iter().map(|area| stress * area).collect();
        let input = StaticsInput {
            tractions: forces(&loads),
            prescribed: self.prescribed.clone(),
            method: self.method,
            newton: Newton { tolerance: 1e-11, ..Newton::default() },
            ..StaticsInput::default()
        };
        let steps = self.steps.clone().unwrap_or(LoadSteps::Given(vec![0.5, 1.0]));
        Statics::new(body.clone().into(), input)?.solve(&steps)
    }

    /// The patch test: on any cloud displacements are linear, and supports have nothing to do.
    fn check(&self) {
        let places = &self.cloud.particles.position;
        let exact: Vec<Vector<D>> = places.iter().map(|x| self.slope * x).collect();
        let states = self.solve().unwrap();
        let last = &states[1];
        let largest = exact.iter().map(Vector::amax).fold(0.0, f64::max);
        let errors = last.displacement.iter().zip(&exact).map(|(u, exact)| (u - exact).amax());
        let error = errors.fold(0.0, f64::max) / largest;
        assert!(error < 1e-8, "displacements are {error:e} off, {:?}", last.solved);
        let scale: f64 = 1e6 * self.cloud.areas.iter().map(Vector::norm).sum::<f64>();
        assert!(
            last.reactions.iter().all(|r| r.force.amax() < 1e-8 * scale),
            "{:?}",
            last.reactions
        );
    }
}

fn symmetric<const D: usize>(slope: Tensor<D>) -> Tensor<D> {
    0.5 * (slope + slope.transpose())
}

/// Points held at as few components as hold a body, at the places of a linear field.
fn points<const D: usize>(
    cloud: &Cloud<D>,
    slope: Tensor<D>,
    held: &[(usize, usize)],
) -> Vec<PrescribedDisplacement<D>> {
    let to = |a: usize, i: usize| (slope * cloud.particles.position[a])[i];
    held.iter().map(|&(a, i)| moved(a, i, to(a, i))).collect()
}

#[test]
fn uniform_strains_are_found_on_any_cloud() {
    for method in [LinearMethod::Direct, LinearMethod::Krylov] {
        let cloud = Cloud::simplices([2.0], [12], 0.2);
        let slope = Tensor::<1>::new(-0.3);
        let prescribed = points(&cloud, slope, &[(0, 0)]);
        let state = StressState::UniaxialStress;
        Uniform { cloud: &cloud, state, slope, prescribed, method, steps: None }.check();

        let cloud = Cloud::simplices([2.0, 1.0], [10, 5], 0.2);
        let slope = some_gradient::<2>() + Tensor::<2>::identity() * 0.2;
        let prescribed = points(&cloud, slope, &[(0, 0), (0, 1), (10, 1)]);
        let state = StressState::PlaneStress;
        Uniform { cloud: &cloud, state, slope, prescribed, method, steps: None }.check();

        let cloud = Cloud::simplices([1.0; 3], [3; 3], 0.15);
        let slope = some_gradient::<3>() + Tensor::<3>::identity() * 0.2;
        let held = [(0, 0), (0, 1), (0, 2), (3, 1), (3, 2), (12, 2)];
        let prescribed = points(&cloud, slope, &held);
        let state = StressState::ThreeDimensional;
        Uniform { cloud: &cloud, state, slope, prescribed, method, steps: None }.check();
    }
}

/// On rollers that are inclined to all axes, two of them with a particle in common; and in
/// compression on rollers along two faces, which hold a body that dead loads would rather turn
/// round.
#[test]
fn uniform_strains_are_found_on_inclined_rollers() {
    let cloud = Cloud::simplices([2.0, 1.0], [10, 5], 0.2);
    let state = StressState::PlaneStress;
    for (pull, left, bottom) in [(0.2, [3.0, 4.0], [-1.0, 5.0]), (-0.05, [1.0, 0.0], [0.0, 1.0])] {
        // Without rotation, so that growing loads have no moment on the way.
        let part = if pull > 0.0 { 1.0 } else { 0.3 };
        let slope = symmetric(some_gradient::<2>()) * part + Tensor::<2>::identity() * pull;
        let roller = |name: &str, direction: [f64; 2], particles: Vec<u32>| {
            let direction = Vector::<2>::from(direction);
            let unit = direction.normalize();
            let value = growing(move |x| unit.dot(&(slope * Vector::<2>::new(x[0], x[1]))));
            PrescribedDisplacement { name: name.into(), particles, direction, value }
        };
        let prescribed = vec![
            roller("left", left, (0..6).map(|row| 11 * row).collect()),
            roller("bottom", bottom, (0..11).collect()),
        ];
        Uniform {
            cloud: &cloud,
            state,
            slope,
            prescribed,
            method: LinearMethod::Direct,
            steps: None,
        }
        .check();
    }
}

/// A body in compression by dead loads has less energy turned round by half a turn, where they pull
/// at it. Held at as few points as hold a rigid body it gives way locally and turns: the linear
/// field is in equilibrium, but does not stay. Steps that adapt report that, a large one jumps.
#[test]
fn compression_by_dead_loads_turns_a_body_held_at_points() {
    let cloud = Cloud::simplices([1.0; 3], [3; 3], 0.15);
    let slope = symmetric(some_gradient::<3>()) - Tensor::<3>::identity() * 0.3;
    let held = [(0, 0), (0, 1), (0, 2), (3, 1), (3, 2), (12, 2)];
    let prescribed = points(&cloud, slope, &held);
    let (state, method) = (StressState::ThreeDimensional, LinearMethod::Direct);
    let mut uniform = Uniform { cloud: &cloud, state, slope, prescribed, method, steps: None };
    let turned = uniform.solve().unwrap().remove(1);
    assert!(turned.solved.iterations.iter().any(|iteration| iteration.indefinite));
    // Half a turn about z takes x to -x and y to -y.
    let places = cloud.particles.position.iter().zip(&turned.displacement);
    let along: f64 = places.map(|(x, u)| x[0] * (x + u)[0] + x[1] * (x + u)[1]).sum();
    assert!(along < 0.0, "{along}");
    let levels = vec![0.5, 1.0];
    uniform.steps = Some(LoadSteps::Automatic { levels, first: 0.05, least: 1e-3 });
    let error = uniform.solve().unwrap_err();
    assert!(matches!(error, StaticsError::Load(LoadError::Unstable { .. })), "{error}");
    assert!(error.to_string().contains("energy falls in"), "{error}");
}

/// A column with a clamped foot.
fn column(law: HyperelasticLaw) -> (Cloud<2>, piola::schemes::total_lagrangian::Discrete<2>) {
    let cloud = Cloud::block([1.0, 2.0], [8, 16], 0.2);
    let body = body(&cloud, law, StressState::PlaneStrain);
    (cloud, body)
}

#[test]
fn newtons_method_converges_quadratically_and_reactions_balance_loads() {
    let (cloud, body) = column(HyperelasticLaw::neo_hookean(constants()));
    let foot = select(&cloud, |x| x[1] == 0.0);
    let mut loads = vec![Vector::<2>::zeros(); body.len()];
    for a in select(&cloud, |x| x[1] == 2.0) {
        loads[a as usize] = Vector::<2>::new(3e4, 1e5) * cloud.areas[a as usize][1];
    }
    let solve = |method| {
        let input = StaticsInput {
            tractions: forces(&loads),
            body_forces: vec![BodyForce {
                body: None,
                acceleration: [growing(|_| 2.0), growing(|_| -9.81)],
            }],
            prescribed: PrescribedDisplacement::clamp("foot", &foot).to_vec(),
            newton: Newton { tolerance: 1e-12, ..Newton::default() },
            method,
            ..StaticsInput::default()
        };
        let mut statics = Statics::new(body.clone().into(), input).unwrap();
        statics.solve(&LoadSteps::Given(vec![1.0])).unwrap().remove(0)
    };
    let direct = solve(LinearMethod::Direct);
    assert!(
        is_quadratic(&direct.solved.iterations, direct.solved.residual, 30.0),
        "{:?}",
        direct.solved
    );
    let mass: f64 = 1000.0 * cloud.particles.volume.iter().sum::<f64>();
    let total: Vector<2> = loads.iter().sum::<Vector<2>>() + Vector::<2>::new(2.0, -9.81) * mass;
    let reaction: Vector<2> = direct.reactions.iter().map(|reaction| reaction.force).sum();
    assert!((reaction + total).norm() < 1e-9 * total.norm(), "{reaction} {total}");
    let others = solve(LinearMethod::Krylov).displacement;
    let apart = direct.displacement.iter().zip(&others).map(|(a, b)| (a - b).amax());
    assert!(apart.fold(0.0, f64::max) < 1e-9, "both solvers find the same");
}

/// A platen that is pressed at one particle moves as one whose motion is prescribed.
#[test]
fn a_tied_platen_moves_as_one_that_is_prescribed() {
    let (cloud, body) = column(HyperelasticLaw::neo_hookean(constants()));
    let foot = PrescribedDisplacement::clamp("foot", &select(&cloud, |x| x[1] == 0.0)).to_vec();
    let top = select(&cloud, |x| x[1] == 2.0);
    for method in [LinearMethod::Direct, LinearMethod::Krylov] {
        let mut loads = vec![Vector::<2>::zeros(); body.len()];
        let force = Vector::<2>::new(1e4, -1e5);
        loads[top[2] as usize] = force;
        let tie = |component| Tie { name: "platen".into(), particles: top.clone(), component };
        let input = StaticsInput {
            tractions: forces(&loads),
            prescribed: foot.clone(),
            ties: vec![tie(0), tie(1)],
            newton: Newton { tolerance: 1e-10, ..Newton::default() },
            method,
            ..StaticsInput::default()
        };
        let pressed =
            Statics::new(body.clone().into(), input).unwrap().solve(&LoadSteps::Given(vec![1.0]));
        let pressed = pressed.unwrap().remove(0);
        let platen = pressed.displacement[top[0] as usize];
        assert!(top.iter().all(|&a| pressed.displacement[a as usize] == platen));
        assert!(platen[1] < -0.1, "{platen}");

        let mut prescribed = foot.clone();
        for component in 0..2 {
            let to = growing(move |_| platen[component]);
            let condition = PrescribedDisplacement::component("platen", top.clone(), component, to);
            prescribed.push(condition);
        }
        let newton = Newton { tolerance: 1e-10, ..Newton::default() };
        let input = StaticsInput { prescribed, method, newton, ..StaticsInput::default() };
        let moved = Statics::new(body.clone().into(), input)
            .unwrap()
            .solve(&LoadSteps::Given(vec![0.5, 1.0]));
        let moved = moved.unwrap().remove(1);
        let apart = pressed.displacement.iter().zip(&moved.displacement);
        let apart = apart.map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
        assert!(apart < 1e-8, "{apart:e}");
        let reaction = moved.reactions[2].force + moved.reactions[3].force;
        assert!((reaction - force).norm() < 1e-7 * force.norm(), "{reaction}");
    }
}

#[test]
fn automatic_steps_are_cut_and_meet_their_levels() {
    let cloud = Cloud::block([2.0, 1.0], [16, 8], 0.2);
    let law = HyperelasticLaw::neo_hookean_logarithmic(constants());
    let body = body(&cloud, law, StressState::PlaneStrain);
    let foot = PrescribedDisplacement::clamp("foot", &select(&cloud, |x| x[1] == 0.0)).to_vec();
    let top = select(&cloud, |x| x[1] == 1.0);
    let squeezed = |to: f64| {
        let mut prescribed = foot.clone();
        let down = growing(move |_| to);
        prescribed.push(PrescribedDisplacement::component("top", top.clone(), 1, down));
        let across = Arc::new(0.0);
        prescribed.push(PrescribedDisplacement::component("top", top.clone(), 0, across));
        StaticsInput { prescribed, ..StaticsInput::default() }
    };
    // Through its own foot: in one step particles are turned inside out.
    let through = Statics::new(body.clone().into(), squeezed(-1.2))
        .unwrap()
        .solve(&LoadSteps::Given(vec![1.0]));
    let error = through.unwrap_err();
    assert!(matches!(error, StaticsError::Inverted { factor: 1.0, reached: 0.0, .. }), "{error}");
    let input = || squeezed(-0.35);
    let steps = LoadSteps::Automatic { levels: vec![0.5, 1.0], first: 1.0, least: 1e-3 };
    let states = Statics::new(body.clone().into(), input()).unwrap().solve(&steps).unwrap();
    let factors: Vec<f64> = states.iter().map(|state| state.factor).collect();
    assert!(factors.contains(&0.5) && factors.last() == Some(&1.0), "{factors:?}");
    assert!(factors.windows(2).all(|pair| pair[0] < pair[1]), "{factors:?}");
    let work = |states: &[StaticState<2>]| {
        let force = |k: usize| match k {
            0 => 0.0,
            _ => -0.35 * states[k - 1].reactions[2].force[1],
        };
        let factor = |k: usize| if k == 0 { 0.0 } else { states[k - 1].factor };
        let trapezoid = |k: usize| 0.5 * (force(k) + force(k + 1)) * (factor(k + 1) - factor(k));
        (0..states.len()).map(trapezoid).sum::<f64>()
    };
    // What the platen puts in is the energy of the body, to the error of the trapezoidal sum.
    let energy: f64 = states.last().unwrap().energies.iter().sum();
    let even: Vec<f64> = (1..=40).map(|k| f64::from(k) / 40.0).collect();
    let fine =
        Statics::new(body.clone().into(), input()).unwrap().solve(&LoadSteps::Given(even)).unwrap();
    assert!((work(&fine) / energy - 1.0).abs() < 3e-3, "{} {energy}", work(&fine));
    let last = fine.last().unwrap().energies.iter().sum::<f64>();
    assert!((last / energy - 1.0).abs() < 1e-8, "the path does not matter: {last} {energy}");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let cloud = Cloud::block([1.0, 1.0], [36, 36], 0.2);
    let law = HyperelasticLaw::neo_hookean(constants());
    let body = body(&cloud, law, StressState::PlaneStrain);
    let foot = select(&cloud, |x| x[1] == 0.0);
    let run = |threads: usize, method| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let input = StaticsInput {
                body_forces: vec![BodyForce {
                    body: None,
                    acceleration: [Arc::new(0.0), growing(|x| -60.0 * x[0])],
                }],
                prescribed: PrescribedDisplacement::clamp("foot", &foot).to_vec(),
                method,
                ..StaticsInput::default()
            };
            Statics::new(body.clone().into(), input)
                .unwrap()
                .solve(&LoadSteps::Given(vec![1.0]))
                .unwrap()
        })
    };
    for method in [LinearMethod::Direct, LinearMethod::Krylov] {
        assert!(run(1, method) == run(3, method), "{method:?}: other bits on three threads");
    }
}

#[test]
fn what_is_wrong_with_supports_is_named() {
    let cloud = Cloud::simplices([2.0, 1.0], [6, 3], 0.2);
    let body = body(&cloud, HyperelasticLaw::neo_hookean(constants()), StressState::PlaneStrain);
    let refused = |prescribed: Vec<PrescribedDisplacement<2>>, ties: Vec<Tie>| {
        let input = StaticsInput { prescribed, ties, ..StaticsInput::default() };
        Statics::new(body.clone().into(), input).err().expect("it is refused")
    };
    let held = |components: &[(usize, usize)]| -> Vec<PrescribedDisplacement<2>> {
        components.iter().map(|&(a, i)| moved(a, i, 0.0)).collect()
    };
    let free = |motion: &str| StaticsError::Free { body: 0, part: None, motion: motion.into() };
    assert_eq!(refused(held(&[(0, 0), (0, 1)]), Vec::new()), free("turn about z"));
    assert_eq!(refused(held(&[(0, 1), (6, 1)]), Vec::new()), free("shift along x"));
    let error = refused(held(&[(99, 0)]), Vec::new());
    assert!(
        matches!(error, StaticsError::Input(InputError::Index { got: 99, count: 28, .. })),
        "{error}"
    );
    let error = refused(held(&[(0, 2)]), Vec::new());
    assert!(matches!(error, StaticsError::Direction { .. }), "{error}");
    let mut three = held(&[(0, 0), (0, 1), (6, 1)]);
    three[2].particles = vec![0];
    three[2].direction = Vector::<2>::new(1.0, 1.0);
    let error = refused(three, Vec::new());
    assert!(matches!(error, StaticsError::Overconstrained { id: 0, .. }), "{error}");
    let tie = Tie { name: "platen".into(), particles: vec![5, 6], component: 1 };
    let error = refused(held(&[(0, 0), (0, 1), (6, 1)]), vec![tie]);
    assert!(matches!(error, StaticsError::Tie { id: 6, component: 1, .. }), "{error}");
    // A tie holds against turning, but not against shifting.
    let tie = Tie { name: "platen".into(), particles: vec![0, 6], component: 1 };
    assert_eq!(refused(held(&[(0, 0)]), vec![tie]), free("shift along y"));
}

/// All is held and nothing is left to solve for: reactions are what the strain takes.
#[test]
fn a_body_that_is_held_throughout_has_reactions() {
    let cloud = Cloud::block([1.0, 1.0], [4, 4], 0.2);
    let law = HyperelasticLaw::neo_hookean(constants());
    let body = body(&cloud, law.clone(), StressState::PlaneStrain);
    let slope = some_gradient::<2>();
    let all = select(&cloud, |_| true);
    let prescribed = (0..2).map(|component| {
        let value = growing(move |x| (slope * Vector::<2>::new(x[0], x[1]))[component]);
        PrescribedDisplacement::component("all", all.clone(), component, value)
    });
    for method in [LinearMethod::Automatic, LinearMethod::Direct, LinearMethod::Krylov] {
        let prescribed = prescribed.clone().collect();
        let input = StaticsInput { prescribed, method, ..StaticsInput::default() };
        let state =
            Statics::new(body.clone().into(), input).unwrap().solve(&LoadSteps::Given(vec![1.0]));
        let state = state.unwrap().remove(0);
        let stress =
            Reduced::<2>::new(law.clone(), StressState::PlaneStrain).unwrap().stress(&slope);
        for (force, area) in state.support_force.iter().zip(&cloud.areas) {
            assert!((force - stress * area).amax() < 1e-8 * stress.amax(), "{force}");
        }
    }
}

#[test]
fn a_failure_shows_its_iterations() {
    let (cloud, body) = column(HyperelasticLaw::neo_hookean(constants()));
    let input = StaticsInput {
        body_forces: vec![BodyForce {
            body: None,
            acceleration: [growing(|_| 60.0), Arc::new(0.0)],
        }],
        prescribed: PrescribedDisplacement::clamp("foot", &select(&cloud, |x| x[1] == 0.0))
            .to_vec(),
        newton: Newton { most_iterations: 2, ..Newton::default() },
        ..StaticsInput::default()
    };
    let mut statics = Statics::new(body.clone().into(), input).unwrap();
    let error = statics.solve(&LoadSteps::Given(vec![1.0])).unwrap_err();
    let StaticsError::Load(LoadError::Newton { source, .. }) = &error else { panic!("{error}") };
    let NewtonError::NoConvergence { history, .. } = source else { panic!("{error}") };
    assert_eq!(history.len(), 2);
    assert!(error.to_string().contains("the residual went 1.0e0, "), "{error}");
    let error = statics.solve(&LoadSteps::Given(vec![0.5, 0.5])).unwrap_err();
    assert!(matches!(error, StaticsError::Load(LoadError::Steps { value: 0.5, .. })), "{error}");
}
