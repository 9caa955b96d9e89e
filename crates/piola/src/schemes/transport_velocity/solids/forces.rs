//! Accelerations of solids.

use multiversion::multiversion;
use piola_formulas::fluid;

use super::{Contact, Solids, Tension};
use crate::Vector;
use crate::operators::{LANES, Lanes, Needs, Neighbor, NeighborBlock, all_of, total};
use crate::parallel;
use crate::schemes::transport_velocity::{Forces, Shifting, Side, TransportVelocity};

/// What a loop is made for: bodies that see each other as one, or one alone;
const ONE: u8 = 0;
/// bodies that push each other by their pressures;
const PUSH: u8 = 1;
/// or by springs.
const SPRINGS: u8 = 2;

/// Constants of one pass.
struct Constants {
    softening: f64,
    /// `alpha h` of CTVF (28).
    artificial: f64,
    /// What of it there is between bodies.
    artificial_apart: f64,
    /// Stiffness of the springs between bodies in units of their bulk moduli, and how long they are in m.
    penalty: f64,
    spacing: f64,
    /// `1 / W(dx)` where particles are shifted by SPST.
    crowding: f64,
}

/// Sums over neighbours: `T` is `f64`, or [`Lanes`] while they grow.
struct Sums<T, const D: usize> {
    stress: [T; D],
    /// Acceleration by other bodies, or the force of springs in N.
    contact: [T; D],
    artificial: [T; D],
    walls: [T; D],
    volume: [T; D],
    crowding: [T; D],
}

/// A particle as forces see it.
#[derive(Clone, Copy)]
struct End<'a, const D: usize> {
    side: &'a Side<D>,
    tension: &'a Tension<D>,
}

impl<const D: usize> TransportVelocity<D> {
    /// Fills the accelerations of solids, without body forces: theory (73) to (75).
    pub(in super::super) fn solid_force_pass(&mut self) {
        let Some(solids) = self.solids.as_deref() else { return };
        let h = self.support.smoothing_length();
        let spacing = self.particles.spacing[0];
        let artificial = self.settings.artificial_viscosity * h;
        let crowding = match self.settings.shifting {
            Shifting::Sun { .. } => 1.0 / self.value_at_spacing(h),
            _ => 0.0,
        };
        let constants = Constants {
            softening: fluid::softening(h),
            artificial,
            artificial_apart: match solids.contact {
                Contact::Penalty { .. } => 0.0,
                _ => artificial,
            },
            penalty: match solids.contact {
                Contact::Penalty { stiffness } => stiffness * spacing.powi(D as i32 - 2),
                _ => 0.0,
            },
            spacing,
            crowding,
        };
        let contact = match (self.continua.are_several(), solids.contact) {
            (true, Contact::Repulsive) => PUSH,
            (true, Contact::Penalty { .. }) => SPRINGS,
            _ => ONE,
        };
        let is_plain = solids.corrections.is_empty() && solids.is_uniform();
        let fill = match (is_plain, contact) {
            (true, ONE) => fill::<D, true, ONE>,
            (true, PUSH) => fill::<D, true, PUSH>,
            (true, _) => fill::<D, true, SPRINGS>,
            (false, ONE) => fill::<D, false, ONE>,
            (false, PUSH) => fill::<D, false, PUSH>,
            (false, _) => fill::<D, false, SPRINGS>,
        };
        let mut forces = std::mem::take(&mut self.forces);
        parallel::for_each_chunk(&mut forces, |first, rows| fill(self, &constants, first, rows));
        self.forces = forces;
    }

    fn end<'a>(&'a self, solids: &'a Solids<D>, place: usize) -> End<'a, D> {
        End { side: &self.sides[place], tension: &solids.tensions[place] }
    }

