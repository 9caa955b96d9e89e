//! The part of a rank.
//!
//! Ranks divide the fluid among them. Each has the solids, whole, and takes their steps by itself, from the same forces and
//! so with the same bits.

use std::ops::Range;

use super::flow::shortest;
use super::{Solid, World};
use crate::schemes::{CoupledScheme as _, Part, RankRefusal, RankRows, RankShare, Scheme as _};

impl<const D: usize> Solid<D> {
    /// The same for a rank.
    fn copy(&self) -> Result<Self, RankRefusal> {
        Ok(Self {
            name: self.name.clone(),
            scheme: self.scheme.share(&Part::whole(self.scheme.particle_count()))?,
            interface: self.interface.clone(),
            cfl: self.cfl,
            law: self.law,
            spacing: self.spacing,
            first: self.first,
            layer: self.layer,
            mass: self.mass.clone(),
            reference: self.reference.clone(),
            is_displaced: self.is_displaced,
            domain: self.domain,
            places: self.places.clone(),
            velocities: self.velocities.clone(),
            numbers: self.numbers.clone(),
            limits: Vec::new(),
        })
    }
}

impl<const D: usize> World<D> {
    /// How many particles of the run a rank has which has those of the fluid with these numbers.
    pub(super) fn count_with(&self, own: &Range<usize>) -> usize {
        let shown = &self.parts.all[0].shown;
        let place = |bound: usize| shown.partition_point(|&number| (number as usize) < bound);
        let of_solids = self.parts.bodies.len() - shown.len();
        place(own.end) - place(own.start) + of_solids
    }

    /// What the solids cost in a step of the fluid, of the length that the state asks for that was looked at last.
    fn cost_of_solids(&self) -> f64 {
        let count = self.fluid_steps_of(&self.limits) as f64;
        let step = self.cfl.map_or(0.0, |cfl| count * shortest(&self.limits, cfl));
        let of = |(number, solid): (usize, &Solid<D>)| {
            let steps = self.solid_steps(number, step) as f64 / count;
            solid.scheme.cost(0..solid.scheme.particle_count()) * steps
        };
        self.solids.iter().enumerate().map(of).sum()
    }

    /// What ranks would have at the start whose particles of the fluid begin and end where `bounds` has it.
    pub(super) fn planned(&self, bounds: &[usize]) -> Result<Vec<RankShare>, RankRefusal> {
        for solid in &self.solids {
            solid.scheme.shares(&Part::whole(solid.scheme.particle_count()).bounds)?;
        }
        let shares = self.fluid.planned(bounds);
        let of_solids = self.cost_of_solids();
        let count = self.fluid_steps_of(&self.limits) as usize;
        let of_fluid = self.fluid.cost(0..self.fluid.particle_count());
        let even = (of_fluid + of_solids) / shares.len() as f64;
        let share = |(share, ends): (RankShare, &[usize])| {
            let own = ends[0]..ends[1];
            // Each gets the forces on the walls of the others, when a step begins and after each step of the fluid in it.
            let told = (self.guided.len() - self.guided.within(&own).len()) * D;
            let told = told * (count + 1) / count;
            RankShare {
                particles: self.count_with(&own),
                bytes: share.bytes + told * size_of::<f64>(),
                load: (self.fluid.cost(own) + of_solids) / even,
                ..share
            }
        };
        Ok(shares.into_iter().zip(bounds.windows(2)).map(share).collect())
    }

    /// The particles of the fluid that a rank has, and all solids.
    pub(super) fn shared(&self, part: &Part) -> Result<Self, RankRefusal> {
        let solids = self.solids.iter().map(Solid::copy).collect::<Result<Vec<_>, _>>()?;
        let fluid = self.fluid.shared(part)?;
        let start = RankRows::of(self, &part.bounds).part(part.ranks.rank(), &self.start);
        let by_solid = || vec![Vec::new(); solids.len()];
        Ok(Self {
            description: self.description,
            fluid,
            cfl: self.cfl,
            contact: self.contact.clone(),
            guided: self.guided.clone(),
            walls: self.walls,
            parts: self.parts.without(self.start.len() - start.len()),
            start,
            forces: by_solid(),
            held: [by_solid(), by_solid()],
            before: Vec::new(),
            booked: Vec::new(),
            touches: by_solid(),
            known: Vec::new(),
            ways: Vec::new(),
            carried: self.carried.clone(),
            pulls: Vec::new(),
            rest: Vec::new(),
            fixed_at: Vec::new(),
            limits: Vec::new(),
            solids,
        })
    }
}
