//! The tables of a case file, described once.

use super::catalogue;
use super::spec::Presence::{Default, Derived, Optional, Required};
use super::spec::{
    Choice, Choices, Interval, KeySpec, Kind, KindSpec, Length, Presence, TableSpec, TaggedSpec,
    Variables,
};

mod checks;
mod fluids;
mod geometry;
mod interpolation;
mod loads;
mod observers;
mod plastic;
mod shapes;
mod solids;
mod time;
mod waves;

/// The case file as a whole.
pub static CASE: TableSpec = TableSpec {
    title: "the case file",
    meaning: "A case in TOML. Lengths are in m, SI units throughout.",
    keys: &[
        key(
            "version",
            Kind::Integer(Interval::between(1.0, 1.0)),
            "1",
            Required,
            "version of this format: 1",
        ),
        key("id", Kind::Text, "", Optional, "row of the reproduction list, for example `U10`"),
        key("title", Kind::Text, "", Required, "what the case shows, in one line"),
        checks::LONG,
        key(
            "dimension",
            Kind::Integer(Interval::between(1.0, 3.0)),
            "1",
            Required,
            "number of space dimensions: 1, 2 or 3",
        ),
        key(
            "parameters",
            Kind::Parameters,
            "",
            Optional,
            "named numbers, or expressions of earlier ones, usable wherever a number or an expression is expected",
        ),
        key("domain", Kind::Table(&geometry::DOMAIN), "", Optional, "the computational domain"),
        key(
            "body",
            Kind::List(&Kind::Table(&geometry::BODY)),
            "",
            Required,
            "the bodies, each a table `[[body]]`",
        ),
        key("scheme", Kind::Tagged(&SCHEME), "", Required, "the formulation and its settings"),
        key(
            "system",
            Kind::List(&Kind::Table(&time::SYSTEM)),
            "",
            Optional,
            "solids in the fluid of `[scheme]`, each a table `[[system]]`",
        ),
        key(
            "time",
            Kind::Table(&time::TIME),
            "",
            Derived("needed by all schemes but `interpolation`"),
            "clock and integrator",
        ),
        key(
            "checkpoint",
            Kind::Table(&time::CHECKPOINT),
            "",
            Optional,
            "when the run writes a file from which it can be resumed; it also does so on Ctrl-C and SIGTERM",
        ),
        key("compute", Kind::Table(&time::COMPUTE), "", Optional, "who computes"),
        key(
            "load",
            Kind::List(&Kind::Tagged(&loads::LOAD)),
            "",
            Optional,
            "body forces, tractions and pressures, each a table `[[load]]`",
        ),
        key(
            "boundary",
            Kind::List(&Kind::Table(&loads::BOUNDARY)),
            "",
            Optional,
            "prescribed velocities or displacements, each a table `[[boundary]]`",
        ),
        key(
            "probe",
            Kind::List(&Kind::Tagged(&observers::PROBE)),
            "",
            Optional,
            "quantities recorded against time, each a table `[[probe]]`",
        ),
        key("output", Kind::Table(&observers::OUTPUT), "", Optional, "what is written and when"),
        key(
            "picture",
            Kind::List(&Kind::Table(&observers::PICTURE)),
            "",
            Optional,
            "pictures of the particles, each a table `[[picture]]`",
        ),
        key(
            "plot",
            Kind::List(&Kind::Table(&observers::PLOT)),
            "",
            Optional,
            "curves against time, each a table `[[plot]]`",
        ),
        key(
            "coarse",
            Kind::Table(&COARSE),
            "",
            Optional,
            "the quick setting run by `piola verify`",
        ),
        key(
            "paper",
            Kind::Table(&PAPER),
            "",
            Optional,
            "particle numbers, steps and parameters of the publication, run with `piola verify --paper` and `--full`",
        ),
        key(
            "variant",
            Kind::List(&Kind::Table(&VARIANT)),
            "",
            Optional,
            "the same case with other settings, each a table `[[variant]]`",
        ),
        key(
            "sweep",
            Kind::List(&Kind::Table(&checks::SWEEP)),
            "",
            Optional,
            "the same case with every value of one or two keys, each a table `[[sweep]]`",
        ),
        key(
            "check",
            Kind::List(&Kind::Table(&checks::CHECK)),
            "",
            Optional,
            "what `piola verify` evaluates, each a table `[[check]]`",
        ),
    ],
};

static SCHEME: TaggedSpec = TaggedSpec {
    title: "[scheme]",
    meaning: "The formulation and its settings.",
    common: &[],
    kinds: &[
        UPWIND,
        fluids::TRANSPORT_VELOCITY,
        solids::TOTAL_LAGRANGIAN,
        solids::DUAL_SUPPORT,
        solids::ELASTODYNAMICS,
        interpolation::INTERPOLATION,
    ],
};

