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
    for arguments in ["--help", "run --help", "check --help", "verify --help"] {
        let (stdout, _) = Place::new().run(arguments, 0);
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
        ("piola", ["piola\\-verify(1)", "Exit codes"]),
        ("piola-run", ["\\-\\-resume", "newest sound checkpoint"]),
        ("piola-mcp", ["Model Context Protocol", "[default: .]"]),
        ("piola-devices-show", ["\\-\\-language", "no device is needed"]),
    ] {
        let text = place.read(&format!("pages/man1/{page}.1"));
        assert!(text.starts_with(".ie") || text.contains(".TH"), "{text}");
        assert_contains(&text, &parts);
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
