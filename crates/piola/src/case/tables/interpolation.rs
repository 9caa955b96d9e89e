//! The scheme `interpolation`.

use super::*;

pub(super) const INTERPOLATION: KindSpec = KindSpec {
    name: "interpolation",
    meaning: "no motion: the SPH approximation of a known function and of its gradients on the particles of a body; needs neither a material nor `time`",
    dimensions: &[1, 2, 3],
    keys: &[
        key(
            "function",
            Kind::Expression(Variables::Position),
            "1",
            Required,
            "the function; its exact gradient is derived from the expression",
        ),
        key(
            "kernel",
            Kind::Name(Choices::Registry(catalogue::kernels)),
            "",
            Default("\"modified_mollifier\""),
            "cover function",
        ),
        key(
            "support",
            Kind::Number(Interval::POSITIVE),
            "spacings",
            Default("5.5"),
            "radius of the cover in units of the particle spacing",
        ),
        key(
            "weights",
            Kind::Name(super::WEIGHTS),
            "",
            Default("\"lattice\""),
            "weight of a particle in kernel sums",
        ),
        key("gradient", Kind::Name(GRADIENTS), "", Default("\"plain\""), "form of the gradient"),
        key(
            "boundary",
            Kind::Name(BOUNDARIES),
            "",
            Default("\"continued\""),
            "values of the ghosts that continue the lattice around the body and into its holes",
        ),
    ],
};

const GRADIENTS: Choices = choices(&[
    choice("plain", "sums of the function with kernel gradients, Elastodynamics (2.25)"),
    choice("difference", "sums of differences, exact for constants"),
    choice("corrected", "exact for linear functions"),
]);

const BOUNDARIES: Choices = choices(&[
    choice("none", "no ghosts: sums end at the boundary of the body"),
    choice(
        "scaled",
        "no ghosts, and sums divided by the share of the cover inside the body: exact for constants; one reading of the factor that Elastodynamics 2.8.1 mentions",
    ),
    choice("continued", "the function"),
    choice(
        "value",
        "values for which sums on the boundary equal the function: Elastodynamics (2.42) in 1D, (2.46) otherwise",
    ),
    choice(
        "slope",
        "values for which gradient sums on the boundary equal the gradient: Elastodynamics (2.45) in 1D; in 2D and 3D this holds for the gradient interpolated once more, which is then the field `gradient`",
    ),
]);
