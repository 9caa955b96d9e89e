//! The pass over pairs: forces, deformation rates and upwind dissipation in one gather.

use rayon::prelude::*;

use super::interaction::{Gathered, Pair};
use super::local::Side;
use super::{BODY_FORCE, Powers, Row, UPWIND_PRESSURE, UPWIND_VELOCITY, Upwind};
use crate::parallel::CHUNK;
use crate::{Tensor, Vector};

/// Neighbours that the innermost loop takes at a time, each with partial sums of its own: the
/// compiler turns them into lanes of vector registers, and as their number is fixed the order of
/// all sums is too, however wide the registers are.
const LANES: usize = 8;

/// A number of each lane.
pub(super) type Lanes = [f64; LANES];

impl<const D: usize> Upwind<D> {
    /// Writes the rates of all rows and the powers at their end.
    pub(super) fn pair_pass(&mut self, rate: &mut [f64]) {
        let settings = &self.settings;
        let velocity = settings.tau_velocity > 0.0;
        let pressure = settings.tau_pressure > 0.0;
        match (velocity, pressure, settings.reconstruction) {
            (false, false, _) => self.all_rows(rate, rate_rows::<D, false, false, false>),
            (true, false, false) => self.all_rows(rate, rate_rows::<D, true, false, false>),
            (_, true, false) => self.all_rows(rate, rate_rows::<D, true, true, false>),
            (_, _, true) => self.all_rows(rate, rate_rows::<D, true, true, true>),
        }
    }

    fn all_rows(&mut self, rate: &mut [f64], rate_rows: RateRows<D>) {
        let (rows, tail) = rate.split_at_mut(self.particles.len() * Row::<D>::LENGTH);
        let mut powers = std::mem::take(&mut self.chunk_powers);
        let chunk_length = CHUNK * Row::<D>::LENGTH;
        let body = |(chunk, (rows, powers)): (usize, (&mut [f64], &mut Powers))| {
            *powers = rate_rows(self, chunk * CHUNK, rows);
        };
        if powers.len() <= 1 {
            rows.chunks_mut(chunk_length).zip(&mut powers).enumerate().for_each(body);
        } else {
            rows.par_chunks_mut(chunk_length).zip(&mut powers).enumerate().for_each(body);
        }
        tail.fill(0.0);
        for chunk in &powers {
            tail.iter_mut().zip(chunk.0).for_each(|(total, part)| *total += part);
        }
        self.chunk_powers = powers;
    }

    /// The sums over the neighbours of particle a, theory (8) to (10).
    #[inline(always)]
    fn gather<const VELOCITY: bool, const PRESSURE: bool, const RECONSTRUCTION: bool>(
        &self,
        a: usize,
    ) -> Gathered<f64, D> {
        let me = &self.sides[a];
        let entries = self.support.list.range(a);
        let neighbors = self.support.list.row(a).chunks(LANES);
        let areas = self.areas.forward(entries.clone()).chunks(LANES);
        let transposed = self.areas.adjoint(entries).chunks(LANES);
        let mut sums = Gathered::uniform([0.0; LANES]);
        for ((neighbors, areas), transposed) in neighbors.zip(areas).zip(transposed) {
            let mut others = [me; LANES];
            for (other, &b) in others.iter_mut().zip(neighbors) {
                *other = &self.sides[b as usize];
            }
            let mut slopes = None;
            if RECONSTRUCTION {
                let slopes = slopes.insert([&self.slopes[a]; LANES]);
                for (slope, &b) in slopes.iter_mut().zip(neighbors) {
                    *slope = &self.slopes[b as usize];
                }
            }
            let (current, reference) = self.separations(me, &others);
            let count = neighbors.len().min(LANES);
            let (areas, transposed) = (&areas[..count], &transposed[..count]);
            for lane in 0..count {
                let pair = Pair {
                    me,
                    other: others[lane],
                    area: Vector::from(areas[lane]),
                    transposed: Vector::from(transposed[lane]),
                    current: Vector::from_fn(|i, _| current[i][lane]),
                    reference: Vector::from_fn(|i, _| reference[i][lane]),
                    slopes: slopes.map(|slopes| [&self.slopes[a], slopes[lane]]),
                };
                sums.add(lane, &pair.terms::<VELOCITY, PRESSURE>());
            }
        }
        sums.total()
    }

