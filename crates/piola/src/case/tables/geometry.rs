//! Domain, bodies, materials and regions.

use super::shapes::{CORNERS, FLAT, ROUND, SHAPE};
use super::*;

pub(super) static DOMAIN: TableSpec = TableSpec {
    title: "[domain]",
    meaning: "The computational domain.",
    keys: &[key(
        "periodic",
        Kind::PerAxis(&Kind::Numbers(Length::Ends, Interval::ANY)),
        "m",
        Optional,
        "for each axis, the ends between which space is periodic",
    )],
};

pub(super) static BODY: TableSpec = TableSpec {
    title: "[[body]]",
    meaning: "A piece of one material, filled with particles.",
    keys: &[
        key("name", Kind::Text, "", Required, "unique name"),
        key(
            "system",
            Kind::Text,
            "",
            Derived("that of `[scheme]`"),
            "the `[[system]]` that it belongs to",
        ),
        key(
            "shape",
            Kind::Tagged(&SHAPE),
            "",
            Required,
            "region that it fills in the reference state",
        ),
        key(
            "spacing",
            Kind::NumberOrPerAxis(Interval::POSITIVE),
            "m",
            Derived("needed unless a file has the particles (`points`, `mesh`)"),
            "distance between particles, one number or one per axis; a square lattice is fitted to the shape with the nearest spacing that divides it into whole numbers. Those of a fluid and its walls may differ by 5 %",
        ),
        key("lattice", Kind::Table(&LATTICE), "", Default("{}"), "how the particles are arranged"),
        key(
            "material",
            Kind::Tagged(&MATERIAL),
            "",
            Derived("needed by all schemes but `interpolation`"),
            "its material",
        ),
        key("initial", Kind::Table(&INITIAL), "", Default("{}"), "its initial state"),
        key("wall", Kind::Table(&fluids::WALL), "", Optional, "makes the body a wall"),
        key(
            "opening",
            Kind::Table(&fluids::OPENING),
            "",
            Optional,
            "makes the body the buffer of an open boundary, an inlet or an outlet",
        ),
    ],
};

static LATTICE: TableSpec = TableSpec {
    title: "lattice",
    meaning: "How the particles of a body are arranged.",
    keys: &[
        key("kind", Kind::Name(LATTICES), "", Default("\"square\""), "arrangement"),
        key(
            "on",
            Kind::Name(ORIGINS),
            "",
            Default("\"boundary\""),
            "position of the first particle",
        ),
        key(
            "jitter",
            Kind::Number(Interval::between(0.0, 0.5)),
            "spacings",
            Default("0.0"),
            "largest random displacement of a particle",
        ),
        key(
            "seed",
            Kind::Integer(Interval::NOT_NEGATIVE),
            "1",
            Default("1"),
            "seed of the random displacements",
        ),
        key(
            "relax",
            Kind::Integer(Interval::between(0.0, 1000.0)),
            "1",
            Default("0"),
            "number of relaxation steps after that, which make the cloud more uniform but not a lattice; particles next to the faces of the shape stay in place",
        ),
    ],
};

const LATTICES: Choices = choices(&[
    choice("square", "square, in 3D cubic"),
    choice("cubic", "another name of `square` in 3D"),
    choice("hexagonal", "hexagonal"),
    choice(
        "concentric",
        "in layers that follow a round face: rings in a disc or an annulus and around the axis of a cylinder, shells in a ball; without ghosts and boundary areas",
    ),
    choice(
        "packed",
        "moved apart until they are even, the outermost half a spacing below the surface, in a shape of any kind but a union; all have the same volume. `piola check` shows how even their density is near the surface. Not around a periodic domain; without ghosts and boundary areas",
    ),
]);
const ORIGINS: Choices = choices(&[
    choice("boundary", "particles on the faces of the shape's box"),
    choice("cells", "particles half a spacing inside these faces"),
]);

pub(super) static REGION: TaggedSpec = TaggedSpec {
    title: "where",
    meaning: "A region that selects particles by their reference position.",
    common: &[],
    kinds: &[
        KindSpec { name: "all", meaning: "every particle", dimensions: &[1, 2, 3], keys: &[] },
        KindSpec {
            name: "plane",
            meaning: "within half a local spacing of a plane whose normal points out of the body; for a mesh, the particles of the boundary faces in the plane",
            dimensions: &[1, 2, 3],
            keys: FLAT,
        },
        KindSpec {
            name: "box",
            meaning: "in the box between two corners",
            dimensions: &[1, 2, 3],
            keys: CORNERS,
        },
        KindSpec {
            name: "ball",
            meaning: "within a distance of a point",
            dimensions: &[1, 2, 3],
            keys: ROUND,
        },
        KindSpec {
            name: "half_space",
            meaning: "on the side of a plane to which its normal points",
            dimensions: &[1, 2, 3],
            keys: FLAT,
        },
        KindSpec {
            name: "set",
            meaning: "a named set of a mesh: its nodes; for particles in cells, its cells and those behind its faces",
            dimensions: &[1, 2, 3],
            keys: &[key(
                "name",
                Kind::Text,
                "",
                Required,
                "name of a physical group of Gmsh, its number if it has none; `array:value` for an integer array of VTK",
            )],
        },
    ],
};

