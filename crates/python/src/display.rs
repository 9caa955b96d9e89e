//! What notebooks show, and times as texts show them.

use piola::output::{DIGITS, significant};

/// A time in s with as many digits as people read.
pub fn seconds(time: f64) -> String {
    format!("{} s", significant(time, DIGITS))
}

/// Text inside of HTML.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// A table with a heading and texts aligned to the left.
pub fn table<'a>(heading: &str, rows: impl IntoIterator<Item = [&'a str; 2]>) -> String {
    let rows = rows.into_iter().map(|[name, text]| {
        format!(
            "<tr><th style=\"text-align:left\">{}</th><td style=\"text-align:left\">{}</td></tr>",
            escape(name),
            escape(text)
        )
    });
    let rows: String = rows.collect();
    format!("<table><caption>{}</caption>{rows}</table>", escape(heading))
}

/// Text as it stands.
pub fn preformatted(text: &str) -> String {
    format!("<pre>{}</pre>", escape(text))
}

/// A page of its own within the notebook.
pub fn page(html: &str) -> String {
    format!(
        "<iframe srcdoc=\"{}\" style=\"width:100%;height:640px;border:0\"></iframe>",
        escape(html)
    )
}
