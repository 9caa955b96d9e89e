//! What fluids and solids share: particles that move with a transport velocity, their neighbours, walls,
//! surfaces and shifting. Nothing here knows of what matter they are.

use std::ops::Range;

use piola_formulas::pairs::Record;
use piola_formulas::pairs::fluid::FluidSide;

use super::barrier::Hold;
use super::fields::{Columns, ColumnsMut, Made};
use super::shifting::Iteration;
use super::sides::Side;
use super::surface::Opening;
use super::walls::{WallParticle, WallValues};
use super::{Continua, Continuum, DensityRule, Forces, Guard, Guided, Settings};
use crate::Vector;
use crate::boundaries::BodyForce;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::fields::width;
use crate::geometry::Particles;
use crate::neighbors::SkinList;
use crate::operators::MovingSupport;
use crate::parallel::Team;
use crate::schemes::{Array, RankRows};

/// The matter of a body where nothing presses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtRest {
    /// Density rho0 in kg/m^3.
    pub density: f64,
    /// Speed of bulk waves in m/s.
    pub wave_speed: f64,
}

impl AtRest {
    /// `1 / (rho0 c)^2`: half of it times the square of a pressure is the energy of compression of a mass, over that mass.
    pub(super) fn compliance(&self) -> f64 {
        (self.density * self.wave_speed).powi(-2)
    }
}

/// Particles of any continuum in the formulation.
pub struct Common<const D: usize> {
    /// Reference state; the number of a particle is its index here.
    pub(super) particles: Particles<D>,
    pub(super) support: MovingSupport<D>,
    /// Where the particles of each rank stand in a state of all, if there are several.
    pub(super) rows: Option<RankRows>,
    pub(super) settings: Settings,
    /// By body.
    pub(super) at_rest: Vec<AtRest>,
    /// Mass by number in kg, or the volume in m^D of what fills it at any density.
    pub(super) mass: Vec<f64>,
    /// By body: whether its particles fill their volumes at any density, as those of walls do.
    pub(super) fills: Vec<bool>,
    pub(super) is_wall: Vec<bool>,
    /// The particles that are not shifted, by number; empty where all are.
    pub(super) unshifted: Vec<bool>,
    pub(super) walls: Vec<WallParticle<D>>,
    pub(super) wall_values: Vec<WallValues<D>>,
    /// Velocity with which walls move, and with which their surface slides where it is.
    pub(super) motion: PrescribedComponents,
    pub(super) sliding: PrescribedComponents,
    /// The walls that somebody else moves.
    pub(super) guided: Guided<D>,
    pub(super) body_forces: Vec<BodyForce<D>>,
    /// To which continuum a particle belongs, by place.
    pub(super) continua: Continua<D>,
    /// The largest speed that the last pass over densities has seen, in m/s.
    pub(super) fastest: f64,
    // Scratch, by place: that of which neighbours see something has room for copies, too.
    pub(super) sides: Vec<Side<D>>,
    pub(super) forces: Vec<Forces<D>>,
    /// What walls do to what touches them; empty without walls.
    pub(super) holds: Vec<Hold<D>>,
    /// Where free surfaces are, if they are looked for, and scratch of the search.
    pub(super) openings: Vec<Opening<D>>,
    pub(super) found: Vec<(Vector<D>, bool)>,
    pub(super) marks: Vec<bool>,
    pub(super) volumes: Vec<f64>,
    pub(super) iteration: Iteration<D>,
    /// Who looks for particles that escape, with the width of everything at the start in m.
    pub(super) guard: Option<(Guard, f64)>,
    /// The particles that have been removed, by number; empty where none ever is. They are passive,
    /// as walls are.
    pub(super) removed: Vec<bool>,
    /// The first particle whose place was no number, if the neighbours could not be found.
    pub(super) lost: Option<usize>,
}

