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
    // A text that goes on in the next line of the source without its backslash.
    let wide = text.lines().find(|line| line.trim_start().contains("   "));
    assert_eq!(wide, None);
}

#[test]
fn the_schema_of_the_case_file_is_fresh() {
    let text = format!("{:#}\n", schema::json_schema());
    is_fresh("docs/case-file.schema.json", "schema", &text);
}
