//! The scheme `transport_velocity`, walls, and what of a case fits to which scheme.

use piola_formulas::hyperelastic::HyperelasticLaw;

use super::*;
use crate::case::model::{Body, Boundary, Material, TransportVelocity, Wall};
use crate::schemes::transport_velocity::{
    Corrections, DensityRule, PressureRule, Settings, Shifting, Slip,
};

/// Settings of the scheme `transport_velocity`.
pub(super) fn transport_velocity(record: &Record) -> Option<TransportVelocity> {
    let alpha = record.number("pressure_diffusion")?.value;
    let shifting = match record.text("shifting")?.as_str() {
        "none" => Shifting::None,
        "ipst" => Shifting::Iterative {
            tolerance: record.number("shifting_tolerance")?.value,
            most_passes: record.whole::<u32>("shifting_passes")?.value,
        },
        _ => Shifting::Sun { factor: record.number("shifting_factor")?.value },
    };
    Some(TransportVelocity {
        kernel: record.text("kernel")?,
        smoothing_length: record.number("smoothing_length")?,
        settings: Settings {
            density: match record.text("density")?.as_str() {
                "summation" => DensityRule::Summation,
                _ => DensityRule::Continuity,
            },
            pressure: match record.text("pressure")?.as_str() {
                "state_equation" => PressureRule::StateEquation,
                _ => PressureRule::Edac { alpha },
            },
            corrections: Corrections::from_name(&record.text("corrections")?.value)?,
            shifting,
            artificial_viscosity: record.number("artificial_viscosity")?.value,
            free_surface: record.boolean("free_surface")?,
            density_drift: record.number("density_drift")?.value,
        },
        removes_escaped: record.text("escaped")?.as_str() == "remove",
    })
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
    pub(super) fn fits_scheme(&mut self, bodies: &[Body], boundaries: &[Boundary]) {
        let scheme = self.names.scheme;
        let is_fluid = scheme == "transport_velocity";
        for body in bodies {
            let help = match (scheme, &body.material.value) {
                ("transport_velocity", Material::WeaklyCompressible { .. })
                | ("dual_support" | "elastodynamics", Material::Hyperelastic { .. })
                | (interpolation::NAME, _)
                | ("upwind", Material::Linear { .. } | Material::GammaLaw { .. }) => None,
                ("transport_velocity", _) => {
                    Some("use `kind = \"weakly_compressible\"`, for walls too".to_owned())
                }
                ("dual_support" | "elastodynamics", _) => {
                    Some(format!("use one of {}", HyperelasticLaw::NAMES.join(", ")))
                }
                _ => Some("use `linear` or `gamma_law`".to_owned()),
            };
            if let Some(help) = help {
                let message = format!("the scheme `{scheme}` does not know this material");
                let problem = Problem::new(body.material.place, message, "of another scheme");
                self.report(problem.help(help));
            }
            if matches!(scheme, "dual_support" | "elastodynamics")
                && body.initial.pressure.as_constant() != Some(0.0)
            {
                let message =
                    format!("body `{}` starts with a pressure, which no strain makes", *body.name);
                let problem = Problem::new(body.name.place, message, "no meaning in this scheme");
                self.report(problem.help("remove `initial.pressure`"));
            }
            if let (Some(wall), false) = (&body.wall, is_fluid) {
                let message = format!("the scheme `{scheme}` has no walls of ghost particles");
                self.report(
                    Problem::new(wall.place, message, "no meaning here")
                        .help("remove it, or use the scheme `transport_velocity`"),
                );
            }
        }
        for boundary in boundaries.iter().filter(|_| is_fluid) {
            let of_wall = |body: &Located<usize>| {
                bodies.get(body.value).is_some_and(|body| body.wall.is_some())
            };
            if !boundary.body.as_ref().is_some_and(of_wall) {
                let message = "only walls move as prescribed: the key `body` must name one";
                let place = boundary.body.as_ref().map_or(boundary.name.place, |body| body.place);
                self.report(Problem::new(place, message, "no wall"));
            }
        }
    }
}
