//! The gradient of a body in its reference configuration, with its hourglass energy and the adjoint of both.

use std::ops::Range;

use nalgebra::{SMatrix, SVector};
use piola_formulas::Scalar;
use piola_formulas::kernels::Kernel;

use super::adjoint::AdjointPairs;
use super::directed::DirectedSupport;
use super::dual_gradient::DualGradient;
use super::frozen::RowSizes;
use super::images::Image;
use super::slots::Slots;
use super::strained::{Strained, stabilised};
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborList};
use crate::parallel::Team;
use crate::{Tensor, Vector};

/// What the lower and the upper plane of each axis prescribe for the component along it.
pub type PlaneData<const D: usize> = [[f64; 2]; D];

/// The displacement gradient `A_a = sum_b u_ab (x) G_ab` and the hourglass energy
/// `sum_a c_a sum_b w_ab |A_a X_ab - u_ab|^2` of a total Lagrangian body, theory (44) and (47), with the exact
/// derivatives of energies that are functions of both: what all such formulations are made of.
///
/// Images continue the body beyond planes, theory (59). Fields have their values behind those of particles, and
/// what acts on them acts on the particles that they mirror.
///
/// The hourglass energy is `sum_a c_a (sum_b w_ab |u_ab|^2 - 2 A_a : M_a + A_a : A_a S_a)` with
/// `M_a = sum_b w_ab u_ab (x) X_ab` and `S_a = sum_b w_ab X_ab (x) X_ab`. Its first sum is one of differences
/// of pairs. M is `A S` where gradients have not been made consistent with patches, theory (60), and
/// elsewhere a second sum beside A.
#[derive(Clone, Debug)]
pub struct ReferenceGradient<const D: usize> {
    /// Hourglass coefficient c of each particle in J, of which the pairs have their stiffness.
    hourglass: Vec<f64>,
    /// Whether the gradient is that of the paper: one that is not has one sum, too, where nothing is stabilised.
    is_plain: bool,
    kernel: Kernel,
    radius: Vec<f64>,
    domain: Domain<D>,
    /// Reference positions of particles, and behind them of images.
    positions: Vec<Vector<D>>,
    images: Vec<Image<D>>,
    pub(crate) pairs: Pairs<D>,
    centers: Vec<Center<D>>,
}

/// The pairs that passes go through: with one sum, and with two.
#[derive(Clone, Debug)]
pub(crate) enum Pairs<const D: usize> {
    Plain(AdjointPairs<D, 1>),
    Consistent(AdjointPairs<D, 2>),
}

/// Runs an expression on the pairs, whatever the number of their sums.
macro_rules! on_pairs {
    ($all:expr, $pairs:ident => $body:expr) => {
        match $all {
            Pairs::Plain($pairs) => $body,
            Pairs::Consistent($pairs) => $body,
        }
    };
}

/// Sums over the support of a particle that do not change.
#[derive(Clone, Copy, Debug)]
struct Center<const D: usize> {
    /// `sum_b G_ab` and `sum_b w_ab X_ab`, in 1/m.
    coefficients: [Vector<D>; 2],
    /// `S_a`.
    shape: Tensor<D>,
}

/// Particles whose tensions are found together.
const BLOCK: usize = 32;

impl<const D: usize> ReferenceGradient<D> {
    /// The gradient of `gradient` on its support, with hourglass coefficients in J.
    #[inline(never)]
    pub fn new(
        (particles, images): (&Particles<D>, &[Image<D>]),
        support: &DirectedSupport<D>,
        gradient: &DualGradient<D>,
        hourglass: Vec<f64>,
    ) -> Self {
        let images = images.to_vec();
        let mut positions = particles.position.clone();
        positions.extend(images.iter().map(|image| image.position));
        let arm = |a: usize, b: u32, entry: u32| {
            support.separation(&positions, a, b) * gradient.weight(entry)
        };
        let center = |a: usize| {
            let mut center = Center { coefficients: [Vector::zeros(); 2], shape: Tensor::zeros() };
            for (&b, entry) in support.list.row(a).iter().zip(support.list.range(a)) {
                let arm = arm(a, b, entry as u32);
                center.coefficients[0] += Vector::from(*gradient.coefficient(entry as u32));
                center.coefficients[1] += arm;
                center.shape += arm * support.separation(&positions, a, b).transpose();
            }
            center
        };
        let centers = (0..particles.len()).map(center).collect();
        let has_hourglass = hourglass.iter().any(|hourglass| *hourglass != 0.0);
        let pairs = match gradient.is_plain() || !has_hourglass {
            true => Pairs::Plain(AdjointPairs::new(support, gradient, &hourglass, arm)),
            false => Pairs::Consistent(AdjointPairs::new(support, gradient, &hourglass, arm)),
        };
        let DirectedSupport { kernel, domain, .. } = *support;
        let radius = support.radius.clone();
        let is_plain = gradient.is_plain();
        Self { hourglass, is_plain, kernel, radius, domain, positions, images, pairs, centers }
    }

