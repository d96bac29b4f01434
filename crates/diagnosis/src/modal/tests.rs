//! What a comparison by modes comes to, on simulated structures.

mod every_joint;
mod phases;
mod search;
mod suspended;

use crate::catalogue::catalogue;
use crate::estimates::estimates;
use crate::finding::{Finding, FrfEvidence, Tried};
use crate::fitter::Fitter;
use crate::modal::features::Features;
use crate::modal::fit::{ANY, ModalFit, SetOut};
use crate::modal::judgement::ModalJudgement;
use crate::modal::prior::{Prior, priors, priors_among};
use crate::modal::search::ModalSearch;
use crate::modal::searcher::Named;
use crate::modal::sizes::known;
use crate::search::Search;
use crate::settings::Settings;
use crate::simulated::{observed, simulated};
use crate::{Diagnosis, DiagnosisOptions, Hypothesis, Observation, Watch};
use jointscope_findings::{Estimate, Verdict};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
use jointscope_lumped::{Instrument, synthesize};
use jointscope_model_error::{ErrorSizes, UPPER_RESIDUAL};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};

const SHEAR: f64 = 1.88e7;

/// A free bar of steel, 510 × 19 × 9.8 mm, its rotary inertia and its shear stiffness, N, stated.
fn bar(shear: f64) -> Fixture {
    let points = ["0.015", "0.127", "0.255", "0.367", "0.494"]
        .iter()
        .enumerate()
        .map(|(n, x)| format!(r#""{}": {{ "body": "A", "x": {{"value": {x}, "std": 2e-4}} }}"#, n + 1));
    let known = |value: f64, relative: f64| format!(r#"{{"value": {value}, "std": {}}}"#, relative * value);
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "beam": {{ "from": 0.0, "to": 0.51, "youngs_modulus": {}, "second_moment": {}, "mass_per_length": {} }} }} }},
             "points": {{ {} }}, "joints": {{}},
             "damping": {{ "modal_ratios": [{}, {}, {}] }},
             "physics": [{{ "kind": "shear_deformation", "place": "A", "shear_stiffness": {}, "rotary_inertia": {} }}] }}"#,
        known(2.07e11, 0.01),
        known(1.49e-9, 0.008),
        known(2.165, 0.002),
        points.collect::<Vec<_>>().join(", "),
        known(0.007, 0.25),
        known(0.0025, 0.3),
        known(0.0036, 0.25),
        known(shear, 0.05),
        known(1.18e-5, 0.02),
    ))
    .unwrap()
}

#[test]
fn a_fit_stands_where_it_would_come_to_rest_at_the_errors_that_it_asks_for() {
    // What departs is far from what is stated, and hardly seen: within the usual errors of natural
    // frequencies.
    for factor in [1.4, 1.6, 1.8, 2.0] {
        let lump = Effect::new(EffectKind::AddedMass, Place::Body("A".into()), None, &[0.1, 1e-3]);
        let truth = bar(factor * SHEAR);
        let own = truth.physics().to_vec();
        let truth = truth.with_physics(own.into_iter().chain([lump]).collect()).unwrap();
        let pairs =
            ["1", "2"].iter().flat_map(|i| ["1", "2", "3", "4", "5"].map(|o| FrfPair::transverse(o, i)));
        let lines = SpectralLines::even(20.0, 2.5, 430).unwrap();
        let observation = simulated(&truth, &pairs.collect::<Vec<_>>(), &lines, 6e-6);
        let nominal = Hypothesis::nominal(&bar(SHEAR), false);
        let features = Features::of(&observation, &nominal, &Settings::default().modal).unwrap();
        let problem = features.problem(observation.work());
        let sharply = SetOut::Beside(features.known.scales.times(1e-3));
        let paired = problem.paired_modes(&nominal).unwrap();
        let fit =
            problem.fitted_from(&nominal, paired, &priors(&nominal, &[]), (None, sharply, ANY)).unwrap();
        let (rest, _) = problem.at_sizes(&fit, &fit.evidence.sizes).unwrap();
        let moved =
            rest.coordinates.iter().zip(&fit.hypothesis.coordinates).map(|(rest, at)| (rest - at).abs());
        let moved = moved.fold(0.0, f64::max);
        assert!(moved < 1.5, "{factor}: {moved:.2} deviations from {:?}", fit.evidence.sizes);
    }
}

