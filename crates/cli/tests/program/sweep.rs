use std::fs;

use crate::support::{BAR, Place, assert_contains};

/// A case that is swept fails by hand: the second value allows three steps only.
const FAILING: &str = "sweep bar/case.toml --over time.max_steps=1000,3 -q";

/// The cells of the comparison table, with its header.
fn table(place: &Place, folder: &str) -> Vec<Vec<String>> {
    let text = place.read(&format!("{folder}/sweep.csv"));
    let mut lines = text.lines();
    let header = lines.next().unwrap().split(',').map(str::to_owned).collect::<Vec<_>>();
    // Values in quotes have no commas here.
    std::iter::once(header)
        .chain(lines.map(|line| line.split(',').map(str::to_owned).collect()))
        .collect()
}

/// The cell of a column in a row, from 1.
fn cell<'a>(table: &'a [Vec<String>], row: usize, column: &str) -> &'a str {
    let index = table[0].iter().position(|name| name == column);
    &table[row][index.unwrap_or_else(|| panic!("no {column} in {:?}", table[0]))]
}

#[test]
fn members_run_into_folders_and_are_compared() {
    let place = Place::with_bar();
    let (stdout, stderr) = place.run("sweep bar/case.toml --over body.bar.spacing=0.2,0.1,0.05", 0);
    assert_contains(
        &stdout,
        &["body.bar.spacing", "wall time", "tip.displacement.x at end", "0.05", "completed"],
    );
    assert_contains(&stdout, &["in results/bar-sweep: sweep.csv, plots (3 charts)"]);
    assert_contains(&stderr, &["3 of 3: body.bar.spacing=0.05: completed"]);
    let table = table(&place, "results/bar-sweep");
    assert_eq!(table.len(), 4);
    assert_eq!(table[0][0], "body.bar.spacing");
    for (row, spacing, particles) in [(1, "0.2", 6), (2, "0.1", 11), (3, "0.05", 21)] {
        assert_eq!(cell(&table, row, "body.bar.spacing"), spacing);
        assert_eq!(cell(&table, row, "outcome"), "completed");
        // What the table says is what the member's own files say.
        let folder = format!("results/bar-sweep/body.bar.spacing={spacing}");
        assert_eq!(cell(&table, row, "folder"), format!("body.bar.spacing={spacing}"));
        let probes = place.read(&format!("{folder}/probes.csv"));
        let values: Vec<f64> = probes
            .lines()
            .skip(1)
            .map(|line| line.split(',').nth(1).unwrap().parse().unwrap())
            .collect();
        let number = |column: &str| -> f64 { cell(&table, row, column).parse().unwrap() };
        assert_eq!(number("tip.displacement.x final [m]"), *values.last().unwrap());
        let largest = values.iter().copied().fold(f64::MIN, f64::max);
        assert_eq!(number("tip.displacement.x largest [m]"), largest);
        let record: serde_json::Value =
            serde_json::from_str(&place.read(&format!("{folder}/run.json"))).unwrap();
        assert_eq!(number("steps [1]"), record["steps"].as_f64().unwrap());
        assert_eq!(record["bodies"][0]["particles"], particles);
    }
    for chart in ["tip.displacement.x", "energy.total", "final-values"] {
        let path = place.path(format!("results/bar-sweep/plots/{chart}.png"));
        assert!(fs::read(&path).unwrap().starts_with(b"\x89PNG"), "{}", path.display());
    }
}

#[test]
fn two_keys_give_all_pairs_and_jobs_change_nothing() {
    let place = Place::with_bar();
    let over = "sweep bar/case.toml --variant fast --over time.cfl=0.2,0.1 \
                --over scheme.kernel=cubic_spline,quintic_spline --set time.end=0.01 -q";
    assert_eq!(place.run(&format!("{over} --jobs 1 --out one"), 0), Default::default());
    place.run(&format!("{over} --jobs 3 --threads 2 --out three"), 0);
    let [one, three] = ["one", "three"].map(|folder| table(&place, folder));
    assert_eq!(one.len(), 5);
    let pair = ["time.cfl=0.1", "scheme.kernel=quintic_spline"];
    assert_eq!(one[4][..2], ["0.1", "quintic_spline"]);
    let speed = place.read(&format!("one/{}/run.json", pair.join("+")));
    assert!(speed.contains("fast"), "{speed}");
    for (one, three) in one.iter().zip(&three) {
        for (index, (one, three)) in one.iter().zip(three).enumerate() {
            // All but the wall time.
            assert!(index == 5 || one == three, "{one} {three}");
        }
    }
}

