//! Slopes of displacements at loaded edges, from the stress there: theory (64).

use piola_formulas::tensor;

use super::super::{Matrices, Mixture, TotalLagrangian};
use super::edges::{Edges, Slot};
use crate::{Tensor, Vector};

/// Steps of Newton's method.
const MOST_STEPS: usize = 60;

/// A step of Newton's method shorter than this has been the last: the next one is round-off.
const LAST_STEP: f64 = 1e-10;

/// The entries (i, j) of the displacement gradient that are sought at a particle for each i, with the
/// number of the slot that knows the stress.
pub(in super::super) type Sought<const D: usize> = [Option<(usize, usize)>; D];

/// Derivatives of the stress by the entries (k, l) of the gradient.
pub(in super::super) type Tangents<const D: usize> = [[Tensor<D>; D]; D];

impl<const D: usize> Slot<D> {
    /// What is sought in the slot of a number, and which entries of the gradient are not zero beforehand.
    ///
    /// On an edge the loaded components of the column across are sought. A corner of two loaded edges
    /// knows no direction: its shear is zero, and its stretches are those of both loads. Where the other
    /// edge holds a component, its slope along that edge is zero.
    pub fn search(slots: &[Self], number: usize) -> (Sought<D>, Tensor<D>) {
        let slot = &slots[number];
        let mut known = Tensor::from_element(1.0);
        let at_corner: Vec<usize> =
            slot.across.iter().copied().flatten().chain(std::iter::once(number)).collect();
        if at_corner.len() == 1 {
            let own = |i: usize| (!slot.is_held[i]).then_some((slot.axis, number));
            return (std::array::from_fn(own), known);
        }
        let mut sought = [None; D];
        let is_held = |i: usize| at_corner.iter().any(|&other| slots[other].is_held[i]);
        for &other in &at_corner {
            for i in slots[other].loaded() {
                known[(i, slots[other].axis)] = 0.0;
                if slots[other].axis == i && !is_held(i) {
                    sought[i] = Some((i, other));
                }
            }
        }
        (sought, known)
    }
}

/// Entries of the displacement gradient at which those of the stress of a material are `stress`, by
/// Newton's method from those of `gradient`, with steps that leave at least half of the volume.
pub(super) fn solve<const D: usize>(
    mixture: &Mixture<D>,
    mut gradient: Tensor<D>,
    sought: &Sought<D>,
    stress: impl Fn(usize, usize) -> f64,
) -> Tensor<D> {
    let volume = |gradient: &Tensor<D>| tensor::determinant(&(gradient + Tensor::identity()));
    let is_bounded = !mixture.is_linear();
    for _ in 0..MOST_STEPS {
        let own = mixture.stress(&gradient);
        let rest = |i: usize, j: usize, slot: usize| stress(slot, i) - own[(i, j)];
        let Some(change) = step(&mixture.tangent(&gradient), sought, rest) else {
            return Tensor::from_element(f64::NAN);
        };
        let (least, mut next) = (0.5 * volume(&gradient), gradient + change);
        let mut share = 1.0;
        while is_bounded && volume(&next) < least && share > f64::EPSILON {
            share *= 0.5;
            next = gradient + change * share;
        }
        gradient = next;
        if !(change.amax() > LAST_STEP * (1.0 + gradient.amax())) {
            break;
        }
    }
    gradient
}

/// The change of the entries that are sought at which their stresses change by `rest`, which is told the
/// entry and the slot.
pub(super) fn step<const D: usize>(
    tangents: &Tangents<D>,
    sought: &Sought<D>,
    rest: impl Fn(usize, usize, usize) -> f64,
) -> Option<Tensor<D>> {
    let matrix = Tensor::<D>::from_fn(|i, k| match (sought[i], sought[k]) {
        (Some((j, _)), Some((l, _))) => tangents[k][l][(i, j)],
        _ => f64::from(u8::from(i == k)),
    });
    let rest = Vector::<D>::from_fn(|i, _| sought[i].map_or(0.0, |(j, slot)| rest(i, j, slot)));
    let change = tensor::inverse(&matrix)? * rest;
    let is_sought = |i: usize, j: usize| sought[i].is_some_and(|(column, _)| column == j);
    Some(Tensor::from_fn(|i, j| if is_sought(i, j) { change[i] } else { 0.0 }))
}

/// `gradient` without the entries that are sought.
fn without<const D: usize>(gradient: &Tensor<D>, sought: &Sought<D>) -> Tensor<D> {
    let is_sought = |i: usize, j: usize| sought[i].is_some_and(|(column, _)| column == j);
    Tensor::from_fn(|i, j| if is_sought(i, j) { 0.0 } else { gradient[(i, j)] })
}

