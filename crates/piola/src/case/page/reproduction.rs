//! The reproduction list: what is required of each result of the papers, and whether it is met.

use serde::Deserialize;

use super::{Results, cell, push};
use crate::case::model::Against;

/// One row of the list, as `reproduction.toml` has it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reproduction {
    /// Its id: a letter for the paper, and a number.
    pub id: String,
    /// What is required.
    pub asked: String,
    /// The setting that it was run at.
    pub setting: String,
    /// The result.
    pub result: String,
    /// Whether that is what was required.
    pub met: Met,
    /// Why it is not, or how it is known.
    pub why: String,
    /// The id of the cases whose checks show it, if it is another.
    pub checks_of: Option<String>,
}

/// Whether a row of the list is met.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Met {
    /// As required.
    Yes,
    /// In part, or in a weaker form.
    Partly,
    /// Not.
    No,
}

impl Reproduction {
    /// Reads the list.
    ///
    /// # Errors
    /// What is wrong with `text`, in the words of the TOML reader, with the line.
    pub fn read(text: &str) -> Result<Vec<Self>, String> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct List {
            row: Vec<Reproduction>,
        }
        let list: List = toml::from_str(text).map_err(|error| error.to_string())?;
        Ok(list.row)
    }
}

/// Adds the list to the page: what a person says of each row, beside what the checks of the cases
/// with its id count.
pub(super) fn table(page: &mut String, list: &[Reproduction], results: &Results) {
    if list.is_empty() {
        return;
    }
    let count = |met: Met| list.iter().filter(|row| row.met == met).count();
    push(
        page,
        &format!(
            "\n## The reproduction list\n\n\
             {} of {} rows are met as required, {} in part or in a weaker form, {} are not met. \
             This is judged by hand; the last column counts the checks of the cases with this id \
             against exact solutions, other methods and the papers.\n\n\
             | id | asked | setting | result | met | why | checks |\n|---|---|---|---|---|---|---|\n",
            count(Met::Yes),
            list.len(),
            count(Met::Partly),
            count(Met::No),
        ),
    );
    for row in list {
        let shown_by = row.checks_of.as_ref().unwrap_or(&row.id);
        let cases = results.cases.iter().filter(|case| case.id == *shown_by);
        let outside = Against::ALL.into_iter().filter(|worth| worth.is_outside());
        let each = cases.flat_map(|case| outside.clone().map(|worth| case.count(Some(worth))));
        let [met, all] = each.fold([0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
        let judged = match row.met {
            Met::Yes => "yes",
            Met::Partly => "partly",
            Met::No => "**no**",
        };
        let checks = match (&row.checks_of, all) {
            (_, 0) => "none".to_owned(),
            (None, _) => format!("{met} of {all}"),
            (Some(other), _) => format!("{met} of {all}, those of {other}"),
        };
        let cells = [&row.id, &row.asked, &row.setting, &row.result].map(|text| cell(text));
        let line =
            format!("| {} | {judged} | {} | {checks} |\n", cells.join(" | "), cell(&row.why));
        push(page, &line);
    }
}
