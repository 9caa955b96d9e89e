//! Probes, output, pictures and plots.

use super::*;

pub(super) static PROBE: TaggedSpec = TaggedSpec {
    title: "[[probe]]",
    meaning: "Something recorded against time in the tables, or along a line.",
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
                    "relative_to",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Optional,
                    "another point of the same body: what the particle there has is subtracted, as for the deflection of a part whose supports move",
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
                key(
                    "min",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Optional,
                    "lower corner of a box: of these particles only those that are in it at the time \
                     count, and where none is there is no value",
                ),
                key(
                    "max",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Optional,
                    "upper corner of that box",
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
            name: "mean",
            meaning: "the mean of a field over a selection, for example of `velocity` over a body",
            dimensions: &[1, 2, 3],
            keys: &[
                key("field", Kind::Text, "", Required, "a field, with all its components"),
                WHERE,
            ],
        },
        KindSpec {
            name: "force",
            meaning: "the resultant of the forces of a fluid on a wall or a solid, and their moment: columns `NAME.FIELD` and `NAME.moment`",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "field",
                    Kind::Text,
                    "",
                    Default("\"force\""),
                    "a field of forces: `force`, or a part of it: `pressure_force`, `viscous_force`, `barrier_force`; of solids `contact_force`, what they touch",
                ),
                key(
                    "about",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Derived("the origin"),
                    "the point of space that the moment is about",
                ),
                WHERE,
            ],
        },
        KindSpec {
            name: "sensor",
            meaning: "the pressure that a round sensor in a wall has: the force of the fluid on the patch of the wall over its area; column `NAME.pressure`. In a wall thinner than a support, what is on its far side counts too",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "at",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "its middle, on the face of the wall",
                ),
                key(
                    "normal",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "",
                    Required,
                    "the normal of the face there, towards the fluid, of any length",
                ),
                key(
                    "radius",
                    Kind::Number(Interval::POSITIVE),
                    "m",
                    Required,
                    "its radius; of its edge, a spacing wide, a part counts",
                ),
            ],
        },
        KindSpec {
            name: "gauge",
            meaning: "how far a fluid reaches along a line that is a support or more away from walls, like the free surface over the floor: column `NAME.elevation`, the distance from `from`",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "from",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "where the line starts, below the surface",
                ),
                key(
                    "to",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "where it ends, above all that may come",
                ),
            ],
        },
        KindSpec {
            name: "flux",
            meaning: "the mass of a fluid that goes through a plane in a second: column `NAME.flux`",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "point",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "a point of the plane",
                ),
                key(
                    "normal",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "1",
                    Required,
                    "its normal, of any length: the way in which the flux is positive",
                ),
                key(
                    "min",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Optional,
                    "lower corner of a box outside of which nothing counts",
                ),
                key(
                    "max",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Optional,
                    "upper corner of that box",
                ),
            ],
        },
        KindSpec {
            name: "opening",
            meaning: "what has gone through an open boundary of a fluid, which `body` names: the mass that has come in and gone out, columns `NAME.entered` and `NAME.left`, and the energy and momentum of particles that have come in less those of particles that have gone out, without what pressure does to them there, `NAME.energy`, `NAME.linear.x` and on",
            dimensions: &[1, 2, 3],
            keys: &[],
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
                    "relative_to",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Optional,
                    "another point: what is there is subtracted, as for the pressure between front and back of a body in a stream",
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
            name: "tangent",
            meaning: "the Taylor test of the tangent of an implicit step of `upwind` from the state of \
                      the moment, for those who change the formulation: `NAME.least_slope` and \
                      `NAME.largest_slope` are 2 where it is exact",
            dimensions: &[1, 2, 3],
            keys: &[key(
                "step",
                Kind::Number(Interval::POSITIVE),
                "s",
                Required,
                "length of the step that is tested",
            )],
        },
        KindSpec {
            name: "line",
            meaning: "a profile: fields interpolated at places along a straight line, against the distance from its start; each in a file of its own, the last one for plots and checks",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "from",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "where it starts",
                ),
                key(
                    "to",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "where it ends",
                ),
                key(
                    "points",
                    Kind::Integer(Interval::between(2.0, 10_000.0)),
                    "1",
                    Default("101"),
                    "number of places, at the same distance from each other, both ends among them",
                ),
                key(
                    "fields",
                    Kind::List(&Kind::Text),
                    "",
                    Required,
                    "names of fields, recorded with all their components",
                ),
                key(
                    "times",
                    Kind::Numbers(Length::Any, Interval::NOT_NEGATIVE),
                    "s",
                    Derived("those of the particle files, and the end"),
                    "times of the profiles",
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
                    "a field with one number a particle, or FIELD.COMPONENT, or FIELD.magnitude; with `components` a vector field",
                ),
                key(
                    "exact",
                    Kind::Expression(Variables::PositionAndTime),
                    "",
                    Derived("required unless there are `components`"),
                    "what it should be, of the current position and time",
                ),
                key(
                    "components",
                    Kind::PerAxis(&Kind::Expression(Variables::PositionAndTime)),
                    "",
                    Derived("none"),
                    "what components of a vector should be, instead of `exact`; those that are left away do not count",
                ),
                key(
                    "without_mean",
                    Kind::Boolean,
                    "",
                    Default("false"),
                    "whether the means of both are taken away first, as of a pressure without a zero",
                ),
                key(
                    "norm",
                    Kind::Name(NORMS),
                    "",
                    Default("\"absolute\""),
                    "what is summed over the particles",
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

const NORMS: Choices = choices(&[
    choice("absolute", "absolute values"),
    choice("square", "squares, of which the root is taken"),
    choice(
        "volume",
        "squares times reference volumes, of which the root is taken, Dual-support (56)",
    ),
]);
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
        key(
            "report",
            Kind::Boolean,
            "",
            Default("true"),
            "whether the run ends with `report.html`, one page with all of its results",
        ),
    ],
};

const COMPRESSIONS: Choices = choices(&[choice("zlib", "with zlib"), choice("none", "not at all")]);

pub(super) static PICTURE: TableSpec = TableSpec {
    title: "[[picture]]",
    meaning: "A picture of the particles coloured by a field. In 3D walls of ghost particles are left out, which would hide what is between them.",
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
    meaning: "Curves of the tables against time, or along a line, with the reference curves of checks.",
    keys: &[
        key("name", Kind::Text, "", Required, "unique name of the picture"),
        key(
            "curves",
            Kind::List(&Kind::Text),
            "",
            Required,
            "columns of the tables, for example `top.displacement.y` or `energy.total`; all against time, or all of lines",
        ),
        key(
            "over_time",
            Kind::Boolean,
            "",
            Default("false"),
            "of one column of a line: a map of all its profiles in colours, over place and time",
        ),
    ],
};
