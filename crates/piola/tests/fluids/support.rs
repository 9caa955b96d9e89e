//! Fluids that several tests build.

use std::sync::atomic::AtomicBool;

use piola::Vector;
use piola::case::{self, Finished, LoadOptions, Session};
use piola::geometry::{Faces, LatticeSpec, Particles, Placement, Shape, fill};
use piola::neighbors::Domain;
use piola::schemes::transport_velocity::{
    Contact, DensityRule, Fluid, Hypoelastic, Settings, Solid, SolidsInput, TransportVelocity,
    TransportVelocityInput,
};
use piola::schemes::{Initial, Scheme};
use piola_formulas::kernels::Kernel;

/// The settings of CTVF section 4.1.
pub const SETTINGS: Settings = Settings { density: DensityRule::Summation, ..Settings::FLUID };

/// `side^D` particles in the unit box, each coordinate displaced by up to `jitter` spacings.
pub fn unit_box<const D: usize>(side: usize, jitter: f64, seed: u64) -> Particles<D> {
    let shape = Shape::cuboid(Vector::zeros(), Vector::repeat(1.0));
    let square = LatticeSpec::square([1.0 / side as f64; D]);
    let spec = LatticeSpec { placement: Placement::Cells, jitter, seed, ..square };
    let filled = shape.and_then(|shape| fill(&shape, &spec));
    filled.expect("the box can be filled").particles
}

/// The box that is periodic between 0 and 1 along each axis.
pub fn periodic<const D: usize>() -> Domain<D> {
    Domain::new([Some([0.0, 1.0]); D]).expect("the bounds are in order")
}

/// A fluid in the periodic unit box, `h` in spacings.
pub fn fluid_in_box<const D: usize>(
    particles: Particles<D>,
    settings: Settings,
    fluid: Fluid,
    h: f64,
    start: impl Fn(&Vector<D>) -> (Vector<D>, f64),
) -> TransportVelocity<D> {
    let values = particles.position.iter().map(start);
    let (velocity, pressure) = values.unzip();
    let initial = Initial { velocity, pressure };
    let smoothing_length = h * particles.spacing[0];
    let input =
        TransportVelocityInput { smoothing_length, initial, ..at_rest(particles, settings) };
    TransportVelocity::new(input, fluid).expect("the fluid can be built")
}

/// Particles at rest in the periodic unit box, `h` of one spacing.
fn at_rest<const D: usize>(
    particles: Particles<D>,
    settings: Settings,
) -> TransportVelocityInput<D> {
    let count = particles.len();
    TransportVelocityInput {
        smoothing_length: particles.spacing[0],
        faces: vec![Faces::default(); count],
        particles,
        domain: periodic(),
        kernel: Kernel::QuinticSpline,
        settings,
        initial: Initial { velocity: vec![Vector::zeros(); count], pressure: vec![0.0; count] },
        walls: Vec::new(),
        motion: Vec::new(),
        sliding: Vec::new(),
        body_forces: Vec::new(),
        open: Default::default(),
        damping: None,
    }
}

/// The system of solids.
pub type Solids<const D: usize> = TransportVelocity<D, Hypoelastic<D>>;

/// Solids at rest in the periodic unit box, a material a body, `h` of one spacing.
pub fn solids_in_box<const D: usize>(
    particles: Particles<D>,
    settings: Settings,
    materials: Vec<Solid>,
) -> (TransportVelocityInput<D>, SolidsInput) {
    let solids = SolidsInput {
        materials,
        contact: Contact::Repulsive,
        self_contact: None,
        corrected: false,
        held: Vec::new(),
    };
    (at_rest(particles, settings), solids)
}

/// The columns of a particle of any matter.
const COMMON: [&str; 6] = ["velocity", "position", "density", "pressure", "kick", "deviation"];

/// What a particle of a solid has besides: the deviatoric stress as xx, yy, zz, yz, xz, xy and three numbers.
const OWN: [&str; 4] = ["deviatoric_stress", "plastic_strain", "temperature", "internal_energy"];

/// Where the columns of a state have a particle.
fn places(
    scheme: &dyn Scheme,
    names: &'static [&'static str],
    number: usize,
) -> impl Iterator<Item = usize> {
    names.iter().flat_map(move |name| {
        let field = scheme.description().field(name).expect("a known field");
        let components = field.kind.components(scheme.dimension());
        let start = scheme.column(field).start + number * components;
        start..start + components
    })
}

/// What a state says of each particle: u, r, rho, p, du/dt, d.
pub fn rows(scheme: &dyn Scheme, state: &[f64]) -> Vec<Vec<f64>> {
    let row = |number| places(scheme, &COMMON, number).map(|place| state[place]).collect();
    (0..scheme.particle_count()).map(row).collect()
}

fn change(
    scheme: &dyn Scheme,
    names: &'static [&'static str],
    state: &mut [f64],
    mut change: impl FnMut(usize, &mut [f64]),
) {
    for number in 0..scheme.particle_count() {
        let mut row: Vec<f64> = places(scheme, names, number).map(|place| state[place]).collect();
        change(number, &mut row);
        places(scheme, names, number).zip(row).for_each(|(place, value)| state[place] = value);
    }
}

/// Lets `how` change that, particle by particle.
pub fn change_rows(scheme: &dyn Scheme, state: &mut [f64], how: impl FnMut(usize, &mut [f64])) {
    change(scheme, &COMMON, state, how);
}

/// Lets `how` change what each particle of a solid has besides: s, plastic strain, temperature, energy.
pub fn change_matter(scheme: &dyn Scheme, state: &mut [f64], how: impl FnMut(usize, &mut [f64])) {
    change(scheme, &OWN, state, how);
}

/// The deviations in a state.
pub fn deviations<const D: usize>(scheme: &dyn Scheme, state: &[f64]) -> Vec<Vector<D>> {
    let of = |row: &Vec<f64>| Vector::from_column_slice(&row[3 * D + 2..]);
    rows(scheme, state).iter().map(of).collect()
}

/// A session of the text of a case with overrides, or what is wrong with it.
pub fn session(text: &str, set: &[&str]) -> Result<Session, String> {
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(text, "case.toml", &options).map_err(|error| error.to_string())?;
    Session::new(&case).map_err(|error| error.to_string())
}

/// A session of the text of a case with files beside it, or what is wrong with it.
pub fn session_beside(files: &[(&str, &str)], text: &str) -> Result<Session, String> {
    let folder = tempfile::tempdir().expect("a folder can be made");
    for (name, content) in files.iter().chain(&[("case.toml", text)]) {
        std::fs::write(folder.path().join(name), content).expect("files can be written");
    }
    let case = case::load(&folder.path().join("case.toml"), &LoadOptions::default());
    case.and_then(|case| Session::new(&case)).map_err(|problems| problems.to_string())
}

/// The finished run of the text of a case.
pub fn run(text: &str, set: &[&str]) -> Finished {
    let session = session(text, set).unwrap_or_else(|error| panic!("{error}"));
    session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs")
}

/// All values of a column of the tables, `energy.NAME`, `momentum.NAME`, `step.NAME` or of a probe.
pub fn values(finished: &Finished, name: &str) -> Vec<f64> {
    let tables = &finished.tables;
    let (table, column) = name.split_once('.').expect("a table and a column");
    let values = match table {
        "step" => tables.steps.values(column),
        "energy" => tables.energy.values(column),
        "momentum" => tables.momentum.values(column),
        _ => tables.probes.values(name),
    };
    values.unwrap_or_else(|| panic!("no `{name}`")).to_vec()
}
