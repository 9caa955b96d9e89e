//! Which components of the rows of a state are unknowns.

use crate::{Tensor, Vector};

/// What a local component of a row is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Local {
    /// An unknown, by number.
    Free(u32),
    /// Given from outside.
    Held,
}

/// Rows of `D` components as linear functions of fewer unknowns: `u_a = R_a q_a`, where the columns
/// of the orthonormal frame `R_a` are the directions of its local components, and each local
/// component is an unknown, shared with other rows or its own, or held.
#[derive(Clone, Debug)]
pub struct Reduction<const D: usize> {
    frames: Vec<Tensor<D>>,
    locals: Vec<[Local; D]>,
    /// First unknown of each group, and after the last one their number.
    starts: Vec<u32>,
    /// The rows of each group: those that hold its unknowns.
    members: Vec<Vec<u32>>,
}

impl<const D: usize> Reduction<D> {
    /// Numbers the free components of rows in the given order of rows. `held[a]` says which local
    /// components are held; each tie is a component with the rows that share it, which is free in
    /// all of them and along the same axis.
    pub fn new(
        frames: Vec<Tensor<D>>,
        held: &[[bool; D]],
        ties: &[(usize, Vec<u32>)],
        order: &[u32],
    ) -> Self {
        let mut locals = vec![[Local::Held; D]; frames.len()];
        let mut tied = vec![[false; D]; frames.len()];
        for (component, rows) in ties {
            rows.iter().for_each(|&a| tied[a as usize][*component] = true);
        }
        let (mut starts, mut members, mut next) = (vec![0], Vec::new(), 0);
        for &a in order {
            let row = a as usize;
            let first = next;
            for i in 0..D {
                if !held[row][i] && !tied[row][i] {
                    locals[row][i] = Local::Free(next);
                    next += 1;
                }
            }
            if next > first {
                starts.push(next);
                members.push(vec![a]);
            }
        }
        // Shared unknowns see many others and come last, where they fill least.
        for (component, rows) in ties {
            rows.iter().for_each(|&a| locals[a as usize][*component] = Local::Free(next));
            next += 1;
            starts.push(next);
            members.push(rows.clone());
        }
        Self { frames, locals, starts, members }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.frames.len()
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.starts.last().map_or(0, |&count| count as usize)
    }

    /// What the local components of a row are.
    pub fn locals(&self, a: usize) -> &[Local; D] {
        &self.locals[a]
    }

    /// The directions of the local components of a row, as columns.
    pub fn frame(&self, a: usize) -> &Tensor<D> {
        &self.frames[a]
    }

    /// Groups of unknowns that the same rows hold: first unknown, one past the last, and the rows.
    pub(super) fn groups(&self) -> impl Iterator<Item = (u32, u32, &[u32])> {
        let ends = self.starts.windows(2).map(|ends| (ends[0], ends[1]));
        ends.zip(&self.members).map(|((first, last), rows)| (first, last, rows.as_slice()))
    }

    /// Rows of unknowns, with held components from `held`, which is in local components.
    pub fn expand(&self, unknowns: &[f64], held: &[Vector<D>], rows: &mut [Vector<D>]) {
        for (a, row) in rows.iter_mut().enumerate() {
            let local = Vector::from_fn(|i, _| match self.locals[a][i] {
                Local::Free(number) => unknowns[number as usize],
                Local::Held => held[a][i],
            });
            *row = self.frames[a] * local;
        }
    }

    /// Rows of unknowns, with held components of zero.
    pub fn expand_free(&self, unknowns: &[f64], rows: &mut [Vector<D>]) {
        for (a, row) in rows.iter_mut().enumerate() {
            let local = Vector::from_fn(|i, _| match self.locals[a][i] {
                Local::Free(number) => unknowns[number as usize],
                Local::Held => 0.0,
            });
            *row = self.frames[a] * local;
        }
    }

    /// What forces on rows do on the unknowns: the transpose of [`Self::expand_free`].
    pub fn restrict(&self, rows: &[Vector<D>], unknowns: &mut [f64]) {
        unknowns.fill(0.0);
        for (a, row) in rows.iter().enumerate() {
            let local = self.frames[a].tr_mul(row);
            for i in 0..D {
                if let Local::Free(number) = self.locals[a][i] {
                    unknowns[number as usize] += local[i];
                }
            }
        }
    }

    /// The unknowns of rows that [`Self::expand`] made.
    pub fn collect(&self, rows: &[Vector<D>], unknowns: &mut [f64]) {
        for (a, row) in rows.iter().enumerate() {
            let local = self.frames[a].tr_mul(row);
            for i in 0..D {
                if let Local::Free(number) = self.locals[a][i] {
                    unknowns[number as usize] = local[i];
                }
            }
        }
    }

    /// The part of a row along held directions.
    pub fn held_part(&self, a: usize, row: &Vector<D>) -> Vector<D> {
        let mut local = self.frames[a].tr_mul(row);
        for i in 0..D {
            if self.locals[a][i] != Local::Held {
                local[i] = 0.0;
            }
        }
        self.frames[a] * local
    }
}
