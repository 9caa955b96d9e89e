//! Implicit steps of the formulation, theory (55) to (57), Upwind chapters 4 to 6.
//!
//! Of v, J, x and F only v is unknown: x and F of a stage `s = b + k f(s)` are linear in it, and so
//! J follows where its own equation has no pressure dissipation; with it J is unknown too. Newton's
//! method and the linear equations are those of [`crate::solve`].

mod equations;
mod stage;
mod tangent;
mod taylor;

use num_dual::Dual64;

use super::fields::ColumnsMut;
use super::local::Unknowns;
use super::{KEPT, LEDGER, Upwind};
use crate::boundaries::BodyForce;
use crate::coordinates;
use crate::parallel::{Halo, Team};
use crate::schemes::momentum::kinetic_distance;
use crate::schemes::{Missed, NoSolution, Part, Scheme, Theta, ThetaScheme};
use crate::solve::{
    BlockMatrix, Costs, Equations, Found, LinearError, LinearMethod, LinearSolver, Newton,
    NewtonError, Reduction,
};
use crate::{Tensor, Vector};

pub use equations::StepEquations;
use stage::Fields;
use tangent::Response;

/// How the equations of implicit steps are solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImplicitSettings {
    /// How linear equations are solved.
    pub method: LinearMethod,
    /// When Newton's method has arrived, and when it gives up. Its tolerance is of the norm of the
    /// momentum at the start of a step and of what all forces would change it by.
    pub newton: Newton,
    /// Whether volume ratios are unknowns where they need not be: the result is the same, and takes
    /// longer.
    pub keeps_ratio: bool,
}

impl Default for ImplicitSettings {
    fn default() -> Self {
        Self {
            method: LinearMethod::default(),
            newton: Newton { tolerance: 1e-10, most_iterations: 30, most_halvings: 10 },
            keeps_ratio: false,
        }
    }
}

/// What implicit steps need besides the formulation itself.
///
/// Each of several ranks has all of it. They share what takes long: the rows of the matrix, products, and what particles do
/// to each other.
#[derive(Clone)]
pub(super) struct Implicit<const D: usize> {
    settings: ImplicitSettings,
    solver: LinearSolver<D>,
    matrix: BlockMatrix<D>,
    responses: Vec<Response<D>>,
    fields: Fields<f64, D>,
    dual: Option<Box<Fields<Dual64, D>>>,
    /// The base b of the stage.
    base: Vec<Unknowns<f64, D>>,
    /// The same as a state, with its ledger.
    base_state: Vec<f64>,
    rate: Vec<f64>,
    /// k in s.
    weight: f64,
    /// Body forces and tractions at the instant of the stage, N.
    outside: Vec<Vector<D>>,
    /// Velocities of prescribed components then, m/s.
    held: Vec<Vector<D>>,
    /// Sum of the sizes of the areas of each particle in m^(D-1).
    area: Vec<f64>,
    left: Vec<Vector<D>>,
    /// The unknowns that `fields` is filled for, in this step.
    evaluated: Option<Vec<f64>>,
    start: Vec<f64>,
    /// What residuals are measured against in kg m/s.
    size: f64,
    /// Steps of GMRES in the last solution with the factors of this step; none before the first.
    steps_with_factors: Option<usize>,
    linear_steps: usize,
    team: Team,
}

