//! Several systems in one case.

use super::{
    Body, Boundary, Case, Initial, Lattice, LatticeKind, LatticeOrigin, Load, LoadKind, Material,
    Probe, Scheme, Time, Wall,
};
use crate::case::expression::Expression;
use crate::case::source::Located;
use crate::schemes::transport_velocity::Slip;
use crate::schemes::world::ContactLaw;

/// A formulation in addition to the main one, for bodies that name it: a solid in a fluid.
#[derive(Clone, Debug)]
pub struct System {
    /// Unique name.
    pub name: Located<String>,
    /// The formulation with its settings.
    pub scheme: Located<Scheme>,
    /// How it takes its steps.
    pub time: Time,
    /// The slip condition at its surface.
    pub slip: Slip,
    /// Its contact with walls and other systems.
    pub contact: ContactLaw,
}

impl Case {
    /// The case of one of its systems alone: its bodies with what acts on them and what is recorded of
    /// them. In that of the main one (`None`) bodies of the others are walls of its material and spacing,
    /// under the same numbers; in the others bodies have the numbers of [`Self::bodies_of`].
    pub fn part(&self, system: Option<usize>) -> Self {
        let numbers = self.bodies_of(system);
        let number = |body: &Located<usize>| {
            let own = numbers.iter().position(|known| *known == body.value)?;
            Some(Located::new(own, body.place))
        };
        let is_own = |body: &Option<Located<usize>>| match body {
            Some(body) => self.bodies[body.value].system == system,
            None => system.is_none(),
        };
        let loads = self.loads.iter().filter(|load| {
            is_own(&load.body)
                || (load.body.is_none() && matches!(load.kind, LoadKind::BodyForce { .. }))
        });
        let boundaries = self.boundaries.iter().filter(|boundary| is_own(&boundary.body));
        let probes = self.probes.iter().filter(|probe| is_own(&probe.body));
        let own = system.map(|system| &self.systems[system]);
        Self {
            bodies: numbers.iter().map(|&number| self.body_in(number, system)).collect(),
            scheme: own.map_or_else(|| self.scheme.clone(), |own| own.scheme.clone()),
            time: own.map_or_else(|| self.time.clone(), |own| own.time.clone()),
            loads: loads
                .map(|load| Load { body: load.body.as_ref().and_then(number), ..load.clone() })
                .collect(),
            boundaries: boundaries
                .map(|it| Boundary { body: it.body.as_ref().and_then(number), ..it.clone() })
                .collect(),
            probes: probes
                .map(|it| Probe { body: it.body.as_ref().and_then(number), ..it.clone() })
                .collect(),
            systems: Vec::new(),
            ..self.clone()
        }
    }

    /// The numbers of the bodies that are in the case of a system alone: all in that of the main one.
    pub fn bodies_of(&self, system: Option<usize>) -> Vec<usize> {
        let is_in = |body: &Body| system.is_none() || body.system == system;
        let bodies = self.bodies.iter().enumerate();
        bodies.filter(|(_, body)| is_in(body)).map(|(number, _)| number).collect()
    }

    /// The first body of fluid, or wall, with a spacing of its own, which solids are walls to the fluid with: points from a
    /// file have none.
    pub fn spaced_fluid(&self) -> Option<&Body> {
        let is_fluid = |body: &&Body| {
            body.system.is_none() && matches!(*body.material, Material::WeaklyCompressible { .. })
        };
        self.bodies.iter().filter(is_fluid).find(|body| !body.spacing.is_empty())
    }

    /// A body as a system sees it: its own are those of the main one then.
    fn body_in(&self, number: usize, system: Option<usize>) -> Body {
        let body = &self.bodies[number];
        let (None, Some(other)) = (system, body.system) else {
            return Body { system: None, ..body.clone() };
        };
        let Some(fluid) = self.spaced_fluid() else { return body.clone() };
        let zero = || vec![Expression::constant(0.0); self.dimension];
        let wall = Wall { slip: self.systems[other].slip, sliding: Vec::new() };
        Body {
            material: fluid.material.clone(),
            spacing: fluid.spacing.clone(),
            lattice: Lattice {
                kind: match body.lattice.kind {
                    LatticeKind::Packed => LatticeKind::Packed,
                    _ => LatticeKind::Square,
                },
                on: LatticeOrigin::Cells,
                jitter: 0.0,
                seed: 0,
                relax: 0,
            },
            initial: Initial {
                place: body.initial.place,
                velocity: zero(),
                displacement: zero(),
                pressure: Expression::constant(0.0),
            },
            wall: Some(Located::new(wall, self.systems[other].name.place)),
            ..body.clone()
        }
    }
}
