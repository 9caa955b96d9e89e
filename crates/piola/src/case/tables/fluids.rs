//! The scheme `transport_velocity` and walls.

use super::*;

pub(super) const TRANSPORT_VELOCITY: KindSpec = KindSpec {
    name: "transport_velocity",
    meaning: "weakly compressible fluids, or elastic-plastic solids, that move with a corrected transport velocity",
    dimensions: &[1, 2, 3],
    keys: &[
        key(
            "kernel",
            Kind::Name(Choices::Registry(catalogue::kernels)),
            "",
            Default("\"quintic_spline\""),
            "smoothing kernel",
        ),
        key(
            "smoothing_length",
            Kind::Number(Interval::POSITIVE),
            "spacings",
            Default("1.0"),
            "smoothing length h in units of the particle spacing",
        ),
        key(
            "density",
            Kind::Name(DENSITIES),
            "",
            Default("\"continuity\""),
            "how the density is computed",
        ),
        key(
            "pressure",
            Kind::Name(PRESSURES),
            "",
            Derived("`edac`; `state_equation` for solids"),
            "how the pressure is computed",
        ),
        key(
            "pressure_diffusion",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Derived("0.5; 0.001 for solids"),
            "factor of the diffusivity of the pressure, CTVF (24); for `edac`",
        ),
        key(
            "density_relaxation",
            Kind::Number(Interval::between(0.0, 1.0)),
            "1",
            Derived("0.002; 0.01 with `corrected_gradients`; no meaning for solids"),
            "rate in units of c/h at which the density of a fluid with `free_surface` relaxes to the summation density, with `spst`, theory (108)",
        ),
        key(
            "corrections",
            Kind::Name(CORRECTIONS),
            "",
            Default("\"full\""),
            "correction terms for particles that do not move with their velocity",
        ),
        key(
            "shifting",
            Kind::Name(SHIFTINGS),
            "",
            Default("\"spst\""),
            "how particles are kept evenly distributed",
        ),
        key(
            "shifting_factor",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Default("1.0"),
            "factor of the velocity deviation of `spst`, CTVF (35)",
        ),
        key(
            "shifting_tolerance",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Default("0.001"),
            "tolerance at which the passes of `ipst` stop, CTVF (39)",
        ),
        key(
            "shifting_passes",
            Kind::Integer(Interval::between(1.0, 100.0)),
            "1",
            Default("5"),
            "maximum number of passes of `ipst` per step",
        ),
        key(
            "background_pressure",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Derived("1.0; for `background`"),
            "largest background pressure of `background` in units of rho_0 c^2",
        ),
        key(
            "viscous_force",
            Kind::Name(VISCOUS),
            "",
            Derived("`laplacian`; no meaning for solids"),
            "form of the viscous forces, which differs only at free surfaces",
        ),
        key(
            "artificial_viscosity",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Default("0.0"),
            "factor alpha of the artificial viscosity, CTVF (28)",
        ),
        key(
            "damping",
            Kind::Expression(Variables::Position),
            "1/s",
            Derived("none; no meaning for solids"),
            "rate at which motion dies out, as an expression of the current position: a beach that absorbs waves, theory (92)",
        ),
        key(
            "free_surface",
            Kind::Boolean,
            "",
            Derived("false; true for solids"),
            "whether free surfaces are detected, near which shifting is limited, CTVF (44), (45)",
        ),
        key(
            "surface_shifting",
            Kind::Name(AT_SURFACES),
            "",
            Derived("`held`; `along` for solids"),
            "how particles on free surfaces and near them are shifted",
        ),
        key(
            "corrected_gradients",
            Kind::Boolean,
            "",
            Default("false"),
            "whether gradients are exact for linear fields away from free surfaces of fluids, with the conjugate momentum equation: for solids theory (74), for fluids (109) to (113)",
        ),
        key(
            "velocity_diffusion",
            Kind::Number(Interval::between(0.0, 1.0)),
            "1",
            Derived("0.5 with `corrected_gradients` of fluids; no meaning otherwise"),
            "factor of the diffusivity of what velocity differences have beyond their linear part, theory (112)",
        ),
        key(
            "contact",
            Kind::Name(CONTACTS),
            "",
            Derived("`repulsive`; no meaning for fluids"),
            "how solids of different bodies interact",
        ),
        key(
            "contact_stiffness",
            Kind::Number(Interval::POSITIVE),
            "1",
            Derived("1.0; for `penalty`"),
            "stiffness of the springs of `penalty` in units of the bulk modulus times dx^(D-2)",
        ),
        key(
            "self_contact",
            Kind::Number(Interval::POSITIVE),
            "spacings",
            Derived("none; no meaning for fluids"),
            "initial distance beyond which particles of one body interact like those of two bodies; without it a body whose faces meet fuses",
        ),
        key(
            "escaped",
            Kind::Name(ESCAPES),
            "",
            Default("\"stop\""),
            "what happens to a particle that passes through a wall, falls on the end of one or leaves the bounding box; no meaning for solids in a fluid",
        ),
        key(
            "reserve",
            Kind::Integer(Interval::between(1.0, 1e8)),
            "",
            Derived(
                "a twentieth of the particles of the fluid and its buffers, at least two buffers",
            ),
            "number of particles that memory is reserved for at the start in addition to the initial ones, with open boundaries and in each finer region of `refine`; its default there is the number that fits into the band of the region plus a tenth of its own. A run that needs more extends the reserve",
        ),
        key(
            "refine",
            Kind::List(&super::shapes::ANY_SHAPE),
            "",
            Optional,
            "regions in which the spacing of fluids and walls is half of that around them, theory (95): the first within the fluid, each further one within the previous one; no meaning for solids",
        ),
    ],
};

