//! What acts on bodies: loads and boundaries.

use super::*;

/// A factor over time.
pub(super) const HISTORY: KeySpec = key(
    "history",
    Kind::File,
    "",
    Optional,
    "CSV file of two columns, time in s (in statics the load factor) and a factor: all expressions here are multiplied with it; straight lines between its rows, the first and the last value beyond them",
);

pub(super) static LOAD: TaggedSpec = TaggedSpec {
    title: "[[load]]",
    meaning: "A force on particles.",
    common: &[
        key("name", Kind::Text, "", Optional, "name for overrides and messages"),
        key(
            "body",
            Kind::Text,
            "",
            Derived("all bodies; a traction or pressure needs it if there are several"),
            "name of the body that it acts on",
        ),
        HISTORY,
    ],
    kinds: &[
        KindSpec {
            name: "body_force",
            meaning: "an acceleration of every particle",
            dimensions: &[1, 2, 3],
            keys: &[key(
                "acceleration",
                Kind::Expressions(Variables::PositionAndTime),
                "m/s^2",
                Required,
                "one expression a component, of time and the reference position, with `transport_velocity` the current one",
            )],
        },
        KindSpec {
            name: "traction",
            meaning: "a force per reference area that keeps its direction",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "where",
                    Kind::Tagged(&geometry::REGION),
                    "",
                    Required,
                    "the particles of the surface that it acts on",
                ),
                key(
                    "traction",
                    Kind::Expressions(Variables::PositionAndTime),
                    "Pa",
                    Required,
                    "one expression a component, of the reference position and time",
                ),
            ],
        },
        KindSpec {
            name: "pressure",
            meaning: "a pressure that follows the surface, along its normal and on its area of the moment; for the scheme `total_lagrangian` with `form = \"adjoint\"`",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "where",
                    Kind::Tagged(&geometry::REGION),
                    "",
                    Required,
                    "the surface that it acts on: in a plane the side that its normal points to, in other regions all sides",
                ),
                key(
                    "pressure",
                    Kind::Expression(Variables::PositionAndTime),
                    "Pa",
                    Required,
                    "positive in compression, of the reference position and time",
                ),
            ],
        },
        KindSpec {
            name: "spring",
            meaning: "a spring with a damper from the centre of mass of the particles to a point of space, each of which gets the share of its mass; for the scheme `total_lagrangian` in explicit steps",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "where",
                    Kind::Tagged(&geometry::REGION),
                    "",
                    Default("{ kind = \"all\" }"),
                    "the particles that it is tied to",
                ),
                key(
                    "to",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "the point that it is tied to",
                ),
                key(
                    "stiffness",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "N/m",
                    Default("0.0"),
                    "of the spring, for 1 m in missing dimensions",
                ),
                key(
                    "damping",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "N s/m",
                    Default("0.0"),
                    "of the damper",
                ),
                key(
                    "length",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "m",
                    Derived("that of the start"),
                    "its length without force",
                ),
            ],
        },
    ],
};

pub(super) static BOUNDARY: TableSpec = TableSpec {
    title: "[[boundary]]",
    meaning: "Prescribed velocities, in statics displacements, of a selection of particles.",
    keys: &[
        key("name", Kind::Text, "", Required, "unique name"),
        key("body", Kind::Text, "", Derived("all bodies"), "name of the body"),
        key(
            "where",
            Kind::Tagged(&geometry::REGION),
            "",
            Required,
            "the particles, selected in the reference state",
        ),
        HISTORY,
        key(
            "velocity",
            Kind::PerAxis(&Kind::Expression(Variables::PositionAndTime)),
            "m/s",
            Optional,
            "the components that are prescribed, as expressions of the reference position and time",
        ),
        key(
            "wave_maker",
            Kind::Tagged(&waves::WAVE_MAKER),
            "",
            Optional,
            "of a wall of a fluid, instead of `velocity`: a piston that makes waves",
        ),
        key(
            "angular_velocity",
            Kind::Table(&TURN),
            "rad/s",
            Optional,
            "of a rigid body: the components that are prescribed; `velocity` is then that of its centre of mass, or of `pivot`",
        ),
        key(
            "pivot",
            Kind::Numbers(Length::Dimension, Interval::ANY),
            "m",
            Optional,
            "of a rigid body: a point that goes with it, in it or not, of which `velocity` prescribes all components: a hinge where they are 0",
        ),
        key(
            "mirror",
            Kind::Boolean,
            "",
            Optional,
            "with the scheme `total_lagrangian`: whether mirror images continue the body beyond the plane that `where` selects, across an axis, with the velocity across prescribed, in statics the displacement, the same all over it: a symmetry plane or a roller",
        ),
        key(
            "displacement",
            Kind::PerAxis(&Kind::Expression(Variables::PositionAndTime)),
            "m",
            Optional,
            "with the integrators `static` and `arc_length`: the components that are prescribed, as expressions of the reference position and the load factor `t`",
        ),
        key(
            "roller",
            Kind::Table(&ROLLER),
            "",
            Optional,
            "with the integrators `static` and `arc_length`: a plane that the particles can only move along",
        ),
        key(
            "tied",
            Kind::List(&Kind::Name(AXES)),
            "",
            Optional,
            "with the integrators `static` and `arc_length`: components of the displacement that all particles have in common, like those of the face of a rigid platen",
        ),
    ],
};

static TURN: TableSpec = TableSpec {
    title: "angular_velocity",
    meaning: "Components of an angular velocity that are prescribed, as expressions of time.",
    keys: &[turn("x"), turn("y"), turn("z")],
};

const fn turn(axis: &'static str) -> KeySpec {
    key(
        axis,
        Kind::Expression(Variables::PositionAndTime),
        "rad/s",
        Optional,
        "about this axis; in 2D there is `z` alone",
    )
}

const AXES: Choices = choices(&[
    choice("x", "the first component"),
    choice("y", "the second component"),
    choice("z", "the third component"),
]);

static ROLLER: TableSpec = TableSpec {
    title: "roller",
    meaning: "A plane of any inclination. Particles are held along its normal and free along it.",
    keys: &[
        key(
            "normal",
            Kind::Numbers(Length::Dimension, Interval::ANY),
            "1",
            Required,
            "normal of the plane, of any length",
        ),
        key(
            "displacement",
            Kind::Expression(Variables::PositionAndTime),
            "m",
            Default("\"0\""),
            "displacement along the normal, as an expression of the reference position and the load factor `t`",
        ),
    ],
};
