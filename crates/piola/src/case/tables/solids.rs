//! The scheme `total_lagrangian` with its presets, and the materials of elastic solids.

use super::geometry::PLANES;
use super::*;

/// What a preset says of keys that a file leaves out.
struct Usual {
    kernel: &'static str,
    support: &'static str,
    joined: &'static str,
    form: &'static str,
    gradients: &'static str,
    hourglass: &'static str,
    tractions: &'static str,
}

pub(super) const TOTAL_LAGRANGIAN: KindSpec = KindSpec {
    name: "total_lagrangian",
    meaning: "elastic solids whose particles keep their neighbours, with selectable parts; `dual_support` and `elastodynamics` are presets of the same parts",
    dimensions: &[1, 2, 3],
    keys: &keys(Usual {
        kernel: "\"cubic_spline\"",
        support: "2.05 unless `neighbors` is given; with `form = \"strong\"` 5.5 in 1D and 2.5 in 2D",
        joined: "true",
        form: "`adjoint`",
        gradients: "`patch_consistent`; `plain` where there is a body of points from a file, concentric layers or packed particles, or a `mirror`",
        hourglass: "0.1; 1 with `plain` gradients on particles of meshes and files",
        tractions: "`surface`; `layers` with `plain` gradients",
    }),
};

pub(super) const DUAL_SUPPORT: KindSpec = KindSpec {
    name: "dual_support",
    meaning: "`total_lagrangian` with the defaults of Dual-support: elastic solids from one discrete energy, with supports of any size",
    dimensions: &[1, 2, 3],
    keys: &keys(Usual {
        kernel: "\"cubic_spline\"",
        support: "2.05 unless `neighbors` is given; with `form = \"strong\"` 5.5 in 1D and 2.5 in 2D",
        joined: "false",
        form: "`adjoint`",
        gradients: "`patch_consistent`; `plain` where there is a body of points from a file, concentric layers or packed particles, or a `mirror`",
        hourglass: "0.1; 1 with `plain` gradients",
        tractions: "`surface`",
    }),
};

pub(super) const ELASTODYNAMICS: KindSpec = KindSpec {
    name: "elastodynamics",
    meaning: "`total_lagrangian` with the defaults of Elastodynamics: elastic solids on sparse SPH matrices, for waves and large strain; bodies with particles at the same positions are joined there",
    dimensions: &[1, 2, 3],
    keys: &keys(Usual {
        kernel: "\"modified_mollifier\"",
        support: "2.5 unless `neighbors` is given; 5.5 with `form = \"strong\"` in 1D",
        joined: "true",
        form: "`strong` in 1D, `adjoint` otherwise",
        gradients: "`plain`",
        hourglass: "0.05",
        tractions: "`layers`",
    }),
};

const fn keys(usual: Usual) -> [KeySpec; 13] {
    [
        key(
            "kernel",
            Kind::Name(Choices::Registry(catalogue::kernels)),
            "",
            Default(usual.kernel),
            "weighting kernel",
        ),
        key(
            "weights",
            Kind::Name(super::WEIGHTS),
            "",
            Default("\"lattice\""),
            "weight of a particle in kernel sums",
        ),
        key(
            "support",
            Kind::Number(Interval::POSITIVE),
            "spacings",
            Derived(usual.support),
            "support radius in units of the particle spacing",
        ),
        key(
            "neighbors",
            Kind::Integer(Interval::at_least(1.0)),
            "1",
            Optional,
            "number n: the support radius of a particle is the distance to its n-th nearest neighbour, instead of `support`; with `form = \"adjoint\"` and no `mirror`",
        ),
        key(
            "joined",
            Kind::Boolean,
            "",
            Default(usual.joined),
            "whether bodies are joined where they have particles at the same positions",
        ),
        key(
            "form",
            Kind::Name(FORMS),
            "",
            Derived(usual.form),
            "form of the divergence of the stress",
        ),
        key(
            "configuration",
            Kind::Name(CONFIGURATIONS),
            "",
            Default("\"total\""),
            "configuration in which the matrices are computed",
        ),
        key(
            "gradients",
            Kind::Name(GRADIENTS),
            "",
            Derived(usual.gradients),
            "coefficients of the deformation gradient; with `form = \"adjoint\"`",
        ),
        key(
            "hourglass",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Derived(usual.hourglass),
            "coefficient of the hourglass energy in units of the shear modulus, theory (47) and (60), Dual-support (21); with `form = \"adjoint\"`",
        ),
        key(
            "tractions",
            Kind::Name(TRACTIONS),
            "",
            Derived(usual.tractions),
            "particles on which tractions act; with `form = \"adjoint\"`",
        ),
        key(
            "viscosity",
            Kind::Number(Interval::NOT_NEGATIVE),
            "Pa s",
            Derived("0; for solids in a fluid that are stiff that of theory (82)"),
            "Kelvin-Voigt viscosity, theory (65); with explicit steps",
        ),
        key(
            "artificial_viscosity",
            Kind::Numbers(Length::Any, Interval::NOT_NEGATIVE),
            "1",
            Derived("[0, 0]"),
            "linear and quadratic coefficients of the artificial viscosity, theory (66); with explicit steps",
        ),
        key(
            "damping",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1/s",
            Default("0.0"),
            "damping rate, to reach equilibrium at rest: about the shear wave speed over the size of the body; with explicit steps",
        ),
    ]
}

