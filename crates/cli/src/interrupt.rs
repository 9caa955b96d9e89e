//! Ctrl-C: the first finishes the step and writes the state, the second ends at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::Exit;
use crate::terminal;

/// Listens for Ctrl-C and for requests to terminate. The flag is set by the first one.
pub fn listen() -> Arc<AtomicBool> {
    listen_and(|| {
        terminal::report("\nstopping after this step; press Ctrl-C again to stop at once\n");
    })
}

/// The same, of a process beside others that tell of it.
pub fn listen_quietly() -> Arc<AtomicBool> {
    listen_and(|| {})
}

fn listen_and(tell: impl Fn() + Send + 'static) -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let handler = move || {
        if flag.load(Ordering::SeqCst) {
            std::process::exit(i32::from(Exit::Interrupted.code()));
        }
        // Whoever sees the flag may end the program, so that it is told first. One thread handles all signals.
        tell();
        flag.store(true, Ordering::SeqCst);
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        terminal::report(&format!("warning: Ctrl-C will not write the state: {error}\n"));
    }
    stop
}
