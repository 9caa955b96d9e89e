//! The part of a rank.

use std::ops::Range;

use piola_formulas::pairs::Record as _;
use piola_formulas::pairs::upwind::{UpwindSide, UpwindSlope};

use super::Upwind;
use crate::Vector;
use crate::neighbors::NeighborList;
use crate::operators::{Slots, Support};
use crate::schemes::{Part, RankRefusal, RankShare};

impl<const D: usize> Upwind<D> {
    /// The slots of a rank.
    fn slots(&self, own: Range<usize>, bounds: &[usize]) -> Slots {
        let rank = |b: usize| bounds.partition_point(|&bound| bound <= b) - 1;
        let copies = self.support.list.beside(&own).into_iter().map(|b| (rank(b), b)).collect();
        Slots::new(own, Vec::new(), copies)
    }

    /// What ranks would have whose particles begin and end where `bounds` has it.
    pub(super) fn planned(&self, bounds: &[usize]) -> Result<Vec<RankShare>, RankRefusal> {
        if let Some(implicit) = &self.implicit {
            if bounds.len() > 2 && implicit.is_direct() {
                return Err(RankRefusal::DIRECT);
            }
            // Each rank gets what the equations of all particles of the others have.
            let none = |own| Slots::new(own, Vec::new(), Vec::new());
            let mut shares = Part::planned(self, bounds, 0, none);
            let told = |share: &RankShare| (self.particles.len() - share.particles) * D;
            shares.iter_mut().for_each(|it| it.bytes += told(it) * size_of::<f64>());
            return Ok(shares);
        }
        let slopes = usize::from(self.settings.reconstruction);
        let numbers = UpwindSide::<D>::NUMBERS + slopes * UpwindSlope::<D>::NUMBERS;
        Ok(Part::planned(self, bounds, numbers, |own| self.slots(own, bounds)))
    }

    /// What a rank computes: all with its part of the equations of implicit steps, or its particles.
    pub(super) fn shared(&self, part: &Part) -> Result<Self, RankRefusal> {
        let Some(implicit) = &self.implicit else { return self.cut(part) };
        self.planned(&part.bounds)?;
        let mut share = self.cut(&Part::whole(self.particles.len()))?;
        share.support = self.support.clone();
        share.implicit = Some(Box::new(implicit.share(part)));
        Ok(share)
    }

    /// The particles of a rank, with the same coefficients.
    fn cut(&self, part: &Part) -> Result<Self, RankRefusal> {
        let own = part.own();
        let slots = self.slots(own.clone(), &part.bounds);
        let team = part.team(&slots)?;
        let (count, all) = (own.len(), slots.iter().count());
        let reconstructed = if self.settings.reconstruction { all } else { 0 };
        let place = |a: usize| own.contains(&a).then(|| a - own.start);
        let loaded = self.loaded.iter();
        let loaded = loaded.filter_map(|load| Some(load.clone().on(place(load.particle)?)));
        let mut share = Self {
            team,
            is_driven: self.is_driven,
            nearest: self.nearest[own.clone()].to_vec(),
            areas: self.areas.part(own.clone(), |slot| slots.place(slot)),
            largest_exchange: self.largest_exchange,
            fastest_reference: self.fastest_reference,
            prescribed: self.prescribed.part(place),
            steady_body_force: self.steady_body_force,
            body_acceleration: vec![Vector::zeros(); count],
            loaded: loaded.collect(),
            sides: vec![UpwindSide::zero(); all],
            slopes: vec![UpwindSlope::zero(); reconstructed],
            observed: Vec::new(),
            body_forces: self.body_forces.clone(),
            initial_velocity: self.initial_velocity[own.clone()].to_vec(),
            particles: self.particles.part(own.clone()),
            // Neighbours are those of the areas.
            support: Support {
                kernel: self.support.kernel,
                smoothing_length: Vec::new(),
                list: NeighborList::default(),
                reverse: Vec::new(),
                domain: self.support.domain,
            },
            least_squares: self.least_squares.as_ref().map(|all| all.part(own.clone())),
            settings: self.settings,
            materials: self.materials.clone(),
            reference: self.reference[own].to_vec(),
            stages: self.stages.clone(),
            implicit: None,
        };
        share.update_body_acceleration(0.0);
        Ok(share)
    }
}
