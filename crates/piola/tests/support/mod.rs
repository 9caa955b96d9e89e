//! Particles and schemes that several tests build.
#![allow(dead_code, reason = "each test binary uses a part of it")]

use std::sync::Arc;

use piola::Vector;
use piola::boundaries::{PrescribedVelocity, SpaceTime, Traction};
use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::operators::{Correction, Support};
use piola::schemes::upwind::{
    BodyForce, ImplicitSettings, Initial, Material, Settings, Upwind, UpwindInput, WaveSpeed,
};
use piola::schemes::{Ledger, Scheme};
use piola::time::IntegratorKind;
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::VolumetricLaw;

/// A box lattice with particles on its faces: whole cells as weights, and half a cell in volume
/// for each face a particle lies on.
pub fn lattice<const D: usize>(lengths: [f64; D], intervals: [usize; D]) -> Particles<D> {
    let mut particles = Particles::default();
    let count: usize = intervals.iter().map(|n| n + 1).product();
    for number in 0..count {
        let (mut rest, mut position, mut volume, mut weight) = (number, Vector::zeros(), 1.0, 1.0);
        for axis in 0..D {
            let (index, n) = (rest % (intervals[axis] + 1), intervals[axis]);
            rest /= n + 1;
            let cell = lengths[axis] / n as f64;
            position[axis] = lengths[axis] * index as f64 / n as f64;
            weight *= cell;
            volume *= if index == 0 || index == n { 0.5 * cell } else { cell };
        }
        particles.position.push(position);
        particles.volume.push(volume);
        particles.weight.push(weight);
        let largest = (0..D).map(|k| lengths[k] / intervals[k] as f64).fold(0.0, f64::max);
        particles.spacing.push(largest);
        particles.body.push(0);
        particles.id.push(number as u32);
    }
    particles
}

/// Settings without stabilisation.
pub const PLAIN: Settings = Settings {
    correction: Correction::Gradient,
    tau_velocity: 0.0,
    tau_pressure: 0.0,
    reconstruction: false,
    wave_speed: WaveSpeed::Constant,
};

/// What a test chooses of a scheme.
pub struct Choice<const D: usize> {
    pub particles: Particles<D>,
    pub smoothing_ratio: f64,
    pub settings: Settings,
    pub law: VolumetricLaw,
    pub density: f64,
    pub gravity: Vector<D>,
    pub body_forces: Vec<BodyForce<D>>,
    pub tractions: Vec<Traction<D>>,
    pub prescribed: Vec<PrescribedVelocity>,
    pub domain: Domain<D>,
    pub implicit: Option<ImplicitSettings>,
}

impl<const D: usize> Choice<D> {
    pub fn new(particles: Particles<D>, law: VolumetricLaw) -> Self {
        Self {
            particles,
            smoothing_ratio: 0.7,
            settings: PLAIN,
            law,
            density: 1000.0,
            gravity: Vector::zeros(),
            body_forces: Vec::new(),
            tractions: Vec::new(),
            prescribed: Vec::new(),
            domain: Domain::open(),
            implicit: None,
        }
    }

    /// Prescribes a zero velocity component of all particles that `on` selects.
    pub fn fix(self, component: usize, on: impl Fn(&Vector<D>) -> bool) -> Self {
        self.prescribe(component, Arc::new(0.0), on)
    }

    /// Prescribes a velocity component of all particles that `on` selects.
    pub fn prescribe(
        mut self,
        component: usize,
        value: Arc<dyn SpaceTime>,
        on: impl Fn(&Vector<D>) -> bool,
    ) -> Self {
        let particles = self.select(on);
        let name = format!("prescribed {component}");
        self.prescribed.push(PrescribedVelocity { name, particles, component, value });
        self
    }

    /// Loads all particles that `on` selects with a traction, each on the area that `area` gives.
    pub fn load(
        mut self,
        value: [Arc<dyn SpaceTime>; D],
        on: impl Fn(&Vector<D>) -> bool,
        area: impl Fn(&Vector<D>) -> f64,
    ) -> Self {
        let particles = self.select(on);
        let areas = particles.iter().map(|&a| area(&self.particles.position[a as usize])).collect();
        self.tractions.push(Traction {
            name: "load".into(),
            particles,
            areas,
            places: vec![],
            value,
        });
        self
    }

    fn select(&self, on: impl Fn(&Vector<D>) -> bool) -> Vec<u32> {
        let positions = self.particles.position.iter().enumerate();
        positions.filter(|(_, x)| on(x)).map(|(a, _)| a as u32).collect()
    }

    pub fn build(self, velocity: impl Fn(&Vector<D>) -> Vector<D>) -> Upwind<D> {
        self.build_stressed(velocity, |_| 0.0)
    }

    pub fn build_stressed(
        self,
        velocity: impl Fn(&Vector<D>) -> Vector<D>,
        pressure: impl Fn(&Vector<D>) -> f64,
    ) -> Upwind<D> {
        let positions = &self.particles.position;
        let initial = Initial {
            velocity: positions.iter().map(velocity).collect(),
            pressure: positions.iter().map(pressure).collect(),
        };
        Upwind::new(self.input(initial)).expect("the scheme can be built")
    }

