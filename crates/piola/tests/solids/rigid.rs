//! Rigid bodies against the equations of motion of bodies, solved by themselves in fine steps.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use piola::Vector;
use piola::boundaries::{BodyForce, SpaceTime, Spring};
use piola::schemes::total_lagrangian::{
    Material, RigidBody, TotalLagrangian, TotalLagrangianInput,
};
use piola::schemes::{Ledger, Scheme};
use piola::time::{Integrator, KickDriftKick};
use piola_formulas::kernels::Kernel;

use crate::statics::mirrors::values;
use crate::support::lattice;

/// A value of time by its first two integrals.
#[derive(Clone, Copy)]
struct Swing {
    amplitude: f64,
    frequency: f64,
}

impl SpaceTime for Swing {
    fn value(&self, _x: [f64; 3], t: f64) -> f64 {
        self.amplitude * self.frequency * (self.frequency * t).cos()
    }

    fn rate(&self, _x: [f64; 3], t: f64) -> f64 {
        -self.amplitude * self.frequency.powi(2) * (self.frequency * t).sin()
    }

    fn is_steady(&self) -> bool {
        false
    }
}

/// A box of particles that moves as one, with a velocity of each at the start.
pub fn input<const D: usize>(
    lengths: [f64; D],
    intervals: [usize; D],
    velocity: impl Fn(&Vector<D>) -> Vector<D>,
) -> TotalLagrangianInput<D> {
    let particles = lattice(lengths, intervals);
    let count = particles.len() as u32;
    let velocity = particles.position.iter().map(velocity).collect();
    let radius = particles.spacing.iter().map(|spacing| 2.6 * spacing).collect();
    let rigid =
        RigidBody { name: "body".into(), particles: (0..count).collect(), ..RigidBody::default() };
    TotalLagrangianInput {
        velocity,
        rigid: vec![rigid],
        ..TotalLagrangianInput::of_bodies(
            particles,
            &[Material::rigid(2.0)],
            (Kernel::WendlandC2, radius),
        )
    }
}

/// What is left of a run: the state at its end, and by how much energy and momentum are off what the
/// ledger has.
struct Run<const D: usize> {
    position: Vec<Vector<D>>,
    energy: f64,
    momentum: Vec<f64>,
}

fn run<const D: usize>(input: TotalLagrangianInput<D>, end: f64, steps: usize) -> Run<D> {
    let reference = input.particles.position.clone();
    let mut scheme = TotalLagrangian::new(input).unwrap();
    let (mut old, mut method) = (scheme.initial_state(), KickDriftKick::default());
    let mut new = old.clone();
    let balance = |scheme: &TotalLagrangian<D>, state: &[f64]| {
        let (mut energies, mut momentum) = ([0.0; 3], vec![0.0; [1, 3, 6][D - 1]]);
        scheme.energies(state, &mut energies);
        scheme.momentum(state, &mut momentum);
        let ledger = Ledger::of(scheme, state);
        let sum = |impulses: &[f64]| {
            momentum.iter_mut().zip(impulses).for_each(|(own, impulse)| *own -= impulse);
        };
        ledger.impulses.chunks_exact([1, 3, 6][D - 1]).for_each(sum);
        (energies.iter().sum::<f64>() - ledger.work.iter().sum::<f64>(), momentum)
    };
    let first = balance(&scheme, &old);
    let step = end / steps as f64;
    for k in 0..steps {
        method.step(&mut scheme, k as f64 * step, step, &old, &mut new).unwrap();
        std::mem::swap(&mut old, &mut new);
    }
    let last = balance(&scheme, &old);
    let column = |name: &str| -> Vec<Vector<D>> {
        let field = scheme.description().field(name).unwrap();
        old[scheme.column(field)].chunks_exact(D).map(Vector::from_column_slice).collect()
    };
    let displacement = column("displacement");
    Run {
        position: reference.iter().zip(displacement).map(|(x, u)| x + u).collect(),
        energy: last.0 - first.0,
        momentum: last.1.iter().zip(first.1).map(|(last, first)| last - first).collect(),
    }
}

/// Classical Runge-Kutta steps of any system.
fn solve<const N: usize>(
    mut state: [f64; N],
    end: f64,
    rate: impl Fn(f64, &[f64; N]) -> [f64; N],
) -> [f64; N] {
    let steps = 20_000;
    let h = end / f64::from(steps);
    for k in 0..steps {
        let t = f64::from(k) * h;
        let at =
            |share: f64, rate: &[f64; N]| std::array::from_fn(|i| state[i] + share * h * rate[i]);
        let one = rate(t, &state);
        let two = rate(t + 0.5 * h, &at(0.5, &one));
        let three = rate(t + 0.5 * h, &at(0.5, &two));
        let four = rate(t + h, &at(1.0, &three));
        state = std::array::from_fn(|i| {
            state[i] + h / 6.0 * (one[i] + 2.0 * two[i] + 2.0 * three[i] + four[i])
        });
    }
    state
}

