//! Bodies that are one where their particles share places.

use std::collections::BTreeMap;

use crate::Vector;
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborError, search};
use crate::schemes::total_lagrangian::{Material, Mixture};

/// Particles that are closer than this share of their spacing are at one place.
pub(super) const SAME_PLACE: f64 = 1e-6;

/// Which particles of different bodies lie at one place, where the bodies are joined.
pub(super) struct Joined {
    /// Index of a particle that stays, and of one that goes into it, before they are ordered.
    pairs: Vec<(u32, u32)>,
    /// By id of the particle that stays: bodies with their volumes.
    parts: BTreeMap<u32, Vec<(u32, f64)>>,
    /// Number of the group of joined bodies of each body.
    group: Vec<u32>,
    /// Whether a body is rigid: it holds the particles that it shares, and is not seen by others.
    is_rigid: Vec<bool>,
}

impl Joined {
    /// No bodies that are joined.
    pub fn none(is_rigid: Vec<bool>) -> Self {
        let group = (0..is_rigid.len() as u32).collect();
        Self { pairs: Vec::new(), parts: BTreeMap::new(), group, is_rigid }
    }

    /// The number of the group that a particle sees.
    pub fn groups<const D: usize>(&self, particles: &Particles<D>) -> Vec<u32> {
        let of = |a: usize| {
            let (body, id) = (particles.body[a], particles.id[a]);
            let shared = self.parts.get(&id);
            let mut bodies = shared.into_iter().flatten().map(|it| it.0);
            let deformed = bodies.find(|&body| !self.is_rigid[body as usize]);
            self.group[deformed.unwrap_or(body) as usize]
        };
        (0..particles.len()).map(of).collect()
    }

    /// Those whose particles share places.
    pub fn find<const D: usize>(
        particles: &Particles<D>,
        domain: &Domain<D>,
        is_rigid: Vec<bool>,
    ) -> Result<Self, NeighborError> {
        let mut joined = Self::none(is_rigid);
        if joined.group.len() < 2 {
            return Ok(joined);
        }
        let radii: Vec<f64> =
            particles.spacing.iter().map(|spacing| SAME_PLACE * spacing).collect();
        let list = search(&particles.position, &radii, domain)?;
        let mut is_gone = vec![false; particles.len()];
        for a in 0..particles.len() {
            if is_gone[a] {
                continue;
            }
            let mut parts = vec![(particles.body[a], particles.volume[a])];
            for &b in list.row(a) {
                let other = particles.body[b as usize];
                if b as usize > a && !is_gone[b as usize] && other != particles.body[a] {
                    is_gone[b as usize] = true;
                    joined.pairs.push((a as u32, b));
                    parts.push((other, particles.volume[b as usize]));
                }
            }
            // Those that deform see each other.
            let deformed = parts.iter().filter(|(body, _)| !joined.is_rigid[*body as usize]);
            let groups: Vec<u32> = deformed.map(|(body, _)| joined.group[*body as usize]).collect();
            if let Some(&low) = groups.iter().min() {
                let is_joined = |group: &&mut u32| groups.contains(group);
                joined.group.iter_mut().filter(is_joined).for_each(|group| *group = low);
            }
            if parts.len() > 1 {
                joined.parts.insert(particles.id[a], parts);
            }
        }
        Ok(joined)
    }

    /// Whether two bodies share a particle.
    pub fn share(&self, one: u32, other: u32) -> bool {
        let has = |parts: &[(u32, f64)], body| parts.iter().any(|(own, _)| *own == body);
        self.parts.values().any(|parts| has(parts, one) && has(parts, other))
    }

    /// Whether a particle that stays, by its id, has a part of a body.
    pub fn has_part_of(&self, id: u32, body: u32) -> bool {
        self.parts.get(&id).is_some_and(|parts| parts.iter().any(|(own, _)| *own == body))
    }

    /// Makes one particle of those at one place, with the sum of their volumes and areas.
    pub fn merge<const D: usize>(
        &self,
        particles: &mut Particles<D>,
        mut areas: Option<&mut Vec<Vector<D>>>,
    ) {
        if self.pairs.is_empty() {
            return;
        }
        if let Some(areas) = areas.as_deref_mut() {
            for &(a, b) in &self.pairs {
                let more = areas[b as usize];
                areas[a as usize] += more;
            }
        }
        let order = particles.join(&self.pairs);
        if let Some(areas) = areas {
            *areas = order.iter().map(|&a| areas[a as usize]).collect();
        }
    }

    /// What particles are made of: the material of their body, or shares of several.
    pub fn mixtures<const D: usize>(
        &self,
        particles: &Particles<D>,
        materials: &[Material<D>],
    ) -> (Vec<Mixture<D>>, Vec<u32>) {
        let mut mixtures = Mixture::of_each(materials);
        let mut mixture = particles.body.clone();
        for (id, parts) in &self.parts {
            let whole: f64 = parts.iter().map(|(_, volume)| volume).sum();
            let made = Mixture(
                parts
                    .iter()
                    .map(|&(body, volume)| (materials[body as usize].clone(), volume / whole))
                    .collect(),
            );
            let known = mixtures.iter().position(|known| *known == made);
            let number = known.unwrap_or_else(|| {
                mixtures.push(made);
                mixtures.len() - 1
            });
            if let Some(a) = particles.id.iter().position(|known| known == id) {
                mixture[a] = number as u32;
            }
        }
        (mixtures, mixture)
    }
}
