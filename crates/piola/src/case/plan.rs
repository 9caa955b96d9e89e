//! What a run of a case will do, without running it: the content of `piola check`.

use std::time::Instant;

use super::assembly::{self, bodies::BodyReport};
use super::model;
use super::session::Session;
use crate::neighbors::NeighborStatistics;
use crate::schemes::{Part, Particle, RankShare, Scheme, StepLimit};
use crate::time::{StepControl, supersonic};

/// What will happen when a case runs.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The bodies with their particles.
    pub bodies: Vec<BodyReport>,
    /// Smallest, mean and largest number of neighbours.
    pub neighbors: NeighborStatistics,
    /// Particles with fewer neighbours than there are dimensions.
    pub poorly_supported: Vec<Particle>,
    /// The bounds on the first step, smallest first.
    pub limits: Vec<PlannedLimit>,
    /// The first step in s.
    pub step: f64,
    /// What limits it.
    pub limiter: String,
    /// Number of steps to the end if all are as large as the first.
    pub steps: u64,
    /// Number of its own steps that each system takes in the first step, by name; empty for a single system.
    pub own_steps: Vec<(String, u64)>,
    /// The effect of the integrator on the fastest undamped oscillation, if known.
    pub undamped: Option<Undamped>,
    /// Particle evaluations per second, measured on this machine.
    pub evaluations_per_second: f64,
    /// Wall time of the run in s at that speed, without output.
    pub seconds: f64,
    /// Memory of states and neighbour lists in bytes.
    pub memory: usize,
    /// What each rank has, where there are several.
    pub ranks: Vec<PlannedRank>,
    /// The speed of the ranks over that of as many that have the same share each and tell each other nothing, as
    /// predicted for a network with [`LATENCY`] and [`BANDWIDTH`]; 1 without ranks.
    pub efficiency: f64,
    /// What will be written, one line each.
    pub outputs: Vec<String>,
    /// What has been chosen for the user.
    pub notes: Vec<String>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// What a rank will have and do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedRank {
    /// What it has.
    pub share: RankShare,
    /// Bytes of copies that come in a step.
    pub step_bytes: usize,
    /// The share of its time in which it computes, as predicted for a network with [`LATENCY`] and [`BANDWIDTH`]. In the
    /// rest it tells others and is told; waiting for those that have more to compute is not counted.
    pub efficiency: f64,
}

/// Time in s that a message of a network takes.
pub const LATENCY: f64 = 1.5e-6;

/// Bytes a second that a network carries.
pub const BANDWIDTH: f64 = 12e9;

/// Sums over all ranks in an evaluation, and the bytes of them that a rank has: those of eight mechanisms of a loaded solid
/// with their forces, and of how fast powers grow.
const SUMS: [f64; 2] = [2.0, 38_080.0];

/// What all ranks tell all in a step beside sums, what goes from one to all, and the number of those that have something to
/// say, which goes up a tree and down again.
const ROUNDS: f64 = 10.0;

/// Bytes of a rank that all ranks get in a step: what is largest, and who has it.
const LOOK: f64 = 120.0;

/// Seconds in a step of so many evaluations in which a rank of `size` tells others and is told, in a network with [`LATENCY`]
/// and [`BANDWIDTH`], by kind: copies, of which so many bytes come from so many ranks in an evaluation; sums over all ranks;
/// rounds of all ranks.
pub fn seconds_told(size: usize, evaluations: f64, [bytes, partners]: [f64; 2]) -> [f64; 3] {
    let (size, [sums, summed]) = (size as f64, SUMS);
    let levels = size.log2().ceil();
    // It sends to those that it gets from. Sums are scattered, added and gathered again.
    let copies = bytes / BANDWIDTH + 2.0 * partners * LATENCY;
    let reduced = 2.0 * (1.0 - 1.0 / size) * summed / BANDWIDTH + 2.0 * sums * levels * LATENCY;
    let rounds = ROUNDS * levels * LATENCY + size * LOOK / BANDWIDTH;
    [evaluations * copies, evaluations * reduced, rounds]
}

