//! A bounded number of damaged seeds through what fuzzers feed: `fuzz/run` looks longer, and at
//! which code is reached.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use std::fs;
use std::path::Path;

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

#[path = "../../../../fuzz/src/lib.rs"]
mod targets;

/// The seeds of a target.
fn corpus(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(name);
    let mut paths: Vec<_> = fs::read_dir(folder).unwrap().map(|it| it.unwrap().path()).collect();
    paths.sort();
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}

/// Texts that numbers, names and lists do not expect.
const WORDS: [&str; 16] = [
    "nan",
    "-inf",
    "1e308",
    "-0.0",
    "1e-320",
    "99999999999999999999",
    "0x7fffffff",
    "[]",
    "{}",
    "\"\"",
    "''",
    "=",
    "\n[[",
    "\u{202e}",
    "t",
    "1 / 0",
];

/// A seed with some damage.
fn damaged(seeds: &[Vec<u8>], random: &mut Pcg64Mcg) -> Vec<u8> {
    let mut data = seeds[random.random_range(0..seeds.len())].clone();
    for _ in 0..random.random_range(1..3) {
        let at = random.random_range(0..=data.len());
        let end = (at + random.random_range(1..24)).min(data.len());
        match random.random_range(0..8) {
            0 if at < data.len() => data[at] ^= 1 << random.random_range(0..8),
            1 if at < data.len() => data[at] = random.next_u32() as u8,
            2 => drop(data.drain(at..end)),
            3 => {
                let part = data[at..end].to_vec();
                data.splice(at..at, part);
            }
            4 => {
                let word = WORDS[random.random_range(0..WORDS.len())];
                data.splice(at..end.min(at + 4), word.bytes());
            }
            5 => data.truncate(at),
            6 => {
                // Eight bytes make another number of a checkpoint.
                let number = [f64::NAN, -1.0, 0.0, 1e300, f64::from_bits(u64::MAX)];
                let number = number[random.random_range(0..number.len())];
                data.splice(at..(at + 8).min(data.len()), number.to_le_bytes());
            }
            _ => {
                let other = &seeds[random.random_range(0..seeds.len())];
                let from = random.random_range(0..=other.len());
                data.splice(at..end, other[from..].iter().take(64).copied());
            }
        }
    }
    data
}

/// Feeds `count` damaged seeds; how many of them were good all the same.
fn feed(name: &str, seeds: &[Vec<u8>], count: usize, target: fn(&[u8]) -> bool) -> usize {
    for (number, seed) in seeds.iter().enumerate() {
        assert!(target(seed), "seed {number} of {name} is not good any more");
    }
    let mut random = Pcg64Mcg::seed_from_u64(20_261_121);
    let good = (0..count).filter(|_| target(&damaged(seeds, &mut random))).count();
    println!("{name}: {count} inputs tried, {good} of them good, none a fault");
    good
}

#[test]
fn case_files() {
    let good = feed("case_file", &corpus("case_file"), 4000, targets::case_file);
    assert!(good > 50, "damage that spares the meaning reaches the builder: {good}");
}

#[test]
fn point_clouds() {
    let good = feed("point_cloud", &corpus("point_cloud"), 4000, targets::point_cloud);
    assert!(good > 100, "{good}");
}

#[test]
fn meshes() {
    let good = feed("mesh", &corpus("mesh"), 4000, targets::mesh);
    assert!(good > 100, "{good}");
}

#[test]
fn checkpoints() {
    let seeds = [targets::checkpoint_seed()];
    let good = feed("checkpoint", &seeds, 1500, targets::checkpoint);
    assert!(good > 100, "damage to numbers is not seen by the reader, but must do no harm: {good}");
}
