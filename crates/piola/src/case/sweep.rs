//! The results of the members of a sweep, side by side: one table, and charts.

use std::io;
use std::path::Path;

use super::finished::Finished;
use super::model::Case;
use crate::observe::Series;
use crate::output::{self, Column, OutputError, Plot, Style, atomic};

/// Members of a sweep with their results.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    /// What the case shows.
    pub title: String,
    /// Paths of the keys.
    pub keys: Vec<String>,
    /// The members, in order.
    pub members: Vec<MemberResult>,
}

/// The result of one member.
#[derive(Clone, Debug)]
pub struct MemberResult {
    /// Name of its folder.
    pub name: String,
    /// The value of each key.
    pub values: Vec<MemberValue>,
    /// The outcome of its run, or in a word why there was none.
    pub outcome: String,
    /// Wall time in s, of building and running.
    pub seconds: Option<f64>,
    /// The run, if there was one.
    pub finished: Option<Finished>,
}

/// The value of a key.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberValue {
    /// As the user wrote it.
    pub text: String,
    /// If it is a number or an expression of the parameters, the number.
    pub number: Option<f64>,
}

impl MemberValue {
    /// The value that the user wrote as `text`, for the case that it makes.
    pub fn new(text: &str, case: &Case) -> Self {
        let text = text.trim().trim_matches(['"', '\'']).to_owned();
        let number = case.evaluate(&text);
        Self { text, number }
    }
}

/// Last, smallest and largest value of a column of the tables.
struct Extremes {
    unit: String,
    values: [f64; 3],
}

const REDUCED: [&str; 3] = ["final", "smallest", "largest"];

impl Comparison {
    /// Writes the table as CSV to the file `path`: the values of the keys, folder, outcome, steps
    /// and wall time of each member, and last, smallest and largest value of every column of probes
    /// and energies. Members without a run have empty cells.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<u64, OutputError> {
        atomic::write_file(path, |out| self.write_to(out))
    }

    fn write_to(&self, out: &mut dyn io::Write) -> io::Result<()> {
        let columns = self.columns();
        let mut writer = csv::Writer::from_writer(out);
        let fixed = ["folder", "outcome", "steps [1]", "wall_time [s]"].map(str::to_owned);
        let reduced = columns.iter().flat_map(|column| {
            REDUCED
                .map(|which| Column::new(format!("{} {which}", column.name), &column.unit).header())
        });
        writer.write_record(self.keys.iter().cloned().chain(fixed).chain(reduced))?;
        for member in &self.members {
            let mut row: Vec<String> =
                member.values.iter().map(|value| value.text.clone()).collect();
            let summary = member.finished.as_ref().map(|finished| &finished.summary);
            row.push(member.name.clone());
            row.push(member.outcome.clone());
            row.push(summary.map_or_else(String::new, |summary| summary.steps.to_string()));
            row.push(member.seconds.map_or_else(String::new, |seconds| format!("{seconds:.3}")));
            for column in &columns {
                row.extend(match extremes(member, &column.name) {
                    Some(found) => found.values.map(|value| format!("{value:?}")),
                    None => Default::default(),
                });
            }
            writer.write_record(row)?;
        }
        writer.flush()
    }

    /// The columns of probes and energies of the members, in order.
    fn columns(&self) -> Vec<Column> {
        let mut columns: Vec<Column> = Vec::new();
        for finished in self.members.iter().filter_map(|member| member.finished.as_ref()) {
            let tables = [(&finished.tables.probes, ""), (&finished.tables.energy, "energy.")];
            for (table, prefix) in tables {
                for column in table.columns().iter().skip(1) {
                    let column = Column::new(format!("{prefix}{}", column.name), &column.unit);
                    if !columns.contains(&column) {
                        columns.push(column);
                    }
                }
            }
        }
        columns
    }

    /// Names of the columns of probes, and the total energy: the quantities that are shown on the screen.
    pub fn headlines(&self) -> Vec<String> {
        let names = self.columns().into_iter().map(|column| column.name);
        names.filter(|name| !name.starts_with("energy.") || name == "energy.total").collect()
    }

    /// The last value of a column in a member, with its unit.
    pub fn last(&self, member: &MemberResult, column: &str) -> Option<(f64, String)> {
        extremes(member, column).map(|found| (found.values[0], found.unit))
    }

    /// The charts, each with a name for its file: for every column of probes and for the total
    /// energy the curves of all members, and for one key whose values are numbers the last values
    /// of each of them against the key.
    pub fn charts(&self) -> Vec<(String, Plot)> {
        let mut charts = Vec::new();
        for name in self.headlines() {
            let series: Vec<output::Series> = self
                .members
                .iter()
                .filter_map(|member| {
                    let curve = member.finished.as_ref()?.quantity(&name)?;
                    curve_series(&format!("{}: {name}", member.name), curve)
                })
                .collect();
            if !series.is_empty() {
                let plot =
                    Plot { title: self.title.clone(), abscissa: Column::new("time", "s"), series };
                charts.push((name, plot));
            }
        }
        charts.extend(self.finals().map(|plot| ("final-values".to_owned(), plot)));
        charts
    }

    fn finals(&self) -> Option<Plot> {
        let [key] = &self.keys[..] else { return None };
        let numbers = self.members.iter().map(|member| member.values.first()?.number);
        let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
        let mut order: Vec<usize> = (0..numbers.len()).collect();
        order.sort_by(|one, other| numbers[*one].total_cmp(&numbers[*other]));
        let series = self
            .columns()
            .into_iter()
            .filter(|column| !column.name.starts_with("energy.") || column.name == "energy.total");
        let series: Vec<output::Series> = series
            .filter_map(|column| {
                let points: Vec<[f64; 2]> = order
                    .iter()
                    .filter_map(|&index| {
                        let (last, _) = self.last(&self.members[index], &column.name)?;
                        Some([numbers[index], last])
                    })
                    .collect();
                (!points.is_empty()).then_some(output::Series {
                    column,
                    points,
                    style: Style::Line,
                })
            })
            .collect();
        (numbers.len() > 1 && !series.is_empty()).then(|| Plot {
            title: format!("{}: last values", self.title),
            abscissa: Column::new(key, ""),
            series,
        })
    }
}

