//! Particles that move until they are even.

use super::lower::Depth;
use super::outside::Outside;
use super::{KERNEL, Packing, smoothing};
use crate::geometry::Shape;
use crate::neighbors::{Domain, NeighborError, NeighborList, search};
use crate::{Vector, parallel};

/// Most steps.
const MOST: usize = 1000;

/// Lists of neighbours hold what is nearer than the support and this many spacings, and last until a particle has moved
/// by half of these.
const SKIN: f64 = 0.5;

/// Most spacings that a particle moves in a step.
const LONGEST: f64 = 0.1;

/// By how much a step is made longer after this many downhill, and shorter after one uphill; how much of velocities is
/// turned towards the forces at first, and what remains of that part after each step: those of Bitzek2006.
const LONGER: f64 = 1.1;
const AFTER: usize = 5;
const SHORTER: f64 = 0.5;
const TURNED: f64 = 0.1;
const LESS: f64 = 0.99;
/// The shortest step, of the longest.
const SHORTEST: f64 = 1e-3;

/// A particle on its way.
#[derive(Clone, Copy)]
struct Moving<const D: usize> {
    at: Vector<D>,
    /// In spacings.
    velocity: Vector<D>,
    force: Vector<D>,
    /// By how much it is deeper than it has to be, at least, in m.
    clear: f64,
}

/// Neighbours, and the places at which they were found.
struct Pairs<const D: usize> {
    list: NeighborList,
    found_at: Vec<Vector<D>>,
}

impl<const D: usize> Pairs<D> {
    fn of(position: &[Vector<D>], reach: f64) -> Result<Self, NeighborError> {
        let list = search(position, &vec![reach; position.len()], &Domain::open())?;
        Ok(Self { list, found_at: position.to_vec() })
    }

    /// Whether no particle has moved by more than this many m.
    fn hold(&self, position: &[Vector<D>], most: f64) -> bool {
        let moved = |a: usize| (position[a] - self.found_at[a]).norm();
        parallel::maximum(position.len(), 0.0, moved) <= most
    }
}

/// What is added up over particles.
#[derive(Clone, Copy, Default)]
struct Totals {
    power: f64,
    force: f64,
    velocity: f64,
    push: f64,
}

/// Moves particles of volume `own` in a shape by the forces of theory (100), by the method of Bitzek2006, until none would move by
/// more than [`Packing::SETTLED`] spacings. Returns the number of steps and how far one would.
pub(super) fn settle<const D: usize>(
    position: &mut [Vector<D>],
    shape: &Shape<D>,
    outside: &Outside<D>,
    own: f64,
) -> Result<(usize, f64), NeighborError> {
    let width = outside.width();
    let new = |at: &Vector<D>| Moving {
        at: *at,
        velocity: Vector::zeros(),
        force: Vector::zeros(),
        clear: f64::NEG_INFINITY,
    };
    let mut all: Vec<Moving<D>> = position.iter().map(new).collect();
    shift(&mut all, shape, width, 0.0);
    let stiffness = stiffness::<D>(outside, own);
    let longest = 1.0 / stiffness.sqrt();
    let (mut step, mut turned, mut downhill) = (0.5 * longest, TURNED, 0);
    let mut pairs: Option<Pairs<D>> = None;
    let mut taken = 0;
    let push = loop {
        position.iter_mut().zip(&all).for_each(|(x, own)| *x = own.at);
        let known = pairs.take().filter(|pairs| pairs.hold(position, 0.5 * SKIN * width));
        let known =
            known.map_or_else(|| Pairs::of(position, outside.reach() + SKIN * width), Ok)?;
        forces(&mut all, position, &known.list, outside, own);
        pairs = Some(known);
        confine(&mut all, shape, width, stiffness);
        let totals = totals(&all);
        let push = totals.push / stiffness;
        if push <= Packing::SETTLED || taken == MOST {
            break push;
        }
        if totals.power > 0.0 {
            let scale = turned * (totals.velocity / totals.force.max(f64::MIN_POSITIVE)).sqrt();
            let keep = 1.0 - turned;
            for own in &mut all {
                own.velocity = own.velocity * keep + own.force * scale;
            }
            downhill += 1;
            if downhill > AFTER {
                (step, turned) = ((LONGER * step).min(longest), LESS * turned);
            }
        } else {
            all.iter_mut().for_each(|own| own.velocity.fill(0.0));
            (step, turned, downhill) = ((SHORTER * step).max(SHORTEST * longest), TURNED, 0);
        }
        all.iter_mut().for_each(|own| own.velocity += own.force * step);
        shift(&mut all, shape, width, step);
        taken += 1;
    };
    Ok((taken, push))
}

