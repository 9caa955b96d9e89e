//! The scheme `transport_velocity`, walls, and what of a case fits to which scheme.

use piola_formulas::hyperelastic::HyperelasticLaw;
use piola_formulas::volumetric::VolumetricLaw;

use super::*;
use crate::case::model::{
    Body, Boundary, Material, OpenFlow, Opening, Profile, Region, TransportVelocity, Wall,
};
use crate::schemes::transport_velocity::{
    AtSurface, Contact, Corrections, DensityRule, Gradients, PressureRule, Settings, Shifting,
    Slip, Viscous,
};

/// Factor of the diffusivity of the pressure, CTVF (24), of fluids and of solids, unless the case has
/// one. With that of fluids the pressure crosses a plate within a hundredth of its period.
const DIFFUSION: [f64; 2] = [0.5, 0.001];

/// Keys of the scheme that say what solids do.
const OF_SOLIDS: [&str; 3] = ["contact", "contact_stiffness", "self_contact"];

impl Reader<'_, '_> {
    /// Settings of the scheme `transport_velocity`.
    pub(super) fn transport_velocity(&mut self, record: &Record) -> Option<TransportVelocity> {
        let is_solid = self.names.current.is_solid;
        for key in OF_SOLIDS.iter().filter(|_| !is_solid) {
            self.meaningless(record, key, "for fluids");
        }
        if is_solid {
            self.meaningless(record, "viscous_force", "for solids");
            self.meaningless(record, "damping", "for solids");
            self.meaningless(record, "density_relaxation", "for solids");
            self.meaningless(record, "refine", "for solids");
            self.meaningless(record, "velocity_diffusion", "for solids");
        }
        let corrected_gradients = record.boolean("corrected_gradients").unwrap_or(false);
        let of_fluid = match corrected_gradients && !is_solid {
            true => Settings::CORRECTED,
            false => Settings::FLUID,
        };
        let gradients = self.gradients(record, of_fluid)?;
        let relaxes = record.boolean("free_surface") == Some(true);
        if !is_solid && !relaxes {
            self.meaningless(record, "density_relaxation", "without `free_surface = true`");
        } else if !is_solid && record.text("shifting")?.as_str() != "spst" {
            self.meaningless(record, "density_relaxation", "without `shifting = \"spst\"`");
        } else if !is_solid && record.text("density")?.as_str() == "summation" {
            self.meaningless(record, "density_relaxation", "with `density = \"summation\"`");
        }
        let alpha = record.number("pressure_diffusion").map(|it| it.value);
        let alpha = alpha.unwrap_or(DIFFUSION[usize::from(is_solid)]);
        let pressure = record.text("pressure");
        let edac = pressure.as_ref().map_or(!is_solid, |pressure| pressure.as_str() == "edac");
        let density = record.text("density")?;
        if is_solid && density.as_str() == "summation" {
            let message = "the density of solids is found by the continuity equation";
            let problem = Problem::new(density.place, message, "would see their faces as voids");
            return self.refuse(problem.help("remove it"));
        }
        let stiffness = record.number("contact_stiffness").map_or(1.0, |it| it.value);
        let contact = record.text("contact");
        let contact = match contact.as_ref().map(|contact| contact.as_str()) {
            Some("full") => Contact::Full,
            Some("penalty") => Contact::Penalty { stiffness },
            _ => Contact::Repulsive,
        };
        if !matches!(contact, Contact::Penalty { .. }) {
            self.meaningless(record, "contact_stiffness", "without `contact = \"penalty\"`");
        }
        if contact == Contact::Full {
            self.meaningless(record, "self_contact", "with `contact = \"full\"`");
        }
        let most = record.number("background_pressure").map_or(1.0, |it| it.value);
        let shifting = match record.text("shifting")?.as_str() {
            "none" => Shifting::None,
            "background" => Shifting::Background { most },
            "ipst" => Shifting::Iterative {
                tolerance: record.number("shifting_tolerance")?.value,
                most_passes: record.whole::<u32>("shifting_passes")?.value,
            },
            _ => Shifting::Sun { factor: record.number("shifting_factor")?.value },
        };
        if !matches!(shifting, Shifting::Background { .. }) {
            self.meaningless(record, "background_pressure", "without `shifting = \"background\"`");
        }
        Some(TransportVelocity {
            kernel: record.text("kernel")?,
            smoothing_length: record.number("smoothing_length")?,
            settings: Settings {
                density: match density.as_str() {
                    "summation" => DensityRule::Summation,
                    _ => DensityRule::Continuity,
                },
                pressure: match edac {
                    false => PressureRule::StateEquation,
                    true => PressureRule::Edac { alpha },
                },
                corrections: Corrections::from_name(&record.text("corrections")?.value)?,
                shifting,
                viscous: match record.text("viscous_force").as_ref().map(|it| it.as_str()) {
                    Some("stress") => Viscous::Stress,
                    _ => Viscous::Laplacian,
                },
                artificial_viscosity: record.number("artificial_viscosity")?.value,
                density_relaxation: (record.number("density_relaxation"))
                    .map_or(of_fluid.density_relaxation, |it| it.value),
                gradients,
                free_surface: record.boolean("free_surface").unwrap_or(is_solid),
                at_surface: match record.text("surface_shifting").as_ref().map(|it| it.as_str()) {
                    Some("held") => AtSurface::Held,
                    None if !is_solid => AtSurface::Held,
                    _ => AtSurface::Along,
                },
            },
            contact,
            self_contact: record.number("self_contact"),
            corrected_gradients,
            damping: record.expression("damping").map(|rate| {
                Located::new(rate, record.key_place("damping").unwrap_or(record.place))
            }),
            removes_escaped: record.text("escaped")?.as_str() == "remove",
            reserve: record.whole::<u32>("reserve").map(|it| it.value),
            refine: self.shapes(record, "refine")?,
        })
    }
}

