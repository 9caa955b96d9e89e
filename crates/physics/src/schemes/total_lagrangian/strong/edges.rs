//! The edges of a row or a box of particles in the strong form: what is held there, what is loaded, and
//! the data with which ghosts carry fields on beyond them.

use std::collections::BTreeMap;

use super::super::Mixture;
use super::super::TotalLagrangianError;
use super::ghosts::{Places, ghosts};
use super::holes::{self, Foot, Hole, Inside};
use super::slopes::Sought;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{Traction, traction::Loaded};
use crate::geometry::Particles;
use crate::operators::{ContinuedGradient, Cover, GradientForm, OperatorError};
use crate::{Tensor, Vector, parallel};

/// Particles nearer to an edge than this share of their spacing lie on it.
pub(super) const ON_EDGE: f64 = 1e-6;

/// One straight edge, across an axis.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct Edge<const D: usize> {
    /// The axis that it lies across.
    pub axis: usize,
    /// Whether the body lies below it on the axis.
    pub is_upper: bool,
    /// Whether the velocity of a component is prescribed on it; otherwise its traction is, if only as
    /// zero.
    pub is_held: [bool; D],
    /// The particle on it that has all other coordinates in common with each particle.
    pub feet: Vec<u32>,
    /// The number of the slot of each of its particles.
    pub slots: BTreeMap<u32, u32>,
}

/// What is known of an edge at one of its particles: displacements of held components, the slope of
/// others along the axis of the edge, and the stress that belongs to it.
pub(in super::super) struct Slot<const D: usize> {
    pub particle: usize,
    pub axis: usize,
    pub is_held: [bool; D],
    /// The edge through the same particle across each other axis, by its slot.
    pub across: [Option<usize>; D],
    /// What is sought of the gradient.
    pub sought: Sought<D>,
    /// 0 for entries of the gradient that are zero, 1 for others.
    pub not_zero: Tensor<D>,
    /// 1 for an upper edge, -1 for a lower one.
    pub normal: f64,
    pub loads: Vec<Loaded<D>>,
}

impl<const D: usize> Slot<D> {
    /// The components that are loaded.
    pub fn loaded(&self) -> impl Iterator<Item = usize> + '_ {
        (0..D).filter(|&i| !self.is_held[i])
    }

    /// Column `axis` of the first Piola-Kirchhoff stress on the edge, Pa.
    pub fn stress(&self, time: f64) -> Vector<D> {
        self.loads.iter().map(|load| load.traction(time) * self.normal).sum()
    }

    /// Its rate, Pa/s.
    pub fn stress_rate(&self, time: f64) -> Vector<D> {
        self.loads.iter().map(|load| load.traction_rate(time) * self.normal).sum()
    }
}

/// The edges of a body, with the matrices that take the gradient of displacements and the divergence of the
/// stress, theory (64).
pub(in super::super) struct Edges<const D: usize> {
    pub edges: Vec<Edge<D>>,
    pub slots: Vec<Slot<D>>,
    pub gradient: ContinuedGradient<D>,
    pub divergence: ContinuedGradient<D>,
    /// Stress of loaded components in each slot at the last evaluation, Pa.
    pub stress: Vec<Vector<D>>,
    /// Slopes to start the search for slopes from.
    pub known: Vec<Vector<D>>,
    /// Slopes while they are searched for.
    pub found: Vec<Vector<D>>,
    /// The feet of ghosts in holes, whose slopes stand behind those of edges.
    pub feet: Vec<Foot<D>>,
    /// Particles on the edges of holes, with the normals there.
    pub rims: Vec<(usize, Vector<D>)>,
}

/// The edges and holes of a body, before their loads are known.
pub(in super::super) struct Outline<const D: usize> {
    pub edges: Vec<Edge<D>>,
    pub inside: Vec<Inside<D>>,
    rims: Vec<(usize, Vector<D>)>,
}

/// The edges of the box that particles fill but for holes, whose ghosts lie within `reach` m.
pub(in super::super) fn find<const D: usize>(
    particles: &Particles<D>,
    group: &[u32],
    prescribed: &PrescribedComponents,
    holes: &[Hole<D>],
    reach: f64,
) -> Result<Outline<D>, TotalLagrangianError> {
    let mut bodies: Vec<u32> = group.to_vec();
    bodies.sort_unstable();
    bodies.dedup();
    if D > 2 || bodies.len() > 1 {
        return Err(TotalLagrangianError::Strong { dimension: D, bodies: bodies.len() });
    }
    let positions = &particles.position;
    let inside = holes::sites(particles, holes, reach)?;
    let places = Places { particles, inside: &inside, slots: 0 };
    let mut edges: Vec<Edge<D>> = Vec::new();
    for axis in 0..D {
        for is_upper in [false, true] {
            let side = if is_upper { 1.0 } else { -1.0 };
            let farthest =
                positions.iter().map(|x| side * x[axis]).fold(f64::NEG_INFINITY, f64::max);
            let is_on =
                |a: &usize| farthest - side * positions[*a][axis] < ON_EDGE * particles.spacing[*a];
            let on: Vec<usize> = (0..positions.len()).filter(is_on).collect();
            let feet = feet(&places, &on, axis)?;
            let slots = on.iter().map(|&a| (a as u32, 0)).collect();
            edges.push(Edge { axis, is_upper, is_held: [false; D], feet, slots });
        }
    }
    hold(&mut edges, prescribed, particles)?;
    let slots = edges.iter_mut().flat_map(|edge| edge.slots.values_mut());
    (0u32..).zip(slots).for_each(|(number, slot)| *slot = number);
    Ok(Outline { edges, inside, rims: holes::rims(particles, holes) })
}

