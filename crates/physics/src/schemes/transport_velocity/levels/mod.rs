//! A fluid at several resolutions, theory (95), (96).
//!
//! A level has the particles of one spacing, half that of the level before, and is a [`TransportVelocity`] fluid by itself:
//! no particle meets one of another size, so all that holds for a uniform fluid holds within a level. The coarsest level
//! fills the whole fluid. A finer one fills its region and a band around it.
//!
//! Where a finer level has its region, the particles of the coarser one follow it, and in the band those of the finer
//! one follow the coarser: their velocity and pressure are those of the function that fits the other level, (95),
//! and they move with them and are shifted as all others. A particle is counted where its level is the finest there is.
//!
//! The coarsest level loses and gains no particle where levels meet, so that its mass is exact. A particle that comes
//! to a finer region is followed by 2^D finer ones of the same mass, which are born in the band; finer particles that come
//! out of the band are taken out.

mod scheme;
mod transfer;

use std::sync::LazyLock;

use piola_formulas::fluid;
use piola_formulas::pairs::fit::Flow;
use transfer::{Taken, Transfer};

use super::fluid::LEDGER;
use super::{Continuum, FLUIDS, Nesting, TransportVelocity, TransportVelocityError};
use crate::Vector;
use crate::fields::{FieldDescription, Life};
use crate::neighbors::Domain;
use crate::schemes::ledger::Totals;
use crate::schemes::parts::Parts;
use crate::schemes::{Accounts, Capability, Scheme, SchemeDescription};

/// What a fluid at several resolutions shows: what one at a single one does, and how much of it there is.
static DESCRIPTION: LazyLock<SchemeDescription> = LazyLock::new(|| {
    let derived = |field: &FieldDescription| FieldDescription {
        life: match field.life {
            Life::Kept => Life::Kept,
            // It is a column of each level, and of none of all.
            _ => Life::Derived(field.stages()),
        },
        ..*field
    };
    let fields: Vec<FieldDescription> = FLUIDS.fields.iter().map(derived).collect();
    let figures = [FLUIDS.figures, &[("mass", "kg"), ("present", "1")]].concat();
    SchemeDescription {
        fields: Box::leak(fields.into_boxed_slice()),
        figures: Box::leak(figures.into_boxed_slice()),
        ledger: Accounts { is_kicked: false, ..FLUIDS.ledger },
        offers: &[Capability::Kicks],
        ..FLUIDS
    }
});

/// What a fluid at several resolutions is called and what it shows.
pub fn refined() -> &'static SchemeDescription {
    &DESCRIPTION
}

/// How far away in spacings particles of another level are followed: as near as there are enough of them, with walls on one
/// side, to tell slopes and a curvature.
const REACH: f64 = 2.5;

/// A fluid at several resolutions.
pub struct Levels<const D: usize> {
    /// From the coarsest to the finest.
    levels: Vec<TransportVelocity<D>>,
    /// Between each level and the next: what the coarser one takes, and the finer one.
    transfers: Vec<[Transfer<D>; 2]>,
    parts: Parts,
    start: Vec<f64>,
}

impl<const D: usize> Levels<D> {
    /// Puts levels together that are nested in each other, from the coarsest to the finest.
    ///
    /// # Errors
    /// When neighbours of one level in another cannot be found.
    #[inline(never)]
    pub fn new(levels: Vec<TransportVelocity<D>>) -> Result<Self, TransportVelocityError> {
        let (mut parts, mut start) = (Parts::default(), Vec::new());
        for level in &levels {
            // Walls stay where their level is counted; what flows shows where it is.
            let is_shown = |&a: &u32| {
                let place = &level.common.particles.position[a as usize];
                let counts = level.matter.nesting().is_none_or(|nesting| nesting.counts(place));
                level.common.wall_of(a).is_none() || counts
            };
            let shown = (0..level.particle_count() as u32).filter(is_shown).collect();
            parts.push(level, shown, |own| own, &mut start);
        }
        let mut transfers = Vec::new();
        for pair in levels.windows(2) {
            let [coarse, fine] = [&pair[0].common, &pair[1].common];
            let [all, finer] = [coarse, fine].map(|it| it.particles.position.as_slice());
            let domain: Domain<D> = *coarse.support.list().domain();
            let kernel = coarse.support.kernel();
            let h =
                [fine, coarse].map(|it| REACH * it.particles.spacing[0] / kernel.support_over_h());
            transfers.push([
                Transfer::new([finer, all], kernel, h[0], domain)?,
                Transfer::new([all, finer], kernel, h[1], domain)?,
            ]);
        }
        let mut all = Self { levels, transfers, parts, start: Vec::new() };
        start.resize(start.len() + LEDGER.integrals(D), 0.0);
        all.exchange(&mut start);
        for k in 0..all.levels.len() {
            let own = all.parts.all[k].state.clone();
            all.levels[k].restart(&mut start[own]);
        }
        all.start = start;
        Ok(all)
    }

