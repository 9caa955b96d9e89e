//! Pairs of a gradient and of its adjoint, with as many coefficients as there are sums.

use std::ops::Range;

use nalgebra::{SMatrix, SVector};
use piola_formulas::Number;
use piola_formulas::kernels::Needs;
use piola_formulas::pairs::total_lagrangian::{Forces, Gradients};
use piola_formulas::pairs::{Components, Each, One};

use super::directed::DirectedSupport;
use super::dual_gradient::{DualGradient, dual_row};
use super::frozen::{FrozenRows, Row, RowSizes};
use super::gather::{Among, Term, gather, gather_parts, sum_at, visit};
use crate::parallel::{Parts, Team};
use crate::{Tensor, Vector};

/// Pairs with N coefficients: `G_ab`, and `w_ab X_ab`.
#[derive(Clone, Debug)]
pub(crate) struct AdjointPairs<const D: usize, const N: usize> {
    /// Supports.
    pub gradients: FrozenRows<Each<Components<D>, N>>,
    /// Supports and dual supports: the coefficients as the other has them, and `2 (c_a w_ab + c_b w_ba)` in N/m.
    pub forces: FrozenRows<(Each<Components<D>, N>, One)>,
}

impl<const D: usize, const N: usize> AdjointPairs<D, N> {
    /// Those of a gradient on its support, with hourglass coefficients c in J and arms `w_ab X_ab` by particle,
    /// neighbour and entry.
    pub fn new(
        support: &DirectedSupport<D>,
        gradient: &DualGradient<D>,
        hourglass: &[f64],
        arm: impl Fn(usize, u32, u32) -> Vector<D>,
    ) -> Self {
        let list = &support.list;
        let entries = |a: usize| list.row(a).iter().zip(list.range(a).map(|entry| entry as u32));
        let pair = |a: usize, b: u32, entry: u32| -> [Vector<D>; N] {
            let of = |n: usize| match n {
                0 => Vector::from(*gradient.coefficient(entry)),
                _ => arm(a, b, entry),
            };
            std::array::from_fn(of)
        };
        let row = |a: usize| entries(a).map(move |(&b, entry)| (b, pair(a, b, entry)));
        let stiffness = |a: usize, entry: u32| {
            let own = hourglass.get(a).map_or(0.0, |hourglass| *hourglass);
            2.0 * own * gradient.weight(entry)
        };
        let taken = |a: usize| {
            let mut row: Vec<(u32, ([Vector<D>; N], f64))> = dual_row(support, a)
                .map(|(&b, &entry)| {
                    let owner = b as usize;
                    (b, (pair(owner, a as u32, entry), stiffness(owner, entry)))
                })
                .collect();
            for (&b, entry) in entries(a) {
                let stiffness = stiffness(a, entry);
                match row.binary_search_by_key(&b, |(neighbor, _)| *neighbor) {
                    Ok(known) => row[known].1.1 += stiffness,
                    Err(_) if stiffness == 0.0 => {}
                    Err(place) => row.insert(place, (b, ([Vector::zeros(); N], stiffness))),
                }
            }
            row
        };
        Self {
            gradients: FrozenRows::new((0..hourglass.len()).map(row)),
            forces: FrozenRows::new((0..list.len()).map(taken)),
        }
    }

    /// Those of some particles, and of images, of which `place` says where others stand now.
    pub fn part(&self, own: Range<usize>, images: &[usize], place: impl Fn(u32) -> u32) -> Self {
        let gradients = self.gradients.part(own.clone(), &place);
        let slots = own.chain(images.iter().copied());
        Self { gradients, forces: self.forces.part(slots, place) }
    }

    /// Number of the pairs of a particle in both passes.
    pub fn length(&self, a: usize) -> usize {
        self.gradients.length(a) + self.forces.length(a)
    }

    /// N.
    pub const fn sums(&self) -> usize {
        N
    }

    /// Shows `close` the sums of each particle: its number and that of its row in `out`. `finish` goes over the rows of some
    /// particles when they are filled.
    pub fn sum<O: Parts>(
        &self,
        field: &[Vector<D>],
        out: O,
        close: impl Fn([usize; 2], &[Tensor<D>; N], &mut O) + Sync,
        finish: impl Fn(Range<usize>, &mut O) + Sync,
    ) {
        let sum = Term { law: Gradients::<D, N>, source: field, among: Among::All };
        let count = self.gradients.count();
        let (alone, rows) = (Team::default(), (&self.gradients, &sum));
        let close =
            |rows, sums: &[Tensor<D>; N], out: &mut O, _: &mut [f64; 0]| close(rows, sums, out);
        let _: [f64; 0] = gather_parts(&alone, rows, (count, out), close, finish);
    }

    /// The sums of one particle, in numbers of any type.
    #[inline]
    pub fn sums_at<T: Number>(&self, field: &[SVector<T, D>], a: usize) -> [SMatrix<T, D, D>; N] {
        sum_at(&self.gradients, &Gradients::<D, N>, a, |b| field[b])
    }

    /// Shows what particle a has in its support, with the coefficients.
    pub fn visit(&self, a: usize, mut look: impl FnMut(usize, &[Vector<D>; N])) {
        let (among, needs) = (Among::All, Needs::Nothing);
        visit(&self.gradients, a, among, needs, &mut Row::default(), |b, (pair, _)| look(b, pair));
    }

    /// All that particle a shares a support with, some twice.
    pub fn all(&self, a: usize) -> Vec<u32> {
        let mut all = Vec::new();
        // Images have no support of their own.
        if a < self.gradients.count() {
            self.visit(a, |b, _| all.push(b as u32));
        }
        let (among, needs) = (Among::All, Needs::Nothing);
        visit(&self.forces, a, among, needs, &mut Row::default(), |b, _| all.push(b as u32));
        all
    }

    /// Writes the forces of derivatives of an energy by all sums; `own` are the sums of the coefficients of
    /// each particle.
    pub fn forces(
        &self,
        field: &[Vector<D>],
        own: impl Fn(usize) -> [Vector<D>; 2] + Sync,
        tension: &[Tensor<D>],
        force: &mut [Vector<D>],
    ) {
        let (tension, _) = tension.as_chunks::<N>();
        let source = (tension, field);
        let sum = Term { law: Forces::<D, N>, source, among: Among::All };
        gather(&self.forces, &sum, force, Some, |a, taken, force| {
            *force = *taken;
            tension[a].iter().zip(&own(a)).for_each(|(tension, sum)| *force += tension * sum);
        });
    }

    /// How large the rows of both passes are.
    pub fn sizes(&self) -> [RowSizes; 2] {
        [self.gradients.sizes(), self.forces.sizes()]
    }

    /// Bytes of all coefficients.
    pub fn memory(&self) -> usize {
        self.gradients.memory() + self.forces.memory()
    }
}
