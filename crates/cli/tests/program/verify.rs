use crate::support::{BAR, Place, assert_contains};

/// A check of the tip that fails, at both settings unless `when` says otherwise.
fn impossible(when: &str) -> String {
    format!(
        "\n[[check]]\nquantity = \"tip.displacement.x\"\nreduce = \"maximum\"\nat_least = 1e3\n\
         source = \"nothing\"\nwhen = \"{when}\"\n"
    )
}

#[test]
fn checks_that_pass() {
    let place = Place::with_bar();
    let (stdout, _) = place.run("verify bar", 0);
    let mut lines = stdout.lines();
    assert_contains(
        lines.next().unwrap(),
        &["id", "setting", "quantity", "got", "expected", "tolerance"],
    );
    let row: Vec<&str> = lines.next().unwrap().split("  ").filter(|s| !s.is_empty()).collect();
    let row: Vec<&str> = row.iter().map(|cell| cell.trim()).collect();
    let expected = [
        "T1",
        "coarse",
        "tip.displacement.x initial",
        "0 m",
        "0 m",
        "1e-15 m",
        "it starts at rest",
        "yes",
    ];
    assert_eq!(row, expected);
    assert_contains(&stdout, &["1 check of 1 case: 1 passed, 0 failed"]);
    // It leaves no files.
    assert!(!place.path("results").exists());
}

#[test]
fn a_failed_check_is_named_and_counted() {
    let place = Place::new();
    place.write("cases/a/case.toml", BAR);
    place.write("cases/deep/b/case.toml", BAR.to_owned() + &impossible("always"));
    // The default is the folder `cases`.
    let (stdout, _) = place.run("verify", 1);
    assert_contains(&stdout, &["at least 1000 m", "NO", "3 checks of 2 cases: 2 passed, 1 failed"]);
}

#[test]
fn what_a_case_knows_not_to_be_met_does_not_fail() {
    let place = Place::new();
    let known = impossible("always") + "unmet = \"bars are no longer than that\"\n";
    place.write("cases/a/case.toml", BAR.to_owned() + &known);
    let (stdout, _) = place.run("verify", 0);
    let count = "2 checks of 1 case: 1 passed, 1 known not to be met, 0 failed";
    assert_contains(&stdout, &["bars are no longer than that", "  no\n", count]);
    // Once it is met, the mark is wrong.
    place.write("cases/a/case.toml", BAR.to_owned() + &known.replace("1e3", "-1e3"));
    let (stdout, _) = place.run("verify", 1);
    assert_contains(&stdout, &["remove `unmet`", "1 passed, 1 failed"]);
}

#[test]
fn the_setting_chooses_runs_and_checks() {
    let place = Place::new();
    place.write("bar/case.toml", BAR.to_owned() + &impossible("case"));
    place.run("verify bar", 0);
    place.run("verify bar --full", 1);
    // The end of the run itself is another one.
    let end =
        "\n[[check]]\nquantity = \"run.time\"\nexpected = 0.01\ntolerance = 1e-9\nsource = \"s\"\n";
    place.write("bar/case.toml", BAR.to_owned() + end);
    place.run("verify bar", 0);
    place.run("verify bar --full", 1);
}

#[test]
fn a_variant_is_run_for_its_checks() {
    let place = Place::new();
    let check = "\n[[check]]\nvariant = \"fast\"\nquantity = \"tip.displacement.x\"\n\
                 reduce = \"final\"\nmore_than = \"base\"\nsource = \"it starts faster\"\n";
    place.write("bar/case.toml", BAR.to_owned() + check);
    let (stdout, _) = place.run("verify bar", 0);
    assert_contains(&stdout, &["fast: tip.displacement.x final", "more than base ("]);
    place.write("bar/case.toml", BAR.to_owned() + &check.replace("more_than", "less_than"));
    place.run("verify bar", 1);
}

#[test]
fn a_failed_run_fails_its_checks_with_the_reason() {
    let place = Place::new();
    place.write("bar/case.toml", BAR.replace("cfl = 0.2", "cfl = 0.2\nmax_steps = 1"));
    let (stdout, _) = place.run("verify bar", 1);
    assert_contains(
        &stdout,
        &["the run failed: it took the maximum number of steps, 1,", "1 failed"],
    );
}

#[test]
fn a_case_that_cannot_be_read_fails_and_the_rest_goes_on() {
    let place = Place::new();
    place.write("cases/a/case.toml", "version = 7");
    place.write("cases/b/case.toml", BAR);
    let (stdout, stderr) = place.run("verify cases", 1);
    assert_contains(&stderr, &["cases/a/case.toml:1:11", "problems in cases/a/case.toml"]);
    assert_contains(&stdout, &["the case file", "2 checks of 2 cases: 1 passed, 1 failed"]);
}

#[test]
fn one_case_is_chosen_by_id_or_folder() {
    let place = Place::new();
    place.write("cases/a/case.toml", BAR.replace("\"T1\"", "\"A7\""));
    place.write("cases/b/case.toml", BAR.to_owned() + &impossible("always"));
    place.write("cases/c/case.toml", "version = 7");
    for only in ["A7", "a7", "a"] {
        let (stdout, _) = place.run(&format!("verify --only {only}"), 0);
        assert_contains(&stdout, &["1 check of 1 case"]);
    }
    place.run("verify --only b", 1);
    place.run("verify --only c", 1);
}

