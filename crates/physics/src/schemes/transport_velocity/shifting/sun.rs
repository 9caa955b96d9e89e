//! SPST: a velocity deviation from the crowding of neighbours.

use piola_formulas::fluid;
use piola_formulas::pairs::sums::CrowdingWithin;

use crate::operators::{Among, NeighborBlock, OfCenter, Term, add_at};
use crate::schemes::transport_velocity::{AtSurface, Common, Shifting};
use crate::{Vector, parallel};

/// Largest Mach number of CTVF (35). A fluid that is faster is not weakly compressible: such a
/// speed is that of a particle in a splash, and no measure of how fast the others lose their order.
const MOST_MACH: f64 = 0.25;

/// How fast particles are shifted by SPST.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Speed {
    factor: f64,
    /// The largest speed that counts in m/s.
    most: f64,
    smoothing_length: f64,
}

impl Speed {
    /// What the sum of CTVF (35) is scaled by, in m^2/s, and the largest deviation in m/s, for a largest
    /// speed in m/s.
    pub fn of(&self, fastest: f64) -> (f64, f64) {
        let speed = fastest.min(self.most);
        (-self.factor * speed * 2.0 * self.smoothing_length, 0.5 * speed)
    }
}

impl<const D: usize> Common<D> {
    /// Replaces the deviations of the sides by those of the current places,
    /// `d_a = -f Ma 2h c sum V_b (1 + R (W_ab / W(dx))^4) grad W_ab`, CTVF (35), where the Mach
    /// number is that of the largest speed now, of solids by theory (76): `Ma c = max |u|`. Near
    /// free surfaces the sum has the smaller support of CTVF algorithm 1, and (44) holds: theory (27), (30). As
    /// in the method's source, no deviation is larger than half of the largest speed.
    pub(in super::super) fn shift(&mut self) {
        let (scale, most) = self.shifting_speed().of(self.fastest);
        let mut sides = std::mem::take(&mut self.sides);
        if self.settings.free_surface {
            self.volumes.clear();
            self.volumes.extend(sides.iter().map(|side| side.volume));
        }
        let (list, h) = (self.support.list(), self.support.smoothing_length());
        parallel::for_each_chunk(&mut sides[..list.owned()], |first, sides| {
            let mut block = NeighborBlock::default();
            for (offset, side) in sides.iter_mut().enumerate() {
                let place = first + offset;
                if list.is_passive(place) {
                    continue;
                }
                if self.is_unshifted(list.numbers()[place] as usize) {
                    side.deviation = Vector::zeros();
                    continue;
                }
                let crowding = self.forces[place].crowding;
                let is_along = self.settings.at_surface == AtSurface::Along;
                let shift = match self.openings.get(place) {
                    None => crowding,
                    Some(opening) if is_along => opening.tangential(crowding, h),
                    Some(opening) if opening.is_surface => Vector::zeros(),
                    Some(opening) if opening.reach < h => {
                        let crowding = self.crowding_within(place, opening.reach, &mut block);
                        opening.along_surface(crowding)
                    }
                    Some(_) => crowding,
                };
                side.deviation = fluid::shortened(shift * scale, most);
            }
        });
        self.sides = sides;
    }

    /// How fast particles are shifted; not at all without SPST.
    pub(in super::super) fn shifting_speed(&self) -> Speed {
        let factor = match self.settings.shifting {
            Shifting::Sun { factor } => factor,
            _ => 0.0,
        };
        let speeds = self.at_rest.iter().map(|matter| matter.wave_speed);
        let most = MOST_MACH * speeds.fold(0.0, f64::max);
        Speed { factor, most, smoothing_length: self.support.smoothing_length() }
    }

    /// The sum of CTVF (35) with a smaller support, for the few particles near surfaces. Volumes
    /// stand in `volumes`.
    fn crowding_within(&self, place: usize, h: f64, block: &mut NeighborBlock<D>) -> Vector<D> {
        let smoothing_length = self.support.smoothing_length();
        let crowding = 1.0 / self.value_at_spacing(smoothing_length);
        let kernel = self.support.kernel();
        let law = CrowdingWithin::<D> { kernel, smoothing_length, crowding };
        let source = ((self.volumes.as_slice(), &self.continua), OfCenter(|_| h));
        let mut sum = Vector::zeros();
        add_at(&self.support, &Term { law, source, among: Among::All }, place, block, &mut sum);
        sum
    }

    /// The sum of the kernel over a square lattice of the spacing times the volume of a particle in it: 1 but for what a
    /// kernel of few neighbours lacks.
    pub(in super::super) fn lattice_sum(&self) -> f64 {
        let (kernel, h) = (self.support.kernel(), self.support.smoothing_length());
        let spacing = self.particles.spacing[0];
        let reach = (kernel.support_radius(h) / spacing) as usize;
        let width = 2 * reach + 1;
        let sites = (0..width.pow(D as u32)).map(|site| {
            let steps = (0..D).map(|axis| (site / width.pow(axis as u32) % width).abs_diff(reach));
            (steps.map(|steps| steps * steps).sum::<usize>() as f64).sqrt() * spacing
        });
        sites.map(|distance| kernel.value(D, distance, h)).sum::<f64>() * spacing.powi(D as i32)
    }

    /// The kernel at a distance of one spacing, in m^-D.
    pub(in super::super) fn value_at_spacing(&self, smoothing_length: f64) -> f64 {
        self.support.kernel().value(D, self.particles.spacing[0], smoothing_length)
    }
}
