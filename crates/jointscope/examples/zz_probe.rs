#![allow(clippy::unwrap_used, missing_docs)]
use jointscope::diagnosis::{Fit, Hypothesis, Linearisation, Observation, catalogue};
use std::time::Instant;
fn main() {
    let dir = std::env::args().nth(1).unwrap();
    let fixture =
        jointscope::Fixture::from_json(&std::fs::read_to_string(format!("{dir}/fixture.json")).unwrap())
            .unwrap();
    let bytes = std::fs::read(format!("{dir}/frf.uff")).unwrap();
    let recording = jointscope::read(&fixture, &bytes).unwrap();
    let observation = Observation::new(recording.frfs().unwrap(), |_| true).unwrap();
    let start = Hypothesis::nominal(&fixture, false);
    println!(
        "lines {} frfs {} tolerances {}",
        observation.lines().len(),
        observation.pairs().len(),
        start.tolerances().len()
    );
    let t = Instant::now();
    for _ in 0..1000 {
        std::hint::black_box(start.to_fixture().unwrap());
    }
    println!("to_fixture {:.1} us", t.elapsed().as_secs_f64() * 1e3);
    let t = Instant::now();
    for _ in 0..1000 {
        std::hint::black_box(start.predict(&observation).unwrap());
    }
    println!("predict {:.1} us", t.elapsed().as_secs_f64() * 1e3);
    let f2 = start.to_fixture().unwrap();
    let t = Instant::now();
    for _ in 0..1000 {
        std::hint::black_box(jointscope::lumped::Model::new(&f2, 1000.0).unwrap());
    }
    println!("Model::new {:.1} us", t.elapsed().as_secs_f64() * 1e3);
    let c = catalogue(&fixture, &observation);
    println!("{} candidates, {} starts", c.len(), c.iter().map(|c| c.starts.len()).sum::<usize>());
    for c in &c {
        let h = start.with(c.effect(0));
        let mut best = f64::INFINITY;
        for _ in 0..100 {
            let t = Instant::now();
            let _ = std::hint::black_box(h.predict(&observation));
            best = best.min(t.elapsed().as_secs_f64());
        }
        println!("  predict with {} {} {:.1} us", c.kind.name(), c.place, best * 1e6);
    }
    let t = Instant::now();
    for _ in 0..20 {
        std::hint::black_box(Linearisation::of(&start, &observation));
    }
    println!("linearise {:.1} us", t.elapsed().as_secs_f64() * 1e6 / 20.0);
    let t = Instant::now();
    let fit = Fit::of(&start, &observation, true).unwrap();
    println!("fit far {:.1} ms objective {:.1}", t.elapsed().as_secs_f64() * 1e3, fit.objective);
}
