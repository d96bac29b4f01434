#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| jointscope_fuzz::targets::recordings(bytes));