/// Two free blocks on a strip, their damping ratios known to 15 %.
const BLOCKS: &str = r#"{
  "bodies": { "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }, "B": { "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 } },
  "points": { "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0 }, "3": { "body": "B", "x": 0.065 }, "4": { "body": "B", "x": 0.125 } },
  "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 } } },
  "damping": { "modal_ratios": [{ "value": 0.004, "std": 6e-4 }, { "value": 0.006, "std": 9e-4 }] } }"#;

/// What is recorded with noise of a quarter of a per cent and errors of the shapes of half of one, which no
/// two FRFs share.
fn with_errors_of_shapes(truth: &Fixture, pairs: &[FrfPair], lines: &SpectralLines) -> Observation {
    let frfs = synthesize(truth, pairs, lines, Instrument::AsRecorded).unwrap();
    let count = lines.len();
    let off = |at: usize| 1.0 + 0.005 * (7.0 * (1 + at / count) as f64).sin();
    let frfs = frfs.with_values(|at, value| value * off(at));
    observed(frfs, 6e-6)
}

/// What is recorded of two points by hits on two others, with the noise of a thousandth.
fn recorded(truth: &Hypothesis) -> Observation {
    let pairs = ["1", "2"].iter().flat_map(|i| ["3", "4"].map(|o| FrfPair::transverse(o, i)));
    let lines = SpectralLines::even(20.0, 2.5, 430).unwrap();
    let of_truth = truth.to_fixture().unwrap();
    simulated(&of_truth, &pairs.collect::<Vec<_>>(), &lines, 1e-6)
}

#[test]
fn what_is_left_above_the_band_holds_nothing_against_a_name_of_rigid_blocks() {
    let blocks = Fixture::from_json(BLOCKS).unwrap();
    let usual = |fixture: &Fixture| known(&Settings::default().modal, fixture, &[]).scales.upper_residual;
    assert!(usual(&bar(SHEAR)) < 0.2 * usual(&blocks), "a beam has modes of its own there");
    let nominal = Hypothesis::nominal(&blocks, false);
    let lump = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 0.02]);
    let observation = recorded(&nominal.with(lump.clone()));
    let features = Features::of(&observation, &nominal, &Settings::default().modal).unwrap();
    let problem = features.problem(observation.work());
    let large_above = |hypothesis: &Hypothesis| {
        let candidates = catalogue(&blocks, &observation);
        let priors = priors_among(hypothesis, &candidates).unwrap();
        let mut fit = problem.fitted(hypothesis, &priors).unwrap();
        fit.evidence.sizes.upper_residual = 3.0 * usual(&blocks);
        problem.relative_sizes_as_stated(&fit, 1.0)[UPPER_RESIDUAL]
    };
    assert!((large_above(&nominal) - 3.0).abs() < 1e-9, "the fixture alone is not called consistent");
    assert_eq!(large_above(&nominal.with(lump)), 0.0);
}

#[test]
fn frequencies_of_storeys_that_do_not_turn_are_known_less_well_unless_the_fixture_says_how_well() {
    let storey = |turns: &str, stated: &str| {
        let text = format!(
            r#"{{ "bodies": {{ "F1": {{ "mass": 1.5{turns} }} }}, "points": {{ "1": {{ "body": "F1", "x": 0.1 }} }}, "joints": {{}},
                  "supports": {{ "ground": {{ "point": "1", "stiffness": 1.4e6 }} }}{stated} }}"#
        );
        known(&Settings::default().modal, &Fixture::from_json(&text).unwrap(), &[]).scales.frequency
    };
    let (still, turning) = (r#", "rotates": false"#, r#", "inertia": 1e-3, "x_cg": 0.1"#);
    assert_eq!(storey(turning, ""), 0.003);
    assert_eq!(storey(still, ""), 0.01);
    assert_eq!(storey(still, r#", "model_error": { "frequency": 0.002 }"#), 0.002);
}

#[test]
fn errors_are_held_to_a_multiple_of_what_is_usual_kind_by_kind() {
    let nominal = Hypothesis::nominal(&Fixture::from_json(BLOCKS).unwrap(), false);
    let observation = recorded(&nominal);
    let features = Features::of(&observation, &nominal, &Settings::default().modal).unwrap();
    let problem = features.problem(observation.work());
    let mut fit = problem.fitted(&nominal, &priors(&nominal, &[])).unwrap();
    let usual = features.known.scales;
    fit.evidence.sizes = ErrorSizes { frequency: 1.5 * usual.frequency, shape: 9.0 * usual.shape, ..usual };
    let held = problem.no_larger(&fit, (2.0, 3.0));
    let expected = ErrorSizes { shape: 6.0 * usual.shape, ..fit.evidence.sizes };
    let pairs = held.to_array().into_iter().zip(expected.to_array());
    assert!(pairs.clone().all(|(held, expected)| (held / expected - 1.0).abs() < 1e-12), "{held:?}");
}

/// What `of` makes of blocks of which B holds a lump of 0.2 kg, judged by modes without any name, and of
/// hypotheses with lumps of other masses.
fn judged_beside_lump(of: impl FnOnce(&Fitter, &Search, ModalJudgement, &dyn Fn(f64) -> Hypothesis)) {
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let nominal = Hypothesis::nominal(&fixture, false);
    let lump =
        |mass| nominal.with(Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, mass]));
    let observation = recorded(&lump(0.2));
    let settings = Settings::default();
    let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
    let within = Search::without_effects(&fitter, &fixture, false).unwrap();
    of(&fitter, &within, ModalJudgement::of(&fitter, &nominal, &[], None).unwrap(), &lump);
}

