//! Charts of the validation page: the plots of a case with their references, and trends of sweeps.

use super::SettingRuns;
use crate::case::model::{Case, Expectation, Level, Reduction, Sweep};
use crate::case::sweep::curve_series;
use crate::case::verify::{CheckRow, TrendData};
use crate::observe;
use crate::output::{Column, Curve, Plot, Series, Style};

/// Points of a reference curve that are marked at most.
const MARKS: usize = 60;

/// The charts of a case with names for their files.
pub(super) fn charts(page: &SettingRuns) -> Vec<(String, Plot)> {
    let case = &page.case;
    let mut charts = Vec::new();
    for plot in case.plots.iter().filter(|plot| !plot.over_time) {
        let curves: Vec<String> = plot.curves.iter().map(|curve| curve.name()).collect();
        let name = &plot.name.value;
        let abscissa = abscissa(page, &curves[0]);
        let all = of_variants(case, page, &curves);
        charts.push((name.clone(), chart(&case.title, &abscissa, all)));
        for sweep in case.sweeps.iter().filter(|_| curves.len() == 1) {
            let title = format!("{}: {}", case.title, keys(sweep, case.level));
            let members = of_members(case, page, sweep, &curves[0]);
            charts.push((format!("{name}-{}", *sweep.name), chart(&title, &abscissa, members)));
        }
    }
    charts.retain(|(_, chart)| chart.series.iter().any(|series| series.style.is_line()));
    charts.extend(trends(case, &page.rows));
    charts
}

fn chart(title: &str, abscissa: &Column, series: Vec<Series>) -> Plot {
    Plot { title: title.to_owned(), abscissa: abscissa.clone(), series }
}

/// What the curve called `name` is against.
fn abscissa(page: &SettingRuns, name: &str) -> Column {
    let found = page.finished().find_map(|(_, finished)| match finished.quantity(name) {
        Some(observe::Series::Curve { against, .. }) => Some(against),
        _ => None,
    });
    found.unwrap_or(Column::new("time", "s"))
}

/// The last parts of the paths of the keys of a sweep.
fn keys(sweep: &Sweep, level: Level) -> String {
    let keys = sweep.keys(level).iter().map(|key| last_part(&key.path).to_owned());
    keys.collect::<Vec<_>>().join(", ")
}