impl<const D: usize> Common<D> {
    /// Particles with their neighbours, each with a mass in kg.
    pub(super) fn new(
        particles: Particles<D>,
        support: MovingSupport<D>,
        settings: Settings,
        (is_wall, walls): (Vec<bool>, Vec<WallParticle<D>>),
        (at_rest, mass): (Vec<AtRest>, Vec<f64>),
    ) -> Self {
        let count = support.list().owned();
        let touched = if walls.is_empty() { 0 } else { count };
        let looked_for = if settings.free_surface { count } else { 0 };
        let mut fills = vec![false; at_rest.len()];
        walls.iter().for_each(|it| fills[particles.body[it.number as usize] as usize] = true);
        Self {
            mass,
            fills,
            sides: vec![FluidSide::zero(); count],
            forces: vec![Forces::default(); count],
            holds: vec![Hold::default(); touched],
            wall_values: vec![WallValues::default(); walls.len()],
            openings: vec![Opening::default(); looked_for],
            found: vec![(Vector::zeros(), false); looked_for],
            marks: vec![false; looked_for],
            volumes: Vec::with_capacity(looked_for),
            continua: Continua::one(*support.list().domain()),
            iteration: Iteration::default(),
            unshifted: Vec::new(),
            motion: PrescribedComponents::default(),
            sliding: PrescribedComponents::default(),
            guided: Guided::default(),
            body_forces: Vec::new(),
            fastest: 0.0,
            guard: None,
            removed: Vec::new(),
            lost: None,
            rows: None,
            particles,
            support,
            settings,
            at_rest,
            is_wall,
            walls,
        }
    }

    /// Those of a rank which has `count` of them.
    pub(super) fn part(&self, team: Team, count: usize, rows: RankRows) -> Self {
        let support = self.support.part(team, count);
        let walls = (self.is_wall.clone(), self.walls.clone());
        let matter = (self.at_rest.clone(), self.mass.clone());
        Self {
            unshifted: self.unshifted.clone(),
            motion: self.motion.clone(),
            sliding: self.sliding.clone(),
            guided: self.guided.clone(),
            body_forces: self.body_forces.clone(),
            continua: self.continua.renewed(),
            iteration: self.iteration.clone(),
            guard: self.guard.clone(),
            removed: self.removed.clone(),
            fills: self.fills.clone(),
            rows: Some(rows).filter(|_| !support.list().team().is_alone()),
            ..Self::new(self.particles.clone(), support, self.settings, walls, matter)
        }
    }

