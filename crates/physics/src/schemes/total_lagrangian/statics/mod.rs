//! Statics: states in equilibrium with loads that grow with a load factor.
//!
//! The potential `E(u) - f . u` of [`Discrete`] is stationary in the components that supports leave
//! free; its Hessian is the [`Stiffness`]. With the quadratic potential of inertia about the
//! displacements of a motion without forces, the same equations are an implicit step. How zeros are
//! found, and in which steps, is the part of [`crate::solve`].

mod advance;
mod equations;
mod error;
mod faces;
mod inertia;
mod passes;
mod rigid;
mod sensitivity;
mod stiffness;
mod supports;

pub use advance::Known;
pub use error::StaticsError;
pub use error::free_to_move;
pub use inertia::InertialStep;
pub use stiffness::Stiffness;

use std::sync::Arc;

use piola_ranks::RankError;

use super::{Discrete, Loads};
use crate::Vector;
use crate::boundaries::{
    BodyForce, FollowerPressure, PrescribedDisplacement, PrescribedFaces, Tie, Traction,
};
use crate::operators::Trace;
use crate::parallel::Team;
use crate::schemes::Part;
use crate::schemes::input::{check_pressure, check_traction};
use crate::solve::{
    ArcLength, Costs, Increment, LinearMethod, LinearSolver, LoadSteps, Newton, Solved, follow,
    follow_arc,
};
use faces::Faces;
use inertia::Inertia;
use passes::Passes;
use rigid::free_motion;
use supports::Supports;

/// What acts on a body and holds it, all of it functions of place and load factor, and how
/// equilibrium is found.
#[derive(Clone, Default)]
pub struct StaticsInput<const D: usize> {
    /// Body forces, which add up.
    pub body_forces: Vec<BodyForce<D>>,
    /// Dead tractions, which add up.
    pub tractions: Vec<Traction<D>>,
    /// Pressures that follow the surface, which add up.
    pub pressures: Vec<FollowerPressure<D>>,
    /// Prescribed displacements; of two in the same direction the later one holds.
    pub prescribed: Vec<PrescribedDisplacement<D>>,
    /// Boundary faces of cells, where particles are centres of cells.
    pub trace: Option<Trace<D>>,
    /// Prescribed displacements of faces of the trace.
    pub prescribed_faces: Vec<PrescribedFaces<D>>,
    /// Particles that move together.
    pub ties: Vec<Tie>,
    /// How linear equations are solved.
    pub method: LinearMethod,
    /// When Newton's method has arrived, and when it gives up.
    pub newton: Newton,
}

impl<const D: usize> StaticsInput<D> {
    /// The loads on a body.
    fn loads(&self, discrete: &Discrete<D>) -> Result<Loads<D>, StaticsError> {
        let (count, positions) = (discrete.len(), &discrete.solid.particles.position);
        self.tractions.iter().try_for_each(|load| check_traction(load, count))?;
        self.pressures.iter().try_for_each(|load| check_pressure(load, count))?;
        Ok(Loads {
            body_forces: self.body_forces.clone(),
            loaded: self.tractions.iter().flat_map(|load| load.loaded(positions)).collect(),
            pressed: self.pressures.iter().flat_map(|load| load.pressed(positions)).collect(),
            springs: Vec::new(),
        })
    }
}

/// A body with loads and supports.
///
/// Each of several ranks has all of it. They share what takes long: the products of Krylov methods, internal forces and
/// energies, tangents, and the coarse space, each rank with the rows of its own particles.
#[derive(Clone)]
pub struct Statics<const D: usize> {
    discrete: Arc<Discrete<D>>,
    loads: Loads<D>,
    supports: Supports<D>,
    faces: Faces<D>,
    solver: LinearSolver<D>,
    stiffness: Stiffness<D>,
    newton: Newton,
    /// Displacements in m, those of images behind.
    displacement: Vec<Vector<D>>,
    passes: Passes<D>,
    /// Internal forces in N, with places for those on images.
    internal: Vec<Vector<D>>,
    /// What loads and internal forces leave, held components included, N.
    left: Vec<Vector<D>>,
    /// Dead loads at one load factor, N.
    dead: Option<(f64, Vec<Vector<D>>)>,
    /// In a step of a body in motion.
    inertia: Option<Inertia<D>>,
    /// Whether the tangent of the body is the same in all states. It is then made at rest, and
    /// factorised anew for another inertia only.
    is_linear: bool,
    /// Inertia of the tangent that the solver has, and whether it was to be definite.
    loaded: Option<(f64, bool)>,
    /// Who computes together.
    team: Team,
}

