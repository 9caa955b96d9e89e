//! Runs whose steps several ranks take together.
//!
//! Rank 0 has the run: clock, observers, files. It tells the others what to do, and does the same with its part.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Instant;

use piola_ranks::{RankError, Ranks, Threads};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::Executor;
use crate::parallel::Team;
use crate::schemes::{
    DeviceSteps, Health, Part, Phase, RankCosts, RankRefusal, RankRows, Scheme, StepLimit,
    StepsError,
};
use crate::solve::Costs;
use crate::time::failure::Failure;
use crate::time::integrator::Integrator;

/// What all ranks are to do.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Order {
    /// Take over what rank 0 has for them.
    Put,
    /// Take a step from a time, both in s, where failures have multiplied steps by a factor.
    Step { time: f64, step: f64, factor: f64 },
    /// Look at the state.
    Inspect,
    /// Give the state to rank 0.
    Fetch,
    /// Give the state before the last step.
    FetchBefore,
    /// Tell what has taken time.
    Costs,
    /// Nothing more of this run: another one of the same case with so many more particles in reserve goes on.
    Again(usize),
    /// Nothing more.
    End,
}

impl Order {
    fn pack(self) -> Vec<f64> {
        match self {
            Self::Put => vec![0.0],
            Self::Step { time, step, factor } => vec![1.0, time, step, factor],
            Self::Inspect => vec![2.0],
            Self::Fetch => vec![3.0],
            Self::FetchBefore => vec![4.0],
            Self::Costs => vec![5.0],
            Self::End => vec![6.0],
            Self::Again(more) => vec![7.0, more as f64],
        }
    }

    fn unpack(said: &[f64]) -> Option<Self> {
        Some(match *said {
            [0.0] => Self::Put,
            [1.0, time, step, factor] => Self::Step { time, step, factor },
            [2.0] => Self::Inspect,
            [3.0] => Self::Fetch,
            [4.0] => Self::FetchBefore,
            [5.0] => Self::Costs,
            [6.0] => Self::End,
            [7.0, more] => Self::Again(more as usize),
            _ => return None,
        })
    }
}

/// What a rank computes.
struct Worker {
    ranks: Arc<dyn Ranks>,
    scheme: Box<dyn Scheme>,
    integrator: Box<dyn Integrator>,
    state: Vec<f64>,
    before: Vec<f64>,
    next: Vec<f64>,
    limits: Vec<StepLimit>,
    health: Health,
    /// Its particles.
    particles: usize,
    /// Seconds of steps and of looks at states.
    taken: f64,
    /// What asks this rank to end the run, if it is a process.
    stop: Option<Arc<AtomicBool>>,
}

impl Worker {
    /// That of a rank of a run with this integrator. All ranks call this together.
    fn new(
        whole: &dyn Scheme,
        part: &Part,
        integrator: &dyn Integrator,
    ) -> Result<Self, RankRefusal> {
        let mut scheme = whole.share(part)?;
        let own = integrator.renewed(scheme.as_mut());
        let integrator = own.ok_or_else(|| RankRefusal::Integrator(integrator.name()))?;
        let state = scheme.initial_state();
        let particles = match scheme.is_whole_on_ranks() {
            true => part.own().len(),
            false => scheme.particle_count(),
        };
        Ok(Self {
            particles,
            ranks: part.ranks.clone(),
            before: state.clone(),
            next: state.clone(),
            scheme,
            integrator,
            state,
            limits: Vec::new(),
            health: Health::NEUTRAL,
            taken: 0.0,
            stop: None,
        })
    }

    /// Goes on from another state. What the integrator remembers of the one before may be right for the particles of some
    /// ranks only, which then would not take part in what the others tell each other.
    fn take(&mut self, state: Vec<f64>) {
        self.state = state;
        if let Some(systems) = self.scheme.coupled() {
            systems.forget();
        }
        if let Some(integrator) = self.integrator.renewed(self.scheme.as_mut()) {
            self.integrator = integrator;
        }
    }

    /// Does what rank 0 says, until it says no more; how many more particles another run has in reserve that goes on.
    fn serve(&mut self) -> Result<Option<usize>, RankError> {
        loop {
            match Order::unpack(&self.ranks.broadcast(Vec::new())?) {
                // What is no order comes from a rank that has failed.
                None => return Err(RankError::Lost(0)),
                Some(Order::End) => return Ok(None),
                Some(Order::Again(more)) => return Ok(Some(more)),
                Some(order) => self.obey(order)?,
            }
        }
    }

