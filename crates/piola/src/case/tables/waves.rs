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
            "direction of the waves, a vector of any length",
        ),
    ],
    kinds: &[
        KindSpec {
            name: "regular",
            meaning: "second-order regular waves",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "height",
                    Kind::Number(Interval::POSITIVE),
                    "m",
                    Required,
                    "wave height, from trough to crest",
                ),
                key("period", Kind::Number(Interval::POSITIVE), "s", Required, "wave period"),
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
            meaning: "a solitary wave, with Goring's motion",
            dimensions: &[1, 2, 3],
            keys: &[key(
                "height",
                Kind::Number(Interval::POSITIVE),
                "m",
                Required,
                "height of the crest above the water at rest",
            )],
        },
        KindSpec {
            name: "spectrum",
            meaning: "long-crested waves with a JONSWAP spectrum, with components of linear theory",
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
                    "peak enhancement factor; 1 is the Pierson-Moskowitz spectrum",
                ),
                key(
                    "components",
                    Kind::Integer(Interval::between(1.0, 10000.0)),
                    "1",
                    Default("200"),
                    "number of components, with frequencies from 0.5 to 3 times the peak frequency",
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
