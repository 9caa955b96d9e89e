//! Splines on nested lattices, which take the long part of a residual away.

use nalgebra::DMatrix;

use super::System;
use super::unrolled::Unrolled;
use crate::{Vector, parallel};

/// Functions of the widest lattice, at most, whose equations are solved as a whole.
const MOST_FUNCTIONS: usize = 512;

/// What is added to the diagonal of those equations, as a share of it: linear functions are without energy.
const SHIFT: f64 = 1e-8;

/// Share of its functions that a lattice has at most when its edges are doubled. Thinner bodies, and many small
/// ones, gain nothing from wider lattices.
const MOST_KEPT: f64 = 0.75;

/// Entries of the form of energy in 3D: the second derivatives, and their trace.
const ENTRIES: usize = 7;

/// A preconditioner on functions that vary slowly: products of quadratic splines on lattices of edges H, 2 H, 4 H, ...,
/// each of which has all functions of the next. With the values C of the functions of a lattice at particles
/// it adds `C E^-1 C^T r`, with the energies of the functions for E, and on the widest lattice
/// with all their products of energy.
///
/// The energy of a multiplier m that varies slowly is that of its second derivatives Q: where supports are even
/// all round, the misfit of a linear function is `1/2 X . Q X`, and the sum of its squares
/// `k_a (2 Q : Q + (tr Q)^2)` with `k_a = sum_b V_a o_ab |X_ab|^4/(4 D (D + 2))`. A preconditioner may be this rough:
/// it changes the number of steps, and not what they lead to. Conjugate gradients on single particles take about as many
/// steps as the square of the number of particles across a body, with splines
/// some tens whatever that number is.
pub(super) struct Splines<const D: usize> {
    levels: Vec<Level<D>>,
    /// The inverse of the equations on the widest lattice.
    inverse: Option<DMatrix<f64>>,
}

/// The functions of one lattice.
struct Level<const D: usize> {
    /// What they are made of: values at particles, or shares of the functions of the lattice before.
    spread: Weights,
    /// The same by functions.
    gather: Weights,
    /// One over their energies, zero for those that have none.
    inverse: Vec<f64>,
    /// Scratch for each.
    values: Vec<Vector<D>>,
}

/// Rows of weights.
struct Weights {
    offsets: Vec<usize>,
    columns: Vec<u32>,
    weights: Vec<f64>,
}

impl Weights {
    fn row(&self, row: usize) -> impl Iterator<Item = (&u32, &f64)> {
        let range = self.offsets[row]..self.offsets[row + 1];
        self.columns[range.clone()].iter().zip(&self.weights[range])
    }

    /// Weights of which row k is the k-th item.
    fn of(rows: impl Iterator<Item = impl Iterator<Item = (u32, f64)>>) -> Self {
        let mut all = Self { offsets: vec![0], columns: Vec::new(), weights: Vec::new() };
        for row in rows {
            for (column, weight) in row {
                all.columns.push(column);
                all.weights.push(weight);
            }
            all.offsets.push(all.columns.len());
        }
        all
    }

    /// Rows and columns exchanged.
    fn transposed(&self, columns: usize) -> Self {
        let mut offsets = vec![0; columns + 1];
        self.columns.iter().for_each(|&column| offsets[column as usize + 1] += 1);
        (0..columns).for_each(|column| offsets[column + 1] += offsets[column]);
        let mut next = offsets.clone();
        let mut rows = vec![0; self.columns.len()];
        let mut weights = vec![0.0; self.columns.len()];
        for row in 0..self.offsets.len() - 1 {
            for (&column, &weight) in self.row(row) {
                let at = &mut next[column as usize];
                (rows[*at], weights[*at]) = (row as u32, weight);
                *at += 1;
            }
        }
        Self { offsets, columns: rows, weights }
    }

