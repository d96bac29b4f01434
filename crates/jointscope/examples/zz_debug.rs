//! Scores the diagnosis on simulated hammer tests with hidden effects.
//!
//! `cargo run --release -p jointscope --example score_diagnosis -- CASES SEED [ONLY]`: random fixtures, true quantities drawn
//! within their tolerances, a quarter of the cases without an effect, the rest with one at a random place and of a random size. The simulated
//! laboratory that makes them shares no code with the diagnosis.
#![allow(clippy::unwrap_used)]

use jointscope::diagnosis::{Fit, Hypothesis, Observation, Search};
use jointscope::fixture::{Effect, EffectKind, Fixture};
use jointscope::{FrfSet, SpectralLines};
use jointscope_rig::{
    Family, HammerTest, Instrument, drawn_within_tolerance, frfs, generator, random_effect,
};
use rand::RngExt;

struct Case {
    believed: Fixture,
    recorded: FrfSet,
    effect: Option<Effect>,
}

fn case(seed: u64) -> Option<Case> {
    let mut random = generator(seed);
    let families = [Family::TwoBlocks, Family::SupportedTwoBlocks, Family::ThreeBlocks, Family::Frame];
    let family = families[random.random_range(0..families.len())];
    let believed = family.draw("case", &mut random).ok()?;
    let truth = drawn_within_tolerance(&believed, &mut random).ok()?;
    let pairs = family.usual_pairs();
    let linear: Vec<EffectKind> = EffectKind::ALL.into_iter().filter(|k| !k.is_nonlinear()).collect();
    let kind = linear[random.random_range(0..linear.len())];
    let null = random.random_range(0..4) == 0;
    let effect = if null { None } else { Some(random_effect(&mut random, &truth, kind, &pairs).ok()??) };
    let truth = truth.with_physics(effect.iter().cloned().collect()).ok()?;
    let lines = SpectralLines::even(2.5, 2.5, 400).ok()?;
    let clean = frfs(&truth, &pairs, &lines, Instrument::AsDescribed).ok()?;
    let hammer = HammerTest {
        averages: [5, 8, 10, 16, 20][random.random_range(0..5)],
        noise_response: random.random_range(0.004..0.015),
        noise_force: random.random_range(0.0005..0.0015),
        corner: random.random_range(900.0..1300.0),
        spread: 0.25,
        common_hits: false,
        seed,
    };
    Some(Case { believed, recorded: hammer.measure(&clean).ok()?, effect })
}

#[derive(Default)]
struct Score {
    nulls: [usize; 2],
    singles: usize,
    kind: usize,
    place: usize,
    accepted: usize,
    surplus: usize,
    small: usize,
}

fn main() {
    let argument =
        |n: usize, default: u64| std::env::args().nth(n).and_then(|a| a.parse().ok()).unwrap_or(default);
    let (cases, seed) = (argument(1, 40), argument(2, 1));
    println!("{cases} cases from seed {seed}");
    let mut score = Score::default();
    let mut times: Vec<f64> = Vec::new();
    let only = std::env::args().nth(3).and_then(|a| a.parse::<u64>().ok());
    for index in (0..cases).filter(|index| only.is_none_or(|o| o == *index)) {
        let Some(case) = case(seed.wrapping_mul(1_000_003).wrapping_add(index)) else { continue };
        debug(&case);
    }
    times.sort_by(f64::total_cmp);
    let Score { nulls, singles, kind, place, accepted, surplus, small } = score;
    println!("nulls called consistent: {} of {}", nulls[0], nulls[1]);
    println!("single effects of at least 50 in chi-squared: {singles} ({small} smaller ones left aside)");
    println!(
        "  kind right {kind}, kind and place right {place}, name accepted {accepted}, extra findings {surplus}"
    );
    println!("seconds a search: median {:.2}, longest {:.2}", 0.0, 0.0);
}

fn judge(score: &mut Score, index: u64, case: &Case, observation: &Observation, search: &Search) {
    let found = search.repaired.hypothesis.effects();
    let say = |text: &str| {
        let names: Vec<String> = found
            .iter()
            .map(|e| format!("{} {} {:?}", e.kind.name(), e.place, e.dof.map(|d| d.name())))
            .collect();
        println!("case {index}: {text}; found [{}]", names.join(", "));
    };
    let Some(effect) = &case.effect else {
        score.nulls[1] += 1;
        score.nulls[0] += usize::from(found.is_empty());
        if !found.is_empty() {
            say(&format!(
                "nothing hidden, objective {:.1} refitted, {:.1} repaired",
                search.refitted.objective, search.repaired.objective
            ));
        }
        return;
    };
    let start = Hypothesis::nominal(&case.believed, false).with(effect.clone());
    let truth = [true, false].into_iter().filter_map(|far| Fit::of(&start, observation, far));
    let truth = truth.map(|fit| fit.objective).fold(f64::INFINITY, f64::min);
    if search.refitted.objective - truth < 50.0 {
        score.small += 1;
        return;
    }
    score.singles += 1;
    let first_is = |test: &dyn Fn(&Effect) -> bool| found.iter().any(test);
    let kind = first_is(&|e| e.kind == effect.kind);
    let place = first_is(&|e| e.kind == effect.kind && e.place == effect.place && e.dof == effect.dof);
    let accepted = place || (found.len() == 1 && search.repaired.objective < truth + 9.0);
    score.kind += usize::from(kind);
    score.place += usize::from(place);
    score.accepted += usize::from(accepted);
    score.surplus += usize::from(found.len() > 1);
    if !accepted || found.len() > 1 {
        let hidden: Vec<f64> = effect.parameters.iter().map(|p| p.value).collect();
        say(&format!(
            "{} {} {:?} {hidden:?}, objective {:.1} refitted, {truth:.1} truth, {:.1} repaired",
            effect.kind.name(),
            effect.place,
            effect.dof.map(|d| d.name()),
            search.refitted.objective,
            search.repaired.objective
        ));
    }
}
fn debug(case: &Case) {
    let observation = Observation::new(&case.recorded, |_| true).unwrap();
    let search = Search::of(&case.believed, &observation, false).unwrap();
    println!(
        "nominal {:.1} refitted {:.1} repaired {:.1}",
        search.nominal.objective, search.refitted.objective, search.repaired.objective
    );
    println!("hidden {:?}", case.effect);
    for (i, t) in search.refitted.hypothesis.tolerances().iter().enumerate() {
        print!("{} {:.2}; ", t.path, search.refitted.hypothesis.departure(i));
    }
    println!();
    if let Some(effect) = &case.effect {
        for far in [true, false] {
            for h in [Hypothesis::nominal(&case.believed, false), search.refitted.hypothesis.clone()] {
                let fit = Fit::of(&h.with(effect.clone()), &observation, far).unwrap();
                println!("truth far {far}: {:.1} {:?}", fit.objective, fit.hypothesis.effects());
            }
        }
    }
    for (c, fit) in search.ranked(&search.refitted, &observation).into_iter().take(12) {
        let e = &search.candidates[c];
        println!(
            "  {} {} {:?}: {:.1} {:?}",
            e.kind.name(),
            e.place,
            e.dof,
            fit.objective,
            fit.hypothesis.effects().last().unwrap().parameters.iter().map(|p| p.value).collect::<Vec<_>>()
        );
    }
}
