//! Bytes that stages move, against what types and lists have, counted by hand.

use std::path::Path;

use piola::case::{self, Level, LoadOptions, Session};
use piola::schemes::{Scheme, Traffic};

fn session(name: &str, set: &[&str]) -> Session {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, level: Level::Coarse, ..LoadOptions::default() };
    let case = case::load(&path.join("case.toml"), &options);
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The traffic of a stage, the first of its name.
fn traffic(scheme: &dyn Scheme, name: &str) -> Traffic {
    let phases = scheme.phases();
    let stages = phases.iter().flat_map(|phase| phase.stages.iter().zip(&phase.traffic));
    let mut of_name = stages.filter(|((stage, _), _)| stage.name == name);
    *of_name.next().unwrap_or_else(|| panic!("there is a stage `{name}`")).1
}

/// Groups of eight of so many neighbours each, on average.
fn groups_of(neighbors: impl ExactSizeIterator<Item = usize>) -> f64 {
    let count = neighbors.len() as f64;
    neighbors.map(|neighbors| neighbors.div_ceil(8)).sum::<usize>() as f64 / count
}

/// Groups of eight neighbours of a particle, on average.
fn groups(scheme: &dyn Scheme) -> f64 {
    groups_of((0..scheme.particle_count()).map(|a| scheme.neighborhood(a).len()))
}

fn assert_close(traffic: &Traffic, [own, gathered, least]: [f64; 3]) {
    let close = |found: f64, expected: f64| (found - expected).abs() <= 1e-9 * expected;
    let is_close =
        close(traffic.own, own) && close(traffic.gathered, gathered) && close(traffic.least, least);
    assert!(is_close, "{traffic:?}, not {own} {gathered} {least}");
}

const NUMBER: f64 = 8.0;

/// In 2D a state has v, J, x and F, 9 numbers, and a side x, X, v, H, p, density and wave speed, 13 in two lines of a cache.
#[test]
fn upwind_moves_what_its_tables_have() {
    let mut session = session("upwind/column-impact", &["scheme.reconstruction=true"]);
    let scheme = &*session.scheme();
    // The state, X, three reference values and the body are read, and the side is written.
    let side = 128.0;
    let local = (9.0 + 2.0 + 3.0) * NUMBER + 4.0 + side;
    assert_close(&traffic(scheme, "local"), [local, 0.0, local]);
    // Side, diagonal, three reference values, volume and body force are read, rates written. A group of neighbours has
    // eight indices and two areas, 288 bytes, and a row where it starts and how long it is.
    let own = side + (2.0 + 3.0 + 1.0 + 2.0 + 9.0) * NUMBER;
    let groups = groups(scheme);
    let rows = 8.0 + groups * (8.0 * 4.0 + 8.0 * 4.0 * NUMBER);
    let (pairs, slope) = (traffic(scheme, "pairs"), 64.0);
    let gathered = side + slope;
    assert_close(&pairs, [own, rows + groups * 8.0 * gathered, own + slope + rows]);
    // Slopes are those of two components of v and of p, in one line. They ask for no areas, but have the inverse of moments.
    let own = side + 4.0 * NUMBER + slope;
    let rows = 8.0 + groups * 8.0 * 4.0;
    let slopes = traffic(scheme, "slopes");
    assert_close(&slopes, [own, rows + groups * 8.0 * side, own + rows]);
}

