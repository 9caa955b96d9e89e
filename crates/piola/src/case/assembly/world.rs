//! Several systems built one by one and put together.

use super::bodies::{self, BodyReport};
use super::overlap::REMEDY;
use super::{Built, Parts, beyond_stable, domain, fluids, integrator, layers, probes, system};
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case, Material, StepControl};
use crate::schemes::world::{InterfaceError, SolidInput, World, WorldError};
use crate::schemes::{Scheme, boxed};
use crate::time::{Coupled, Integrator};

/// Builds a fluid with solids in it.
pub(super) fn build<const D: usize>(case: &Case) -> Result<Parts, Vec<Problem>> {
    if let (None, Some(points)) =
        (case.spaced_fluid(), case.bodies.iter().find(|body| body.system.is_none()))
    {
        let message = "points have no spacing, with which solids are walls to the fluid";
        let help = "describe the fluid by shapes, or give it a wall that has a spacing".to_owned();
        let problem = case.problem_at(points.shape.place, message, "no spacing", Some(help));
        return Err(vec![problem]);
    }
    let main = case.part(None);
    let domain = domain::<D>(&main)?;
    let thin = layers::check(case, &main, &domain)?;
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
    let (mut fluid, built) = fluids::build_fluid(&main, settings, particles, reports, domain)?;
    let warnings = [built.warnings, far, thin, unheld(&main).into_iter().collect()].concat();
    let mut all = vec![Built { warnings, ..built }];
    let beat = Beat::of(&main, &mut fluid);
    let (mut solids, mut integrators) = (Vec::new(), Vec::<Box<dyn Integrator>>::new());
    for (number, named) in case.systems.iter().enumerate() {
        let mut part = case.part(Some(number));
        let note = beat.and_then(|beat| beat.calm(&mut part));
        let (mut scheme, mut built) = system::<D>(&part)?;
        built.notes.extend(note);
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
                "bring the two spacings within a factor of 3"
            }
            WorldError::Interface { .. } => "use a smaller spacing for the solid",
            WorldError::Motion { .. } => "use `total_lagrangian`",
        };
        vec![case.problem_at(place, error.to_string(), "of this system", Some(help.to_owned()))]
    })?;
    let built = together(case, all, &world);
    Ok((boxed(world), Box::new(Coupled::new(integrators)), built))
}

/// The steps of a fluid, in which its forces change at once for all of the own steps that solids take in one of them.
#[derive(Clone, Copy)]
struct Beat {
    /// Their length in s, as the fluid is at the start.
    step: f64,
    density: f64,
    wave_speed: f64,
    spacing: f64,
}

/// The relaxation time that keeps vibrations of a solid from growing, over the step of the fluid and the square of the phase
/// of a layer of it on the stiffness of the fluid in that step, theory (82). From 1.82 of `1/pi^3` on none grows.
const CALMING: f64 = 2.0 / (std::f64::consts::PI * std::f64::consts::PI * std::f64::consts::PI);

/// The longest time of relaxation of shear over the step of the fluid: by `2 pi^2 / 100` times that a mode of a hundred steps
/// loses of its amplitude in a period, which is 1 % then.
const MOST_RELAXATION: f64 = 0.05;

impl Beat {
    /// That of the fluid of a case; none without a fluid that has waves.
    fn of(main: &Case, fluid: &mut impl Scheme) -> Option<Self> {
        let bodies = || main.bodies.iter().filter(|body| body.system.is_none());
        let body =
            bodies().find(|body| matches!(*body.material, Material::WeaklyCompressible { .. }))?;
        let density = body.material.density();
        let wave_speed = (body.material.bulk_modulus(main.dimension) / density).sqrt();
        let mut limits = Vec::new();
        fluid.inspect(&fluid.initial_state(), &mut limits);
        let stable = |number: f64| {
            let own =
                limits.iter().map(|limit| limit.step * if limit.scaled { number } else { 1.0 });
            own.fold(f64::INFINITY, f64::min)
        };
        let step = match *main.time.step {
            StepControl::Cfl(number) => stable(number),
            StepControl::Fixed(step) | StepControl::AtMost(step) => step,
        };
        let spacing = body.spacing.iter().copied().fold(0.0, f64::max);
        (step < f64::INFINITY && spacing > 0.0).then_some(Self {
            step,
            density,
            wave_speed,
            spacing,
        })
    }

    /// Makes the solid of a case viscous, as little as keeps the steps of the fluid from driving its vibrations, theory (82),
    /// where it is elastic, takes explicit steps, has waves that cross its spacing within a step of the fluid, and does not say
    /// how viscous it is, unless a mode of a hundred steps of the fluid would lose more than a hundredth of its amplitude in
    /// a period by it, where it shears or bends. What to tell of it.
    fn calm(&self, part: &mut Case) -> Option<String> {
        if part.time.rule.is_some() || !matches!(*part.time.step, StepControl::Cfl(_)) {
            return None;
        }
        let model::Scheme::TotalLagrangian(settings) = &mut part.scheme.value else { return None };
        if settings.says_viscosity {
            return None;
        }
        let dimension = part.dimension;
        // Viscosity that it takes, and which it bears.
        let of = |body: &model::Body| {
            let Material::Hyperelastic { density, law, plane, .. } = &*body.material else {
                return [0.0, f64::INFINITY];
            };
            let constants = law.small_strain();
            let modulus = plane.pressure_wave_modulus(&constants, dimension);
            let bears = MOST_RELAXATION * self.step * constants.mu;
            let spacings = body.spacing.iter().copied();
            let spacing = spacings.fold(f64::INFINITY, f64::min);
            if (modulus / density).sqrt() * self.step <= spacing {
                return [0.0, bears];
            }
            let layer = body.spacing.iter().copied().fold(self.spacing, f64::max);
            let number = self.wave_speed * self.step;
            let relaxation = CALMING * self.step * self.density / density * number * number
                / (self.spacing * layer);
            [0.5 * relaxation * modulus, bears]
        };
        let [viscosity, most] = (part.bodies.iter().map(of))
            .fold([0.0, f64::INFINITY], |[takes, bears], of| [of[0].max(takes), of[1].min(bears)]);
        let is_stiff = viscosity > 0.0 && viscosity < f64::INFINITY;
        let shown = crate::output::significant(viscosity, 3);
        is_stiff.then(|| {
            if viscosity > most {
                return format!(
                    "nothing damps its vibrations, which the steps of the fluid may drive slowly, theory (82): a \
                     `scheme.viscosity` of {shown} Pa s would damp them, but also takes more than 1 % per period from \
                     its slow bending vibrations; watch its energy over long runs, or take implicit steps"
                );
            }
            settings.dissipation.value.viscosity = viscosity;
            format!(
                "`scheme.viscosity` is {shown} Pa s, the least that keeps the steps of the fluid from driving its \
                 vibrations, theory (82); a value of its own, or 0, replaces that"
            )
        })
    }
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
            "nothing holds the fluid `{}`: there is no wall, no opening, no periodic axis and no body force, so it \
             keeps its initial motion except where solids push it; add a wall, make the domain periodic, or add \
             a `[[load]]` of the kind `body_force`",
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
        all.notes.extend(part.notes.iter().map(|text| format!("system `{name}`: {text}")));
        let bodies: Vec<BodyReport> = part.bodies;
        for (body, report) in case.bodies_of(Some(number)).into_iter().zip(bodies) {
            all.bodies[body] = report;
        }
    }
    all
}
