//! So many look-alike cases of a seed, planned: `planning N SEED THREADS`.
fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|word| word.parse::<usize>().ok());
    let mut next = |otherwise| numbers.next().unwrap_or(otherwise);
    let (wanted, seed, threads) = (next(10), next(1), next(1));
    match jointscope_proof::Planning::of(wanted, seed as u64, threads, |_| ()) {
        Ok(planning) => {
            for case in &planning.cases {
                println!("{}", serde_json::json!(case));
            }
            println!("{planning}");
        }
        Err(error) => eprintln!("{error}"),
    }
}
