//! SPH matrices of a body and its mirror images, on the unknowns of the body alone.

use super::error::OperatorError;
use super::images::Image;
use super::sparse::SparseOperator;
use super::stencil::{Cover, GradientForm, Stencil, stencils};
use crate::{Tensor, Vector, parallel};

/// What the lower and the upper plane of each axis prescribe for the component along it.
pub type PlaneData<const D: usize> = [[f64; 2]; D];

/// The gradient of a vector field on a body whose images continue the field beyond planes, theory
/// (59): `du_i/dx_j = sum_q X_pq^(i,j) u_q,i + sum_k x_p^(k,j) d_k`, with the columns of images added to
/// those of the particles that they mirror. So there are no ghosts in a product, and its transpose is
/// the adjoint of all of it.
///
/// Components of a field are continued differently, and so have matrices of their own; without images
/// all share one set.
#[derive(Clone, Debug)]
pub struct FoldedGradient<const D: usize> {
    pub(super) forward: Block<D>,
    adjoint: Block<D>,
    /// Which values belong to a component.
    class: [usize; D],
    sources: Vec<Source<D>>,
    shape: Vec<Tensor<D>>,
}

/// One pattern with the values of each class of components.
#[derive(Clone, Debug)]
pub(super) struct Block<const D: usize> {
    offsets: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<Vec<[f64; D]>>,
}

/// What the datum of a plane adds to the derivatives of the component along its axis.
#[derive(Clone, Debug)]
struct Source<const D: usize> {
    axis: usize,
    side: usize,
    coefficients: Vec<[f64; D]>,
}

impl<const D: usize> FoldedGradient<D> {
    /// The matrices of a cover.
    ///
    /// # Errors
    /// As [`SphMatrices::new`](super::SphMatrices::new).
    pub fn new(cover: &Cover<'_, D>, form: GradientForm) -> Result<Self, OperatorError> {
        Ok(Self::fold(cover, &stencils(cover, form)?))
    }