    /// The index in the run of a particle of a level, if it is shown.
    pub fn index_of(&self, level: usize, particle: u32) -> Option<u32> {
        self.parts.index_of(level, particle)
    }

    /// The levels with their parts of a state.
    fn each<'a>(
        &'a self,
        state: &'a [f64],
    ) -> impl Iterator<Item = (&'a TransportVelocity<D>, &'a [f64])> {
        let parts = self.parts.all.iter().map(|part| &state[part.state.clone()]);
        self.levels.iter().zip(parts)
    }

    /// Lets particles change from level to level, finer ones be born and taken out.
    fn regroup(&mut self, state: &mut [f64]) {
        let mut parents = Vec::new();
        for (level, part) in self.levels.iter_mut().zip(&self.parts.all) {
            let TransportVelocity { common, matter, .. } = level;
            let own = &mut state[part.state.clone()];
            let mut totals = Totals::default();
            // Of the finer ones, before those that are born take their numbers.
            let (total, next) = matter.regroup(common, own);
            matter.bear_finer(common, &parents, own);
            totals.book(LEDGER.entry("openings"), &total);
            LEDGER.add(D, &totals, level.tail(own));
            parents = next;
        }
    }

    /// Gives particles that follow those of another level what these have in a state.
    fn exchange(&mut self, state: &mut [f64]) {
        for (level, part) in self.levels.iter_mut().zip(&self.parts.all) {
            let TransportVelocity { common, matter, .. } = level;
            matter.follow(common, &state[part.state.clone()]);
        }
        // From the finest to the coarsest, and then back: what is taken first is what the finer level has.
        for k in (0..self.transfers.len()).rev() {
            self.transfer(k, true, state);
        }
        for k in 0..self.transfers.len() {
            self.transfer(k, false, state);
        }
    }

    /// Between level `k` and the next finer one: `up` is to the coarser.
    fn transfer(&mut self, k: usize, up: bool, state: &mut [f64]) {
        let [giving, taking] = if up { [k + 1, k] } else { [k, k + 1] };
        let transfer = &mut self.transfers[k][usize::from(!up)];
        let (levels, parts) = (&self.levels, &self.parts.all);
        let [give, take] = [giving, taking].map(|level| &levels[level]);
        let [from, to] = [giving, taking].map(|level| parts[level].state.clone());
        let places = take.common.columns(&state[to.clone()]).position;
        let is_up = |a: usize| {
            take.matter.nesting().is_some_and(|nesting| nesting.follows_finer(&places[a]) == up)
        };
        let takes = |a: usize| take.matter.is_follower(a as u32) && is_up(a);
        transfer.choose(|a| give.gives(a), takes);
        transfer.find(|gives, a| match gives {
            true => give.taken(&state[from.clone()], a),
            false => take.taken(&state[to.clone()], a),
        });
        let takers: Vec<usize> =
            take.matter.followers().iter().map(|&a| a as usize).filter(|&a| takes(a)).collect();
        let take = &self.levels[taking];
        for a in takers {
            if let Some(flow) = transfer.found(a) {
                take.follow_flow(&mut state[to.clone()], a, flow);
            }
        }
    }

    /// Puts the integrals of all levels behind their states.
    fn sum_up(&self, state: &mut [f64]) {
        let at = self.parts.end();
        let (own, total) = state.split_at_mut(at);
        total.fill(0.0);
        for (level, own) in
            self.levels.iter().zip(self.parts.all.iter().map(|it| &own[it.state.clone()]))
        {
            let tail = &own[level.particle_count() * level.width()..];
            total.iter_mut().zip(tail).for_each(|(sum, own)| *sum += own);
        }
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// Whether a particle (number) of fluid is there, so that other levels may take from it.
    fn gives(&self, number: usize) -> bool {
        let common = &self.common;
        let is_removed = common.removed[number];
        !is_removed && (!common.is_wall[number] || self.matter.is_follower(number as u32))
    }

    /// Where a particle (number) is in a state, and what it has.
    fn taken(&self, state: &[f64], number: usize) -> Taken<D> {
        let at = self.common.columns(state);
        let flow = Flow { velocity: at.velocity[number], pressure: at.pressure[number] };
        Taken { position: at.position[number], flow }
    }

    /// Gives a particle (number) of a state what another level has there.
    fn follow_flow(&self, state: &mut [f64], number: usize, flow: &Flow<f64, D>) {
        let matter = self.matter.fluid();
        let (own, _) = self.common.parts(state);
        own.velocity[number] = flow.velocity;
        own.pressure[number] = flow.pressure;
        own.density[number] = fluid::density(flow.pressure, matter.density, matter.wave_speed);
    }
}

impl<const D: usize> Nesting<D> {
    /// Whether a particle at a place that follows another level follows the next finer one, and not the one before.
    fn follows_finer(&self, place: &Vector<D>) -> bool {
        match (&self.own, &self.finer) {
            (_, None) => false,
            (None, Some(_)) => true,
            (Some(own), Some(finer)) => finer.shape.depth(place) > -own.shape.depth(place),
        }
    }
}
