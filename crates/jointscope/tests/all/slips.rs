//! What tests really do to data: the one hammer, filters of channels, paths past the joint, hum and
//! overloads. Each from the simulated laboratory, named as such or left out.

use crate::common::{believed, four_pairs, hammer, measured};
use crate::model_error::told;
use jointscope::diagnosis::{Diagnosis, DiagnosisOptions, Verdict};
use jointscope::fixture::{Dof, Effect, EffectKind, Place};
use jointscope::{Fixture, FrfPair, FrfSet, SpectralLines};
use jointscope_rig::HammerSetup;
use num_complex::Complex64;
use serde_json::json;

/// The four FRFs across the joint, and those on block A.
fn eight_pairs() -> Vec<FrfPair> {
    let near = [("1", "1"), ("2", "1"), ("1", "2"), ("2", "2")];
    four_pairs().into_iter().chain(near.map(|(o, i)| FrfPair::transverse(o, i))).collect()
}

fn diagnosed(effect: &Effect, pairs: &[FrfPair], seed: u64) -> Diagnosis {
    let fixture = believed([0.004, 0.004]);
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let frfs = measured(&fixture, vec![effect.clone()], (pairs, &lines), &hammer(seed));
    Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap()
}

/// Expects the effect by its name alone, its parameters within a share of what they are.
#[track_caller]
fn named(effect: &Effect, pairs: &[FrfPair], seed: u64, share: f64) {
    let diagnosis = diagnosed(effect, pairs, seed);
    let [found] = &diagnosis.findings[..] else { panic!("{}", told(&diagnosis)) };
    let same = |e: &Effect| (e.kind, e.place.clone(), e.dof);
    assert!(
        same(&found.effect) == same(effect)
            && found.probability > 0.5
            && diagnosis.verdict == Verdict::Explained,
        "{}",
        told(&diagnosis)
    );
    let leading = effect.kind.spec().size.parameter;
    let ratio = found.effect.value(leading) / effect.value(leading);
    assert!((ratio - 1.0).abs() < share, "{ratio} of {effect:?}");
}

fn on(kind: EffectKind, place: Place, values: &[f64]) -> Effect {
    Effect::new(kind, place, None, values)
}

#[test]
fn a_late_hammer_is_one_channel_and_not_two_early_responses() {
    named(&on(EffectKind::ChannelDelay, Place::Force, &[5e-5]), &four_pairs(), 11, 0.02);
    named(&on(EffectKind::ChannelDelay, Place::Force, &[5e-5]), &eight_pairs(), 12, 0.02);
}

#[test]
fn a_hammer_that_reads_high_is_no_mass_that_is_missing() {
    named(&on(EffectKind::ChannelGain, Place::Force, &[1.05]), &eight_pairs(), 13, 0.005);
}

#[test]
fn a_hammer_that_strikes_beside_the_sensor_and_a_sensor_beside_the_impacts_are_off_by_themselves() {
    let driven = || "1".to_owned();
    named(&on(EffectKind::PointOffset, Place::Reference(driven()), &[0.003]), &eight_pairs(), 41, 0.1);
    named(&on(EffectKind::PointOffset, Place::Response(driven()), &[-0.002]), &eight_pairs(), 42, 0.1);
    named(&on(EffectKind::PointOffset, Place::Point(driven()), &[0.003]), &eight_pairs(), 43, 0.1);
}

#[test]
fn a_sensor_that_goes_from_response_to_response_is_one_mass_and_not_three() {
    named(&on(EffectKind::SensorMass, Place::Responses, &[0.012]), &eight_pairs(), 45, 0.02);
}