/// A box that is thrown and turns about its middle axis, which is unstable: two flips. Euler's equations,
/// with the rotation matrix beside them, are solved in the test.
#[test]
fn a_box_that_tumbles_follows_eulers_equations() {
    let (lengths, spin) = ([0.8, 0.5, 0.3], Vector3::new(0.1, 4.0, 0.05));
    let centre = Vector3::from(lengths) * 0.5;
    let thrown = Vector3::new(0.3, -0.2, 0.1);
    let start = || input(lengths, [8, 5, 3], |x| thrown + spin.cross(&(x - centre)));
    let all = start();
    let inertia: Matrix3<f64> = (0..all.particles.len())
        .map(|a| {
            let arm = all.particles.position[a] - centre;
            let mass = 2.0 * all.particles.volume[a];
            (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * mass
        })
        .sum();
    let inverse = inertia.try_inverse().unwrap();
    let end = 6.0;
    let state: [f64; 12] = std::array::from_fn(|k| match k {
        0..3 => spin[k],
        _ => f64::from(u8::from((k - 3) % 4 == 0)),
    });
    let solved = solve(state, end, |_, state| {
        let spin = Vector3::from_column_slice(&state[..3]);
        let turned = Matrix3::from_column_slice(&state[3..]);
        let change = inverse * -spin.cross(&(inertia * spin));
        let rate = turned * spin.cross_matrix();
        std::array::from_fn(|k| if k < 3 { change[k] } else { rate.as_slice()[k - 3] })
    });
    let turned = Matrix3::from_column_slice(&solved[3..]);
    let corner = centre + thrown * end - turned * centre;
    let off = |steps: usize| {
        let Run { position, energy, momentum, .. } = run(start(), end, steps);
        // Of 1 J and of 0.1 kg m^2/s, after thousands of steps.
        assert!(energy.abs() < 1e-11, "{energy}");
        assert!(momentum.iter().all(|off| off.abs() < 1e-11), "{momentum:?}");
        let edge = (position[1] - position[0]).norm();
        assert!((edge - 0.1).abs() < 1e-11, "an edge of {edge} m");
        (position[0] - corner).norm()
    };
    let [coarse, fine] = [2000, 4000].map(off);
    let order = (coarse / fine).log2();
    assert!((order - 2.0).abs() < 0.1, "order {order}: {coarse} and {fine} m");
}

/// The numbers of its particles in memory mean nothing to a body: one that has the last of them, in another order, moves
/// as one that has them all.
#[test]
fn bodies_have_any_particles() {
    let spin = Vector3::new(0.1, 4.0, 0.05);
    let thrown = |x: &Vector<3>| spin.cross(&(x - Vector::from([0.4, 0.25, 0.15])));
    let alone = run(input([0.8, 0.5, 0.3], [8, 5, 3], thrown), 1.0, 100);
    let mut both = input([0.8, 0.5, 0.3], [8, 5, 3], thrown);
    let (count, far) = (both.particles.len(), Vector::from([5.0, 0.0, 0.0]));
    let first: Vec<Vector<3>> = both.particles.position.iter().map(|x| x - far).collect();
    let second = std::mem::replace(&mut both.particles.position, first);
    both.particles.position.extend(second);
    both.particles.volume.extend_from_within(..);
    both.particles.weight.extend_from_within(..);
    both.particles.spacing.extend_from_within(..);
    both.particles.body.extend((0..count).map(|_| 1));
    both.particles.id.extend(count as u32..2 * count as u32);
    both.radius.extend_from_within(..);
    both.displacement.extend_from_within(..);
    both.velocity.splice(0..0, vec![Vector::from([0.0, 1.0, 0.0]); count]);
    both.group = both.particles.body.clone();
    both.mixture = both.particles.body.clone();
    both.mixtures.extend_from_within(..);
    let backwards = (count as u32..2 * count as u32).rev().collect();
    both.rigid.push(RigidBody {
        name: "second".into(),
        particles: backwards,
        ..RigidBody::default()
    });
    let both = run(both, 1.0, 100);
    for (one, other) in alone.position.iter().zip(&both.position[count..]) {
        assert!((one - other).norm() < 1e-12, "{one} and {other}");
    }
    let risen = both.position[0] - Vector::from([-5.0, 1.0, 0.0]);
    assert!(risen.norm() < 1e-12, "{risen}");
}

/// What is thrown without springs and fluids has no waves to measure its speed by: it falls as far as it falls, and the
/// work of damping is that of a force that stays in each kick, so that the balance is closed to round-off.
#[test]
fn a_body_falls_through_air() {
    let start = || {
        let mut input = input([0.4, 0.4], [4, 4], |_| Vector::from([0.1, 0.0]));
        let pull: [Arc<dyn SpaceTime>; 2] = [Arc::new(0.0), Arc::new(-9.81)];
        input.body_forces = vec![BodyForce { body: None, acceleration: pull }];
        input
    };
    let free = run(start(), 2.0, 200);
    assert!((free.position[0] - Vector::from([0.2, -0.5 * 9.81 * 4.0])).norm() < 1e-11);
    let mut damped = start();
    damped.settings.dissipation.damping = 0.7;
    let damped = run(damped, 2.0, 200);
    // Round-off of some 40 J in each of 200 steps is 2e-12 J.
    assert!(damped.energy.abs() < 1e-11, "{} J of 40 J", damped.energy);
    // The end of exponential decay towards g/d, to the second order of 0.7 of a hundredth.
    let fallen = 9.81 / 0.7 * (2.0 - (1.0 - (-1.4_f64).exp()) / 0.7);
    assert!((damped.position[0][1] + fallen).abs() < 0.007 * fallen, "{}", damped.position[0]);
    let text = r#"
version = 1
title = "Two rigid plates fall"
dimension = 2
[[body]]
name = "first"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 0.5] }
spacing = 0.1
material = { kind = "rigid", density = 10.0 }
initial = { velocity = [0.1, 0.0] }
[[body]]
name = "second"
shape = { kind = "box", min = [-0.3, 2.0], max = [0.7, 2.5] }
spacing = 0.1
material = { kind = "rigid", density = 20.0 }
initial = { velocity = ["-3 * (y - 2.25)", "3 * (x - 0.2)"] }
[scheme]
kind = "total_lagrangian"
[[load]]
kind = "body_force"
acceleration = ["0", "-9.81"]
[time]
end = 1.0
[[probe]]
name = "first"
kind = "particle"
at = [0.0, 0.0]
fields = ["displacement"]
[[probe]]
name = "second"
kind = "particle"
at = [0.7, 2.5]
fields = ["displacement"]
"#;
    let columns = ["first", "second"]
        .map(|name| ["x", "y"].map(|axis| format!("{name}.displacement.{axis}")));
    let names: Vec<&str> = columns.iter().flatten().map(String::as_str).collect();
    let found = values(text, &names);
    let (sin, cos) = 3.0_f64.sin_cos();
    let turned = [0.5 * (cos - 1.0) - 0.25 * sin, 0.25 * (cos - 1.0) + 0.5 * sin];
    let exact = [0.1, -4.905, turned[0], turned[1] - 4.905];
    for (found, exact) in found.iter().zip(exact) {
        assert!((found - exact).abs() < 1e-10, "{found} for {exact}");
    }
}

