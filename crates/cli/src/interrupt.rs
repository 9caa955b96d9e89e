//! Ctrl-C: the first finishes the step and writes the state, the second ends at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::Exit;
use crate::terminal;

/// Listens for Ctrl-C and for requests to terminate. The flag is set by the first one.
pub fn listen() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let handler = move || {
        if flag.swap(true, Ordering::SeqCst) {
            std::process::exit(i32::from(Exit::Interrupted.code()));
        }
        terminal::report("\nstopping after this step; press Ctrl-C again to stop at once\n");
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        terminal::report(&format!("warning: Ctrl-C will not write the state: {error}\n"));
    }
    stop
}

/// Leaves it to another process to end the run: a first request to terminate is its, a second one ends at once.
pub fn ignore() {
    let told = AtomicBool::new(false);
    let handler = move || {
        if told.swap(true, Ordering::SeqCst) {
            std::process::exit(i32::from(Exit::Interrupted.code()));
        }
    };
    // Without it the process ends at the first, and with it the run.
    let _ = ctrlc::set_handler(handler);
}