    /// The matrices, and with coefficients c in J the hourglass matrices of the same sums.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_hourglass(
        cover: &Cover<'_, D>,
        form: GradientForm,
        coefficients: &[f64],
    ) -> Result<(Self, FoldedHourglass<D>), OperatorError> {
        let stencils = stencils(cover, form)?;
        let hourglass = FoldedHourglass::fold(cover.images, &stencils, coefficients);
        Ok((Self::fold(cover, &stencils), hourglass))
    }

    fn fold(cover: &Cover<'_, D>, stencils: &[Stencil<D>]) -> Self {
        let (count, images) = (stencils.len(), cover.images);
        let class = if images.is_empty() { [0; D] } else { std::array::from_fn(|i| i) };
        let classes = class[D - 1] + 1;
        let mut forward = Block::new(classes);
        let mut sources: Vec<Source<D>> = planes(images)
            .into_iter()
            .map(|(axis, side)| Source { axis, side, coefficients: vec![[0.0; D]; count] })
            .collect();
        let mut row: Vec<(u32, Tensor<D>)> = Vec::new();
        // The coefficients of component i stand in row i.
        let signed =
            |sign: &[f64; D], gradient: &Vector<D>| Tensor::from_fn(|i, j| sign[i] * gradient[j]);
        for (a, stencil) in stencils.iter().enumerate() {
            row.clear();
            row.push((a as u32, signed(&[1.0; D], &stencil.diagonal)));
            for entry in &stencil.entries {
                match entry.neighbor.checked_sub(count) {
                    None => {
                        row.push((entry.neighbor as u32, signed(&[1.0; D], &entry.gradient)));
                    }
                    Some(number) => {
                        let image = &images[number];
                        row.push((image.source, signed(&image.sign, &entry.gradient)));
                        for source in &mut sources {
                            let share = image.data[source.axis][source.side];
                            for j in 0..D {
                                source.coefficients[a][j] += share * entry.gradient[j];
                            }
                        }
                    }
                }
            }
            forward.push(&mut row);
        }
        let adjoint = forward.transposed();
        let shape = stencils.iter().map(|stencil| stencil.shape).collect();
        Self { forward, adjoint, class, sources, shape }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.shape.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.shape.is_empty()
    }

    /// The matrices of particles that are continued by ghosts, each of which is particles and data with
    /// coefficients: the datum d is column `count + d`, where a field must be known as a function.
    pub(super) fn of_rows(forward: Block<D>, shape: Vec<Tensor<D>>) -> Self {
        // Nothing takes its adjoint.
        let adjoint = Block::new(0);
        Self { forward, adjoint, class: std::array::from_fn(|i| i), sources: Vec::new(), shape }
    }

    /// The particles that have a part in the gradient of particle `a`, itself among them.
    pub fn row(&self, a: usize) -> &[u32] {
        let row = &self.forward.columns[self.forward.offsets[a]..self.forward.offsets[a + 1]];
        &row[..row.partition_point(|&column| (column as usize) < self.len())]
    }

    /// `L_a/tr L_a` of theory (44), which the hourglass force needs.
    pub fn shape(&self, a: usize) -> &Tensor<D> {
        &self.shape[a]
    }

    /// The matrix that takes the derivative of a component along an axis.
    pub fn matrix(&self, component: usize, axis: usize) -> SparseOperator {
        let (block, class) = (&self.forward, self.class[component]);
        let rows = (0..self.len()).map(|a| {
            let range = block.offsets[a]..block.offsets[a + 1];
            let values = block.values[class][range.clone()].iter().map(move |value| value[axis]);
            block.columns[range].iter().copied().zip(values)
        });
        SparseOperator::from_rows(rows, self.len())
    }

    /// The gradient `du_i/dx_j` of a field at particle `a`.
    #[inline]
    pub fn gradient_at(&self, field: &[Vector<D>], data: &PlaneData<D>, a: usize) -> Tensor<D> {
        self.gradient_of(|b| field[b], data, a)
    }

    /// The gradient at particle `a` of a field that is known as a function of the particle.
    #[inline]
    pub fn gradient_of(
        &self,
        field: impl Fn(usize) -> Vector<D>,
        data: &PlaneData<D>,
        a: usize,
    ) -> Tensor<D> {
        let mut gradient = self.forward.gather(&self.class, a, field);
        for source in &self.sources {
            let datum = data[source.axis][source.side];
            for j in 0..D {
                gradient[(source.axis, j)] += source.coefficients[a][j] * datum;
            }
        }
        gradient
    }

    /// The divergence `sum_j dT_ij/dx_j` at particle `a` of a tensor field that is known as a function
    /// of the particle.
    #[inline]
    pub fn divergence_of(&self, field: impl Fn(usize) -> Tensor<D>, a: usize) -> Vector<D> {
        let block = &self.forward;
        let mut sum = Vector::zeros();
        for entry in block.offsets[a]..block.offsets[a + 1] {
            let own = field(block.columns[entry] as usize);
            for i in 0..D {
                let values = &block.values[self.class[i]][entry];
                for j in 0..D {
                    sum[i] += values[j] * own[(i, j)];
                }
            }
        }
        sum
    }

    /// The part of data in the gradient at particle `a`, whose numbers are counted from 0.
    #[inline]
    pub fn gradient_of_data(&self, datum: impl Fn(usize) -> Vector<D>, a: usize) -> Tensor<D> {
        let count = self.len();
        let of = |q: usize| q.checked_sub(count).map_or_else(Vector::zeros, &datum);
        self.forward.gather(&self.class, a, of)
    }

    /// The gradient of a field at all particles: the first product of a step.
    pub fn gradient(&self, field: &[Vector<D>], data: &PlaneData<D>, result: &mut [Tensor<D>]) {
        parallel::for_each_chunk(result, |first, result| {
            for (offset, gradient) in result.iter_mut().enumerate() {
                *gradient = self.gradient_at(field, data, first + offset);
            }
        });
    }

    /// `f_q,i = -sum_p sum_j X_pq^(i,j) T_p,ij`: the second product of a step. The forces in N of
    /// tensions T in J, stresses times volumes, whose power is `-T : grad v` for the velocities of a
    /// body and no others.
    pub fn forces(&self, tension: &[Tensor<D>], result: &mut [Vector<D>]) {
        parallel::for_each_chunk(result, |first, result| {
            for (offset, force) in result.iter_mut().enumerate() {
                *force = self.force_at(tension, first + offset);
            }
        });
    }

    #[inline]
    fn force_at(&self, tension: &[Tensor<D>], a: usize) -> Vector<D> {
        let block = &self.adjoint;
        let mut force = Vector::zeros();
        for entry in block.offsets[a]..block.offsets[a + 1] {
            let tension = &tension[block.columns[entry] as usize];
            for i in 0..D {
                let values = &block.values[self.class[i]][entry];
                for j in 0..D {
                    force[i] -= values[j] * tension[(i, j)];
                }
            }
        }
        force
    }

    /// The power in W of tensions on what planes do to the gradients: `T : grad u` of the sources
    /// alone, with the rates of the data.
    pub fn source_power(&self, tension: &[Tensor<D>], rates: &PlaneData<D>) -> f64 {
        let of = |source: &Source<D>| {
            let rate = rates[source.axis][source.side];
            let term = |a: usize| {
                let row = &source.coefficients[a];
                (0..D).map(|j| tension[a][(source.axis, j)] * row[j]).sum::<f64>()
            };
            rate * parallel::sum(self.len(), term)
        };
        self.sources.iter().map(of).sum()
    }

    /// Bytes of all coefficients.
    pub fn memory(&self) -> usize {
        let sources: usize =
            self.sources.iter().map(|source| size_of_val(source.coefficients.as_slice())).sum();
        self.forward.memory() + self.adjoint.memory() + sources + size_of_val(self.shape.as_slice())
    }
}

