//! Convergence of the upwind formulation to manufactured and exact solutions.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::support::{Choice, Function, PLAIN, lattice, march, march_from, places, rows, varying};
use nalgebra::Matrix2;
use num_dual::{Dual, Dual64, DualNum};
use piola::Vector;
use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::schemes::upwind::{BodyForce, Settings, Upwind};
use piola::schemes::{Observation, Scheme};
use piola_formulas::tensor::{cofactor, determinant};
use piola_formulas::volumetric::{VolumetricLaw, VolumetricResponse};

/// Numbers with derivatives of derivatives.
type Twice = Dual<Dual64>;

/// Unit density and wave speed.
fn law() -> VolumetricLaw {
    VolumetricLaw::gamma_law_from_wave_speed(1.0, 1.0, 7.0).expect("a sound material")
}

/// Current position of the reference position `x` at time `t`: the same motion for periodic and
/// bounded bodies, with nothing special at the faces. Strains reach 0.2.
fn motion<T: DualNum<Primitive = f64> + Copy>(x: [T; 2], t: T) -> [T; 2] {
    let (kx, ky) = (x[0] * (2.0 * PI), x[1] * (2.0 * PI));
    let first = (t * 3.0).sin() * (kx + 0.3).sin() * ky.cos() * 0.02;
    let second = (t * 4.0).sin() * (kx - 0.7).cos() * (ky + 0.5).sin() * 0.02;
    [x[0] + first, x[1] + second]
}

fn lift(value: Dual64, slope: f64) -> Twice {
    Dual::new(value, Dual64::from_re(slope))
}

/// Deformation gradient by dual numbers.
fn deformation(x: [Dual64; 2], t: Dual64) -> Matrix2<Dual64> {
    let column = |j: usize| {
        let seed = |k: usize| lift(x[k], f64::from(j == k));
        motion([seed(0), seed(1)], lift(t, 0.0)).map(|component| component.eps)
    };
    let (first, second) = (column(0), column(1));
    Matrix2::new(first[0], second[0], first[1], second[1])
}

/// First Piola-Kirchhoff stress `-p(det F) cof F`.
fn stress(x: [Dual64; 2], t: Dual64) -> Matrix2<Dual64> {
    let f = deformation(x, t);
    let pressure = law().pressure(determinant(&f));
    cofactor(&f).map(|h| -pressure * h)
}

/// Velocity and its rate.
fn velocity(x: [f64; 3], t: f64, component: usize) -> [f64; 2] {
    let place = |k: usize| lift(Dual64::from_re(x[k]), 0.0);
    let time = lift(Dual64::from_re(t).derivative(), 1.0);
    let position = motion([place(0), place(1)], time)[component];
    [position.eps.re, position.eps.eps]
}

/// The acceleration that the body needs from outside: `dv/dt - DIV P / rho`.
fn source(x: [f64; 3], t: f64, component: usize) -> f64 {
    let divergence: f64 = (0..2)
        .map(|j| {
            let seed = |k: usize| Dual64::new(x[k], f64::from(j == k));
            stress([seed(0), seed(1)], Dual64::from_re(t))[(component, j)].eps
        })
        .sum();
    velocity(x, t, component)[1] - divergence
}

fn driven(particles: Particles<2>, settings: Settings) -> Choice<2> {
    let mut choice = Choice::new(particles, law());
    choice.density = 1.0;
    choice.settings = settings;
    choice.body_forces.push(BodyForce {
        body: None,
        acceleration: std::array::from_fn(|k| varying(move |x, t| source(x, t, k))),
    });
    choice
}

fn start(choice: Choice<2>) -> Upwind<2> {
    let component = |x: &Vector<2>, k: usize| velocity([x[0], x[1], 0.0], 0.0, k)[0];
    choice.build(|x| Vector::<2>::new(component(x, 0), component(x, 1)))
}