impl<const D: usize> Implicit<D> {
    /// Finds the pattern of the tangent.
    ///
    /// # Errors
    /// [`LinearError`] where the factors do not fit into memory.
    pub fn new(scheme: &Upwind<D>, mut settings: ImplicitSettings) -> Result<Self, LinearError> {
        settings.keeps_ratio |= scheme.settings.tau_pressure != 0.0;
        let (count, list) = (scheme.particles.len(), &scheme.support.list);
        let row = |a: usize| {
            let near = || std::iter::once(a as u32).chain(list.row(a).iter().copied());
            let two_away = near().flat_map(|b| list.row(b as usize).iter().copied());
            let mut all: Vec<u32> = near().chain(two_away).collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let matrix = BlockMatrix::new((0..count).map(row));
        let mut held = vec![[false; D]; count];
        scheme.prescribed.iter().for_each(|entry| held[entry.particle][entry.component] = true);
        let frames = vec![Tensor::identity(); count];
        let positions = &scheme.particles.position;
        let solver = LinearSolver::new(settings.method, positions, &matrix, |order| {
            Reduction::new(frames.clone(), &held, &[], order)
        })?;
        let length = count * scheme.width() + LEDGER.length(D) + KEPT;
        let mut new = Self {
            settings,
            solver,
            matrix,
            responses: vec![Response::ZERO; count],
            fields: Fields::new(count),
            dual: None,
            base: Vec::with_capacity(count),
            base_state: vec![0.0; length],
            rate: vec![0.0; length],
            weight: 0.0,
            outside: vec![Vector::zeros(); count],
            held: vec![Vector::zeros(); count],
            area: Vec::new(),
            left: vec![Vector::zeros(); count],
            evaluated: None,
            start: Vec::new(),
            size: 0.0,
            steps_with_factors: None,
            linear_steps: 0,
            team: Team::default(),
        };
        let area = |a: usize| {
            let mut area = 0.0;
            new.stage(scheme).pairs(a, |_, pair| area += pair.transposed.norm());
            area
        };
        new.area = (0..count).map(area).collect();
        Ok(new)
    }

    /// The same for a rank.
    pub fn share(&self, part: &Part) -> Self {
        let mut share = self.clone();
        if !part.is_whole() {
            // What a rank asks of others are rows of which it has all.
            let team = Team::new(part.ranks.clone(), part.bounds.clone(), Halo::default());
            share.matrix.share(team.clone());
            share.solver.share(team.clone());
            share.team = team;
        }
        share
    }

    /// Who computes together.
    pub fn team(&self) -> &Team {
        &self.team
    }

    /// Whether linear equations are solved by factors.
    pub fn is_direct(&self) -> bool {
        self.solver.is_direct()
    }

    /// What linear equations took so far.
    pub fn costs(&self) -> Costs {
        self.solver.costs()
    }

    /// Bytes of its matrix and its factors, which are most of what it holds.
    pub fn memory(&self) -> usize {
        self.matrix.memory() + self.solver.costs().factor_entries * size_of::<f64>()
    }

    /// Binds the equations to a step from `old`.
    fn bind(&mut self, scheme: &mut Upwind<D>, rule: &Theta, [time, step]: [f64; 2], old: &[f64]) {
        let instant = time + rule.instant() * step;
        self.base_state.copy_from_slice(old);
        let share = rule.share_at_start() * step;
        if share > 0.0 {
            scheme.rates(time, old, &mut self.base_state);
            let both = self.base_state.iter_mut().zip(old);
            both.for_each(|(base, old)| *base = old + share * *base);
        }
        self.weight = rule.weight() * step;
        self.base.clear();
        let at = scheme.columns(&self.base_state);
        self.base.extend((0..scheme.particles.len()).map(|a| Unknowns::of(&at, a)));
        for (a, outside) in self.outside.iter_mut().enumerate() {
            let (body, x) = (scheme.particles.body[a], &scheme.particles.position[a]);
            *outside = BodyForce::sum(&scheme.body_forces, body, x, instant) * scheme.mass(a);
        }
        for load in &scheme.loaded {
            self.outside[load.particle] += load.force(instant);
        }
        for entry in scheme.prescribed.iter() {
            self.held[entry.particle][entry.component] = entry.at(instant);
        }
        self.evaluated = None;
        (self.steps_with_factors, self.linear_steps) = (None, 0);
        self.solver.restart();
    }
}

impl<const D: usize> Upwind<D> {
    /// Shows the equations of one step of `rule` from `old` at `time`; nothing if the formulation was
    /// not built for implicit steps.
    pub fn with_step_equations<R>(
        &mut self,
        rule: &Theta,
        [time, step]: [f64; 2],
        old: &[f64],
        look: impl FnOnce(&mut StepEquations<'_, D>) -> R,
    ) -> Option<R> {
        let mut parts = self.implicit.take()?;
        parts.bind(self, rule, [time, step], old);
        let mut equations = StepEquations { scheme: self, parts: &mut parts };
        equations.prepare(old);
        let result = look(&mut equations);
        self.implicit = Some(parts);
        Some(result)
    }
}

impl<const D: usize> StepEquations<'_, D> {
    /// Chooses where to start: at the velocities of `old`, or at rest where they would turn a
    /// particle inside out within the step.
    fn prepare(&mut self, old: &[f64]) {
        let velocity = self.scheme.columns(old).velocity;
        let mut start = self.start_at(velocity);
        if self.trial(0.0, &start).broken.is_some() {
            start = self.start_at(&vec![Vector::zeros(); velocity.len()]);
        }
        self.evaluate(&start);
        self.measure();
        self.parts.start = start;
    }