impl<const D: usize> Block<D> {
    pub(super) fn new(classes: usize) -> Self {
        Self { offsets: vec![0], columns: Vec::new(), values: vec![Vec::new(); classes] }
    }

    /// Appends a row of columns with the coefficients of component i in row i, which it sorts.
    pub(super) fn push(&mut self, row: &mut [(u32, Tensor<D>)]) {
        // Stable, so that sums are taken in one order.
        row.sort_by_key(|(column, _)| *column);
        let first = self.columns.len();
        for (column, coefficients) in row {
            if self.columns.len() == first || self.columns.last() != Some(column) {
                self.columns.push(*column);
                self.values.iter_mut().for_each(|values| values.push([0.0; D]));
            }
            for (i, values) in self.values.iter_mut().enumerate() {
                if let Some(sum) = values.last_mut() {
                    (0..D).for_each(|j| sum[j] += coefficients[(i, j)]);
                }
            }
        }
        self.offsets.push(self.columns.len());
    }

    /// `sum_q value_q^(i)_j f_i(q)` of a row.
    #[inline]
    fn gather(&self, class: &[usize; D], a: usize, f: impl Fn(usize) -> Vector<D>) -> Tensor<D> {
        let mut sum = Tensor::zeros();
        for entry in self.offsets[a]..self.offsets[a + 1] {
            let own = f(self.columns[entry] as usize);
            for i in 0..D {
                let values = &self.values[class[i]][entry];
                for j in 0..D {
                    sum[(i, j)] += values[j] * own[i];
                }
            }
        }
        sum
    }

    fn transposed(&self) -> Self {
        let count = self.offsets.len() - 1;
        let mut offsets = vec![0; count + 1];
        self.columns.iter().for_each(|&column| offsets[column as usize + 1] += 1);
        for a in 0..count {
            offsets[a + 1] += offsets[a];
        }
        let mut next = offsets.clone();
        let mut columns = vec![0; self.columns.len()];
        let mut order = vec![0; self.columns.len()];
        for a in 0..count {
            for entry in self.offsets[a]..self.offsets[a + 1] {
                let place = &mut next[self.columns[entry] as usize];
                (columns[*place], order[*place]) = (a as u32, entry);
                *place += 1;
            }
        }
        let values = self.values.iter();
        let values = values.map(|values| order.iter().map(|&entry| values[entry]).collect());
        Self { offsets, columns, values: values.collect() }
    }

    fn memory(&self) -> usize {
        let values: usize = self.values.iter().map(|values| size_of_val(values.as_slice())).sum();
        size_of_val(self.offsets.as_slice()) + size_of_val(self.columns.as_slice()) + values
    }
}

/// The planes that some image depends on.
fn planes<const D: usize>(images: &[Image<D>]) -> Vec<(usize, usize)> {
    let all = (0..D).flat_map(|axis| [(axis, 0), (axis, 1)]);
    all.filter(|&(axis, side)| images.iter().any(|image| image.data[axis][side] != 0.0)).collect()
}

/// The part of the hourglass energy of theory (47) that is quadratic in differences of displacements,
///
/// ```text
/// E = sum_p c_p sum_q w_pq |u_q - u_p|^2 - sum_p c_p A_p : A_p L_p/tr L_p
/// ```
///
/// images counted as they are seen: its first sum is a matrix for each component. The second is a
/// stress, which goes through the gradient's own matrices, theory (60).
#[derive(Clone, Debug)]
pub struct FoldedHourglass<const D: usize> {
    /// `-d2E/du2` of the first sum in N/m, one a class of components.
    matrices: Vec<SparseOperator>,
    class: [usize; D],
    /// Axis and side of each plane, with what its datum adds to the forces, in N/m.
    sources: Vec<((usize, usize), Vec<f64>)>,
    /// `d2E/dd2` of pairs of these planes.
    constants: Vec<Vec<f64>>,
    coefficients: Vec<f64>,
}