    /// Current and reference separations from a particle to others, component by component.
    #[inline(always)]
    fn separations(&self, me: &Side<D>, others: &[&Side<D>; LANES]) -> ([Lanes; D], [Lanes; D]) {
        let domain = &self.support.domain;
        let (mut current, mut reference) = ([[0.0; LANES]; D], [[0.0; LANES]; D]);
        for (lane, other) in others.iter().enumerate() {
            let (now, then) = if domain.is_open() {
                (other.position - me.position, other.reference - me.reference)
            } else {
                (
                    domain.separation(&me.position, &other.position),
                    domain.separation(&me.reference, &other.reference),
                )
            };
            for i in 0..D {
                current[i][lane] = now[i];
                reference[i][lane] = then[i];
            }
        }
        (current, reference)
    }
}

/// Writes the rates of some rows, the first of which has the number given.
type RateRows<const D: usize> = fn(&Upwind<D>, usize, &mut [f64]) -> Powers;

#[multiversion::multiversion(targets("x86_64+avx2"))]
fn rate_rows<
    const D: usize,
    const VELOCITY: bool,
    const PRESSURE: bool,
    const RECONSTRUCTION: bool,
>(
    scheme: &Upwind<D>,
    first: usize,
    rows: &mut [f64],
) -> Powers {
    let mut powers = Powers::default();
    for (offset, row) in rows.chunks_exact_mut(Row::<D>::LENGTH).enumerate() {
        let a = first + offset;
        let sums = scheme.gather::<VELOCITY, PRESSURE, RECONSTRUCTION>(a);
        scheme.write_row(a, &sums, row, &mut powers);
    }
    powers
}

impl<const D: usize> Upwind<D> {
    #[inline(always)]
    fn write_row(&self, a: usize, sums: &Gathered<f64, D>, row: &mut [f64], powers: &mut Powers) {
        let me = &self.sides[a];
        let (settings, volume) = (&self.settings, self.particles.volume[a]);
        let internal =
            Vector::from(sums.internal) + me.cofactor * self.areas.diagonal(a) * me.pressure;
        let upwind_force = Vector::from(sums.upwind_force) * settings.tau_velocity;
        let upwind_volume_rate = sums.upwind_volume_rate * settings.tau_pressure;
        let gravity = self.body_acceleration[a];
        let mass = self.mass(a);
        let acceleration = (internal + upwind_force) / mass + gravity;
        let deformation_rate = Tensor::from_fn(|i, j| sums.deformation_rate[i][j] / volume);
        row[..D].copy_from_slice(acceleration.as_slice());
        let dilatation = me.cofactor.dot(&deformation_rate);
        row[Row::<D>::VOLUME_RATIO] = dilatation + upwind_volume_rate / volume;
        row[Row::<D>::POSITION..Row::<D>::DEFORMATION].copy_from_slice(me.velocity.as_slice());
        for i in 0..D {
            for j in 0..D {
                row[Row::<D>::DEFORMATION + i * D + j] = deformation_rate[(i, j)];
            }
        }
        powers.0[BODY_FORCE] += mass * gravity.dot(&me.velocity);
        powers.0[UPWIND_VELOCITY] += upwind_force.dot(&me.velocity);
        powers.0[UPWIND_PRESSURE] -= me.pressure * upwind_volume_rate;
    }
}

impl<const D: usize> Gathered<Lanes, D> {
    /// Adds the terms of a pair to one lane.
    #[inline(always)]
    fn add(&mut self, lane: usize, terms: &Gathered<f64, D>) {
        for i in 0..D {
            self.internal[i][lane] += terms.internal[i];
            self.upwind_force[i][lane] += terms.upwind_force[i];
            for j in 0..D {
                self.deformation_rate[i][j][lane] += terms.deformation_rate[i][j];
            }
        }
        self.upwind_volume_rate[lane] += terms.upwind_volume_rate;
    }

    /// The sums over all lanes.
    #[inline(always)]
    fn total(&self) -> Gathered<f64, D> {
        Gathered {
            internal: self.internal.map(total),
            deformation_rate: self.deformation_rate.map(|row| row.map(total)),
            upwind_force: self.upwind_force.map(total),
            upwind_volume_rate: total(self.upwind_volume_rate),
        }
    }
}

/// Sum over the lanes, by halves.
#[inline(always)]
fn total(lanes: Lanes) -> f64 {
    let quarter = |k: usize| (lanes[k] + lanes[k + 4]) + (lanes[k + 2] + lanes[k + 6]);
    quarter(0) + quarter(1)
}
