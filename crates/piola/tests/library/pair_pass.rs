//! The rates of the upwind formulation against sums written out from the operators and the pair
//! laws, particle by particle: theory (8) to (13) without anything that makes them fast.

use crate::support::{Choice, disturbed, jittered, lattice, places, rows};
use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::operators::{Correction, GradientOperator, LeastSquares, Support};
use piola::schemes::Scheme;
use piola::schemes::upwind::{Settings, WaveSpeed};
use piola::{Tensor, Vector};
use piola_formulas::kernels::Kernel;
use piola_formulas::riemann::{Interface, stretched_wave_speed};
use piola_formulas::tensor::{cofactor, right_cauchy_green, smallest_eigenvalue};
use piola_formulas::volumetric::{VolumetricLaw, VolumetricResponse};

const DENSITY: f64 = 1000.0;
const SPEED: f64 = 10.0;

fn law() -> VolumetricLaw {
    VolumetricLaw::gamma_law_from_wave_speed(SPEED, DENSITY, 7.0).expect("a sound material")
}

/// The unknowns of one particle and what follows from them alone.
struct State<const D: usize> {
    velocity: Vector<D>,
    position: Vector<D>,
    cofactor: Tensor<D>,
    pressure: f64,
    wave_speed: f64,
}

impl<const D: usize> State<D> {
    fn new(row: &[f64], stretched: WaveSpeed) -> Self {
        let f = Tensor::<D>::from_fn(|i, j| row[2 * D + 1 + i * D + j]);
        let smallest: f64 = smallest_eigenvalue(&right_cauchy_green(&f));
        Self {
            velocity: Vector::from_column_slice(&row[..D]),
            position: Vector::from_column_slice(&row[D + 1..2 * D + 1]),
            cofactor: cofactor(&f),
            pressure: law().pressure(row[D]),
            wave_speed: match stretched {
                WaveSpeed::Constant => SPEED,
                WaveSpeed::Stretch => stretched_wave_speed(SPEED, smallest),
            },
        }
    }
}

/// The parts that the scheme is made of, and the state of all particles.
struct Parts<'a, const D: usize> {
    particles: &'a Particles<D>,
    settings: Settings,
    support: Support<D>,
    operator: GradientOperator<D>,
    least_squares: LeastSquares<D>,
    states: Vec<State<D>>,
}

impl<const D: usize> Parts<'_, D> {
    fn separation(&self, a: usize, b: usize) -> Vector<D> {
        self.support.separation(&self.particles.position, a, b as u32)
    }

    /// Least-squares gradients of velocity and pressure, theory (4).
    fn slopes(&self, a: usize) -> (Tensor<D>, Vector<D>) {
        let (mut velocity, mut pressure) = (Tensor::<D>::zeros(), Vector::<D>::zeros());
        for &b in self.support.list.row(a) {
            let (me, other) = (&self.states[a], &self.states[b as usize]);
            let d = self.separation(a, b as usize);
            velocity += (other.velocity - me.velocity) * d.transpose() / d.norm_squared();
            pressure += d * (other.pressure - me.pressure) / d.norm_squared();
        }
        let inverse = self.least_squares.inverse(a);
        (velocity * inverse.transpose(), inverse * pressure)
    }

    /// Rates of v, J and F of particle a.
    fn rates(&self, a: usize) -> (Vector<D>, f64, Tensor<D>) {
        let (me, volume) = (&self.states[a], &self.particles.volume);
        let range = self.support.list.range(a);
        let mut force = me.cofactor * self.operator.diagonal(a) * (me.pressure * volume[a]);
        let mut volume_rate = 0.0;
        let mut deformation_rate = Tensor::<D>::zeros();
        let pairs = self.operator.forward(range.clone()).iter().zip(self.operator.adjoint(range));
        for (&b, (g, transposed)) in self.support.list.row(a).iter().zip(pairs) {
            let b = b as usize;
            let other = &self.states[b];
            let (g, transposed) = (Vector::from(*g), Vector::from(*transposed));
            let reference = self.separation(a, b);
            let current = self.support.domain.separation(&me.position, &other.position);
            let mut velocity_jump = other.velocity - me.velocity;
            let mut pressure_jump = other.pressure - me.pressure;
            force += other.cofactor * transposed * (other.pressure * volume[b]);
            deformation_rate += velocity_jump * g.transpose();
            if self.settings.reconstruction {
                let (mine, theirs) = (self.slopes(a), self.slopes(b));
                velocity_jump -= (mine.0 + theirs.0) * reference * 0.5;
                pressure_jump -= (mine.1 + theirs.1).dot(&reference) * 0.5;
            }
            let impedance = DENSITY * me.wave_speed.max(other.wave_speed);
            let interface = Interface::new(current, reference, impedance);
            let areas = [&(g * volume[a]), &(transposed * volume[b])];
            let cofactors = [&me.cofactor, &other.cofactor];
            force += interface.force(&velocity_jump, &(areas[0] - areas[1]))
                * self.settings.tau_velocity;
            volume_rate +=
                interface.volume_rate(pressure_jump, cofactors, areas) * self.settings.tau_pressure;
        }
        let acceleration = force / (DENSITY * volume[a]);
        let ratio_rate = me.cofactor.dot(&deformation_rate) + volume_rate / volume[a];
        (acceleration, ratio_rate, deformation_rate)
    }
}

