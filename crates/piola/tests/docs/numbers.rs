//! No number in a README of a case or in the gallery, whole ones in tables and others anywhere, that neither the results nor
//! the files of the case hold, and whose sentence has no command and no source.

use piola::case::page::CaseResults;

use super::pages::{below, page, root};
use super::validation::results;

/// Units that a page may have in place of those of the results: %, mm or ms, um or us, kPa, MPa.
const FACTORS: [f64; 6] = [1.0, 1e2, 1e3, 1e6, 1e-3, 1e-6];

/// The numbers of `text`, each as it is written: digits, and perhaps a point and an exponent.
fn tokens(text: &str) -> impl Iterator<Item = &str> {
    let is_part = |c: char| c.is_ascii_digit() || ".-+e".contains(c);
    let words = text.split(move |c: char| !is_part(c));
    // A sign ends a number, but in an exponent.
    let parts = words.flat_map(|word| {
        let is_end = |at: &usize| !word[..*at].ends_with('e');
        let ends = word.match_indices(['-', '+']).map(|(at, _)| at).filter(is_end);
        let ends: Vec<usize> = ends.chain([word.len()]).collect();
        let starts = [0].into_iter().chain(ends.clone().into_iter().map(|end| end + 1));
        starts.zip(ends).map(|(start, end)| &word[start..end]).collect::<Vec<_>>()
    });
    parts.map(|word| word.trim_matches(['.', 'e'])).filter(|word| word.parse::<f64>().is_ok())
}

/// Those with a point.
fn written(text: &str) -> Vec<String> {
    tokens(text).filter(|word| word.contains('.')).map(str::to_owned).collect()
}

/// The whole numbers of the tables of `text` that are worth a comparison: from 20 on, for smaller ones are the rounded
/// values of too much, and with or without blanks between thousands.
fn whole(text: &str) -> Vec<String> {
    let outside = text.split("```").step_by(2);
    let rows = outside.flat_map(str::lines).filter(|line| line.starts_with('|'));
    let cells = rows.flat_map(|row| row.split(['|', ',', ';', '(', ')']));
    let numbers = cells.flat_map(|cell| {
        let mut numbers: Vec<String> = Vec::new();
        let mut is_open = false;
        for word in cell.split(' ') {
            let is_digits = !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit());
            match numbers.last_mut() {
                Some(last) if is_open && is_digits && word.len() == 3 => last.push_str(word),
                _ if is_digits => numbers.push(word.to_owned()),
                _ => {}
            }
            is_open = is_digits && word.len() <= 3;
        }
        numbers
    });
    numbers.filter(|number| number.parse::<u64>().is_ok_and(|number| number >= 20)).collect()
}

/// All numbers that a case has results of, with their ratios to what is expected, or files. Those of a table are results, or
/// what is expected of them.
fn known(case: &CaseResults, folder: &str, is_table: bool) -> (Vec<f64>, Vec<f64>) {
    let cells = |text: &str| {
        let words = text.split([' ', ',', ';', '(', ')', '=']).map(str::to_owned);
        words.filter_map(|word| word.trim_end_matches('%').parse().ok()).collect::<Vec<f64>>()
    };
    let numbers = case.rows.iter().flat_map(|row| {
        let results = [&row.got, &row.expected, &row.off_by].into_iter().chain(&row.members);
        let rest = [&row.quantity, &row.tolerance, &row.source].into_iter();
        let rest = rest.chain(&row.run).chain(&row.bound).filter(|_| !is_table);
        let ratio = cells(&row.got).first().zip(cells(&row.expected).first()).map(|(a, b)| a / b);
        let all = results.chain(rest).flat_map(|text| cells(text));
        all.chain(ratio.filter(|_| !is_table)).collect::<Vec<_>>()
    });
    let files = below(folder, &["case.toml", ".csv", ".py"]);
    // What a case says of its results is no evidence of them.
    let lines = files.iter().flat_map(|file| file.text.lines());
    let texts = lines
        .filter(|line| !line.starts_with("unmet = "))
        .flat_map(tokens)
        .map(|word| word.parse().expect("a number"));
    let particles = case.particles.map(|count| count as f64);
    (numbers.chain(particles).collect(), texts.collect())
}

