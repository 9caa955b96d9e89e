use std::fs;

use crate::support::{BAR, Place, assert_contains};

/// The tiny case with a reference curve for its tip: at rest, which it is not.
fn with_reference() -> String {
    format!(
        "{BAR}\n[[check]]\nquantity = \"tip.displacement.x\"\nreduce = \"curve\"\n\
         reference = \"data/tip.csv\"\nat_most = 0.1\nsource = \"a table by hand\"\n\
         [[check]]\nvariant = \"fast\"\nquantity = \"tip.displacement.x\"\nreduce = \"final\"\n\
         more_than = \"base\"\nsource = \"it is faster\"\n"
    )
}

fn bytes(place: &Place, name: &str) -> Vec<u8> {
    fs::read(place.path(name)).unwrap()
}

#[test]
fn a_report_is_made_again_from_the_folder_alone() {
    let place = Place::new();
    place.write("bar/case.toml", with_reference());
    place.write("bar/data/tip.csv", "# by hand\ntime,x\n0,0\n0.01,0\n0.02,0\n");
    let (stdout, _) = place.run("run bar/case.toml", 0);
    assert_contains(&stdout, &["open results/bar/report.html in a browser"]);
    let first = bytes(&place, "results/bar/report.html");
    let text = String::from_utf8(first.clone()).unwrap();
    assert_contains(
        &text,
        &[
            "<h1>A tiny bar</h1>",
            "2 of 2 checks passed",
            "tip.displacement.x curve",
            "reference of tip.displacement.x: a table by hand",
            "1 more checks need another run",
            "variant fast",
            "all 6 particles at all 2 instants",
            "energy.total",
        ],
    );
    // Elsewhere, without the case, and without the report.
    fs::rename(place.path("results/bar"), place.path("moved")).unwrap();
    fs::remove_dir_all(place.path("bar")).unwrap();
    fs::remove_file(place.path("moved/report.html")).unwrap();
    let (stdout, stderr) = place.run("report moved", 0);
    assert_eq!((stdout.as_str(), stderr.as_str()), ("moved/report.html\n", ""));
    assert_eq!(bytes(&place, "moved/report.html"), first);
}

#[test]
fn what_ranks_have_done_is_in_the_record_and_the_report() {
    let place = Place::with_bar();
    let set = "--set body.bar.spacing=0.005 --set time.end=2e-3 --set output.every=1e-3";
    let (stdout, _) = place.run(&format!("run bar/case.toml {set} --ranks 3"), 0);
    assert_contains(&stdout, &["ranks       3, the slowest computed"]);
    let record: serde_json::Value =
        serde_json::from_str(&place.read("results/bar/run.json")).unwrap();
    let ranks = record["ranks"].as_array().unwrap();
    let sum = |key: &str| ranks.iter().map(|rank| rank[key].as_f64().unwrap()).sum::<f64>();
    assert_eq!((ranks.len(), sum("particles")), (3, 201.0), "{ranks:?}");
    for rank in ranks {
        assert!(
            ["computed", "waited", "messages", "bytes"]
                .iter()
                .all(|key| rank[key].as_f64() > Some(0.0))
        );
    }
    let page = place.read("results/bar/report.html");
    assert_contains(
        &page,
        &["<dt>Ranks</dt><dd>3</dd>", "Waiting and sending", "3 ranks, in the steps since"],
    );
    let rows = page.split("id=\"ranks\"").nth(1).unwrap().split("</table>").next().unwrap();
    assert_eq!(rows.matches("<tr>").count(), 1 + 3, "{rows}");
    for rank in ranks {
        assert_contains(rows, &[&format!("<td>{}</td>", rank["messages"])]);
    }
    // As it is made again, and not in a report of one rank.
    place.run("report results/bar", 0);
    assert_eq!(place.read("results/bar/report.html"), page);
    place.run(&format!("run bar/case.toml {set} -q"), 0);
    assert!(!place.read("results/bar/report.html").contains("id=\"ranks\""));
    assert!(place.read("results/bar/run.json").contains("\"ranks\": []"));
}

#[test]
fn a_variant_evaluates_its_own_checks() {
    let place = Place::new();
    place.write("bar/case.toml", with_reference());
    place.write("bar/data/tip.csv", "0,0\n0.02,0\n");
    place.run("run bar/case.toml --variant fast -q --set time.cfl=0.1", 0);
    let text = place.read("results/bar-fast/report.html");
    // The one check of the variant compares with the case itself.
    assert_contains(&text, &["variant fast", "time.cfl=0.1", "The case has no checks of this run"]);
    assert_contains(&text, &["3 more checks need another run", "more than base"]);
    assert!(!text.contains("reference of tip.displacement.x"));
}

