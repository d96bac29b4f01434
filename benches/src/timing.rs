use std::time::Instant;

/// Times of one version of the work, one for each round.
#[derive(Debug, Clone, PartialEq)]
pub struct Timing {
    /// Median over the rounds, s a call.
    pub seconds: f64,
    /// The fastest round, s a call: the figure least touched by what else the machine does.
    pub best: f64,
    /// Each round's own, s a call.
    pub rounds: Vec<f64>,
}

/// Times `versions` in turns: every round runs each of them for about `budget` seconds.
///
/// Turns matter more than long runs: whatever else the machine does falls on all versions alike.
pub fn compare(rounds: usize, budget: f64, versions: &mut [&mut dyn FnMut()]) -> Vec<Timing> {
    let calls: Vec<usize> = versions.iter_mut().map(|version| calls_within(budget, version)).collect();
    let mut times = vec![Vec::with_capacity(rounds); versions.len()];
    for _ in 0..rounds {
        for ((version, &calls), times) in versions.iter_mut().zip(&calls).zip(&mut times) {
            let start = Instant::now();
            for _ in 0..calls {
                version();
            }
            times.push(start.elapsed().as_secs_f64() / calls as f64);
        }
    }
    times
        .into_iter()
        .map(|rounds| Timing {
            seconds: median(rounds.clone()),
            best: rounds.iter().copied().fold(f64::INFINITY, f64::min),
            rounds,
        })
        .collect()
}

/// The median over the rounds of how many times longer `a` takes than `b`.
pub fn ratio(a: &Timing, b: &Timing) -> f64 {
    median(a.rounds.iter().zip(&b.rounds).map(|(a, b)| a / b).collect())
}

fn calls_within(budget: f64, version: &mut dyn FnMut()) -> usize {
    version();
    let mut calls = 1;
    loop {
        let start = Instant::now();
        for _ in 0..calls {
            version();
        }
        let spent = start.elapsed().as_secs_f64();
        if spent >= 0.2 * budget {
            return ((calls as f64 * budget / spent) as usize).max(1);
        }
        calls *= 4;
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

    #[test]
    fn versions_run_in_turns() {
        let order = RefCell::new(Vec::new());
        let times = compare(
            3,
            0.0,
            &mut [&mut || order.borrow_mut().push('a'), &mut || order.borrow_mut().push('b')],
        );
        let order: String = order.borrow().iter().collect();
        assert!(order.ends_with("ababab"), "{order}");
        assert!(times.iter().all(|version| version.rounds.len() == 3 && version.best <= version.seconds));
    }

    #[test]
    fn a_ratio_is_the_median_of_what_each_round_says() {
        let of = |rounds: [f64; 3]| Timing { seconds: 0.0, best: 0.0, rounds: rounds.to_vec() };
        // The second round met something else on the machine, in one of its versions.
        assert_eq!(ratio(&of([10.0, 90.0, 12.0]), &of([1.0, 1.0, 1.0])), 12.0);
        assert_eq!(ratio(&of([10.0, 10.0, 12.0]), &of([1.0, 5.0, 1.0])), 10.0);
    }
}
