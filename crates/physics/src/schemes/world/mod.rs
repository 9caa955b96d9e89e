//! Several systems in one run: a fluid, and solids that it flows around.
//!
//! The fluid is [`TransportVelocity`]; a solid is any formulation with velocities and places in its state. To the
//! fluid a solid is a wall that moves: particles of its own, at its own spacing, fill the solid and are
//! carried by it, theory (81): by the particles around them in the reference configuration. Those of a hypoelastic solid change
//! their neighbours; they carry the same walls all the same, and the run ends where they have come apart or flowed so far
//! that the reference says nothing any more ([`Scheme::keeps_neighbors`]). Their ghost values are those of all walls, theory (31), (32), with the
//! velocity of the solid and with normals that follow its deformation, `n = F^-T N / |F^-T N|`. What the fluid
//! does to them, from the same pairs turned round, is what the solid gets.
//!
//! A step splits what the systems do alone from what they do to each other, theory (82):
//!
//! ```text
//! v_s <- v_s + dt/(2n) f(t)/m       the solid takes a part of the impulse of the fluid
//! (x_s, v_s, ...) <- n own steps    of the solid, by its own integrator, v_s <- v_s + dt/n f(t)/m between two
//! m times kick, drift, kick         of the fluid, with walls that go from the old to the new places of the solid
//! v_s <- v_s + (J - (1 - 1/(2n)) dt f(t))/m   with the impulse J of the fluid in its steps
//! ```
//!
//! The force is held, as impulses once a step would drive vibrations of the solid with a whole number of periods in it.
//! Each part is of second order, but for terms of first order that the fluid has by itself. The solid gets the impulse that
//! the fluid gives, so linear momentum is kept to round-off. A solid with faster waves takes more steps of its own, and
//! one in implicit steps takes one; of slower and heavy ones the fluid takes several steps in one of theirs.
//!
//! The ghost pressure of a solid's surface leaves out the acceleration of the surface, `-rho a . r` over
//! less than a spacing, which is an added mass that acts a step late: with it solids lighter than the fluid
//! are unstable. What it leaves out is of first order in the spacing.

mod contact;
mod coupled;
mod description;
mod flow;
mod interface;
mod scheme;
mod share;

use std::ops::Range;

use thiserror::Error;

use self::contact::Contact;
pub use self::contact::{ContactLaw, MOST_DAMPING, MOST_STIFFNESS};
use self::description::{INTERFACE, WALLS};
pub use self::flow::MOST_FLUID_STEPS;
use self::flow::{Way, shortest};
use self::interface::Interface;
pub use self::interface::{InterfaceError, MOST_RATIO};
use crate::coordinates;
use crate::fields::FieldKind;
use crate::neighbors::Domain;
use crate::schemes::parts::Parts;
use crate::schemes::transport_velocity::{TransportVelocity, WallSelection};
use crate::schemes::{Particle, Scheme, SchemeDescription, StepLimit};
use crate::{Tensor, Vector};

/// Most steps of a solid in one of the fluid.
pub const MOST_STEPS: u64 = 1000;

/// A solid of a world.
pub struct SolidInput {
    /// The name of its system.
    pub name: String,
    /// The formulation, bound to its particles.
    pub scheme: Box<dyn Scheme>,
    /// Its spacing in m.
    pub spacing: f64,
    /// Which bodies of the fluid stand for it.
    pub bodies: Vec<u32>,
    /// The numbers of its bodies in the run.
    pub numbers: Vec<u32>,
    /// The CFL number of its own steps; `None` where they are as long as those of the fluid.
    pub cfl: Option<f64>,
    /// How it is kept apart from walls and other solids.
    pub law: ContactLaw,
}

/// Systems that make no world.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum WorldError {
    /// Fluid and solid cannot be coupled.
    #[error("{error}")]
    Interface {
        /// The number of the solid.
        solid: usize,
        /// Why.
        error: InterfaceError,
    },
    /// Two bodies are in the same place.
    #[error(
        "the bodies of the system `{system}` and others overlap: particle {id} of these, at {at} m, lies inside \
         one of `{system}`, or closer to its particles than in two adjacent bodies",
        at = coordinates(position)
    )]
    Overlap {
        /// Name of the system.
        system: String,
        /// Number of the particle of the other body in the order of creation.
        id: u32,
        /// Where it is in m.
        position: Vec<f64>,
    },
    /// The formulation has no velocities that a fluid could change.
    #[error("the scheme `{scheme}` of the system `{system}` cannot move with a fluid")]
    Motion {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the system.
        system: String,
    },
}

