//! What implicit steps of the upwind formulation cost: `cargo bench -p piola --bench implicit`.
//!
//! `growth` alone measures how a step grows with the number of particles, directly and iteratively,
//! `break-even` where implicit steps cost less than explicit ones, by stiffness and by number of
//! particles. Numbers replace those of particles, `2d`, `3d`, `direct` and `krylov` leave the others
//! out, and `plot=FILE.png` draws the break-even.

#[path = "../tests/support/mod.rs"]
mod support;

use std::f64::consts::PI;
use std::path::Path;
use std::time::Instant;

use piola::Vector;
use piola::output::{Column, Plot, Series, Style};
use piola::schemes::upwind::{BodyForce, ImplicitSettings, Settings, Upwind};
use piola::schemes::{Observation, Scheme, Theta, ThetaScheme};
use piola::solve::LinearMethod;
use piola::time::{Integrator, RungeKutta};
use piola_formulas::volumetric::VolumetricLaw;
use support::{Choice, PLAIN, lattice, varying};

/// Height of the column in m.
const HEIGHT: f64 = 2.5;
/// Modulus of the softest column in Pa, that of U6.
const SOFTEST: f64 = 1e6 / (2.0 * (1.0 - 0.3));
const DENSITY: f64 = 1000.0;
const GRAVITY: f64 = 9.81;
/// Length of an implicit step over the largest stable explicit one, where growth is measured.
const LONG: f64 = 20.0;

/// A column as wide as high that fills a tank, with slip on its walls and its floor, under gravity
/// that grows within 1 s.
fn column<const D: usize>(cells: usize, law: VolumetricLaw, method: LinearMethod) -> Upwind<D> {
    let mut choice = Choice::new(lattice([HEIGHT; D], [cells; D]), law);
    choice.settings = Settings { tau_velocity: 0.5, ..PLAIN };
    choice.implicit = Some(ImplicitSettings { method, ..ImplicitSettings::default() });
    let grown = |t: f64| 0.5 * (1.0 - (PI * t.min(1.0)).cos());
    let acceleration = std::array::from_fn(|axis| {
        let full = if axis + 1 == D { -GRAVITY } else { 0.0 };
        varying(move |_, t| full * grown(t))
    });
    choice.body_forces.push(BodyForce { body: None, acceleration });
    for axis in 0..D {
        choice = choice.fix(axis, |x| x[axis] == 0.0 || (axis + 1 < D && x[axis] == HEIGHT));
    }
    choice.build(|_| Vector::zeros())
}

/// The largest stable explicit step in s.
fn stable<const D: usize>(scheme: &mut Upwind<D>) -> f64 {
    let (state, mut limits) = (scheme.initial_state(), Vec::new());
    scheme.inspect(&state, &mut limits);
    limits.iter().map(|limit| limit.step).fold(f64::INFINITY, f64::min)
}

/// Wall time in s and what `run` gives.
fn timed<T>(run: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = run();
    (start.elapsed().as_secs_f64(), result)
}

fn growth<const D: usize>(particles: usize, name: &str, method: LinearMethod) -> (usize, f64) {
    let law = VolumetricLaw::gamma_law(SOFTEST, 7.0).expect("a sound material");
    let cells = (particles as f64).powf(1.0 / D as f64).round() as usize - 1;
    let (set_up, mut scheme) = timed(|| column::<D>(cells, law, method));
    let step = LONG * stable(&mut scheme);
    let (mut old, steps) = (scheme.initial_state(), 3);
    let mut new = old.clone();
    let figures = old.len() - 2;
    let (mut newton, mut krylov) = (0.0, 0.0);
    let (seconds, ()) = timed(|| {
        for count in 0..steps {
            // Where gravity grows fastest.
            let time = 0.4 + f64::from(count) * step;
            scheme.advance(&Theta::CRANK_NICOLSON, time, step, &old, &mut new).expect("a state");
            newton += new[figures];
            krylov += new[figures + 1];
            std::mem::swap(&mut old, &mut new);
        }
    });
    let costs = scheme.linear_costs().unwrap_or_default();
    let (count, each) = (scheme.particle_count(), seconds / f64::from(steps));
    let per_step = f64::from(steps);
    println!(
        "{D:>2} {name:>7} {count:>9} {set_up:>9.2} {:>10.1} {:>7.1} {each:>10.4} {:>10.2} \
         {:>9} {:>8.2}",
        newton / per_step,
        krylov / per_step,
        1e6 * each / count as f64,
        costs.factor_entries,
        scheme.memory() as f64 / count as f64 / 1024.0,
    );
    (count, each)
}

fn all_growth<const D: usize>(sizes: &[usize], name: &str, method: LinearMethod) {
    let rows: Vec<(usize, f64)> = sizes.iter().map(|&n| growth::<D>(n, name, method)).collect();
    for pair in rows.windows(2) {
        let [(small, quick), (large, slow)] = [pair[0], pair[1]];
        let power = (slow / quick).ln() / (large as f64 / small as f64).ln();
        println!("   {name} from {small} to {large} particles: a step grows as N^{power:.2}");
    }
}