const DENSITIES: Choices = choices(&[
    choice(
        "continuity",
        "by the continuity equation, CTVF (25) corrected; in fluids with `edac` from the pressure by \
         CTVF (8), which satisfies it",
    ),
    choice("summation", "as the sum over masses"),
]);
const PRESSURES: Choices = choices(&[
    choice("edac", "by integration with diffusion, CTVF (26) corrected"),
    choice("state_equation", "from the density, CTVF (8)"),
]);
const VISCOUS: Choices = choices(&[
    choice(
        "laplacian",
        "the Laplacian of the velocity, theory (23), which lacks half of the dissipation of waves at a free surface",
    ),
    choice("stress", "the viscous stress, theory (90), which vanishes at a free surface"),
]);
const CORRECTIONS: Choices = choices(&[
    choice("full", "d . grad of pressure and velocity, CTVF (12), (18), (23)"),
    choice(
        "paper",
        "the same for pressure, and the momentum equation of CTVF (27) but for its softening, which slows a uniform stream, theory (22)",
    ),
    choice("none", "no terms; the divergence is that of the velocity"),
    choice("transport_divergence", "no terms; the divergence is that of the transport velocity"),
    choice("stress", "only the stress of the momentum equation"),
    choice("gtvf", "the stress; the divergence is that of the transport velocity"),
]);
const SHIFTINGS: Choices = choices(&[
    choice("spst", "by a velocity deviation, CTVF (35)"),
    choice("ipst", "by an iterated displacement, CTVF (37) to (41)"),
    choice("background", "by a background pressure that depends on the pressure, GTVF"),
    choice("none", "no shifting"),
]);

const AT_SURFACES: Choices = choices(&[
    choice(
        "held",
        "not shifted on them, and shifted with small supports near them, CTVF (44), (45) and algorithm 1",
    ),
    choice("along", "shifted along them, with full supports"),
]);
const CONTACTS: Choices = choices(&[
    choice("repulsive", "they compress each other and push by that pressure, but never pull"),
    choice("full", "in every term, like particles of one body, CTVF (30): they can weld"),
    choice("penalty", "springs push where particles are closer than a spacing"),
]);

const ESCAPES: Choices = choices(&[
    choice("stop", "the run ends with a message that names it"),
    choice("remove", "it no longer interacts and is counted in `step.removed`"),
]);

pub(super) static WALL: TableSpec = TableSpec {
    title: "wall",
    meaning: "Makes a body a wall of ghost particles, for the scheme `transport_velocity`.",
    keys: &[
        key("slip", Kind::Name(SLIPS), "", Default("\"no\""), "how the fluid moves along it"),
        key(
            "sliding",
            Kind::PerAxis(&Kind::Expression(Variables::PositionAndTime)),
            "m/s",
            Optional,
            "velocity at which its surface slides in place, like a belt, in addition to its motion",
        ),
    ],
};

pub(super) static OPENING: TableSpec = TableSpec {
    title: "opening",
    meaning: "Makes a body the buffer of an open boundary, for fluids of the scheme `transport_velocity`: fluid enters and leaves through its end towards the fluid. One of `velocity`, `flow_rate` and `pressure` is required; sound passes through all of them. Its initial state is that of the first body of fluid.",
    keys: &[
        key(
            "normal",
            Kind::Numbers(Length::Dimension, Interval::ANY),
            "1",
            Required,
            "normal of the boundary, from the buffer into the fluid, of any length",
        ),
        key(
            "velocity",
            Kind::Expressions(Variables::PositionAndTime),
            "m/s",
            Optional,
            "velocity of the fluid there; the pressure is that of the fluid inside",
        ),
        key(
            "flow_rate",
            Kind::Expression(Variables::PositionAndTime),
            "m^D/s",
            Optional,
            "volume flow rate into the fluid, negative for outflow, with a uniform velocity",
        ),
        key(
            "pressure",
            Kind::Expression(Variables::PositionAndTime),
            "Pa",
            Optional,
            "mean pressure of the fluid there; it leaves with its own velocity or enters along the normal",
        ),
        key(
            "profile",
            Kind::Table(&PROFILE),
            "",
            Optional,
            "a factor of `velocity` or `pressure` that depends on the position within the opening",
        ),
        super::loads::HISTORY,
        key(
            "relaxation",
            Kind::Number(Interval::POSITIVE),
            "s",
            Derived("twenty times the travel time of sound through all bodies"),
            "time scale on which mean pressures follow; faster changes pass as sound",
        ),
    ],
};

pub(super) const SLIPS: Choices = choices(&[
    choice("no", "no slip: the fluid sticks to it"),
    choice("free", "free slip: the fluid slides along it"),
]);

/// A factor from a file by the place within an opening.
static PROFILE: TableSpec = TableSpec {
    title: "profile",
    meaning: "A factor that depends on the distance from a point in the plane of an opening, as measured or computed elsewhere: over the height of a channel, or over the radius of a pipe.",
    keys: &[
        key(
            "file",
            Kind::File,
            "",
            Required,
            "CSV file with two columns, distance in m and factor: interpolated linearly between rows, constant beyond them",
        ),
        key(
            "from",
            Kind::Numbers(Length::Dimension, Interval::ANY),
            "m",
            Required,
            "the point: a wall of a channel, or the axis of a pipe",
        ),
    ],
};
