//! The pages that the program writes are those of this version.

use piola::case::{reference, schema};

use super::pages::page;

fn is_fresh(name: &str, command: &str, text: &str) {
    assert!(page(name).text == text, "renew it: cargo run --release -- {command} > {name}");
}

#[test]
fn the_reference_of_the_case_file_is_fresh() {
    let text = reference::markdown();
    is_fresh("docs/case-file.md", "reference", &text);
    // Lines of the source that were joined with their indentation.
    let is_wide = |line: &&str| {
        let is_text = |byte: u8| byte != b' ' && byte != b'|';
        line.as_bytes().windows(4).any(|w| is_text(w[0]) && w[1..3] == *b"  " && is_text(w[3]))
            || line.trim_start().contains("   ")
    };
    let wide = text.lines().find(is_wide);
    assert_eq!(wide, None);
}

#[test]
fn the_schema_of_the_case_file_is_fresh() {
    let text = format!("{:#}\n", schema::json_schema());
    is_fresh("docs/case-file.schema.json", "schema", &text);
}
