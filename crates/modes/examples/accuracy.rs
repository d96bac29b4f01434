//! Bias and spread of frequencies and damping ratios against the Cramér–Rao bound, on simulated tests:
//! `cargo run --release -p jointscope-modes --example accuracy [SEEDS]`
#![allow(clippy::unwrap_used, dead_code)] // shares the helpers of the tests, which fail as tests do

#[path = "../tests/all/common/mod.rs"]
mod common;

fn main() {
    let seeds = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(400);
    println!("| test | found | true | bound | bias / bound | spread / bound | rms of error / stated ± |");
    println!("|---|---|---|---|---|---|---|");
    for scenario in common::bound::scenarios() {
        let (scores, found) = scenario.scores(seeds);
        for [frequency, ratio] in scores {
            for (score, unit, factor) in [(frequency, "Hz", 1.0), (ratio, "%", 100.0)] {
                println!(
                    "| {} | {:.1} % | {:.4} {unit} | {:.2e} | {:+.2} | {:.2} | {:.2} |",
                    scenario.name,
                    100.0 * found,
                    factor * score.truth,
                    factor * score.bound,
                    score.bias,
                    score.spread,
                    score.pull
                );
            }
        }
    }
}
