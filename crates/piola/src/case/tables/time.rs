//! The clock, integrators and checkpoints.

use super::*;
use crate::schemes::world::{MOST_DAMPING, MOST_STIFFNESS};

pub(super) static TIME: TableSpec = TableSpec {
    title: "[time]",
    meaning: "Clock and integrator. The time starts at 0.",
    keys: &[
        key("end", Kind::Number(Interval::POSITIVE), "s", Required, "time at which the run ends"),
        INTEGRATOR,
        CFL,
        key(
            "step",
            Kind::Number(Interval::POSITIVE),
            "s",
            Derived("none; a tenth of `end` with the integrators `static` and `arc_length`"),
            "fixed time step instead of `cfl`, checked against the stable step; with an implicit integrator, `static` or `arc_length` the largest step, shortened to meet output",
        ),
        BETA,
        GAMMA,
        ALPHA,
        SPECTRAL_RADIUS,
        THETA,
        key(
            "error",
            Kind::Number(Interval::between(1e-10, 0.5)),
            "1",
            Optional,
            "with an implicit integrator: error of a step that is allowed, of the velocities over those \
             that all energy would give. Each step is taken as a whole and in two halves, and is as long \
             as the difference of both allows, `step` at most",
        ),
        TOLERANCE,
        LINEAR_SOLVER,
        key(
            "max_steps",
            Kind::Integer(Interval::at_least(1.0)),
            "1",
            Optional,
            "maximum number of steps, after which the run fails",
        ),
        key(
            "min_step",
            Kind::Number(Interval::POSITIVE),
            "s",
            Optional,
            "the run fails if the stable step falls below this",
        ),
        key(
            "max_speed",
            Kind::Number(Interval::POSITIVE),
            "m/s",
            Derived("10 times the sum of the largest speed and wave speed at the start"),
            "the run fails if a particle is faster",
        ),
        key(
            "on_failure",
            Kind::Name(REACTIONS),
            "",
            Default("\"stop\""),
            "what happens when a state is found to be invalid",
        ),
        key(
            "retries",
            Kind::Integer(Interval::between(1.0, 60.0)),
            "1",
            Derived("5 with `on_failure = \"retry\"`"),
            "how often the run may go back; the steps are halved each time, and grow again where Newton's method converges quickly",
        ),
    ],
};

const INTEGRATOR: KeySpec = key(
    "integrator",
    Kind::Name(Choices::Registry(catalogue::integrators)),
    "",
    Derived(
        "`kick_drift_kick`; `tvd_rk2` for the scheme `upwind` where `tau_velocity` or `tau_pressure` is above 0",
    ),
    "time integrator",
);

const CFL: KeySpec = key(
    "cfl",
    Kind::Number(Interval::POSITIVE),
    "1",
    Derived(
        "0.3 (`transport_velocity`: 0.25, `total_lagrangian` by `kick_drift_kick`: 0.9) unless `step` is given; none with an implicit integrator",
    ),
    "CFL number: fraction of the time that a wave needs from particle to particle; with `total_lagrangian`, fraction of the largest stable step of central differences",
);

const BETA: KeySpec = key(
    "beta",
    Kind::Number(Interval::between(0.25, 1.0)),
    "1",
    Derived("0.25, with the integrator `newmark`"),
    "weight of the new acceleration in the displacement, at least half of `gamma`",
);

const GAMMA: KeySpec = key(
    "gamma",
    Kind::Number(Interval::between(0.5, 1.0)),
    "1",
    Derived("0.5, with the integrator `newmark`"),
    "weight of the new acceleration in the velocity: above 0.5 all periods are damped, and steps are of first order",
);

const ALPHA: KeySpec = key(
    "alpha",
    Kind::Number(Interval::between(0.0, 1.0 / 3.0)),
    "1",
    Derived("0.05, with the integrator `hht_alpha`"),
    "weight of the forces at the start of a step: the larger, the more short periods are damped",
);

const SPECTRAL_RADIUS: KeySpec = key(
    "spectral_radius",
    Kind::Number(Interval::between(0.0, 1.0)),
    "1",
    Derived("0.8, with the integrator `generalised_alpha`"),
    "factor by which a step multiplies the shortest periods; 1 is the implicit midpoint rule, without damping",
);

const THETA: KeySpec = key(
    "theta",
    Kind::Number(Interval::between(0.5, 1.0)),
    "1",
    Derived("0.55, with the integrator `theta`"),
    "weight of the rates at the end of a step: 0.5 is `crank_nicolson`, 1 is `backward_euler`",
);

const TOLERANCE: KeySpec = key(
    "tolerance",
    Kind::Number(Interval::between(1e-13, 1e-2)),
    "1",
    Derived("1e-8 with `static`, `arc_length` or an implicit integrator, 1e-10 with `upwind`"),
    "largest residual force of Newton's method, relative to loads and reactions; with `upwind` the residual momentum of a step, relative to the momentum and its change by the forces",
);