/// A plate that swings by a corner on a support that moves to and fro. The pendulum's equation is solved in the
/// test.
#[test]
fn a_plate_on_a_hinge_is_a_pendulum() {
    let (lengths, gravity) = ([0.2, 0.6], 9.81);
    let swing = Swing { amplitude: 0.05, frequency: 3.0 };
    let hinge = Vector::from([0.1, 0.6]);
    let start = || {
        let mut input = input(lengths, [4, 12], |_| Vector::zeros());
        input.rigid[0].pivot = Some(hinge);
        input.rigid[0].velocity = vec![(0, Arc::new(swing)), (1, Arc::new(0.0))];
        let pull: [Arc<dyn SpaceTime>; 2] = [Arc::new(0.3 * gravity), Arc::new(-gravity)];
        input.body_forces = vec![BodyForce { body: None, acceleration: pull }];
        input
    };
    let all = start();
    let mass = |a: usize| 2.0 * all.particles.volume[a];
    let arms = || (0..all.particles.len()).map(|a| (mass(a), all.particles.position[a] - hinge));
    let inertia: f64 = arms().map(|(mass, arm)| mass * arm.norm_squared()).sum();
    let moment = -arms().map(|(mass, arm)| mass * arm[1]).sum::<f64>();
    let end = 2.0;
    // The angle from hanging down, with the acceleration of the support.
    let [angle, _] = solve([0.0, moment / inertia * -0.15], end, |t, [angle, rate]| {
        let side = 0.3 * gravity - swing.rate([0.0; 3], t);
        let turn = side * angle.cos() - gravity * angle.sin();
        [*rate, moment / inertia * turn]
    });
    let place = hinge
        + Vector::from([swing.amplitude * (swing.frequency * end).sin(), 0.0])
        + Vector::from([angle.sin(), -angle.cos()]) * 0.6;
    let off = |steps: usize| {
        let Run { position, energy, momentum, .. } = run(start(), end, steps);
        // The bottom's middle, and what the ledgers have lost.
        let momentum = momentum.iter().fold(0.0_f64, |most, off| most.max(off.abs()));
        [(position[2] - place).norm(), energy.abs(), momentum]
    };
    let [coarse, fine] = [1000, 2000].map(off);
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.1, "order {order}: {coarse} and {fine}");
    }
}

