//! What several ranks have and tell each other, and how fast they are: `cargo bench -p piola --bench ranks -- 1e5 1e6`.
//!
//! A block of a neo-Hookean solid in 2D and 3D, of as many particles as the arguments say. For 2 to 64 ranks: the particles and
//! the copies of the rank that has most of them, the ranks that it gets them from, the bytes that come with each evaluation,
//! and the largest load over the mean. Then the time of a step on one rank and on two, with one thread each: best of some steps
//! in turns; left out if an argument is `counts`. Then what one of four ranks tells the others in a step of a loaded block.
//! Last a model, of what follows from these figures on a cluster: nothing of it is measured.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use piola::case::{self, BANDWIDTH, Case, LATENCY, LoadOptions, Session, seconds_told};
use piola::schemes::Part;
use piola_ranks::{Message, RankError, Ranks, Threads};

/// How often each is timed, in turns.
const TURNS: usize = 7;

/// Ranks of which the parts are counted.
const RANKS: [usize; 6] = [2, 4, 8, 16, 32, 64];

/// Steps of which calls are counted, of so many ranks, after as many that are not.
const COUNTED: [u64; 2] = [10, 4];

/// Seconds a particle and step of the model where none have been measured.
const SECONDS: f64 = 1e-6;

/// Ranks beside one that has others on all sides, by its corners, too.
const ON_ALL_SIDES: f64 = 26.0;

fn block(dimension: usize, count: f64, more: &str) -> Case {
    let side = count.powf(1.0 / dimension as f64).round();
    let ends = vec!["1.0"; dimension].join(", ");
    let zeros = vec!["0.0"; dimension].join(", ");
    let text = format!(
        "version = 1\ntitle = 'A block'\ndimension = {dimension}\n[[body]]\nname = 'block'\n\
         shape = {{ kind = 'box', min = [{zeros}], max = [{ends}] }}\nspacing = {}\nlattice = {{ on = 'cells' }}\n\
         material = {{ kind = 'neo_hookean', density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3 }}\n\
         initial = {{ velocity = [{}] }}\n[scheme]\nkind = 'dual_support'\n[time]\nend = 1.0\n{more}\n",
        1.0 / side,
        ["'0.1 * sin(3 * x)'", "'x * y'", "'z'"][..dimension].join(", "),
    );
    let case = case::parse(&text, "block.toml", &LoadOptions::default());
    case.unwrap_or_else(|problems| panic!("{problems}"))
}