/// The particle of an edge across `axis` in line with each place. Where a hole has taken it, images are
/// beyond reach, but for those of ghosts in the hole, for which the next one on the edge stands.
fn feet<const D: usize>(
    places: &Places<'_, D>,
    on: &[usize],
    axis: usize,
) -> Result<Vec<u32>, TotalLagrangianError> {
    let particles = places.particles;
    let along = |a: usize| if D == 1 { 0.0 } else { places.position(a)[1 - axis] };
    let mut sorted: Vec<(f64, usize)> = on.iter().map(|&a| (along(a), a)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut feet = Vec::with_capacity(places.len());
    for a in 0..places.len() {
        let slack = ON_EDGE * particles.spacing[a.min(particles.len() - 1)];
        let next = sorted.partition_point(|(place, _)| *place < along(a) - slack);
        let near = sorted[next.saturating_sub(1)..].iter().take(2);
        let nearest = near.min_by(|x, y| (x.0 - along(a)).abs().total_cmp(&(y.0 - along(a)).abs()));
        match nearest {
            Some((place, foot)) if (place - along(a)).abs() <= slack => feet.push(*foot as u32),
            Some((_, foot)) if !places.inside.is_empty() => feet.push(*foot as u32),
            _ => return Err(gap(particles, a).into()),
        }
    }
    Ok(feet)
}

fn gap<const D: usize>(particles: &Particles<D>, a: usize) -> OperatorError {
    let position = particles.position[a].iter().copied().collect();
    OperatorError::Gap { id: particles.id[a], position }
}

/// Finds what is held. A component of a velocity that is prescribed on an edge is so between its
/// corners, which belong to two edges.
fn hold<const D: usize>(
    edges: &mut [Edge<D>],
    prescribed: &PrescribedComponents,
    particles: &Particles<D>,
) -> Result<(), TotalLagrangianError> {
    let mut is_prescribed = vec![[false; D]; particles.len()];
    prescribed.iter().for_each(|it| is_prescribed[it.particle][it.component] = true);
    for number in 0..edges.len() {
        let edge = &edges[number];
        let is_corner = |a: &u32| {
            edges.iter().any(|other| other.axis != edge.axis && other.slots.contains_key(a))
        };
        let between: Vec<u32> = edge.slots.keys().copied().filter(|a| !is_corner(a)).collect();
        if between.is_empty() {
            let corner = edge.slots.keys().next().map_or(0, |&a| a as usize);
            return Err(gap(particles, corner).into());
        }
        let mut is_held = [false; D];
        for (component, is_held) in is_held.iter_mut().enumerate() {
            let held = between.iter().filter(|&&a| is_prescribed[a as usize][component]).count();
            if held != 0 && held != between.len() {
                let missing = between.iter().find(|&&a| !is_prescribed[a as usize][component]);
                let a = missing.map_or(0, |&a| a as usize);
                return Err(TotalLagrangianError::PartOfEdge {
                    component,
                    id: particles.id[a],
                    position: particles.position[a].iter().copied().collect(),
                });
            }
            *is_held = held > 0;
        }
        edges[number].is_held = is_held;
    }
    Ok(())
}

/// Matrices of displacements and of stresses of particles with their edges and ghosts in holes at
/// `cover.particles`, whose own images are not used.
pub(in super::super) fn matrices<const D: usize>(
    cover: &Cover<'_, D>,
    edges: &[Edge<D>],
    inside: &[Inside<D>],
) -> Result<[ContinuedGradient<D>; 2], OperatorError> {
    let reach = cover.radius.iter().copied().fold(0.0, f64::max);
    let slots = edges.iter().map(|edge| edge.slots.len()).sum();
    let made = ghosts(&Places { particles: cover.particles, inside, slots }, edges, reach);
    // On an even lattice the matrix of moments is a factor an axis, by which the plain sums miss the
    // gradient of a linear field. In a row they are taken as they are, as the paper does.
    let form = if D == 1 { GradientForm::Plain } else { GradientForm::Corrected };
    let [of_displacement, of_stress] = made;
    Ok([
        ContinuedGradient::new(cover, form, &of_displacement)?,
        ContinuedGradient::new(cover, form, &of_stress)?,
    ])
}

impl<const D: usize> Edges<D> {
    /// The edges with their loads, and the loads that act elsewhere.
    pub fn new(
        outline: Outline<D>,
        [gradient, divergence]: [ContinuedGradient<D>; 2],
        tractions: &[Traction<D>],
        positions: &[Vector<D>],
        mixture_of: impl Fn(usize) -> Mixture<D>,
    ) -> Result<(Self, Vec<Loaded<D>>), TotalLagrangianError> {
        let Outline { edges, inside, rims } = outline;
        let foot = |inside: Inside<D>| {
            let mixture = mixture_of(inside.like);
            Foot::new(inside, &mixture)
        };
        let feet: Vec<Foot<D>> = inside.into_iter().map(foot).collect();
        let mut slots = Vec::new();
        for edge in &edges {
            for &particle in edge.slots.keys() {
                let mut across = [None; D];
                for other in edges.iter().filter(|other| other.axis != edge.axis) {
                    if let Some(&slot) = other.slots.get(&particle) {
                        across[other.axis] = Some(slot as usize);
                    }
                }
                slots.push(Slot {
                    particle: particle as usize,
                    axis: edge.axis,
                    is_held: edge.is_held,
                    across,
                    sought: [None; D],
                    not_zero: Tensor::zeros(),
                    normal: if edge.is_upper { 1.0 } else { -1.0 },
                    loads: Vec::new(),
                });
            }
        }
        for number in 0..slots.len() {
            let (sought, not_zero) = Slot::search(&slots, number);
            (slots[number].sought, slots[number].not_zero) = (sought, not_zero);
        }
        let mut elsewhere = Vec::new();
        for traction in tractions {
            let is_whole =
                |edge: &&Edge<D>| traction.particles.iter().all(|a| edge.slots.contains_key(a));
            let whole = edges.iter().find(is_whole);
            for load in traction.loaded(positions) {
                let a = load.particle as u32;
                let mut of = edges.iter().filter(|edge| edge.slots.contains_key(&a));
                let own = whole.or_else(|| of.next().filter(|_| of.next().is_none()));
                match own.and_then(|edge| edge.slots.get(&a)) {
                    Some(&slot) => slots[slot as usize].loads.push(load),
                    None if D == 1 => elsewhere.push(load),
                    None => {
                        return Err(TotalLagrangianError::NoEdge { name: traction.name.clone() });
                    }
                }
            }
        }
        let stress = vec![Vector::zeros(); slots.len()];
        let found = vec![Vector::zeros(); slots.len() + feet.len()];
        let known = found.clone();
        let all = Self { edges, slots, gradient, divergence, stress, known, found, feet, rims };
        Ok((all, elsewhere))
    }

    /// Number of data: values and slopes at edges, and slopes at the feet of ghosts in holes.
    pub fn data(&self) -> usize {
        self.slots.len() + self.feet.len()
    }

    /// The particles that have a part in the gradient of particle `a`, without itself.
    pub fn neighborhood(&self, a: usize) -> Vec<u32> {
        self.gradient.row(a).into_iter().filter(|&b| b as usize != a).collect()
    }

    /// What of `stress` edges say, in place: shear along edges that are held is zero, the load is all of
    /// the stress across, and there is none across the edge of a hole.
    pub fn overwrite(&self, stress: &mut [Tensor<D>], scale: impl Fn(usize) -> f64) {
        for slot in &self.slots {
            for i in (0..D).filter(|&i| slot.is_held[i]) {
                (0..D)
                    .filter(|&t| t != slot.axis)
                    .for_each(|t| stress[slot.particle][(i, t)] = 0.0);
            }
        }
        for (slot, load) in self.slots.iter().zip(&self.stress) {
            for i in slot.loaded() {
                stress[slot.particle][(i, slot.axis)] = load[i] * scale(slot.particle);
            }
        }
        for (particle, normal) in &self.rims {
            let across = stress[*particle] * normal;
            stress[*particle] -= across * normal.transpose();
        }
    }

    /// Forces in N of tensions in J, and of the stresses in Pa of loads: `V div P`.
    pub fn forces(
        &self,
        tension: &[Tensor<D>],
        load: &[Vector<D>],
        volume: &[f64],
        force: &mut [Vector<D>],
    ) {
        let count = volume.len();
        let field = |b: usize| match b.checked_sub(count) {
            None => tension[b] / volume[b],
            Some(slot) => Tensor::from_fn(|i, _| load[slot][i]),
        };
        parallel::for_each_chunk(force, |first, force| {
            for (offset, force) in force.iter_mut().enumerate() {
                let a = first + offset;
                *force = self.divergence.divergence_of(field, a) * volume[a];
            }
        });
    }
}