    /// Adds the weighted values of each row to `sums`.
    fn add<const D: usize>(&self, values: &[Vector<D>], sums: &mut [Vector<D>]) {
        parallel::for_each_chunk(sums, |first, sums| {
            for (offset, sum) in sums.iter_mut().enumerate() {
                for (&column, &weight) in self.row(first + offset) {
                    *sum += values[column as usize] * weight;
                }
            }
        });
    }
}

/// A function, or a cell, of the lattice of a part of the particles that hang together.
type Key<const D: usize> = (u32, [i32; D]);

/// Where a particle lies on a lattice.
#[derive(Clone, Copy)]
struct Place<const D: usize> {
    cell: Key<D>,
    /// Its place in the cell, from 0 to 1.
    at: [f64; D],
}

/// One of the nested lattices. Function i has the cells i - 2, i - 1 and i, along each axis.
struct Lattice<const D: usize> {
    edge: [f64; D],
    /// Cells along periodic axes, and zero along others.
    cells: [i32; D],
    places: Vec<Place<D>>,
    functions: Vec<Key<D>>,
    /// Functions of cells, in the order of [`digits`], and the cell of each particle.
    of_cells: Vec<u32>,
    cell_of: Vec<u32>,
}

impl<const D: usize> Lattice<D> {
    fn new(edge: [f64; D], cells: [i32; D], places: Vec<Place<D>>) -> Self {
        let mut all: Vec<Key<D>> = places.iter().map(|place| place.cell).collect();
        all.sort_unstable();
        all.dedup();
        let near = |&(part, cell): &Key<D>| {
            digits::<D>(3).map(move |digits| {
                let axis = |i: usize| wrap(cell[i] + digits[i] as i32, cells[i]);
                (part, std::array::from_fn(axis))
            })
        };
        let mut functions: Vec<Key<D>> = all.iter().flat_map(near).collect();
        functions.sort_unstable();
        functions.dedup();
        let of_cells = all.iter().flat_map(near).map(|key| number(&functions, &key)).collect();
        let cell_of = places.iter().map(|place| number(&all, &place.cell)).collect();
        Self { edge, cells, places, functions, of_cells, cell_of }
    }

    /// The lattice of doubled edges.
    fn wider(&self) -> Self {
        let place = |place: &Place<D>| {
            let (part, cell) = place.cell;
            let half = |i: usize| (place.at[i] + f64::from(cell[i].rem_euclid(2))) * 0.5;
            let at = std::array::from_fn(half);
            Place { cell: (part, cell.map(|cell| cell.div_euclid(2))), at }
        };
        let edge = self.edge.map(|edge| 2.0 * edge);
        let cells = self.cells.map(|cells| cells / 2);
        Self::new(edge, cells, self.places.iter().map(place).collect())
    }

    /// Functions that are not zero at a particle, in the order of [`digits`].
    fn near(&self, a: usize) -> &[u32] {
        let count = 3_usize.pow(D as u32);
        &self.of_cells[self.cell_of[a] as usize * count..][..count]
    }

    /// The functions at particles.
    fn at_particles(&self) -> Weights {
        Weights::of((0..self.places.len()).map(|a| {
            let values = self.places[a].at.map(|at| spline(at)[0]);
            let product = move |digits: [usize; D]| -> f64 {
                (0..D).map(|axis| values[axis][digits[axis]]).product()
            };
            self.near(a).iter().copied().zip(digits::<D>(3).map(product))
        }))
    }

    /// The functions of this lattice as sums of those of the one before, of half the edges: along each axis
    /// functions 2 J - 2 to 2 J + 1 have shares of 1/4, 3/4, 3/4 and 1/4 of function J.
    fn shares_in(&self, finer: &Self) -> Weights {
        Weights::of(finer.functions.iter().map(|&(part, function)| {
            digits::<D>(2).map(move |digits| {
                let mut weight = 1.0;
                let parent = std::array::from_fn(|i| {
                    let (half, odd) = (function[i].div_euclid(2), function[i].rem_euclid(2));
                    let is_upper = digits[i] as i32;
                    weight *= if odd == is_upper { 0.75 } else { 0.25 };
                    wrap(half + is_upper, self.cells[i])
                });
                (number(&self.functions, &(part, parent)), weight)
            })
        }))
    }

