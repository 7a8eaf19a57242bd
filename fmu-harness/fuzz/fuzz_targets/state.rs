#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fmu_harness_fuzz::state(data));
