//! The areas through which particles act on each other, in blocks of neighbours.

use piola_formulas::kernels::Needs;
use piola_formulas::pairs::{Frozen, FrozenPair, Record};
use piola_formulas::{Lanes as _, Lanes4, WIDTH};

use super::gather::{Among, Pairs};
use super::gradient::GradientOperator;
use crate::Vector;
use crate::neighbors::NeighborList;

/// Neighbours of a block.
///
/// A sum over neighbours keeps one partial sum a lane, and as this number is fixed so is the
/// order of all sums, however wide the registers of the machine are.
pub const LANES: usize = 8;

/// A number of each neighbour of a block.
pub type Lanes = [f64; LANES];

/// Some neighbours of a particle with the areas between them, component by component, so that
/// one operation acts on all lanes.
#[derive(Clone, Copy, Debug)]
pub struct Block<const D: usize> {
    /// Numbers of the neighbours.
    pub neighbors: [u32; LANES],
    /// Components of `V_a G_ab` in m^(D-1).
    pub forward: [Lanes; D],
    /// Components of `V_b G_ba` in m^(D-1).
    pub adjoint: [Lanes; D],
}

/// Where the neighbours of a particle stand, and how many there are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    first: u32,
    count: u32,
}

/// Gradient coefficients times quadrature volumes, `V_a G_ab`, of every pair both ways.
///
/// They are what the sums of a formulation use: with the adjoint form of [`GradientOperator`]
/// forces are `-sum_b P_b (V_b G_ba)`, gradients `1/V_a sum_b (f_b - f_a) (x) (V_a G_ab)`, and the
/// antisymmetric area between two particles is `C_ab = V_a G_ab - V_b G_ba`.
///
/// The last block of a row is filled up with its last neighbour and areas of zero, so that loops
/// over lanes have a fixed length and need no condition: whatever is multiplied with an area
/// vanishes there, and what is divided by is the distance to a real neighbour.
#[derive(Clone, Debug)]
pub struct PairAreas<const D: usize> {
    blocks: Vec<Block<D>>,
    rows: Vec<Row>,
    /// `V_a G_aa` of each particle in m^(D-1).
    diagonal: Vec<[f64; D]>,
}

impl<const D: usize> PairAreas<D> {
    /// The areas of an operator on `list` for the volumes V in m^D.
    pub fn new(operator: &GradientOperator<D>, list: &NeighborList, volume: &[f64]) -> Self {
        let rows = || (0..list.len()).map(|a| list.range(a));
        let count = rows().map(|row| row.len().div_ceil(LANES)).sum();
        let mut blocks = Vec::with_capacity(count);
        let mut ranges = Vec::with_capacity(list.len());
        for (a, row) in rows().enumerate() {
            ranges.push(Row { first: blocks.len() as u32, count: row.len() as u32 });
            let neighbors = list.row(a).chunks(LANES);
            let forward = operator.forward(row.clone()).chunks(LANES);
            let adjoint = operator.adjoint(row).chunks(LANES);
            blocks.extend(neighbors.zip(forward.zip(adjoint)).map(
                |(neighbors, (forward, adjoint))| block(a, neighbors, [forward, adjoint], volume),
            ));
        }
        let diagonal = volume.iter().enumerate().map(|(a, v)| (operator.diagonal(a) * *v).into());
        Self { blocks, rows: ranges, diagonal: diagonal.collect() }
    }

    /// `V_a G_aa` in m^(D-1).
    #[inline]
    pub fn diagonal(&self, a: usize) -> Vector<D> {
        Vector::from(self.diagonal[a])
    }

    /// Bytes of all areas, which a pass over pairs reads.
    pub fn memory(&self) -> usize {
        size_of_val(self.blocks.as_slice())
            + size_of_val(self.rows.as_slice())
            + size_of_val(self.diagonal.as_slice())
    }
}

impl<const D: usize> Pairs for PairAreas<D> {
    type Pair = FrozenPair<D>;
    type Row<'a> = Row;
    type Block = Row;

    #[inline(always)]
    fn row(&self, a: usize, among: Among) -> Row {
        match among {
            Among::Passive => Row::default(),
            _ => self.rows[a],
        }
    }

    /// A row is all that there is, and nothing has to be found of it.
    #[inline(always)]
    fn next(&self, row: &mut Row, _needs: Needs, block: &mut Row) -> usize {
        *block = std::mem::take(row);
        block.count as usize
    }

    #[inline(always)]
    fn four(&self, block: &Row, first: usize) -> ([u32; WIDTH], Frozen<Lanes4, D>) {
        let eight = &self.blocks[block.first as usize + first / LANES];
        let half = first / WIDTH % (LANES / WIDTH);
        let of = |numbers: &Lanes| Lanes4::load(numbers.as_chunks().0[half]);
        let mut pair = FrozenPair::zero::<Lanes4>();
        for i in 0..D {
            pair.area[i] = of(&eight.forward[i]);
            pair.transposed[i] = of(&eight.adjoint[i]);
        }
        let left = (block.count as usize).saturating_sub(first).min(WIDTH);
        pair.counts = Lanes4::load(COUNTS[left]);
        (eight.neighbors.as_chunks().0[half], pair)
    }

    #[inline(always)]
    fn one(&self, block: &Row, k: usize) -> (usize, Frozen<f64, D>) {
        let (eight, lane) = (&self.blocks[block.first as usize + k / LANES], k % LANES);
        let of = |lanes: &[Lanes; D]| Vector::from_fn(|i, _| lanes[i][lane]);
        let pair = Frozen { area: of(&eight.forward), transposed: of(&eight.adjoint), counts: 1.0 };
        (eight.neighbors[lane] as usize, pair)
    }
}

/// What counts of four lanes of which so many are left.
const COUNTS: [[f64; WIDTH]; WIDTH + 1] =
    [[0.0; WIDTH], [1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [1.0, 1.0, 1.0, 0.0], [1.0; WIDTH]];

/// The block of some neighbours of a, from their coefficients `G_ab` and `G_ba`.
fn block<const D: usize>(
    a: usize,
    neighbors: &[u32],
    [forward, adjoint]: [&[[f64; D]]; 2],
    volume: &[f64],
) -> Block<D> {
    let last = neighbors[neighbors.len() - 1];
    let mut block =
        Block { neighbors: [last; LANES], forward: [[0.0; LANES]; D], adjoint: [[0.0; LANES]; D] };
    block.neighbors[..neighbors.len()].copy_from_slice(neighbors);
    for (lane, &b) in neighbors.iter().enumerate() {
        for i in 0..D {
            block.forward[i][lane] = forward[lane][i] * volume[a];
            block.adjoint[i][lane] = adjoint[lane][i] * volume[b as usize];
        }
    }
    block
}