/// What ranks will have and do that have as many threads each as take this many seconds for a `step` of all particles, with
/// so many evaluations of those that are divided, and the speed of all of them over that of ranks with even shares that tell
/// each other nothing.
fn planned_ranks(shares: Vec<RankShare>, evaluations: u64, step: f64) -> (Vec<PlannedRank>, f64) {
    let (size, count) = (shares.len(), evaluations as f64);
    let even = step / size.max(1) as f64;
    let mut slowest = even;
    let of_rank = |share: RankShare| {
        let computed = share.load * even;
        let told = seconds_told(size, count, [share.bytes as f64, share.partners as f64]);
        let time = computed + told.iter().sum::<f64>();
        slowest = slowest.max(time);
        let step_bytes = evaluations as usize * share.bytes;
        PlannedRank { share, step_bytes, efficiency: computed / time.max(f64::MIN_POSITIVE) }
    };
    let ranks = shares.into_iter().map(of_rank).collect();
    (ranks, even / slowest.max(f64::MIN_POSITIVE))
}

/// The fastest oscillation that the particles resolve and that nothing damps, in a run whose steps
/// are all as long as the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Undamped {
    /// Its period in s.
    pub period: f64,
    /// The factor by which its energy changes in a period.
    pub by_period: f64,
    /// The factor by which its energy changes in the whole run.
    pub by_end: f64,
}

impl Undamped {
    /// More than this, and what is lost in rounding is an energy as large as any in the run.
    const MOST: f64 = 2.0;

    fn warning(&self, integrator: &str) -> Option<String> {
        (self.by_end > Self::MOST).then(|| {
            format!(
                "nothing damps the fastest oscillation of the particles, and `{integrator}` multiplies \
                 its energy by {:.3e} until the end; use `kick_drift_kick`, which keeps it, or \
                 `ssp_rk3`, which damps it, or lower `time.cfl`",
                self.by_end
            )
        })
    }
}

/// A bound on the first step.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedLimit {
    /// Its name.
    pub name: &'static str,
    /// The largest step it allows, including the CFL number where it applies, in s.
    pub step: f64,
    /// The particle that sets it.
    pub particle: Particle,
}

/// States that a run holds: the current, the previous and the next one, two that a failed run looks
/// back to, and a rate.
const STATES: usize = 6;

/// What was found to bound a step, smallest first.
fn planned_limits(
    scheme: &dyn Scheme,
    control: StepControl,
    found: &[StepLimit],
) -> Vec<PlannedLimit> {
    let number = match control {
        StepControl::Cfl(number) => number,
        StepControl::Fixed(_) | StepControl::AtMost(_) => 1.0,
    };
    let planned = found.iter().map(|limit| PlannedLimit {
        name: limit.name,
        step: if limit.scaled { number * limit.step } else { limit.step },
        particle: scheme.particle(limit.particle),
    });
    let mut limits: Vec<PlannedLimit> = planned.collect();
    limits.sort_by(|a, b| a.step.total_cmp(&b.step));
    limits
}

impl Session {
    /// The bounds on the next step, smallest first.
    pub fn limits(&mut self) -> Vec<PlannedLimit> {
        let mut found = Vec::new();
        let state = self.executor.state().to_owned();
        self.executor.scheme.inspect(&state, &mut found);
        self.executor.look_anew();
        let control = assembly::step_control(&self.case);
        planned_limits(self.executor.scheme.as_ref(), control, &found)
    }