const LINEAR_SOLVER: KeySpec = key(
    "linear_solver",
    Kind::Name(LINEAR_SOLVERS),
    "",
    Derived("`automatic` with `static`, `arc_length` or an implicit integrator"),
    "how the linear equations of Newton's method are solved",
);
/// How a system beside the main one goes on in time.
static METHOD: TableSpec = TableSpec {
    title: "[system.time]",
    meaning: "How the system takes its own steps: as many within one of the fluid as its stable step requires, one for several of the fluid if it is slow and heavy, or one with an implicit integrator.",
    keys: &[INTEGRATOR, CFL, BETA, GAMMA, ALPHA, SPECTRAL_RADIUS, THETA, TOLERANCE, LINEAR_SOLVER],
};

pub(super) static SYSTEM: TableSpec = TableSpec {
    title: "[[system]]",
    meaning: "A solid in a fluid: any formulation but `interpolation`, for the bodies that name it with `system`. The bodies without that key are those of `[scheme]`, the fluid, which sees the solids as walls that bend.",
    keys: &[
        key("name", Kind::Text, "", Required, "unique name, to which bodies refer"),
        key("scheme", Kind::Tagged(&SCHEME), "", Required, "the formulation and its settings"),
        key("time", Kind::Table(&METHOD), "", Optional, "how it takes its steps"),
        key(
            "slip",
            Kind::Name(fluids::SLIPS),
            "",
            Default("\"no\""),
            "how fluid moves along its surface",
        ),
        key(
            "friction",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Default("0.0"),
            "Coulomb friction coefficient where it slides along walls; between two systems their mean. Bodies of one system do not touch each other, except with `transport_velocity`, as its `contact` says",
        ),
        key(
            "contact_stiffness",
            Kind::Number(Interval::between(0.01, MOST_STIFFNESS)),
            "1",
            Default("1.0"),
            "stiffness of the contact with walls and other systems, in units of the density of the solid times the squared wave speed of the fluid, theory (85); between two systems the smaller one",
        ),
        key(
            "contact_damping",
            Kind::Number(Interval::between(0.0, MOST_DAMPING)),
            "1",
            Default("0.5"),
            "energy loss of an impact, theory (85): 0 for none, 1 for nearly all; between two systems the mean",
        ),
    ],
};

const LINEAR_SOLVERS: Choices = choices(&[
    choice(
        "automatic",
        "`direct` for bodies that are cheap to factorise, `krylov` for larger ones",
    ),
    choice(
        "direct",
        "by a sparse factorisation, of the symmetric half where the tangent is not symmetric, with \
         GMRES for the rest",
    ),
    choice(
        "krylov",
        "by conjugate gradients, or GMRES where the tangent is not symmetric: with `upwind`, and with \
         pressures that follow the surface",
    ),
]);

const REACTIONS: Choices = choices(&[
    choice("stop", "the run ends with the last good state"),
    choice(
        "retry",
        "the run goes back some steps and continues with half the step, and stops after too many retries; not with a fixed time step",
    ),
]);

const PRECISIONS: Choices = choices(&[
    choice("double", "the results of the processor, to the bit"),
    choice(
        "single",
        "what is computed of pairs is in single precision, on a device; states and sums over particles stay in double \
         precision",
    ),
]);

pub(super) static COMPUTE: TableSpec = TableSpec {
    title: "[compute]",
    meaning: "Who computes. Results in double precision do not depend on the device, and none on the number of ranks.",
    keys: &[
        key(
            "device",
            Kind::Text,
            "",
            Default("\"processor\""),
            "`processor`, or the name of a device as listed by `piola devices`, for example `cuda:0`; `docs/devices.md` lists the supported cases",
        ),
        key(
            "precision",
            Kind::Name(PRECISIONS),
            "",
            Default("\"double\""),
            "the precision of what a device computes of pairs of particles; single precision needs a `device`, and `docs/devices.md` says what it costs and gains",
        ),
        key(
            "ranks",
            Kind::Integer(Interval::at_least(1.0)),
            "1",
            Default("1"),
            "how many ranks share the particles, each with a part of the threads; `docs/distributed.md` lists the supported cases",
        ),
    ],
};

pub(super) static CHECKPOINT: TableSpec = TableSpec {
    title: "[checkpoint]",
    meaning: "When checkpoints are written, from which `piola run --resume` continues. Results do not depend on them.",
    keys: &[
        key(
            "every_steps",
            Kind::Integer(Interval::at_least(1.0)),
            "1",
            Optional,
            "steps between checkpoints",
        ),
        key(
            "every",
            Kind::Number(Interval::POSITIVE),
            "s",
            Optional,
            "simulated time between checkpoints; steps are not shortened to meet it",
        ),
        key(
            "every_wall",
            Kind::Number(Interval::POSITIVE),
            "s",
            Derived("300 unless `every_steps` or `every` is given"),
            "wall time between checkpoints",
        ),
        key(
            "keep",
            Kind::Integer(Interval::between(1.0, 1e6)),
            "1",
            Default("2"),
            "number of newest checkpoints that are kept",
        ),
        key(
            "at_end",
            Kind::Boolean,
            "",
            Default("false"),
            "whether one is written at the end, to continue with a later `time.end`",
        ),
    ],
};
