//! Correction on a coarse space: the motions of a few parts as rigid bodies.
//!
//! A preconditioner that acts on single particles leaves what is long, which conjugate gradients
//! then need as many steps for as there are particles across the body. The energy of long
//! displacements is mostly that of parts that shift and turn against each other, so that their
//! motions P, with the tangent `P^T K P` that is factorised, take them away: the number of steps
//! depends on the size of a part only.

use super::linear::Tangent;
use super::{Factor, FactorError, Local, Reduction, SparseMatrix, dissect};
use crate::parallel::Team;
use crate::{Tensor, Vector, parallel};

/// Rows that a part has at least, in one, two and three dimensions.
const LEAST_ROWS: [usize; 3] = [16, 24, 48];
/// Parts that there are at most: a factorisation of their motions is quick.
const MOST_PARTS: [usize; 3] = [4000, 2500, 500];
/// What is added to the diagonal of the coarse tangent, as a share of it: motions of a part that is
/// held but for a few particles may depend on each other.
const SHIFT: f64 = 1e-10;

/// The coarse space of a reduction, and the tangent there.
#[derive(Clone)]
pub(super) struct Coarse<const D: usize> {
    /// Motions of a part: shifts and turns.
    modes: usize,
    /// Part of each unknown.
    part_of: Vec<u32>,
    /// What each motion of its part moves an unknown by.
    motion: Vec<f64>,
    /// What the motions of parts move each row by: one share for each part that it has unknowns in.
    shares: Vec<Vec<Share<D>>>,
    /// Rows that have an unknown in each part.
    rows: Vec<Vec<u32>>,
    /// Parts from each one on that share an entry with it, ascending; itself is the first.
    coupled: Vec<Vec<u32>>,
    matrix: SparseMatrix,
    factor: Factor,
    /// Whether the tangent is positive definite there, so that it can precondition.
    is_definite: bool,
}

/// The unknowns that a row has in a part.
#[derive(Clone)]
struct Share<const D: usize> {
    part: u32,
    /// What each motion of the part moves the row by.
    moved: Vec<Vector<D>>,
}

