//! Several systems built one by one and put together.

use super::bodies::{self, BodyReport};
use super::overlap::REMEDY;
use super::{Built, Parts, beyond_stable, domain, fluids, integrator, probes, system};
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case, StepControl};
use crate::schemes::world::{InterfaceError, SolidInput, World, WorldError};
use crate::time::{Coupled, Integrator};

/// Builds a fluid with solids in it.
pub(super) fn build<const D: usize>(case: &Case) -> Result<Parts, Vec<Problem>> {
    let main = case.part(None);
    let domain = domain::<D>(&main)?;
    let (particles, reports) = bodies::particles::<D>(&main, &domain)?;
    let far = probes::far(&main, &particles);
    let model::Scheme::TransportVelocity(settings) = &main.scheme.value else {
        // The reader of cases has refused others.
        return Err(vec![case.problem_at(case.scheme.place, "no fluid", "needs one", None)]);
    };
    if let Some(region) = settings.refine.first() {
        let message = "a fluid with solids in it has one spacing";
        let help = Some("remove `refine`".to_owned());
        return Err(vec![case.problem_at(region.place, message, "no meaning here", help)]);
    }
    let (fluid, built) = fluids::build_fluid(&main, settings, particles, reports, domain)?;
    let warnings = [built.warnings, far, unheld(&main).into_iter().collect()].concat();
    let mut all = vec![Built { warnings, ..built }];
    let (mut solids, mut integrators) = (Vec::new(), Vec::<Box<dyn Integrator>>::new());
    for (number, named) in case.systems.iter().enumerate() {
        let part = case.part(Some(number));
        let (mut scheme, mut built) = system::<D>(&part)?;
        built.warnings.extend(beyond_stable(&part));
        integrators.push(integrator(&part, scheme.as_mut())?);
        let numbers = case.bodies_of(Some(number)).into_iter().map(|body| body as u32);
        let numbers: Vec<u32> = numbers.collect();
        let spacings = built.bodies.iter().flat_map(|body| body.spacing.iter().copied());
        solids.push(SolidInput {
            name: named.name.value.clone(),
            scheme,
            spacing: spacings.fold(0.0, f64::max),
            bodies: numbers.clone(),
            numbers,
            law: named.contact,
            cfl: match *named.time.step {
                StepControl::Cfl(number) => Some(number),
                _ => None,
            },
        });
        all.push(built);
    }
    let cfl = match *main.time.step {
        StepControl::Cfl(number) => Some(number),
        _ => None,
    };
    let world = World::new(fluid, cfl, solids, &domain).map_err(|error| {
        let place = match &error {
            WorldError::Interface { solid, .. } => case.systems[*solid].name.place,
            WorldError::Motion { system, .. } | WorldError::Overlap { system, .. } => {
                let named = case.systems.iter().find(|known| *known.name == *system);
                named.map_or(case.scheme.place, |system| system.scheme.place)
            }
        };
        let help = match &error {
            WorldError::Overlap { .. } => REMEDY,
            WorldError::Interface { error: InterfaceError::Spacings { .. }, .. } => {
                "make the two spacings more alike"
            }
            WorldError::Interface { .. } => "use a smaller spacing for the solid",
            WorldError::Motion { .. } => "use `total_lagrangian`",
        };
        vec![case.problem_at(place, error.to_string(), "of this system", Some(help.to_owned()))]
    })?;
    let built = together(case, all, &world);
    Ok((Box::new(world), Box::new(Coupled::new(integrators)), built))
}

/// A warning of a fluid that only solids could hold or move.
fn unheld(main: &Case) -> Option<String> {
    let bounds = |body: &model::Body| body.wall.is_some() || body.opening.is_some();
    let fluid = main.bodies.iter().find(|body| !bounds(body))?;
    let is_held = main.bodies.iter().any(|body| body.system.is_none() && bounds(body))
        || main.domain.periodic.iter().any(Option::is_some)
        || main.loads.iter().any(|load| matches!(load.kind, model::LoadKind::BodyForce { .. }));
    (!is_held).then(|| {
        format!(
            "nothing holds the fluid `{}`: there is no wall, no opening, no periodic axis and no body force, so that it \
             goes on as it starts but for what solids do to it; add a wall, make the domain periodic, or add a \
             `[[load]]` of the kind `body_force`",
            fluid.name.value
        )
    })
}

/// What has been built of all systems, with particles by their index in the run.
fn together<const D: usize>(case: &Case, parts: Vec<Built>, world: &World<D>) -> Built {
    let mut parts = parts.into_iter().enumerate().map(|(system, mut part)| {
        let index = |particle: u32| world.index_of(system, particle);
        part.probes.iter_mut().for_each(|probe| probe.renumber(&index));
        part.lines.iter_mut().for_each(|line| line.values.renumber(&index));
        part.poorly_supported = part.poorly_supported.into_iter().filter_map(index).collect();
        part
    });
    let mut all = parts.next().expect("there is a fluid");
    for (number, part) in parts.enumerate() {
        all.probes.extend(part.probes);
        all.lines.extend(part.lines);
        all.poorly_supported.extend(part.poorly_supported);
        let name = &case.systems[number].name.value;
        all.warnings.extend(part.warnings.iter().map(|text| format!("system `{name}`: {text}")));
        let bodies: Vec<BodyReport> = part.bodies;
        for (body, report) in case.bodies_of(Some(number)).into_iter().zip(bodies) {
            all.bodies[body] = report;
        }
    }
    all
}