#[test]
fn what_explains_modes_in_part_is_stated_only_where_lines_too_miss_less_with_it() {
    judged_beside_lump(|fitter, within, mut judged, lump| {
        for (mass, verdict) in
            [(0.15, Verdict::PartlyExplained), (0.01, Verdict::Unexplained), (-0.2, Verdict::Unexplained)]
        {
            judged.verdict = Verdict::PartlyExplained;
            judged.stated[1] = lump(mass);
            let (predicted, search) = judged.predicted(fitter, within);
            assert_eq!(predicted.verdict, verdict, "{mass} kg of 0.2 kg");
            let stated = usize::from(verdict == Verdict::PartlyExplained);
            let effects = [&predicted.stated[1], &search.repaired.hypothesis].map(Hypothesis::effect_count);
            assert_eq!(effects, [stated; 2], "{mass} kg of 0.2 kg");
        }
    });
}

#[test]
fn what_leaves_much_of_lines_that_modes_do_not_tell_is_a_part_of_it_and_what_spoils_lines_is_withdrawn() {
    judged_beside_lump(|fitter, within, mut judged, lump| {
        judged.verdict = Verdict::Explained;
        // A tenth of the mass is a hundredth of the squares, more than half of it more than a tenth.
        for (mass, excess_residual_terms, since_baseline, verdict) in [
            (0.09, true, false, Verdict::PartlyExplained),
            (0.18, true, false, Verdict::Explained),
            (0.09, false, false, Verdict::Explained),
            (0.09, true, true, Verdict::Explained),
            (-0.6, false, false, Verdict::Unexplained),
        ] {
            (judged.excess_residual_terms, judged.since_baseline, judged.stated[1]) =
                (excess_residual_terms, since_baseline, lump(mass));
            let (predicted, _) = judged.predicted(fitter, within);
            assert_eq!(
                predicted.verdict, verdict,
                "{mass} kg of 0.2 kg, {excess_residual_terms}, {since_baseline}"
            );
        }
    });
}

#[test]
fn gains_of_records_that_are_anything_leave_no_fixture_consistent_and_the_odd_record_is_named() {
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let exact = recorded(&Hypothesis::nominal(&fixture, false));
    let count = exact.lines().len();
    let frfs = exact.frfs().clone().with_values(|at, v| if at / count == 1 { v / 9.80665 } else { v });
    let variance = frfs.all_values().iter().map(|value| 1e-6 * value.norm_sqr()).collect();
    let frfs = frfs.with_variance(variance).unwrap();
    let (observation, settings) = (Observation::new(&frfs, |_| true).unwrap(), Settings::default());
    let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
    let judged = ModalJudgement::of(&fitter, &Hypothesis::nominal(&fixture, false), &[], None).unwrap();
    assert!(judged.errors[0].is_none(), "modes are those of the fixture");
    assert_eq!(judged.verdict, Verdict::Unexplained);
    let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Explained);
    let [found] = &diagnosis.findings[..] else { panic!("{:?}", diagnosis.findings) };
    assert_eq!(found.effect.place, Place::Record(exact.pairs()[1].to_string()));
    assert!((9.80665 * found.effect.value(0) - 1.0).abs() < 1e-3, "{found:?}");
    assert!(found.probability > 0.9);
}