impl<const D: usize> FoldedHourglass<D> {
    fn fold(images: &[Image<D>], stencils: &[Stencil<D>], coefficients: &[f64]) -> Self {
        let count = stencils.len();
        let class = if images.is_empty() { [0; D] } else { std::array::from_fn(|i| i) };
        let planes = planes(images);
        let mut sources: Vec<_> = planes.iter().map(|&plane| (plane, vec![0.0; count])).collect();
        let mut constants = vec![vec![0.0; planes.len()]; planes.len()];
        let identity = |source: usize| Image {
            source: source as u32,
            position: Vector::zeros(),
            sign: [1.0; D],
            data: [[0.0; 2]; D],
        };
        let mut matrices = Vec::new();
        for component in 0..=class[D - 1] {
            let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); count];
            for (a, stencil) in stencils.iter().enumerate() {
                for entry in &stencil.entries {
                    let number = entry.neighbor.checked_sub(count);
                    let image = number.map_or_else(|| identity(entry.neighbor), |k| images[k]);
                    let (b, sign) = (image.source as usize, image.sign[component]);
                    let stiffness = 2.0 * coefficients[a] * entry.weight;
                    rows[a].push((a as u32, -stiffness));
                    rows[b].push((b as u32, -stiffness * sign * sign));
                    rows[a].push((b as u32, stiffness * sign));
                    rows[b].push((a as u32, stiffness * sign));
                    for (k, &(axis, side)) in planes.iter().enumerate() {
                        let share = image.data[axis][side];
                        if axis != component || share == 0.0 {
                            continue;
                        }
                        sources[k].1[a] += stiffness * share;
                        sources[k].1[b] -= stiffness * share * sign;
                        for (l, &(other, end)) in planes.iter().enumerate() {
                            if other == axis {
                                constants[k][l] += stiffness * share * image.data[other][end];
                            }
                        }
                    }
                }
            }
            matrices.push(SparseOperator::from_rows(rows, count));
        }
        Self { matrices, class, sources, constants, coefficients: coefficients.to_vec() }
    }

    /// Coefficient c of particle `a` in J.
    pub fn coefficient(&self, a: usize) -> f64 {
        self.coefficients[a]
    }

    /// Adds the forces in N of the first sum.
    pub fn add_forces(&self, u: &[Vector<D>], data: &PlaneData<D>, forces: &mut [Vector<D>]) {
        parallel::for_each_chunk(forces, |first, forces| {
            for (offset, force) in forces.iter_mut().enumerate() {
                let a = first + offset;
                for i in 0..D {
                    let row = self.matrices[self.class[i]].row(a);
                    force[i] += row.map(|(b, value)| value * u[b as usize][i]).sum::<f64>();
                }
                for ((axis, side), source) in &self.sources {
                    force[*axis] += source[a] * data[*axis][*side];
                }
            }
        });
    }

    /// The first sum in J.
    pub fn energy(&self, u: &[Vector<D>], data: &PlaneData<D>) -> f64 {
        let mut forces = vec![Vector::zeros(); u.len()];
        self.add_forces(u, data, &mut forces);
        // Half of what is linear in the data is missing from the product with the forces.
        let linear = |a: usize| {
            let planes = self.sources.iter();
            planes
                .map(|((axis, side), source)| u[a][*axis] * source[a] * data[*axis][*side])
                .sum::<f64>()
        };
        let quadratic = parallel::sum(u.len(), |a| -0.5 * (u[a].dot(&forces[a]) + linear(a)));
        let datum = |k: usize| {
            let (axis, side) = self.sources[k].0;
            data[axis][side]
        };
        let pairs = self.constants.iter().enumerate().flat_map(|(k, row)| {
            row.iter().enumerate().map(move |(l, constant)| 0.5 * constant * datum(k) * datum(l))
        });
        quadratic + pairs.sum::<f64>()
    }

    /// The power in W that moving planes do on the first sum: `dE/dd` times the rates of the data.
    pub fn source_power(&self, u: &[Vector<D>], data: &PlaneData<D>, rates: &PlaneData<D>) -> f64 {
        let mut power = 0.0;
        for (k, ((axis, side), source)) in self.sources.iter().enumerate() {
            let of_body = parallel::sum(u.len(), |a| source[a] * u[a][*axis]);
            let others = self.sources.iter().zip(&self.constants[k]);
            let of_planes: f64 =
                others.map(|(((other, end), _), constant)| constant * data[*other][*end]).sum();
            power += rates[*axis][*side] * (of_planes - of_body);
        }
        power
    }

    /// Bytes of all coefficients.
    pub fn memory(&self) -> usize {
        let matrices: usize = self.matrices.iter().map(SparseOperator::memory).sum();
        let sources: usize = self.sources.iter().map(|(_, it)| size_of_val(it.as_slice())).sum();
        matrices + sources + size_of_val(self.coefficients.as_slice())
    }
}
