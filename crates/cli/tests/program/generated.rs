use std::fs;
use std::io::Read;
use std::process::{Command, Stdio};

use crate::support::{Place, assert_contains};

#[test]
fn the_schema_is_json_and_knows_the_keys() {
    let (stdout, _) = Place::new().run("schema", 0);
    let schema: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(schema["type"], "object");
    for key in ["version", "body", "scheme", "time", "check"] {
        assert!(schema["properties"][key].is_object(), "{key}");
    }
}

#[test]
fn the_reference_is_markdown_with_the_keys() {
    let (stdout, _) = Place::new().run("reference", 0);
    assert!(stdout.starts_with("# "));
    assert_contains(&stdout, &["| `version` |", "smoothing_length", "tau_velocity"]);
}

#[test]
fn completions_know_the_commands() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let (stdout, _) = Place::new().run(&format!("completions {shell}"), 0);
        assert_contains(&stdout, &["verify", "reference", "variant"]);
    }
    Place::new().run("completions dosh", 2);
}

#[test]
fn help_lists_the_exit_codes() {
    let all = "run check sweep verify report new devices mcp man";
    let commands = all.split(' ').map(|command| format!("{command} --help"));
    for arguments in commands.chain(["--help".to_owned(), "devices show --help".to_owned()]) {
        let (stdout, _) = Place::new().run(&arguments, 0);
        assert_contains(&stdout, &["Exit codes:", "  3  the run failed", "130  interrupted"]);
    }
    let (stdout, _) = Place::new().run("--version", 0);
    let version = stdout.strip_prefix(&format!("piola {} (commit ", env!("CARGO_PKG_VERSION")));
    let (commit, features) = version.unwrap().split_once("; devices: processor").unwrap();
    let ranks = match cfg!(feature = "mpi") {
        true => "; ranks: threads, and processes of MPI)\n",
        false => "; ranks: threads, without MPI)\n",
    };
    assert!(features.ends_with(ranks), "{stdout}");
    let is_hash = commit.len() >= 10 && commit.chars().all(|c| c.is_ascii_hexdigit());
    assert!(is_hash || commit == "unknown", "{stdout}");
}

#[test]
fn manual_pages_tell_of_every_command() {
    let place = Place::new();
    place.run("man pages/man1", 0);
    for (page, parts) in [
        ("piola", ["piola\\-verify(1)", ".SH SUBCOMMANDS"]),
        ("piola-run", ["\\-\\-resume", "newest sound checkpoint"]),
        ("piola-mcp", ["Model Context Protocol", "[default: .]"]),
        ("piola-devices-show", ["\\-\\-language", "no device is needed"]),
        ("piola-devices-bounds", ["\\-\\-precision", "lower bounds"]),
    ] {
        let text = place.read(&format!("pages/man1/{page}.1"));
        assert!(text.starts_with(".ie") || text.contains(".TH"), "{text}");
        assert_contains(&text, &parts);
    }
    let pages: Vec<_> = fs::read_dir(place.path("pages/man1")).unwrap().collect();
    // One for each command, those below `devices` and the program itself.
    assert_eq!(pages.len(), 15);
    for page in pages {
        let text = fs::read_to_string(page.unwrap().path()).unwrap();
        let version = env!("CARGO_PKG_VERSION");
        assert!(
            text.lines().any(|line| line.starts_with(".TH") && line.contains(version)),
            "{text}"
        );
        let (before, status) = text.split_once(".SH \"EXIT STATUS\"\n").unwrap();
        assert!(!before.contains("Exit codes") && !text.contains(".SH EXTRA"), "{text}");
        let listed = ".TP\n\\fB3\\fR\nthe run failed; its last good state is on disk\n";
        let version = format!(".SH VERSION\nv{version}\n");
        assert_contains(status, &[listed, "\\fB130\\fR", &version]);
    }
    place.write("file", "");
    place.run("man file", 4);
}

#[test]
fn a_closed_pipe_ends_quietly() {
    for command in ["schema", "reference", "completions"] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_piola"));
        program.arg(command).stdout(Stdio::piped()).stderr(Stdio::piped());
        if command == "completions" {
            program.arg("bash");
        }
        let mut child = program.spawn().unwrap();
        let mut first = [0];
        child.stdout.take().unwrap().read_exact(&mut first).unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stderr), "");
        assert!(output.status.success(), "{command}: {:?}", output.status);
    }
}
