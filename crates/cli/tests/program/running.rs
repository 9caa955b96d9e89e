//! Programs that run while their test goes on, on systems that have signals.
#![cfg(unix)]

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::support::Place;

/// Nothing here takes longer, unless it hangs.
const PATIENCE: Duration = Duration::from_secs(60);

/// A running program, which does not outlive its test.
pub struct Program(pub Child);

impl Drop for Program {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Program {
    /// Starts piola.
    pub fn piola(place: &Place, arguments: &str) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_piola"));
        Self::start(command.args(arguments.split_whitespace()).current_dir(place.path("")))
    }

    /// Starts a program.
    pub fn start(command: &mut Command) -> Self {
        // Both outputs are far below what a pipe holds, so that nobody has to read meanwhile.
        Self(command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap())
    }

    /// Waits until something is so while the program runs.
    #[track_caller]
    pub fn wait_until(&mut self, what: &str, is_so: impl Fn() -> bool) {
        let start = Instant::now();
        while !is_so() {
            assert!(start.elapsed() < PATIENCE, "not after a minute: {what}");
            assert_eq!(self.0.try_wait().unwrap(), None, "the program has ended before: {what}");
            sleep(Duration::from_millis(5));
        }
    }

    /// Waits until the file at `path` satisfies `ready`.
    #[track_caller]
    pub fn wait_for(&mut self, path: &Path, ready: impl Fn(&str) -> bool) {
        let what = format!("{} is as expected", path.display());
        self.wait_until(&what, || fs::read_to_string(path).is_ok_and(|text| ready(&text)));
    }

    /// Sends `signal` and waits for the end; the exit code, stdout and stderr.
    #[track_caller]
    pub fn stop(self, signal: &str) -> (Option<i32>, String, String) {
        send(signal, self.0.id());
        self.end()
    }

    /// Waits for the end; the exit code, stdout and stderr.
    #[track_caller]
    pub fn end(mut self) -> (Option<i32>, String, String) {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.0.try_wait().unwrap() {
                break status;
            }
            assert!(start.elapsed() < PATIENCE, "the program goes on for a minute");
            sleep(Duration::from_millis(5));
        };
        let (mut stdout, mut stderr) = (String::new(), String::new());
        self.0.stdout.take().unwrap().read_to_string(&mut stdout).unwrap();
        self.0.stderr.take().unwrap().read_to_string(&mut stderr).unwrap();
        (status.code(), stdout, stderr)
    }
}

/// Sends a signal to a process.
#[track_caller]
pub fn send(signal: &str, process: u32) {
    // It goes out through the shell, whose `kill` every system has.
    let kill = format!("kill -{signal} {process}");
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
}
