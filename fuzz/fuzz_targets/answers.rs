#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| jointscope_fuzz::targets::answers(bytes));
libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, limit: usize, seed: u32| {
    jointscope_fuzz::json::mutated(data, size, limit, seed)
});
