//! Writing to a terminal, a file or a pipe that may be closed.

use std::io::{self, Write};

use console::{Style, Term, style};

use crate::exit::{Exit, Fault};

/// Writes `text` to stdout. A closed pipe (`piola schema | head`) is not a fault: whoever reads
/// has read enough.
pub fn print(text: &str) -> Result<(), Fault> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Fault::new(Exit::Io, format_args!("cannot write to the standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes `text` to stderr. Nobody can be told if that fails.
pub fn report(text: &str) {
    let mut stderr = io::stderr().lock();
    let _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
}

/// The width of stdout in characters, `None` if it is no terminal.
pub fn stdout_width() -> Option<usize> {
    let stdout = Term::stdout();
    let (_, columns) = stdout.is_term().then(|| stdout.size_checked()).flatten()?;
    Some(usize::from(columns))
}

/// A report of problems with colours, if stderr is a terminal that wants them (`NO_COLOR`).
///
/// The lines of the library's rendering are told apart by how they start.
pub fn coloured(report: &str) -> String {
    if !console::colors_enabled_stderr() {
        return report.to_owned();
    }
    let paint = |line: &str| -> String {
        let trimmed = line.trim_start();
        let paint = |text: &str, style: Style| style.for_stderr().apply_to(text).to_string();
        if let Some(message) = line.strip_prefix("error:") {
            return format!("{}{message}", paint("error:", Style::new().red().bold()));
        }
        if trimmed.starts_with("--> ") {
            return paint(line, Style::new().cyan());
        }
        if let Some(help) = trimmed.strip_prefix("= help:") {
            let margin = &line[..line.len() - trimmed.len()];
            return format!("{margin}{}{help}", paint("= help:", Style::new().green()));
        }
        match trimmed.strip_prefix("| ") {
            Some(marks) if marks.trim_start().starts_with('^') => {
                paint(line, Style::new().yellow())
            }
            _ => line.to_owned(),
        }
    };
    report
        .split_inclusive('\n')
        .map(|line| match line.strip_suffix('\n') {
            Some(line) => format!("{}\n", paint(line)),
            None => paint(line),
        })
        .collect()
}

/// `word` in green or red on stdout, if it is a terminal that wants colours.
pub fn verdict(word: &str, good: bool) -> String {
    match good {
        true => style(word).green().to_string(),
        false => style(word).red().bold().to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_change_no_word() {
        let report = "error: wrong\n  --> case.toml:3:1\n  |\n3 | spacin = 1\n  | ^^^^^^ unknown\n  \
                      = help: spacing\n\n1 problem\n";
        console::set_colors_enabled_stderr(true);
        let painted = coloured(report);
        assert_eq!(console::strip_ansi_codes(&painted), report);
        let is_painted = |line: &str| line.contains('\u{1b}');
        let lines: Vec<bool> = painted.lines().map(is_painted).collect();
        assert_eq!(lines, [true, true, false, false, true, true, false, false]);
        console::set_colors_enabled_stderr(false);
        assert_eq!(coloured(report), report);
    }
}
