//! Scores the diagnosis of amplitude-dependent joints on concealed cases of the simulated laboratory, which shares no code with it.
//!
//! `cargo run --release -p jointscope-proof --example amplitude -- CASES SEED [FAMILY]`
#![allow(clippy::unwrap_used)]

use jointscope_fixture::{Damping, Dof, EffectKind, Fixture};
use jointscope_nonlinear::{CHANGED, NonlinearDiagnosis, NonlinearOptions};
use jointscope_rig::{Family, StrikeTest, drawn_within_tolerance, generator, random_law, reach};
use jointscope_spectra::Channel;
use rand::Rng;

/// Peaks of the three levels, N.
const LEVELS: [f64; 3] = [35.0, 140.0, 500.0];

fn unit(rng: &mut impl Rng) -> f64 {
    (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let number = |i: usize, or: u64| arguments.get(i).and_then(|a| a.parse().ok()).unwrap_or(or);
    let (cases, seed) = (number(1, 20), number(2, 1));
    let family = match arguments.get(3).map(String::as_str) {
        Some("three") => Family::ThreeBlocks,
        Some("frame") => Family::Frame,
        Some("supported") => Family::SupportedTwoBlocks,
        Some("beam") => Family::BeamAndBlock,
        _ => Family::TwoBlocks,
    };
    let only_nulls = arguments.get(4).is_some_and(|a| a == "null");
    let (mut nulls, mut alarms, mut planted, mut right, mut seen) = (0, 0, 0, 0, 0);
    let mut errors: Vec<(String, f64, bool)> = Vec::new();
    let (mut ratios, mut seconds) = (Vec::new(), 0.0);
    for case in 0..cases {
        let mut rng = generator(seed * 100_000 + case);
        let fixture = loop {
            let drawn: Fixture = family.draw("amplitude", &mut rng).unwrap();
            if !matches!(drawn.damping(), Damping::LossFactor(_)) {
                break drawn;
            }
        };
        let truth = drawn_within_tolerance(&fixture, &mut rng).unwrap();
        let point = |i: usize| Channel::transverse(fixture.points()[i].name.clone());
        let last = fixture.points().len() - 1;
        let (struck, read) = (vec![point(0), point(1)], vec![point(last - 1), point(last)]);
        let test = StrikeTest {
            rate: 6400.0,
            samples: 6144,
            steps: if only_nulls { 4 } else { 8 },
            pulse: 0.0005 + 0.0002 * unit(&mut rng),
            levels: LEVELS.to_vec(),
            hits: 3,
            noise_response: 0.01,
            noise_force: 0.001 + 0.0005 * unit(&mut rng),
        };
        let kind = match case % 4 {
            _ if only_nulls => None,
            0 => Some(EffectKind::CubicStiffness),
            1 => Some(EffectKind::Friction),
            2 => Some(EffectKind::Gap),
            _ => None,
        };
        let effect = kind.map(|kind| {
            let joints = fixture.joints();
            let joint = &joints[(unit(&mut rng) * joints.len() as f64) as usize];
            let dof = if unit(&mut rng) < 0.6 || family == Family::Frame {
                Dof::Translation
            } else {
                Dof::Rotation
            };
            let most = struck.iter().map(|c| reach(&truth, (&joint.name, dof), c, &test, LEVELS[2]).unwrap());
            let most = most.fold(0.0, f64::max);
            let stiffness = jointscope_lumped::nominal_stiffness(&joint.law, fixture.joint_length(joint));
            let own = usize::from(dof == Dof::Rotation);
            random_law(&mut rng, kind, &joint.name, dof, stiffness.at(own, own), most)
        });
        let hidden = truth.with_physics(effect.clone().into_iter().collect()).unwrap();
        let hits = match test.record(&hidden, &struck, &read, &mut rng) {
            Ok(hits) => hits,
            Err(error) => {
                println!("{case}: {error}");
                continue;
            }
        };
        let begun = std::time::Instant::now();
        let diagnosis = NonlinearDiagnosis::of(&fixture, &hits, &NonlinearOptions::default());
        seconds += begun.elapsed().as_secs_f64();
        let diagnosis = match diagnosis {
            Ok(diagnosis) => diagnosis,
            Err(error) => {
                println!("{case}: {error}");
                continue;
            }
        };
        let p = diagnosis.homogeneity.p_value;
        let Some(effect) = effect else {
            nulls += 1;
            if p < CHANGED {
                alarms += 1;
                println!("{case}: false alarm, p = {p:.1e}, ratio {:.3}", diagnosis.homogeneity.ratio);
            }
            continue;
        };
        planted += 1;
        if p < CHANGED {
            seen += 1;
        }
        let chi2 = diagnosis.models.as_ref().map(|m| m[2].chi2_per_dof);
        let name =
            |e: &jointscope_fixture::Effect| format!("{} {} {:?}", e.kind.name(), e.place, e.dof.unwrap());
        let found = diagnosis.findings.first();
        let correct =
            found.is_some_and(|f| name(&f.effect) == name(&effect)) && diagnosis.findings.len() == 1;
        right += usize::from(correct);
        let mut line = String::new();
        if let Some(found) = found.filter(|_| correct) {
            for (place, estimate) in found.estimates.iter().enumerate() {
                let error = estimate.value / effect.value(place) - 1.0;
                let covered = estimate
                    .interval
                    .is_some_and(|[low, high]| low <= effect.value(place) && effect.value(place) <= high);
                line += &format!(
                    " {} {:+.2} %{}",
                    estimate.parameter.name,
                    100.0 * error,
                    if covered { "" } else { "!" }
                );
                errors.push((format!("{}.{}", effect.kind.name(), estimate.parameter.name), error, covered));
            }
        }
        if let Some(held) = &diagnosis.held_out {
            ratios.push(held.nrmse_refitted / held.nrmse_repaired);
            line += &format!(" held out {:.3} -> {:.4}", held.nrmse_refitted, held.nrmse_repaired);
        }
        let also: Vec<String> = diagnosis
            .findings
            .iter()
            .map(|f| format!("{} ({:.2})", name(&f.effect), f.probability))
            .collect();
        println!(
            "{case}: {} {}: {:?} p {p:.0e} chi2 {:.3} found {also:?}{line} [{:.1} s]",
            if correct { "right" } else { "WRONG" },
            name(&effect),
            diagnosis.verdict,
            chi2.unwrap_or(0.0),
            begun.elapsed().as_secs_f64()
        );
        if !correct {
            println!("    planted {:?}", effect.parameters.iter().map(|q| q.value).collect::<Vec<_>>());
            for f in &diagnosis.findings {
                println!(
                    "    found {:?} of {:?}",
                    name(&f.effect),
                    f.estimates.iter().map(|e| e.value).collect::<Vec<_>>()
                );
            }
        }
    }
    println!(
        "nulls {nulls}, false alarms {alarms}; planted {planted}, seen {seen}, named rightly {right}; {:.2} s a case",
        seconds / cases as f64
    );
    let mut kinds: Vec<String> = errors.iter().map(|(k, ..)| k.clone()).collect();
    kinds.sort();
    kinds.dedup();
    for kind in kinds {
        let of: Vec<&(String, f64, bool)> = errors.iter().filter(|(k, ..)| *k == kind).collect();
        let mut sizes: Vec<f64> = of.iter().map(|(_, e, _)| e.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let within = sizes.iter().filter(|e| **e < 0.1).count();
        let covered = of.iter().filter(|(.., c)| *c).count();
        println!(
            "{kind}: {} of {} within 10 %, median error {:.2} %, 95 % intervals hold {covered}",
            within,
            of.len(),
            100.0 * sizes[sizes.len() / 2]
        );
    }
    ratios.sort_by(f64::total_cmp);
    if let (Some(least), Some(median)) = (ratios.first(), ratios.get(ratios.len() / 2)) {
        let five = ratios.iter().filter(|r| **r >= 5.0).count();
        println!(
            "held out: refitted over repaired error, least {least:.1}, median {median:.1}, at least 5 in {five} of {}",
            ratios.len()
        );
    }
}