    /// The entries of each function near a particle whose products, times k, are those of energy.
    fn energies(&self, a: usize, entries: &mut Vec<[f64; ENTRIES]>) {
        let of_axes = self.places[a].at.map(spline);
        entries.clear();
        entries.extend(digits::<D>(3).map(|digits| {
            let derivative = |p: usize, q: usize| -> f64 {
                let factor = |axis: usize| {
                    let order = usize::from(axis == p) + usize::from(axis == q);
                    of_axes[axis][order][digits[axis]] / self.edge[axis].powi(order as i32)
                };
                (0..D).map(factor).product()
            };
            let (mut entries, mut next) = ([0.0; ENTRIES], 1);
            for p in 0..D {
                for q in p..D {
                    let second = derivative(p, q);
                    let twice = if p == q { std::f64::consts::SQRT_2 } else { 2.0 };
                    entries[next] = twice * second;
                    next += 1;
                    entries[0] += if p == q { second } else { 0.0 };
                }
            }
            entries
        }));
    }

    fn inverse_energies(&self, stiffness: &[f64]) -> Vec<f64> {
        let (mut energies, mut entries) = (vec![0.0; self.functions.len()], Vec::new());
        for (a, stiffness) in stiffness.iter().enumerate() {
            self.energies(a, &mut entries);
            for (&function, entries) in self.near(a).iter().zip(&entries) {
                energies[function as usize] += stiffness * product(entries, entries);
            }
        }
        energies.iter().map(|&energy| if energy > 0.0 { 1.0 / energy } else { 0.0 }).collect()
    }

    /// The inverse of all products of energy.
    fn inverse(&self, stiffness: &[f64]) -> Option<DMatrix<f64>> {
        let count = self.functions.len();
        let (mut matrix, mut entries) = (DMatrix::zeros(count, count), Vec::new());
        for (a, stiffness) in stiffness.iter().enumerate() {
            self.energies(a, &mut entries);
            for (&i, one) in self.near(a).iter().zip(&entries) {
                for (&j, other) in self.near(a).iter().zip(&entries) {
                    matrix[(i as usize, j as usize)] += stiffness * product(one, other);
                }
            }
        }
        for i in 0..count {
            let entry = &mut matrix[(i, i)];
            *entry = if *entry > 0.0 { *entry * (1.0 + SHIFT) } else { 1.0 };
        }
        Some(matrix.cholesky()?.inverse())
    }
}

impl<const D: usize> Splines<D> {
    /// Splines for the equations of some particles, on lattices of which the first has the mean radius of supports for
    /// its edge.
    pub fn new(system: &System<'_, D>) -> Self {
        let stiffness = system.fourth_moments();
        let mut lattice = first(system);
        let mut transfer = lattice.at_particles();
        let mut levels = Vec::new();
        loop {
            let count = lattice.functions.len();
            levels.push(Level {
                gather: transfer.transposed(count),
                spread: transfer,
                inverse: lattice.inverse_energies(&stiffness),
                values: vec![Vector::zeros(); count],
            });
            if count <= MOST_FUNCTIONS {
                return Self { levels, inverse: lattice.inverse(&stiffness) };
            }
            let wider = lattice.wider();
            if wider.functions.len() as f64 > MOST_KEPT * count as f64 {
                return Self { levels, inverse: None };
            }
            transfer = wider.shares_in(&lattice);
            lattice = wider;
        }
    }