    /// The same gradient of the same particles with other hourglass coefficients in J.
    pub fn with_hourglass(&self, particles: &Particles<D>, hourglass: Vec<f64>) -> Self {
        let (support, gradient) = self.lists();
        Self::new((particles, &self.images), &support, &gradient, hourglass)
    }

    /// That of some particles and of their images, behind which stand copies of other slots.
    pub fn part(&self, slots: &Slots) -> Self {
        let Slots { own, images, .. } = slots;
        let all = || slots.iter();
        let place = |slot: u32| slots.place(slot);
        let image = |&slot: &usize| {
            let image = self.images[slot - self.count()];
            Image { source: image.source - own.start as u32, ..image }
        };
        Self {
            hourglass: self.hourglass[own.clone()].to_vec(),
            is_plain: self.is_plain,
            kernel: self.kernel,
            radius: own.clone().map(|a| self.radius[a]).collect(),
            domain: self.domain,
            positions: all().map(|slot| self.positions[slot]).collect(),
            images: images.iter().map(image).collect(),
            pairs: match &self.pairs {
                Pairs::Plain(all) => Pairs::Plain(all.part(own.clone(), images, place)),
                Pairs::Consistent(all) => Pairs::Consistent(all.part(own.clone(), images, place)),
            },
            centers: self.centers[own.clone()].to_vec(),
        }
    }

    /// The slots of a rank: its particles, their images, and what either takes part in a gradient with, and `more`, as
    /// copies, rank by rank. Those of a rank begin and end where `bounds` has it.
    pub fn slots(&self, own: Range<usize>, bounds: &[usize], more: &[usize]) -> Slots {
        let source = |slot: usize| self.source(slot).0;
        let rank = |slot: usize| bounds.partition_point(|&bound| bound <= source(slot)) - 1;
        let all = self.count()..self.positions.len();
        let images: Vec<usize> = all.filter(|&slot| own.contains(&source(slot))).collect();
        let near = own.clone().chain(images.iter().copied()).flat_map(|slot| self.beside(slot));
        let others = near.chain(more.iter().copied());
        let others = others.filter(|&slot| !own.contains(&source(slot)));
        let mut copies: Vec<(usize, usize)> = others.map(|slot| (rank(slot), slot)).collect();
        copies.sort_unstable();
        copies.dedup();
        Slots::new(own, images, copies)
    }

    /// The slots that a particle or an image takes part in a gradient with, some twice.
    fn beside(&self, slot: usize) -> Vec<usize> {
        let all = on_pairs!(&self.pairs, pairs => pairs.all(slot));
        all.into_iter().map(|slot| slot as usize).collect()
    }

    /// Number of the pairs of a particle that passes go through.
    pub fn length(&self, a: usize) -> usize {
        on_pairs!(&self.pairs, pairs => pairs.length(a))
    }

    /// How large the rows of gradients and of forces are.
    pub fn sizes(&self) -> [RowSizes; 2] {
        on_pairs!(&self.pairs, pairs => pairs.sizes())
    }

    /// Bytes that a particle has of its own: coefficients, shape and stiffness.
    pub const OWN: [usize; 2] = [size_of::<Center<D>>(), size_of::<f64>()];

    /// How many tensors forces gather of a particle.
    pub fn tensions(&self) -> usize {
        on_pairs!(&self.pairs, pairs => pairs.sums())
    }

    /// Number of particles.
    pub fn count(&self) -> usize {
        self.centers.len()
    }

    /// Number of images, whose values stand behind those of particles.
    pub fn images(&self) -> usize {
        self.images.len()
    }

    /// Number of particles and of their images, behind which a rank has copies of others.
    pub fn owned(&self) -> usize {
        self.centers.len() + self.images.len()
    }

    /// The particle that a slot is, or is the image of, with the signs of the components of its field there.
    #[inline]
    pub fn source(&self, slot: usize) -> (usize, Vector<D>) {
        match slot.checked_sub(self.count()) {
            None => (slot, Vector::from_element(1.0)),
            Some(image) => {
                let image = &self.images[image];
                (image.source as usize, image.sign.into())
            }
        }
    }

    /// Where particles are, and behind them images, in m.
    pub fn positions(&self) -> &[Vector<D>] {
        &self.positions
    }

    /// Writes the values of images behind those of particles.
    pub fn continue_field(&self, data: &PlaneData<D>, field: &mut [Vector<D>]) {
        let (own, behind) = field.split_at_mut(self.count());
        for (value, image) in behind.iter_mut().zip(&self.images) {
            let source = own[image.source as usize];
            *value = Vector::from_fn(|i, _| image.sign[i] * source[i] + image.carried(data)[i]);
        }
    }