impl<const D: usize> Edges<D> {
    /// Writes values of held components behind a field of `count` particles, and `slopes` for others.
    fn append(&self, count: usize, field: &mut [Vector<D>], slope: impl Fn(usize, usize) -> f64) {
        for (number, slot) in self.slots.iter().enumerate() {
            let held = field[slot.particle];
            field[count + number] =
                Vector::from_fn(|i, _| if slot.is_held[i] { held[i] } else { slope(number, i) });
        }
        for number in self.slots.len()..self.data() {
            field[count + number] = Vector::from_fn(|i, _| slope(number, i));
        }
    }

    /// Writes values of held components behind a field of `count` particles, with zeros for others.
    pub fn append_held(&self, count: usize, field: &mut [Vector<D>]) {
        self.append(count, field, |_, _| 0.0);
    }

    /// Writes data of the edges behind a field of rates: with the derivatives of the stress at a
    /// particle, and the rates of the stress in a slot.
    pub fn continue_rates(
        &mut self,
        field: &mut [Vector<D>],
        tangents: impl Fn(usize) -> Tangents<D>,
        stress_rate: impl Fn(&Slot<D>) -> Vector<D>,
    ) {
        let count = self.gradient.count();
        self.append_held(count, field);
        let mut found = std::mem::take(&mut self.found);
        for (slot, found) in self.slots.iter().zip(&mut found) {
            let (a, sought) = (slot.particle, &slot.sought);
            if sought.iter().all(Option::is_none) {
                *found = Vector::zeros();
                continue;
            }
            let gradient = self.gradient.gradient_at(field, a);
            let rates = without(&gradient.component_mul(&slot.not_zero), sought);
            let tangents = tangents(a);
            let own = |i: usize, j: usize| -> f64 {
                let entries = (0..D * D).map(|entry| (entry / D, entry % D));
                entries.map(|(k, l)| tangents[k][l][(i, j)] * rates[(k, l)]).sum()
            };
            let rest =
                |i: usize, j: usize, slot: usize| stress_rate(&self.slots[slot])[i] - own(i, j);
            let change = step(&tangents, sought, rest);
            let change = change.unwrap_or_else(|| Tensor::from_element(f64::NAN));
            *found = change.column(slot.axis).into();
        }
        for (foot, found) in self.feet.iter().zip(&mut found[self.slots.len()..]) {
            *found = foot.slope_rate(field);
        }
        self.append(count, field, |number, i| found[number][i]);
        self.found = found;
    }
}

impl<const D: usize> TotalLagrangian<D> {
    /// Writes displacements of held components, and the slopes that the `tail` of a state keeps, behind `field`, the
    /// displacements in a state.
    pub(in super::super) fn append_kept(&self, field: &mut [Vector<D>], tail: &[f64]) {
        let Some(edges) = self.matrices.edges() else { return };
        let kept = self.kept(tail);
        edges.append(self.solid.len(), field, |number, i| kept[number * D + i]);
    }

    /// Writes all data of the edges behind the displacements, with the stresses that belong to them.
    pub(super) fn continue_displacement(&mut self, time: f64) {
        let Matrices::Strong(edges) = &mut self.matrices else { return };
        let (count, displacement) = (self.solid.len(), &mut self.displacement);
        edges.known.copy_from_slice(&displacement[count..]);
        edges.append_held(count, displacement);
        for (stress, slot) in edges.stress.iter_mut().zip(&edges.slots) {
            *stress = slot.stress(time);
        }
        let (slots, stress) = (&edges.slots, &edges.stress);
        let mut found = std::mem::take(&mut edges.found);
        for (slot, found) in slots.iter().zip(&mut found) {
            let (a, sought) = (slot.particle, &slot.sought);
            if sought.iter().all(Option::is_none) {
                *found = Vector::zeros();
                continue;
            }
            let mut gradient = edges.gradient.gradient_at(displacement, a);
            gradient.component_mul_assign(&slot.not_zero);
            for (i, entry) in sought.iter().enumerate() {
                if let Some((j, slot)) = *entry {
                    gradient[(i, j)] = edges.known[slot][i];
                }
            }
            let mixture = self.solid.mixture(a);
            let solution = solve(mixture, gradient, sought, |slot, i| stress[slot][i]);
            *found = solution.column(slot.axis).into();
        }
        let first = edges.slots.len();
        for (number, foot) in (first..).zip(&mut edges.feet) {
            let mixture = self.solid.mixture(foot.inside.like);
            found[number] = foot.slope(mixture, displacement, edges.known[number]);
        }
        edges.append(count, displacement, |number, i| found[number][i]);
        edges.found = found;
    }
}