#[test]
fn a_dashpot_is_known_no_better_than_the_damping_of_the_modes_that_it_damps() {
    // It turns the phases of their shapes too, which are recorded far more sharply than any model has their
    // damping.
    let values = [0.1, 0.06, 200.0, 0.01];
    let resonator = Effect::new(EffectKind::AttachedResonator, Place::Body("B".into()), None, &values);
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let nominal = Hypothesis::nominal(&fixture, false);
    let truth = nominal.with(resonator);
    let observation = recorded(&truth);
    let features = Features::of(&observation, &nominal, &Settings::default().modal).unwrap();
    let problem = features.problem(observation.work());
    let own = truth.coordinates[nominal.coordinates.len()..].iter().map(|at| Prior { mean: *at, std: 1.4 });
    let priors: Vec<Prior> = priors(&nominal, &[]).into_iter().chain(own).collect();
    let paired = problem.paired_modes(&truth).unwrap();
    let fit = problem.fitted_from(&truth, paired, &priors, (None, SetOut::Usual, ANY)).unwrap();
    let mut of_ratios = fit.clone();
    of_ratios.paired.comparison = of_ratios.paired.comparison.with_ratios_alone();
    const ERROR: f64 = 0.05;
    let sizes = ErrorSizes { damping: ERROR, ..fit.evidence.sizes };
    // The logarithm of a ratio is its coordinate.
    let known = |fit: &ModalFit| fit.covariance_at(&sizes).unwrap().std(truth.coordinates.len() - 1);
    let (with, without) = (known(&fit), known(&of_ratios));
    // Three modes have its damping, each with an error of its own.
    let share = with * 3f64.sqrt() / ERROR;
    assert!((0.85..1.3).contains(&share), "known to {with}, the modes' damping to {ERROR}");
    assert!(with > 2.0 * without, "known to {with}, by phases that err in nothing to {without}");
}

#[test]
fn a_joint_that_is_softer_than_stated_may_be_damped_in_proportion_all_the_same() {
    // The strip turns on a rotational spring at its far end, and damping ratios are those of the assembly
    // with that. An effect leaves the fixture's damping matrix as it stands.
    let (length, bending, spring) = (0.065_f64, 2.07e11 * 3.67e-10, 1200.0);
    let [a, b, d] =
        [length.powi(3) / 3.0 / bending, length.powi(2) / 2.0 / bending, length / bending + 1.0 / spring];
    let determinant = a * d - b * b;
    let [a, b, d] = [d, -b, a].map(|entry| entry / determinant);
    let blocks = BLOCKS.replace("\"value\": 0.006", "\"value\": 0.02");
    let beam = r#""beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }"#;
    let softer = blocks.replace(beam, &format!(r#""stiffness": [[{a}, {b}], [{b}, {d}]]"#));
    assert_ne!(softer, blocks);
    let observation = recorded(&Hypothesis::nominal(&Fixture::from_json(&softer).unwrap(), true));
    let nominal = Hypothesis::nominal(&Fixture::from_json(&blocks).unwrap(), true);
    let features = Features::of(&observation, &nominal, &Settings::default().modal).unwrap();
    let problem = features.problem(observation.work());
    let place = Place::Point("3".into());
    let kind = EffectKind::InterfaceCompliance;
    let start = nominal.with(Effect::new(kind, place, Some(Dof::Rotation), &[spring, 0.0]));
    let own = start.coordinates[nominal.coordinates.len()..].iter().map(|at| Prior { mean: *at, std: 1.0 });
    let priors: Vec<Prior> = priors(&nominal, &[]).into_iter().chain(own).collect();
    let fit = problem.fitted(&start, &priors).unwrap();
    let found = fit.hypothesis.effects()[0].value(0);
    let quadrature = fit.evidence.sizes.quadrature / problem.sizes.quadrature;
    assert!(quadrature < 0.1, "shapes' phases are off by {quadrature:.2} times what is usual");
    assert!((found / spring - 1.0).abs() < 0.02, "{found} N m/rad");
}

#[test]
fn a_shear_deformation_leaves_the_rotary_inertia_of_its_section_open() {
    let plain = bar(SHEAR).with_physics(Vec::new()).unwrap();
    let nominal = Hypothesis::nominal(&plain, false);
    let pairs = ["1", "2", "3", "4", "5"].map(|o| FrfPair::transverse(o, "1"));
    let lines = SpectralLines::even(20.0, 2.5, 430).unwrap();
    let observation = simulated(&bar(SHEAR), &pairs, &lines, 6e-6);
    let candidates = catalogue(&plain, &observation);
    let shear = candidates.iter().find(|c| c.kind == EffectKind::ShearDeformation).unwrap();
    // EI over E/ρ, which the bar's own section has to 3 %.
    for start in 0..shear.starts.len() {
        assert!((shear.effect(start).value(1) / 1.18e-5 - 1.0).abs() < 0.03);
    }
    let hypothesis = nominal.with(shear.effect(0));
    let known = priors(&hypothesis, &[shear]).pop().unwrap();
    // A coordinate of one is the start: none at all and three times as much are both as likely as not to
    // surprise.
    assert!(known.mean == 0.0 && (2.0..5.0).contains(&known.std), "{known:?}");
}

/// What is found of a lump on block B of a fixture that is known exactly, `gains` of the four records being
/// off by so much: without and with what errors of the modes leave uncertain of it.
fn found_with_gains(gains: [f64; 4]) -> [Vec<Estimate>; 2] {
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let nominal = Hypothesis::nominal(&fixture, true);
    let lump = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 0.2]);
    let truth = nominal.with(lump.clone());
    let exact = recorded(&truth);
    let count = exact.lines().len();
    let frfs = exact.frfs().clone().with_values(|at, value| value * (1.0 + gains[at / count]));
    let observation = observed(frfs, 1e-6);
    let settings = Settings::default();
    let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
    let judged = ModalJudgement::of(&fitter, &nominal, &[], None).unwrap();
    let covariance = fitter.information(&truth).covariance();
    let estimates = estimates(&truth, 0, &lump, covariance.as_ref(), 1.0);
    let evidence = FrfEvidence { gain: 0.0, elsewhere: Vec::new(), measured: None };
    let finding = Finding {
        effect: lump,
        estimates: estimates.clone(),
        probability: 1.0,
        alternatives: Vec::new(),
        evidence,
    };
    let candidates = catalogue(&fixture, &observation);
    let mut widened = judged.with_errors_of_modes(&fitter, &truth, &candidates, vec![finding]);
    [estimates, widened.pop().unwrap().estimates]
}