    /// The columns of a state, and what stands behind them.
    pub(super) fn columns<'a>(&self, state: &'a [f64]) -> Columns<'a, D> {
        Columns::of(state, self.count())
    }

    /// The same, to be changed.
    pub(super) fn parts<'a>(&self, state: &'a mut [f64]) -> (ColumnsMut<'a, D>, &'a mut [f64]) {
        ColumnsMut::of(state, self.count())
    }

    /// The columns of a state of the particles of all ranks.
    pub(super) fn all_columns<'a>(&self, whole: &'a [f64]) -> Columns<'a, D> {
        Columns::of(whole, self.particles.len())
    }

    /// The same, to be changed.
    pub(super) fn all_parts<'a>(&self, whole: &'a mut [f64]) -> (ColumnsMut<'a, D>, &'a mut [f64]) {
        ColumnsMut::of(whole, self.particles.len())
    }

    /// Who computes together.
    pub(super) fn team(&self) -> &Team {
        self.support.list().team()
    }

    /// The particles of a state: all, or those of this rank.
    pub(super) fn count(&self) -> usize {
        self.support.list().owned()
    }

    /// The number of the first particle of a state, whose row is 0.
    pub(super) fn first(&self) -> usize {
        self.team().first()
    }

    /// The row of a particle (number) in a state, if it is one of this rank.
    pub(super) fn row(&self, number: usize) -> Option<usize> {
        self.team().own(number, self.count())
    }

    /// The walls (indices) of this rank.
    pub(super) fn own_walls(&self) -> Range<usize> {
        let place =
            |number: usize| self.walls.partition_point(|wall| (wall.number as usize) < number);
        place(self.first())..place(self.first() + self.count())
    }

    /// Makes room for what places have, of which a new list may have more.
    pub(super) fn make_room(&mut self) {
        let all = self.support.list().len();
        self.sides.resize(all, FluidSide::zero());
        if !self.holds.is_empty() {
            self.holds.resize(all, Hold::default());
        }
        if self.settings.free_surface {
            self.openings.resize(all, Opening::default());
            self.marks.resize(all, false);
        }
    }

    /// Shows what neighbours see of own particles to the ranks that have copies of them.
    pub(super) fn show_sides(&mut self) {
        let (team, owned) = (self.support.list().team(), self.support.list().owned());
        team.refresh_records::<FluidSide<D>>(&mut self.sides, owned);
    }

    /// Matter of a particle (number) where nothing presses.
    pub(super) fn at_rest(&self, number: usize) -> &AtRest {
        &self.at_rest[self.particles.body[number] as usize]
    }

    /// Whether a particle (number) fills its volume at any density.
    pub(super) fn fills(&self, number: usize) -> bool {
        self.fills[self.particles.body[number] as usize]
    }

    /// Mass in kg of a particle (number) of a density in kg/m^3.
    pub(super) fn mass_at(&self, number: usize, density: f64) -> f64 {
        weigh(self.mass[number], self.fills(number), density)
    }

    /// `1 / (rho0 c)^2` of a particle (number).
    pub(super) fn compliance(&self, number: usize) -> f64 {
        let AtRest { density, wave_speed } = self.at_rest(number);
        (density * wave_speed).powi(-2)
    }

    /// Whether a particle (number) is not shifted.
    pub(super) fn is_unshifted(&self, number: usize) -> bool {
        self.unshifted.get(number).is_some_and(|is_unshifted| *is_unshifted)
    }

    /// A place, if the particle there is not passive.
    pub(super) fn active(&self, place: usize) -> Option<usize> {
        (!self.support.list().is_passive(place)).then_some(place)
    }

    /// A place, if the particle there is passive: of a wall, or removed.
    pub(super) fn passive(&self, place: usize) -> Option<usize> {
        self.support.list().is_passive(place).then_some(place)
    }

    /// The body forces in m/s^2 at a particle, where it is now.
    pub(super) fn body_force_at(&self, number: usize, place: usize, time: f64) -> Vector<D> {
        let position = &self.support.list().positions()[place];
        BodyForce::sum(&self.body_forces, self.particles.body[number], position, time)
    }

    /// What columns stand in that are of all matter.
    pub(super) fn arrays<M: Continuum<D>>(&self) -> Vec<Array> {
        let (list, count) = (self.support.list(), self.count());
        let rows = |name, is_counted: fn(&SkinList<D>, usize) -> bool| {
            Array::rows(name, self.support.sizes(|place| is_counted(list, place)), count)
        };
        let summed = match self.settings.density {
            DensityRule::Summation => rows("neighbors.summed", |_, _| true),
            _ => Array::with("neighbors.summed", 0),
        };
        let own = width(M::DESCRIPTION.fields, D) - width(Made::FIELDS, D);
        let all = [
            Array::of::<Vector<D>>("acceleration"),
            Array::of::<Vector<D>>("shifting_velocity"),
            Array::with("material_state", own * size_of::<f64>()),
            Array::of::<f64>("mass"),
            Array::of::<u32>("body"),
            Array::of::<u32>("order"),
            Array::of::<Vector<D>>("place"),
            Array::of::<Side<D>>("side"),
            Array::of::<Forces<D>>("forces"),
            Array::of::<Opening<D>>("surface"),
            Array::of::<bool>("on_surface"),
            Array::of::<Hold<D>>("barrier"),
            Array::spread("wall_motion", size_of_val(self.wall_values.as_slice()), count),
            rows("neighbors", |_, _| true),
            rows("neighbors.active", |list, place| !list.is_passive(place)),
            rows("neighbors.passive", SkinList::is_passive),
            summed,
            Array::rows("candidates", self.support.candidates(), count),
        ];
        // These are few numbers, or of few particles.
        let few = ["fastest", "ledger", "buffers", "openings", "damping"];
        let few = few.into_iter().map(|name| Array::with(name, 0));
        Array::columns(Made::FIELDS, D).chain(all).chain(few).collect()
    }

    /// Bytes of arrays by particle.
    pub(super) fn memory(&self) -> usize {
        let particle = size_of::<Side<D>>() + size_of::<Forces<D>>() + 2 * size_of::<f64>();
        let held = self.holds.len() * size_of::<Hold<D>>();
        self.support.memory() + self.particles.len() * particle + held
    }
}

/// Mass in kg of a particle of a density in kg/m^3, from the mass or from the volume that it fills in m^D.
pub(super) fn weigh(amount: f64, fills: bool, density: f64) -> f64 {
    if fills { amount * density } else { amount }
}
