//! The discrete energy with its exact derivatives.

use nalgebra::{SMatrix, SVector};
use num_dual::Dual64;
use piola_formulas::Scalar;
use piola_formulas::pairs::Periods;
pub use piola_formulas::pairs::dual_support::Side;
use piola_formulas::pairs::dual_support::{
    Reactions, SupportSums, Supported, SupportedPair, Supports,
};

use super::Material;
use crate::geometry::Particles;
use crate::operators::{
    Among, DirectedSupport, DualGradient, FrozenRows, Term, dual_row, gather, sum_at,
};
use crate::{Tensor, Vector};

/// Particles, supports, coefficients and materials: all that the energy of a set of displacements
/// depends on. Its bodies are generic over the number type, so that dual numbers give derivatives
/// of energies and forces through them.
#[derive(Clone, Debug)]
pub struct Discrete<const D: usize> {
    pub(super) particles: Particles<D>,
    pub(super) support: DirectedSupport<D>,
    pub(super) gradient: DualGradient<D>,
    /// One a body.
    pub(super) materials: Vec<Material<D>>,
    /// `c_ab = hourglass_a s_ab/tr L_a` with this one a particle, J.
    pub(super) hourglass: Vec<f64>,
    pub(super) pairs: SupportPairs<D>,
}

/// The pairs that passes go through.
#[derive(Clone, Debug)]
pub(super) struct SupportPairs<const D: usize> {
    /// Supports.
    rows: FrozenRows<SupportedPair<D>>,
    /// Dual supports, with the pairs as the other particle has them.
    dual: FrozenRows<SupportedPair<D>>,
    centers: Vec<Center<D>>,
}

impl<const D: usize> SupportPairs<D> {
    pub fn new(
        particles: &Particles<D>,
        support: &DirectedSupport<D>,
        gradient: &DualGradient<D>,
    ) -> Self {
        let pair = |entry: u32| Supported {
            gradient: Vector::from(*gradient.coefficient(entry)),
            weight: gradient.weight(entry),
        };
        let (list, count) = (&support.list, particles.len());
        let row = |a: usize| {
            let entries = list.row(a).iter().zip(list.range(a));
            entries.map(move |(&b, entry)| (b, pair(entry as u32)))
        };
        let dual = |a: usize| dual_row(support, a).map(move |(&b, &entry)| (b, pair(entry)));
        let center = |a: usize| {
            let (mut sum, mut first, mut second) =
                (Vector::zeros(), Vector::zeros(), Tensor::zeros());
            for (b, pair) in row(a) {
                let separation = support.separation(&particles.position, a, b);
                sum += pair.gradient;
                first += separation * pair.weight;
                second += separation * separation.transpose() * pair.weight;
            }
            Center { gradient: sum.into(), first: first.into(), second: second.into() }
        };
        Self {
            rows: FrozenRows::new((0..count).map(row)),
            dual: FrozenRows::new((0..count).map(dual)),
            centers: (0..count).map(center).collect(),
        }
    }

    /// Bytes of all of it.
    pub fn memory(&self) -> usize {
        self.rows.memory() + self.dual.memory() + size_of_val(self.centers.as_slice())
    }
}

/// Sums over the support of a particle that do not change.
#[derive(Clone, Copy, Debug)]
struct Center<const D: usize> {
    /// `sum_b G_ab` in 1/m.
    gradient: [f64; D],
    /// `sum_b w_ab X_ab` in 1/m, with the weights of theory (47).
    first: [f64; D],
    /// `sum_b w_ab X_ab (x) X_ab`.
    second: [[f64; D]; D],
}

