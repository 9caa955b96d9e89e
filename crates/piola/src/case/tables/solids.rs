//! The scheme `dual_support` and the materials of elastic solids.

use super::geometry::PLANES;
use super::*;

pub(super) const DUAL_SUPPORT: KindSpec = KindSpec {
    name: "dual_support",
    meaning: "elastic solids from one discrete energy, with supports of any size",
    dimensions: &[1, 2, 3],
    keys: &[
        key(
            "kernel",
            Kind::Name(Choices::Registry(catalogue::kernels)),
            "",
            Default("\"cubic_spline\""),
            "kernel that weighs the neighbours",
        ),
        key(
            "weights",
            Kind::Name(super::WEIGHTS),
            "",
            Default("\"lattice\""),
            "what is summed under the kernel",
        ),
        key(
            "support",
            Kind::Number(Interval::POSITIVE),
            "spacings",
            Derived("2.05 unless `neighbors` is given"),
            "support radius in units of the particle spacing",
        ),
        key(
            "neighbors",
            Kind::Integer(Interval::at_least(1.0)),
            "1",
            Optional,
            "support radius of a particle is the distance to its so many-th neighbour, instead of `support`",
        ),
        key(
            "gradients",
            Kind::Name(GRADIENTS),
            "",
            Derived("`patch_consistent`; `plain` where there is a body of points from a file"),
            "coefficients of the deformation gradient",
        ),
        key(
            "hourglass",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Derived("0.1; 1 with `plain` gradients"),
            "coefficient of the hourglass energy in units of the shear modulus, Dual-support (21)",
        ),
    ],
};

const GRADIENTS: Choices = choices(&[
    choice("patch_consistent", "corrected so that constant stress is in equilibrium on any cloud"),
    choice("plain", "those of the paper, Dual-support (12)"),
]);

pub(super) const YOUNG_MODULUS: KeySpec =
    key("young_modulus", Kind::Number(Interval::POSITIVE), "Pa", Optional, "Young's modulus");
pub(super) const POISSON_RATIO: KeySpec =
    key("poisson_ratio", Kind::Number(Interval::ANY), "1", Optional, "Poisson's ratio");
pub(super) const BULK_MODULUS: KeySpec =
    key("bulk_modulus", Kind::Number(Interval::POSITIVE), "Pa", Optional, "bulk modulus kappa");
pub(super) const SHEAR_MODULUS: KeySpec =
    key("shear_modulus", Kind::Number(Interval::POSITIVE), "Pa", Optional, "shear modulus mu");
pub(super) const LAME_LAMBDA: KeySpec =
    key("lame_lambda", Kind::Number(Interval::ANY), "Pa", Optional, "Lame's first constant");
const PLANE: KeySpec = key(
    "plane",
    Kind::Name(PLANES),
    "",
    Derived("`strain`; no meaning in 3D"),
    "what the directions do that the case does not have",
);
const REQUIRED_BULK_MODULUS: KeySpec = key(
    "bulk_modulus",
    Kind::Number(Interval::POSITIVE),
    "Pa",
    Required,
    "bulk modulus kappa of small strains",
);

const ISOTROPIC: &[KeySpec] =
    &[YOUNG_MODULUS, POISSON_RATIO, BULK_MODULUS, SHEAR_MODULUS, LAME_LAMBDA, PLANE];

const fn isotropic(name: &'static str, meaning: &'static str) -> KindSpec {
    KindSpec { name, meaning, dimensions: &[1, 2, 3], keys: ISOTROPIC }
}

pub(super) const LINEAR_ELASTIC: KindSpec = isotropic(
    "linear_elastic",
    "Hooke's law of small strains, Dual-support (44); give `young_modulus` with `poisson_ratio`, `bulk_modulus` with `shear_modulus`, or `lame_lambda` with `shear_modulus`",
);
pub(super) const SAINT_VENANT_KIRCHHOFF: KindSpec = isotropic(
    "saint_venant_kirchhoff",
    "Hooke's law for the strain of Green and Lagrange, Elastodynamics (3.50); stiffness as for `linear_elastic`",
);
pub(super) const NEO_HOOKEAN: KindSpec = isotropic(
    "neo_hookean",
    "neo-Hookean with the volume apart, Dual-support (46); stiffness as for `linear_elastic`",
);
pub(super) const NEO_HOOKEAN_LOGARITHMIC: KindSpec = isotropic(
    "neo_hookean_logarithmic",
    "neo-Hookean with the logarithm of J, Dual-support (50); stiffness as for `linear_elastic`",
);
pub(super) const MOONEY_RIVLIN: KindSpec = KindSpec {
    name: "mooney_rivlin",
    meaning: "Mooney and Rivlin's rubber, theory (41)",
    dimensions: &[1, 2, 3],
    keys: &[
        key("c10", Kind::Number(Interval::ANY), "Pa", Required, "first constant"),
        key("c01", Kind::Number(Interval::ANY), "Pa", Required, "second constant"),
        REQUIRED_BULK_MODULUS,
        PLANE,
    ],
};
pub(super) const OGDEN: KindSpec = KindSpec {
    name: "ogden",
    meaning: "Ogden's rubber, theory (42)",
    dimensions: &[1, 2, 3],
    keys: &[
        key(
            "moduli",
            Kind::Numbers(Length::Any, Interval::ANY),
            "Pa",
            Required,
            "modulus of each of one to three terms",
        ),
        key(
            "exponents",
            Kind::Numbers(Length::Any, Interval::ANY),
            "1",
            Required,
            "exponent of each term, of the sign of its modulus",
        ),
        REQUIRED_BULK_MODULUS,
        PLANE,
    ],
};
