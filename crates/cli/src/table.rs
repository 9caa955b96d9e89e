//! Columns of text, aligned and fitted to a width.

use console::{measure_text_width, truncate_str};

/// Columns are not made narrower than this.
const NARROWEST: usize = 12;
/// Spaces between columns.
const GAP: usize = 2;

/// Lines of `rows` with aligned columns, one line a row.
///
/// Where they are wider than `width`, the columns `shrinkable` are cut, each as far as needed and
/// possible before the next, until all fit or none can be cut further.
pub fn align(rows: &[Vec<String>], width: Option<usize>, shrinkable: &[usize]) -> Vec<String> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let mut widths = vec![0; columns];
    for row in rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = measure_text_width(cell).max(*width);
        }
    }
    let room = width.unwrap_or(usize::MAX).saturating_sub(GAP * columns.saturating_sub(1));
    for column in shrinkable.iter().copied().filter(|column| *column < columns) {
        let excess = widths.iter().sum::<usize>().saturating_sub(room);
        let spare = widths[column].saturating_sub(NARROWEST);
        widths[column] -= excess.min(spare);
    }
    let line = |row: &Vec<String>| {
        let mut line = String::new();
        for (cell, width) in row.iter().zip(&widths) {
            let cell = truncate_str(cell, *width, "…");
            let padding = GAP + width - measure_text_width(&cell).min(*width);
            line.push_str(&cell);
            line.extend(std::iter::repeat_n(' ', padding));
        }
        line.trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<Vec<String>> {
        [["id", "quantity", "ok"], ["U10", "a rather long name of a quantity", "no"]]
            .map(|row| row.map(str::to_owned).to_vec())
            .to_vec()
    }

    #[test]
    fn columns_are_aligned() {
        let lines = align(&rows(), None, &[1]);
        assert_eq!(lines[0], format!("id   quantity{}ok", " ".repeat(26)));
        assert_eq!(lines[1], "U10  a rather long name of a quantity  no");
        assert_eq!(align(&[], Some(10), &[0]), Vec::<String>::new());
    }

    #[test]
    fn wide_columns_are_cut_to_the_width() {
        let lines = align(&rows(), Some(30), &[1]);
        assert_eq!(lines[1], "U10  a rather long name o…  no");
        assert!(lines.iter().all(|line| measure_text_width(line) <= 30));
        // Nothing is cut below a readable width, whatever the terminal.
        let lines = align(&rows(), Some(1), &[1]);
        assert_eq!(lines[1], "U10  a rather lo…  no");
    }
}