#[test]
fn what_lines_find_is_no_surer_than_the_errors_that_the_modes_need_beside_it() {
    let [lines, both] = found_with_gains([0.0; 4]);
    assert_eq!(lines, both, "modes that need no error widen nothing");
    let [lines, both] = found_with_gains([0.04, -0.03, 0.04, -0.03]);
    let wider = |place: usize| both[place].std.unwrap() / lines[place].std.unwrap();
    assert!(wider(1) > 3.0 && wider(0) > 3.0, "{} and {}", wider(1), wider(0));
    assert_eq!(both[1].value, lines[1].value);
}

/// Two blocks on a strip with one of them held to ground by a spring, N/m, and a ripple over frequency on all
/// records that is none of a structure's.
fn rippled(spring: f64, ripple: f64) -> FrfSet {
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let support = Effect::new(EffectKind::Support, Place::Body("B".into()), None, &[0.11, spring, 0.0]);
    let nominal = Hypothesis::nominal(&fixture, false);
    let exact = recorded(&if spring > 0.0 { nominal.with(support) } else { nominal });
    let hz = exact.lines().hz().to_vec();
    let factor = |at: usize| 1.0 + ripple * (hz[at % hz.len()] / 3.7 + (at / hz.len()) as f64).cos();
    let frfs = exact.frfs().clone().with_values(|at, value| value * factor(at));
    let variance = exact.frfs().all_values().iter().map(|value| 1e-6 * value.norm_sqr()).collect();
    frfs.with_variance(variance).unwrap()
}

#[test]
fn what_no_structure_has_in_its_frfs_is_not_held_against_a_name() {
    // The noise is a thousandth; a spring of which the mode is in the band, and one of which it is below.
    for (spring, ripple) in [(1.65e5, 0.006), (1.65e4, 0.005)] {
        let fixture = Fixture::from_json(BLOCKS).unwrap();
        let frfs = rippled(spring, ripple);
        let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
        let case = format!("{spring} N/m beside {ripple}: {:?}", diagnosis.verdict);
        let [finding] = &diagnosis.findings[..] else { panic!("{case}, {:?}", diagnosis.findings) };
        let stiffness = &finding.estimates[1];
        assert_eq!(finding.effect.kind, EffectKind::Support, "{case}");
        assert!(finding.probability > 0.8, "{case}: {}", finding.probability);
        assert!((stiffness.value / spring - 1.0).abs() < 0.01, "{case}: {} N/m", stiffness.value);
        assert!(diagnosis.nrmse()[2] < ripple, "{case}");
    }
}

