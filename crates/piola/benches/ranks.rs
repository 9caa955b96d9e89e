//! What several ranks have and how fast they are: `cargo bench -p piola --bench ranks -- 1e5 1e6`.
//!
//! A block of a neo-Hookean solid in 2D and 3D, of as many particles as the arguments say. For 2 to 64 ranks: the particles and
//! the copies of the rank that has most of them, the ranks that it gets them from, the bytes that come with each evaluation,
//! and its load over the mean. Then the time of a step on one rank and on two, with one thread each: best of some steps in
//! turns. Last a model, of what follows from these figures on a cluster: nothing of it is measured.

use std::time::Instant;

use piola::case::{self, BANDWIDTH, LATENCY, LoadOptions, Session};
use piola::schemes::Part;

/// How often each is timed, in turns.
const TURNS: usize = 7;

/// Ranks of which the parts are counted.
const RANKS: [usize; 6] = [2, 4, 8, 16, 32, 64];

/// Bytes of a sum that ranks add up, and sums of an evaluation: power, growth and six components of a force each of eight
/// mechanisms.
const SUMS: [f64; 2] = [560.0, 64.0];

/// Messages of all to all in a step, each of which goes through a tree.
const ROUNDS: f64 = 8.0;

fn session(dimension: usize, count: f64, ranks: usize) -> Session {
    let side = count.powf(1.0 / dimension as f64).round();
    let ends = vec!["1.0"; dimension].join(", ");
    let zeros = vec!["0.0"; dimension].join(", ");
    let text = format!(
        "version = 1\ntitle = 'A block'\ndimension = {dimension}\n[[body]]\nname = 'block'\n\
         shape = {{ kind = 'box', min = [{zeros}], max = [{ends}] }}\nspacing = {}\nlattice = {{ on = 'cells' }}\n\
         material = {{ kind = 'neo_hookean', density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3 }}\n\
         initial = {{ velocity = [{}] }}\n[scheme]\nkind = 'dual_support'\n[time]\nend = 1.0\n[compute]\nranks = {ranks}\n",
        1.0 / side,
        ["'0.1 * sin(3 * x)'", "'x * y'", "'z'"][..dimension].join(", "),
    );
    let case = case::parse(&text, "block.toml", &LoadOptions::default());
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Copies of the rank that has most of them, of each number of ranks, with the bytes of one.
fn parts(session: &mut Session) -> Vec<(usize, f64, f64)> {
    println!("  ranks  particles  copies  from  kB an evaluation  load");
    let scheme = session.scheme();
    let of_ranks = |ranks| {
        let bounds = Part::bounds(scheme, ranks).expect("there are enough particles");
        let shares = scheme.shares(&bounds).expect("it can be shared");
        let most = shares.iter().max_by_key(|share| share.copies).expect("there are ranks");
        let load = shares.iter().map(|share| share.load).fold(0.0, f64::max);
        let (copies, bytes) = (most.copies, most.bytes as f64);
        println!(
            "  {ranks:5}  {:9}  {copies:6}  {:4}  {:16.0}  {load:.3}",
            most.particles,
            most.partners,
            bytes * 1e-3
        );
        (most.particles, copies as f64, bytes / copies as f64)
    };
    RANKS.into_iter().map(of_ranks).collect()
}

/// The best time of a step in s of each session, in turns, with so many threads.
fn best<const N: usize>(sessions: &mut [(Session, usize); N]) -> [f64; N] {
    let mut best = [f64::INFINITY; N];
    for turn in 0..=TURNS {
        for ((session, threads), best) in sessions.iter_mut().zip(&mut best) {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(*threads).build();
            let start = Instant::now();
            pool.expect("threads can be had")
                .install(|| session.step())
                .expect("no file is written");
            // The first one touches all memory once.
            if turn > 0 {
                *best = best.min(start.elapsed().as_secs_f64());
            }
        }
    }
    best
}

/// The share of the time of a step in which ranks compute, with so many particles each and seconds a particle.
fn efficiency(ranks: f64, particles: f64, second: f64, [surface, bytes]: [f64; 2]) -> f64 {
    let copies = surface * particles.powf(2.0 / 3.0);
    let rounds = ROUNDS * ranks.log2().ceil();
    let sums = 2.0 * SUMS[0] * SUMS[1] / BANDWIDTH;
    // A block among others has 26 of them beside it, and gets displacements and tensions of each.
    let told = copies * bytes / BANDWIDTH + (2.0 * 26.0 + rounds) * LATENCY + sums;
    particles * second / (particles * second + told)
}

fn main() {
    let counts: Vec<f64> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let mut known = None;
    for dimension in [2, 3] {
        for &count in &counts {
            println!("{dimension}D, {count:.0} particles");
            let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
            let mut alone =
                one.expect("a thread can be had").install(|| session(dimension, count, 1));
            let parts = parts(&mut alone);
            let two = rayon::ThreadPoolBuilder::new().num_threads(2).build();
            let shared = two.expect("threads can be had").install(|| session(dimension, count, 2));
            let [alone, shared] = best(&mut [(alone, 1), (shared, 2)]);
            println!(
                "  step: {:.1} ms on one rank, {:.1} ms on two: {:.2} times as fast\n",
                alone * 1e3,
                shared * 1e3,
                alone / shared
            );
            known = Some((alone / count, parts));
        }
    }
    let Some((second, parts)) = known else { return };
    // Of a rank with others on all sides.
    let (particles, copies, bytes) = parts[parts.len() - 1];
    let surface = [copies / (particles as f64).powf(2.0 / 3.0), bytes];
    println!("model in 3D, {:.0} ns a particle and step, one thread a rank", second * 1e9);
    println!("  ranks  efficiency with 1e6 particles each  with 1e8 in all");
    for ranks in [1, 8, 64, 512, 4096].map(f64::from) {
        let weak = efficiency(ranks, 1e6, second, surface);
        let strong = efficiency(ranks, 1e8 / ranks, second, surface);
        println!("  {ranks:5}  {weak:34.3}  {strong:15.3}");
    }
}
