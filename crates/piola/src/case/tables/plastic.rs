//! Hypoelastic and elastic-plastic materials of the scheme `transport_velocity`.

use super::solids::{BULK_MODULUS, LAME_LAMBDA, POISSON_RATIO, SHEAR_MODULUS, YOUNG_MODULUS};
use super::*;

pub(super) const HYPOELASTIC: KindSpec = KindSpec {
    name: "hypoelastic",
    meaning: "a solid whose deviatoric stress is integrated in time with the Jaumann rate, CTVF (4), in 2D in plane strain; for the scheme `transport_velocity`; stiffness as for `linear_elastic`",
    dimensions: &[1, 2, 3],
    keys: &[
        YOUNG_MODULUS,
        POISSON_RATIO,
        BULK_MODULUS,
        SHEAR_MODULUS,
        LAME_LAMBDA,
        key(
            "pressure_law",
            Kind::Tagged(&PRESSURE_LAW),
            "",
            Derived("`{ kind = \"linear\" }`"),
            "how the pressure depends on the density",
        ),
        key(
            "spall_strength",
            Kind::Number(Interval::POSITIVE),
            "Pa",
            Derived("none: it never fails in tension"),
            "limit of the tension, below which the pressure does not fall; where it would, the solid opens",
        ),
        key(
            "strength",
            Kind::Tagged(&STRENGTH),
            "",
            Derived("`{ kind = \"elastic\" }`"),
            "flow stress",
        ),
        key(
            "temperature",
            Kind::Number(Interval::POSITIVE),
            "K",
            Default("293.15"),
            "initial temperature",
        ),
        key(
            "specific_heat",
            Kind::Number(Interval::POSITIVE),
            "J/(kg K)",
            Optional,
            "specific heat; without it the solid does not warm up",
        ),
        key(
            "heat_share",
            Kind::Number(Interval::between(0.0, 1.0)),
            "1",
            Default("0.9"),
            "fraction of the plastic work that becomes heat",
        ),
    ],
};

static PRESSURE_LAW: TaggedSpec = TaggedSpec {
    title: "pressure_law",
    meaning: "The pressure of a solid.",
    common: &[],
    kinds: &[
        KindSpec {
            name: "linear",
            meaning: "K (rho / rho0 - 1), CTVF (8)",
            dimensions: &[1, 2, 3],
            keys: &[],
        },
        KindSpec {
            name: "tait",
            meaning: "K / gamma ((rho / rho0)^gamma - 1)",
            dimensions: &[1, 2, 3],
            keys: &[key(
                "exponent",
                Kind::Number(Interval::above(1.0)),
                "1",
                Default("7.0"),
                "the exponent gamma",
            )],
        },
        KindSpec {
            name: "mie_grueneisen",
            meaning: "Mie-Grueneisen, about the shock Hugoniot U = c + S u, with the internal energy",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "slope",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "1",
                    Required,
                    "slope S of the shock speed over the particle speed",
                ),
                key(
                    "gruneisen",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "1",
                    Required,
                    "Grueneisen coefficient Gamma at rest",
                ),
            ],
        },
    ],
};

static STRENGTH: TaggedSpec = TaggedSpec {
    title: "strength",
    meaning: "The flow stress of a solid.",
    common: &[],
    kinds: &[
        KindSpec { name: "elastic", meaning: "no plastic flow", dimensions: &[1, 2, 3], keys: &[] },
        KindSpec {
            name: "linear",
            meaning: "`yield_stress` plus `hardening` times the plastic strain",
            dimensions: &[1, 2, 3],
            keys: &[
                YIELD_STRESS,
                key(
                    "hardening",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "Pa",
                    Default("0.0"),
                    "plastic modulus; 0 is perfectly plastic",
                ),
            ],
        },
        KindSpec {
            name: "johnson_cook",
            meaning: "(A + B e^n)(1 + C ln(e'/e0'))(1 - T*^m) of Johnson and Cook, with A the yield stress",
            dimensions: &[1, 2, 3],
            keys: &[
                YIELD_STRESS,
                key("hardening", Kind::Number(Interval::NOT_NEGATIVE), "Pa", Required, "B"),
                key("exponent", Kind::Number(Interval::POSITIVE), "1", Required, "n"),
                key("rate_factor", Kind::Number(Interval::NOT_NEGATIVE), "1", Default("0.0"), "C"),
                key(
                    "reference_rate",
                    Kind::Number(Interval::POSITIVE),
                    "1/s",
                    Default("1.0"),
                    "plastic strain rate e0' below which the rate has no effect",
                ),
                key("softening", Kind::Number(Interval::POSITIVE), "1", Default("1.0"), "m"),
                key(
                    "melting_temperature",
                    Kind::Number(Interval::POSITIVE),
                    "K",
                    Derived("no effect of the temperature"),
                    "temperature at which the strength vanishes; at the `temperature` of the material the strength is full",
                ),
            ],
        },
    ],
};

const YIELD_STRESS: KeySpec =
    key("yield_stress", Kind::Number(Interval::POSITIVE), "Pa", Required, "yield stress");