    /// Does what all ranks do. What comes to rank 0, and goes out from it, does so beside this.
    fn obey(&mut self, order: Order) -> Result<(), RankError> {
        match order {
            Order::Put => {
                let state = self.ranks.scatter(&[])?;
                self.take(state);
            }
            Order::Fetch => drop(self.ranks.gather(self.told(&self.state))?),
            Order::FetchBefore => drop(self.ranks.gather(self.told(&self.before))?),
            Order::Costs => drop(self.ranks.gather(&self.costs())?),
            Order::Inspect => {
                self.inspect()?;
            }
            Order::Step { time, step, factor } => {
                self.integrator.shorten(factor);
                // A failure of it is that of all ranks, of which number 0 tells.
                drop(self.step(time, step)?);
            }
            Order::Again(_) | Order::End => {}
        }
        Ok(())
    }

    /// Why the ranks cannot go on.
    fn lost(&self) -> Option<RankError> {
        self.scheme.team().and_then(Team::fault).cloned()
    }

    /// What it has of a state that others do not have.
    fn told<'a>(&self, state: &'a [f64]) -> &'a [f64] {
        if self.scheme.is_whole_on_ranks() { &[] } else { state }
    }

    /// What has taken its time, as numbers.
    fn costs(&self) -> Vec<f64> {
        let (waited, sent) = self.scheme.team().map(Team::costs).unwrap_or_default();
        let particles = self.particles as f64;
        let [messages, bytes] = sent.map(|count| count as f64);
        vec![particles, self.taken - waited, waited, messages, bytes]
    }

    /// Takes a step, or stays where it is if there is none, which is then so on all ranks: they solve the same equations.
    fn step(&mut self, time: f64, step: f64) -> Result<Result<(), Failure>, RankError> {
        let (start, scheme) = (Instant::now(), self.scheme.as_mut());
        let taken = self.integrator.step(scheme, time, step, &self.state, &mut self.next);
        self.taken += start.elapsed().as_secs_f64();
        if let Some(lost) = self.lost() {
            return Err(lost);
        }
        if taken.is_ok() {
            std::mem::swap(&mut self.before, &mut self.state);
            std::mem::swap(&mut self.state, &mut self.next);
        }
        Ok(taken)
    }

    /// Looks at the state: whether any rank has something to say of it, and whether any is asked to stop.
    fn inspect(&mut self) -> Result<[bool; 2], RankError> {
        let start = Instant::now();
        self.health = self.scheme.inspect(&self.state, &mut self.limits);
        self.taken += start.elapsed().as_secs_f64();
        if let Some(lost) = self.lost() {
            return Err(lost);
        }
        let stops = self.stop.as_ref().is_some_and(|stop| stop.load(Ordering::Relaxed));
        let mut told = [self.scheme.warning().is_some(), stops].map(i64::from);
        self.ranks.add(&mut told)?;
        Ok(told.map(|ranks| ranks > 0))
    }
}

/// The steps of several ranks, as rank 0 has them taken.
struct RankSteps {
    worker: Worker,
    /// Where the rows of each rank stand in a state of all.
    rows: RankRows,
    /// Whether any rank has something to say of the state, and whether any is asked to stop.
    told: [bool; 2],
    /// What failures have multiplied steps by.
    factor: f64,
    /// The threads that rank 0 computes with, if the ranks are threads.
    pool: Option<ThreadPool>,
    others: Vec<JoinHandle<()>>,
    /// How the run ends for the others.
    last: Order,
}

impl RankSteps {
    /// Says what all do, and does it.
    fn order(&mut self, order: Order) -> Result<(), RankError> {
        let Self { worker, pool, told, .. } = self;
        worker.ranks.broadcast(order.pack())?;
        let run = || match order {
            Order::Inspect => {
                *told = worker.inspect()?;
                Ok(())
            }
            order => worker.obey(order),
        };
        on(pool.as_ref(), run)
    }

