//! What acts on bodies: body forces, tractions and pressures.

use std::cell::OnceCell;

use super::bodies::{self, vector};
use super::selections::{self, Selection, not_empty, over_time, selection, trace_numbers};
use crate::Vector;
use crate::boundaries::{BodyForce, FollowerPressure, Spring, Traction};
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case, LoadKind};
use crate::case::source::{Located, Place};
use crate::geometry::Particles;
use crate::neighbors::Domain;
use crate::operators::{Trace, exposed_areas};

/// The body forces.
pub(super) fn body_forces<const D: usize>(case: &Case) -> Vec<BodyForce<D>> {
    let mut forces = Vec::new();
    for load in &case.loads {
        if let LoadKind::BodyForce { acceleration } = &load.kind {
            forces.push(BodyForce {
                body: load.body.as_ref().map(|body| body.value as u32),
                acceleration: std::array::from_fn(|k| {
                    over_time(&acceleration[k], load.history.as_ref())
                }),
            });
        }
    }
    forces
}

/// The surface of the bodies as loads see it. On bodies from meshes these are faces, which nodes
/// share and centres of cells by their trace; on others the boundary areas of particles, which are
/// asked for where there is a load on them.
pub(super) struct LoadedSurface<'a, const D: usize, F> {
    case: &'a Case,
    particles: &'a Particles<D>,
    domain: &'a Domain<D>,
    trace: Option<&'a Trace<D>>,
    find_areas: F,
    areas: OnceCell<Result<Vec<Vector<D>>, String>>,
}

/// A share of a load on one particle.
struct Share<const D: usize> {
    particle: u32,
    /// Its part of the load on an area; by the trace of a face it may be negative.
    share: f64,
    /// Outward area vector in m^(D-1) of what is shared.
    area: Vector<D>,
    place: Vector<D>,
}

impl<'a, const D: usize, F: Fn() -> Result<Vec<Vector<D>>, String>> LoadedSurface<'a, D, F> {
    /// The surface with the outward boundary area vectors of particles in m^(D-1), or why there are
    /// none.
    pub fn new(
        case: &'a Case,
        particles: &'a Particles<D>,
        domain: &'a Domain<D>,
        trace: Option<&'a Trace<D>>,
        find_areas: F,
    ) -> Self {
        Self { case, particles, domain, trace, find_areas, areas: OnceCell::new() }
    }

    /// The tractions: on particles with the part of each area that points along the normal of the
    /// region.
    pub fn tractions(&self, problems: &mut Vec<Problem>) -> Vec<Traction<D>> {
        let mut tractions = Vec::new();
        for load in &self.case.loads {
            let LoadKind::Traction { region, traction } = &load.kind else { continue };
            let Some(shares) = self.loaded(load, region, problems) else { continue };
            tractions.push(Traction {
                name: name(load, "traction"),
                particles: shares.iter().map(|it| it.particle).collect(),
                areas: shares.iter().map(|it| it.share * it.area.norm()).collect(),
                places: shares.iter().map(|it| it.place).collect(),
                value: std::array::from_fn(|k| over_time(&traction[k], load.history.as_ref())),
            });
        }
        tractions
    }

    /// The springs.
    pub fn springs(&self, problems: &mut Vec<Problem>) -> Vec<Spring<D>> {
        let mut springs = Vec::new();
        for load in &self.case.loads {
            let model::LoadKind::Spring { region, to, stiffness, damping, length } = &load.kind
            else {
                continue;
            };
            let body = load.body.as_ref();
            let particles = selections::select(self.case, self.particles, region, body, problems);
            let anchor = vector::<D>(to);
            let places = particles.iter().map(|&a| self.particles.position[a as usize]);
            // Particles of a lattice weigh what their volume is.
            let volumes = || particles.iter().map(|&a| self.particles.volume[a as usize]);
            let whole: f64 = volumes().sum();
            let centre = places.zip(volumes()).map(|(place, volume)| place * (volume / whole));
            let centre = centre.sum::<Vector<D>>();
            springs.push(Spring {
                name: name(load, "spring"),
                length: length.unwrap_or((centre - anchor).norm()),
                stiffness: *stiffness,
                damping: *damping,
                particles,
                anchor,
            });
        }
        springs
    }

    /// The pressures: on particles in a plane with the part of each area that points along its
    /// normal, on those of other regions with all of it.
    pub fn pressures(&self, problems: &mut Vec<Problem>) -> Vec<FollowerPressure<D>> {
        let mut pressures = Vec::new();
        for load in &self.case.loads {
            let LoadKind::Pressure { region, pressure } = &load.kind else { continue };
            let Some(shares) = self.loaded(load, region, problems) else { continue };
            pressures.push(FollowerPressure {
                name: name(load, "pressure"),
                particles: shares.iter().map(|it| it.particle).collect(),
                areas: shares.iter().map(|it| it.area * it.share).collect(),
                places: shares.iter().map(|it| it.place).collect(),
                value: over_time(pressure, load.history.as_ref()),
            });
        }
        pressures
    }

