use crate::support::{BAR, Place, assert_contains};

/// The commands that read a case, which all refuse alike.
const COMMANDS: [&str; 2] = ["run", "check"];

/// Both commands end with `code`, write nothing, and say all `parts`.
#[track_caller]
fn refused(place: &Place, arguments: &str, code: i32, parts: &[&str]) {
    for command in COMMANDS {
        let (stdout, stderr) = place.run(&format!("{command} {arguments}"), code);
        assert_eq!(stdout, "");
        assert_contains(&stderr, parts);
        assert!(!stderr.contains('\u{1b}'), "colours in a pipe:\n{stderr}");
    }
    assert!(!place.path("results").exists());
}

#[test]
fn all_problems_come_at_once_with_their_places() {
    let place = Place::new();
    let text = BAR.replace("spacing = 0.2", "spacin = 0.2").replace("end = 0.02", "end = [1]");
    place.write("bad.toml", &text);
    let line = |start: &str| text.lines().position(|line| line.starts_with(start)).unwrap() + 1;
    refused(
        &place,
        "bad.toml --set scheme.tau_velocity=-1",
        2,
        &[
            &format!("bad.toml:{}:1", line("spacin")),
            "^^^^^^",
            "did you mean `spacing`?",
            &format!("bad.toml:{}:7", line("end")),
            "--set scheme.tau_velocity=-1",
            "3 problems in bad.toml",
        ],
    );
}

#[test]
fn overrides_are_checked_like_the_file() {
    let place = Place::with_bar();
    refused(&place, "bar/case.toml --set time.ende=1", 2, &["ende", "did you mean `end`?"]);
    refused(&place, "bar/case.toml --set time.end", 2, &["time.end", "="]);
    refused(&place, "bar/case.toml --set body.beam.spacing=1", 2, &["beam"]);
    refused(&place, "bar/case.toml --set =", 2, &["--set ="]);
    refused(&place, "bar/case.toml --variant fats", 2, &["fats", "did you mean `fast`?"]);
}

#[test]
fn problems_of_building_point_into_the_file() {
    let place = Place::new();
    place.write("bad.toml", BAR.replace("point = [0.0]", "point = [7.0]"));
    refused(&place, "bad.toml", 2, &["bad.toml:", "^^^", "selects no particle"]);
}

#[test]
fn files_that_cannot_be_read_are_faults_of_files() {
    let place = Place::with_bar();
    refused(&place, "nowhere/case.toml", 4, &["nowhere/case.toml", "No such file"]);
    refused(&place, "bar", 4, &["bar", "folder"]);
}

#[test]
fn files_that_are_no_case_are_bad_cases() {
    let place = Place::new();
    place.write("empty.toml", "");
    refused(&place, "empty.toml", 2, &["`version`", "`dimension`", "empty.toml"]);
    // Bytes without pattern, the same in every run, some of them control characters.
    let mut state = 1_u32;
    let bytes: Vec<u8> = (0..5000)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        })
        .collect();
    place.write("random.toml", &bytes);
    refused(&place, "random.toml", 2, &["random.toml", "UTF-8"]);
    let ascii: Vec<u8> = bytes.iter().map(|byte| byte & 0x7f).collect();
    place.write("ascii.toml", ascii);
    refused(&place, "ascii.toml", 2, &["ascii.toml"]);
    place.write("long.toml", format!("title = [{}", "1.0, ".repeat(200_000)));
    refused(&place, "long.toml", 2, &["long.toml:1:"]);
    // 100 MB that take no room on the disk.
    let large = std::fs::File::create(place.path("large.toml")).unwrap();
    large.set_len(100 << 20).unwrap();
    refused(&place, "large.toml", 2, &["large.toml", "too large"]);
}

#[test]
fn numbers_that_are_none_are_refused() {
    let place = Place::with_bar();
    for value in ["nan", "inf", "-inf", "1e999", "\"0/0\"", "\"1e308*10\""] {
        refused(&place, &format!("bar/case.toml --set time.end={value}"), 2, &["time.end="]);
        let speed = format!("bar/case.toml --set parameters.speed={value}");
        refused(&place, &speed, 2, &["parameters.speed="]);
    }
}

#[test]
fn a_bad_command_line_has_the_code_of_a_bad_case() {
    let place = Place::new();
    for arguments in ["", "run", "fly case.toml", "run a b", "verify --fulll"] {
        let (_, stderr) = place.run(arguments, 2);
        assert_contains(&stderr, &["Usage: piola"]);
    }
}