const UPWIND: KindSpec = KindSpec {
    name: "upwind",
    meaning: "total Lagrangian mixed formulation with Riemann upwinding",
    dimensions: &[1, 2, 3],
    keys: &[
        key(
            "kernel",
            Kind::Name(Choices::Registry(catalogue::kernels)),
            "",
            Default("\"cubic_spline\""),
            "smoothing kernel",
        ),
        key(
            "smoothing_length",
            Kind::Number(Interval::POSITIVE),
            "spacings",
            Required,
            "smoothing length h in units of the particle spacing; the support radius is a multiple of it that depends on the kernel",
        ),
        key(
            "correction",
            Kind::Name(CORRECTIONS),
            "",
            Default("\"gradient\""),
            "correction of the kernel",
        ),
        key(
            "weights",
            Kind::Name(WEIGHTS),
            "",
            Default("\"lattice\""),
            "weight of a particle in kernel sums",
        ),
        key(
            "tau_velocity",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Default("0.0"),
            "strength of the upwinding of the velocity",
        ),
        key(
            "tau_pressure",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Default("0.0"),
            "strength of the upwinding of the pressure",
        ),
        key(
            "dissipation",
            Kind::Name(DISSIPATIONS),
            "",
            Default("\"corrected\""),
            "form of both upwindings; all but `corrected` are only for comparison with the paper",
        ),
        key(
            "reconstruction",
            Kind::Boolean,
            "",
            Default("false"),
            "whether states at the midpoint of a pair are reconstructed linearly, Upwind (3.53)",
        ),
        key(
            "wave_speed",
            Kind::Name(WAVE_SPEEDS),
            "",
            Default("\"constant\""),
            "wave speed used by the upwinding",
        ),
    ],
};

const CORRECTIONS: Choices = choices(&[
    choice("none", "no correction"),
    choice("gradient", "gradients exact for linear fields"),
    choice("kernel_and_gradient", "kernel exact for constants, gradients exact for linear fields"),
]);
const WEIGHTS: Choices = choices(&[
    choice("lattice", "the volume of a lattice cell for every particle, also at a face"),
    choice("volume", "the volume of the particle"),
]);
const DISSIPATIONS: Choices = choices(&[
    choice("corrected", "as derived"),
    choice("printed_3_38", "velocity term without the density, as printed in Upwind (3.38)"),
    choice(
        "printed_3_42",
        "pressure term with the sign printed in Upwind (3.42), which feeds energy in",
    ),
    choice("as_printed", "both of these"),
]);
const WAVE_SPEEDS: Choices = choices(&[
    choice("constant", "that of the reference state"),
    choice("stretch", "divided by the stretch, Upwind (3.57)"),
]);

static COARSE: TableSpec = TableSpec {
    title: "[coarse]",
    meaning: "The quick setting run by `piola verify`, for tests.",
    keys: &[key(
        "set",
        Kind::List(&Kind::Text),
        "",
        Required,
        "overrides, each `path.to.key=value`, or `path.to.list+=value` to append; applied before those of a variant",
    )],
};

static PAPER: TableSpec = TableSpec {
    title: "[paper]",
    meaning: "Particle numbers, steps and parameters of the publication, where they differ from those of the case.",
    keys: &[
        key(
            "set",
            Kind::List(&Kind::Text),
            "",
            Default("[]"),
            "overrides, each `path.to.key=value`, applied before those of a variant; none if the case already has the setting of the publication",
        ),
        checks::LONG,
    ],
};

static VARIANT: TableSpec = TableSpec {
    title: "[[variant]]",
    meaning: "The same case with other settings.",
    keys: &[
        key("name", Kind::Text, "", Required, "unique name; `base` is the case itself"),
        key("title", Kind::Text, "", Optional, "what it shows, in one line"),
        key(
            "set",
            Kind::List(&Kind::Text),
            "",
            Default("[]"),
            "overrides, each `path.to.key=value`",
        ),
        key(
            "coarse",
            Kind::List(&Kind::Text),
            "",
            Default("[]"),
            "further overrides in the coarse setting",
        ),
        checks::PAPER,
        checks::LONG,
    ],
};

const fn key(
    name: &'static str,
    kind: Kind,
    unit: &'static str,
    presence: Presence,
    meaning: &'static str,
) -> KeySpec {
    KeySpec { name, kind, unit, presence, meaning }
}

const fn choice(name: &'static str, meaning: &'static str) -> Choice {
    Choice { name, meaning }
}

const fn choices(list: &'static [Choice]) -> Choices {
    Choices::Fixed(list)
}
