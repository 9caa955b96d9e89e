//! The hourglass energy of a scalar field, written out: each component of a displacement has it.

use piola::Vector;
use piola::geometry::Particles;
use piola::operators::{DirectedSupport, DualGradient};

/// The hourglass energy of a scalar field s, a temperature or a concentration, on the supports and
/// gradients of the formulation with dual supports: theory (47) for one component,
///
/// ```text
/// E = sum_ab c_a w_ab e_ab^2,   e_ab = grad s_a . X_ab - (s_b - s_a),   grad s_a = sum_b (s_b - s_a) G_ab
/// ```
///
/// with coefficients c_a and the weights `w_ab = s_ab/tr L_a` of [`DualGradient::weights`].
#[derive(Clone, Copy, Debug)]
pub struct ScalarHourglass<'a, const D: usize> {
    /// The particles.
    pub particles: &'a Particles<D>,
    /// Their supports.
    pub support: &'a DirectedSupport<D>,
    /// Their gradients.
    pub gradient: &'a DualGradient<D>,
    /// c_a of each particle: an energy over the square of a unit of s.
    pub coefficients: &'a [f64],
}

/// What the support of a particle says of it: its gradient, and `2 c_a sum_b w_ab e_ab X_ab`.
#[derive(Clone, Copy)]
struct Side<const D: usize> {
    gradient: Vector<D>,
    moment: Vector<D>,
}

impl<const D: usize> ScalarHourglass<'_, D> {
    /// The gradient of the field at particle a.
    fn gradient_at(&self, field: &[f64], a: usize) -> Vector<D> {
        let list = &self.support.list;
        let row = list.row(a).iter().zip(self.gradient.coefficients(list.range(a)));
        row.map(|(&b, g)| Vector::from(*g) * (field[b as usize] - field[a])).sum()
    }

    /// `e_ab`, of which the gradient at a is known.
    fn deviation(&self, field: &[f64], gradient: &Vector<D>, a: usize, b: usize) -> f64 {
        let separation = self.support.separation(&self.particles.position, a, b as u32);
        gradient.dot(&separation) - (field[b] - field[a])
    }

    /// The energy of a field.
    pub fn energy(&self, field: &[f64]) -> f64 {
        let list = &self.support.list;
        let energy = |a: usize| {
            let gradient = self.gradient_at(field, a);
            let row = list.row(a).iter().zip(self.gradient.weights(list.range(a)));
            let squares = row.map(|(&b, weight)| {
                weight * self.deviation(field, &gradient, a, b as usize).powi(2)
            });
            self.coefficients[a] * squares.sum::<f64>()
        };
        (0..field.len()).map(energy).sum()
    }

    fn side(&self, field: &[f64], a: usize) -> Side<D> {
        let list = &self.support.list;
        let gradient = self.gradient_at(field, a);
        let row = list.row(a).iter().zip(self.gradient.weights(list.range(a)));
        let moment: Vector<D> = row
            .map(|(&b, weight)| {
                let separation = self.support.separation(&self.particles.position, a, b);
                let deviation = self.deviation(field, &gradient, a, b as usize);
                separation * (2.0 * self.coefficients[a] * weight * deviation)
            })
            .sum();
        Side { gradient, moment }
    }

    /// `t_ab`, by which the energy of a changes with `ds_b - ds_a`: the negative of Dual-support
    /// (30), which as printed drives a field away from its gradient; with the moment of a, which
    /// vanishes for plain gradients.
    fn exchange(&self, field: &[f64], side: &Side<D>, entry: u32, a: usize, b: usize) -> f64 {
        let deviation = self.deviation(field, &side.gradient, a, b);
        side.moment.dot(&Vector::from(*self.gradient.coefficient(entry)))
            - 2.0 * self.coefficients[a] * self.gradient.weight(entry) * deviation
    }

    /// `-dE/ds` of all particles: what a rate equation of the field adds. It sums to zero, and is
    /// zero for linear fields.
    pub fn force(&self, field: &[f64]) -> Vec<f64> {
        let sides: Vec<Side<D>> = (0..field.len()).map(|a| self.side(field, a)).collect();
        let list = &self.support.list;
        let mut force = vec![0.0; field.len()];
        for a in 0..field.len() {
            for (&b, entry) in list.row(a).iter().zip(list.range(a)) {
                let exchange = self.exchange(field, &sides[a], entry as u32, a, b as usize);
                force[a] += exchange;
                force[b as usize] -= exchange;
            }
        }
        force
    }
}