static MATERIAL: TaggedSpec = TaggedSpec {
    title: "material",
    meaning: "The material of a body.",
    common: &[key(
        "density",
        Kind::Number(Interval::POSITIVE),
        "kg/m^3",
        Required,
        "reference density",
    )],
    kinds: &[
        KindSpec {
            name: "linear",
            meaning: "pressure linear in the volume ratio, p = -kappa (J - 1); give `bulk_modulus`, `wave_speed`, or `young_modulus` with `poisson_ratio`",
            dimensions: &[1, 2, 3],
            keys: &[
                PRESSURE_MODULUS,
                WAVE_SPEED,
                key(
                    "young_modulus",
                    Kind::Number(Interval::POSITIVE),
                    "Pa",
                    Optional,
                    "Young's modulus, instead of `bulk_modulus`",
                ),
                key(
                    "poisson_ratio",
                    Kind::Number(Interval::ANY),
                    "1",
                    Optional,
                    "Poisson's ratio, above -1 and below 0.5 (0.5 itself is allowed in plane and uniaxial stress)",
                ),
                key(
                    "plane",
                    Kind::Name(PLANES),
                    "",
                    Derived("`stress`; no meaning in 3D"),
                    "assumption for the directions that are not resolved",
                ),
            ],
        },
        KindSpec {
            name: "gamma_law",
            meaning: "p = kappa (J^-gamma - 1), Upwind (6.30); give `bulk_modulus` or `wave_speed`",
            dimensions: &[1, 2, 3],
            keys: &[
                PRESSURE_MODULUS,
                WAVE_SPEED,
                key("gamma", Kind::Number(Interval::at_least(1.0)), "1", Required, "exponent"),
            ],
        },
        KindSpec {
            name: "weakly_compressible",
            meaning: "a fluid with p = kappa (rho / rho0 - 1), CTVF (8); give `wave_speed`, ten times the largest speed, or `bulk_modulus`",
            dimensions: &[1, 2, 3],
            keys: &[
                PRESSURE_MODULUS,
                WAVE_SPEED,
                key(
                    "viscosity",
                    Kind::Number(Interval::NOT_NEGATIVE),
                    "m^2/s",
                    Default("0.0"),
                    "kinematic viscosity",
                ),
            ],
        },
        solids::LINEAR_ELASTIC,
        solids::SAINT_VENANT_KIRCHHOFF,
        solids::NEO_HOOKEAN,
        solids::NEO_HOOKEAN_LOGARITHMIC,
        solids::MOONEY_RIVLIN,
        solids::OGDEN,
        solids::HYPERELASTIC,
        solids::RIGID,
        plastic::HYPOELASTIC,
    ],
};

const PRESSURE_MODULUS: KeySpec = key(
    "bulk_modulus",
    Kind::Number(Interval::POSITIVE),
    "Pa",
    Optional,
    "modulus kappa of the pressure law",
);
const WAVE_SPEED: KeySpec = key(
    "wave_speed",
    Kind::Number(Interval::POSITIVE),
    "m/s",
    Optional,
    "wave speed of the reference state, instead of `bulk_modulus`",
);

pub(super) const PLANES: Choices =
    choices(&[choice("stress", "zero stress in them"), choice("strain", "zero strain in them")]);

static INITIAL: TableSpec = TableSpec {
    title: "initial",
    meaning: "Initial state of a body, as expressions of the reference position.",
    keys: &[
        key(
            "velocity",
            Kind::Expressions(Variables::AtStart),
            "m/s",
            Derived("0"),
            "one expression per component",
        ),
        key(
            "displacement",
            Kind::Expressions(Variables::AtStart),
            "m",
            Derived("0"),
            "one expression per component; for the scheme `total_lagrangian`",
        ),
        key(
            "pressure",
            Kind::Expression(Variables::AtStart),
            "Pa",
            Default("0.0"),
            "initial pressure, positive in compression",
        ),
    ],
};
