//! Pistons that make waves.

use super::*;

pub(super) static WAVE_MAKER: TaggedSpec = TaggedSpec {
    title: "wave_maker",
    meaning: "The motion of a piston that makes waves on water at rest, theory (93) and (94).",
    common: &[
        key("depth", Kind::Number(Interval::POSITIVE), "m", Required, "depth of the water at rest"),
        key("gravity", Kind::Number(Interval::POSITIVE), "m/s^2", Default("9.81"), "gravity"),
        key(
            "direction",
            Kind::Numbers(Length::Dimension, Interval::ANY),
            "1",
            Derived("along x"),
            "where the waves go, of any length",
        ),
    ],
    kinds: &[
        KindSpec {
            name: "regular",
            meaning: "regular waves, of second order",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "height",
                    Kind::Number(Interval::POSITIVE),
                    "m",
                    Required,
                    "from trough to crest",
                ),
                key("period", Kind::Number(Interval::POSITIVE), "s", Required, "the period"),
                key(
                    "ramp",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "s",
                    Derived("two periods"),
                    "time within which the motion grows",
                ),
            ],
        },
        KindSpec {
            name: "solitary",
            meaning: "a solitary wave, by Goring's motion",
            dimensions: &[1, 2, 3],
            keys: &[key(
                "height",
                Kind::Number(Interval::POSITIVE),
                "m",
                Required,
                "of the crest over the water at rest",
            )],
        },
        KindSpec {
            name: "spectrum",
            meaning: "long-crested waves of the spectrum of JONSWAP, each component of linear theory",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "significant_height",
                    Kind::Number(Interval::POSITIVE),
                    "m",
                    Required,
                    "four times the standard deviation of the surface",
                ),
                key(
                    "peak_period",
                    Kind::Number(Interval::POSITIVE),
                    "s",
                    Required,
                    "period of the peak",
                ),
                key(
                    "gamma",
                    Kind::Number(Interval::between(1.0, 20.0)),
                    "1",
                    Default("3.3"),
                    "by how much the peak is raised; 1 is the spectrum of Pierson and Moskowitz",
                ),
                key(
                    "components",
                    Kind::Integer(Interval::between(1.0, 10000.0)),
                    "1",
                    Default("200"),
                    "number of components, of frequencies from 0.5 to 3 of that of the peak",
                ),
                key(
                    "seed",
                    Kind::Integer(Interval::NOT_NEGATIVE),
                    "1",
                    Default("1"),
                    "seed of their frequencies and phases",
                ),
                key(
                    "ramp",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "s",
                    Derived("two periods of the peak"),
                    "time within which the motion grows",
                ),
            ],
        },
    ],
};
