//! Which curves a report shows, and what is shown beside them.

use std::collections::BTreeSet;

use super::*;

/// The charts of the case, then whatever its tables hold besides, then energies and steps.
pub(super) fn groups(case: Option<&Case>, tables: &Tables) -> Vec<ChartGroup> {
    let mut shown = BTreeSet::new();
    let mut own = Vec::new();
    for plot in case.iter().flat_map(|case| &case.plots) {
        let names: Vec<String> = plot.curves.iter().map(|curve| curve.name()).collect();
        own.push(chart(&plot.name, &names, case, tables));
        shown.extend(names);
    }
    let names = tables.names();
    let is_of = |name: &str, table: &str| name.strip_prefix(table).is_some();
    let in_tables =
        |name: &&String| ["energy.", "momentum.", "step."].iter().any(|table| is_of(name, table));
    let mut probes = Vec::new();
    for name in names.iter().filter(|name| !in_tables(name) && !shown.contains(*name)) {
        // The components of a field share a chart.
        let field = |name: &str| match name.splitn(3, '.').collect::<Vec<_>>()[..] {
            [probe, field, ..] => format!("{probe}.{field}"),
            _ => name.to_owned(),
        };
        let title = field(name);
        if probes.iter().any(|chart: &Chart| chart.title == title) {
            continue;
        }
        let together: Vec<String> = names
            .iter()
            .filter(|other| !in_tables(other) && !shown.contains(*other) && field(other) == title)
            .cloned()
            .collect();
        probes.push(chart(&title, &together, case, tables));
    }
    let stored = ["energy.kinetic", "energy.strain", "energy.total"].map(String::from);
    let is_stored = |name: &&String| stored.contains(name);
    let mut energy = Vec::new();
    if !stored.iter().all(|name| shown.contains(name)) {
        energy.push(chart("energy", &stored, case, tables));
    }
    // A mechanism that did nothing is no curve.
    let moves = |name: &&String| match tables.curve(name) {
        Some(Series::Curve { values, .. }) => values.iter().any(|value| *value != 0.0),
        _ => false,
    };
    let work: Vec<String> = names
        .iter()
        .filter(|name| is_of(name, "energy.") && !is_stored(name) && moves(name))
        .cloned()
        .collect();
    energy.push(chart("work of each mechanism so far, and the balance", &work, case, tables));
    let momentum: Vec<String> =
        names.iter().filter(|name| is_of(name, "momentum.") && moves(name)).cloned().collect();
    let momentum = vec![chart(
        "momentum, and the impulse of every load and boundary so far",
        &momentum,
        case,
        tables,
    )];
    let steps = ["step.size", "step.smallest_ratio", "step.largest_speed"];
    let steps = steps.iter().map(|name| chart(&name[5..], &[(*name).to_owned()], case, tables));
    let groups = [
        ("From the case", own),
        ("Probes", probes),
        ("Energy", energy),
        ("Momentum", momentum),
        ("Steps and health", steps.collect()),
    ];
    groups
        .into_iter()
        .map(|(title, charts)| ChartGroup {
            title: title.into(),
            charts: charts.into_iter().filter(|chart| !chart.series.is_empty()).collect(),
        })
        .filter(|group| !group.charts.is_empty())
        .collect()
}

/// The columns called `names`, all against time or all along one line, with the references of checks
/// beside them.
pub(in crate::case) fn chart(
    title: &str,
    names: &[String],
    case: Option<&Case>,
    tables: &Tables,
) -> Chart {
    let mut series = Vec::new();
    let mut sources = Vec::new();
    let mut across = Column::new("time", "s");
    for name in names {
        let Some(Series::Curve { against, abscissa, values, unit }) = tables.curve(name) else {
            continue;
        };
        across = against;
        series.push(output::Series {
            column: Column::new(name, &unit),
            points: abscissa.into_iter().zip(values).map(|(x, value)| [x, value]).collect(),
            style: output::Style::Line,
        });
        for (check, curve) in case.iter().flat_map(|case| references(case, name)) {
            let label = reference_label(case, name);
            if series.iter().any(|other: &output::Series| other.column.name == label) {
                continue;
            }
            sources.push(format!("{label}: {}", check.source));
            series.push(output::Series {
                column: Column::new(label, &unit),
                points: curve
                    .abscissa
                    .into_iter()
                    .zip(curve.ordinate)
                    .map(|(time, value)| [time, value])
                    .collect(),
                style: output::Style::Marks,
            });
        }
    }
    Chart { title: title.to_owned(), across, series, sources }
}

/// How the reference of the column `name` is called. It is one of the case as its author wrote it.
fn reference_label(case: Option<&Case>, name: &str) -> String {
    match case.is_some_and(|case| case.is_changed) {
        true => format!("reference of {name} for the case without overrides"),
        false => format!("reference of {name}"),
    }
}

/// The reference curves that checks of this run compare the column `name` with.
pub(in crate::case) fn references<'a>(
    case: &'a Case,
    name: &str,
) -> impl Iterator<Item = (&'a Check, Curve)> {
    let checks = case.checks.iter().filter(move |check| {
        check.quantity.name() == name
            && check.variant.as_ref().map(|variant| &variant.value) == case.variant.as_ref()
    });
    checks.filter_map(|check| Some((check, Curve::read_csv(check.file()?).ok()?)))
}
