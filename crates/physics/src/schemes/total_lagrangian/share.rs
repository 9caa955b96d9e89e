//! The part of a rank.

use std::ops::Range;
use std::sync::Arc;

use super::fields::Made;
use super::group::Group;
use super::{Discrete, Matrices, TotalLagrangian};
use crate::fields::width;
use crate::operators::Slots;
use crate::schemes::{Part, RankRefusal, RankRows, RankShare};
use crate::{Tensor, Vector};

/// Vectors that ranks tell each other of the particles of a rigid body in an evaluation, and about as many of those of a spring.
const GATHERED: usize = 5;

impl<const D: usize> TotalLagrangian<D> {
    /// What several ranks cannot share yet, with what a case has to be like instead.
    fn unshared(&self) -> Option<[&'static str; 2]> {
        let features = [
            (
                self.matrices.edges().is_some(),
                ["the strong form does not run", "choose `form = \"adjoint\"`"],
            ),
            (self.updated.is_some(), ["the updated configuration does not run", "leave it out"]),
        ];
        features.into_iter().find(|(is_there, _)| *is_there).map(|(_, what)| what)
    }

    /// The gradients, if this many ranks can share all of it.
    fn whole(&self, ranks: usize) -> Result<&Discrete<D>, RankRefusal> {
        if ranks > 1 && self.statics.as_ref().is_some_and(|statics| statics.is_direct()) {
            return Err(RankRefusal::DIRECT);
        }
        match (&self.matrices, self.unshared()) {
            (Matrices::Adjoint(whole), None) => Ok(whole),
            (_, Some([what, instead])) => Err(RankRefusal::Feature { what, instead }),
            _ => Err(RankRefusal::Formulation(self.description.name)),
        }
    }

    /// The slots of each rank.
    fn slots(whole: &Discrete<D>, own: Range<usize>, bounds: &[usize]) -> Slots {
        let on_planes: Vec<usize> = whole.planes.iter().map(|(_, particle)| *particle).collect();
        whole.operator.slots(own, bounds, &on_planes)
    }

    /// What ranks would have whose particles begin and end where `bounds` has it.
    pub(super) fn planned(&self, bounds: &[usize]) -> Result<Vec<RankShare>, RankRefusal> {
        let whole = self.whole(bounds.len() - 1)?;
        // Where there are images, copies are fetched before and after these are made.
        let fields = 1 + usize::from(self.dissipation.is_viscous() || self.has_images);
        let vectors = fields * (1 + usize::from(self.has_images));
        let is_solved = self.statics.is_some();
        let vectors = if is_solved { 0 } else { vectors };
        let numbers = vectors * D + whole.operator.tensions() * D * D;
        let mut shares =
            Part::planned(self, bounds, numbers, |own| Self::slots(whole, own, bounds));
        for (share, ends) in shares.iter_mut().zip(bounds.windows(2)) {
            let told = match is_solved {
                // Each rank gets the forces on all particles of the others.
                true => self.solid.len() - share.particles,
                false => GATHERED * Group::elsewhere(self, &(ends[0]..ends[1])),
            };
            share.bytes += told * D * size_of::<f64>();
        }
        Ok(shares)
    }

    /// What a rank computes: the body with its part of the equations, where states are solved for, or its particles.
    pub(super) fn shared(&self, part: &Part) -> Result<Self, RankRefusal> {
        let Some(statics) = &self.statics else { return self.cut(part) };
        self.whole(part.ranks.size())?;
        let mut share = self.cut(&Part::whole(self.solid.len()))?;
        share.statics = Some(Box::new(statics.share(part)?));
        share.is_static = self.is_static;
        Ok(share)
    }

    /// The particles of a rank, with the same coefficients.
    fn cut(&self, part: &Part) -> Result<Self, RankRefusal> {
        let whole = self.whole(part.ranks.size())?;
        let own = part.own();
        let slots = Self::slots(whole, own.clone(), &part.bounds);
        let team = part.team(&slots)?;
        let group = Group::of(self, part, &team);
        let operator = Arc::new(whole.operator.part(&slots));
        let solid = Arc::new(self.solid.part(own.clone()));
        let (count, all) = (own.len(), slots.iter().count());
        let is_viscous = self.dissipation.is_viscous();
        // Planes know how fast they move by a particle, which another rank may have.
        let is_told = !part.is_whole() && (is_viscous || self.has_images);
        let is_continued = is_told || !self.velocity.is_empty();
        let place = |a: usize| own.contains(&a).then(|| a - own.start);
        let planes = whole.planes.iter();
        let planes = planes.map(|&(plane, on)| (plane, slots.place(on as u32) as usize)).collect();
        let matrices = Matrices::Adjoint(Discrete { solid: solid.clone(), operator, planes });
        let length = self.rate.len() - (self.solid.len() - count) * width(Made::FIELDS, D);
        let mut share = Self {
            description: self.description,
            updated: None,
            loads: self.loads.part(place),
            is_driven: self.is_driven,
            has_images: self.has_images,
            team,
            prescribed: self.prescribed.part(place),
            rigid: self.rigid.clone(),
            group,
            statics: None,
            is_static: false,
            stable: self.stable,
            not_convex: None,
            jumped: None,
            is_evaluated: false,
            has_matrices: true,
            stages: self.stages.clone(),
            displacement: vec![Vector::zeros(); all],
            velocity: vec![Vector::zeros(); if is_continued { all } else { 0 }],
            acceleration: Vec::new(),
            strained: matrices.strained(count),
            gradient_rate: vec![Tensor::zeros(); if is_viscous { count } else { 0 }],
            stress: Vec::new(),
            force: vec![Vector::zeros(); slots.owned()],
            rate: vec![0.0; length],
            reaction: Vec::new(),
            initial: Vec::new(),
            dissipation: self.dissipation,
            matrices,
            solid,
        };
        share.initial = RankRows::of(self, &part.bounds).part(part.ranks.rank(), &self.initial);
        Ok(share)
    }
}
