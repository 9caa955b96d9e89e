//! The scheme `elastodynamics`.

use super::*;

pub(super) const ELASTODYNAMICS: KindSpec = KindSpec {
    name: "elastodynamics",
    meaning: "elastic solids on sparse SPH matrices, for waves and large strain; bodies whose particles share places are joined there",
    dimensions: &[1, 2, 3],
    keys: &[
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
            Derived("5.5 with `form = \"strong\"` in 1D, 2.5 otherwise"),
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
            "form",
            Kind::Name(FORMS),
            "",
            Derived("`strong` in 1D, `adjoint` otherwise"),
            "how the divergence of the stress is taken",
        ),
        key(
            "configuration",
            Kind::Name(CONFIGURATIONS),
            "",
            Default("\"total\""),
            "where the matrices are made",
        ),
        key(
            "hourglass",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Derived("0.05 with `form = \"adjoint\"`"),
            "coefficient of the hourglass energy in units of the shear modulus, theory (60)",
        ),
        key(
            "viscosity",
            Kind::Number(Interval::NOT_NEGATIVE),
            "Pa s",
            Default("0.0"),
            "viscosity of Kelvin and Voigt's material, theory (65)",
        ),
        key(
            "artificial_viscosity",
            Kind::Numbers(Length::Any, Interval::NOT_NEGATIVE),
            "1",
            Derived("[0, 0]"),
            "linear and quadratic coefficient of the artificial viscosity, theory (66)",
        ),
        key(
            "damping",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1/s",
            Default("0.0"),
            "rate at which motion dies out, to come to rest in equilibrium: about the shear wave speed over the size of the body",
        ),
    ],
};

const FORMS: Choices = choices(&[
    choice(
        "strong",
        "by the matrices of the gradient, with ghosts beyond the edges that carry the load as a slope, theory (64): the paper's way; for one row in 1D, and in 2D for one box of a lattice with particles on its edges, out of which discs may be cut",
    ),
    choice("adjoint", "by their transposes, with tractions as forces on particles"),
]);

const CONFIGURATIONS: Choices = choices(&[
    choice("total", "at the reference places, once"),
    choice(
        "updated",
        "at the places of the moment, in each step, which shows the tensile instability; in 1D",
    ),
]);