/// A state in equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticState<const D: usize> {
    /// The load factor.
    pub factor: f64,
    /// Displacements in m.
    pub displacement: Vec<Vector<D>>,
    /// Force of the supports on each particle in N, that of held faces by their coefficients.
    pub support_force: Vec<Vector<D>>,
    /// Force of each condition on the body, in their order, those of faces last.
    pub reactions: Vec<Reaction<D>>,
    /// Strain and hourglass energy in J.
    pub energies: [f64; 2],
    /// What it took.
    pub solved: Solved,
    /// Whether it may lie beyond a limit of the load that the step to it went over.
    pub jumped: bool,
}

/// What a condition holds the body with.
#[derive(Clone, Debug, PartialEq)]
pub struct Reaction<const D: usize> {
    /// Name of the condition.
    pub name: String,
    /// The force on the body in N.
    pub force: Vector<D>,
}

impl<const D: usize> Statics<D> {
    /// Binds loads and supports to a body, and finds the pattern of its stiffness.
    ///
    /// # Errors
    /// [`StaticsError`] for conditions on what does not exist or that contradict each other, and
    /// for bodies that are free to move as a whole.
    pub fn new(discrete: Arc<Discrete<D>>, input: StaticsInput<D>) -> Result<Self, StaticsError> {
        let loads = input.loads(&discrete)?;
        Self::resting(discrete, input, loads)
    }

    /// As [`Self::new`], under loads that are known, and not those of `input`.
    pub(super) fn resting(
        discrete: Arc<Discrete<D>>,
        input: StaticsInput<D>,
        loads: Loads<D>,
    ) -> Result<Self, StaticsError> {
        let statics = Self::moving(discrete, input, loads)?;
        let Self { discrete, supports, faces, stiffness, .. } = &statics;
        let (particles, parts) = (&discrete.solid.particles, stiffness.parts());
        let Some((first, motion)) = free_motion(particles, &parts, supports, faces.springs())
        else {
            return Ok(statics);
        };
        let body = particles.body[first];
        let is_whole = |a: usize| particles.body[a] != body || parts[a] == parts[first];
        let part = match (0..particles.len()).all(is_whole) {
            true => None,
            false => Some((particles.id[first], particles.position[first].as_slice().to_vec())),
        };
        Err(StaticsError::Free { body, part, motion })
    }

    /// As [`Self::resting`], for a body that may move as a whole, with inertia: for [`Self::march`].
    pub(super) fn moving(
        discrete: Arc<Discrete<D>>,
        input: StaticsInput<D>,
        loads: Loads<D>,
    ) -> Result<Self, StaticsError> {
        let StaticsInput { prescribed, prescribed_faces, ties, .. } = input;
        let (solid, count) = (&*discrete.solid, discrete.len());
        let supports = Supports::new(&solid.particles, prescribed, ties)?;
        let shear = |a: usize| solid.mixture(a).shear_modulus();
        let faces = Faces::new(input.trace.as_ref(), prescribed_faces, shear)?;
        let mut stiffness = Stiffness::new(discrete.clone());
        stiffness.hold(faces.springs());
        let places = &solid.particles.position;
        let solver =
            LinearSolver::new(input.method, places, &stiffness, |order| supports.reduction(order))?;
        let passes = Passes::new(&discrete.operator);
        let (is_linear, slots) = (solid.is_linear(), discrete.operator.positions().len());
        Ok(Self {
            discrete,
            loads,
            supports,
            faces,
            solver,
            stiffness,
            newton: input.newton,
            displacement: vec![Vector::zeros(); slots],
            passes,
            internal: vec![Vector::zeros(); slots],
            left: vec![Vector::zeros(); count],
            dead: None,
            inertia: None,
            is_linear,
            loaded: None,
            team: Team::default(),
        })
    }

