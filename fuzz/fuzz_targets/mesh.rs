#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    piola_fuzz::mesh(data);
});
