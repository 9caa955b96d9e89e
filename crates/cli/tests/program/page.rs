use std::fs;

use crate::support::{BAR, Place, assert_contains};

/// Checks of a sweep beside those of the tiny bar, of which one fails.
const CHECKS: &str = r#"
[[plot]]
name = "tip"
curves = ["tip.displacement.x"]

[[sweep]]
name = "mesh"
over = { body.bar.spacing = [0.2, 0.1] }

[[check]]
sweep = "mesh"
quantity = "run.first_step"
ratio = [0.49, 0.51]
against = "exact"
reason = "it is proportional"
source = "the step follows the spacing | Upwind (4.3)"

[[check]]
variant = "fast"
quantity = "tip.displacement.x"
at_most = 0.0
source = "wrong on purpose"
"#;

#[test]
fn a_page_of_a_coarse_case_is_as_expected() {
    let place = Place::new();
    place.write("cases/bar/case.toml", BAR.to_owned() + CHECKS);
    place.write("cases/bar/README.md", "# T1");
    place.write("cases/bar/impact.png", "a picture of its page");
    let (stdout, _) = place.run("verify cases --page docs/page.md", 1);
    assert_contains(&stdout, &["3 checks of 1 case", "wrote docs/page.md with 3 charts"]);
    let page = place.read("docs/page.md");
    let version = env!("CARGO_PKG_VERSION");
    assert_contains(
        &page,
        &[
            "# Validation\n",
            &format!("as written by `piola verify --page` of version {version}."),
            "**2 of 2 checks against something outside the program are met**: 2 of 2 against an exact",
            "0 of 1 do not say what they compare with.",
            "| T1 | bar | 2 of 2 |  |  |  |  |",
            "## CTVF: Adepu and Ramachandran (2021)",
            "### T1: A tiny bar",
            "[bar](../cases/bar/README.md), 4 runs of 6 to 11 particles.",
            "| coarse | tip.displacement.x initial | 0 m | 1e-15 m | 0 m | 0 m | exact \
             | it starts at rest | yes |",
            // Half the step, as spacing and step are proportional.
            "| coarse | sweep mesh: run.first_step | ratios 0.49 to 0.51 along body.bar.spacing |  | 0.5 |  \
             | exact | the step follows the spacing \\| Upwind (4.3). Bound: it is proportional | yes |",
            "| coarse | fast: tip.displacement.x final | at most 0 m |  | 0.0",
            "| wrong on purpose | **no** |",
            "![bar, tip](page/T1-bar-tip.png)",
            "![bar, mesh-run-first_step](page/T1-bar-mesh-run-first_step.png)",
            "![bar, impact](../cases/bar/impact.png)",
        ],
    );
    // A second time it is the same to the byte, charts too.
    let chart = || fs::read(place.path("docs/page/T1-bar-tip.png")).unwrap();
    let first = chart();
    place.run("verify cases --page docs/page.md --threads 1", 1);
    assert_eq!((place.read("docs/page.md"), chart()), (page, first));
}

#[test]
fn charts_that_are_no_longer_shown_are_removed_and_nothing_else() {
    let place = Place::new();
    place.write("bar/case.toml", BAR.to_owned() + CHECKS);
    place.run("verify bar --page page.md", 1);
    place.write("page/other.png", "mine");
    assert!(place.path("page/T1-bar-tip.png").exists());
    place.write("bar/case.toml", BAR);
    place.run("verify bar --page page.md", 0);
    assert!(!place.path("page/T1-bar-tip.png").exists());
    assert_eq!(place.read("page/other.png"), "mine");
    assert!(!place.read("page.md").contains(".png"));
}

#[test]
fn a_page_needs_a_place_to_be() {
    let place = Place::with_bar();
    let (_, stderr) = place.run("verify bar --page page", 2);
    assert_contains(&stderr, &["needs a file name extension"]);
    place.write("file", "");
    place.run("verify bar --page file/page.md", 4);
    // A case that cannot be read is in the page, as failed.
    place.write("cases/bad/case.toml", "version = 7");
    place.run("verify cases --page page.md", 1);
    assert_contains(&place.read("page.md"), &["### bad: ", "| the case file |", "**no**"]);
}
