//! Time that other programs on the machine disturb least.

use std::time::Instant;

/// Seconds on the clock that fits the number of threads: the CPU time of this thread where it
/// works alone, so that waiting for the processor does not count, and the time on the wall
/// otherwise.
pub fn now() -> f64 {
    if rayon::current_num_threads() == 1 { thread_time() } else { wall_time() }
}

#[cfg(unix)]
fn thread_time() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

#[cfg(not(unix))]
fn thread_time() -> f64 {
    wall_time()
}

fn wall_time() -> f64 {
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// The best of several runs of `work`, which returns its seconds first: at least five runs, and
/// more until they have taken a second and a half.
pub fn best<T>(mut work: impl FnMut() -> (f64, T)) -> (f64, T) {
    let start = Instant::now();
    let mut best = work();
    let mut runs = 1;
    while runs < 5 || start.elapsed().as_secs_f64() < 1.5 {
        let next = work();
        if next.0 < best.0 {
            best = next;
        }
        runs += 1;
    }
    best
}

/// Seconds of the best run of `work`.
pub fn best_time(mut work: impl FnMut()) -> f64 {
    let timed = || {
        let start = now();
        work();
        (now() - start, ())
    };
    best(timed).0
}
