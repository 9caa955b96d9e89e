//! Speed of the upwind formulation:
//! `cargo bench -p piola --bench upwind [-- SIZE... 2d|3d serial]`.
//!
//! Prints one Markdown table: for clouds of 2D and 3D particles, on one thread and on all, what an
//! evaluation of the rates costs, where the time goes, and how much of the memory bandwidth that
//! the same run measures it takes. Sizes are numbers of particles, 1e4, 1e5 and 1e6 if none is
//! given, and the rarer switches at the first of them; `2d`, `3d` and `serial` leave the other dimension and all threads out. `docs/performance.md` explains the columns.

mod bandwidth;
mod clock;
mod measure;
mod problem;

use measure::Measured;
use problem::Switches;

const SIZES: [usize; 3] = [10_000, 100_000, 1_000_000];

const HEADER: &str = "\
| D | threads | particles | neighbours | terms | M eval/s | ns/particle | ns/pair | local % | \
slopes % | pairs % | inspect | update | B/particle | GB/s | of read % |
|--:|--:|--:|--:|:--|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|";

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let given: Vec<usize> = words.iter().filter_map(|word| size(word)).collect();
    let sizes = if given.is_empty() { SIZES.to_vec() } else { given };
    let asked = |word: &str| words.iter().any(|given| given == word);
    let all = std::thread::available_parallelism().map_or(1, |threads| threads.get());
    println!("{HEADER}");
    for threads in if all > 1 && !asked("serial") { vec![1, all] } else { vec![1] } {
        if !asked("3d") {
            rows::<2>(threads, &sizes);
        }
        if !asked("2d") {
            rows::<3>(threads, &sizes);
        }
    }
}

/// A number of particles, also as `1e6`; `None` for other words and what cargo adds to them.
fn size(text: &str) -> Option<usize> {
    let number: f64 = text.parse().ok()?;
    (number >= 1.0).then_some(number as usize)
}

fn rows<const D: usize>(threads: usize, sizes: &[usize]) {
    for (number, &size) in sizes.iter().enumerate() {
        let others = if number == 0 { Switches::OTHERS.as_slice() } else { &[] };
        for &switches in Switches::MAIN.iter().chain(others) {
            let measured = measure::on_threads(threads, || measure::run::<D>(size, switches));
            print_row::<D>(threads, switches.name, &measured);
        }
    }
}

fn print_row<const D: usize>(threads: usize, name: &str, measured: &Measured) {
    let Measured { particles, neighbors, bytes, read_rate, .. } = *measured;
    let total: f64 = measured.passes.iter().map(|(_, seconds)| seconds).sum();
    let share = |name: &str| -> f64 {
        let own = measured.passes.iter().filter(|(pass, _)| *pass == name);
        100.0 * own.map(|(_, seconds)| seconds).sum::<f64>() / total
    };
    let each = |seconds: f64| 1e9 * seconds / particles as f64;
    let rate = bytes as f64 / total;
    println!(
        "| {D} | {threads} | {particles} | {neighbors:.1} | {name} | {speed:.2} | {particle:.0} | \
         {pair:.2} | {local:.1} | {slopes:.1} | {pairs:.1} | {inspect:.1} | {update:.1} | \
         {moved:.0} | {streamed:.1} | {share:.0} |",
        speed = particles as f64 / total / 1e6,
        particle = each(total),
        pair = each(total) / neighbors,
        local = share("local"),
        slopes = share("slopes"),
        pairs = share("pairs"),
        inspect = each(measured.inspect),
        update = each(measured.update),
        moved = bytes as f64 / particles as f64,
        streamed = rate / 1e9,
        share = 100.0 * rate / read_rate,
    );
}