#[test]
fn no_check_is_no_success() {
    let place = Place::with_bar();
    place.write("none/readme.md", "");
    for arguments in ["verify none", "verify bar --only T2"] {
        let (_, stderr) = place.run(arguments, 1);
        assert_contains(&stderr, &["there is no check to evaluate"]);
    }
    let (_, stderr) = place.run("verify nowhere", 4);
    assert_contains(&stderr, &["nowhere"]);
    let (_, stderr) = place.run("verify", 4);
    assert_contains(&stderr, &["cases"]);
}

#[test]
fn paths_may_be_files_and_may_repeat() {
    let place = Place::with_bar();
    let (stdout, _) = place.run("verify bar/case.toml bar bar", 0);
    assert_contains(&stdout, &["1 check of 1 case"]);
}

#[test]
fn cases_side_by_side_give_the_same_table_and_page() {
    let place = Place::new();
    let wrong = BAR.replace("version = 1", "version = 2");
    let names = ["a", "b", "c", "d"];
    for (name, text) in names.into_iter().zip([BAR, &wrong, BAR, BAR]) {
        let text = text.replace("\"T1\"", &format!("\"{name}\""));
        place.write(&format!("cases/{name}/case.toml"), text);
    }
    let run = |jobs: usize| {
        let page = format!("page-{jobs}.md");
        let (stdout, _) = place.run(&format!("verify --jobs {jobs} --page {page}"), 1);
        // What follows tells how long it took.
        let table = stdout.split(" (").next().unwrap().to_owned();
        let results = place.read(&page.replace(".md", ".json"));
        (table, results, place.read(&page).replace(&format!("page-{jobs}"), "page"))
    };
    let one = run(1);
    assert_contains(&one.0, &["4 checks of 4 cases: 3 passed, 1 failed"]);
    names.iter().for_each(|name| assert_contains(&one.2, &[&format!("| {name} |")]));
    assert_eq!(run(4), one);
    assert_eq!(run(9), one);
}

#[test]
fn a_case_that_takes_long_runs_only_if_asked() {
    let place = Place::new();
    place.write("bar/case.toml", BAR.replace("version = 1", "version = 1\nlong = true"));
    // The coarse setting never does.
    let (stdout, _) = place.run("verify bar", 0);
    assert_contains(&stdout, &["1 check of 1 case: 1 passed, 0 failed"]);
    let (stdout, _) = place.run("verify bar --full", 0);
    assert_contains(&stdout, &["1 check of 1 case", "1 more check with `--long`"]);
    let (stdout, _) = place.run("verify bar --full --long=base", 0);
    assert_contains(&stdout, &["2 checks of 1 case: 2 passed"]);
    // One that is asked for and cannot begin fails; what an earlier one gave stays on the page.
    place.run("verify bar --full --long=base --keep kept --page page.md", 0);
    let dated = || {
        let page = place.read("page.md");
        page.lines().find(|line| line.starts_with("| case, ")).unwrap().to_owned()
    };
    let known = dated();
    let record = place.read("kept/bar/case/run.json");
    place.write("kept/bar/case/run.json", &record[..record.len() / 2]);
    let again = "verify bar --full --long=base --keep kept --page page.md";
    let (stdout, _) = place.run(again, 1);
    let told = ["1 passed, 1 failed", "kept/bar/case", "remove that folder to begin anew"];
    assert_contains(&stdout, &told);
    assert!(!stdout.contains("--long"), "{stdout}");
    assert_eq!(dated(), known);
    // One that is compared with one that was not asked for fails, too.
    let other = "\n[[variant]]\nname = \"other\"\nlong = true\nset = [\"time.max_steps=3\"]\n\n[[check]]\n\
                 quantity = \"tip.displacement.x\"\nequal_to = \"other\"\ntolerance = 0\n\
                 source = \"itself\"\nwhen = \"case\"\n";
    let both = BAR.replace("version = 1", "version = 1\nlong = true") + other;
    place.write("bar/case.toml", both);
    let (stdout, _) = place.run("verify bar --full --long=base --keep kept", 1);
    assert_contains(&stdout, &["1 passed, 2 failed"]);
}

#[test]
fn runs_that_are_kept_are_continued() {
    let place = Place::new();
    place.write(
        "bar/case.toml",
        BAR.replace("version = 1", "version = 1\ncheckpoint = { every_steps = 1 }"),
    );
    let verdict = |keep: &str| {
        let (stdout, _) = place.run(&format!("verify bar --full {keep}"), 0);
        stdout.split(" (").next().unwrap().to_owned()
    };
    let plain = verdict("");
    // The first part of a run, as an interruption leaves it.
    place.run("run bar/case.toml --set time.max_steps=3 --out kept/bar/case", 3);
    assert_eq!(verdict("--keep kept"), plain);
    let resumed = |folder: &str| {
        let record = place.read(&format!("kept/bar/{folder}/run.json"));
        !record.contains("\"resumed_at\": []")
    };
    assert!(resumed("case"), "it did not begin where the other had ended");
    assert!(!resumed("coarse"), "nothing was there to continue");
    // What has ended is not run again, and tells the same.
    assert_eq!(verdict("--keep kept"), plain);
    assert!(resumed("coarse"));
    place.write("bar/case.toml", BAR.replace("spacing = 0.2", "spacing = 0.1"));
    let (stdout, _) = place.run("verify bar --full --keep kept", 1);
    assert_contains(&stdout, &["kept/bar/case", "remove that folder to begin anew"]);
}
