//! The dissipation of the scheme `upwind` as the paper prints it.

use crate::case::diagnostics::Problem;
use crate::case::model::{Case, Dissipation, Upwind};

/// Strengths of the dissipation of velocity and of pressure as the scheme takes them.
///
/// The printed Upwind (3.38) lacks the density: next to ours its velocity dissipation is
/// `1 / rho` as strong, in the units of the case. The printed (3.42) has the sign opposite to (3.41): its
/// pressure dissipation is ours with the other sign, and feeds energy in.
///
/// # Errors
/// Bodies of several densities, for which a strength each would be needed.
pub fn strengths(case: &Case, settings: &Upwind) -> Result<[f64; 2], Vec<Problem>> {
    let (velocity, pressure) = (settings.tau_velocity, settings.tau_pressure);
    let kind = settings.dissipation.value;
    let density = case.bodies[0].material.density();
    if kind.lacks_density() && case.bodies.iter().any(|body| body.material.density() != density) {
        let message = "the printed (3.38) is available only for bodies of one density";
        let help = "use `dissipation = \"corrected\"`".to_owned();
        let place = settings.dissipation.place;
        return Err(vec![case.problem_at(place, message, "as printed", Some(help))]);
    }
    Ok([
        if kind.lacks_density() { velocity / density } else { velocity },
        if kind.turns_area() { -pressure } else { pressure },
    ])
}

/// What the user should know who asks for it.
pub fn warning(settings: &Upwind) -> Option<String> {
    let what = match settings.dissipation.value {
        Dissipation::Corrected => return None,
        Dissipation::WithoutDensity => {
            "(3.38) as printed lacks the density, so that almost nothing dissipates"
        }
        Dissipation::TurnedArea => {
            "(3.42) as printed has the wrong sign, so that the dissipation of pressure feeds energy in"
        }
        Dissipation::AsPrinted => {
            "(3.38) as printed lacks the density and (3.42) has the wrong sign, so that almost \
             nothing dissipates and the dissipation of pressure feeds energy in"
        }
    };
    Some(format!(
        "`scheme.dissipation` is `{}`: {what}; it is for comparison with figures 6.7 and 6.8 of the \
         paper only",
        settings.dissipation.value.name()
    ))
}