    /// Adds what the splines make of a residual.
    pub fn add(&mut self, residual: &[Vector<D>], sum: &mut [Vector<D>]) {
        let mut finer = residual;
        for level in &mut self.levels {
            level.values.fill(Vector::zeros());
            level.gather.add(finer, &mut level.values);
            finer = &level.values;
        }
        let last = self.levels.len() - 1;
        for (number, level) in self.levels.iter_mut().enumerate() {
            match &self.inverse {
                Some(inverse) if number == last => {
                    let right = std::mem::take(&mut level.values);
                    let row = |i: usize| {
                        let entries = inverse.column(i);
                        let products =
                            right.iter().zip(&entries).map(|(right, entry)| right * *entry);
                        products.sum()
                    };
                    level.values = (0..right.len()).map(row).collect();
                }
                _ => {
                    let all = level.values.iter_mut().zip(&level.inverse);
                    all.for_each(|(value, inverse)| *value *= *inverse);
                }
            }
        }
        for number in (1..self.levels.len()).rev() {
            let (finer, wider) = self.levels.split_at_mut(number);
            wider[0].spread.add(&wider[0].values, &mut finer[number - 1].values);
        }
        self.levels[0].spread.add(&self.levels[0].values, sum);
    }
}

/// The first lattice. Along periodic axes, if bodies go on for ever there, the number of its cells can be
/// halved as often as along the others.
fn first<const D: usize>(system: &System<'_, D>) -> Lattice<D> {
    let Unrolled { places: positions, part_of, endless } = &system.unrolled;
    let domain = &system.support.domain;
    let count = positions.len().max(1) as f64;
    let width = system.support.radius.iter().sum::<f64>() / count;
    let crossed: [bool; D] = std::array::from_fn(|axis| endless.iter().any(|part| part[axis]));
    let inside = |x: &Vector<D>| {
        let wrapped = domain.wrap(x);
        Vector::from_fn(|axis, _| if crossed[axis] { wrapped[axis] } else { x[axis] })
    };
    let positions: Vec<Vector<D>> = positions.iter().map(inside).collect();
    let end = |axis: usize, start: f64, choose: fn(f64, f64) -> f64| {
        positions.iter().map(|x| x[axis]).fold(start, choose)
    };
    let low: [f64; D] = std::array::from_fn(|i| end(i, f64::INFINITY, f64::min));
    let high: [f64; D] = std::array::from_fn(|i| end(i, f64::NEG_INFINITY, f64::max));
    let (mut edge, mut cells, mut start) = ([width; D], [0; D], low);
    let longest = (0..D).map(|i| high[i] - low[i]).fold(width, f64::max);
    let halvings = (longest / width).log2().ceil() as i32;
    for (axis, bounds) in domain.periodic().iter().enumerate() {
        match bounds.filter(|_| crossed[axis]) {
            // Particles lie between the faces of cells.
            None => start[axis] -= 0.25 * width,
            Some([lower, upper]) => {
                let wanted = (upper - lower) / width;
                let halvings = halvings.min(wanted.log2() as i32).max(0);
                let widest = (wanted / f64::from(1 << halvings)).floor().max(1.0);
                cells[axis] = widest as i32 * (1 << halvings);
                edge[axis] = (upper - lower) / f64::from(cells[axis]);
                start[axis] = lower;
            }
        }
    }
    let place = |(x, &part): (&Vector<D>, &u32)| {
        let along: [f64; D] = std::array::from_fn(|i| (x[i] - start[i]) / edge[i]);
        let cell = std::array::from_fn(|i| wrap(along[i].floor() as i32, cells[i]));
        Place { cell: (part, cell), at: along.map(|along| along - along.floor()) }
    };
    let places = positions.iter().zip(part_of).map(place).collect();
    Lattice::new(edge, cells, places)
}

/// A number along an axis of which the period has this many cells, or zero.
fn wrap(number: i32, period: i32) -> i32 {
    if period == 0 { number } else { number.rem_euclid(period) }
}

/// The place of a key among sorted ones, which have it.
fn number<const D: usize>(keys: &[Key<D>], key: &Key<D>) -> u32 {
    keys.partition_point(|known| known < key) as u32
}