impl<const D: usize> Coarse<D> {
    /// Parts of equal numbers of rows at `points`, `coupled` as in a [`Tangent`]; `None` where there
    /// are too few rows for it to help.
    ///
    /// # Errors
    /// [`FactorError::Memory`].
    pub fn new(
        points: &[Vector<D>],
        reduction: &Reduction<D>,
        coupled: &[Vec<u32>],
    ) -> Result<Option<Self>, FactorError> {
        let count = (points.len() / LEAST_ROWS[D - 1]).min(MOST_PARTS[D - 1]);
        if count < 2 {
            return Ok(None);
        }
        let parts = ordered(points, split(points, count), coupled);
        let modes = D * (D + 1) / 2;
        let mut part_of = vec![u32::MAX; reduction.unknowns()];
        let mut motion = vec![0.0; reduction.unknowns() * modes];
        for (number, part) in parts.iter().enumerate() {
            let center = part.iter().map(|&a| points[a as usize]).sum::<Vector<D>>();
            let center = center / part.len() as f64;
            let reach = |&a: &u32| (points[a as usize] - center).norm();
            let size = part.iter().map(reach).fold(f64::MIN_POSITIVE, f64::max);
            for &a in part {
                let a = a as usize;
                let moved = motions(&((points[a] - center) / size));
                for (i, local) in reduction.locals(a).iter().enumerate() {
                    let &Local::Free(k) = local else { continue };
                    let k = k as usize;
                    // An unknown that rows share moves with the first of them.
                    if part_of[k] != u32::MAX {
                        continue;
                    }
                    part_of[k] = number as u32;
                    let axis = reduction.frame(a).column(i);
                    for (entry, moved) in motion[k * modes..].iter_mut().zip(&moved) {
                        *entry = axis.dot(moved);
                    }
                }
            }
        }
        let shares: Vec<Vec<Share<D>>> = (0..points.len())
            .map(|a| shares_of(reduction, a, &part_of, |k| &motion[k * modes..][..modes]))
            .collect();
        let mut rows = vec![Vec::new(); parts.len()];
        let mut seen: Vec<Vec<u32>> = vec![Vec::new(); parts.len()];
        for (a, coupled) in coupled.iter().enumerate() {
            for Share { part, .. } in &shares[a] {
                rows[*part as usize].push(a as u32);
                let others = coupled.iter().flat_map(|&b| &shares[b as usize]);
                let seen = &mut seen[*part as usize];
                seen.extend(others.map(|other| other.part).filter(|other| other >= part));
                // As many as there are neighbours of neighbours: thinned out row by row.
                seen.sort_unstable();
                seen.dedup();
            }
        }
        // A part without unknowns keeps its place, with itself alone.
        for (number, all) in seen.iter_mut().enumerate() {
            if all.is_empty() {
                all.push(number as u32);
            }
        }
        let column = |part: usize, mode: usize| {
            let entries = |&other: &u32| {
                let first = if other as usize == part { mode } else { 0 };
                (first..modes).map(move |other_mode| other as usize * modes + other_mode)
            };
            seen[part].iter().flat_map(entries).collect::<Vec<usize>>()
        };
        let columns = (0..parts.len()).flat_map(|part| (0..modes).map(move |mode| (part, mode)));
        let matrix = SparseMatrix::of_columns(columns.map(|(part, mode)| column(part, mode)));
        let factor = Factor::new(&matrix)?;
        let coupled = seen;
        let is_definite = false;
        Ok(Some(Self {
            modes,
            part_of,
            motion,
            shares,
            rows,
            coupled,
            matrix,
            factor,
            is_definite,
        }))
    }

    /// The matrix with its factors.
    pub fn parts(&self) -> (&SparseMatrix, &Factor) {
        (&self.matrix, &self.factor)
    }

    /// Gathers the values of a tangent, of which each of a team makes those of some parts.
    pub fn assemble<T: Tangent<D>>(&mut self, tangent: &T, team: &Team) {
        let own = team.even_share(self.rows.len());
        let mut columns: Vec<Vec<f64>> = vec![Vec::new(); own.len()];
        let this = &*self;
        parallel::for_each_item(&mut columns, |k, values| {
            *values = this.gather(own.start + k, tangent);
        });
        let values = team.rows_of_all(columns.concat());
        // Where a rank is lost, so is what they compute.
        if team.fault().is_none() {
            self.matrix.set_values(values);
            self.matrix.regularise(SHIFT);
        }
    }

    /// Factorises the tangent that was assembled, and returns how many directions of negative
    /// curvature it has here.
    ///
    /// # Errors
    /// [`FactorError::Singular`].
    pub fn factorise(&mut self) -> Result<usize, FactorError> {
        let negative = self.factor.factorise(&self.matrix)?;
        self.is_definite = negative == 0;
        Ok(negative)
    }

    /// The entries of the columns of one part.
    fn gather<T: Tangent<D>>(&self, part: usize, tangent: &T) -> Vec<f64> {
        let (modes, others) = (self.modes, &self.coupled[part]);
        // By mode of this part, then by part and mode of the others.
        let stride = others.len() * modes;
        let mut blocks = vec![0.0; modes * stride];
        // What one row resists with when the others move.
        let mut forces = vec![Vector::<D>::zeros(); stride];
        for &a in &self.rows[part] {
            forces.fill(Vector::zeros());
            tangent.add_row(a as usize, &mut |b: u32, block: &Tensor<D>| {
                for share in &self.shares[b as usize] {
                    let Ok(at) = others.binary_search(&share.part) else { continue };
                    let forces = forces[at * modes..].iter_mut();
                    forces.zip(&share.moved).for_each(|(force, moved)| *force += block * moved);
                }
            });
            let own = self.shares[a as usize].iter().filter(|own| own.part as usize == part);
            for (mode, moved) in own.flat_map(|own| own.moved.iter().enumerate()) {
                let sums = blocks[mode * stride..][..stride].iter_mut();
                sums.zip(&forces).for_each(|(sum, force)| *sum += moved.dot(force));
            }
        }
        // The lower triangle: of its own block a column begins on the diagonal.
        let column = |mode: usize| blocks[mode * stride + mode..(mode + 1) * stride].iter();
        (0..modes).flat_map(column).copied().collect()
    }

