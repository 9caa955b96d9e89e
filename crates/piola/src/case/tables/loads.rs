//! What acts on bodies: loads and boundaries.

use super::*;

/// A factor over time.
pub(super) const HISTORY: KeySpec = key(
    "history",
    Kind::File,
    "",
    Optional,
    "CSV file with two columns, time in s (in statics the load factor) and a factor by which all expressions here are multiplied; interpolated linearly between rows, constant beyond them",
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
            "name of the body on which it acts",
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
                "one expression per component, of time and the reference position (the current one with `transport_velocity`)",
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
                    "particles of the surface on which it acts",
                ),
                key(
                    "traction",
                    Kind::Expressions(Variables::PositionAndTime),
                    "Pa",
                    Required,
                    "one expression per component, of the reference position and time",
                ),
            ],
        },
        KindSpec {
            name: "pressure",
            meaning: "a follower pressure, along the current normal and on the current area of the surface; for the scheme `total_lagrangian` with `form = \"adjoint\"`",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "where",
                    Kind::Tagged(&geometry::REGION),
                    "",
                    Required,
                    "surface on which it acts: for a plane the side to which its normal points, for other regions all sides",
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
            meaning: "a spring with a damper between the centre of mass of the particles and a fixed point; the force is shared among the particles by mass; for the scheme `total_lagrangian` with explicit steps",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "where",
                    Kind::Tagged(&geometry::REGION),
                    "",
                    Default("{ kind = \"all\" }"),
                    "particles to which it is attached",
                ),
                key(
                    "to",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "m",
                    Required,
                    "fixed point to which it is attached",
                ),
                key(
                    "stiffness",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "N/m",
                    Default("0.0"),
                    "stiffness of the spring, for 1 m in missing dimensions",
                ),
                key(
                    "damping",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "N s/m",
                    Default("0.0"),
                    "coefficient of the damper",
                ),
                key(
                    "length",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "m",
                    Derived("the initial distance"),
                    "length at zero force",
                ),
            ],
        },
    ],
};

pub(super) static BOUNDARY: TableSpec = TableSpec {
    title: "[[boundary]]",
    meaning: "Prescribed velocities (displacements in statics) of selected particles.",
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
            "prescribed components, as expressions of the reference position and time",
        ),
        key(
            "wave_maker",
            Kind::Tagged(&waves::WAVE_MAKER),
            "",
            Optional,
            "for a wall of a fluid, instead of `velocity`: a piston that makes waves",
        ),
        key(
            "angular_velocity",
            Kind::Table(&TURN),
            "rad/s",
            Optional,
            "for a rigid body: prescribed components; `velocity` is then that of its centre of mass, or of `pivot`",
        ),
        key(
            "pivot",
            Kind::Numbers(Length::Dimension, Interval::ANY),
            "m",
            Optional,
            "for a rigid body: a point that moves with it, inside or outside, all of whose components are prescribed by `velocity`; a hinge if they are 0",
        ),
        key(
            "mirror",
            Kind::Boolean,
            "",
            Optional,
            "with the scheme `total_lagrangian`: whether mirror images continue the body beyond the plane selected by `where`, normal to an axis, with a uniform prescribed normal velocity (displacement in statics): a symmetry plane or a roller",
        ),
        key(
            "displacement",
            Kind::PerAxis(&Kind::Expression(Variables::PositionAndTime)),
            "m",
            Optional,
            "with the integrators `static` and `arc_length`: prescribed components, as expressions of the reference position and the load factor `t`",
        ),
        key(
            "roller",
            Kind::Table(&ROLLER),
            "",
            Optional,
            "with the integrators `static` and `arc_length`: a plane along which the particles can move",
        ),
        key(
            "tied",
            Kind::List(&Kind::Name(AXES)),
            "",
            Optional,
            "with the integrators `static` and `arc_length`: components of the displacement shared by all particles, like those of the face of a rigid platen",
        ),
    ],
};

static TURN: TableSpec = TableSpec {
    title: "angular_velocity",
    meaning: "Prescribed components of an angular velocity, as expressions of time.",
    keys: &[turn("x"), turn("y"), turn("z")],
};

const fn turn(axis: &'static str) -> KeySpec {
    key(
        axis,
        Kind::Expression(Variables::PositionAndTime),
        "rad/s",
        Optional,
        "about this axis; in 2D only `z`",
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
