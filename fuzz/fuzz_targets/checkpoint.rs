#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(
    init: {
        // What a checkpoint holds changes with the program: its seed is made anew each time.
        std::fs::write("found/checkpoint/seed", piola_fuzz::checkpoint_seed())
            .expect("fuzz/run has made the folder");
    },
    |data: &[u8]| {
        piola_fuzz::checkpoint(data);
    }
);