    /// Adds the correction of a residual to `scaled`, where there is one.
    pub fn add(&mut self, residual: &[f64], scaled: &mut [f64]) {
        if !self.is_definite {
            return;
        }
        let modes = self.modes;
        let mut coarse = vec![0.0; self.matrix.len()];
        let unknowns = self.part_of.iter().zip(self.motion.chunks_exact(modes));
        for ((&part, motion), residual) in unknowns.zip(residual) {
            let sums = coarse[part as usize * modes..].iter_mut();
            sums.zip(motion).for_each(|(sum, moved)| *sum += moved * residual);
        }
        self.factor.solve(&mut coarse);
        let unknowns = self.part_of.iter().zip(self.motion.chunks_exact(modes));
        for ((&part, motion), scaled) in unknowns.zip(scaled) {
            let found = coarse[part as usize * modes..].iter();
            *scaled += found.zip(motion).map(|(found, moved)| found * moved).sum::<f64>();
        }
    }
}

/// The shares of a row, of whose unknowns the part and what its motions move them by are known.
fn shares_of<'a, const D: usize>(
    reduction: &Reduction<D>,
    a: usize,
    part_of: &[u32],
    motion: impl Fn(usize) -> &'a [f64],
) -> Vec<Share<D>> {
    let mut shares: Vec<Share<D>> = Vec::new();
    for (i, local) in reduction.locals(a).iter().enumerate() {
        let &Local::Free(k) = local else { continue };
        let axis = reduction.frame(a).column(i);
        let motion = motion(k as usize);
        let part = part_of[k as usize];
        let found = shares.iter().position(|share| share.part == part);
        let at = found.unwrap_or_else(|| {
            shares.push(Share { part, moved: vec![Vector::zeros(); motion.len()] });
            shares.len() - 1
        });
        let all = shares[at].moved.iter_mut().zip(motion);
        all.for_each(|(sum, moved)| *sum += axis * *moved);
    }
    shares
}

/// Displacements of a place in the rigid motions of a body: shifts, then turns.
fn motions<const D: usize>(place: &Vector<D>) -> Vec<Vector<D>> {
    let unit = |axis: usize| Vector::from_fn(|i, _| f64::from(u8::from(i == axis)));
    let mut all: Vec<Vector<D>> = (0..D).map(unit).collect();
    for first in 0..D {
        for second in first + 1..D {
            let mut turn = Vector::zeros();
            (turn[first], turn[second]) = (-place[second], place[first]);
            all.push(turn);
        }
    }
    all
}

/// Points in `count` parts of nearly equal numbers, cut across their longest extents.
fn split<const D: usize>(points: &[Vector<D>], count: usize) -> Vec<Vec<u32>> {
    let mut parts = Vec::with_capacity(count);
    let mut left = vec![((0..points.len() as u32).collect::<Vec<u32>>(), count)];
    while let Some((mut part, count)) = left.pop() {
        if count < 2 {
            parts.push(part);
            continue;
        }
        let extent = |axis: usize| {
            let along = part.iter().map(|&a| points[a as usize][axis]);
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            let (low, high) = along.fold(ends, |(low, high), x| (low.min(x), high.max(x)));
            high - low
        };
        let longest = |best, axis| if extent(axis) > extent(best) { axis } else { best };
        let axis = (1..D).fold(0, longest);
        part.sort_by(|a, b| {
            let (x, y) = (points[*a as usize][axis], points[*b as usize][axis]);
            x.total_cmp(&y).then(a.cmp(b))
        });
        let near = count / 2;
        let far = part.split_off(part.len() * near / count);
        left.push((far, count - near));
        left.push((part, near));
    }
    parts
}