    /// Lets what acts on images act on the particles that they mirror.
    pub fn fold(&self, force: &mut [Vector<D>]) {
        let (own, behind) = force.split_at_mut(self.count());
        for (force, image) in behind.iter().zip(&self.images) {
            let signed = Vector::<D>::from_fn(|i, _| image.sign[i] * force[i]);
            own[image.source as usize] += signed;
        }
    }

    /// The power in W of planes whose data change at these rates, with the forces on images of all ranks.
    pub fn plane_power(&self, team: &Team, force: &[Vector<D>], rates: &PlaneData<D>) -> f64 {
        let pairs = force[self.count()..].iter().zip(&self.images);
        -team.total(pairs.map(|(force, image)| force.dot(&image.carried(rates))))
    }

    /// Who sees whom with which coefficients, entry by entry, as matrices are made of it.
    pub fn lists(&self) -> (DirectedSupport<D>, DualGradient<D>) {
        let (mut offsets, mut indices) = (vec![0], Vec::new());
        let (mut coefficients, mut weights) = (Vec::new(), Vec::new());
        for a in 0..self.positions.len() {
            self.see(a, |b, coefficient, weight| {
                indices.push(b as u32);
                coefficients.push((*coefficient).into());
                weights.push(weight);
            });
            offsets.push(indices.len());
        }
        let list = NeighborList::from_arrays(offsets, indices);
        let kernel = (self.kernel, self.radius.clone());
        let support = DirectedSupport::on(list, kernel, self.domain);
        (support, DualGradient { coefficients, weights, is_plain: self.is_plain })
    }

    /// Shows what particle a has in its support, with `G_ab` and `w_ab`. An image has nothing in it.
    fn see(&self, a: usize, mut look: impl FnMut(usize, &Vector<D>, f64)) {
        let Some(center) = self.centers.get(a) else { return };
        on_pairs!(&self.pairs, pairs => pairs.visit(a, |b, coefficients| {
            let separation = self.separation(a, b);
            let arm = match coefficients.as_slice() {
                [_, arm] => *arm,
                _ => center.shape * coefficients[0],
            };
            look(b, &coefficients[0], arm.dot(&separation) / separation.norm_squared());
        }));
    }

    fn separation(&self, a: usize, b: usize) -> Vector<D> {
        self.domain.separation(&self.positions[a], &self.positions[b])
    }

    /// The displacement gradient of particle a, in numbers of any type.
    #[inline]
    pub fn gradient_at<T: Scalar>(
        &self,
        displacement: &[SVector<T, D>],
        a: usize,
    ) -> SMatrix<T, D, D> {
        on_pairs!(&self.pairs, pairs => pairs.sums_at(displacement, a)[0])
    }

    /// The hourglass energy of particle a in J, of which the gradient is known, square by square.
    pub fn hourglass_energy<T: Scalar>(
        &self,
        displacement: &[SVector<T, D>],
        gradient: &SMatrix<T, D, D>,
        a: usize,
    ) -> T {
        let mut sum = T::zero();
        if self.hourglass[a] == 0.0 {
            return sum;
        }
        self.see(a, |b, _, weight| {
            let separation = self.separation(a, b);
            let mut deviation = displacement[a] - displacement[b];
            for i in 0..D {
                for j in 0..D {
                    deviation[i] += gradient[(i, j)] * separation[j];
                }
            }
            sum += deviation.iter().fold(T::zero(), |sum, &entry| sum + entry * entry) * weight;
        });
        sum * self.hourglass[a]
    }

    /// `sum_b G_ab` in 1/m.
    #[inline]
    pub fn sum(&self, a: usize) -> Vector<D> {
        self.centers[a].coefficients[0]
    }

    /// `S_a = sum_b w_ab X_ab (x) X_ab`.
    #[inline]
    pub fn shape(&self, a: usize) -> &Tensor<D> {
        &self.centers[a].shape
    }

    /// Scratch for the strains of all particles.
    pub fn strained(&self) -> Strained<D> {
        let sums = self.tensions();
        let zeros = |count: usize| vec![Tensor::zeros(); count];
        Strained { gradient: zeros(self.count()), tension: zeros(sums * self.positions.len()) }
    }

    /// The gradients of a field.
    pub fn gradients(&self, field: &[Vector<D>], gradient: &mut [Tensor<D>]) {
        on_pairs!(&self.pairs, pairs => {
            pairs.sum(field, gradient, |[_, k], sums, gradient| gradient[k] = sums[0], |_, _| {});
        });
    }

    /// Gradients of displacements, and with the `tension` in J, stress times volume, that particles have at
    /// their gradients, the derivatives of their energy: `tension(first, gradients, tensions)` fills in those
    /// of some particles that follow each other.
    pub fn strain(
        &self,
        displacement: &[Vector<D>],
        strained: &mut Strained<D>,
        tension: impl Fn(usize, &[Tensor<D>], &mut [Tensor<D>]) + Sync,
    ) {
        self.strain_with(1.0, displacement, strained, tension);
    }

