//! The pages that the program writes are those of this version.

use piola::case::{reference, schema};

use super::pages::page;

fn is_fresh(name: &str, command: &str, text: &str) {
    assert!(page(name).text == text, "renew it: cargo run --release -- {command} > {name}");
}

#[test]
fn the_reference_of_the_case_file_is_fresh() {
    is_fresh("docs/case-file.md", "reference", &reference::markdown());
}

#[test]
fn the_schema_of_the_case_file_is_fresh() {
    let text = format!("{:#}\n", schema::json_schema());
    is_fresh("docs/case-file.schema.json", "schema", &text);
}