const FORMS: Choices = choices(&[
    choice(
        "strong",
        "by the gradient matrices, with ghosts beyond the edges that carry the load as a slope, theory (64): the formulation of Elastodynamics; for one row in 1D, and in 2D for one box of a lattice with particles on its edges, from which discs may be cut out",
    ),
    choice("adjoint", "by their transposes, with tractions as forces on particles"),
]);

const CONFIGURATIONS: Choices = choices(&[
    choice("total", "at the reference positions, once"),
    choice(
        "updated",
        "at the current positions, in each step, which shows the tensile instability; in 1D, with `form = \"strong\"`",
    ),
]);

const GRADIENTS: Choices = choices(&[
    choice("patch_consistent", "corrected so that constant stress is in equilibrium on any cloud"),
    choice("plain", "the gradients of the papers, Dual-support (12)"),
]);

const TRACTIONS: Choices = choices(&[
    choice("surface", "those on the surface"),
    choice(
        "layers",
        "behind a plane face all layers on which a homogeneous stress exerts forces, each with its share, so that such a stress is in equilibrium with plain gradients",
    ),
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
    "assumption for the directions that are not resolved",
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

pub(super) const RIGID: KindSpec = KindSpec {
    name: "rigid",
    meaning: "a rigid body, theory (83), with the scheme `total_lagrangian` and its presets; with `joined = true` flexible bodies are clamped to it where they have particles at the same positions. Bodies touch each other only in a fluid, each in its own `[[system]]`",
    dimensions: &[1, 2, 3],
    keys: &[],
};
pub(super) const LINEAR_ELASTIC: KindSpec = isotropic(
    "linear_elastic",
    "Hooke's law of small strains, Dual-support (44); give `young_modulus` with `poisson_ratio`, `bulk_modulus` with `shear_modulus`, or `lame_lambda` with `shear_modulus`",
);
pub(super) const SAINT_VENANT_KIRCHHOFF: KindSpec = isotropic(
    "saint_venant_kirchhoff",
    "Hooke's law for the Green-Lagrange strain, Elastodynamics (3.50); stiffness as for `linear_elastic`",
);
pub(super) const NEO_HOOKEAN: KindSpec = isotropic(
    "neo_hookean",
    "neo-Hookean with a separate volumetric part, Dual-support (46); stiffness as for `linear_elastic`",
);
pub(super) const NEO_HOOKEAN_LOGARITHMIC: KindSpec = isotropic(
    "neo_hookean_logarithmic",
    "neo-Hookean with the logarithm of J, Dual-support (50); stiffness as for `linear_elastic`",
);
pub(super) const MOONEY_RIVLIN: KindSpec = KindSpec {
    name: "mooney_rivlin",
    meaning: "Mooney-Rivlin rubber, theory (41)",
    dimensions: &[1, 2, 3],
    keys: &[
        key("c10", Kind::Number(Interval::ANY), "Pa", Required, "first constant"),
        key("c01", Kind::Number(Interval::ANY), "Pa", Required, "second constant"),
        REQUIRED_BULK_MODULUS,
        PLANE,
    ],
};
pub(super) const HYPERELASTIC: KindSpec = KindSpec {
    name: "hyperelastic",
    meaning: "a strain energy of your own, theory (99)",
    dimensions: &[1, 2, 3],
    keys: &[
        key(
            "energy",
            Kind::Text,
            "J/m^3",
            Required,
            "energy per reference volume, an expression of the parameters and of the invariants of C = F^T F: `I1` = tr C, `I2` = ((tr C)^2 - C : C)/2, `J` = det F, `I1b` = J^(-2/3) I1, `I2b` = J^(-4/3) I2, with + - * / ^, exp, ln, log and sqrt. At rest I1 = I2 = 3 and J = 1, and there must be no stress; constants do not matter. For example `shear/2 * (I1b - 3) + bulk/2 * (J - 1)^2`",
        ),
        PLANE,
    ],
};
pub(super) const OGDEN: KindSpec = KindSpec {
    name: "ogden",
    meaning: "Ogden rubber, theory (42)",
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
            "exponent of each term, with the same sign as its modulus",
        ),
        REQUIRED_BULK_MODULUS,
        PLANE,
    ],
};