/// All numbers of D digits below `base`, the last digit first to change.
fn digits<const D: usize>(base: usize) -> impl Iterator<Item = [usize; D]> {
    (0..base.pow(D as u32)).map(move |mut rest| {
        let mut digits = [0; D];
        for digit in digits.iter_mut().rev() {
            (*digit, rest) = (rest % base, rest / base);
        }
        digits
    })
}

/// The three quadratic splines in a cell, and their first and second derivatives times the edge and its square.
fn spline(at: f64) -> [[f64; 3]; 3] {
    let (before, middle) = (1.0 - at, at - 0.5);
    [
        [0.5 * before * before, 0.75 - middle * middle, 0.5 * at * at],
        [-before, -2.0 * middle, at],
        [1.0, -2.0, 1.0],
    ]
}

fn product(one: &[f64; ENTRIES], other: &[f64; ENTRIES]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(cells: [i32; 2]) -> Lattice<2> {
        let place = |k: usize| {
            let along = [0.37 * (k % 8) as f64 + 0.1, 0.61 * (k / 8) as f64 + 0.2];
            let cell = std::array::from_fn(|i| wrap(along[i].floor() as i32 - 1, cells[i]));
            Place { cell: (0, cell), at: along.map(|along| along - along.floor()) }
        };
        Lattice::new([0.5, 0.25], cells, (0..64).map(place).collect())
    }

    /// Functions of wider lattices, from those of finer ones, are what they are at particles.
    #[test]
    fn lattices_are_nested() {
        for cells in [[0; 2], [4, 0], [4, 6]] {
            let finer = lattice(cells);
            let wider = finer.wider();
            let values: Vec<Vector<2>> = (0..wider.functions.len())
                .map(|k| Vector::from([(k as f64).sin(), (3.0 * k as f64).cos()]))
                .collect();
            let mut direct = vec![Vector::zeros(); 64];
            wider.at_particles().add(&values, &mut direct);
            let mut between = vec![Vector::zeros(); finer.functions.len()];
            wider.shares_in(&finer).add(&values, &mut between);
            let mut nested = vec![Vector::zeros(); 64];
            finer.at_particles().add(&between, &mut nested);
            for (direct, nested) in direct.iter().zip(&nested) {
                assert!((direct - nested).amax() < 1e-14, "{direct} and {nested}");
            }
        }
    }

    /// The functions have the sum one, and linear functions no energy.
    #[test]
    fn linear_functions_have_no_energy() {
        let lattice = lattice([0; 2]);
        let (weights, mut entries) = (lattice.at_particles(), Vec::new());
        for a in 0..64 {
            let sum: f64 = weights.row(a).map(|(_, weight)| weight).sum();
            assert!((sum - 1.0).abs() < 1e-15, "{sum}");
            lattice.energies(a, &mut entries);
            let linear = |&function: &u32| {
                let (_, key) = lattice.functions[function as usize];
                2.0 + 3.0 * f64::from(key[0]) - f64::from(key[1])
            };
            for entry in 0..ENTRIES {
                let all = lattice.near(a).iter().zip(&entries);
                let sum: f64 = all.map(|(k, entries)| linear(k) * entries[entry]).sum();
                assert!(sum.abs() < 1e-12, "{sum}");
            }
        }
    }

    #[test]
    fn exchanged_twice_weights_are_as_before() {
        let lattice = lattice([0, 6]);
        let weights = lattice.at_particles();
        let again = weights.transposed(lattice.functions.len()).transposed(64);
        assert_eq!(weights.offsets, again.offsets);
        for a in 0..64 {
            let sorted = |weights: &Weights| {
                let mut row: Vec<(u32, u64)> =
                    weights.row(a).map(|(&k, w)| (k, w.to_bits())).collect();
                row.sort_unstable();
                row
            };
            assert_eq!(sorted(&weights), sorted(&again));
        }
    }
}