impl Reader<'_, '_> {
    /// How gradients are taken.
    fn gradients(&mut self, record: &Record, settings: Settings) -> Option<Gradients> {
        let Gradients::Corrected { velocity_diffusion } = settings.gradients else {
            if !self.names.current.is_solid {
                let reason = "without `corrected_gradients = true`";
                self.meaningless(record, "velocity_diffusion", reason);
            }
            return Some(Gradients::Plain);
        };
        let corrections = record.text("corrections")?;
        if corrections.as_str() != "full" {
            let message = format!(
                "corrected gradients need `corrections = \"full\"`, not `{}`",
                *corrections
            );
            let label = "does not go with `corrected_gradients`";
            let problem = Problem::new(corrections.place, message, label);
            return self.refuse(problem.help("remove it"));
        }
        let density = record.text("density")?;
        let is_algebraic =
            record.text("pressure").is_some_and(|it| it.as_str() == "state_equation");
        if density.as_str() == "summation" && is_algebraic {
            let message = "with a density by summation and a pressure by the equation of state nothing uses a divergence, \
                           so that the forces have none to be conjugate to";
            let label = "does not go with `corrected_gradients`";
            let problem = Problem::new(density.place, message, label);
            return self
                .refuse(problem.help("remove `density`, or `pressure`, or `corrected_gradients`"));
        }
        let diffusion = record.number("velocity_diffusion");
        let velocity_diffusion = diffusion.map_or(velocity_diffusion, |it| it.value);
        Some(Gradients::Corrected { velocity_diffusion })
    }

    /// What makes a body the buffer of an open boundary.
    pub(super) fn opening(&mut self, record: &Record) -> Option<Located<Opening>> {
        const FLOWS: [&str; 3] = ["velocity", "flow_rate", "pressure"];
        let given: Vec<&str> = FLOWS.into_iter().filter(|key| record.has(key)).collect();
        if given.len() != 1 {
            let message = match given.as_slice() {
                [] => "an opening needs one of `velocity`, `flow_rate` and `pressure`".to_owned(),
                [one, other, ..] => format!("`{one}` and `{other}` cannot both be prescribed"),
                [_] => String::new(),
            };
            let label = if given.is_empty() { "nothing is prescribed" } else { "too much" };
            return self.refuse(Problem::new(record.place, message, label));
        }
        let normal = self.unit(record, "normal")?;
        let flow = match given[0] {
            "velocity" => OpenFlow::Velocity(record.expressions("velocity")?),
            "flow_rate" => {
                let rate = record.expression("flow_rate")?;
                if rate.depends_on_position() {
                    let message =
                        "a flow rate is that of the whole opening and depends on the time alone";
                    let place = record.key_place("flow_rate").unwrap_or(record.place);
                    let problem = Problem::new(place, message, "depends on the place");
                    return self.refuse(problem.help("prescribe `velocity` by place"));
                }
                OpenFlow::Rate(rate)
            }
            _ => OpenFlow::Pressure(record.expression("pressure")?),
        };
        if given[0] == "flow_rate" {
            self.meaningless(record, "profile", "with a flow rate, which is that of the whole");
        }
        let profile = match record.record("profile") {
            Some(of) => {
                Some(Profile { factor: self.factor(of, "file")?, from: of.numbers("from")?.value })
            }
            None => None,
        };
        let history = self.history(record)?;
        let relaxation = record.number("relaxation").map(|time| time.value);
        let opening = Opening { normal, flow, profile, history, relaxation };
        Some(Located::new(opening, record.place))
    }
}

