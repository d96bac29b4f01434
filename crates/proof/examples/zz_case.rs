#![allow(clippy::unwrap_used, missing_docs)]
use jointscope_diagnosis::*;
use jointscope_proof::Plan;
fn main() {
    let a: Vec<u64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let plan = Plan { cases: 48, seed: a[0], fresh_from: None, only: Some(a[1] as usize), ..Plan::default() };
    let (cases, _) = plan.draw().unwrap();
    let case = &cases[0];
    let observation = Observation::new(&case.recorded, |_| true).unwrap();
    let start = Hypothesis::nominal(&case.believed, false);
    let search = Search::of(&case.believed, &observation, false).unwrap();
    println!(
        "refitted {:.1} repaired {:.1} {:?}",
        search.refitted.objective,
        search.repaired.objective,
        search.repaired.hypothesis.effects()
    );
    let c = search
        .candidates
        .iter()
        .position(|c| c.kind.name() == "support" && c.place.to_string() == "A")
        .unwrap();
    for i in 0..search.candidates[c].starts.len() {
        let e = search.candidates[c].effect(i);
        let f = Fit::of(&start.with(e), &observation, true).unwrap();
        println!(
            "{:?} -> {:.1} {:?}",
            search.candidates[c].starts[i],
            f.objective,
            f.hypothesis.effects()[0].parameters.iter().map(|p| p.value).collect::<Vec<_>>()
        );
    }
}