#[test]
fn a_fixture_is_consistent_with_a_ripple_as_small_as_errors_of_models_are_and_not_with_a_larger_one() {
    for (ripple, verdict) in [(0.004, Verdict::Consistent), (0.012, Verdict::Unexplained)] {
        let fixture = Fixture::from_json(BLOCKS).unwrap();
        let diagnosis = Diagnosis::of(&fixture, &rippled(0.0, ripple), &DiagnosisOptions::default()).unwrap();
        assert_eq!(diagnosis.verdict, verdict, "{ripple}: {:?}", diagnosis.findings);
        assert_eq!(diagnosis.beside_modes.is_some(), verdict == Verdict::Consistent);
    }
}

#[test]
fn what_was_tried_in_vain_is_ranked_each_name_once() {
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let diagnosis = Diagnosis::of(&fixture, &rippled(0.0, 0.012), &DiagnosisOptions::default()).unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Unexplained);
    let name = |tried: &Tried| (tried.effect.kind, tried.effect.place.clone(), tried.effect.dof);
    let names: Vec<_> = diagnosis.tried.iter().map(name).collect();
    assert!(names.len() > 8, "{names:?}");
    assert!((1..names.len()).all(|k| !names[..k].contains(&names[k])), "{names:?}");
    assert!(diagnosis.tried.is_sorted_by(|a, b| a.ln_gain >= b.ln_gain), "the nearest first");
}

#[test]
fn damping_is_off_by_no_more_than_was_stated_of_it_or_is_usual() {
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let nominal = Hypothesis::nominal(&fixture, false);
    let observation = recorded(&nominal);
    let features = Features::of(&observation, &nominal, &Settings::default().modal).unwrap();
    let problem = features.problem(observation.work());
    let mut fit = problem.fitted(&nominal, &priors(&nominal, &[])).unwrap();
    // Features that ask for errors of damping so many times the usual one of 10 %, whatever the parameters:
    // of n modes that are all off by d, with a half-normal prior of scale s, d² = τ²(1 + τ²/(n s²)).
    let ask = |fit: &mut ModalFit, times: f64| {
        let n = fit.paired.pairing.pairs.len();
        let off = times * problem.sizes.damping * (1.0 + times.powi(2) / n as f64).sqrt();
        for mode in 0..n {
            fit.linear.difference[2 * mode + 1] = off;
            fit.linear.slopes.iter_mut().for_each(|slope| slope[2 * mode + 1] = 0.0);
        }
        fit.evidence.sizes.damping = times * problem.sizes.damping;
    };
    // Ratios are stated to 15 %, and models of which nothing is stated have them to 10 %.
    let is_adequate = |fit: &ModalFit| problem.is_adequate(fit, (2.0, 4.0));
    ask(&mut fit, 2.5);
    assert!(!is_adequate(&fit), "the fixture's own modes");
    ask(&mut fit, 2.05);
    assert!(is_adequate(&fit), "errors of twice the usual are as probable");
    let lump = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 1e-6]);
    fit.hypothesis = nominal.with(lump);
    ask(&mut fit, 2.5);
    assert!(is_adequate(&fit), "those of a structure with a lump");
    ask(&mut fit, 4.0);
    assert!(!is_adequate(&fit), "more than was stated");

    let loosely = BLOCKS.replace("6e-4", "12e-4").replace("9e-4", "18e-4");
    assert_ne!(loosely, BLOCKS);
    fit.hypothesis = Hypothesis::nominal(&Fixture::from_json(&loosely).unwrap(), false);
    ask(&mut fit, 2.5);
    assert!(is_adequate(&fit), "the fixture's own modes, of which it states ratios to 30 %");
}