fn last_part(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// Curves of the case itself, of a single column those of its variants too, with dashes, and what is
/// expected of them.
fn of_variants(case: &Case, page: &SettingRuns, curves: &[String]) -> Vec<Series> {
    let mut series = Vec::new();
    for name in curves {
        for (run, finished) in page.finished() {
            let (label, style) = match run {
                None => (name.clone(), Style::Line),
                Some(run) if curves.len() == 1 && case.member(run).is_none() => {
                    (format!("{run}: {name}"), Style::Dashes)
                }
                Some(_) => continue,
            };
            let curve = finished.quantity(name).and_then(|found| curve_series(&label, found));
            series.extend(curve.map(|curve| Series { style, ..curve }));
        }
        series.extend(expected(case, page, name));
    }
    series
}

/// A column of the members of a sweep, and what is expected of it in the case itself.
fn of_members(case: &Case, page: &SettingRuns, sweep: &Sweep, name: &str) -> Vec<Series> {
    let members = page.finished().filter_map(|(run, finished)| {
        let (own, index) = case.member(run.as_ref()?)?;
        let values = sweep.values(index, case.level).into_iter();
        let values: Vec<&str> = values.map(|(_, value)| value.text.as_str()).collect();
        let label = format!("{}: {name}", values.join(", "));
        let curve = curve_series(&label, finished.quantity(name)?)?;
        (own.name.value == sweep.name.value).then_some((index, curve))
    });
    let mut members: Vec<(usize, Series)> = members.collect();
    members.sort_by_key(|(index, _)| *index);
    let members = members.into_iter().map(|(_, series)| series);
    members.chain(expected(case, page, name)).collect()
}

/// Marks at what is expected of a column of the case itself.
fn expected(case: &Case, page: &SettingRuns, name: &str) -> Option<Series> {
    let (_, finished) = page.finished().find(|(run, _)| run.is_none())?;
    let found = finished.quantity(name)?;
    let points = references(case, name, &found);
    let observe::Series::Curve { unit, .. } = found else { return None };
    let column = Column::new("expected", unit);
    (!points.is_empty()).then_some(Series { column, points, style: Style::Marks })
}

/// Points through which the curve of `name` of the case itself should go.
fn references(case: &Case, name: &str, found: &observe::Series) -> Vec<[f64; 2]> {
    let observe::Series::Curve { abscissa, values, .. } = found else { return Vec::new() };
    let extremum = |sign: f64, [first, last]: [f64; 2]| {
        let rows = abscissa.iter().zip(values).filter(|(x, _)| (first..=last).contains(*x));
        rows.max_by(|one, other| (sign * one.1).total_cmp(&(sign * other.1))).map(|row| *row.0)
    };
    let mut points = Vec::new();
    for check in case.checks.iter().filter(|check| {
        let of_case = check.variant.is_none() && check.members.is_none();
        of_case && check.when.includes(case.level) && check.quantity.name() == name
    }) {
        if let Some(curve) = check.reduce.reference().and_then(|file| Curve::read_csv(file).ok()) {
            let all = curve.abscissa.iter().zip(&curve.ordinate);
            let every = curve.abscissa.len().div_ceil(MARKS).max(1);
            points.extend(all.step_by(every).map(|(x, y)| [*x, *y]));
        }
        let Expectation::Value { expected, .. } = check.expectation else { continue };
        let ends = [abscissa.first(), abscissa.last()].map(|x| x.copied().unwrap_or_default());
        let (window, reduce) = match &check.reduce {
            Reduction::Within(window, reduce) => (*window, &**reduce),
            reduce => (ends, reduce),
        };
        let time = match reduce {
            Reduction::At(time) => Some(*time),
            Reduction::Initial => Some(window[0]),
            Reduction::Final => Some(window[1]),
            Reduction::Maximum => extremum(1.0, window),
            Reduction::Minimum => extremum(-1.0, window),
            _ => None,
        };
        points.extend(time.map(|time| [time, expected]));
    }
    points
}

/// Rows that can stand in one chart: the same quantity along the same key of the same sweep.
struct Group<'a> {
    name: String,
    data: &'a TrendData,
    quantity: String,
    log: bool,
    lines: Vec<(String, &'a TrendData)>,
}

/// One chart for each quantity along a key with numbers: with logarithms where an order is taken.
fn trends(case: &Case, rows: &[CheckRow]) -> Vec<(String, Plot)> {
    let mut groups: Vec<Group> = Vec::new();
    for row in rows {
        let (Some(data), Some(run)) = (&row.trend, &row.run) else { continue };
        if data.points.len() < 2 || data.points.iter().any(|point| point.key.is_none()) {
            continue;
        }
        let log = row.expected.starts_with("order ");
        let sweep = run.trim_start_matches("sweep ").split(' ').next().unwrap_or_default();
        let plain: String = row.quantity.replace("error of ", "").replace([' ', '.'], "-");
        let name = format!("{sweep}-{plain}");
        let line = (run.clone(), data);
        match groups.iter_mut().find(|group| group.name == name && group.data.key == data.key) {
            // A chart of errors wins over one of values, as orders are read from it.
            Some(group) if group.data.of_error == data.of_error => {
                group.log |= log;
                if group.lines.iter().all(|(known, _)| *known != line.0) {
                    group.lines.push(line);
                }
            }
            Some(group) if data.of_error => {
                let quantity = row.quantity.clone();
                *group = Group { name, data, quantity, log, lines: vec![line] };
            }
            Some(_) => {}
            None => {
                let quantity = row.quantity.clone();
                groups.push(Group { name, data, quantity, log, lines: vec![line] });
            }
        }
    }
    groups.iter().map(|group| (group.name.clone(), group.chart(case))).collect()
}

impl Group<'_> {
    fn chart(&self, case: &Case) -> Plot {
        let log = |value: f64| if self.log { value.log10() } else { value };
        let unit = match (self.log, self.data.unit.as_str()) {
            (false, unit) => unit.to_owned(),
            (true, unit) => format!("log10 of {unit}"),
        };
        let series = self.lines.iter().map(|(run, data)| {
            let mut numbers: Vec<[f64; 2]> = data
                .points
                .iter()
                .filter_map(|point| {
                    let number = point.error.filter(|_| data.of_error).unwrap_or(point.value);
                    Some([point.key?, number])
                })
                .collect();
            if self.log && !data.of_error {
                // Of an order without an expected value the differences are looked at.
                numbers =
                    numbers.windows(2).map(|w| [w[0][0], (w[0][1] - w[1][1]).abs()]).collect();
            }
            let points = numbers.into_iter().map(|[key, number]| [log(key), log(number)]).collect();
            let name = match run.split_once('(') {
                Some((_, other)) => {
                    let (key, value) = other.split_once('=').unwrap_or((other, ""));
                    let value = value.trim_end_matches(')');
                    format!("{}={value}: {}", last_part(key), self.quantity)
                }
                None => self.quantity.clone(),
            };
            let column = Column::new(name, unit.clone());
            Series { column, points, style: Style::Line }
        });
        let series: Vec<Series> = series.collect();
        let marks = series.iter().map(|line| Series { style: Style::Marks, ..line.clone() });
        let marks: Vec<Series> = marks
            .map(|line| Series { column: Column::new("members", line.column.unit), ..line })
            .collect();
        let points = marks.iter().flat_map(|line| line.points.clone()).collect();
        let marks = marks.into_iter().next().map(|line| Series { points, ..line });
        let key = &self.data.key;
        let abscissa = if self.log { format!("log10 of {key}") } else { key.clone() };
        Plot {
            title: format!("{}: {} along {key}", case.title, self.quantity),
            abscissa: Column::new(abscissa, ""),
            series: series.into_iter().chain(marks).collect(),
        }
    }
}
