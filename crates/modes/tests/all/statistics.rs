//! Estimates against the Cramér–Rao bound. The figures in `docs/reference/modes.md` come from the example
//! `accuracy`, which does the same with more seeds.

use crate::common::bound::scenarios;

#[test]
fn frequencies_and_damping_ratios_are_unbiased_and_scatter_by_their_bound_from_0_01_to_3_percent() {
    const SEEDS: u64 = 40;
    for scenario in scenarios() {
        let (scores, found) = scenario.scores(SEEDS);
        assert!(found >= 0.98, "{}: the modes were found in {found} of the tests", scenario.name);
        for score in scores.iter().flatten() {
            let of = format!("{}, {}: {score:?}", scenario.name, score.truth);
            assert!(score.bias.abs() < 0.6, "{of}");
            // A spread from 40 tests is itself known to 11 %.
            assert!(score.spread < 1.3, "{of}");
            assert!((0.75..1.3).contains(&score.pull), "{of}");
        }
    }
}