/// What `of` makes of a lump on block B, which the modes name.
fn judged_lump<T>(of: impl FnOnce(&Fitter, &Effect, &ModalJudgement) -> T) -> T {
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let nominal = Hypothesis::nominal(&fixture, false);
    let lump = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 0.2]);
    let observation = recorded(&nominal.with(lump.clone()));
    let settings = Settings::default();
    let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
    let judged = ModalJudgement::of(&fitter, &nominal, &catalogue(&fixture, &observation), None).unwrap();
    of(&fitter, &lump, &judged)
}

#[test]
fn what_is_known_of_a_resonance_is_known_of_it_however_far_a_fit_has_followed_it() {
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let nominal = Hypothesis::nominal(&fixture, false);
    let response = Place::Response("4".into());
    let resonance = Effect::new(EffectKind::ChannelResonance, response, None, &[9000.0, 0.25]);
    let observation = recorded(&nominal.with(resonance));
    let settings = Settings::default();
    let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
    let candidates = catalogue(&fixture, &observation);
    let judged = ModalJudgement::of(&fitter, &nominal, &candidates, None).unwrap();
    let fits = judged.search.singles.iter().map(|single| &single.fit);
    let resonances = fits.filter(|fit| fit.hypothesis.effects()[0].kind == EffectKind::ChannelResonance);
    for fit in resonances {
        let known = priors_among(&fit.hypothesis, &candidates).unwrap();
        for (ours, known) in fit.priors.iter().zip(&known) {
            assert!((ours.std / known.std - 1.0).abs() < 1e-9, "{ours:?} for {known:?}");
        }
    }
    assert!(judged.search.singles.iter().any(|single| single.fit.hypothesis.effects()[0].value(0) > 4000.0));
}

#[test]
fn names_that_lines_are_at_odds_with_are_stated_as_a_part_and_no_surer_than_something_not_listed_lets_them_be()
 {
    let judged = judged_lump(|_, _, judged| judged.clone());
    let stated = |judged: &ModalJudgement| judged.names[0].iter().map(|(_, p, _)| p).sum::<f64>();
    assert!(judged.verdict == Verdict::Explained && stated(&judged) > 0.9, "{}", stated(&judged));
    let doubted = judged.doubted();
    assert_eq!(doubted.verdict, Verdict::PartlyExplained);
    assert!((stated(&doubted) - 2.0 / 3.0).abs() < 1e-9, "{}", stated(&doubted));
    assert_eq!(doubted.doubted().names[0][0].1, doubted.names[0][0].1);
}

#[test]
fn one_finding_of_the_lines_is_no_more_probable_than_the_name_that_the_modes_hold_more_probable() {
    let of_joint = |kind, value: f64| Effect::new(kind, Place::Joint("J".into()), None, &[value]);
    let other = of_joint(EffectKind::JointMass, 0.01);
    let third = of_joint(EffectKind::StiffnessChange, 0.9);
    let finding = |effect: &Effect| Finding {
        effect: effect.clone(),
        estimates: Vec::new(),
        probability: 0.9,
        alternatives: vec![(third.clone(), 0.06)],
        evidence: FrfEvidence { gain: 0.0, elsewhere: Vec::new(), measured: None },
    };
    judged_lump(|fitter, lump, judged| {
        let so_exact = |exact: bool| {
            let best = Named { exact, ..judged.search.best.clone() };
            ModalJudgement { search: ModalSearch { best, ..judged.search.clone() }, ..judged.clone() }
        };
        let (exact, judged) = (so_exact(true), so_exact(false));
        let [found] = &judged.with_its_own_name(fitter, vec![finding(&other)])[..] else { panic!() };
        assert!((found.probability - 0.45).abs() < 1e-12 && (found.stated() - 0.96).abs() < 1e-12);
        assert!(found.alternatives[0].0.is_named_as(lump) && (found.alternatives[0].1 - 0.48).abs() < 1e-12);
        assert!(
            found.alternatives[1].0.is_named_as(&third) && (found.alternatives[1].1 - 0.03).abs() < 1e-12
        );
        let unchanged = |findings: Vec<Finding>| {
            judged.with_its_own_name(fitter, findings).iter().all(|finding| finding.probability == 0.9)
        };
        assert!(unchanged(vec![finding(lump)]), "the modes' own name");
        assert!(unchanged(vec![finding(&other), finding(&third)]), "modes have one name for two findings");
        let kept = exact.with_its_own_name(fitter, vec![finding(&other)]);
        assert_eq!(
            kept[0].probability, 0.9,
            "where no error of the model is needed lines tell what they find"
        );
    });
}
