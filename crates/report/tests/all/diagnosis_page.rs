//! What the page of a diagnosis must say, and what it must not hide.

use jointscope_diagnosis::{Departure, Diagnosis, DiagnosisOptions, ModelError, Verdict};
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_report::{InputFile, PageContext, diagnosis_report};
use jointscope_samples::{Noise, TWO_STOREYS, with};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use jointscope_wording::Says;
use num_complex::Complex64;

fn storeys(physics: &str) -> Fixture {
    let named = TWO_STOREYS.replacen("two storeys", "two <storeys>", 1);
    Fixture::from_json(&with(&named, &format!(r#""physics": [{physics}]"#))).unwrap()
}

/// FRFs 1/1 and 2/1 with half a per cent of noise that is the same each time, changed by `change` (FRF,
/// line's share of the band).
fn recorded(truth: &Fixture, change: impl Fn(usize, f64) -> Complex64) -> FrfSet {
    let pairs = [("1", "1"), ("2", "1")].map(|(o, i)| FrfPair::transverse(o, i));
    let lines = SpectralLines::even(20.0, 5.0, 77).unwrap();
    let frfs = synthesize(truth, &pairs, &lines, Instrument::AsRecorded).unwrap();
    let mut noise = Noise::from_state(3);
    let mut uniform = || noise.uniform() - 0.5;
    let mut variance = Vec::new();
    let n = lines.len();
    let values = frfs
        .all_values()
        .iter()
        .enumerate()
        .map(|(index, value)| {
            let value = value * change(index / n, (index % n) as f64 / n as f64);
            let std = 0.005 * value.norm();
            variance.push(std * std);
            value + Complex64::new(uniform(), uniform()) * (6.0_f64.sqrt() * std)
        })
        .collect();
    FrfSet::new(lines, frfs.form(), pairs.to_vec(), values).unwrap().with_variance(variance).unwrap()
}

fn page(physics: &str, change: impl Fn(usize, f64) -> Complex64) -> (Diagnosis, String) {
    let believed = storeys("");
    let frfs = recorded(&storeys(physics), change);
    let diagnosis = Diagnosis::of(&believed, &frfs, &DiagnosisOptions::default()).unwrap();
    let html = rendered(&diagnosis);
    (diagnosis, html)
}

fn rendered(diagnosis: &Diagnosis) -> String {
    let believed = storeys("");
    let context = PageContext {
        program: "jointscope 0.0.0".into(),
        command: "jointscope diagnose storeys.json frf.uff -o out".into(),
        inputs: vec![InputFile { name: "storeys.json".into(), sha256: "ab".repeat(32) }],
        notes: vec!["one remark".into()],
        hits: None,
    };
    let page = || diagnosis_report(diagnosis, &believed, &context).html().unwrap();
    let html = page();
    assert_eq!(html, page(), "the same input, other bytes");
    html
}

fn unchanged(_: usize, _: f64) -> Complex64 {
    Complex64::ONE
}

#[track_caller]
fn holds(html: &str, parts: &[&str]) {
    parts.iter().for_each(|part| assert!(html.contains(part), "`{part}` is missing from the page"));
    for not in ["NaN", "src=\"http", "href=\"http", "<storeys>"] {
        assert!(!html.contains(not), "the page contains {not}");
    }
}

#[test]
fn a_recorded_coherence_stands_below_its_frf_and_lines_without_any_are_marked() {
    let mut frfs = recorded(&storeys(""), unchanged);
    let mut coherence = vec![0.9; 77];
    (coherence[3], coherence[7]) = (0.0, 0.0);
    frfs.set_coherence(0, coherence).unwrap();
    let html = rendered(&Diagnosis::of(&storeys(""), &frfs, &DiagnosisOptions::default()).unwrap());
    let held = "\"held\":[-0.04,1.04]";
    holds(
        &html,
        &["figure class=\"plot strip\"", "Coherence of H 1/1", held, "2 lines are without any and not used"],
    );
    // Above in the magnitudes and in the strip itself.
    assert_eq!(html.matches("no coherence, not used").count(), 2);
    assert_eq!((html.matches(held).count(), html.matches("Coherence of H 2/1").count()), (1, 0));
    assert!(html.contains("[0.9,0.9,0.9,0,0.9"), "the strip shows what was recorded, masked lines too");
}

#[test]
fn a_finding_is_marked_measured_and_judged() {
    let (diagnosis, html) =
        page(r#"{ "kind": "added_mass", "place": "high", "x": 0.18, "mass": 0.6 }"#, unchanged);
    assert_eq!(diagnosis.verdict, Verdict::Explained, "{}", diagnosis.says());
    holds(
        &html,
        &[
            "class=\"verdict attention\"",
            "1. added mass",
            "95 % interval",
            "Probability",
            "Held out, repaired",
        ],
    );
    holds(
        &html,
        &["Measured δ(ω)", "law: −ω²m", "Repaired: χ² per value", "departure, repaired", "bodies/low/mass"],
    );
    holds(&html, &["jointscope diagnose storeys.json", "sha256 abab", "one remark"]);
    // How sure, how much better, what to do; alternative texts say what is marked.
    holds(
        &html,
        &[
            "How probable",
            "Error on lines never fitted",
            "What to do next",
            "look for what weighs that much there",
        ],
    );
    holds(
        &html,
        &[
            "Marked: 1. added mass on high at x = 180.0 mm",
            "Residuals of FRF 1/1",
            "Residual of FRF 2/1, repaired",
            "held out",
        ],
    );
    holds(&html, &["Magnitude. χ² per value (1 is noise): refitted "]);
    // Verdict first, then where, what, how much better.
    let at = |text: &str| html.find(text).unwrap();
    assert!(
        at("class=\"verdict") < at("id=\"at-a-glance\"") && at("id=\"at-a-glance\"") < at("id=\"findings\"")
    );
}

#[test]
fn where_nothing_is_left_out_the_page_says_so_and_shows_no_repaired_model() {
    let (diagnosis, html) = page("", unchanged);
    assert_eq!(diagnosis.verdict, Verdict::Consistent, "{}", diagnosis.says());
    holds(&html, &["class=\"verdict ok\"", "Nothing is left out", "None of the effects tried here"]);
    assert!(!html.contains("Repaired: χ² per value") && !html.contains("Measured δ(ω)"));
}

#[test]
fn a_delay_beside_a_ripple_is_said_not_to_be_all() {
    // The phase grows over the band as a delay's does; what ripples beside it passes for errors in what lies
    // outside the band.
    let odd = |frf: usize, share: f64| match frf {
        0 => Complex64::from_polar(1.0 + 0.2 * (9.0 * share).sin(), 0.6 * share * share),
        _ => Complex64::ONE,
    };
    let (diagnosis, html) = page("", odd);
    assert_ne!(diagnosis.verdict, Verdict::Consistent);
    assert_ne!(diagnosis.verdict, Verdict::Explained, "{}", diagnosis.says());
    assert!(diagnosis.findings.iter().all(|finding| finding.probability < 0.9), "{}", diagnosis.says());
    let all = ["but that is not all", "none of the effects known here accounts"];
    assert!(all.iter().any(|told| html.contains(told)), "{}", diagnosis.says());
}

#[test]
fn a_mismatch_without_a_name_is_shown_by_place_and_band() {
    // A phase that grew over the band would be a delay, by and large.
    let odd = |frf: usize, share: f64| match frf {
        0 => Complex64::from_polar(1.0 + 0.2 * (9.0 * share).sin(), 0.2 * (9.0 * share).cos()),
        _ => Complex64::ONE,
    };
    let (diagnosis, html) = page("", odd);
    assert!(
        matches!(diagnosis.verdict, Verdict::Unexplained | Verdict::PartlyExplained),
        "{}",
        diagnosis.says()
    );
    holds(&html, &["class=\"verdict problem\"", "Refitted within tolerances: χ² per value by FRF and band"]);
}

#[test]
fn where_the_model_is_off_by_more_than_the_noise_its_error_stands_beside_the_usual_one() {
    let (mut diagnosis, html) =
        page(r#"{ "kind": "added_mass", "place": "high", "x": 0.18, "mass": 0.6 }"#, unchanged);
    assert!(!html.contains("Error of the model") && html.contains("χ² gained"));
    let refitted = ModelError { frequency: 0.014, damping: 1e-4, residue: 0.02, ..ModelError::default() };
    let repaired = ModelError { frequency: 0.002, residue: 0.013, ..ModelError::default() };
    diagnosis.model_error = Some([refitted, repaired]);
    let html = rendered(&diagnosis);
    for part in [
        "Error of the model",
        "natural frequency",
        "1.4 %",
        "0.2 %",
        "none seen",
        "1.3 %",
        "1.5 %",
        "Evidence gained",
    ] {
        holds(&html, &[part]);
    }
    for claim in ["down to their noise", "χ² gained", "as noise is"] {
        assert!(!html.contains(claim), "the page says `{claim}`");
    }
}

#[test]
fn the_page_of_a_baseline_shows_both_states_and_their_modes() {
    let believed = storeys("");
    let before = recorded(&believed, unchanged);
    let mass = r#"{ "kind": "added_mass", "place": "high", "x": 0.18, "mass": 0.6 }"#;
    let after = recorded(&storeys(mass), unchanged);
    let options = DiagnosisOptions { baseline: Some(before.clone()), ..DiagnosisOptions::default() };
    let diagnosis = Diagnosis::of(&believed, &after, &options).unwrap();
    let modes = &diagnosis.baseline.as_ref().unwrap().modes;
    let [mode] = modes.as_slice() else { panic!("{modes:?}") };
    // 3.4 MN/m between 6.9 kg and 6.0 kg, then 6.6 kg.
    let hz = |high: f64| (3.4e6 * (1.0 / 6.9 + 1.0 / high)).sqrt() / std::f64::consts::TAU;
    let (was, now) = (mode.baseline.unwrap().frequency, mode.now.unwrap().frequency);
    assert!((was / hz(6.0) - 1.0).abs() < 1e-3, "{was} Hz, then {} Hz", hz(6.0));
    assert!((now / hz(6.6) - 1.0).abs() < 1e-3, "{now} Hz, then {} Hz", hz(6.6));
    let (change, predicted) = (mode.change.unwrap().frequency, mode.predicted.unwrap().frequency);
    assert!((change - (now / was).ln()).abs() < 1e-12 && (predicted / change - 1.0).abs() < 0.1);
    let html = rendered(&diagnosis);
    holds(
        &html,
        &[
            "what has changed since the baseline",
            "Modes, baseline and now",
            "Δf, predicted",
            "Change of FRF 2/1",
            ">baseline</button>",
            ">calibrated</button>",
            ">repaired</button>",
        ],
    );

    let options = DiagnosisOptions { baseline: Some(before.clone()), ..DiagnosisOptions::default() };
    let html = rendered(&Diagnosis::of(&believed, &before, &options).unwrap());
    holds(&html, &["the recording is that of the baseline"]);
    assert!(!html.contains("Δf, predicted") && !html.contains("Change of FRF"));
}

#[test]
fn a_consistent_fixture_off_by_a_usual_error_is_not_called_explained_by_noise() {
    let (mut diagnosis, _) = page("", unchanged);
    let usual = ModelError { frequency: 5e-4, residue: 0.003, ..ModelError::default() };
    diagnosis.model_error = Some([usual, usual]);
    let html = rendered(&diagnosis);
    holds(
        &html,
        &[
            "class=\"verdict ok\"",
            "Nothing is left out that a name would explain",
            "usually off by",
            "0.05 %",
        ],
    );
    for claim in ["leaves is noise", "down to their noise", "repaired"] {
        assert!(!html.contains(claim), "the page says `{claim}`");
    }
}

#[test]
fn a_quantity_far_from_what_is_stated_takes_the_green_tick_away() {
    let (mut diagnosis, html) = page("", unchanged);
    assert!(!html.contains("Departures from what is stated"));
    diagnosis.departures = vec![Departure {
        path: "bodies/low/mass".into(),
        stated: 6.9,
        std: 0.007,
        refitted: 6.97,
        repaired: 6.97,
        deviations: 10.0,
    }];
    diagnosis.verdict = Verdict::Unexplained;
    let html = rendered(&diagnosis);
    holds(
        &html,
        &["class=\"verdict attention\"", "Departures from what is stated", "6.9000 ± 0.0070 kg", "6.970 kg"],
    );
    assert!(!html.contains("class=\"verdict ok\""));
}