fn compare<const D: usize>(
    particles: Particles<D>,
    smoothing_ratio: f64,
    settings: Settings,
    domain: Domain<D>,
) {
    let mut choice = Choice::new(particles.clone(), law());
    choice.smoothing_ratio = smoothing_ratio;
    choice.settings = settings;
    choice.domain = domain;
    let mut scheme = choice.build(|_| Vector::zeros());
    let state = disturbed(&scheme, 0.03);
    let mut rate = vec![0.0; state.len()];
    scheme.rates(0.0, &state, &mut rate);

    let support = Support::new(&particles, Kernel::CubicSpline, smoothing_ratio, domain)
        .expect("the neighbours can be found");
    let length = scheme.width();
    let places = places(&scheme);
    let (state, rate) = (rows(&places, &state), rows(&places, &rate));
    let rows = state.chunks_exact(length);
    let parts = Parts {
        operator: GradientOperator::new(&particles, &support, settings.correction)
            .expect("the gradient exists"),
        least_squares: LeastSquares::new(&particles, &support).expect("the slopes exist"),
        states: rows.map(|row| State::new(row, settings.wave_speed)).collect(),
        particles: &particles,
        settings,
        support,
    };
    let expected: Vec<_> = (0..particles.len()).map(|a| parts.rates(a)).collect();
    let largest = |size: fn(&(Vector<D>, f64, Tensor<D>)) -> f64| {
        expected.iter().map(size).fold(0.0, f64::max)
    };
    let sizes = [
        largest(|(acceleration, _, _)| acceleration.norm()),
        largest(|(_, ratio_rate, _)| ratio_rate.abs()),
        largest(|(_, _, deformation_rate)| deformation_rate.norm()),
    ];
    for (a, (acceleration, ratio_rate, deformation_rate)) in expected.iter().enumerate() {
        let row = &rate[a * length..][..length];
        let found = Vector::<D>::from_column_slice(&row[..D]);
        let found_f = Tensor::<D>::from_fn(|i, j| row[2 * D + 1 + i * D + j]);
        let what = format!("{D}D {settings:?} h/dx {smoothing_ratio}, particle {a}");
        assert!((found - acceleration).norm() < 1e-13 * sizes[0], "{what}: {found}");
        assert!((row[D] - ratio_rate).abs() < 1e-13 * sizes[1], "{what}: {}", row[D]);
        assert!((found_f - deformation_rate).norm() < 1e-13 * sizes[2], "{what}: {found_f}");
        assert_eq!(row[D + 1..2 * D + 1], state[a * length..][..D], "{what}");
    }
}

/// Calls `compare` with every combination of switches.
fn for_all_switches(mut compare: impl FnMut(Settings)) {
    for [tau_velocity, tau_pressure] in [[0.0, 0.0], [0.7, 0.0], [0.0, 0.4], [0.7, 0.4]] {
        for reconstruction in [false, true] {
            for wave_speed in [WaveSpeed::Constant, WaveSpeed::Stretch] {
                compare(Settings {
                    correction: Correction::Gradient,
                    tau_velocity,
                    tau_pressure,
                    reconstruction,
                    wave_speed,
                });
            }
        }
    }
}

/// Numbers of neighbours that do and do not fill whole blocks of lanes, in 1D from 2 to 11.
#[test]
fn rates_are_the_sums_of_the_pair_laws() {
    for_all_switches(|settings| {
        for smoothing_ratio in [0.7, 1.4, 2.7] {
            compare(jittered([10.0], [20], 0.2), smoothing_ratio, settings, Domain::open());
        }
        compare(jittered([1.0, 2.0], [6, 12], 0.1), 1.4, settings, Domain::open());
        compare(jittered([1.0, 1.0, 1.5], [4, 4, 6], 0.1), 1.2, settings, Domain::open());
    });
}

#[test]
fn rates_are_the_sums_of_the_pair_laws_for_every_correction() {
    for correction in Correction::ALL {
        for_all_switches(|settings| {
            let settings = Settings { correction, ..settings };
            compare(jittered([1.0, 2.0], [6, 12], 0.1), 1.4, settings, Domain::open());
        });
    }
}

/// The bounds lie one spacing beyond the last particles, and a few pairs reach across them.
#[test]
fn rates_are_the_sums_of_the_pair_laws_in_periodic_boxes() {
    let line = Domain::new([Some([0.0, 10.5])]).expect("a sound box");
    let torus = Domain::new([Some([0.0, 1.125]), None]).expect("a sound box");
    let cube = Domain::new([Some([0.0, 1.25]), Some([0.0, 1.25]), Some([0.0, 1.75])]);
    let cube = cube.expect("a sound box");
    for_all_switches(|settings| {
        compare(lattice([10.0], [20]), 1.4, settings, line);
        compare(lattice([1.0, 2.0], [8, 16]), 1.4, settings, torus);
        compare(jittered([1.0, 1.0, 1.5], [4, 4, 6], 0.1), 1.2, settings, cube);
    });
}