/// The flags that say who computes hold for members, too.
#[test]
fn members_are_computed_where_the_flags_say() {
    let place = Place::with_bar();
    let sweep =
        "sweep bar/case.toml --over time.max_steps=3,4 --device nowhere:7 --precision single";
    let (_, stderr) = place.run(sweep, 2);
    assert_contains(&stderr, &["time.max_steps=3: there is no device `nowhere:7`"]);
}

#[test]
fn a_sweep_of_the_case_file_runs_its_members() {
    let place = Place::new();
    let sweep = "\n[[sweep]]\nname = \"mesh\"\nover = { body.bar.spacing = [0.2, \"1 / 8\"] }\n\
                 variant = \"fast\"\n";
    place.write("bar/case.toml", BAR.to_owned() + sweep);
    place.run("sweep bar/case.toml --sweep mesh -q", 0);
    let table = table(&place, "results/bar-mesh-sweep");
    assert_eq!(cell(&table, 2, "folder"), "body.bar.spacing=1_8");
    // A member can be run by its name, and does the same.
    place.run("run bar/case.toml --variant mesh.2 -q", 0);
    let one = place.read("results/bar-mesh.2/probes.csv");
    assert_eq!(one, place.read("results/bar-mesh-sweep/body.bar.spacing=1_8/probes.csv"));
    let (_, stderr) = place.run("sweep bar/case.toml --sweep mash", 2);
    assert_contains(&stderr, &["no sweep `mash`", "did you mean `mesh`?"]);
    place.run("sweep bar/case.toml", 2);
    place.run("sweep bar/case.toml --sweep mesh --over time.cfl=0.1", 2);
}

#[test]
fn a_failed_member_does_not_stop_the_rest() {
    let place = Place::with_bar();
    let (stdout, stderr) = place.run(&FAILING.replace("1000,3", "3,1000"), 3);
    assert_eq!(stdout, "");
    assert_contains(
        &stderr,
        &["time.max_steps=3: the run failed: it took the maximum number of steps"],
    );
    let table = table(&place, "results/bar-sweep");
    assert_eq!(cell(&table, 1, "outcome"), "failed: too_many_steps");
    assert_eq!(cell(&table, 2, "outcome"), "completed");
    // What cannot be built is told apart from what fails.
    let (_, stderr) =
        place.run("sweep bar/case.toml --over boundary.clamp.where.point=[7.0],[0.0] --out x", 2);
    assert_contains(&stderr, &["error: boundary.clamp.where.point=_7.0_: ", "selects no particle"]);
    assert_eq!(cell(&self::table(&place, "x"), 1, "outcome"), "refused");
}

#[test]
fn wrong_values_are_refused_before_anything_runs() {
    let place = Place::with_bar();
    for (over, parts) in [
        ("body.bar.spacin=0.1,0.2", ["spacin", "did you mean `spacing`?"]),
        ("body.bar.spacing=0.1,-1", ["--set body.bar.spacing=-1", "must be above 0"]),
        ("body.bar.spacing=0.1,,0.2", ["--over", "a value is empty"]),
        ("body.bar.spacing", ["--over", "path.to.key=value1,value2"]),
    ] {
        let (_, stderr) = place.run(&format!("sweep bar/case.toml --over {over}"), 2);
        assert_contains(&stderr, &parts);
    }
    let three = "--over time.cfl=0.1 --over time.end=1 --over body.bar.spacing=0.1";
    let (_, stderr) = place.run(&format!("sweep bar/case.toml {three}"), 2);
    assert_contains(&stderr, &["one or two keys"]);
    let twice = "--over time.cfl=0.1 --over time.cfl=0.2";
    let (_, stderr) = place.run(&format!("sweep bar/case.toml {twice}"), 2);
    assert_contains(&stderr, &["twice"]);
    assert!(!place.path("results").exists());
}

#[test]
fn only_folders_of_sweeps_are_used_again() {
    let place = Place::with_bar();
    let sweep = "sweep bar/case.toml --over time.cfl=0.2,0.1 -q --out out";
    place.run(sweep, 0);
    place.run(sweep, 0);
    place.write("mine/letter.txt", "keep me");
    let (_, stderr) = place.run(&sweep.replace("--out out", "--out mine"), 4);
    assert_contains(&stderr, &["mine", "letter.txt", "--out"]);
    assert_eq!(place.read("mine/letter.txt"), "keep me");
    assert!(!place.path("mine/sweep.csv").exists());
    place.write("file", "");
    place.run(&sweep.replace("--out out", "--out file"), 4);
}