    /// As [`Self::strain`], with a share of the hourglass energy.
    pub(crate) fn strain_with(
        &self,
        share: f64,
        displacement: &[Vector<D>],
        strained: &mut Strained<D>,
        tension: impl Fn(usize, &[Tensor<D>], &mut [Tensor<D>]) + Sync,
    ) {
        on_pairs!(&self.pairs, pairs => {
            let out = (&mut *strained.gradient, strained.tension.as_chunks_mut().0);
            pairs.sum(displacement, out, |[_, k], sums, (gradient, derivatives)| {
                (gradient[k], derivatives[k]) = (sums[0], *sums);
            }, |own, (gradient, derivatives)| {
                self.derive(share, own.start, gradient, derivatives, &tension);
            });
        });
    }

    /// Turns sums of particles from `first` on, of which the first are their gradients, into the derivatives of their energy
    /// by them.
    fn derive<const N: usize>(
        &self,
        share: f64,
        first: usize,
        gradient: &[Tensor<D>],
        sums: &mut [[Tensor<D>; N]],
        tension: &impl Fn(usize, &[Tensor<D>], &mut [Tensor<D>]),
    ) {
        let mut tensions = [Tensor::zeros(); BLOCK];
        let blocks = gradient.chunks(BLOCK).zip(sums.chunks_mut(BLOCK));
        for (first, (gradient, sums)) in (first..).step_by(BLOCK).zip(blocks) {
            let tensions = &mut tensions[..gradient.len()];
            tension(first, gradient, tensions);
            for ((a, sums), tension) in (first..).zip(sums).zip(tensions) {
                let stiffness = 2.0 * share * self.hourglass[a];
                *sums = self.derivatives(a, sums, *tension, stiffness);
            }
        }
    }

    /// The derivatives of the energy of a particle by its sums.
    #[inline]
    fn derivatives<const N: usize>(
        &self,
        a: usize,
        sums: &[Tensor<D>; N],
        tension: Tensor<D>,
        stiffness: f64,
    ) -> [Tensor<D>; N] {
        match stiffness != 0.0 {
            true => stabilised(sums, tension, &self.centers[a].shape, stiffness),
            false => {
                let mut derivatives = [Tensor::zeros(); N];
                derivatives[0] = tension;
                derivatives
            }
        }
    }

    /// Forces in N on particles, and behind them on images, of displacements and of what
    /// [`Self::strain`] makes of them; that of images is zero.
    pub fn forces(&self, field: &[Vector<D>], tension: &[Tensor<D>], force: &mut [Vector<D>]) {
        let own = |slot: usize| self.own_coefficients(slot);
        on_pairs!(&self.pairs, pairs => pairs.forces(field, own, tension, force));
    }

    /// `sum_b G_ab` and `sum_b w_ab X_ab` of a particle in 1/m; of an image zero.
    #[inline]
    pub(crate) fn own_coefficients(&self, slot: usize) -> [Vector<D>; 2] {
        self.centers.get(slot).map_or([Vector::zeros(); 2], |center| center.coefficients)
    }

    /// The images of particles.
    pub(crate) fn all_images(&self) -> &[Image<D>] {
        &self.images
    }

    /// The hourglass coefficient of a particle in J.
    pub fn hourglass(&self, a: usize) -> f64 {
        self.hourglass[a]
    }

    /// The particles in the support of a particle, and in whose support it lies.
    pub fn neighborhood(&self, a: usize) -> Vec<u32> {
        self.particles(on_pairs!(&self.pairs, pairs => pairs.all(a)), a)
    }

    /// Number of particles in the support of a particle; images count as what they mirror.
    pub fn neighbors(&self, a: usize) -> usize {
        let mut support = Vec::new();
        self.see(a, |b, _, _| support.push(b as u32));
        self.particles(support, a).len()
    }

    /// The particles but a that are meant, once each.
    fn particles(&self, slots: Vec<u32>, a: usize) -> Vec<u32> {
        let source = |slot: u32| match (slot as usize).checked_sub(self.count()) {
            None => slot,
            Some(image) => self.images[image].source,
        };
        let mut all: Vec<u32> =
            slots.into_iter().map(source).filter(|&b| b as usize != a).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Bytes of lists and coefficients.
    pub fn memory(&self) -> usize {
        on_pairs!(&self.pairs, pairs => pairs.memory())
            + size_of_val(self.radius.as_slice())
            + size_of_val(self.hourglass.as_slice())
            + size_of_val(self.positions.as_slice())
            + size_of_val(self.images.as_slice())
            + size_of_val(self.centers.as_slice())
    }
}