/// The unit square, periodic both ways.
fn periodic(n: usize, settings: Settings) -> Upwind<2> {
    let spacing = 1.0 / n as f64;
    let length = 1.0 - spacing;
    let mut particles = lattice([length, length], [n - 1, n - 1]);
    particles.volume.fill(spacing * spacing);
    let mut choice = driven(particles, settings);
    choice.domain = Domain::new([Some([0.0, 1.0]); 2]).expect("a sound box");
    start(choice)
}

/// The unit square between walls that move as prescribed, in both directions. Faces under dead
/// tractions are no test: with `p` not zero a material without shear stiffness has surface modes
/// there that grow as `exp(k sqrt(|p|/rho) t)`, the faster the shorter.
fn walled(n: usize, settings: Settings) -> Upwind<2> {
    let mut choice = driven(lattice([1.0, 1.0], [n, n]), settings);
    for component in 0..2 {
        let value = Arc::new(Function {
            value: move |x, t| velocity(x, t, component)[0],
            rate: move |x, t| velocity(x, t, component)[1],
        });
        let on_face = |x: &f64| *x < 1e-9 || *x > 1.0 - 1e-9;
        choice = choice.prescribe(component, value, move |x| x.iter().any(on_face));
    }
    start(choice)
}

/// Root mean square errors, over all volume, of velocity, evolved J and position at `END`.
fn errors(mut scheme: Upwind<2>, steps: usize) -> [f64; 3] {
    const END: f64 = 0.4;
    let state = march(&mut scheme, END / steps as f64, steps);
    let (count, length) = (scheme.particle_count(), scheme.width());
    let unknowns = rows(&places(&scheme), &state);
    let all: Vec<u32> = (0..count as u32).collect();
    let volumes = Observation::new(&mut scheme, END, &state).values("volume", &all);
    let mut sums = [0.0; 3];
    for (a, volume) in volumes.iter().enumerate() {
        let reference = scheme.particle(a).reference;
        let (place, row) = ([reference[0], reference[1], 0.0], &unknowns[a * length..][..length]);
        let dual = [reference[0], reference[1]].map(Dual64::from_re);
        let ratio = determinant(&deformation(dual, Dual64::from_re(END))).re;
        let position = motion([reference[0], reference[1]], END);
        sums[1] += volume * (row[2] - ratio).powi(2);
        for k in 0..2 {
            sums[0] += volume * (row[k] - velocity(place, END, k)[0]).powi(2);
            sums[2] += volume * (row[3 + k] - position[k]).powi(2);
        }
    }
    sums.map(f64::sqrt)
}

/// Asserts the order of the errors of velocity, volume ratio and position, from 24 intervals to
/// 48 with steps in proportion.
fn assert_orders(body: impl Fn(usize) -> Upwind<2>, within: std::ops::Range<f64>) {
    let [coarse, fine] = [24, 48].map(|n| errors(body(n), 2 * n));
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        let order = (coarse / fine).log2();
        assert!(within.contains(&order), "order {order}: {coarse} to {fine}");
    }
}

fn upwinded(reconstruction: bool) -> Settings {
    Settings { tau_velocity: 0.5, tau_pressure: 0.5, reconstruction, ..PLAIN }
}

/// Central differences on the narrow stencil, and a method of second order in time.
#[test]
fn the_plain_scheme_is_of_second_order() {
    assert_orders(|n| periodic(n, PLAIN), 1.9..2.1);
    assert_orders(|n| walled(n, PLAIN), 1.9..2.1);
}

/// Jumps of order dx between neighbours make an error of order dx; 0.75 because at 24 intervals
/// the pressures still carry a good part of second order.
#[test]
fn upwinding_without_reconstruction_is_of_first_order() {
    assert_orders(|n| periodic(n, upwinded(false)), 0.75..1.1);
    assert_orders(|n| walled(n, upwinded(false)), 0.75..1.1);
}