    /// The sums of the particle at `place`.
    #[inline(always)]
    fn gather_stresses<const PLAIN: bool, const CONTACT: u8>(
        &self,
        solids: &Solids<D>,
        place: usize,
        constants: &Constants,
        block: &mut NeighborBlock<D>,
    ) -> Sums<Lanes, D> {
        let zero = [0.0; LANES];
        let mut sums = Sums {
            stress: [zero; D],
            contact: [zero; D],
            artificial: [zero; D],
            walls: [zero; D],
            volume: [zero; D],
            crowding: [zero; D],
        };
        let me = self.end(solids, place);
        let needs = Needs::Both;
        let mut rest = self.support.active(place);
        while self.support.fill(&mut rest, needs, block) {
            for group in block.groups() {
                let sides = all_of(&self.sides, group.places);
                let tensions = all_of(&solids.tensions, group.places);
                let all_own = match CONTACT {
                    ONE => [1.0; LANES],
                    _ => self.continua.own(place, group.places),
                };
                for lane in 0..LANES {
                    let own = all_own[lane];
                    let other = End { side: sides[lane], tension: tensions[lane] };
                    let neighbor = group.neighbor(lane);
                    sums.add_stress::<PLAIN>(lane, me, other, own, &neighbor);
                    sums.add_artificial::<PLAIN>(lane, me, other, own, &neighbor, constants);
                    if CONTACT != ONE {
                        let apart = 1.0 - own;
                        sums.add_contact::<CONTACT>(lane, me, other, apart, &neighbor, constants);
                    }
                    sums.crowd(lane, other.side.volume * own, &neighbor, constants);
                }
            }
        }
        let mut rest = self.support.passive(place);
        while self.support.fill(&mut rest, needs, block) {
            for group in block.groups() {
                let sides = all_of(&self.sides, group.places);
                let tensions = all_of(&solids.tensions, group.places);
                for lane in 0..LANES {
                    let other = End { side: sides[lane], tension: tensions[lane] };
                    let neighbor = group.neighbor(lane);
                    let force = pull::<D, PLAIN>(me, other, &neighbor);
                    for (sum, force) in sums.walls.iter_mut().zip(force) {
                        sum[lane] += force;
                    }
                    sums.crowd(lane, other.side.volume, &neighbor, constants);
                }
            }
        }
        sums
    }

    /// The force of solids on a wall particle, over its mass.
    fn reaction_of_solids(
        &self,
        solids: &Solids<D>,
        place: usize,
        block: &mut NeighborBlock<D>,
    ) -> Forces<D> {
        let (me, mut sum) = (self.end(solids, place), Vector::zeros());
        let mut rest = self.support.active(place);
        while self.support.fill(&mut rest, Needs::Slope, block) {
            for neighbor in block.iter() {
                let other = self.end(solids, neighbor.place);
                sum += Vector::from(pull::<D, false>(me, other, &neighbor));
            }
        }
        Forces { walls: sum * me.tension.share, ..Forces::default() }
    }
}

/// `m_b (sigma_a/rho_a^2 + sigma_b/rho_b^2) . grad W_ab`, with corrected gradients
/// `V_b (sigma_a L_a + sigma_b L_b) . grad W_ab`.
///
/// What is `PLAIN` has no corrections and is symmetric: each number less to collect from neighbours
/// counts.
#[inline(always)]
fn pull<const D: usize, const PLAIN: bool>(
    me: End<'_, D>,
    other: End<'_, D>,
    neighbor: &Neighbor<D>,
) -> [f64; D] {
    let weight = if PLAIN { other.side.mass() } else { other.tension.weight };
    let mut force = [0.0; D];
    for (i, force) in force.iter_mut().enumerate() {
        let mut sum = 0.0;
        for j in 0..D {
            let (row, column) = if PLAIN { (i.min(j), i.max(j)) } else { (i, j) };
            let tensor = me.tension.tensor[row][column] + other.tension.tensor[row][column];
            sum += tensor * neighbor.separation[j];
        }
        *force = sum * (weight * neighbor.slope);
    }
    force
}

impl<const D: usize> Sums<Lanes, D> {
    #[inline(always)]
    fn add_stress<const PLAIN: bool>(
        &mut self,
        lane: usize,
        me: End<'_, D>,
        other: End<'_, D>,
        own: f64,
        neighbor: &Neighbor<D>,
    ) {
        let force = pull::<D, PLAIN>(me, other, neighbor);
        for (sum, force) in self.stress.iter_mut().zip(force) {
            sum[lane] += force * own;
        }
    }