impl<const D: usize> Discrete<D> {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.particles.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.particles.is_empty()
    }

    /// The material of particle a.
    #[inline]
    pub(super) fn material(&self, a: usize) -> &Material<D> {
        &self.materials[self.particles.body[a] as usize]
    }

    /// Mass of particle a in kg (per unit of the missing dimensions).
    #[inline]
    pub(super) fn mass(&self, a: usize) -> f64 {
        self.material(a).density * self.particles.volume[a]
    }

    /// Displacement gradient of particle a, theory (44), Dual-support (12) less the identity.
    #[inline]
    pub fn displacement_gradient<T: Scalar>(
        &self,
        displacement: &[SVector<T, D>],
        a: usize,
    ) -> SMatrix<T, D, D> {
        let mut gradient = SMatrix::zeros();
        let list = &self.support.list;
        for (&b, g) in list.row(a).iter().zip(self.gradient.coefficients(list.range(a))) {
            add_product(&mut gradient, &(displacement[b as usize] - displacement[a]), g);
        }
        gradient
    }

    /// Strain and hourglass energy of particle a in J, theory (47), Dual-support (21) and (38).
    pub fn energy_of<T: Scalar>(&self, displacement: &[SVector<T, D>], a: usize) -> [T; 2] {
        let gradient = self.displacement_gradient(displacement, a);
        let strain = self.material(a).law.energy(&gradient) * self.particles.volume[a];
        let mut hourglass = T::zero();
        let list = &self.support.list;
        let row = list.row(a).iter().zip(self.gradient.weights(list.range(a)));
        for (&b, weight) in row {
            let deviation = self.deviation(displacement, &gradient, a, b);
            let square = deviation.iter().fold(T::zero(), |sum, &entry| sum + entry * entry);
            hourglass += square * *weight;
        }
        [strain, hourglass * self.hourglass[a]]
    }

    /// Strain and hourglass energy of all particles in J. Added up in their order, on one thread.
    pub fn total_energy<T: Scalar>(&self, displacement: &[SVector<T, D>]) -> [T; 2] {
        (0..self.len()).fold([T::zero(); 2], |[strain, hourglass], a| {
            let [s, h] = self.energy_of(displacement, a);
            [strain + s, hourglass + h]
        })
    }

    /// `A_a X_ab - u_ab`: how far b is from where a linear field around a would have it.
    #[inline]
    fn deviation<T: Scalar>(
        &self,
        displacement: &[SVector<T, D>],
        gradient: &SMatrix<T, D, D>,
        a: usize,
        b: u32,
    ) -> SVector<T, D> {
        let separation = self.support.separation(&self.particles.position, a, b);
        let mut deviation = displacement[a] - displacement[b as usize];
        for i in 0..D {
            for j in 0..D {
                deviation[i] += gradient[(i, j)] * separation[j];
            }
        }
        deviation
    }

    /// What the sums over the support of particle a make of it: gradient, tension and pull.
    ///
    /// Its energy changes by `sum_b t_ab . (du_b - du_a)`, `t_ab = T_a G_ab - 2 c_ab e_ab`, where
    /// `T_a = V_a P_a + 2 sum_b c_ab e_ab (x) X_ab` and e the deviation: theory (48). With plain
    /// gradients the sum in T vanishes; with corrected ones it does not.
    #[inline]
    fn side<T: Scalar>(
        &self,
        a: usize,
        sums: &SupportSums<T, D>,
        displacement: SVector<T, D>,
        stress: impl Fn(usize, &SMatrix<T, D, D>) -> SMatrix<T, D, D>,
    ) -> Side<T, D> {
        let (center, gradient) = (&self.pairs.centers[a], sums.gradient);
        let volume = self.particles.volume[a];
        let mut tension = stress(a, &gradient).map(|entry| entry * volume);
        let mut pull = SVector::<T, D>::zeros();
        let hourglass = 2.0 * self.hourglass[a];
        if hourglass != 0.0 {
            // Sums of deviations and of deviations with their arms.
            let deviation = applied(&gradient, &center.first) - sums.difference;
            for j in 0..D {
                // The sums are symmetric.
                let arm = applied(&gradient, &center.second[j]);
                for i in 0..D {
                    tension[(i, j)] += (arm[i] - sums.moment[(i, j)]) * hourglass;
                }
            }
            pull -= deviation.map(|entry| entry * hourglass);
        }
        pull += applied(&tension, &center.gradient);
        let reference = self.particles.position[a].map(T::from);
        Side { gradient, tension, pull, displacement, reference, hourglass: T::from(hourglass) }
    }

    /// Forces on all particles in N into `force`, with the sides that they are made of.
    pub fn forces(
        &self,
        displacement: &[Vector<D>],
        sides: &mut [Side<f64, D>],
        force: &mut [Vector<D>],
    ) {
        self.fill_sides(displacement, sides, |a, gradient| self.material(a).law.stress(gradient));
        self.fill_forces(sides, force);
    }

    /// The pass over supports: the sides of all particles, with the stresses of `stress`.
    pub fn fill_sides(
        &self,
        displacement: &[Vector<D>],
        sides: &mut [Side<f64, D>],
        stress: impl Fn(usize, &Tensor<D>) -> Tensor<D> + Sync,
    ) {
        let source = (displacement, &*self.particles.position);
        let close = |a: usize, sums: &SupportSums<f64, D>, side: &mut Side<f64, D>| {
            *side = self.side(a, sums, displacement[a], &stress);
        };
        let (rows, way, among) = (&self.pairs.rows, self.periods(), Among::All);
        match self.resists_hourglass() {
            true => {
                let law = Supports::<D, true>(way);
                gather(rows, &Term { law, source, among }, sides, Some, close);
            }
            false => {
                let law = Supports::<D, false>(way);
                gather(rows, &Term { law, source, among }, sides, Some, close);
            }
        }
    }

    /// The pass over dual supports: forces in N, theory (49), Dual-support (28) with the sign of its
    /// (27) turned round.
    pub fn fill_forces(&self, sides: &[Side<f64, D>], force: &mut [Vector<D>]) {
        let close = |a: usize, taken: &Vector<D>, force: &mut Vector<D>| {
            *force = sides[a].pull + taken;
        };
        let (rows, way, among) = (&self.pairs.dual, self.periods(), Among::All);
        match self.resists_hourglass() {
            true => {
                let law = Reactions::<D, true>(way);
                gather(rows, &Term { law, source: sides, among }, force, Some, close);
            }
            false => {
                let law = Reactions::<D, false>(way);
                gather(rows, &Term { law, source: sides, among }, force, Some, close);
            }
        }
    }

    fn periods(&self) -> Periods<D> {
        Periods::new(self.support.domain.periods())
    }

    fn resists_hourglass(&self) -> bool {
        self.hourglass.iter().any(|hourglass| *hourglass != 0.0)
    }

    /// The tangent stiffness times `direction`, `d2E/du2 direction`, in N for a direction in m:
    /// Dual-support (29) and (40), both with the factors that they lack. By dual numbers through
    /// the forces, so exact and symmetric for any material.
    pub fn stiffness_product(
        &self,
        displacement: &[Vector<D>],
        direction: &[Vector<D>],
    ) -> Vec<Vector<D>> {
        let seeded: Vec<SVector<Dual64, D>> = displacement
            .iter()
            .zip(direction)
            .map(|(u, d)| SVector::from_fn(|i, _| Dual64::new(u[i], d[i])))
            .collect();
        let places = self.particles.position.iter().map(|x| x.map(Dual64::from));
        let places: Vec<_> = seeded.iter().copied().zip(places).collect();
        let (supports, reactions) =
            (Supports::<D, true>(self.periods()), Reactions::<D, true>(self.periods()));
        let stress = |a: usize, gradient: &SMatrix<Dual64, D, D>| -> SMatrix<Dual64, D, D> {
            self.material(a).law.stress(gradient)
        };
        let side = |a: usize| {
            let sums = sum_at(&self.pairs.rows, &supports, a, |b| places[b]);
            self.side(a, &sums, seeded[a], stress)
        };
        let sides: Vec<Side<Dual64, D>> = (0..self.len()).map(side).collect();
        let force = |a: usize| {
            let taken = sum_at(&self.pairs.dual, &reactions, a, |b| sides[b]);
            (sides[a].pull + taken).map(|entry| -entry.eps)
        };
        (0..self.len()).map(force).collect()
    }
}

/// `tensor += vector (x) row`.
#[inline]
fn add_product<T: Scalar, const D: usize>(
    tensor: &mut SMatrix<T, D, D>,
    vector: &SVector<T, D>,
    row: &[f64; D],
) {
    for j in 0..D {
        for i in 0..D {
            tensor[(i, j)] += vector[i] * row[j];
        }
    }
}

/// `tensor vector`.
#[inline]
fn applied<T: Scalar, const D: usize>(
    tensor: &SMatrix<T, D, D>,
    vector: &[f64; D],
) -> SVector<T, D> {
    let mut result = SVector::zeros();
    for j in 0..D {
        for i in 0..D {
            result[i] += tensor[(i, j)] * vector[j];
        }
    }
    result
}
