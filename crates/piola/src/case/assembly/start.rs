//! Values at the start, from expressions of the position or from arrays of the particles.

use super::bodies::BodyReport;
use crate::Vector;
use crate::boundaries::padded;
use crate::case::diagnostics::Problem;
use crate::case::expression::Expression;
use crate::case::model::{self, Body, Case};
use crate::geometry::Particles;
use crate::schemes::upwind::Initial;

/// Velocities and pressures.
pub(super) fn initial<const D: usize>(
    case: &Case,
    reports: &[BodyReport],
    particles: &Particles<D>,
) -> Initial<D> {
    let rows = rows(reports, particles);
    let pressure = |a: usize| {
        let body = &case.bodies[particles.body[a] as usize];
        value(&body.initial.pressure, &particles.position[a], rows[a])
    };
    Initial {
        velocity: at_start(case, reports, particles, |initial| &initial.velocity),
        pressure: (0..particles.len()).map(pressure).collect(),
    }
}

/// A vector of each particle.
pub(super) fn at_start<const D: usize>(
    case: &Case,
    reports: &[BodyReport],
    particles: &Particles<D>,
    components: impl Fn(&model::Initial) -> &[Expression],
) -> Vec<Vector<D>> {
    let rows = rows(reports, particles);
    let of = |a: usize| {
        let components = components(&case.bodies[particles.body[a] as usize].initial);
        Vector::from_fn(|k, _| value(&components[k], &particles.position[a], rows[a]))
    };
    (0..particles.len()).map(of).collect()
}

/// Which particle of its body each is, in the order of creation, in which those of a body follow those of the bodies before it.
fn rows<const D: usize>(reports: &[BodyReport], particles: &Particles<D>) -> Vec<usize> {
    let first = reports.iter().scan(0, |next, report| {
        let first = *next;
        *next += report.particles;
        Some(first)
    });
    let first: Vec<usize> = first.collect();
    let row = |(id, body): (&u32, &u32)| (*id as usize).wrapping_sub(first[*body as usize]);
    particles.id.iter().zip(&particles.body).map(row).collect()
}

/// The value of a particle at a position. What waits in reserve has no row.
fn value<const D: usize>(expression: &Expression, x: &Vector<D>, row: usize) -> f64 {
    match expression.array() {
        Some(values) => values.get(row).copied().unwrap_or(0.0),
        None => expression.eval(padded(x), 0.0),
    }
}

/// Refuses arrays of another length than a body has particles, and in fluids that particles flow into.
pub(super) fn check(case: &Case, body: &Body, particles: usize) -> Result<(), Problem> {
    let initial = &body.initial;
    let fields: [(&str, &[Expression]); 3] = [
        ("velocity", &initial.velocity),
        ("displacement", &initial.displacement),
        ("pressure", std::slice::from_ref(&initial.pressure)),
    ];
    let arrays = fields.iter().flat_map(|(key, all)| {
        all.iter().filter_map(move |expression| Some((key, expression.array()?)))
    });
    let of_body = &*body.name;
    let refuse = |message: String, label: &str, help: &str| {
        Err(case.problem_at(initial.place, message, label, Some(help.to_owned())))
    };
    for (key, values) in arrays {
        if case.bodies.iter().any(|body| body.opening.is_some()) {
            let message = format!(
                "`{key}` of the body `{of_body}` is an array, which has no values for the particles in the buffers of openings"
            );
            return refuse(message, "an array", "use an expression or a function");
        }
        if values.len() != particles {
            let message = format!(
                "the array for `{key}` of the body `{of_body}` has {} rows, expected {particles}: one for each of its \
                 particles, in the order of creation",
                values.len()
            );
            return refuse(message, "an array", "`positions` of the case gives them in this order");
        }
    }
    Ok(())
}