#[test]
fn structural_damping_that_the_stated_ratios_were_measured_with_is_no_delay_of_a_channel() {
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let lossy = on(EffectKind::LossFactor, Place::Joint("J".into()), &[0.01]);
    let frfs = measured(&believed([1e-6, 1e-6]), vec![lossy], (&four_pairs(), &lines), &hammer(44));
    // A modal test of that structure reads half the loss factor in both modes.
    let stated = believed([0.0045, 0.0052]);
    let diagnosis = Diagnosis::of(&stated, &frfs, &DiagnosisOptions::default()).unwrap();
    let [found] = &diagnosis.findings[..] else { panic!("{}", told(&diagnosis)) };
    assert!(found.effect.kind == EffectKind::LossFactor, "{}", told(&diagnosis));
    assert!((found.effect.value(0) / 0.01 - 1.0).abs() < 0.1, "{}", told(&diagnosis));
    assert!(diagnosis.departures.is_empty(), "{:?}", diagnosis.departures);
}

#[test]
fn ac_coupling_is_a_high_pass_and_no_dashpots_to_ground() {
    named(&on(EffectKind::ChannelHighpass, Place::Response("3".into()), &[1.5]), &four_pairs(), 14, 0.1);
    named(&on(EffectKind::ChannelHighpass, Place::Force, &[1.5]), &eight_pairs(), 15, 0.1);
}

#[test]
fn a_softly_mounted_sensor_resonates_above_the_band() {
    named(
        &on(EffectKind::ChannelResonance, Place::Response("4".into()), &[2600.0, 0.02]),
        &four_pairs(),
        16,
        0.05,
    );
}

#[test]
fn a_hammer_that_resonates_far_above_the_band_is_not_late() {
    let resonance = on(EffectKind::ChannelResonance, Place::Force, &[5800.0, 0.04]);
    named(&resonance, &four_pairs(), 26, 0.05);
}

#[test]
fn a_sensor_may_resonate_in_the_band_or_just_above_it_too() {
    for (hz, seed) in [(690.0, 24), (1250.0, 25)] {
        let resonance = on(EffectKind::ChannelResonance, Place::Response("3".into()), &[hz, 0.025]);
        named(&resonance, &four_pairs(), seed, 0.02);
    }
}

#[test]
fn a_cable_from_block_to_block_is_a_bypass_where_it_is() {
    let place = Place::Between("A".into(), "B".into());
    named(&on(EffectKind::Bypass, place, &[-0.02, 0.1, 2e5, 3.0]), &eight_pairs(), 17, 0.05);
}

#[test]
fn fractional_damping_of_a_joint_is_neither_a_dashpot_nor_a_loss_factor() {
    let pot = Effect::new(EffectKind::Springpot, Place::Joint("J".into()), Some(Dof::Rotation), &[4.0, 0.5]);
    named(&pot, &four_pairs(), 18, 0.25);
}

#[test]
fn a_body_may_be_held_against_rotation_alone() {
    let held =
        Effect::new(EffectKind::Support, Place::Body("A".into()), Some(Dof::Rotation), &[0.0, 5000.0, 0.3]);
    let diagnosis = diagnosed(&held, &eight_pairs(), 19);
    let [found] = &diagnosis.findings[..] else { panic!("{}", told(&diagnosis)) };
    assert!(found.effect.kind == EffectKind::Support && found.effect.dof == Some(Dof::Rotation));
    assert!((found.effect.value(1) / 5000.0 - 1.0).abs() < 0.02 && found.estimate("x").is_none());
}

#[test]
fn what_hardly_shows_is_not_named_where_frfs_were_estimated_from_hits() {
    let fixture = believed([0.004, 0.004]);
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let coupled = on(EffectKind::ChannelHighpass, Place::Response("4".into()), &[0.25]);
    let frfs = measured(&fixture, vec![coupled], (&four_pairs(), &lines), &hammer(21));
    let diagnosed = |estimated: bool| {
        let options = DiagnosisOptions { estimated, ..DiagnosisOptions::default() };
        Diagnosis::of(&fixture, &frfs, &options).unwrap()
    };
    let recorded = diagnosed(false);
    assert!(
        recorded.findings.len() == 1 && recorded.refitted.0 < 1.2,
        "{:?} {}",
        recorded.refitted,
        told(&recorded)
    );
    let estimated = diagnosed(true);
    assert!(estimated.findings.is_empty() && estimated.verdict == Verdict::Consistent);
}

