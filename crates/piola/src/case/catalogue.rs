//! The names that a case file can use: kernels, integrators, fields and columns of tables.

use super::spec::Choice;
use crate::fields::{FieldDescription, FieldKind};

/// The kernels.
pub fn kernels() -> Vec<Choice> {
    [
        ("cubic_spline", "cubic spline, support 2 h"),
        ("quintic_spline", "quintic spline, support 3 h"),
        ("lucy", "Lucy's quartic"),
        ("gaussian", "truncated Gaussian"),
        ("mollifier", "mollifier"),
        ("modified_mollifier", "modified mollifier"),
        ("linear", "hat function"),
        ("quadratic", "quadratic"),
        ("wendland_c2", "Wendland C2"),
        ("wendland_c4", "Wendland C4"),
        ("wendland_c6", "Wendland C6"),
    ]
    .map(|(name, meaning)| Choice { name, meaning })
    .to_vec()
}

/// The time integrators.
pub fn integrators() -> Vec<Choice> {
    vec![Choice { name: "tvd_rk2", meaning: "explicit two-stage Runge-Kutta, Upwind (4.1)" }]
}

/// The fields of the scheme called `scheme`.
pub fn fields(scheme: &str) -> &'static [FieldDescription] {
    match scheme {
        "upwind" => UPWIND_FIELDS,
        _ => &[],
    }
}

/// Columns of the energy table, after `energy.`. Empty where any name is accepted.
pub fn energy_columns(_scheme: &str) -> &'static [&'static str] {
    &[]
}

/// Columns of the table of steps, after `step.`. Empty where any name is accepted.
pub fn step_columns() -> &'static [&'static str] {
    &[]
}

/// Numbers of the run as a whole, after `run.`.
pub const RUN_COLUMNS: &[&str] = &["first_step", "steps", "particles", "outcome"];

const fn field(
    name: &'static str,
    unit: &'static str,
    kind: FieldKind,
    meaning: &'static str,
) -> FieldDescription {
    FieldDescription { name, unit, kind, meaning }
}

const UPWIND_FIELDS: &[FieldDescription] = &[
    field("position", "m", FieldKind::Vector, "current position"),
    field("displacement", "m", FieldKind::Vector, "current minus reference position"),
    field("velocity", "m/s", FieldKind::Vector, "velocity"),
    field("pressure", "Pa", FieldKind::Scalar, "pressure, positive in compression"),
    field("volume_ratio", "1", FieldKind::Scalar, "the evolved volume ratio J"),
    field("determinant", "1", FieldKind::Scalar, "determinant of the deformation gradient"),
    field("deformation_gradient", "1", FieldKind::Tensor, "deformation gradient F"),
    field("density", "kg/m^3", FieldKind::Scalar, "reference density over J"),
    field("wave_speed", "m/s", FieldKind::Scalar, "speed of pressure waves"),
    field("acceleration", "m/s^2", FieldKind::Vector, "acceleration"),
    field("neighbours", "1", FieldKind::Scalar, "number of neighbours"),
    field("volume", "m^D", FieldKind::Scalar, "reference volume of the particle"),
];