    /// What of the surface is in the region of a load, of faces and of particles; a problem if that
    /// is nothing.
    fn loaded(
        &self,
        load: &model::Load,
        region: &Located<model::Region>,
        problems: &mut Vec<Problem>,
    ) -> Option<Vec<Share<D>>> {
        let found = self.parts(region, load.body.as_ref(), problems)?;
        let mut shares = self.shares(&found.faces);
        if found.particles.is_empty() {
            return Some(shares);
        }
        let is_plane = matches!(&region.value, model::Region::Plane { .. });
        if !is_plane && matches!(load.kind, LoadKind::Traction { .. }) {
            // The area vectors of edges and corners are sums over sides, and shorter than their areas.
            problems.push(self.case.problem_at(
                region.place,
                "a traction needs a plane, whose normal tells the loaded side",
                "not a plane",
                Some("use where = { kind = \"plane\", point = .., normal = .. }".into()),
            ));
            return None;
        }
        let areas = self.facing(region, &found.particles, problems)?;
        let own = found.particles.iter().zip(areas).filter(|(_, area)| area.amax() > 0.0);
        let place = |a: u32| self.particles.position[a as usize];
        let own = own.map(|(&particle, area)| Share {
            particle,
            share: 1.0,
            area,
            place: place(particle),
        });
        shares.extend(own);
        if shares.is_empty() {
            let help = match is_plane {
                true => {
                    "select particles on the surface, with a normal that points out of the body"
                }
                false => "select particles on the surface of a body",
            };
            problems.push(self.case.problem_at(
                region.place,
                "none of the particles of this region lies on the boundary",
                "nothing to load",
                Some(help.into()),
            ));
            return None;
        }
        Some(shares)
    }

    /// The faces of bodies from meshes in a region, and the particles of others; a problem if there
    /// is neither.
    fn parts(
        &self,
        region: &Located<model::Region>,
        body: Option<&Located<usize>>,
        problems: &mut Vec<Problem>,
    ) -> Option<Selection> {
        let Self { case, particles, .. } = self;
        let mut found = selection(case, particles, region, body, problems)?;
        let selected = found.particles.len();
        let is_of_mesh =
            |a: u32| particles.surface.bodies.contains_key(&particles.body[a as usize]);
        found.particles.retain(|&a| !is_of_mesh(a));
        if found.faces.is_empty() && found.particles.is_empty() {
            match selected > 0 {
                true => problems.push(case.problem_at(
                    region.place,
                    "this region selects particles, but no face of the boundary",
                    "nothing to load",
                    Some("select faces: a plane, a set of faces, or a box around them".into()),
                )),
                false => not_empty(case, particles, region, &found.particles, problems),
            }
            return None;
        }
        Some(found)
    }

    /// What of the areas of particles in a region is loaded: along the normal of a plane, else all.
    fn facing(
        &self,
        region: &Located<model::Region>,
        selected: &[u32],
        problems: &mut Vec<Problem>,
    ) -> Option<Vec<Vector<D>>> {
        let areas = self.areas(region.place, problems)?;
        let own = selected.iter().map(|&a| areas[a as usize]);
        Some(match &region.value {
            model::Region::Plane { normal, .. } => {
                let normal = vector::<D>(normal).normalize();
                own.map(|area| normal * area.dot(&normal).max(0.0)).collect()
            }
            _ => own.collect(),
        })
    }

    fn areas(&self, place: Place, problems: &mut Vec<Problem>) -> Option<&[Vector<D>]> {
        match self.areas.get_or_init(|| (self.find_areas)().and_then(|it| self.faced(it))) {
            Ok(areas) => Some(areas),
            Err(message) => {
                let problem = self.case.problem_at(place, message.clone(), "loaded here", None);
                problems.push(problem);
                None
            }
        }
    }

    /// The areas with those of the exposed faces where particles are centres of the cells of a
    /// lattice.
    fn faced(&self, mut areas: Vec<Vector<D>>) -> Result<Vec<Vector<D>>, String> {
        for (number, body) in (0u32..).zip(&self.case.bodies) {
            let lattice = &body.lattice;
            let is_of_cells = (lattice.kind, lattice.on)
                == (model::LatticeKind::Square, model::LatticeOrigin::Cells);
            if body.shape.value.is_from_file() || !is_of_cells {
                continue;
            }
            let still = bodies::lattice(self.case, body, self.domain, 0.0)
                .map_err(|problem| problem.message)?;
            let edges = &still.actual_spacing;
            let exposed =
                exposed_areas(&still.particles.position, edges, &still.rotation, self.domain);
            let own = || (0..areas.len()).filter(|&a| self.particles.body[a] == number);
            // Ids count in the order of creation, body after body.
            let first = own().map(|a| self.particles.id[a]).min().unwrap_or(0);
            for a in own().collect::<Vec<_>>() {
                let site = (self.particles.id[a] - first) as usize;
                areas[a] = exposed.get(site).copied().unwrap_or_else(Vector::zeros);
            }
        }
        Ok(areas)
    }

    /// What faces of meshes hand on to particles.
    fn shares(&self, faces: &[u32]) -> Vec<Share<D>> {
        let numbers = trace_numbers(self.particles);
        let mut all = Vec::new();
        for &face in faces {
            // Where there is a trace, a load on a face acts by it on the support of its cell.
            let traced =
                self.trace.zip(numbers[face as usize]).map(|(trace, f)| trace.row(f as usize));
            for sample in self.particles.surface.faces[face as usize].samples() {
                for &(particle, share) in traced.as_ref().unwrap_or(&sample.shares) {
                    all.push(Share { particle, share, area: sample.area, place: sample.place });
                }
            }
        }
        all
    }
}

fn name(load: &model::Load, usual: &str) -> String {
    load.name.as_ref().map_or(usual.into(), |name| name.value.clone())
}