/// A solid bound to the fluid around it.
struct Solid<const D: usize> {
    /// The name of its system.
    name: String,
    scheme: Box<dyn Scheme>,
    interface: Interface<D>,
    cfl: Option<f64>,
    law: ContactLaw,
    spacing: f64,
    /// The number of its first wall particle among those of all solids.
    first: usize,
    /// In which time in s waves of the fluid stop a layer of its particles.
    layer: f64,
    mass: Vec<f64>,
    reference: Vec<Vector<D>>,
    /// Whether its state has displacements, and not positions, which may be wrapped into the box.
    is_displaced: bool,
    domain: Domain<D>,
    /// Where displacements or positions, and velocities, stand in its part of a state.
    places: Range<usize>,
    velocities: Range<usize>,
    /// The numbers of its bodies in the run.
    numbers: Vec<u32>,
    limits: Vec<StepLimit>,
}

/// A fluid with solids in it.
pub struct World<const D: usize> {
    description: &'static SchemeDescription,
    fluid: TransportVelocity<D>,
    /// The CFL number of the fluid's own steps; `None` where steps are given.
    cfl: Option<f64>,
    solids: Vec<Solid<D>>,
    contact: Contact<D>,
    /// The wall particles of the fluid that stand for solids.
    guided: WallSelection,
    /// Where the work of all walls stands among those of the fluid.
    walls: usize,
    /// Those of the fluid, then of each solid.
    parts: Parts,
    start: Vec<f64>,
    // Scratch: by solid forces of the fluid on its particles; those of the start of a step and those of others then; velocities
    // of a solid before, how walls go through a step, which forces are left to give by wall.
    forces: Vec<Vec<Vector<D>>>,
    held: [Vec<Vec<Vector<D>>>; 2],
    before: Vec<Vector<D>>,
    /// The ledger of a solid.
    booked: Vec<f64>,
    /// By solid, what others do to its particles where they touch.
    touches: Vec<Vec<Vector<D>>>,
    /// Places of the solids for which walls have been turned and surfaces have met; none while they turn.
    known: Vec<f64>,
    ways: Vec<Way<D>>,
    /// By wall, its place and its velocity, and the force of the fluid at the moment in N.
    carried: Vec<[Vector<D>; 2]>,
    pulls: Vec<Vector<D>>,
    rest: Vec<Vector<D>>,
    /// Places and velocities of the walls that solids may touch.
    fixed_at: Vec<[Vector<D>; 2]>,
    /// Bounds on the step of the fluid by itself, of the state that was looked at last.
    limits: Vec<StepLimit>,
}

