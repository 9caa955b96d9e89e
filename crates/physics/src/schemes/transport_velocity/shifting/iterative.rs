//! IPST: displacements iterated until particles are even.

use piola_formulas::pairs::sums::Displacement;

use crate::operators::{Among, NeighborBlock, Term, add_at};
use crate::schemes::transport_velocity::{AtSurface, Common, Opening, Shifting};
use crate::{Vector, parallel};

/// Scratch and figures of the iteration.
#[derive(Clone, Debug)]
pub(in super::super) struct Iteration<const D: usize> {
    /// `chi` of CTVF (40) in the configuration at the start: its mean, or at free surfaces its
    /// largest value.
    pub even: f64,
    /// Positions in m by row.
    positions: Vec<Vector<D>>,
    /// Free surfaces at the start of the step, by row.
    openings: Vec<Opening<D>>,
    /// Displacement in m and `chi` by place.
    found: Vec<(Vector<D>, f64)>,
}

impl<const D: usize> Default for Iteration<D> {
    fn default() -> Self {
        let (positions, openings, found) = (Vec::new(), Vec::new(), Vec::new());
        Self { even: f64::NAN, positions, openings, found }
    }
}

impl<const D: usize> Common<D> {
    /// Puts the deviations into `state`, which has been loaded, that move particles in a step of `step` s
    /// by the iterated displacement `sum_m max |u| dt sum_b V_b r_ab / |r_ab| W_ab`, CTVF (37) to (41),
    /// beyond their own velocity, theory (28), for the largest speed in m/s. Returns the number of passes.
    ///
    /// The whole displacement is made in the step: (41) has the acceleration that does so by half
    /// a kick. Fields are not corrected for it, as the transport terms are there for that.
    pub(in super::super) fn iterate_positions(
        &mut self,
        fastest: f64,
        step: f64,
        state: &mut [f64],
    ) -> f64 {
        let Shifting::Iterative { tolerance, most_passes } = self.settings.shifting else {
            return 0.0;
        };
        let mut iteration = std::mem::take(&mut self.iteration);
        iteration.positions.clear();
        iteration.positions.extend_from_slice(self.columns(state).position);
        let reach = fastest * step;
        if self.settings.free_surface {
            self.opening_pass();
            self.find_surfaces();
            iteration.openings.clear();
            let places = self.support.list().places().iter();
            iteration.openings.extend(places.map(|&place| self.openings[place as usize]));
        }
        let (mut passes, begin) = (0.0, self.first());
        for _ in 0..most_passes {
            let (positions, builds) = (&iteration.positions, self.support.list().builds());
            // Places that are lost are noticed when the state is loaded.
            if self.support.update(|number| positions[number - begin]).is_err() {
                break;
            }
            self.follow_places(builds, state);
            let found = &mut iteration.found;
            let largest = self.displacements(reach, &iteration.openings, found);
            if (largest - iteration.even).abs() <= tolerance {
                break;
            }
            passes += 1.0;
            let (found, places) = (&iteration.found, self.support.list().places());
            parallel::for_each_chunk(&mut iteration.positions, |first, rows| {
                for (offset, (row, &place)) in rows.iter_mut().zip(&places[first..]).enumerate() {
                    if !self.is_unshifted(begin + first + offset) {
                        *row += found[place as usize].0;
                    }
                }
            });
        }
        let positions = &iteration.positions;
        let (own, _) = self.parts(state);
        let places = own.position;
        parallel::for_each_chunk(own.deviation, |first, deviation| {
            for (row, deviation) in (first..).zip(deviation) {
                *deviation = (positions[row] - places[row]) / step;
            }
        });
        self.iteration = iteration;
        passes
    }

    /// Notes how even the particles are at the places loaded last.
    pub(in super::super) fn note_evenness(&mut self) {
        let mut iteration = std::mem::take(&mut self.iteration);
        let largest = self.displacements(0.0, &[], &mut iteration.found);
        iteration.even = match self.settings.free_surface {
            true => largest,
            false => {
                let (found, list) = (&iteration.found, self.support.list());
                let fluid = (0..found.len()).filter(|&place| !list.is_passive(place));
                let count = fluid.clone().count();
                fluid.map(|place| found[place].1).sum::<f64>() / count as f64
            }
        };
        self.iteration = iteration;
    }

    /// Fills the displacements and `chi` of the fluid, and returns the largest `chi`.
    /// `openings` by row tell where surfaces are, if there are any.
    fn displacements(
        &self,
        reach: f64,
        openings: &[Opening<D>],
        found: &mut Vec<(Vector<D>, f64)>,
    ) -> f64 {
        let (support, list, begin) = (&self.support, self.support.list(), self.first());
        found.resize(list.owned(), (Vector::zeros(), 0.0));
        let h = support.smoothing_length();
        let scale = h.powi(D as i32);
        let is_along = self.settings.at_surface == AtSurface::Along;
        let source = (self.sides.as_slice(), &self.continua);
        parallel::for_each_chunk(found, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                *row = (Vector::zeros(), 0.0);
                if list.is_passive(place) {
                    continue;
                }
                let opening = openings.get(list.numbers()[place] as usize - begin);
                let within = opening.map(|opening| opening.reach).filter(|&reach| reach < h);
                let smoothing_length = within.filter(|_| !is_along);
                let law = Displacement::<D> { kernel: support.kernel(), smoothing_length };
                let sum = Term { law, source, among: Among::All };
                let mut found = (support.centre(), Vector::zeros());
                add_at(support, &sum, place, &mut block, &mut found);
                let (sum, mut direction) = found;
                if let (Some(opening), Some(_)) = (opening, within) {
                    direction = match is_along {
                        true => opening.tangential(direction, h),
                        false => opening.along_surface(direction),
                    };
                }
                *row = (direction * reach, scale * sum);
            }
        });
        let own = parallel::maximum(found.len(), 0.0, |place| found[place].1);
        let [largest] = self.team().largest([own]);
        largest
    }
}