/// Reconstructed jumps are of order dx^3 and their differences of dx^4, an error of order dx^3
/// beside that of second order: both are seen at 24 intervals.
#[test]
fn upwinding_with_reconstruction_is_of_second_order() {
    assert_orders(|n| periodic(n, upwinded(true)), 1.9..2.4);
    assert_orders(|n| walled(n, upwinded(true)), 1.9..2.4);
}

/// Two constant states of a linear bar of unit density and wave speed; their star state from what
/// the waves carry: `p + v` from the left, `p - v` from the right.
const LEFT: (f64, f64) = (0.3, 0.1); // velocity, pressure
const RIGHT: (f64, f64) = (-0.2, 0.4);
const STAR: (f64, f64) =
    (0.5 * (LEFT.1 + LEFT.0 - RIGHT.1 + RIGHT.0), 0.5 * (LEFT.1 + LEFT.0 + RIGHT.1 - RIGHT.0));

/// Mean error of velocity and pressure over the middle half of the bar, where the ends are not yet
/// felt, and the largest error near the middle, which lies in the star state.
fn riemann_errors(n: usize) -> (f64, f64) {
    let mut choice = Choice::new(lattice([1.0], [n]), VolumetricLaw::linear(1.0).expect("sound"));
    choice.density = 1.0;
    choice.settings = Settings { tau_velocity: 1.0, tau_pressure: 1.0, ..PLAIN };
    let mut scheme = choice.build(|_| Vector::<1>::zeros());
    let mut state = scheme.initial_state();
    let place = |a: usize| a as f64 / n as f64 - 0.5;
    let places = places(&scheme);
    for a in 0..=n {
        let (velocity, pressure) = if place(a) < 0.0 { LEFT } else { RIGHT };
        state[places[4 * a]] = velocity;
        state[places[4 * a + 1]] = 1.0 - pressure;
    }
    let (end, steps) = (0.2, n);
    let state = march_from(&mut scheme, state, end / steps as f64, steps, |_, _| {});
    let (mut sum, mut largest) = (0.0, 0.0_f64);
    for a in n / 4..=3 * n / 4 {
        let exact = match place(a) {
            x if x < -end => LEFT,
            x if x > end => RIGHT,
            _ => STAR,
        };
        let [velocity, ratio] = [0, 1].map(|k| state[places[4 * a + k]]);
        let error = (velocity - exact.0).abs() + (1.0 - ratio - exact.1).abs();
        sum += error / n as f64;
        if place(a).abs() < 0.05 {
            largest = largest.max(error);
        }
    }
    (sum, largest)
}

/// With full upwinding the scheme is Godunov's: a jump spreads over `sqrt(c t dx)`, so that the
/// mean error falls with the root of dx, and the star state stands clear of both fronts.
#[test]
fn a_riemann_problem_converges_to_the_exact_solution() {
    let [coarse, fine] = [205, 821].map(riemann_errors);
    let order = (coarse.0 / fine.0).log2() / (821.0_f64 / 205.0).log2();
    assert!((0.45..0.55).contains(&order), "{order}: {} to {}", coarse.0, fine.0);
    assert!(fine.1 < 1e-9, "{}", fine.1);
}

/// Halving the step divides the change of the solution by four: a bar of 20 intervals that shakes
/// with strains of a quarter under the gamma law.
#[test]
fn the_integrator_is_of_second_order_in_time() {
    for settings in [PLAIN, upwinded(false), upwinded(true)] {
        let solve = |steps: usize| {
            let mut choice = Choice::new(lattice([1.0], [20]), law()).fix(0, |x| x[0] < 1e-9);
            choice.density = 1.0;
            choice.settings = settings;
            let mut scheme = choice.build(|x| Vector::<1>::new(0.3 * (0.5 * PI * x[0]).sin()));
            march(&mut scheme, 1.5 / steps as f64, steps)
        };
        let [coarse, middle, fine] = [200, 400, 800].map(solve);
        let distance = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
        };
        let ratio = distance(&coarse, &middle) / distance(&middle, &fine);
        assert!((3.8..4.2).contains(&ratio), "{settings:?}: {ratio}");
    }
}