/// Explicit over implicit wall time of a column with this many particles, and how far the implicit
/// settlement is from the exact one, as a share of it.
fn settle(particles: usize, stiffness: f64) -> [f64; 2] {
    let cells = (particles as f64).sqrt().round() as usize - 1;
    let law = VolumetricLaw::linear(stiffness * SOFTEST).expect("a sound material");
    let mut scheme = column::<2>(cells, law, LinearMethod::Automatic);
    let mut state = scheme.initial_state();
    let mut new = state.clone();
    let top = (0..scheme.particle_count())
        .find(|&a| scheme.particle(a).reference[1] == HEIGHT)
        .expect("a particle at the top");
    let steps = 5;
    let (implicit, ()) = timed(|| {
        for count in 0..steps {
            let step = 1.0 / f64::from(steps);
            let time = f64::from(count) * step;
            scheme.advance(&Theta::BACKWARD_EULER, time, step, &state, &mut new).expect("a state");
            std::mem::swap(&mut state, &mut new);
        }
    });
    let position = Observation::new(&mut scheme, 1.0, &state).values("displacement", &[top as u32]);
    let exact = -DENSITY * GRAVITY * HEIGHT * HEIGHT / (2.0 * stiffness * SOFTEST);
    // Explicit steps are all alike: some of them tell what all cost.
    let step = 0.3 * stable(&mut scheme);
    let mut integrator = RungeKutta::tvd_rk2(state.len());
    let mut state = scheme.initial_state();
    let tried = (2_000_000 / particles).clamp(20, 2000) as u32;
    let (some, ()) = timed(|| {
        for count in 0..tried {
            let time = f64::from(count) * step;
            integrator.step(&mut scheme, time, step, &state, &mut new).expect("explicit");
            std::mem::swap(&mut state, &mut new);
        }
    });
    let explicit = some / f64::from(tried) / step;
    let error = position[1] / exact - 1.0;
    println!(
        "{particles:>9} {stiffness:>9.0e} {:>10.0} {explicit:>11.3} {implicit:>11.5} {:>9.1} \
         {:>9.2}",
        1.0 / step,
        explicit / implicit,
        100.0 * error
    );
    [explicit / implicit, error]
}

fn break_even(sizes: &[usize], plot: Option<&str>) {
    println!("particles stiffness   explicit  explicit, s implicit, s     ratio  off by, %");
    let mut series: Vec<Series> = Vec::new();
    for &particles in sizes {
        let points = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5];
        let points = points.map(|it: f64| [it.log10(), settle(particles, it)[0].log10()]);
        let column = Column::new(format!("{particles} particles"), "log10 of the ratio");
        series.push(Series { column, points: points.to_vec(), style: Style::Line });
    }
    let Some(path) = plot else { return };
    let even = Column::new("break-even", "log10 of the ratio");
    series.push(Series {
        column: even,
        points: vec![[0.0, 0.0], [5.0, 0.0]],
        style: Style::Dashes,
    });
    let plot = Plot {
        title: "Explicit over implicit wall time of a column that settles in 1 s".into(),
        abscissa: Column::new("log10 of the stiffness over that of U6", ""),
        series,
    };
    if let Err(error) = plot.write_png(Path::new(path)) {
        eprintln!("{error}");
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let asked = |name: &str| arguments.iter().any(|argument| argument == name);
    let wants = |name: &str, other: &str| asked(name) || !asked(other);
    let numbers = arguments.iter().filter_map(|it| it.parse::<f64>().ok());
    let sizes: Vec<usize> = numbers.map(|number| number as usize).collect();
    println!("{} threads", rayon::current_num_threads());
    if wants("growth", "break-even") {
        println!(
            " D  method particles set up, s iterations   GMRES  a step, s us/particle  factors \
             kB/particle"
        );
        let of = |usual: &[usize]| if sizes.is_empty() { usual.to_vec() } else { sizes.clone() };
        for (name, other, method) in
            [("direct", "krylov", LinearMethod::Direct), ("krylov", "direct", LinearMethod::Krylov)]
        {
            if !wants(name, other) {
                continue;
            }
            if wants("2d", "3d") {
                all_growth::<2>(&of(&[1000, 10_000, 100_000]), name, method);
            }
            if wants("3d", "2d") {
                let most = if name == "direct" { 2 } else { 3 };
                all_growth::<3>(&of(&[1000, 10_000, 100_000][..most]), name, method);
            }
        }
    }
    if wants("break-even", "growth") {
        let plot = arguments.iter().find_map(|argument| argument.strip_prefix("plot="));
        let usual = [100, 1000, 10_000];
        break_even(if sizes.is_empty() { &usual } else { &sizes }, plot);
    }
}
