//! FRFs of records that ended while the structure still rang.

use crate::common;
use crate::model_error::told;
use jointscope::diagnosis::{Diagnosis, DiagnosisOptions, Verdict};
use jointscope::fixture::{Effect, EffectKind, Place};
use jointscope::{Fixture, FrfSet, Remarks, SpectralLines};
use jointscope_rig::{Instrument, drawn_within_tolerance, frfs, generator};
use jointscope_samples::of_records;

/// What the records of 0.4 s tell of a structure with such effects, of which a twentieth and more still rings
/// at their end.
fn cut_off(believed: &Fixture, effects: Vec<Effect>, seed: u64) -> FrfSet {
    let truth =
        drawn_within_tolerance(believed, &mut generator(seed)).unwrap().with_physics(effects).unwrap();
    let fine = SpectralLines::even(0.25, 0.25, 12_000).unwrap();
    let exact = frfs(&truth, &common::four_pairs(), &fine, Instrument::AsDescribed).unwrap();
    common::hammer(seed)
        .measure(&of_records(&exact, &SpectralLines::even(5.0, 2.5, 477).unwrap(), |_| (0.0104, 8e-4)))
        .unwrap()
}

#[test]
fn what_records_cut_off_is_no_physics_and_hides_none() {
    let believed = common::believed([0.003, 0.004]);
    let diagnosed = |frfs: &FrfSet| Diagnosis::of(&believed, frfs, &DiagnosisOptions::default()).unwrap();
    let nothing = diagnosed(&cut_off(&believed, Vec::new(), 3));
    assert_eq!(nothing.verdict, Verdict::Consistent, "{}", told(&nothing));
    let end = nothing.early_end.unwrap();
    assert!((end.after - 0.3896).abs() < 1e-4 && (0.25..0.4).contains(&end.left), "{end:?}");
    assert!(
        nothing.remarks().iter().any(|remark| remark.starts_with("Records ended 0.390 s after the blow"))
    );
    let lump = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.11, 0.04]);
    let found = diagnosed(&cut_off(&believed, vec![lump.clone()], 4));
    let [only] = &found.findings[..] else { panic!("{}", told(&found)) };
    assert!(only.effect.is_named_as(&lump) && only.probability > 0.9, "{}", told(&found));
    assert!((only.effect.value(1) / 0.04 - 1.0).abs() < 0.1, "{}", told(&found));
}
