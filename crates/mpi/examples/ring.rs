//! Makes every call on ranks that are threads, 4 or as many as asked for, or on those that `mpirun` has started:
//!
//! ```text
//! cargo run --release -p piola-mpi --features mpi --example ring -- 7
//! mpirun -n 4 target/release/examples/ring
//! ```
//!
//! Under `mpirun`, the last rank fails if it is asked to `abort`, to `panic`, to expect a message of a wrong `length`, or
//! to call from another `thread`.

#[path = "../../ranks/tests/calls/mod.rs"]
mod calls;

use std::error::Error;
use std::thread;

use calls::{every_call, on_threads};
use piola_mpi::Mpi;
use piola_ranks::{Message, RankError, Ranks};

fn main() -> Result<(), Box<dyn Error>> {
    let argument = std::env::args().nth(1);
    if let Some(ranks) = Mpi::start()? {
        // Dropped after a call has failed, the rank ends all.
        return run(&ranks, argument.as_deref()).inspect_err(|error| eprintln!("{error}"));
    }
    let size = argument.map_or(Ok(4), |size| size.parse())?;
    for result in on_threads(size, |rank| every_call(&rank)) {
        result.ok_or("a rank has panicked")??;
    }
    println!("{size} threads agree on every call");
    Ok(())
}

fn run(ranks: &Mpi, failure: Option<&str>) -> Result<(), Box<dyn Error>> {
    every_call(ranks)?;
    let last = ranks.size() - 1;
    match failure.filter(|_| ranks.rank() == last) {
        None => {}
        Some("abort") => ranks.abort(3),
        Some("panic") => panic!("on purpose"),
        Some("length") => {
            let numbers = vec![0.0; 2];
            let refused = ranks.exchange(&[], &mut [Message { rank: 0, numbers }]);
            assert_eq!(ranks.add(&mut [1]), Err(RankError::Lost(last)));
            refused?;
        }
        Some("thread") => thread::scope(|scope| {
            let refused = scope.spawn(|| ranks.add(&mut [1])).join();
            refused.map_err(|_| "the thread has panicked")?.map_err(Box::<dyn Error>::from)
        })?,
        Some(failure) => panic!("abort, panic, length or thread, not {failure}"),
    }
    if failure.is_some() {
        // For the one who expects another length; then wait for the one who fails.
        if ranks.rank() == 0 {
            let numbers = vec![1.0; 3];
            ranks.exchange(&[Message { rank: last, numbers }], &mut [])?;
        }
        ranks.add(&mut [1])?;
    }
    if ranks.rank() == 0 {
        println!("{} processes agree on every call", ranks.size());
    }
    Ok(())
}