#[test]
fn a_report_can_be_left_out() {
    let place = Place::with_bar();
    place.run("run bar/case.toml -q --set output.report=false", 0);
    assert!(!place.path("results/bar/report.html").exists());
    place.run("report results/bar", 0);
    assert!(place.path("results/bar/report.html").exists());
    // A run without one removes that of the run before.
    place.run("run bar/case.toml -q --set output.report=false", 0);
    assert!(!place.path("results/bar/report.html").exists());
}

#[test]
fn a_failed_run_has_a_report_with_the_failure_first() {
    let place = Place::with_bar();
    place.run("run bar/case.toml --set time.max_steps=3", 3);
    let text = place.read("results/bar/report.html");
    let (failure, particles) = (text.find("The run failed"), text.find("id=\"particles\""));
    assert!(failure.unwrap() < particles.unwrap());
    assert_contains(&text, &["failed: too_many_steps", "raise `time.max_steps`"]);
}

#[test]
fn a_fault_of_the_report_leaves_a_good_run_good() {
    let place = Place::with_bar();
    place.run("run bar/case.toml -q", 0);
    fs::remove_file(place.path("results/bar/report.html")).unwrap();
    fs::create_dir(place.path("results/bar/report.html")).unwrap();
    let (stdout, _) = place.run("run bar/case.toml", 0);
    assert_contains(&stdout, &["completed", "warning", "there is no report", "report.html"]);
    assert!(place.read("results/bar/run.json").contains("\"completed\""));
}

#[test]
fn a_folder_without_a_run_is_refused() {
    let place = Place::with_bar();
    let (_, stderr) = place.run("report nowhere", 4);
    assert_contains(&stderr, &["nowhere", "run.json"]);
    let (_, stderr) = place.run("report bar", 4);
    assert_contains(&stderr, &["run.json"]);
    place.write("other/run.json", "{\"program\": \"other\"}");
    let (_, stderr) = place.run("report other", 2);
    assert_contains(&stderr, &["not a record of a run of piola"]);
}

#[test]
fn whatever_is_damaged_is_left_out_and_said() {
    let place = Place::with_bar();
    place.run("run bar/case.toml -q", 0);
    let names = [
        ("particles/frame_000000.vtp", "frame_000000.vtp is damaged"),
        ("probes.csv", "probes.csv is damaged"),
        ("energy.csv", "energy.csv is damaged"),
    ];
    for (name, sentence) in names {
        let name = format!("results/bar/{name}");
        let whole = bytes(&place, &name);
        // Garbage from the middle on.
        let broken = [&whole[..whole.len() / 2], &b"\xff\x00,;<script>"[..]].concat();
        fs::write(place.path(&name), broken).unwrap();
        place.run("report results/bar", 0);
        assert_contains(&place.read("results/bar/report.html"), &[sentence]);
        fs::remove_file(place.path(&name)).unwrap();
        place.run("report results/bar", 0);
        fs::write(place.path(&name), whole).unwrap();
    }
    // A record that is whole JSON and says what cannot be.
    let record = place.read("results/bar/run.json");
    let mut wrong: serde_json::Value = serde_json::from_str(&record).unwrap();
    wrong["dimension"] = 77.into();
    wrong["case_text"] = "version = 1\n[[[".into();
    wrong["files"] = serde_json::json!(["../../secret", "/etc/passwd", "particles/none.vtp"]);
    wrong["bodies"] = serde_json::json!([
        { "name": "a", "particles": u64::MAX, "spacing": [-1.0, 0.0, null] },
        { "name": "b", "particles": u64::MAX }
    ]);
    wrong["bodies"][0]["spacing"] = serde_json::json!([-1.0, 0.0]);
    wrong["stages"] = serde_json::json!([{ "name": "s", "seconds": null, "calls": 0 }]);
    wrong["time_reached"] = serde_json::Value::Null;
    place.write("results/bar/run.json", wrong.to_string());
    place.run("report results/bar", 0);
    let text = place.read("results/bar/report.html");
    assert_contains(&text, &["The case in the record cannot be read", "(1 missing)"]);
    assert!(!text.contains("secret") && !text.contains("passwd"));
}