impl<const D: usize> World<D> {
    /// Couples `solids` with a `fluid` that has walls in their place. With the CFL number `cfl` of its own steps, the
    /// fluid may take several in one of the run, which is then that of slower solids.
    ///
    /// # Errors
    /// [`WorldError`] for systems that do not fit together.
    #[inline(never)]
    pub fn new(
        mut fluid: TransportVelocity<D>,
        cfl: Option<f64>,
        solids: Vec<SolidInput>,
        domain: &Domain<D>,
    ) -> Result<Self, WorldError> {
        let names: Vec<(String, &'static SchemeDescription)> =
            solids.iter().map(|solid| (solid.name.clone(), solid.scheme.description())).collect();
        let mut guided = Vec::new();
        let mut bound = Vec::new();
        for (number, input) in solids.into_iter().enumerate() {
            let walls = fluid.walls_of(&input.bodies);
            if let Some(other) = fluid.too_close_to(&walls) {
                let Particle { id, reference: position } = fluid.particle(other);
                return Err(WorldError::Overlap { system: input.name, id, position });
            }
            let mut solid = Solid::new(number, input, &walls, fluid.spacing(), domain)?;
            solid.first = guided.len();
            solid.layer = solid.layer_stop(&fluid);
            guided.extend(walls.iter().map(|(wall, ..)| *wall));
            bound.push(solid);
        }
        fluid.let_walls_be_guided(&guided);
        let description = fluid.description().with_solids(&names);
        let mut world = Self {
            description,
            guided: WallSelection::new(guided.clone()),
            walls: fluid.description().ledger.place_of(WALLS),
            parts: Parts::default(),
            start: Vec::new(),
            forces: vec![Vec::new(); bound.len()],
            held: [(); 2].map(|()| vec![Vec::new(); bound.len()]),
            before: Vec::new(),
            booked: Vec::new(),
            touches: vec![Vec::new(); bound.len()],
            contact: Contact::new(&fluid, &bound),
            known: Vec::new(),
            ways: Vec::new(),
            carried: vec![[Vector::zeros(); 2]; guided.len()],
            pulls: Vec::new(),
            rest: Vec::new(),
            fixed_at: Vec::new(),
            limits: Vec::new(),
            fluid,
            cfl,
            solids: bound,
        };
        let mut start = world.line_up(&guided);
        // Behind the ledger stands how many steps of each system were the last one of the run, and all of it.
        let counts = 2 * world.parts.all.len();
        start.resize(start.len() + description.ledger.integrals(D) + counts, 0.0);
        world.begin(&mut start);
        world.start = start;
        Ok(world)
    }

    /// Puts states and particles of all systems one after another, but for those of the fluid that stand for
    /// solids; returns the states.
    fn line_up(&mut self, hidden: &[u32]) -> Vec<f64> {
        let mut is_hidden = vec![false; self.fluid.particle_count()];
        hidden.iter().for_each(|&number| is_hidden[number as usize] = true);
        let (mut start, mut parts) = (Vec::new(), std::mem::take(&mut self.parts));
        for number in 0..=self.solids.len() {
            let system = self.system(number);
            let count = system.particle_count() as u32;
            let shown = (0..count).filter(|&a| number > 0 || !is_hidden[a as usize]).collect();
            let solid = number.checked_sub(1).map(|solid| &self.solids[solid]);
            let body = |own: u32| solid.map_or(own, |solid| solid.numbers[own as usize]);
            parts.push(system, shown, body, &mut start);
        }
        self.parts = parts;
        for (number, solid) in self.solids.iter().enumerate() {
            for (row, &wall) in solid.interface.walls().iter().enumerate() {
                let carrier = solid.interface.carrier(row) as usize;
                let index = self.parts.all[number + 1].index[carrier];
                self.parts.all[0].index[wall as usize] = index;
            }
        }
        start
    }

    /// Gives the fluid the motion of the solids at the start, which its accelerations follow.
    fn begin(&mut self, state: &mut [f64]) {
        for (solid, part) in self.solids.iter().zip(&self.parts.all[1..]) {
            solid.scheme.constrain(0.0, &mut state[part.state.clone()]);
        }
        self.carry_walls(state);
        self.guide(state);
        let own = &mut state[self.parts.all[0].state.clone()];
        self.fluid.restart(own);
    }

    /// The index in the run of a particle of a system: 0 is the fluid, the solids follow. Particles that
    /// stand for a solid in the fluid have none.
    pub fn index_of(&self, system: usize, particle: u32) -> Option<u32> {
        self.parts.index_of(system, particle)
    }

    /// The system of a particle (index in the run), and its index there.
    fn local(&self, index: usize) -> (usize, usize) {
        self.parts.local(index)
    }

    /// A system: 0 is the fluid.
    fn system(&self, number: usize) -> &dyn Scheme {
        match number.checked_sub(1) {
            None => &self.fluid,
            Some(solid) => self.solids[solid].scheme.as_ref(),
        }
    }

    /// Where the work of solids on the fluid stands in a state.
    fn interface_at(&self) -> usize {
        self.ledger_at() + self.description.ledger.place_of(INTERFACE)
    }

    /// Where numbers of steps begin in a state.
    fn counts_at(&self) -> usize {
        self.ledger_at() + self.description.ledger.integrals(D)
    }

    /// Where the ledger of all begins in a state.
    fn ledger_at(&self) -> usize {
        self.parts.end()
    }
}

impl<const D: usize> Solid<D> {
    fn new(
        number: usize,
        input: SolidInput,
        walls: &[(u32, u32, Vector<D>)],
        fluid_spacing: f64,
        domain: &Domain<D>,
    ) -> Result<Self, WorldError> {
        let SolidInput { name, scheme, spacing, numbers, cfl, law, .. } = input;
        let count = scheme.particle_count();
        let reference = (0..count).map(|a| Vector::from_vec(scheme.particle(a).reference));
        let reference: Vec<Vector<D>> = reference.collect();
        let column = |name: &str| {
            let field = scheme.description().field(name).filter(|field| field.is_stored())?;
            (field.kind == FieldKind::Vector).then(|| scheme.column(field))
        };
        let (Some(velocities), Some(places)) =
            (column("velocity"), column("displacement").or_else(|| column("position")))
        else {
            let scheme = scheme.description().name;
            return Err(WorldError::Motion { scheme, system: name });
        };
        let spacings = [fluid_spacing, spacing];
        let bodies = scheme.bodies().iter().map(|&own| numbers[own as usize]);
        let bodies: Vec<u32> = bodies.collect();
        let interface = Interface::new(walls, (&reference, &bodies), spacings, domain)
            .map_err(|error| WorldError::Interface { solid: number, error })?;
        let is_displaced = column("displacement").is_some();
        Ok(Self {
            mass: (0..count).map(|a| scheme.mass(a)).collect(),
            name,
            reference,
            is_displaced,
            domain: *domain,
            interface,
            cfl,
            law,
            spacing,
            first: 0,
            layer: 0.0,
            places,
            velocities,
            numbers,
            limits: Vec::new(),
            scheme,
        })
    }