    /// All that a scheme is bound to.
    pub fn input(self, initial: Initial<D>) -> UpwindInput<D> {
        let support =
            Support::new(&self.particles, Kernel::CubicSpline, self.smoothing_ratio, self.domain)
                .expect("the support of a lattice exists");
        let mut body_forces = self.body_forces;
        let steady = |k: usize| Arc::new(self.gravity[k]) as Arc<dyn SpaceTime>;
        body_forces.push(BodyForce { body: None, acceleration: std::array::from_fn(steady) });
        UpwindInput {
            particles: self.particles,
            support,
            settings: self.settings,
            materials: vec![Material { density: self.density, law: self.law }],
            initial,
            body_forces,
            tractions: self.tractions,
            prescribed: self.prescribed,
            implicit: self.implicit,
        }
    }
}

/// A function of place and time with its rate, both written out.
pub struct Function<V, R> {
    pub value: V,
    pub rate: R,
}

impl<V, R> SpaceTime for Function<V, R>
where
    V: Fn([f64; 3], f64) -> f64 + Send + Sync,
    R: Fn([f64; 3], f64) -> f64 + Send + Sync,
{
    fn value(&self, x: [f64; 3], t: f64) -> f64 {
        (self.value)(x, t)
    }

    fn rate(&self, x: [f64; 3], t: f64) -> f64 {
        (self.rate)(x, t)
    }

    fn is_steady(&self) -> bool {
        false
    }
}

/// A function of place and time that nobody asks for its rate: a load.
pub fn varying(value: impl Fn([f64; 3], f64) -> f64 + Send + Sync + 'static) -> Arc<dyn SpaceTime> {
    Arc::new(Function { value, rate: |_, _| f64::NAN })
}

/// Takes `steps` steps of TVD-RK2 from `state` at time 0, constrained first, and shows each.
pub fn march_from(
    scheme: &mut dyn Scheme,
    mut state: Vec<f64>,
    step: f64,
    steps: usize,
    mut show: impl FnMut(f64, &[f64]),
) -> Vec<f64> {
    scheme.constrain(0.0, &mut state);
    let mut new = state.clone();
    let mut integrator = IntegratorKind::TvdRk2.build(scheme).expect("it has rates");
    for count in 1..=steps {
        integrator
            .step(scheme, (count - 1) as f64 * step, step, &state, &mut new)
            .expect("explicit methods always find a state");
        std::mem::swap(&mut state, &mut new);
        show(count as f64 * step, &state);
    }
    state
}

/// Takes steps from the start and returns the last state.
pub fn march(scheme: &mut dyn Scheme, step: f64, steps: usize) -> Vec<f64> {
    let start = scheme.initial_state();
    march_from(scheme, start, step, steps, |_, _| {})
}

/// Kinetic plus strain energy.
pub fn energy(scheme: &dyn Scheme, state: &[f64]) -> f64 {
    let mut energies = [0.0; 2];
    scheme.energies(state, &mut energies);
    energies.iter().sum()
}

/// The work that a mechanism has done so far.
pub fn work(scheme: &dyn Scheme, state: &[f64], mechanism: &str) -> f64 {
    let names = scheme.description().ledger.mechanisms;
    let position = names.iter().position(|name| *name == mechanism).expect("a known mechanism");
    Ledger::of(scheme, state).work[position]
}

/// Energy less the start's and less all work: what the integrator has added.
pub fn imbalance(scheme: &dyn Scheme, start: f64, state: &[f64]) -> f64 {
    energy(scheme, state) - start - Ledger::of(scheme, state).work.iter().sum::<f64>()
}

/// Where a component of a field of a particle stands in a state.
pub fn place(scheme: &dyn Scheme, field: &str, particle: usize, component: usize) -> usize {
    let field = scheme.description().field(field).expect("a known field");
    scheme.column(field).start + particle * field.kind.components(scheme.dimension()) + component
}

/// Where the unknowns of the upwind formulation stand in a state, particle by particle: v, J, x and F
/// row by row.
pub fn places(scheme: &dyn Scheme) -> Vec<usize> {
    let dimension = scheme.dimension();
    let fields = [
        ("velocity", dimension),
        ("volume_ratio", 1),
        ("position", dimension),
        ("deformation_gradient", dimension * dimension),
    ];
    let of = |a: usize| {
        fields.into_iter().flat_map(move |(field, components)| {
            (0..components).map(move |k| match components == dimension * dimension {
                // Tensors stand in a state column by column.
                true => place(scheme, field, a, k % dimension * dimension + k / dimension),
                false => place(scheme, field, a, k),
            })
        })
    };
    (0..scheme.particle_count()).flat_map(of).collect()
}

/// The numbers of a state at such places.
pub fn rows(places: &[usize], state: &[f64]) -> Vec<f64> {
    places.iter().map(|&place| state[place]).collect()
}

/// A seeded number in (-1, 1) for each index: a hash, so that tests need no generator.
pub fn noise(index: usize) -> f64 {
    let mut x = (index as u64).wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// A state with every unknown of every particle disturbed by up to `size`.
pub fn disturbed<S: Scheme>(scheme: &S, size: f64) -> Vec<f64> {
    let mut state = scheme.initial_state();
    let rows = scheme.particle_count() * scheme.width();
    for (index, value) in state[..rows].iter_mut().enumerate() {
        *value += size * noise(index);
    }
    state
}

/// A box lattice whose particles are displaced by up to `jitter` spacings along each axis.
pub fn jittered<const D: usize>(
    lengths: [f64; D],
    intervals: [usize; D],
    jitter: f64,
) -> Particles<D> {
    let mut particles = lattice(lengths, intervals);
    for (a, position) in particles.position.iter_mut().enumerate() {
        for axis in 0..D {
            let spacing = lengths[axis] / intervals[axis] as f64;
            position[axis] += jitter * spacing * noise(a * D + axis);
        }
    }
    particles
}