/// Parts in an order in which their tangent fills little.
fn ordered<const D: usize>(
    points: &[Vector<D>],
    parts: Vec<Vec<u32>>,
    coupled: &[Vec<u32>],
) -> Vec<Vec<u32>> {
    let mut part_of = vec![0_u32; points.len()];
    for (number, part) in parts.iter().enumerate() {
        part.iter().for_each(|&a| part_of[a as usize] = number as u32);
    }
    let touching = |part: &Vec<u32>| {
        let others = part.iter().flat_map(|&a| &coupled[a as usize]);
        let mut all: Vec<u32> = others.map(|&b| part_of[b as usize]).collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    let touching: Vec<Vec<u32>> = parts.iter().map(touching).collect();
    let center = |part: &Vec<u32>| {
        part.iter().map(|&a| points[a as usize]).sum::<Vector<D>>() / part.len() as f64
    };
    let centers: Vec<Vector<D>> = parts.iter().map(center).collect();
    let order = dissect(&centers, &touching);
    let mut parts: Vec<Option<Vec<u32>>> = parts.into_iter().map(Some).collect();
    order.iter().filter_map(|&number| parts[number as usize].take()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::conjugate_gradients;
    use super::super::jacobi::BlockJacobi;
    use super::*;

    /// Points of a square grid joined by springs that resist turning too, with the lowest row held.
    struct Grid {
        side: usize,
    }

    impl Grid {
        fn points(&self) -> Vec<Vector<2>> {
            let place = |a| Vector::from([(a % self.side) as f64, (a / self.side) as f64]);
            (0..self.side * self.side).map(place).collect()
        }

        /// Held below, and with a component that the points of the upper row share.
        fn reduction(&self) -> Reduction<2> {
            let count = self.side * self.side;
            let held: Vec<[bool; 2]> = (0..count).map(|a| [a < self.side; 2]).collect();
            let upper = (count - self.side..count).map(|a| a as u32).collect();
            let order: Vec<u32> = (0..count as u32).collect();
            Reduction::new(vec![Tensor::identity(); count], &held, &[(1, upper)], &order)
        }

        fn neighbors(&self, a: usize) -> Vec<usize> {
            let (x, y) = (a % self.side, a / self.side);
            let inside = |&(x, y): &(usize, usize)| x < self.side && y < self.side;
            [(x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)]
                .iter()
                .filter(|place| inside(place))
                .map(|(x, y)| x + y * self.side)
                .collect()
        }

        fn spring(a: usize, b: usize) -> Tensor<2> {
            let along = if a.abs_diff(b) == 1 { [1.0, 0.3] } else { [0.3, 1.0] };
            Tensor::from_diagonal(&Vector::from(along))
        }
    }

    impl Tangent<2> for Grid {
        fn coupled(&self, a: usize) -> Vec<u32> {
            let mut all: Vec<u32> = self.neighbors(a).iter().map(|&b| b as u32).collect();
            all.push(a as u32);
            all.sort_unstable();
            all
        }

        fn add_row(&self, a: usize, add: &mut dyn FnMut(u32, &Tensor<2>)) {
            for b in self.neighbors(a) {
                add(b as u32, &-Self::spring(a, b));
                add(a as u32, &Self::spring(a, b));
            }
        }

        fn apply(&mut self, direction: &[Vector<2>], product: &mut [Vector<2>]) {
            for (a, product) in product.iter_mut().enumerate() {
                let others = self.neighbors(a).into_iter();
                let forces = others.map(|b| Self::spring(a, b) * (direction[a] - direction[b]));
                *product = forces.sum();
            }
        }

        fn diagonal(&self) -> Vec<Tensor<2>> {
            let of = |a| self.neighbors(a).into_iter().map(|b| Self::spring(a, b)).sum();
            (0..self.side * self.side).map(of).collect()
        }

        fn is_symmetric(&self) -> bool {
            true
        }
    }

    fn coarse(grid: &Grid, reduction: &Reduction<2>) -> Coarse<2> {
        let coupled: Vec<Vec<u32>> = (0..reduction.rows()).map(|a| grid.coupled(a)).collect();
        let made = Coarse::new(&grid.points(), reduction, &coupled).expect("memory");
        let mut coarse = made.expect("there are parts");
        coarse.assemble(grid, &Team::default());
        coarse
    }

    fn product(grid: &mut Grid, reduction: &Reduction<2>, x: &[f64], into: &mut [f64]) {
        let mut rows = vec![Vector::zeros(); reduction.rows()];
        let mut image = rows.clone();
        reduction.expand_free(x, &mut rows);
        grid.apply(&rows, &mut image);
        reduction.restrict(&image, into);
    }

    /// Each column is what the tangent makes of a motion, seen by all motions.
    #[test]
    fn the_coarse_tangent_is_that_of_the_motions() {
        let mut grid = Grid { side: 14 };
        let reduction = grid.reduction();
        let coarse = coarse(&grid, &reduction);
        let unknowns = reduction.unknowns();
        let motion = |column: usize| -> Vec<f64> {
            let (part, mode) = (column / coarse.modes, column % coarse.modes);
            let own = |k: usize| coarse.part_of[k] as usize == part;
            (0..unknowns)
                .map(|k| if own(k) { coarse.motion[k * coarse.modes + mode] } else { 0.0 })
                .collect()
        };
        let (mut image, mut found) = (vec![0.0; unknowns], vec![0.0; coarse.matrix.len()]);
        for column in 0..coarse.matrix.len() {
            let mut unit = vec![0.0; coarse.matrix.len()];
            unit[column] = 1.0;
            coarse.matrix.apply(&unit, &mut found);
            product(&mut grid, &reduction, &motion(column), &mut image);
            for (row, found) in found.iter().enumerate() {
                let expected: f64 = motion(row).iter().zip(&image).map(|(m, f)| m * f).sum();
                assert!((found - expected).abs() < 1e-8, "{row} {column}: {found} {expected}");
            }
        }
    }

    /// Without it, twice as many points across take twice as many steps.
    #[test]
    fn the_number_of_steps_does_not_grow_with_the_body() {
        let steps = |side: usize, corrects: bool| {
            let mut grid = Grid { side };
            let reduction = grid.reduction();
            let mut coarse = coarse(&grid, &reduction);
            assert_eq!(coarse.factorise().expect("regular"), 0);
            let jacobi = BlockJacobi::new(&reduction, &grid.diagonal());
            let right: Vec<f64> = (0..reduction.unknowns()).map(super::super::irregular).collect();
            let precondition = |residual: &[f64], scaled: &mut [f64]| {
                scaled.copy_from_slice(residual);
                jacobi.apply(&reduction, scaled);
                if corrects {
                    coarse.add(residual, scaled);
                }
            };
            let product = |x: &[f64], into: &mut [f64]| product(&mut grid, &reduction, x, into);
            conjugate_gradients(product, precondition, &right, 1e-8, 10_000).steps
        };
        let [plain, corrected] = [false, true].map(|it| [20, 40, 80].map(|side| steps(side, it)));
        assert!(plain[2] > 3 * plain[0], "{plain:?}");
        assert!(2 * corrected[2] < 3 * corrected[0], "{corrected:?}");
        assert!(4 * corrected[2] < plain[2], "{plain:?} {corrected:?}");
    }
}
