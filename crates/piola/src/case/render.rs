//! Problems as plain text, with the offending line and an underline.

use std::fmt;

use super::diagnostics::Problem;
use super::source::{SourceText, floor_boundary};

/// Characters of a line that are shown at most.
const WIDTH: usize = 110;
/// Characters that are shown in front of the underlined text of a long line.
const CONTEXT: usize = 30;

/// Writes one problem with its place in `source`.
///
/// ```text
/// error: the spacing must be above 0, got -0.25
///   --> case.toml:9:11
///    |
///  9 | spacing = -0.25
///    |           ^^^^^ must be above 0
///    = help: the distance between particles in m
/// ```
pub(super) fn write_problem(
    out: &mut fmt::Formatter<'_>,
    problem: &Problem,
    source: Option<&SourceText>,
) -> fmt::Result {
    writeln!(out, "error: {}", printable(&problem.message))?;
    let mut margin = 2;
    match (source, problem.place) {
        (Some(source), Some(place)) => {
            let excerpt = Excerpt::new(source, place.start as usize, place.end as usize);
            let number = excerpt.line.to_string();
            margin = number.len();
            let blank = " ".repeat(margin);
            let name = printable(&source.name);
            writeln!(out, "{blank} --> {name}:{number}:{}", excerpt.column)?;
            writeln!(out, "{blank} |")?;
            writeln!(out, "{number} | {}", excerpt.text)?;
            let label = printable(&problem.label);
            writeln!(out, "{}", format!("{blank} | {} {label}", excerpt.underline).trim_end())?;
        }
        (Some(source), None) => writeln!(out, "   --> {}", printable(&source.name))?,
        _ => {}
    }
    if let Some(help) = &problem.help {
        writeln!(out, "{} = help: {}", " ".repeat(margin), printable(help))?;
    }
    Ok(())
}

/// The part of one line that is shown, and the marks under it.
struct Excerpt {
    line: usize,
    column: usize,
    text: String,
    underline: String,
}

impl Excerpt {
    fn new(source: &SourceText, start: usize, end: usize) -> Self {
        let text = &source.text;
        let start = floor_boundary(text, start);
        let end = floor_boundary(text, end).max(start);
        let (line, column) = source.line_column(start);
        let first = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let last = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
        let before: Vec<char> = text[first..start].chars().collect();
        let marked = text[start..end.min(last)].trim_end_matches('\r').chars().count().max(1);

        let skipped =
            if before.len() + marked > WIDTH { before.len().saturating_sub(CONTEXT) } else { 0 };
        let shown = text[first..last].trim_end_matches('\r').chars().skip(skipped);
        let mut clipped: String = shown.clone().take(WIDTH).collect();
        if shown.count() > WIDTH {
            clipped.push_str("...");
        }
        let (lead, lead_width) = if skipped > 0 { ("...", 3) } else { ("", 0) };
        let visible_before = &before[skipped..];
        // A tab in the line is repeated under it, so that the marks stay in their columns.
        let mut underline = " ".repeat(lead_width);
        underline.extend(visible_before.iter().map(|c| if *c == '\t' { '\t' } else { ' ' }));
        let room = (WIDTH + 1).saturating_sub(visible_before.len()).max(1);
        underline.push_str(&"^".repeat(marked.min(room)));
        Self { line, column, text: format!("{lead}{}", printable(&clipped)), underline }
    }
}

/// The text with control characters other than tabs replaced, so that a file of random bytes
/// cannot steer the terminal.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() && c != '\t' { '\u{fffd}' } else { c }).collect()
}
