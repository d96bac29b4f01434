//! What a free fixture does not know of a structure that hangs, and what a channel makes of a baseline.

use super::{BLOCKS, observed, synthesize};
use crate::{Diagnosis, DiagnosisOptions};
use jointscope_findings::Verdict;
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_lumped::Instrument;
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};

fn pairs() -> Vec<FrfPair> {
    ["1", "2"].iter().flat_map(|i| ["3", "4"].map(|o| FrfPair::transverse(o, i))).collect()
}

/// The FRFs of blocks with these effects, known to a thousandth each.
fn recorded(effects: Vec<Effect>) -> FrfSet {
    let truth = Fixture::from_json(BLOCKS).unwrap().with_physics(effects).unwrap();
    let lines = SpectralLines::even(5.0, 2.5, 430).unwrap();
    let frfs = synthesize(&truth, &pairs(), &lines, Instrument::AsRecorded).unwrap();
    observed(frfs, 1e-6).frfs().clone()
}

fn known(frfs: FrfSet) -> FrfSet {
    let variance = frfs.all_values().iter().map(|value| 1e-6 * value.norm_sqr()).collect();
    frfs.with_variance(variance).unwrap()
}

#[test]
fn blocks_on_two_pieces_of_foam_have_two_supports_neither_of_which_explains_anything_alone() {
    let foam = |body: &str, x: f64, stiffness: f64| {
        Effect::new(EffectKind::Support, Place::Body(body.into()), None, &[x, stiffness, 50.0])
    };
    let stated = [("A", -0.026, 4.3e4), ("B", 0.106, 9.7e4)];
    let frfs = recorded(stated.iter().map(|&(body, x, k)| foam(body, x, k)).collect());
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let diagnosis = Diagnosis::of(&fixture, &known(frfs), &DiagnosisOptions::default()).unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Explained);
    assert_eq!(diagnosis.findings.len(), 2);
    for (body, _, stiffness) in stated {
        let finding = diagnosis.findings.iter().find(|f| f.effect.place == Place::Body(body.into()));
        let finding = finding.unwrap();
        assert_eq!(finding.effect.kind, EffectKind::Support);
        assert!((finding.effect.value(1) / stiffness - 1.0).abs() < 0.1, "{}", finding.effect.value(1));
    }
}

#[test]
fn a_channel_s_gain_acts_on_all_that_it_read_of_the_baseline_whatever_the_model_knows_of_it() {
    // Each FRF is off by some per cent in either state: shapes that the model does not know.
    let lines = recorded(Vec::new()).lines().len();
    let off = |at: usize| 1.0 + 0.04 * (7.0 * (1 + at / lines) as f64).sin();
    let healthy = recorded(Vec::new()).with_values(|at, value| value * off(at));
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    for factor in [0.85, -1.0] {
        let is_of_4 = |at: usize| pairs()[at / lines].response.point == "4";
        let changed = |at, value| if is_of_4(at) { value * factor } else { value };
        let suspect = known(healthy.clone().with_values(changed));
        let options =
            DiagnosisOptions { baseline: Some(known(healthy.clone())), ..DiagnosisOptions::default() };
        let diagnosis = Diagnosis::of(&fixture, &suspect, &options).unwrap();
        let found: Vec<_> =
            diagnosis.findings.iter().map(|f| (f.effect.kind, f.effect.place.clone())).collect();
        assert_eq!(
            found,
            [(EffectKind::ChannelGain, Place::Response("4".into()))],
            "{factor} {:?}",
            diagnosis.findings
        );
        let found = &diagnosis.findings[0];
        assert!((found.effect.value(0) / factor - 1.0).abs() < 2e-3, "{factor}: {}", found.effect.value(0));
        assert!(found.probability > 0.9, "{factor}: {}", found.probability);
    }
}
