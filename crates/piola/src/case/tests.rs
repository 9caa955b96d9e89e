use super::*;

#[test]
fn the_template_is_a_good_case() {
    let case = parse(&template::new_case("a \"new\" case"), "case.toml", &LoadOptions::default())
        .unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(case.title, "a new case");
}
