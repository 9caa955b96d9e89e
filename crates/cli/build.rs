//! Tells the program its commit: that of the variable `PIOLA_COMMIT`, of a packed crate, or of the clone that it is
//! built from.

use std::path::Path;
use std::process::Command;

fn main() {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        (output.status.success() && !text.trim().is_empty()).then(|| text.trim().to_owned())
    };
    let packed = std::fs::read_to_string(".cargo_vcs_info.json").unwrap_or_default();
    let packed =
        packed.split("\"sha1\": \"").nth(1).and_then(|rest| rest.get(..10)).map(str::to_owned);
    // A packed crate in a folder of another repository is not of its commit.
    let is_own = git(&["ls-files", "--error-unmatch", "build.rs"]).is_some();
    let own = if is_own { git(&["rev-parse", "--short=10", "HEAD"]) } else { None };
    // For builds from a copy without its history, as in a container.
    let given = std::env::var("PIOLA_COMMIT").ok().map(|text| text.trim().to_owned());
    let commit = given.filter(|text| !text.is_empty()).or(packed).or(own);
    println!("cargo::rustc-env=PIOLA_COMMIT={}", commit.as_deref().unwrap_or("unknown"));
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=PIOLA_COMMIT");
    // What `HEAD` says changes with each commit and each branch.
    let log =
        git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|path| Path::new(path).exists());
    if let Some(log) = log {
        println!("cargo::rerun-if-changed={log}");
    }
}