    /// The same for a rank. All ranks call this together.
    ///
    /// # Errors
    /// A rank is lost.
    pub(super) fn share(&self, part: &Part) -> Result<Self, RankError> {
        let mut share = self.clone();
        share.loaded = None;
        (share.passes, share.team) = Passes::of_rank(&self.discrete, part)?;
        share.stiffness.share(&share.passes, &share.team);
        share.solver.share(share.team.clone());
        Ok(share)
    }

    /// Who computes together.
    pub(super) fn team(&self) -> &Team {
        &self.team
    }

    /// Whether linear equations are solved by factors.
    pub(super) fn is_direct(&self) -> bool {
        self.solver.is_direct()
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.solver.reduction().unknowns()
    }

    /// Bytes of its arrays, but for those of linear equations.
    pub fn memory(&self) -> usize {
        self.stiffness.memory()
            + self.passes.memory()
            + size_of_val(self.displacement.as_slice())
            + size_of_val(self.internal.as_slice())
            + size_of_val(self.left.as_slice())
    }

    /// What the linear equations took so far.
    pub fn costs(&self) -> Costs {
        self.solver.costs()
    }

    /// The states at all load steps, from rest.
    ///
    /// # Errors
    /// [`StaticsError`] for the first load factor without a stable equilibrium.
    pub fn solve(&mut self, steps: &LoadSteps) -> Result<Vec<StaticState<D>>, StaticsError> {
        let mut states = Vec::new();
        self.solve_with(steps, |state| states.push(state))?;
        Ok(states)
    }

    /// As [`Self::solve`], showing each state when it is found.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn solve_with(
        &mut self,
        steps: &LoadSteps,
        mut show: impl FnMut(StaticState<D>),
    ) -> Result<(), StaticsError> {
        let (newton, start) = (self.newton, vec![0.0; self.unknowns()]);
        self.faces.reset();
        self.solver.restart();
        follow(self, &newton, steps, start, |statics, increment| show(statics.state(increment)))
            .map_err(|error| self.named(error))
    }

    /// Follows the path from rest through limit points as long as `show` wants more.
    ///
    /// # Errors
    /// [`StaticsError`] where the path is lost.
    pub fn follow_arc(
        &mut self,
        arc: &ArcLength,
        mut show: impl FnMut(StaticState<D>) -> bool,
    ) -> Result<(), StaticsError> {
        let (newton, start) = (self.newton, vec![0.0; self.unknowns()]);
        self.faces.reset();
        follow_arc(self, &newton, arc, start, |statics, increment| show(statics.state(increment)))
            .map_err(|error| self.named(error))
    }

    fn state(&mut self, increment: Increment) -> StaticState<D> {
        let Increment { factor, x, solved, jumped } = increment;
        self.balance(factor, &x);
        let reduction = self.solver.reduction();
        let held: Vec<Vector<D>> =
            self.left.iter().enumerate().map(|(a, left)| -reduction.held_part(a, left)).collect();
        let mut forces = vec![Vector::zeros(); self.supports.names().count()];
        for entry in self.supports.entries() {
            let axis = self.supports.frame(entry.particle).column(entry.component);
            let along = axis.dot(&held[entry.particle]);
            forces[entry.condition] += axis * along;
        }
        let named = self.supports.names().map(str::to_owned).zip(forces);
        let faces = self.faces.reactions(&self.displacement, factor);
        let reactions = named.chain(faces).map(|(name, force)| Reaction { name, force });
        StaticState {
            factor,
            displacement: self.displacement[..self.left.len()].to_vec(),
            reactions: reactions.collect(),
            support_force: if self.faces.springs().is_empty() {
                held
            } else {
                self.holding(factor, &x)
            },
            energies: self.discrete.total_energy(&self.displacement),
            solved,
            jumped,
        }
    }
}