/// An upper bound on the slope of forces, both in spacings, for particles on a square lattice: twice the sum of what each neighbour
/// adds.
fn stiffness<const D: usize>(outside: &Outside<D>, own: f64) -> f64 {
    let (width, h) = (outside.width(), smoothing(outside.width()));
    let most = (outside.reach() / width).ceil() as usize;
    let side = 2 * most + 1;
    let of = |number: usize| {
        let square: f64 = (0..D)
            .map(|axis| (number / side.pow(axis as u32) % side) as f64 - most as f64)
            .map(|step| step * step)
            .sum();
        if square == 0.0 {
            return 0.0;
        }
        let (r, off) = (square.sqrt() * width, 1e-4 * width);
        let slope = |r: f64| KERNEL.derivative_over_r(D, r, h) * r;
        let bend = (slope(r + off) - slope(r - off)) / (2.0 * off);
        bend.abs().max(KERNEL.derivative_over_r(D, r, h).abs())
    };
    let sum: f64 = (0..side.pow(D as u32)).map(of).sum();
    2.0 * own * width * width * sum
}

/// The forces of theory (100).
fn forces<const D: usize>(
    all: &mut [Moving<D>],
    position: &[Vector<D>],
    list: &NeighborList,
    outside: &Outside<D>,
    own: f64,
) {
    let (width, reach, h) = (outside.width(), outside.reach(), smoothing(outside.width()));
    parallel::for_each_chunk(all, |first, all| {
        for (offset, moving) in all.iter_mut().enumerate() {
            let mut sum = Vector::zeros();
            for &b in list.row(first + offset) {
                let apart = moving.at - position[b as usize];
                let square = apart.norm_squared();
                if square < reach * reach {
                    sum += apart * KERNEL.derivative_over_r(D, square.sqrt(), h);
                }
            }
            let beyond = match moving.clear < reach {
                true => outside.sum(&moving.at).1,
                false => Vector::zeros(),
            };
            moving.force = (sum * own + beyond) * -width;
        }
    });
}

fn totals<const D: usize>(all: &[Moving<D>]) -> Totals {
    let sum =
        |term: &(dyn Fn(&Moving<D>) -> f64 + Sync)| parallel::sum(all.len(), |a| term(&all[a]));
    Totals {
        power: sum(&|own| own.force.dot(&own.velocity)),
        force: sum(&|own| own.force.norm_squared()),
        velocity: sum(&|own| own.velocity.norm_squared()),
        push: parallel::maximum(all.len(), 0.0, |a| all[a].force.norm()),
    }
}

/// Takes from forces what would push particles higher than they may be: what is left of a step downhill as long as the stiffness
/// allows once it has ended low enough.
fn confine<const D: usize>(all: &mut [Moving<D>], shape: &Shape<D>, width: f64, stiffness: f64) {
    let scale = width / stiffness;
    parallel::for_each_chunk(all, |_, all| {
        let mut depth = Depth::of(shape, width);
        for own in all {
            let way = own.force * scale;
            if own.clear < way.norm() {
                own.force = (depth.lower(own.at + way).0 - own.at) / scale;
            }
        }
    });
}

/// Moves particles by their velocities, and those that are then less than half a spacing below the boundary down to there,
/// theory (102).
fn shift<const D: usize>(all: &mut [Moving<D>], shape: &Shape<D>, width: f64, step: f64) {
    let fastest = LONGEST / step.max(f64::MIN_POSITIVE);
    parallel::for_each_chunk(all, |_, all| {
        let mut depth = Depth::of(shape, width);
        for own in all {
            let speed = own.velocity.norm();
            if speed > fastest {
                own.velocity *= fastest / speed;
            }
            let way = own.velocity * (step * width);
            own.clear -= way.norm();
            let (before, after) = (own.at, own.at + way);
            own.at = after;
            if own.clear <= 0.0 {
                (own.at, own.clear) = depth.lower(after);
                if own.at != after && step > 0.0 {
                    own.velocity = (own.at - before) / (step * width);
                }
            }
        }
    });
}