/// The first mode of a bar on a rigid body that is as heavy: `tan(q) = -(M/m) q`, from the condition that the
/// force of the bar moves the body.
#[test]
fn a_bar_is_clamped_to_what_moves() {
    let case = r#"
version = 1
title = "A bar on a rigid body"
dimension = 1
[parameters]
ratio = 1.5
q = 1.9071
[[body]]
name = "bar"
shape = { kind = "box", min = [0.0], max = [1.0] }
spacing = 0.01
material = { kind = "linear_elastic", density = 1.0, young_modulus = 1.0, poisson_ratio = 0.0 }
initial = { velocity = ["1e-6 * cos(q * (1 - x))"] }
[[body]]
name = "weight"
shape = { kind = "box", min = [-0.1], max = [0.0] }
spacing = 0.01
material = { kind = "rigid", density = "10 * ratio" }
initial = { velocity = ["1e-6 * cos(q)"] }
[scheme]
kind = "elastodynamics"
form = "adjoint"
joined = true
[time]
end = "2 * pi / q"
[[probe]]
name = "weight"
kind = "particle"
at = [-0.1]
fields = ["displacement", "velocity"]
[[probe]]
name = "end"
kind = "particle"
at = [1.0]
fields = ["displacement", "velocity"]
[output]
every = 1000.0
table_every = 0.01
"#;
    let exact = {
        let (mut low, mut high) = (1.6_f64, 3.1_f64);
        for _ in 0..100 {
            let q = 0.5 * (low + high);
            if q.tan() + 1.5 * q < 0.0 { low = q } else { high = q }
        }
        low
    };
    let case = case.replace("q = 1.9071", &format!("q = {exact}"));
    let found =
        values(&case, &["end.velocity.x", "weight.velocity.x", "momentum.balance.linear.x"]);
    // After a period it is where it was; a spacing at the joint is 1 % of the length, and of the phase 6 %,
    // whose cosine is off by 0.2 %.
    assert!((found[0] / 1e-6 - 1.0).abs() < 0.002, "{found:?}");
    assert!((found[1] / (1e-6 * exact.cos()) - 1.0).abs() < 0.01, "{found:?}");
    assert!(found[2].abs() < 1e-18, "{found:?}");
}

/// A body of 0.32 kg on a spring and a damper that end above its middle: the damped oscillator's formula.
#[test]
fn a_body_hangs_on_a_spring() {
    let (stiffness, damping) = (20.0_f64, 0.4_f64);
    let off = |steps: usize| {
        let mut input = input([0.4, 0.4], [4, 4], |_| Vector::from([0.0, 0.3]));
        input.springs = vec![Spring {
            name: "spring".into(),
            particles: (0..input.particles.len() as u32).collect(),
            anchor: Vector::from([0.2, 1.2]),
            length: 1.0,
            stiffness,
            damping,
        }];
        let mass = 0.32;
        let run = run(input, 2.0, steps);
        let (decay, square) = (0.5 * damping / mass, stiffness / mass);
        let frequency = (square - decay * decay).sqrt();
        let exact = 0.3 / frequency * (-decay * 2.0).exp() * (frequency * 2.0).sin();
        assert!(run.momentum.iter().all(|off| off.abs() < 1e-12), "{:?}", run.momentum);
        // The corner rises as all of it does.
        [(run.position[0][1] - exact).abs(), run.energy.abs()]
    };
    let [coarse, fine] = [400, 800].map(off);
    assert!(fine[0] < 1e-3 && fine[0] < 0.6 * coarse[0], "{coarse:?} {fine:?}");
    // The energy of the spring is in no column: work is what it has given.
    assert!(fine[1] < 1e-12, "{fine:?}");
}
