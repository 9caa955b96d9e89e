//! The areas through which particles act on each other, in blocks of neighbours.

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

/// The sum over the lanes, by halves: the same order on every machine.
#[inline(always)]
pub(crate) fn total(mut lanes: Lanes) -> f64 {
    let mut half = LANES / 2;
    while half > 0 {
        for lane in 0..half {
            lanes[lane] += lanes[lane + half];
        }
        half /= 2;
    }
    lanes[0]
}

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
    /// The blocks of particle a are `blocks[offsets[a]..offsets[a + 1]]`.
    offsets: Vec<usize>,
    /// `V_a G_aa` of each particle in m^(D-1).
    diagonal: Vec<[f64; D]>,
}

impl<const D: usize> PairAreas<D> {
    /// The areas of an operator on `list` for the volumes V in m^D.
    pub fn new(operator: &GradientOperator<D>, list: &NeighborList, volume: &[f64]) -> Self {
        let rows = || (0..list.len()).map(|a| list.range(a));
        let count = rows().map(|row| row.len().div_ceil(LANES)).sum();
        let mut blocks = Vec::with_capacity(count);
        let mut offsets = Vec::with_capacity(list.len() + 1);
        offsets.push(0);
        for (a, row) in rows().enumerate() {
            let neighbors = list.row(a).chunks(LANES);
            let forward = operator.forward(row.clone()).chunks(LANES);
            let adjoint = operator.adjoint(row).chunks(LANES);
            blocks.extend(neighbors.zip(forward.zip(adjoint)).map(
                |(neighbors, (forward, adjoint))| block(a, neighbors, [forward, adjoint], volume),
            ));
            offsets.push(blocks.len());
        }
        let diagonal = volume.iter().enumerate().map(|(a, v)| (operator.diagonal(a) * *v).into());
        Self { blocks, offsets, diagonal: diagonal.collect() }
    }

    /// The neighbours of particle a.
    #[inline]
    pub fn row(&self, a: usize) -> &[Block<D>] {
        &self.blocks[self.offsets[a]..self.offsets[a + 1]]
    }

    /// `V_a G_aa` in m^(D-1).
    #[inline]
    pub fn diagonal(&self, a: usize) -> Vector<D> {
        Vector::from(self.diagonal[a])
    }

    /// Bytes of all areas, which a pass over pairs reads.
    pub fn memory(&self) -> usize {
        size_of_val(self.blocks.as_slice())
            + size_of_val(self.offsets.as_slice())
            + size_of_val(self.diagonal.as_slice())
    }
}

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