/// In 2D a side has u, d, density, volume, load and pressure, 8 numbers, and rates are four.
#[test]
fn fluids_move_what_their_tables_have() {
    let mut session = session("ctvf/taylor-green", &[]);
    let scheme = &*session.scheme();
    let (groups, place) = (groups(scheme), 2.0 * NUMBER);
    // Padded rows of indices, each with its start and two lengths.
    let rows = 16.0 + groups * 8.0 * 4.0;
    let side = 8.0 * NUMBER;
    let own = side + 3.0 * NUMBER;
    let rates = traffic(scheme, "rates");
    assert_close(&rates, [own, rows + groups * 8.0 * (side + place), own + place + rows]);
    // Eight vectors of accelerations and sums and one number in place of three rates.
    let own = side + 17.0 * NUMBER;
    let forces = traffic(scheme, "forces");
    assert_close(&forces, [own, rows + groups * 8.0 * (side + place), own + place + rows]);
    // Position, velocity, deviation, density, pressure and mass with the order become the side and the place; the rows
    // are written, of candidates that are within the support and a fifth of it.
    let load = traffic(scheme, "load");
    let own = (2.0 + 2.0 + 2.0 + 1.0 + 1.0 + 1.0) * NUMBER + 4.0 + side + place + rows;
    assert!((load.own - own).abs() < 1e-9 * own, "{load:?}, not {own}");
    let neighbors = scheme.neighborhood(0).len() as f64;
    let candidates = (load.least - own - place - NUMBER) / 4.0;
    // Within 1.2 times the distance are 1.44 times as many, up to the steps of a lattice.
    assert!((1.3..1.6).contains(&(candidates / neighbors)), "{candidates} beside {neighbors}");
}

/// In 3D a plain gradient takes three coefficients of a pair, and forces three and a stiffness; a consistent one has three
/// more, and a second tension.
#[test]
fn total_lagrangian_solids_move_what_their_tables_have() {
    let displacement = 3.0 * NUMBER;
    for (sums, gradients) in [(1.0, "'plain'"), (2.0, "'patch_consistent'")] {
        let set = format!("scheme.gradients={gradients}");
        let mut session = session("dual-support/free-vibration", &[&set]);
        let neighbors = session.view("neighbors", None).expect("it is a field");
        let seen = groups_of(neighbors.numbers().iter().map(|neighbors| *neighbors as usize));
        let scheme = &*session.scheme();
        // Displacement, two sums of coefficients, shape, stiffness, volume and mixture are read; gradient and tensions are
        // written.
        let tension = sums * 9.0 * NUMBER;
        let own = (3.0 + 6.0 + 9.0 + 1.0 + 1.0 + 9.0) * NUMBER + 4.0 + tension;
        let rows = 8.0 + seen * (8.0 * 4.0 + 8.0 * 3.0 * sums * NUMBER);
        let strains = traffic(scheme, "strains");
        assert_close(&strains, [own, rows + seen * 8.0 * displacement, own + rows]);
        // Forces take a particle from those that see it, and from those that it sees with a stiffness.
        let own = tension + (3.0 + 15.0 + 3.0) * NUMBER;
        let group = 8.0 * 4.0 + 8.0 * (3.0 * sums + 1.0) * NUMBER;
        let forces = traffic(scheme, "forces");
        let met = (forces.least - own - 8.0) / group;
        assert!((seen..=groups(scheme)).contains(&met), "{met} beside {seen}");
        let gathered = met * (group + 8.0 * (displacement + tension));
        assert_close(&forces, [own, 8.0 + gathered, own + 8.0 + met * group]);
    }
}

/// Walls count by their share of the particles. Their rows are of indices, each with its start and two lengths, so that their
/// bytes, and how many neighbours are read, say the same of how many there are.
#[test]
fn walls_count_by_their_share() {
    let mut session = session("ctvf/dam-break", &[]);
    let is_wall = session.view("wall", None).expect("it is a field");
    let numbers = is_wall.numbers();
    let share = numbers.iter().filter(|it| **it != 0.0).count() as f64 / numbers.len() as f64;
    assert!((0.05..0.9).contains(&share), "{share}");
    let walls = traffic(&*session.scheme(), "walls");
    // In 2D a side takes 8 numbers.
    let side = 8.0 * NUMBER;
    let rows = (walls.least - walls.own) / share - side;
    let neighbors = (walls.gathered / share - rows) / side;
    let expected = 16.0 + 4.0 * neighbors;
    assert!((rows - expected).abs() < 1e-9 * expected, "{rows}, not {expected}");
}
