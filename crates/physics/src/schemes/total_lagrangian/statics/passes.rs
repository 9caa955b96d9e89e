//! The two passes of internal forces, which several ranks share.

use bytemuck::cast_slice;
use piola_ranks::RankError;

use super::super::Discrete;
use crate::operators::{ReferenceGradient, Slots, Strained};
use crate::parallel::Team;
use crate::schemes::Part;
use crate::{Tensor, Vector};

/// From a field of all particles to the forces on them, with scratch for what is between.
#[derive(Clone)]
pub(super) struct Passes<const D: usize> {
    strained: Strained<D>,
    /// What one of several ranks computes.
    rows: Option<Box<Rows<D>>>,
}

/// The rows of a rank. All ranks have the fields and the forces of all particles.
#[derive(Clone)]
struct Rows<const D: usize> {
    team: Team,
    slots: Slots,
    /// The images of each rank.
    images: Vec<Vec<usize>>,
    operator: ReferenceGradient<D>,
    field: Vec<Vector<D>>,
    strained: Strained<D>,
    force: Vec<Vector<D>>,
}

impl<const D: usize> Passes<D> {
    /// All rows.
    pub fn new(operator: &ReferenceGradient<D>) -> Self {
        Self { strained: operator.strained(), rows: None }
    }

    /// Those of a rank, with its team. All ranks call this together.
    pub fn of_rank(discrete: &Discrete<D>, part: &Part) -> Result<(Self, Team), RankError> {
        let whole = &*discrete.operator;
        if part.is_whole() {
            return Ok((Self::new(whole), Team::default()));
        }
        let slots = whole.slots(part.own(), &part.bounds, &[]);
        let team = part.team(&slots)?;
        let mut images = vec![Vec::new(); part.ranks.size()];
        for slot in whole.count()..whole.positions().len() {
            images[team.owner(whole.source(slot).0)].push(slot);
        }
        let operator = whole.part(&slots);
        let rows = Rows {
            team: team.clone(),
            images,
            field: vec![Vector::zeros(); slots.iter().count()],
            strained: operator.strained(),
            force: vec![Vector::zeros(); slots.owned()],
            slots,
            operator,
        };
        Ok((Self { strained: whole.strained(), rows: Some(Box::new(rows)) }, team))
    }

    /// Writes the forces in N on particles and images of a field, of which particles with displacement gradients have
    /// tensions in J, as [`ReferenceGradient::strain`] and [`ReferenceGradient::forces`].
    pub fn forces(
        &mut self,
        operator: &ReferenceGradient<D>,
        field: &[Vector<D>],
        tension: impl Fn(usize, &[Tensor<D>], &mut [Tensor<D>]) + Sync,
        force: &mut [Vector<D>],
    ) {
        match &mut self.rows {
            Some(rows) => rows.forces(field, tension, force),
            None => {
                operator.strain(field, &mut self.strained, tension);
                operator.forces(field, &self.strained.tension, force);
            }
        }
    }

    /// The displacement gradients of the last field. All ranks call this together.
    pub fn gradients(&mut self) -> &[Tensor<D>] {
        let gradient = &mut self.strained.gradient;
        if let Some(rows) = &self.rows {
            gradient[rows.slots.own.clone()].copy_from_slice(&rows.strained.gradient);
            rows.team.complete(gradient, |a| a);
        }
        gradient
    }

    /// Bytes of all arrays.
    pub fn memory(&self) -> usize {
        let of_rows = |rows: &Rows<D>| {
            rows.operator.memory()
                + rows.strained.memory()
                + size_of_val(rows.field.as_slice())
                + size_of_val(rows.force.as_slice())
        };
        self.strained.memory() + self.rows.as_deref().map_or(0, of_rows)
    }
}

impl<const D: usize> Rows<D> {
    fn forces(
        &mut self,
        field: &[Vector<D>],
        tension: impl Fn(usize, &[Tensor<D>], &mut [Tensor<D>]) + Sync,
        force: &mut [Vector<D>],
    ) {
        let Self { team, slots, images, operator, strained, .. } = self;
        let (first, owned) = (slots.own.start, slots.owned());
        for (own, slot) in self.field.iter_mut().zip(slots.iter()) {
            *own = field[slot];
        }
        let tension = |own: usize, gradients: &[_], tensions: &mut [_]| {
            tension(first + own, gradients, tensions);
        };
        operator.strain(&self.field, strained, tension);
        team.refresh(&mut strained.tension, owned, operator.tensions());
        operator.forces(&self.field, &strained.tension, &mut self.force);
        let (own, behind) = self.force.split_at(slots.own.len());
        force[slots.own.clone()].copy_from_slice(own);
        team.complete(force, |a| a);
        if images.iter().any(|images| !images.is_empty()) {
            let told = team.parts_of_all(cast_slice(behind));
            for (images, told) in images.iter().zip(told.iter().flatten()) {
                let told: &[Vector<D>] = cast_slice(told);
                images.iter().zip(told).for_each(|(slot, told)| force[*slot] = *told);
            }
        }
    }
}
