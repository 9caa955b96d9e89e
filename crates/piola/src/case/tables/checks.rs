//! Sweeps and checks.

use super::*;

pub(super) static SWEEP: TableSpec = TableSpec {
    title: "[[sweep]]",
    meaning: "The same case with every value of one key, or every pair of values of two. The members are runs like variants, called `NAME.1`, `NAME.2` and so on, the last key fastest.",
    keys: &[
        key("name", Kind::Text, "", Required, "unique name"),
        key("title", Kind::Text, "", Optional, "what it shows, in one line"),
        key(
            "over",
            Kind::KeysWithValues,
            "",
            Required,
            "the keys, as paths, with their values: `{ \"body.bar.spacing\" = [0.2, 0.1] }`",
        ),
        key(
            "coarse",
            Kind::KeysWithValues,
            "",
            Optional,
            "other values of some of these keys in the coarse setting",
        ),
        key(
            "variant",
            Kind::Text,
            "",
            Default("\"base\""),
            "the variant that the members start from",
        ),
        key(
            "set",
            Kind::List(&Kind::Text),
            "",
            Default("[]"),
            "overrides of all members, each `path.to.key=value`",
        ),
        key(
            "when",
            Kind::Name(SETTINGS),
            "",
            Default("\"always\""),
            "the settings at which the sweep exists and is checked",
        ),
        PAPER,
        LONG,
    ],
};

pub(super) static CHECK: TableSpec = TableSpec {
    title: "[[check]]",
    meaning: "A quantity of a run and its expected value: `expected` with `tolerance`, or `at_least` and `at_most`, or `less_than`, `more_than` or `equal_to` another variant. A check of a sweep applies to each of its members, or describes with `order`, `monotone` or `ratio` a trend over them.",
    keys: &[
        key(
            "variant",
            Kind::Text,
            "",
            Default("\"base\""),
            "the variant that is run, `base` for the case itself",
        ),
        key(
            "sweep",
            Kind::Text,
            "",
            Optional,
            "the sweep whose members are run, instead of `variant`",
        ),
        key(
            "member",
            Kind::KeysWithValue,
            "",
            Derived("all members of the sweep"),
            "only members that have these values, for example `{ \"time.cfl\" = 0.1 }`",
        ),
        key(
            "along",
            Kind::Text,
            "",
            Derived("the only key that `member` leaves free"),
            "the key of the sweep along which `order`, `monotone` or `ratio` is taken, for each value of the other",
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
            "how its history is reduced to one number; has no effect for run.NAME",
        ),
        key(
            "at",
            Kind::Number(Interval::NOT_NEGATIVE),
            "s",
            Optional,
            "the time, or for a line the distance from its start in m, for the reduction `at`",
        ),
        key(
            "window",
            Kind::Numbers(Length::Any, Interval::NOT_NEGATIVE),
            "s",
            Derived("all of it"),
            "two times: only the history between them is used",
        ),
        key(
            "smooth",
            Kind::Number(Interval::POSITIVE),
            "s",
            Optional,
            "width of a moving mean applied before the reduction, for a force with particle-scale noise: well below a period, and several rows of the table long",
        ),
        key(
            "number",
            Kind::Integer(Interval::at_least(1.0)),
            "1",
            Default("1"),
            "number of the event, counted from 1, for `extremum`, `extremum_time`, `zero_time` and `zero_place`",
        ),
        key(
            "reference",
            Kind::File,
            "",
            Optional,
            "CSV file with the columns time, or distance along a line, and value, for `curve` and `curve_rms`",
        ),
        key(
            "expected",
            Kind::NumberOrText,
            "",
            Optional,
            "expected value, in the unit of the quantity, with the parameters of the variant or member; text for run.outcome",
        ),
        key(
            "tolerance",
            Kind::Number(Interval::NOT_NEGATIVE),
            "1",
            Optional,
            "largest difference relative to `expected`, or to the value of the variant in `equal_to`",
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
        key(
            "equal_to",
            Kind::Text,
            "",
            Optional,
            "name of a variant with the same value, within `tolerance`",
        ),
        key(
            "order",
            Kind::Numbers(Length::Ends, Interval::ANY),
            "1",
            Optional,
            "bounds of the convergence order along a sweep: the least-squares slope of log error against log value of the key. The error is the difference from `expected`, or the quantity itself for `curve` and `curve_rms`; without either, each member is compared with the next (Richardson). Negative for keys that grow with refinement",
        ),
        key(
            "monotone",
            Kind::Name(DIRECTIONS),
            "",
            Optional,
            "direction in which the quantity, or with `expected` its error, changes from member to member in the order of the values",
        ),
        key(
            "ratio",
            Kind::Numbers(Length::Ends, Interval::ANY),
            "1",
            Optional,
            "bounds of the ratio of the quantity, or with `expected` of its error, to that of the previous member, for all members but the first",
        ),
        key(
            "against",
            Kind::Name(AGAINST),
            "",
            Optional,
            "what kind of evidence the expected value is; required of every check with `piola verify --page`",
        ),
        key("source", Kind::Text, "", Required, "where the expected value comes from"),
        key(
            "reason",
            Kind::Text,
            "",
            Optional,
            "reason for the value of the tolerance or bound: order of the method, digits printed, scatter of the experiment",
        ),
        key(
            "unmet",
            Kind::Text,
            "",
            Optional,
            "why the check is not met, if that is known and the expected value is nevertheless right. It counts as not met but does not make `piola verify` fail; once all its rows are met, it does",
        ),
        key(
            "when",
            Kind::Name(SETTINGS),
            "",
            Default("\"always\""),
            "at which setting it is evaluated",
        ),
    ],
};

const DIRECTIONS: Choices = choices(&[
    choice("increasing", "each is above the previous one"),
    choice("decreasing", "each is below the previous one"),
]);
const SETTINGS: Choices = choices(&[
    choice("always", "at the coarse setting and in the case as it stands"),
    choice("coarse", "at the coarse setting only"),
    choice("case", "in the case as it stands only"),
    choice("paper", "at the paper's setting only, with the overrides of `[paper]`"),
]);
const AGAINST: Choices = choices(&[
    choice("exact", "a closed form or a series"),
    choice("independent", "another method or program, with the script or the citation"),
    choice("paper", "a number or a digitised curve of the paper"),
    choice("own", "another run of piola: no evidence of correctness"),
    choice("invariant", "a balance, a symmetry, an outcome, a number of pieces"),
]);
/// Whether a variant or a sweep is at the setting of the publication.
pub(super) const PAPER: KeySpec = key(
    "paper",
    Kind::Boolean,
    "",
    Default("false"),
    "whether it already has the particle numbers, steps and parameters of the publication",
);
/// Whether a run is left out without `--long`.
pub(super) const LONG: KeySpec = key(
    "long",
    Kind::Boolean,
    "",
    Default("false"),
    "whether `piola verify` runs it only with `--long`, as it takes more than a few minutes",
);