#[test]
fn what_hardly_shows_is_not_named_beside_what_does_where_frfs_were_estimated_from_hits() {
    // Of a model without error of its own the noise of the lines decides.
    let mut value = believed([0.004, 0.004]).to_value();
    value["model_error"] = json!({ "frequency": 0.0, "damping": 0.0, "residue": 0.0 });
    let fixture = Fixture::from_value(&value).unwrap();
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let coupled = on(EffectKind::ChannelHighpass, Place::Response("4".into()), &[0.05]);
    let heavy = on(EffectKind::AddedMass, Place::Body("B".into()), &[0.11, 0.05]);
    let frfs = measured(&fixture, vec![heavy, coupled], (&four_pairs(), &lines), &hammer(21));
    let kinds = |estimated: bool| {
        let options = DiagnosisOptions { estimated, ..DiagnosisOptions::default() };
        let diagnosis = Diagnosis::of(&fixture, &frfs, &options).unwrap();
        diagnosis.findings.iter().map(|finding| finding.effect.kind).collect::<Vec<_>>()
    };
    assert_eq!(kinds(false), [EffectKind::AddedMass, EffectKind::ChannelHighpass]);
    assert_eq!(kinds(true), [EffectKind::AddedMass]);
}

#[test]
fn a_gain_of_a_twentieth_is_named_of_hits_though_the_noise_would_hide_it() {
    let fixture = believed([0.004, 0.004]);
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let low = on(EffectKind::ChannelGain, Place::Response("4".into()), &[0.95]);
    let noisy = HammerSetup { noise_response: 0.04, ..hammer(22) };
    let frfs = measured(&fixture, vec![low], (&four_pairs(), &lines), &noisy);
    let options = DiagnosisOptions { estimated: true, ..DiagnosisOptions::default() };
    let diagnosis = Diagnosis::of(&fixture, &frfs, &options).unwrap();
    let [found] = &diagnosis.findings[..] else { panic!("{}", told(&diagnosis)) };
    assert!(diagnosis.refitted.0 < 1.2, "{:?}", diagnosis.refitted);
    assert!(found.effect.kind == EffectKind::ChannelGain && (found.effect.value(0) - 0.95).abs() < 0.02);
}

/// A test with nothing left out, its values changed on lines.
fn disturbed(change: impl Fn(usize, Complex64) -> Complex64) -> (Fixture, FrfSet) {
    let fixture = believed([0.004, 0.004]);
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let frfs = measured(&fixture, Vec::new(), (&four_pairs(), &lines), &hammer(20));
    (fixture, frfs.with_values(|at, value| change(at % 400, value)))
}

#[test]
fn mains_hum_is_left_out_and_nothing_is_named_for_it() {
    let (fixture, frfs) =
        disturbed(|line, value| if (18..21).contains(&line) { 30.0 * value } else { value });
    let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Consistent, "{}", told(&diagnosis));
    let [(from, to)] = diagnosis.contradictory[..] else { panic!("{:?}", diagnosis.contradictory) };
    assert!((40.0..=47.5).contains(&from) && (52.5..=60.0).contains(&to), "{from} to {to} Hz");
}

#[test]
fn single_lines_of_hum_are_left_out_and_no_others_with_them() {
    // 50 and 150 Hz, as large as the FRF itself, at a phase of its own in every record.
    let tone = |at: usize| Complex64::cis(2.4 * at as f64);
    let (fixture, frfs) = disturbed(|_, value| value);
    let hum = |at: usize, value: Complex64| match at % 400 {
        19 | 59 => value + value.norm() * tone(at),
        _ => value,
    };
    let frfs = frfs.with_values(hum);
    let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Consistent, "{}", told(&diagnosis));
    assert_eq!(diagnosis.contradictory, [(50.0, 50.0), (150.0, 150.0)]);
}

#[test]
fn values_of_one_frf_that_were_spoilt_by_themselves_are_left_out() {
    let (fixture, frfs) = disturbed(|_, value| value);
    let spoilt = |at: usize, value: Complex64| match at {
        460 => 20.0 * value,
        533 => 100.0 * value,
        700 => 0.02 * value,
        _ => value,
    };
    let diagnosis = Diagnosis::of(&fixture, &frfs.with_values(spoilt), &DiagnosisOptions::default()).unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Consistent, "{}", told(&diagnosis));
    assert_eq!(diagnosis.contradictory, [(152.5, 152.5), (335.0, 335.0), (752.5, 752.5)]);
}