/// A body that is a wall.
pub(super) fn wall(record: &Record) -> Option<Located<Wall>> {
    let slip = match record.text("slip")?.as_str() {
        "free" => Slip::Free,
        _ => Slip::No,
    };
    let sliding = physics::expressions_per_axis(record, "sliding");
    Some(Located::new(Wall { slip, sliding }, record.place))
}

impl Reader<'_, '_> {
    /// Reports materials, walls and boundaries that the scheme has no use for.
    /// For the bodies of a system.
    pub(super) fn fits_scheme(
        &mut self,
        bodies: &[Body],
        boundaries: &[Boundary],
        system: Option<usize>,
    ) {
        let scheme = self.names.current.scheme;
        let is_fluid = scheme == "transport_velocity";
        let is_elastic = self.names.current.preset().is_some();
        for body in bodies.iter().filter(|body| body.system == system) {
            let help = match (scheme, &body.material.value) {
                (_, Material::Hyperelastic { .. } | Material::Rigid { .. }) if is_elastic => None,
                (
                    "transport_velocity",
                    Material::WeaklyCompressible { .. } | Material::Hypoelastic(_),
                )
                | (interpolation::NAME, _)
                | ("upwind", Material::Volumetric { .. }) => None,
                ("transport_velocity", _) if system.is_some() => {
                    Some("use `hypoelastic`".to_owned())
                }
                ("transport_velocity", _) => {
                    Some("use `weakly_compressible` or `hypoelastic`, for walls too".to_owned())
                }
                _ if is_elastic => {
                    Some(format!("use one of {}, rigid", HyperelasticLaw::NAMES.join(", ")))
                }
                _ => Some(format!("use `{}`", VolumetricLaw::NAMES.join("` or `"))),
            };
            if let Some(help) = help {
                let message = format!("the scheme `{scheme}` does not know this material");
                let problem = Problem::new(body.material.place, message, "of another scheme");
                self.report(problem.help(help));
            }
            let is_solid = matches!(body.material.value, Material::Hypoelastic(_));
            if is_fluid && is_solid != self.names.current.is_solid {
                let place = body.material.place;
                self.report(match system {
                    None => Problem::new(
                        place,
                        "fluids and solids cannot be in one system",
                        "a fluid beside solids",
                    )
                    .help(
                        "give all bodies, walls too, one kind of material; a solid in the fluid is a \
                         `[[system]]` of its own, which its bodies name with `system`",
                    ),
                    Some(_) => Problem::new(
                        place,
                        format!("the body `{}` belongs to a solid in the fluid", *body.name),
                        "a fluid",
                    )
                    .help(
                        "use `hypoelastic`, or leave `system` out, so that it belongs to the fluid \
                         of `[scheme]`",
                    ),
                });
            }
            if (is_elastic || is_solid) && body.initial.pressure.as_constant() != Some(0.0) {
                let message = format!(
                    "body `{}` starts with a pressure that corresponds to no strain",
                    *body.name
                );
                let problem = Problem::new(body.name.place, message, "no meaning in this scheme");
                self.report(problem.help("remove `initial.pressure`"));
            }
            if let Some(opening) = &body.opening {
                let is_of_fluid = is_fluid && !is_solid && system.is_none();
                let message = match (is_of_fluid, &body.wall) {
                    (true, None) => None,
                    (true, Some(_)) => Some("a wall cannot be an opening"),
                    _ => {
                        Some("only a fluid of the scheme `transport_velocity` has open boundaries")
                    }
                };
                if let Some(message) = message {
                    let problem = Problem::new(opening.place, message, "no meaning here");
                    self.report(problem.help("remove `opening`"));
                }
            }
            if let (Some(wall), false, None) = (&body.wall, is_fluid, system) {
                let message = format!("the scheme `{scheme}` has no walls of ghost particles");
                self.report(
                    Problem::new(wall.place, message, "no meaning here")
                        .help("remove it, or use the scheme `transport_velocity`"),
                );
            }
        }
        if system.is_none() {
            self.fits_rigid(bodies, boundaries);
        }
        for boundary in boundaries {
            let of = boundary.body.as_ref().and_then(|body| bodies.get(body.value));
            let pushes_fluid = is_fluid
                && !self.names.current.is_solid
                && of.is_some_and(|body| body.system.is_none());
            if let (Some(maker), false, None) = (&boundary.wave_maker, pushes_fluid, system) {
                let message =
                    "only a wall of a fluid of the scheme `transport_velocity` makes waves";
                let problem = Problem::new(maker.place, message, "no wall of a fluid");
                self.report(problem.help("use `velocity`"));
            }
        }
        let is_of = |boundary: &&Boundary| {
            let body = boundary.body.as_ref().and_then(|body| bodies.get(body.value));
            body.and_then(|body| body.system) == system
        };
        for boundary in boundaries.iter().filter(|_| is_fluid).filter(is_of) {
            let of_wall = |body: &Located<usize>| {
                bodies.get(body.value).is_some_and(|body| body.wall.is_some())
            };
            if !self.names.current.is_solid && !boundary.body.as_ref().is_some_and(of_wall) {
                let message = "only walls move as prescribed: the key `body` must name one";
                let place = boundary.body.as_ref().map_or(boundary.name.place, |body| body.place);
                self.report(Problem::new(place, message, "no wall"));
            }
        }
    }

