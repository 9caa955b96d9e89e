//! Probes, output, pictures and plots.

use super::*;

pub(super) static PROBE: TaggedSpec = TaggedSpec {
    title: "[[probe]]",
    meaning: "Something recorded against time in the tables, or along a line.",
    common: &[
        key("name", Kind::Text, "", Required, "unique name, the first part of its columns"),
        key("body", Kind::Text, "", Derived("all bodies"), "name of the body that it observes"),
    ],
    kinds: &[
        KindSpec {
            name: "particle",
            meaning: "the particle nearest to a point in the reference state",
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
                    "another point of the same body: the values of the particle there are subtracted, for example for the deflection of a part whose supports move",
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
                    "a scalar field, or FIELD.COMPONENT, or FIELD.magnitude",
                ),
                key("of", Kind::Name(EXTREMA), "", Required, "largest or smallest"),
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
                    "lower corner of a box: only particles that are currently in it count; if there are none there is no value",
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
                    "a field of forces: `force`, or a part of it: `pressure_force`, `viscous_force`, `barrier_force`; for solids `contact_force`, the force of contact",
                ),
                key(
                    "about",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Derived("the origin"),
                    "point about which the moment is taken",
                ),
                WHERE,
            ],
        },
        KindSpec {
            name: "sensor",
            meaning: "the pressure on a round sensor in a wall: the force of the fluid on the patch of the wall over its area; column `NAME.pressure`. In a wall thinner than a support, fluid on its far side counts too",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "at",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "centre, on the face of the wall",
                ),
                key(
                    "normal",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "",
                    Required,
                    "normal of the face there, towards the fluid, of any length",
                ),
                key(
                    "radius",
                    Kind::Number(Interval::POSITIVE),
                    "m",
                    Required,
                    "radius; within its edge, a spacing wide, forces count partly",
                ),
            ],
        },
        KindSpec {
            name: "gauge",
            meaning: "how far a fluid extends along a line at least a support away from walls, for example the height of the free surface above the floor: column `NAME.elevation`, the distance from `from`",
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
                    "where it ends, above any expected level",
                ),
            ],
        },
        KindSpec {
            name: "flux",
            meaning: "the mass flow rate of a fluid through a plane: column `NAME.flux`",
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
                    "its normal, of any length: the direction of positive flux",
                ),
                key(
                    "min",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Optional,
                    "lower corner of a box outside which nothing counts",
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
            name: "void",
            meaning: "the largest void: points farther than a spacing from all particles, those of walls included, with no empty way out of the box around them all; column `NAME.volume`, its volume (area in 2D). With the key `body` only particles of that body count. In a closed tank that is not full, the air is a void. No value if particles are so far apart that the grid, a third of a spacing fine, would need more than 1e8 cells",
            dimensions: &[2, 3],
            keys: &[],
        },
        KindSpec {
            name: "opening",
            meaning: "what has passed through an open boundary of a fluid, named by `body`: the mass that has entered and left, columns `NAME.entered` and `NAME.left`, and the energy and momentum of particles that have entered minus those of particles that have left, without the work and impulse of the pressure there, `NAME.energy`, `NAME.linear.x` and so on",
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
                    "another point: the values there are subtracted, for example for the pressure difference between front and back of a body in a stream",
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
                "length of the tested step",
            )],
        },
        KindSpec {
            name: "line",
            meaning: "a profile: fields interpolated at points along a straight line, against the distance from its start; each profile is a separate file, and plots and checks use the last one",
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
                    "number of equidistant points, including both ends",
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
                key(
                    "mean_over",
                    Kind::Number(Interval::POSITIVE),
                    "s",
                    Optional,
                    "time before each of `times`, at most back to the one before, over which a profile is the mean, of samples \
                     as frequent as the rows of the tables",
                ),
            ],
        },
        KindSpec {
            name: "error",
            meaning: "the sum of the differences of a field from its exact value, over the sum of the exact value",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "field",
                    Kind::Text,
                    "",
                    Required,
                    "a scalar field, or FIELD.COMPONENT, or FIELD.magnitude; with `components` a vector field",
                ),
                key(
                    "exact",
                    Kind::Expression(Variables::PositionAndTime),
                    "",
                    Derived("required unless there are `components`"),
                    "exact value, as an expression of the current position and time",
                ),
                key(
                    "components",
                    Kind::PerAxis(&Kind::Expression(Variables::PositionAndTime)),
                    "",
                    Derived("none"),
                    "exact values of the components of a vector, instead of `exact`; omitted components do not count",
                ),
                key(
                    "without_mean",
                    Kind::Boolean,
                    "",
                    Default("false"),
                    "whether the means of both are subtracted first, for example for a pressure without a reference level",
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
            "how the particle files are compressed",
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

const COMPRESSIONS: Choices =
    choices(&[choice("zlib", "by zlib"), choice("none", "no compression")]);

pub(super) static PICTURE: TableSpec = TableSpec {
    title: "[[picture]]",
    meaning: "A picture of the particles coloured by a field. In 3D walls of ghost particles are left out, as they would hide what is between them.",
    keys: &[
        key(
            "field",
            Kind::Text,
            "",
            Required,
            "a scalar field, or FIELD.COMPONENT, or FIELD.magnitude",
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
            "limits of the colour bar, in the unit of the field",
        ),
        key(
            "from",
            Kind::Numbers(Length::Dimension, Interval::ANY),
            "m",
            Derived("that of the particles"),
            "the corner with the smallest coordinates of the part that is shown; with `to`",
        ),
        key(
            "to",
            Kind::Numbers(Length::Dimension, Interval::ANY),
            "m",
            Derived("that of the particles"),
            "the corner with the largest coordinates",
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
            "for one column of a line: a colour map of all its profiles, over position and time",
        ),
    ],
};