#[test]
fn the_one_record_that_is_in_g_is_named() {
    let (fixture, frfs) = disturbed(|_, value| value);
    let frfs = frfs.with_values(|at, value| if at / 400 == 2 { value / 9.80665 } else { value });
    let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
    let [found] = &diagnosis.findings[..] else { panic!("{}", told(&diagnosis)) };
    assert_eq!(found.effect.place, Place::Record(frfs.pairs()[2].to_string()), "{}", told(&diagnosis));
    assert!((9.80665 * found.effect.value(0) - 1.0).abs() < 0.01, "{}", told(&diagnosis));
}

#[test]
fn a_peak_that_an_overload_flattened_is_left_out() {
    let fixture = believed([0.004, 0.004]);
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let frfs = measured(&fixture, Vec::new(), (&four_pairs(), &lines), &hammer(20));
    let size = |line: usize| frfs.values(0)[line].norm();
    let peak = (40..400).fold(40, |best, line| if size(line) > size(best) { line } else { best });
    let (fixture, frfs) = disturbed(|line, value| if line.abs_diff(peak) < 4 { 0.4 * value } else { value });
    let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Consistent, "{}", told(&diagnosis));
    let at = 2.5 * (peak as f64 + 1.0);
    assert!(
        diagnosis.contradictory.iter().any(|(from, to)| *from < at && at < *to),
        "{:?}",
        diagnosis.contradictory
    );
}

#[test]
fn ac_coupling_of_all_responses_alike_is_one_filter_and_not_one_of_each() {
    for (corner, seed) in [(2.0, 26), (1.0, 27)] {
        let each = ["3", "4"].map(|n| on(EffectKind::ChannelHighpass, Place::Response(n.into()), &[corner]));
        let fixture = believed([0.004, 0.004]);
        let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
        let frfs = measured(&fixture, each.to_vec(), (&four_pairs(), &lines), &hammer(seed));
        let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
        let [found] = &diagnosis.findings[..] else { panic!("{}", told(&diagnosis)) };
        assert!(found.effect.kind == EffectKind::ChannelHighpass && found.effect.place == Place::Responses);
        assert!((found.effect.value(0) / corner - 1.0).abs() < 0.1, "{}", told(&diagnosis));
    }
}

#[test]
fn ac_coupling_of_the_one_hammer_is_that_of_the_force() {
    named(&on(EffectKind::ChannelHighpass, Place::Force, &[2.0]), &four_pairs(), 28, 0.1);
    named(&on(EffectKind::ChannelHighpass, Place::Force, &[1.0]), &four_pairs(), 29, 0.1);
}

/// `believed` with gains of records that scatter by a tenth, and what is recorded of it through these gains.
fn struck_unevenly(effects: &[Effect], gains: [f64; 4], seed: u64) -> Diagnosis {
    let mut file: serde_json::Value = serde_json::from_str(&believed([0.004, 0.004]).to_json()).unwrap();
    let scatter = serde_json::json!({ "*": { "gain": { "value": 1.0, "std": 0.1 } } });
    file.as_object_mut().unwrap().insert("channels".into(), scatter);
    let fixture = Fixture::from_json(&file.to_string()).unwrap();
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let frfs = measured(&fixture, effects.to_vec(), (&four_pairs(), &lines), &hammer(seed));
    let frfs = frfs.with_values(|at, value| gains[at / 400] * value);
    Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap()
}

