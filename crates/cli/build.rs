//! Tells the program its commit, where it is built from a clone.

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
    let commit = packed.or(own);
    println!("cargo::rustc-env=PIOLA_COMMIT={}", commit.as_deref().unwrap_or("unknown"));
    println!("cargo::rerun-if-changed=build.rs");
    // What `HEAD` says changes with each commit and each branch.
    let log =
        git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|path| Path::new(path).exists());
    if let Some(log) = log {
        println!("cargo::rerun-if-changed={log}");
    }
}