    /// Inspects the initial state and times the first two steps, or two evaluations of the rates if steps solve
    /// equations.
    pub fn plan(&mut self) -> Plan {
        let control = assembly::step_control(&self.case);
        let scheme = self.executor.scheme.as_mut();
        let mut state = scheme.initial_state();
        scheme.constrain(0.0, &mut state);
        let mut found = Vec::new();
        let health = scheme.inspect(&state, &mut found);
        let limits = planned_limits(scheme, control, &found);
        let mut warnings = self.built.warnings.clone();
        warnings.extend(supersonic([health.largest_speed, health.largest_wave_speed]));
        let (step, limiter) = match control.choose(&found) {
            Ok(chosen) => (chosen.step, chosen.limiter.to_owned()),
            Err(failure) => {
                warnings.push(failure.to_string());
                (limits.first().map_or(f64::NAN, |limit| limit.step), "fixed".to_owned())
            }
        };
        let [mut second, mut third] = [vec![0.0; state.len()], vec![0.0; state.len()]];
        let integrator = self.executor.integrator.as_mut();
        let evaluations = integrator.evaluations(scheme);
        let is_taken = integrator.is_timed_by_steps();
        let mut evaluate = |time: f64, old: &[f64], new: &mut [f64]| match is_taken {
            true => integrator.step(scheme, time, step, old, new),
            false => {
                scheme.rates(time, old, new);
                Ok(())
            }
        };
        // The first one touches all memory once, and counts where there is no second.
        let mut start = Instant::now();
        let failed = evaluate(0.0, &state, &mut second).err();
        if failed.is_none() {
            start = Instant::now();
            // Rates are no state: they are those of the first state again.
            let (time, old) = if is_taken { (step, &second) } else { (0.0, &state) };
            // What fails after the first step is for the run to tell.
            let _ = evaluate(time, old, &mut third);
        }
        let timed = if is_taken { evaluations as f64 } else { 1.0 };
        let evaluation = start.elapsed().as_secs_f64().max(1e-9) / timed;
        warnings.extend(failed.as_ref().map(|failure| format!("the first step fails: {failure}")));
        let own_steps = match failed {
            Some(_) => Vec::new(),
            None => scheme.own_steps(&second),
        };
        let integrator = self.executor.integrator.as_ref();
        // An end that is a multiple of the step up to round-off takes no step more.
        let steps = (*self.case.time.end / step - 1e-9).ceil().max(0.0) as u64;
        let undamped = integrator.energy_factor(0.0).and_then(|_| {
            let frequency = scheme.undamped_frequency(&state).filter(|it| *it > 0.0)?;
            let period = std::f64::consts::TAU / frequency;
            let rate = integrator.energy_factor(frequency * step)?.ln() / step;
            let [by_period, by_end] = [period, *self.case.time.end].map(|time| (rate * time).exp());
            Some(Undamped { period, by_period, by_end })
        });
        warnings.extend(undamped.and_then(|it| it.warning(integrator.name())));
        self.executor.look_anew();
        let in_step = self.executor.evaluations_in_step();
        let scheme = &self.executor.scheme;
        let ranks = self.case.ranks.as_ref().and_then(|ranks| {
            let bounds = Part::bounds(scheme.as_ref(), usize::try_from(**ranks).ok()?).ok()?;
            scheme.shares(&bounds).ok()
        });
        let of_first = own_steps.first().map_or(1, |(_, steps)| *steps);
        let (ranks, efficiency) = planned_ranks(
            ranks.unwrap_or_default(),
            evaluations * of_first,
            evaluations as f64 * evaluation,
        );
        Plan {
            efficiency,
            ranks,
            bodies: self.built.bodies.clone(),
            neighbors: self.built.neighbors,
            poorly_supported: self
                .built
                .poorly_supported
                .iter()
                .map(|&a| scheme.particle(a as usize))
                .collect(),
            limits,
            step,
            limiter,
            steps,
            own_steps,
            undamped,
            evaluations_per_second: in_step as f64 / (evaluations as f64 * evaluation),
            seconds: steps as f64 * evaluations as f64 * evaluation,
            memory: scheme.memory() + STATES * size_of_val(state.as_slice()),
            outputs: self.planned_outputs(),
            notes: self.built.notes.clone(),
            warnings,
        }
    }

    fn planned_outputs(&self) -> Vec<String> {
        let (case, end) = (&self.case, *self.case.time.end);
        let count = |interval: f64| (end / interval).floor() as u64 + 1;
        let mut outputs = vec![
            format!(
                "{}, every {} s: {}",
                counted(count(*case.output.every), "particle file", "particle files"),
                *case.output.every,
                case.output.fields.iter().map(|field| field.name).collect::<Vec<_>>().join(", ")
            ),
            format!(
                "{}, every {} s",
                counted(count(*case.output.table_every), "row of the tables", "rows of the tables"),
                *case.output.table_every
            ),
        ];
        for line in &case.probes {
            let model::ProbeKind::Line { points, times, .. } = &line.kind else { continue };
            let profiles = times.as_ref().map_or(count(*case.output.every), |it| it.len() as u64);
            let profiles = counted(profiles, "profile", "profiles");
            outputs.push(format!("{profiles} of {points} places: {}", *line.name));
        }
        let pictures: usize = case.pictures.iter().map(|picture| picture.times.len()).sum();
        if pictures + case.plots.len() > 0 {
            let pictures = counted(pictures as u64, "picture", "pictures");
            let charts = counted(case.plots.len() as u64, "chart", "charts");
            outputs.push(format!("{pictures} and {charts}"));
        }
        outputs
    }
}

/// A number of things.
pub(super) fn counted(count: u64, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}
