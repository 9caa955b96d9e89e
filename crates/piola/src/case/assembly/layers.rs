//! How thick solids are to the fluid around them.

use super::bodies;
use crate::case::diagnostics::Problem;
use crate::case::model::{Body, Case};
use crate::neighbors::Domain;

/// Fewer layers of particles of the fluid than these do not keep its two sides apart.
const LEAST: f64 = 3.0;

/// What of a layer is round-off.
const ROUND_OFF: f64 = 1e-6;

/// The smallest extent of a body in spacings of the fluid, which are its own in the case of the fluid; none of bodies whose
/// particles come from a file or that go round a periodic domain.
fn layers<const D: usize>(case: &Case, body: &Body, domain: &Domain<D>) -> Option<f64> {
    if body.shape.is_from_file() {
        return None;
    }
    let shape = bodies::shape::<D>(case, body, &body.shape).ok()?;
    // The lattice of what is turned as a whole is turned with it.
    let (min, max) = shape.as_turned().map_or(&shape, |(of, ..)| of).bounding_box();
    let extents = (0..D).filter_map(|axis| {
        let (extent, spacing) = (max[axis] - min[axis], *body.spacing.get(axis)?);
        let is_round = domain.periodic()[axis]
            .is_some_and(|[low, high]| extent >= (high - low) * (1.0 - ROUND_OFF));
        (!is_round && spacing > 0.0).then_some(extent / spacing)
    });
    let least = extents.fold(f64::INFINITY, f64::min);
    (least < f64::INFINITY).then_some(least)
}

/// Warnings of solids of a case that have few layers in the case `main` of the fluid.
///
/// # Errors
/// Those that are thinner than a spacing of the fluid, by name.
pub(super) fn check<const D: usize>(
    case: &Case,
    main: &Case,
    domain: &Domain<D>,
) -> Result<Vec<String>, Vec<Problem>> {
    let (mut problems, mut warnings) = (Vec::new(), Vec::new());
    for (given, body) in case.bodies.iter().zip(&main.bodies) {
        if given.system.is_none() {
            continue;
        }
        let Some(layers) = layers(main, body, domain).filter(|it| *it < LEAST - ROUND_OFF) else {
            continue;
        };
        let name = &*body.name;
        let thick = format!("the solid `{name}` is {layers:.2} spacings of the fluid thick");
        if layers < 1.0 - ROUND_OFF {
            let message = format!("{thick}: the fluid cannot see it");
            let help = format!(
                "make the spacing of the fluid at most a third of its thickness, {:.3e} m",
                layers / LEAST * body.spacing.iter().copied().fold(f64::INFINITY, f64::min)
            );
            let label = format!("body `{name}`");
            problems.push(case.problem_at(given.shape.place, message, label, Some(help)));
        } else {
            warnings.push(format!(
                "{thick}, less than {LEAST}: fluid on one side interacts with that on the other, and faces follow \
                 poorly where it bends; make the spacing of the fluid smaller, or the solid thicker"
            ));
        }
    }
    if problems.is_empty() { Ok(warnings) } else { Err(problems) }
}