    /// Brings a state here.
    fn bring(&self, order: Order, own: &[f64], state: &mut [f64]) -> Result<(), StepsError> {
        self.worker.ranks.broadcast(order.pack())?;
        self.rows.join(&self.worker.ranks.gather(own)?, state);
        Ok(())
    }
}

impl DeviceSteps for RankSteps {
    fn put(&mut self, state: &[f64]) -> Result<(), StepsError> {
        self.worker.ranks.broadcast(Order::Put.pack())?;
        let own = self.worker.ranks.scatter(&self.rows.split(state))?;
        self.worker.take(own);
        Ok(())
    }

    fn step(&mut self, time: f64, step: f64) -> Result<(), StepsError> {
        let Self { worker, pool, factor, .. } = self;
        worker.ranks.broadcast(Order::Step { time, step, factor: *factor }.pack())?;
        worker.integrator.shorten(*factor);
        match on(pool.as_ref(), || worker.step(time, step))? {
            Err(Failure::NoSolution(missed)) => Err(StepsError::NoSolution(missed)),
            Err(Failure::Inaccurate(missed)) => Err(missed.into()),
            // No other failure is one of a step.
            Err(_) => Err(RankError::Lost(worker.ranks.rank()).into()),
            Ok(()) => Ok(()),
        }
    }

    fn growth(&self) -> Option<f64> {
        self.worker.integrator.growth()
    }

    fn was_quick(&self) -> bool {
        let Worker { integrator, scheme, state, .. } = &self.worker;
        // Where each has a part of the state, steps are explicit.
        scheme.is_whole_on_ranks() && integrator.was_quick(scheme.as_ref(), state)
    }

    fn linear_costs(&self) -> Option<Costs> {
        self.worker.scheme.linear_costs()
    }

    /// Ranks that have the whole state know of it what nobody else does: by which way they have come to it.
    fn warning(&self) -> Option<String> {
        let scheme = &self.worker.scheme;
        if scheme.is_whole_on_ranks() { scheme.warning() } else { None }
    }

    fn shorten(&mut self, factor: f64) {
        self.factor = factor;
    }

    fn end_for_another(&mut self, more: usize) {
        self.last = Order::Again(more);
    }

    fn inspect(&mut self, limits: &mut Vec<StepLimit>) -> Result<Health, StepsError> {
        self.order(Order::Inspect)?;
        limits.clone_from(&self.worker.limits);
        Ok(self.worker.health)
    }

    fn fetch(&self, state: &mut [f64]) -> Result<(), StepsError> {
        self.bring(Order::Fetch, &self.worker.state, state)
    }

    fn fetch_before(&self, state: &mut [f64]) -> Result<(), StepsError> {
        self.bring(Order::FetchBefore, &self.worker.before, state)
    }

    fn warns(&self) -> bool {
        self.told[0]
    }

    fn steps_in_last(&self) -> &[u64] {
        self.worker.integrator.steps_in_last()
    }

    /// What stands behind all columns is the same on all ranks.
    fn missing(&self) -> u64 {
        self.worker.scheme.missing(&self.worker.state)
    }

    fn stops(&self) -> bool {
        self.told[1]
    }

    fn costs(&self) -> Result<Vec<RankCosts>, StepsError> {
        self.worker.ranks.broadcast(Order::Costs.pack())?;
        let told = self.worker.ranks.gather(&self.worker.costs())?;
        let of_rank = |told: Vec<f64>| match *told {
            [particles, computed, waited, messages, bytes] => RankCosts {
                particles: particles as usize,
                computed,
                waited,
                messages: messages as u64,
                bytes: bytes as u64,
            },
            _ => RankCosts::default(),
        };
        Ok(told.into_iter().map(of_rank).collect())
    }

    fn phases(&self) -> Vec<&Phase> {
        self.worker.scheme.phases()
    }
}

impl Drop for RankSteps {
    fn drop(&mut self) {
        // Where this rank fails the others wait for something else, and are told when it lets go of the ranks, which it does
        // after this.
        if thread::panicking() {
            return;
        }
        // Those that are lost do not hear it, and have ended.
        drop(self.worker.ranks.broadcast(self.last.pack()));
        self.others.drain(..).for_each(|other| drop(other.join()));
    }
}

/// Runs `body` on the threads of a pool, if there is one.
fn on<T: Send>(pool: Option<&ThreadPool>, body: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(body),
        None => body(),
    }
}

