//! Time to order particles and to list their neighbours: `cargo bench -p piola --bench neighbors`.
//!
//! Wall time, best of several runs, on one thread and on all. An argument that is a number keeps
//! only sizes up to it.

use std::time::Instant;

use piola::Vector;
use piola::neighbors::{Domain, NeighborList, search, spatial_order};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// A lattice of about `count` particles, spacing 1, each moved by up to a tenth of it.
fn lattice<const D: usize>(count: usize) -> Vec<Vector<D>> {
    let side = (count as f64).powf(1.0 / D as f64).round() as usize;
    let mut source = Pcg64::seed_from_u64(1);
    let point = |i: usize| {
        Vector::from_fn(|axis, _| {
            (i / side.pow(axis as u32) % side) as f64 + source.random_range(-0.1..0.1)
        })
    };
    (0..side.pow(D as u32)).map(point).collect()
}

/// Result and least time in ms over runs that last half a second, at least three.
fn best<T>(mut run: impl FnMut() -> T) -> (T, f64) {
    let begin = Instant::now();
    let mut least = f64::INFINITY;
    let mut runs = 0;
    loop {
        let start = Instant::now();
        let result = run();
        least = least.min(start.elapsed().as_secs_f64() * 1e3);
        runs += 1;
        if runs >= 3 && begin.elapsed().as_secs_f64() > 0.5 {
            return (result, least);
        }
    }
}

fn measure<const D: usize>(count: usize, support: f64) {
    let mut points = lattice::<D>(count);
    points.shuffle(&mut Pcg64::seed_from_u64(2));
    let supports = vec![support; points.len()];
    let list = |points: &[Vector<D>]| -> NeighborList {
        search(points, &supports, &Domain::open()).expect("the lattice is sound")
    };
    let (_, shuffled) = best(|| list(&points));
    let (order, ordering) = best(|| spatial_order(&points, support).expect("the lattice is sound"));
    let points: Vec<Vector<D>> = order.iter().map(|&i| points[i as usize]).collect();
    let (neighbors, ordered) = best(|| list(&points));
    let (_, dual) = best(|| neighbors.dual());
    let (_, reverse) = best(|| neighbors.reverse_entries().expect("equal supports"));
    println!(
        "{D}D {threads:>7} {count:>9} {mean:>10.1} {ordering:>9.2} {shuffled:>9.2} {ordered:>9.2} \
         {pair:>8.2} {dual:>8.2} {reverse:>8.2}",
        threads = rayon::current_num_threads(),
        count = points.len(),
        mean = neighbors.statistics().mean,
        pair = ordered * 1e6 / neighbors.pairs() as f64,
    );
}

fn main() {
    let most = std::env::args().find_map(|argument| argument.parse().ok()).unwrap_or(1_000_000);
    println!(
        "   threads particles neighbours  order/ms shuffled/  ordered/  ns/pair     dual  reverse\n\
         {:39}list, ms  list, ms            /ms      /ms",
        ""
    );
    let all = std::thread::available_parallelism().map_or(1, |count| count.get());
    for threads in if all > 1 { vec![1, all] } else { vec![1] } {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be started").install(|| {
            for count in [10_000, 100_000, 200_000, 1_000_000] {
                if count <= most {
                    measure::<2>(count, 3.0);
                    measure::<3>(count, 2.52);
                }
            }
        });
    }
}