/// A curve for a chart; numbers without history make none.
pub(super) fn curve_series(name: &str, series: Series) -> Option<output::Series> {
    let Series::Curve { abscissa, values, unit, .. } = series else { return None };
    let points = abscissa.into_iter().zip(values).map(|(x, value)| [x, value]).collect();
    Some(output::Series { column: Column::new(name, unit), points, style: Style::Line })
}

fn extremes(member: &MemberResult, name: &str) -> Option<Extremes> {
    let Series::Curve { values, unit, .. } = member.finished.as_ref()?.quantity(name)? else {
        return None;
    };
    let last = *values.last()?;
    let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Some(Extremes { unit, values: [last, smallest, largest] })
}

/// The values of a list that are separated by commas: those in brackets, braces and quotes do not
/// count. Blanks around values are dropped.
pub fn split_values(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let (mut start, mut depth, mut quote) = (0, 0_usize, None);
    for (index, letter) in text.char_indices() {
        match (letter, quote) {
            (letter, Some(open)) if letter == open => quote = None,
            (_, Some(_)) => {}
            ('"' | '\'', None) => quote = Some(letter),
            ('[' | '{' | '(', None) => depth += 1,
            (']' | '}' | ')', None) => depth = depth.saturating_sub(1),
            (',', None) if depth == 0 => {
                parts.push(text[start..index].trim());
                start = index + 1;
            }
            _ => {}
        }
    }
    parts.push(text[start..].trim());
    parts
}

/// Names of folders for members, from the values of their keys: `time.cfl=0.1+scheme.kernel=lucy`.
///
/// Characters that are not suitable for file names on every system become `_`, long values are cut, and names that
/// would then be equal, or differ only in case, get a number.
pub fn folder_names(members: &[Vec<(&str, &str)>]) -> Vec<String> {
    const LONGEST: usize = 80;
    let suits = |letter: char| letter.is_ascii_alphanumeric() || "-_.".contains(letter);
    let safe = |text: &str| -> String {
        let text = text.trim().trim_matches(['"', '\'']);
        let letters = text.chars().filter(|letter| !letter.is_whitespace());
        letters.take(LONGEST).map(|letter| if suits(letter) { letter } else { '_' }).collect()
    };
    let mut names: Vec<String> = Vec::new();
    for values in members {
        let parts = values.iter().map(|(key, value)| format!("{}={}", safe(key), safe(value)));
        let mut name: String =
            parts.collect::<Vec<_>>().join("+").chars().take(2 * LONGEST).collect();
        // A point at the end is lost on some systems.
        if name.ends_with('.') {
            name.push('_');
        }
        let plain = name.clone();
        let mut number = 2;
        while names.iter().any(|known| known.eq_ignore_ascii_case(&name)) {
            name = format!("{plain}-{number}");
            number += 1;
        }
        names.push(name);
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_split_at_the_commas_between_them() {
        for (text, parts) in [
            ("0.1,0.2", vec!["0.1", "0.2"]),
            (" 1 , 2 ", vec!["1", "2"]),
            ("[1, 2],[3, 4]", vec!["[1, 2]", "[3, 4]"]),
            ("'a,b',\"c,'d\"", vec!["'a,b'", "\"c,'d\""]),
            ("max(1, 2),{ a = 1, b = [2, 3] }", vec!["max(1, 2)", "{ a = 1, b = [2, 3] }"]),
            ("1,,2", vec!["1", "", "2"]),
            ("", vec![""]),
            ("[1,2", vec!["[1,2"]),
        ] {
            assert_eq!(split_values(text), parts, "{text}");
        }
    }

    #[test]
    fn folders_have_safe_names_that_differ() {
        let one = |value| vec![("body.a.spacing", value)];
        let names = folder_names(&[
            one("0.1"),
            one("[ 0.1, 0.2 ]"),
            one("L / 9"),
            one("L * 9"),
            one("l / 9"),
            one("../../etc"),
            one("1."),
            one("\"quoted\""),
            one(&"é".repeat(500)),
        ]);
        assert_eq!(names[0], "body.a.spacing=0.1");
        assert_eq!(names[1], "body.a.spacing=_0.1_0.2_");
        assert_eq!(names[2..5], ["L_9", "L_9-2", "l_9-3"].map(|n| format!("body.a.spacing={n}")));
        assert_eq!(names[5], "body.a.spacing=.._.._etc");
        assert_eq!(names[6], "body.a.spacing=1._");
        assert_eq!(names[7], "body.a.spacing=quoted");
        assert!(names[8].len() < 200 && names[8].is_ascii());
        let two = folder_names(&[vec![("a", "1"), ("b", "x")], vec![("a", "1"), ("b", "y")]]);
        assert_eq!(two, ["a=1+b=x", "a=1+b=y"]);
    }
}