    /// Finds the stage and writes its columns to `new`; returns the iterations.
    fn find(&mut self, new: &mut [f64]) -> Result<usize, NewtonError> {
        let (mut x, newton) = (self.start(), self.parts.settings.newton);
        if let Some(particle) = self.trial(0.0, &x).broken {
            return Err(NewtonError::Broken { particle, history: Vec::new(), residual: f64::NAN });
        }
        let Found { iterations, .. } = newton.find(self, 0.0, &mut x, Vec::new())?;
        self.evaluate(&x);
        let stage = self.parts.stage(self.scheme);
        let fields = &self.parts.fields;
        let (own, _) = ColumnsMut::<D>::of(new, fields.locals.len());
        for (a, local) in fields.locals.iter().enumerate() {
            let (unknowns, _) = stage.unknowns(a, &fields.velocity[a], &local.gradient);
            own.velocity[a] = unknowns.velocity;
            own.volume_ratio[a] = local.ratio;
            own.position[a] = unknowns.position;
            own.deformation_gradient[a] = unknowns.deformation;
        }
        Ok(iterations.len())
    }

    /// What to say of a step without a solution, from `time` to `end`.
    fn missed(&self, [time, end]: [f64; 2], error: &NewtonError) -> NoSolution {
        let broken = match *error {
            NewtonError::Broken { particle, .. } => Some(particle),
            _ => None,
        };
        let particle = self.scheme.particle(broken.unwrap_or_else(|| self.worst()));
        let kind = if broken.is_some() { Missed::Inverted } else { Missed::NoConvergence };
        let what = match broken {
            Some(_) => "is inverted on every attempt".to_owned(),
            None => format!("has the largest residual: {error}"),
        };
        NoSolution {
            kind,
            time: end,
            reached: time,
            message: format!(
                "no state was found at t = {end:.6} s, a step after t = {time:.6} s: particle {} \
                 (reference position {} m) {what}; lower `time.step`, or let \
                 `time.on_failure = \"retry\"` halve it",
                particle.id,
                coordinates(&particle.reference)
            ),
        }
    }
}

impl<const D: usize> ThetaScheme for Upwind<D> {
    /// Prescribed components have their values at the instant of the stage, and at the end.
    #[inline(never)]
    fn advance(
        &mut self,
        rule: &Theta,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), NoSolution> {
        let end = time + step;
        let found = self.with_step_equations(rule, [time, step], old, |equations| {
            let iterations =
                equations.find(new).map_err(|error| equations.missed([time, end], &error))?;
            Ok((iterations, equations.parts.linear_steps))
        });
        let (iterations, linear_steps) = found.unwrap_or(Ok((0, 0)))?;
        let Some(mut parts) = self.implicit.take() else { return Ok(()) };
        // Work and impulses follow the same rule, by the rates of the explicit passes.
        let mut rate = std::mem::take(&mut parts.rate);
        self.rates(time + rule.instant() * step, new, &mut rate);
        let [base, rates] = [&parts.base_state, &rate].map(|state| self.columns(state).tail);
        let (_, tail) = ColumnsMut::<D>::of(new, self.particles.len());
        for (entry, (base, rate)) in tail.iter_mut().zip(base.iter().zip(rates)) {
            *entry = base + parts.weight * rate;
        }
        parts.rate = rate;
        self.implicit = Some(parts);
        rule.finish(old, new);
        self.constrain(end, new);
        let (_, tail) = ColumnsMut::<D>::of(new, self.particles.len());
        LEDGER.behind_mut(D, tail).copy_from_slice(&[iterations as f64, linear_steps as f64]);
        Ok(())
    }

    #[inline(never)]
    fn remainders(
        &mut self,
        rule: &Theta,
        time: f64,
        step: f64,
        state: &[f64],
        sizes: &[f64],
    ) -> Vec<f64> {
        let found = self.with_step_equations(rule, [time, step], state, |equations| {
            let x = equations.start();
            equations.remainders(&x, sizes)
        });
        found.unwrap_or_default()
    }

    #[inline(never)]
    fn kinetic_distance(&self, one: &[f64], other: &[f64]) -> f64 {
        let velocities = [one, other].map(|state| self.columns(state).velocity);
        kinetic_distance(velocities, |a| self.mass(a))
    }
}
