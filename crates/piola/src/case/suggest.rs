//! The nearest known name for a misspelt one.

/// Longer words are not compared: nobody misspells a name by so much.
const LONGEST: usize = 64;

/// The candidate nearest to `word`, if any is near enough to be meant.
///
/// Near enough is a third of the longer word in single edits and swaps, and at least one edit;
/// a candidate that differs in case or in `-` and `_` only, or that one starts with, is near too.
pub(super) fn nearest<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    if word.len() > LONGEST {
        return None;
    }
    let folded = fold(word);
    candidates
        .into_iter()
        .map(|candidate| {
            let other = fold(candidate);
            let distance = match is_part(&folded, &other) || is_part(&other, &folded) {
                true => 1,
                false => strsim::damerau_levenshtein(&folded, &other),
            };
            let length = word.chars().count().max(candidate.chars().count());
            (distance, (length / 3).max(1), candidate)
        })
        .filter(|(distance, allowed, _)| distance <= allowed)
        .min_by_key(|(distance, ..)| *distance)
        .map(|(.., candidate)| candidate)
}

/// Whether `word` starts with `part`, which is long enough to mean something.
fn is_part(part: &str, word: &str) -> bool {
    part.len() >= 3 && word.starts_with(part)
}

fn fold(word: &str) -> String {
    word.to_lowercase().replace(['-', ' '], "_")
}

/// Names as a list in a sentence: `a`, `b` or `c`.
pub(super) fn one_of<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    match names.split_last() {
        None => "nothing".to_owned(),
        Some((only, [])) => only.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
    }
}

/// "did you mean", or else the list of what there is.
pub(super) fn suggestion<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str> + Clone,
) -> String {
    match nearest(word, candidates.clone()) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("expected {}", one_of(candidates)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_slips_and_nothing_else() {
        let names = ["spacing", "shape", "material", "initial"];
        assert_eq!(nearest("spacng", names), Some("spacing"));
        assert_eq!(nearest("Shape", names), Some("shape"));
        assert_eq!(nearest("intial", names), Some("initial"));
        assert_eq!(nearest("init", names), Some("initial"));
        assert_eq!(nearest("velocity", names), None);
        assert_eq!(nearest(&"a".repeat(1000), names), None);
    }

    #[test]
    fn lists_names() {
        assert_eq!(one_of(["a", "b", "c"]), "`a`, `b` or `c`");
        assert_eq!(one_of([]), "nothing");
        assert_eq!(suggestion("zzz", ["a", "b"]), "expected `a` or `b`");
    }
}
