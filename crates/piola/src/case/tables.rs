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
        key(
            "domain",
            Kind::Table(&geometry::DOMAIN),
            "",
            Optional,
            "the space that the particles live in",
        ),
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
            "when the run writes a file that it can be resumed from; it also does on Ctrl-C and SIGTERM",
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
            "the quick setting that `piola verify` runs",
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
            "smoothing length h in units of the particle spacing; the support radius is the kernel's multiple of it",
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
            "what is summed under the kernel",
        ),
        key(
            "tau_velocity",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Default("0.0"),
            "share of the upwinding of velocity",
        ),
        key(
            "tau_pressure",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Default("0.0"),
            "share of the upwinding of pressure",
        ),
        key(
            "dissipation",
            Kind::Name(DISSIPATIONS),
            "",
            Default("\"corrected\""),
            "form of both upwindings; what is not `corrected` is for comparison with the paper only",
        ),
        key(
            "reconstruction",
            Kind::Boolean,
            "",
            Default("false"),
            "whether states at mid-edges are reconstructed linearly, Upwind (3.53)",
        ),
        key(
            "wave_speed",
            Kind::Name(WAVE_SPEEDS),
            "",
            Default("\"constant\""),
            "the wave speed of the upwinding",
        ),
    ],
};

const CORRECTIONS: Choices = choices(&[
    choice("none", "the kernel as it is"),
    choice("gradient", "gradients exact for linear fields"),
    choice("kernel_and_gradient", "kernel exact for constants, gradients exact for linear fields"),
]);
const WEIGHTS: Choices = choices(&[
    choice("lattice", "the volume of a lattice cell for every particle, also at a face"),
    choice("volume", "the volume of the particle"),
]);
const DISSIPATIONS: Choices = choices(&[
    choice("corrected", "as derived"),
    choice("printed_3_38", "velocity without the density, as Upwind (3.38) is printed"),
    choice(
        "printed_3_42",
        "pressure with the sign of Upwind (3.42) as printed, which feeds energy in",
    ),
    choice("as_printed", "both of these"),
]);
const WAVE_SPEEDS: Choices = choices(&[
    choice("constant", "that of the reference state"),
    choice("stretch", "divided by the stretch, Upwind (3.57)"),
]);

static COARSE: TableSpec = TableSpec {
    title: "[coarse]",
    meaning: "The quick setting that `piola verify` runs, for tests.",
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
    meaning: "Particle numbers, steps and parameters of the publication, where the case as it stands has others.",
    keys: &[
        key(
            "set",
            Kind::List(&Kind::Text),
            "",
            Default("[]"),
            "overrides, each `path.to.key=value`, applied before those of a variant; none where the case as it stands has the publication's setting",
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
            "overrides that come on top in the coarse setting",
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
