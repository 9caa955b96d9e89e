#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    piola_fuzz::point_cloud(data);
});
