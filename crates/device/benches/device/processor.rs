//! The same passes on the processor.

use std::num::NonZero;
use std::thread::{available_parallelism, scope};
use std::time::Instant;

use piola_device::passes::Rows;
use piola_device::passes::fluid::Fluid;
use piola_device::passes::solid::{Body, Solid};
use piola_formulas::Number;

use super::cloud;

/// Spacing of particles in m.
pub const SPACING: f64 = 0.01;
/// Support radius of the fluid over it: 82 neighbours inside.
pub const FLUID_RADIUS: f64 = 2.7;
/// Support radius of the solid over it: 75 neighbours inside.
pub const SOLID_RADIUS: f64 = 2.62;

/// Threads of this machine.
pub fn threads() -> usize {
    available_parallelism().map_or(1, NonZero::get)
}

/// Fills an array on some threads.
fn fill<T: Send>(threads: usize, all: &mut [T], fill: impl Fn(usize, &mut [T]) + Sync) {
    let share = all.len().div_ceil(threads).max(1);
    scope(|scope| {
        for (number, part) in all.chunks_mut(share).enumerate() {
            let fill = &fill;
            scope.spawn(move || fill(number * share, part));
        }
    });
}

/// What particles of a fluid show at the start: a few waves.
pub fn sides(positions: &[[f64; 3]]) -> Vec<[f64; 8]> {
    let wave = |x: f64, y: f64| (7.0 * x + 3.0 * y).sin();
    let side = |[x, y, z]: &[f64; 3]| {
        let density = 1000.0 + wave(*z, *x);
        [*x, *y, *z, wave(*y, *z), wave(*z, *x), wave(*x, *y), density, 400.0 * (density - 1000.0)]
    };
    positions.iter().map(side).collect()
}

/// Velocities and displacements of a solid at the start.
pub fn states(positions: &[[f64; 3]]) -> Vec<([f64; 3], [f64; 3])> {
    let wave = |x: f64, y: f64| (7.0 * x + 3.0 * y).sin();
    let state = |[x, y, z]: &[f64; 3]| {
        let mode = [wave(*y, *z), wave(*z, *x), wave(*x, *y)];
        (mode, mode.map(|u| 5e-3 * u))
    };
    positions.iter().map(state).collect()
}

/// Steps of a fluid in numbers of some type.
pub fn fluid_steps<T: Number + Send + Sync>(
    fluid: &Fluid,
    rows: &Rows,
    sides: &[[f64; 8]],
    steps: usize,
) -> Vec<[T; 8]> {
    let mut sides: Vec<[T; 8]> = sides.iter().map(|side| side.map(T::from)).collect();
    let mut sums = vec![[T::zero(); 7]; sides.len()];
    for _ in 0..steps {
        fill(threads(), &mut sums, |first, part| fluid.fill(&sides, rows, first, part));
        for (side, sums) in sides.iter_mut().zip(&sums) {
            *side = fluid.advance(side, sums);
        }
    }
    sides
}

/// A state of a solid.
pub type State<T> = ([T; 3], [T; 3]);

/// Steps of a solid in numbers of some type.
pub fn solid_steps<T: Number + Send + Sync>(
    solid: &Solid,
    body: &Body,
    states: &[State<f64>],
    steps: usize,
) -> Vec<State<T>> {
    let mut states: Vec<State<T>> =
        states.iter().map(|(v, u)| (v.map(T::from), u.map(T::from))).collect();
    let mut tensions = vec![[T::zero(); 9]; states.len()];
    for _ in 0..steps {
        let displacement: Vec<[T; 3]> = states.iter().map(|(_, u)| *u).collect();
        fill(threads(), &mut tensions, |first, part| {
            solid.fill_tensions(body, &displacement, first, part);
        });
        fill(threads(), &mut states, |first, part| solid.advance(body, &tensions, first, part));
    }
    states
}

/// Best of some times in ms.
fn best(count: usize, mut work: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        work();
        1e3 * start.elapsed().as_secs_f64()
    };
    (0..count).map(time).fold(f64::INFINITY, f64::min)
}

/// Times of both passes on one thread and on all.
pub fn measure(side: usize) {
    let positions = cloud::cube(side, SPACING);
    let rows = cloud::neighbors(&positions, FLUID_RADIUS * SPACING);
    let (fluid, sides) = (Fluid::water(SPACING), sides(&positions));
    let mut sums = vec![[0.0; 7]; sides.len()];
    for threads in [1, threads()] {
        let time = best(3, || {
            fill(threads, &mut sums, |first, part| fluid.fill(&sides, &rows, first, part));
        });
        let pairs = rows.neighbors.len() as f64;
        println!(
            "processor, {threads} threads, fluid sums: {time:.1} ms, {:.2} ns a pair",
            1e6 * time / pairs
        );
    }
    let body = cloud::body(&positions, SOLID_RADIUS * SPACING, SPACING.powi(3), 1000.0);
    let (solid, states) = (Solid::rubber(), states(&positions));
    let displacement: Vec<[f64; 3]> = states.iter().map(|(_, u)| *u).collect();
    let (mut tensions, mut next) = (vec![[0.0; 9]; states.len()], states);
    for threads in [1, threads()] {
        let time = best(3, || {
            fill(threads, &mut tensions, |first, part| {
                solid.fill_tensions(&body, &displacement, first, part);
            });
            fill(threads, &mut next, |first, part| solid.advance(&body, &tensions, first, part));
        });
        let pairs = body.rows.neighbors.len() as f64;
        println!(
            "processor, {threads} threads, solid step: {time:.1} ms, {:.2} ns a pair",
            1e6 * time / pairs
        );
    }
}