/// Whether a number is `written` with fewer digits.
fn is_rounded(written: &str, value: f64) -> bool {
    let (mantissa, exponent) = written.split_once('e').unwrap_or((written, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let (Ok(number), Ok(exponent)) = (written.parse::<f64>(), exponent.parse::<i32>()) else {
        return false;
    };
    let unit = 10_f64.powi(exponent - i32::try_from(decimals).unwrap_or(0));
    (value.abs() - number.abs()).abs() <= 0.5001 * unit
}

fn unheld(text: &str, case: &CaseResults, folder: &str) -> Vec<String> {
    let unheld_of = |numbers: Vec<String>, is_table: bool| {
        let (values, files) = known(case, folder, is_table);
        let held = |number: &String| {
            let rounded =
                |value: &f64| FACTORS.iter().any(|factor| is_rounded(number, value * factor));
            let own: f64 = number.parse().expect("a number");
            let is_same = |value: &f64| {
                FACTORS.iter().any(|factor| (value * factor / own - 1.0).abs() < 1e-9)
            };
            files.iter().any(is_same) || values.iter().any(rounded)
        };
        numbers.into_iter().filter(|number| !held(number)).collect::<Vec<_>>()
    };
    let is_row = |line: &&str| line.starts_with('|');
    let rows: Vec<&str> = text.lines().filter(is_row).collect();
    let rest: Vec<&str> = text.lines().filter(|line| !is_row(line)).collect();
    let mut of_tables = written(&claims(&rows.join("\n")));
    of_tables.extend(whole(text));
    let mut unheld = unheld_of(of_tables, true);
    unheld.extend(unheld_of(written(&claims(&rest.join("\n"))), false));
    unheld
}

/// Text that says by which command the numbers of a sentence came about.
const COMMANDS: [&str; 4] = ["`--", "`piola ", ".py`", "`parameters."];

/// Whether a sentence says where its numbers are from: a command, or a publication with its year, as `(1990)`.
fn says_where(sentence: &str) -> bool {
    let is_year = |word: &str| {
        let word = word.trim_end_matches(['.', ',', ';', ':']).strip_suffix(')');
        let year = word.and_then(|word| word.trim_start_matches('(').parse().ok());
        year.is_some_and(|year: u32| (1900..2100).contains(&year))
    };
    COMMANDS.iter().any(|command| sentence.contains(command))
        || sentence.split_whitespace().any(is_year)
}

/// Whether `word` is the number of an equation of a paper, as `(3.38)` is.
fn is_equation(word: &str) -> bool {
    let word = word.trim_end_matches(['.', ',', ';', ':']);
    let number = word.strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
    let parts = number.and_then(|number| number.split_once('.'));
    let counts = |part: &str| part.parse::<u32>().is_ok_and(|count| count > 0);
    parts.is_some_and(|(chapter, equation)| counts(chapter) && counts(equation))
}

/// What `text` claims: its tables, and the sentences of the rest but for those that say where their numbers are from; no
/// blocks of code, places in papers, and what links lead to.
fn claims(text: &str) -> String {
    let outside = text.split("```").step_by(2);
    let blocks = outside.flat_map(|part| part.split("\n\n")).flat_map(|block| block.split("\n- "));
    let sentences = blocks.flat_map(|block| {
        let is_table = block.lines().any(|line| line.starts_with('|'));
        let ends: &[&str] = if is_table { &[] } else { &[". ", ".\n"] };
        let pieces = ends.iter().fold(vec![block], |pieces, end| {
            pieces.into_iter().flat_map(|piece| piece.split(*end)).collect()
        });
        pieces.into_iter().filter(move |piece| is_table || !says_where(piece))
    });
    let words = sentences.flat_map(|block| {
        let (mut is_place, mut was_place) = (false, false);
        block.split_whitespace().filter(move |word| {
            let of_place = is_place;
            let name = word.trim_start_matches('(').trim_end_matches('s').to_lowercase();
            is_place = match name.as_str() {
                "section" | "figure" | "table" => true,
                "and" | "to" => was_place,
                word => of_place && word.ends_with(','),
            };
            was_place = of_place;
            !of_place && !is_equation(word)
        })
    });
    let words = words.map(|word| word.split_once("](").map_or(word, |(text, _)| text));
    words.collect::<Vec<_>>().join(" ")
}

#[test]
fn numbers_of_cases_are_those_of_the_results() {
    let results = results();
    let mut wrong = Vec::new();
    for case in &results.cases {
        let path = root().join("docs").join(&case.link);
        let folder = path.parent().expect("a case lies in a folder");
        let folder = folder.canonicalize().expect("it is there");
        let base = root().canonicalize().expect("it is there");
        let folder = folder.strip_prefix(base).expect("it is below the root").display().to_string();
        let readme = page(&format!("{folder}/README.md"));
        let numbers = unheld(&readme.text, case, &folder);
        if !numbers.is_empty() {
            wrong.push(format!("{}: {}", readme.name, numbers.join(", ")));
        }
        // The gallery has a row for each.
        let gallery = page("docs/gallery.md");
        let rows = gallery.text.lines().filter(|line| line.contains(&format!("](../{folder})")));
        let rows: Vec<&str> = rows.collect();
        assert!(!rows.is_empty(), "the gallery has no row of {folder}");
        let numbers = unheld(&rows.join("\n"), case, &folder);
        if !numbers.is_empty() {
            wrong.push(format!("docs/gallery.md, {folder}: {}", numbers.join(", ")));
        }
    }
    assert!(
        wrong.is_empty(),
        "neither results nor files of the case hold, and their sentences have no command:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn numbers_are_compared_with_the_digits_they_have() {
    assert_eq!(written("| 0.008 | -1.5e-3 m, 25 | v1.2.3 |"), ["0.008", "1.5e-3"]);
    let text = "In figures 4.1, 4.2 and 4.3 it is 0.5.\n- `--set a=1` gives 0.7\n- and 0.8\n```\n0.9\n```\n";
    assert_eq!(written(&claims(text)), ["0.5", "0.8"]);
    let text =
        "`--set a=1` gives 0.7. It is\n0.8. Liu (1998) has 0.9, Ng (A 2020) 1.1. Of 1998 are 1.2.";
    assert_eq!(written(&claims(text)), ["0.8", "1.2"]);
    assert_eq!(written(&claims("| `--set a=1` | 0.7 |\n| 2 | 0.8 |")), ["0.7", "0.8"]);
    let text = "from (3.38), (3.41); it is (0.5): ![at 0.6 s](at-0.7.png) [a 1.5](b-1.6.png).";
    assert_eq!(written(&claims(text)), ["0.5", "0.6", "1.5"]);
    assert_eq!(written("0.3-0.5, 1.5e-3 and -2.5"), ["0.3", "0.5", "1.5e-3", "2.5"]);
    let table = "| 25 mm, 34 352 | 1875 and (7500) J | T10 | 7.5, 12 |\n| a 1000 100 |\nNot 99.";
    assert_eq!(whole(table), ["25", "34352", "1875", "7500", "1000", "100"]);
    assert!(is_rounded("0.008", 0.00799) && !is_rounded("0.008", 0.0086));
    assert!(is_rounded("1.5e-3", 0.00149) && is_rounded("0.77", 0.7699));
}
