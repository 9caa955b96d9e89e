//! The scheme `interpolation`.

use super::*;

pub(super) const INTERPOLATION: KindSpec = KindSpec {
    name: "interpolation",
    meaning: "no motion: what SPH sums make of a known function and of its gradients on the particles of a body, which needs no material, in a case that needs no `time`",
    dimensions: &[1, 2, 3],
    keys: &[
        key(
            "function",
            Kind::Expression(Variables::Position),
            "1",
            Required,
            "the function, whose exact gradient is taken of the expression",
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
            "what is summed under the kernel",
        ),
        key(
            "gradient",
            Kind::Name(GRADIENTS),
            "",
            Default("\"plain\""),
            "what kernel gradients are made into",
        ),
        key(
            "boundary",
            Kind::Name(BOUNDARIES),
            "",
            Default("\"continued\""),
            "what the ghosts carry that continue the lattice around the body and into its holes",
        ),
    ],
};

const GRADIENTS: Choices = choices(&[
    choice("plain", "sums of the function with kernel gradients, Elastodynamics (2.25)"),
    choice("difference", "sums of differences, exact for constants"),
    choice("corrected", "exact for linear functions"),
]);

const BOUNDARIES: Choices = choices(&[
    choice("none", "there are no ghosts: sums end where the body does"),
    choice("continued", "the function"),
    choice(
        "value",
        "values with which sums on the boundary are the function: Elastodynamics (2.42) in 1D, (2.46) otherwise",
    ),
    choice(
        "slope",
        "values with which sums for gradients on the boundary are the gradient: Elastodynamics (2.45) in 1D; in 2D and 3D that is so of the gradient as it is interpolated once more, which is then what the field `gradient` has",
    ),
]);