#[test]
fn gains_of_records_that_scatter_as_stated_hide_nothing_and_are_no_physics() {
    let gains = [1.07, 0.93, 0.94, 1.11];
    let nothing = struck_unevenly(&[], gains, 30);
    assert_eq!(nothing.verdict, Verdict::Consistent, "{}", told(&nothing));
    assert!(nothing.chi2_per_dof()[1] < 1.1, "{:?}", nothing.chi2_per_dof());
    let kind = EffectKind::InterfaceCompliance;
    let turning = Effect::new(kind, Place::Point("3".into()), Some(Dof::Rotation), &[15_000.0, 1e-3]);
    let diagnosis = struck_unevenly(&[turning], gains, 31);
    let [found] = &diagnosis.findings[..] else { panic!("{}", told(&diagnosis)) };
    assert!(found.effect.kind == kind && found.effect.place == Place::Point("3".into()));
    assert!((found.effect.value(0) / 15_000.0 - 1.0).abs() < 0.1, "{}", told(&diagnosis));
    let [low, _] = found.estimate("damping").unwrap().interval.unwrap();
    assert!(low >= 0.0, "a dashpot of {low} N*m*s/rad");
}

#[test]
fn a_soft_tip_whose_blow_dies_away_within_the_band_is_no_misfit() {
    let fixture = believed([0.004, 0.004]);
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    for (corner, averages, seed) in [(150.0, 5, 34), (250.0, 5, 35), (250.0, 10, 36)] {
        let soft = HammerSetup { corner, averages, noise_force: 0.002, ..hammer(seed) };
        let frfs = measured(&fixture, Vec::new(), (&four_pairs(), &lines), &soft);
        let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
        assert_eq!(
            diagnosis.verdict,
            Verdict::Consistent,
            "{corner} Hz, {averages} hits: {}",
            told(&diagnosis)
        );
        assert!(diagnosis.chi2_per_dof()[1] < 1.1, "{corner} Hz: {:?}", diagnosis.chi2_per_dof());
    }
}

/// A soft tip, and a force channel whose noise is a fiftieth of its signal: where the blow dies away H1 is
/// too small by some per cent.
fn noisy_force(seed: u64) -> HammerSetup {
    HammerSetup { corner: 150.0, averages: 8, noise_force: 0.02, ..hammer(seed) }
}

#[test]
fn what_noise_of_the_force_makes_of_h1_is_no_resonance_of_a_channel() {
    let fixture = believed([0.004, 0.004]);
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    for seed in [1, 2] {
        let frfs = measured(&fixture, Vec::new(), (&four_pairs(), &lines), &noisy_force(seed));
        let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
        assert_eq!(diagnosis.verdict, Verdict::Consistent, "{}", told(&diagnosis));
        assert!(diagnosis.falls_short.is_some_and(|share| share > 0.01), "{:?}", diagnosis.falls_short);
    }
}

#[test]
fn what_is_there_is_named_beside_noise_of_the_force() {
    let fixture = believed([0.004, 0.004]);
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let gain = on(EffectKind::ChannelGain, Place::Response("4".into()), &[1.1]);
    let hammer = HammerSetup { corner: 250.0, ..noisy_force(1) };
    let frfs = measured(&fixture, vec![gain], (&four_pairs(), &lines), &hammer);
    let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
    let [found] = &diagnosis.findings[..] else { panic!("{}", told(&diagnosis)) };
    assert!(
        found.effect.kind == EffectKind::ChannelGain && found.effect.place == Place::Response("4".into())
    );
    assert!((found.effect.value(0) - 1.1).abs() < 0.005, "{}", told(&diagnosis));
}

#[test]
fn a_record_far_outside_of_the_scatter_of_gains_is_named_as_such_and_no_mass_for_it() {
    for (gains, frf, seed) in [([1.07, 0.585, 0.94, 1.11], "3/1", 32), ([0.9, 1.1, 0.585, 1.0], "4/2", 33)] {
        let diagnosis = struck_unevenly(&[], gains, seed);
        let [found] = &diagnosis.findings[..] else { panic!("{}", told(&diagnosis)) };
        let same =
            found.effect.kind == EffectKind::ChannelGain && found.effect.place == Place::Record(frf.into());
        assert!(same && diagnosis.verdict == Verdict::Explained, "{}", told(&diagnosis));
        let [low, high] = found.estimate("factor").unwrap().interval.unwrap();
        assert!(low < 0.585 && 0.585 < high && found.probability > 0.9, "{}", told(&diagnosis));
    }
}