    /// Adds the artificial viscosity, CTVF (28), which pushes. In what is `PLAIN` waves are as fast
    /// everywhere.
    #[inline(always)]
    fn add_artificial<const PLAIN: bool>(
        &mut self,
        lane: usize,
        me: End<'_, D>,
        other: End<'_, D>,
        own: f64,
        neighbor: &Neighbor<D>,
        constants: &Constants,
    ) {
        let jump = me.side.velocity - other.side.velocity;
        let approach = jump.dot(&neighbor.separation);
        let densities = me.side.density + other.side.density;
        let scale = fluid::exchange_scale(densities, neighbor.square, constants.softening);
        let alpha = own * constants.artificial + (1.0 - own) * constants.artificial_apart;
        let speed = match PLAIN {
            true => me.tension.wave_speed,
            false => 0.5 * (me.tension.wave_speed + other.tension.wave_speed),
        };
        let artificial = fluid::artificial_viscosity(alpha * speed, approach, scale);
        let push = artificial * other.side.mass() * neighbor.slope;
        for i in 0..D {
            self.artificial[i][lane] -= neighbor.separation[i] * push;
        }
    }

    /// Adds what bodies that are apart do to each other.
    #[inline(always)]
    fn add_contact<const CONTACT: u8>(
        &mut self,
        lane: usize,
        me: End<'_, D>,
        other: End<'_, D>,
        apart: f64,
        neighbor: &Neighbor<D>,
        constants: &Constants,
    ) {
        let push = match CONTACT {
            SPRINGS => {
                let (one, two) = (me.tension.stiffness, other.tension.stiffness);
                let distance = neighbor.square.sqrt();
                let overlap = (constants.spacing - distance).max(0.0);
                let spring = constants.penalty * (2.0 * one * two / (one + two)) * overlap;
                spring / distance.max(f64::MIN_POSITIVE)
            }
            _ => {
                let load = (me.side.load + other.side.load).max(0.0);
                -load * other.side.mass() * neighbor.slope
            }
        };
        for i in 0..D {
            self.contact[i][lane] += neighbor.separation[i] * (push * apart);
        }
    }

    /// Adds what shifting and surfaces need.
    #[inline(always)]
    fn crowd(&mut self, lane: usize, volume: f64, neighbor: &Neighbor<D>, constants: &Constants) {
        let factor = fluid::repulsion(neighbor.value * constants.crowding);
        let slope = volume * neighbor.slope;
        for i in 0..D {
            let area = neighbor.separation[i] * slope;
            self.volume[i][lane] += area;
            self.crowding[i][lane] += area * factor;
        }
    }

    /// The sums over all lanes.
    #[inline(never)]
    fn total(&self) -> Sums<f64, D> {
        Sums {
            stress: self.stress.map(total),
            contact: self.contact.map(total),
            artificial: self.artificial.map(total),
            walls: self.walls.map(total),
            volume: self.volume.map(total),
            crowding: self.crowding.map(total),
        }
    }
}

/// Fills some rows.
#[multiversion(targets("x86_64+avx2"))]
fn fill<const D: usize, const PLAIN: bool, const CONTACT: u8>(
    scheme: &TransportVelocity<D>,
    constants: &Constants,
    first: usize,
    rows: &mut [Forces<D>],
) {
    let Some(solids) = scheme.solids.as_deref() else { return };
    let mut block = NeighborBlock::default();
    for (offset, row) in rows.iter_mut().enumerate() {
        let place = first + offset;
        if scheme.support.list().is_passive(place) {
            *row = scheme.reaction_of_solids(solids, place, &mut block);
            continue;
        }
        let sums = scheme.gather_stresses::<PLAIN, CONTACT>(solids, place, constants, &mut block);
        let sums = sums.total();
        let (side, share) = (&scheme.sides[place], solids.tensions[place].share);
        let contact = if constants.penalty > 0.0 { 1.0 / side.mass() } else { 1.0 };
        *row = Forces {
            pressure: Vector::from(sums.stress) * share + Vector::from(sums.contact) * contact,
            artificial_viscosity: sums.artificial.into(),
            walls: Vector::from(sums.walls) * share,
            crowding: sums.crowding.into(),
            opening: -Vector::from(sums.volume),
            ..Forces::default()
        };
    }
}