/// Lets `ranks` be of the particles of a formulation, of which all have the whole at first.
fn part(scheme: &dyn Scheme, ranks: Arc<dyn Ranks>) -> Result<Part, RankRefusal> {
    Ok(Part { bounds: Part::bounds(scheme, ranks.size())?, ranks })
}

impl Executor {
    /// Lets ranks take the steps from now on, which are threads of this process: each with its part of the particles, and
    /// of the threads of this pool.
    ///
    /// # Errors
    /// [`RankRefusal`] for what does not run on several ranks, and where there are more ranks than chunks of particles.
    pub fn use_ranks(&mut self, count: usize) -> Result<(), RankRefusal> {
        let (scheme, integrator) = (self.scheme.as_ref(), self.integrator.as_ref());
        // What cannot be shared is refused before there are threads.
        scheme.shares(&Part::bounds(scheme, count)?)?;
        let threads = (rayon::current_num_threads() / count).max(1);
        let pool = || ThreadPoolBuilder::new().num_threads(threads).build().ok();
        let make = |rank: Threads| {
            // Whoever fails lets go of its rank, so that those who wait for it are told.
            let part = part(scheme, Arc::new(rank))?;
            let pool = pool();
            let worker = on(pool.as_ref(), || Worker::new(scheme, &part, integrator))?;
            Ok((worker, part, pool))
        };
        let made: Vec<Result<_, RankRefusal>> = thread::scope(|scope| {
            let ranks = Threads::group(count).into_iter();
            let made: Vec<_> = ranks.map(|rank| scope.spawn(|| make(rank))).collect();
            let join = |(rank, made): (usize, thread::ScopedJoinHandle<'_, _>)| {
                made.join().unwrap_or_else(|_| Err(RankError::Lost(rank).into()))
            };
            made.into_iter().enumerate().map(join).collect()
        });
        let mut made = made.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter();
        let Some((worker, part, pool)) = made.next() else { return Ok(()) };
        let serve = |(mut worker, _, pool): (Worker, Part, Option<ThreadPool>)| {
            thread::spawn(move || drop(on(pool.as_ref(), || worker.serve())))
        };
        let others = made.map(serve).collect();
        self.lead_with(worker, &part, (pool, others))
    }

    /// Lets these ranks take the steps from now on, of which this process is number 0; the others [`serve`](Self::serve).
    ///
    /// # Errors
    /// As [`Self::use_ranks`].
    pub fn lead(&mut self, ranks: Arc<dyn Ranks>) -> Result<(), RankRefusal> {
        let part = part(self.scheme.as_ref(), ranks)?;
        let worker = Worker::new(self.scheme.as_ref(), &part, self.integrator.as_ref())?;
        self.lead_with(worker, &part, (None, Vec::new()))
    }

    /// Takes part in a run of several ranks, of which this process is not number 0, until that ends it, which it does soon
    /// after `stop` is set. Returns with how many more particles in reserve than the case asks for another run of it goes on,
    /// see [`Self::leave`].
    ///
    /// # Errors
    /// As [`Self::use_ranks`], and where a rank is lost.
    pub fn serve(
        self,
        ranks: Arc<dyn Ranks>,
        stop: Arc<AtomicBool>,
    ) -> Result<Option<usize>, RankRefusal> {
        let part = part(self.scheme.as_ref(), ranks)?;
        let mut worker = Worker::new(self.scheme.as_ref(), &part, self.integrator.as_ref())?;
        worker.stop = Some(stop);
        drop(self);
        Ok(worker.serve()?)
    }

    fn lead_with(
        &mut self,
        worker: Worker,
        part: &Part,
        (pool, others): (Option<ThreadPool>, Vec<JoinHandle<()>>),
    ) -> Result<(), RankRefusal> {
        let rows = RankRows::of(self.scheme.as_ref(), &part.bounds);
        let (told, last) = ([false; 2], Order::End);
        let steps = RankSteps { worker, rows, told, factor: 1.0, pool, others, last };
        self.use_steps(Box::new(steps)).map_err(|error| match error {
            StepsError::Ranks(error) => error.into(),
            _ => RankRefusal::Formulation(self.scheme.description().name),
        })
    }
}