    /// The density of what it is made of around a row of the interface, in kg/m^3.
    fn density(&self, row: usize) -> f64 {
        let mass = self.interface.mean(row, |b| self.mass[b]);
        let least = self.mass.iter().copied().fold(f64::INFINITY, f64::min);
        mass.max(least) / self.spacing.powi(D as i32)
    }

    /// The time in s in which waves of a fluid stop a layer of particles, of the solid or as thick as those of the
    /// fluid, which share what is done to one of them.
    fn layer_stop(&self, fluid: &TransportVelocity<D>) -> f64 {
        let rows = 0..self.interface.walls().len();
        let least = rows.map(|row| self.density(row)).fold(f64::INFINITY, f64::min);
        least * self.spacing.max(fluid.spacing()) / (fluid.density() * fluid.wave_speed())
    }

    /// The longest step in s that it would take by itself from the state that was looked at last; nothing where it has
    /// none, as in implicit steps and without waves.
    fn stable_step(&self) -> f64 {
        let has_waves = self.limits.iter().all(|limit| limit.step < f64::INFINITY);
        self.cfl.filter(|_| has_waves).map_or(0.0, |cfl| shortest(&self.limits, cfl))
    }

    /// The displacements of its particles around wall particle `row` of the interface in its part of a state, in m, up
    /// to periods of the box that are the same for all of them: positions may have been wrapped, ways between neighbours
    /// tell what has not.
    #[inline]
    fn displacements<'a>(
        &'a self,
        own: &'a [f64],
        row: usize,
    ) -> impl Fn(usize) -> Vector<D> + Copy + 'a {
        let column: &[Vector<D>] = bytemuck::cast_slice(&own[self.places.clone()]);
        let lead = if self.is_displaced { 0 } else { self.interface.carrier(row) as usize };
        let way = |from: &Vector<D>, to: &Vector<D>| self.domain.separation(from, to);
        let moved = way(&self.reference[lead], &column[lead]);
        move |b| match self.is_displaced {
            true => column[b],
            false => {
                let apart = way(&self.reference[lead], &self.reference[b]);
                moved + way(&column[lead], &column[b]) - apart
            }
        }
    }

    /// The deformation gradient at wall particle `row` of the interface in its part of a state.
    fn deformation(&self, own: &[f64], row: usize) -> Tensor<D> {
        self.interface.deformation(row, self.displacements(own, row))
    }

    /// Where its particle `a` is in its part of a state, in m.
    #[inline]
    fn place(&self, own: &[f64], a: usize) -> Vector<D> {
        let column: &[Vector<D>] = bytemuck::cast_slice(&own[self.places.clone()]);
        if self.is_displaced { self.reference[a] + column[a] } else { column[a] }
    }

    /// The first of its particles around which those are not any more that were there at the start, if it is of a
    /// kind whose particles change their neighbours.
    fn torn(&self, own: &[f64]) -> Option<usize> {
        let rows = (!self.scheme.keeps_neighbors()).then(|| 0..self.interface.walls().len());
        let start = (&self.domain, self.reference.as_slice());
        let is_torn =
            |row: &usize| self.interface.is_torn(*row, start, self.displacements(own, *row));
        let row = rows?.find(is_torn)?;
        Some(self.interface.carrier(row) as usize)
    }

    /// How fast its particle `a` is in its part of a state, in m/s.
    #[inline]
    fn velocity(&self, own: &[f64], a: usize) -> Vector<D> {
        let column: &[Vector<D>] = bytemuck::cast_slice(&own[self.velocities.clone()]);
        column[a]
    }
}
