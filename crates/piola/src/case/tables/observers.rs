//! Probes, output, pictures, plots and checks.

use super::*;

pub(super) static PROBE: TaggedSpec = TaggedSpec {
    title: "[[probe]]",
    meaning: "Something recorded against time in the tables.",
    common: &[
        key("name", Kind::Text, "", Required, "unique name, the first part of its columns"),
        key("body", Kind::Text, "", Derived("all bodies"), "name of the body that it looks at"),
    ],
    kinds: &[
        KindSpec {
            name: "particle",
            meaning: "the particle that is nearest to a point in the reference state",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "at",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "the point",
                ),
                key(
                    "fields",
                    Kind::List(&Kind::Text),
                    "",
                    Required,
                    "names of fields, recorded with all their components",
                ),
            ],
        },
        KindSpec {
            name: "extremum",
            meaning: "the largest or smallest value over a selection",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "field",
                    Kind::Text,
                    "",
                    Required,
                    "a field with one number a particle, or FIELD.COMPONENT, or FIELD.magnitude",
                ),
                key("of", Kind::Name(EXTREMA), "", Required, "which one"),
                key(
                    "where",
                    Kind::Tagged(&super::geometry::REGION),
                    "",
                    Default("{ kind = \"all\" }"),
                    "the particles, selected in the reference state",
                ),
            ],
        },
        KindSpec {
            name: "sum",
            meaning: "the sum of a field over a selection, for example of `force` over a wall",
            dimensions: &[1, 2, 3],
            keys: &[
                key("field", Kind::Text, "", Required, "a field, summed with all its components"),
                WHERE,
            ],
        },
        KindSpec {
            name: "point",
            meaning: "fields interpolated at a fixed point of space",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "at",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "the point",
                ),
                key(
                    "fields",
                    Kind::List(&Kind::Text),
                    "",
                    Required,
                    "names of fields, recorded with all their components",
                ),
            ],
        },
        KindSpec {
            name: "error",
            meaning: "the sum of the differences of a field from what it should be, over the sum of what it should be",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "field",
                    Kind::Text,
                    "",
                    Required,
                    "a field with one number a particle, or FIELD.COMPONENT, or FIELD.magnitude",
                ),
                key(
                    "exact",
                    Kind::Expression(Variables::PositionAndTime),
                    "",
                    Required,
                    "what it should be, of the current position and time",
                ),
                key(
                    "without_mean",
                    Kind::Boolean,
                    "",
                    Default("false"),
                    "whether the means of both are taken away first, as of a pressure without a zero",
                ),
                WHERE,
            ],
        },
    ],
};

const WHERE: KeySpec = key(
    "where",
    Kind::Tagged(&super::geometry::REGION),
    "",
    Default("{ kind = \"all\" }"),
    "the particles, selected in the reference state",
);

const EXTREMA: Choices =
    choices(&[choice("largest", "the largest value"), choice("smallest", "the smallest value")]);

pub(super) static OUTPUT: TableSpec = TableSpec {
    title: "[output]",
    meaning: "What is written and when.",
    keys: &[
        key(
            "every",
            Kind::Number(Interval::POSITIVE),
            "s",
            Derived("a hundredth of `time.end`"),
            "time between particle files",
        ),
        key(
            "table_every",
            Kind::Number(Interval::POSITIVE),
            "s",
            Derived("`every`"),
            "time between rows of the tables",
        ),
        key(
            "fields",
            Kind::List(&Kind::Text),
            "",
            Derived("all fields of the scheme"),
            "names of the fields in the particle files",
        ),
        key(
            "compression",
            Kind::Name(COMPRESSIONS),
            "",
            Default("\"zlib\""),
            "how the particle files are packed",
        ),
    ],
};

const COMPRESSIONS: Choices = choices(&[choice("zlib", "with zlib"), choice("none", "not at all")]);

pub(super) static PICTURE: TableSpec = TableSpec {
    title: "[[picture]]",
    meaning: "A picture of the particles coloured by a field.",
    keys: &[
        key(
            "field",
            Kind::Text,
            "",
            Required,
            "a field with one number a particle, or FIELD.COMPONENT, or FIELD.magnitude",
        ),
        key(
            "times",
            Kind::Numbers(Length::Any, Interval::NOT_NEGATIVE),
            "s",
            Derived("`time.end`"),
            "times of the pictures",
        ),
        key(
            "range",
            Kind::Numbers(Length::Ends, Interval::ANY),
            "",
            Derived("the range of the data"),
            "ends of the colour bar, in the unit of the field",
        ),
    ],
};

pub(super) static PLOT: TableSpec = TableSpec {
    title: "[[plot]]",
    meaning: "Curves of the tables against time.",
    keys: &[
        key("name", Kind::Text, "", Required, "unique name of the picture"),
        key(
            "curves",
            Kind::List(&Kind::Text),
            "",
            Required,
            "columns of the tables, for example `top.displacement.y` or `energy.total`",
        ),
    ],
};

pub(super) static CHECK: TableSpec = TableSpec {
    title: "[[check]]",
    meaning: "A quantity of a run and what is expected of it: `expected` with `tolerance`, or `at_least` and `at_most`, or `less_than` or `more_than`.",
    keys: &[
        key(
            "variant",
            Kind::Text,
            "",
            Default("\"base\""),
            "the variant that is run, `base` for the case itself",
        ),
        key(
            "quantity",
            Kind::Text,
            "",
            Required,
            "column of a table: PROBE.FIELD, PROBE.FIELD.COMPONENT, energy.NAME, momentum.NAME, step.NAME, run.NAME",
        ),
        key(
            "reduce",
            Kind::Name(Choices::Registry(catalogue::reductions)),
            "",
            Default("\"final\""),
            "how its history becomes one number; no meaning for run.NAME",
        ),
        key(
            "at",
            Kind::Number(Interval::NOT_NEGATIVE),
            "s",
            Optional,
            "the time, for the reduction `at`",
        ),
        key(
            "number",
            Kind::Integer(Interval::at_least(1.0)),
            "1",
            Default("1"),
            "which one, counted from 1, for `extremum`, `extremum_time` and `zero_time`",
        ),
        key(
            "reference",
            Kind::File,
            "",
            Optional,
            "CSV file with the columns time and value, for `curve` and `curve_rms`",
        ),
        key(
            "expected",
            Kind::NumberOrText,
            "",
            Optional,
            "the value, in the unit of the quantity; text for run.outcome",
        ),
        key(
            "tolerance",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Optional,
            "largest difference as a share of `expected`",
        ),
        key(
            "absolute",
            Kind::Boolean,
            "",
            Default("false"),
            "whether `tolerance` has the unit of the quantity instead",
        ),
        key("at_least", Kind::Number(Interval::ANY), "", Optional, "smallest value that passes"),
        key("at_most", Kind::Number(Interval::ANY), "", Optional, "largest value that passes"),
        key("less_than", Kind::Text, "", Optional, "name of a variant whose value is larger"),
        key("more_than", Kind::Text, "", Optional, "name of a variant whose value is smaller"),
        key("source", Kind::Text, "", Required, "where the expected value comes from"),
        key(
            "when",
            Kind::Name(SETTINGS),
            "",
            Default("\"always\""),
            "at which setting it is evaluated",
        ),
    ],
};

const SETTINGS: Choices = choices(&[
    choice("always", "at both settings"),
    choice("coarse", "at the coarse setting only"),
    choice("full", "at the full setting only"),
]);