    /// Reports what a rigid body cannot do, and what others cannot.
    fn fits_rigid(&mut self, bodies: &[Body], boundaries: &[Boundary]) {
        let is_rigid = |body: &Body| matches!(body.material.value, Material::Rigid { .. });
        // What boundaries have prescribed so far, by body: velocities, angular velocities and the pivot.
        let mut prescribed = vec![[false; 7]; bodies.len()];
        for boundary in boundaries {
            let number = boundary.body.as_ref().map(|body| body.value);
            let of = number.and_then(|number| bodies.get(number));
            if let (Some(maker), true) = (&boundary.wave_maker, of.is_some_and(is_rigid)) {
                let message = "a rigid body cannot be a wall that makes waves";
                let problem = Problem::new(maker.place, message, "of a rigid body");
                self.report(
                    problem.help("make it a wall of the fluid, or prescribe its `velocity`"),
                );
            }
            let problem = match (of, number, &boundary.turning) {
                (Some(body), _, _) if is_rigid(body) && boundary.region.value != Region::All => {
                    let message = format!(
                        "a rigid body moves as one, and this is a part of `{}`",
                        *body.name
                    );
                    Problem::new(boundary.region.place, message, "a part of it").help(
                        "select all of it with `where = { kind = \"all\" }`; `pivot` says which point the \
                         velocity is of",
                    )
                }
                (Some(body), Some(number), turning) if is_rigid(body) => {
                    let turns = turning.as_ref().map(|turning| &turning.value);
                    let given: [bool; 7] = std::array::from_fn(|k| match k {
                        0..3 => boundary.velocity.get(k).is_some_and(Option::is_some),
                        3..6 => turns.is_some_and(|it| it.angular_velocity[k - 3].is_some()),
                        _ => turns.is_some_and(|it| it.pivot.is_some()),
                    });
                    let mut is_second = false;
                    for (known, given) in prescribed[number].iter_mut().zip(given) {
                        is_second |= *known && given;
                        *known |= given;
                    }
                    if !is_second {
                        continue;
                    }
                    let message = format!(
                        "another boundary prescribes the same of the rigid body `{}`",
                        *body.name
                    );
                    Problem::new(boundary.name.place, message, "the second one")
                        .help("make one of them")
                }
                (_, _, Some(turning)) => {
                    let message = "only a rigid body has an angular velocity and a pivot";
                    Problem::new(turning.place, message, "no rigid body")
                        .help("name one with the key `body`, of the material `rigid`")
                }
                (None, _, None) if bodies.iter().any(is_rigid) => {
                    let message = "a boundary of all bodies would move parts of a rigid one";
                    Problem::new(boundary.name.place, message, "of which body?")
                        .help("name one with the key `body`")
                }
                _ => continue,
            };
            self.report(problem);
        }
    }
}