fn session(dimension: usize, count: f64, ranks: usize) -> Session {
    let case = block(dimension, count, &format!("[compute]\nranks = {ranks}"));
    Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Particles and copies of the rank that has most copies, of each number of ranks, with the bytes of one.
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

/// Calls of a kind: how many, their messages where they go to single ranks, and the bytes that are given to them.
#[derive(Default)]
struct Calls([AtomicU64; 3]);

impl Calls {
    fn add(&self, messages: usize, numbers: usize) {
        let more = [1, messages as u64, 8 * numbers as u64];
        self.0.iter().zip(more).for_each(|(count, more)| {
            count.fetch_add(more, Ordering::Relaxed);
        });
    }
}

/// What ranks do: exchange copies, add sums, gather to all, gather to rank 0, and be told by rank 0.
const KINDS: [&str; 5] = ["copies", "sums over all", "from all to all", "to rank 0", "from rank 0"];

/// A rank that counts its calls.
struct Counting {
    ranks: Threads,
    calls: Arc<[Calls; KINDS.len()]>,
}

impl Ranks for Counting {
    fn rank(&self) -> usize {
        self.ranks.rank()
    }

    fn size(&self) -> usize {
        self.ranks.size()
    }

    fn exchange(&self, send: &[Message], receive: &mut [Message]) -> Result<(), RankError> {
        self.calls[0].add(send.len(), send.iter().map(|message| message.numbers.len()).sum());
        self.ranks.exchange(send, receive)
    }

    fn add(&self, numbers: &mut [i64]) -> Result<(), RankError> {
        self.calls[1].add(0, numbers.len());
        self.ranks.add(numbers)
    }

    fn gather_to_all(&self, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError> {
        self.calls[2].add(0, own.len());
        self.ranks.gather_to_all(own)
    }

    fn gather(&self, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError> {
        self.calls[3].add(1, own.len());
        self.ranks.gather(own)
    }

    fn scatter(&self, all: &[Vec<f64>]) -> Result<Vec<f64>, RankError> {
        self.calls[4].add(0, 0);
        self.ranks.scatter(all)
    }

    fn broadcast(&self, said: Vec<f64>) -> Result<Vec<f64>, RankError> {
        let said = self.ranks.broadcast(said)?;
        self.calls[4].add(0, said.len());
        Ok(said)
    }
}

/// What one of several ranks of a loaded block tells the others in a step.
fn count_calls() {
    let [steps, size] = COUNTED;
    let loads = "[[load]]\nkind = 'body_force'\nacceleration = ['cos(9 * t)', '-2.0 * x', '0']\n\
                 [[load]]\nkind = 'traction'\nwhere = { kind = 'plane', point = [1.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }\n\
                 traction = ['2e3 * sin(9 * t)', '100.0', '0']\n\
                 [[boundary]]\nname = 'wall'\nwhere = { kind = 'plane', point = [0.0, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }\n\
                 velocity = { x = '0.2 * sin(20 * t)', y = '0' }";
    let case = block(3, 4e3, loads);
    let calls: Vec<Arc<[Calls; KINDS.len()]>> = (0..size).map(|_| Arc::default()).collect();
    let mut ranks = Threads::group(size as usize)
        .into_iter()
        .zip(&calls)
        .map(|(ranks, calls)| Arc::new(Counting { ranks, calls: calls.clone() }) as Arc<dyn Ranks>);
    let first = ranks.next().expect("there are ranks");
    std::thread::scope(|scope| {
        for rank in ranks {
            let case = &case;
            scope.spawn(move || case::serve(case, rank, Arc::new(AtomicBool::new(false))));
        }
        let mut session =
            Session::on_ranks(&case, first).unwrap_or_else(|problems| panic!("{problems}"));
        let mut step = || {
            (0..steps).for_each(|_| {
                session.step().expect("no file is written");
            });
        };
        step();
        let told = |calls: &Calls| calls.0.each_ref().map(|it| it.load(Ordering::Relaxed));
        let before = calls[1].each_ref().map(told);
        step();
        println!(
            "a step of rank 1 of {size}, {} particles in all, loaded",
            session.scheme().particle_count()
        );
        println!("  {:16}  calls  messages     bytes", "");
        for ((kind, calls), before) in KINDS.iter().zip(calls[1].iter()).zip(before) {
            let [count, messages, bytes] = told(calls);
            let each = |now: u64, before: u64| (now - before) as f64 / steps as f64;
            println!(
                "  {kind:16}  {:5.1}  {:8.1}  {:8.0}",
                each(count, before[0]),
                each(messages, before[1]),
                each(bytes, before[2])
            );
        }
        println!();
    });
}

/// What a model makes of copies that a rank with others on all sides has, so many to the power two thirds of its particles and
/// of so many bytes each.
fn model(second: f64, [surface, bytes]: [f64; 2]) {
    println!(
        "model in 3D: {:.0} ns a particle and step, one evaluation a step, {} us a message, {} GB/s",
        second * 1e9,
        LATENCY * 1e6,
        BANDWIDTH * 1e-9
    );
    for (title, whole) in [("1e6 particles each", None), ("1e8 particles in all", Some(1e8))] {
        println!("  {title}\n  ranks  efficiency  ms computing  us copies  us sums  us rounds");
        for ranks in [1, 8, 64, 512, 4096] {
            let particles = whole.map_or(1e6, |all: f64| all / ranks as f64);
            let copies = surface * particles.powf(2.0 / 3.0);
            let beside = ON_ALL_SIDES.min(ranks as f64 - 1.0);
            let others = if ranks > 1 { copies * bytes } else { 0.0 };
            let told = seconds_told(ranks, 1.0, [others, beside]);
            let computed = particles * second;
            let efficiency = computed / (computed + told.iter().sum::<f64>());
            let [copies, sums, rounds] = told.map(|seconds| seconds * 1e6);
            println!(
                "  {ranks:5}  {efficiency:10.3}  {:12.1}  {copies:9.0}  {sums:7.0}  {rounds:9.0}",
                computed * 1e3
            );
        }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let counts: Vec<f64> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    let is_timed = !arguments.iter().any(|argument| argument == "counts");
    let mut known = None;
    for dimension in [2, 3] {
        for &count in &counts {
            println!("{dimension}D, {count:.0} particles");
            let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
            let mut alone =
                one.expect("a thread can be had").install(|| session(dimension, count, 1));
            let parts = parts(&mut alone);
            let mut second = SECONDS;
            if is_timed {
                let two = rayon::ThreadPoolBuilder::new().num_threads(2).build();
                let shared =
                    two.expect("threads can be had").install(|| session(dimension, count, 2));
                let [alone, shared] = best(&mut [(alone, 1), (shared, 2)]);
                println!(
                    "  step: {:.1} ms on one rank, {:.1} ms on two: {:.2} times as fast",
                    alone * 1e3,
                    shared * 1e3,
                    alone / shared
                );
                second = alone / count;
            }
            println!();
            known = Some((second, parts));
        }
    }
    count_calls();
    let Some((second, parts)) = known else { return };
    // Of the most ranks, some have others on all sides.
    let (particles, copies, bytes) = parts[parts.len() - 1];
    model(second, [copies / (particles as f64).powf(2.0 / 3.0), bytes]);
}
