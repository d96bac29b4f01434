//! What the page of a decomposition must say, and what it must not hide.

use jointscope_averaging::Band;
use jointscope_decomposition::{Analysis, AnalysisOptions, DecompositionError, Judgement, Method, Relation};
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_report::format::quantity;
use jointscope_report::{InputFile, PageContext, decomposition_report};
use jointscope_samples::{Noise, TWO_STOREYS, transverse};
use jointscope_spectra::{FrfSet, SpectralLines};
use jointscope_wording::Says;
use num_complex::Complex64;

const PAIRS: [(&str, &str); 5] = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2"), ("1", "1")];

fn blocks(extra: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "name": "two blocks",
             "bodies": {{ "A": {{ "mass": 1.10, "inertia": 9.2e-4, "x_cg": -0.05 }},
                          "B": {{ "mass": 1.20, "inertia": 8.1e-4, "x_cg": 0.11 }} }},
             "points": {{ "1": {{ "body": "A", "x": -0.085 }}, "2": {{ "body": "A", "x": 0 }},
                          "3": {{ "body": "B", "x": 0.065 }}, "4": {{ "body": "B", "x": 0.15 }} }},
             "joints": {{ "J": {{ "from": "2", "to": "3",
                          "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }},
             "damping": {{ "modal_ratios": [0.004, 0.006] }} {extra} }}"#
    ))
    .unwrap()
}

/// FRFs of a fixture with half a per cent of noise, always the same.
fn recorded(fixture: &Fixture, pairs: &[(&str, &str)]) -> FrfSet {
    recorded_on(fixture, pairs, SpectralLines::even(0.0, 2.5, 401).unwrap())
}

fn recorded_on(fixture: &Fixture, pairs: &[(&str, &str)], lines: SpectralLines) -> FrfSet {
    let pairs = transverse(pairs);
    let frfs = synthesize(fixture, &pairs, &lines, Instrument::AsRecorded).unwrap();
    let mut noise = Noise::from_state(1);
    let mut uniform = || noise.uniform() - 0.5;
    let mut variance = Vec::new();
    let values = frfs
        .all_values()
        .iter()
        .map(|value| {
            let std = 0.005 * value.norm().max(1e-3);
            variance.push(std * std);
            // A uniform number on (−½, ½) has variance 1/12, and each part half of the whole.
            value + Complex64::new(uniform(), uniform()) * (6.0_f64.sqrt() * std)
        })
        .collect();
    FrfSet::new(lines, frfs.form(), pairs, values).unwrap().with_variance(variance).unwrap()
}

fn analysis(fixture: &Fixture, frfs: &FrfSet, relation: Relation) -> Analysis {
    let options = AnalysisOptions {
        relation,
        band: Some(Band { from: 450.0, to: 800.0 }),
        ..AnalysisOptions::default()
    };
    Analysis::of(fixture, frfs, &options).unwrap()
}

fn two_blocks(relation: Relation) -> (Fixture, Analysis) {
    let fixture = blocks("");
    let analysis = analysis(&fixture, &recorded(&fixture, &PAIRS), relation);
    (fixture, analysis)
}

fn context() -> PageContext {
    PageContext {
        program: "jointscope 9.8.7".into(),
        command: "jointscope decompose rig.json hits.uff -o out".into(),
        inputs: vec![
            InputFile { name: "rig.json".into(), sha256: "5f0c91aa".into() },
            InputFile { name: "hits </script>.uff".into(), sha256: "c3ab07d2".into() },
        ],
        notes: vec!["1 FRF at nodes that the fixture does not have left out: 9/1".into()],
        hits: None,
    }
}

fn page(fixture: &Fixture, analysis: &Analysis) -> String {
    // Apostrophes are escaped in text; the sentences below read better without.
    decomposition_report(analysis, fixture, &context()).html().unwrap().replace("&#39;", "'")
}

/// The JSON from which the plots are drawn.
fn plots(html: &str) -> serde_json::Value {
    let start = html.find("id=\"plot-data\">").unwrap() + 15;
    let end = start + html[start..].find("</script>").unwrap();
    serde_json::from_str(&html[start..end]).unwrap()
}

#[test]
fn the_headline_states_the_stiffness_with_noise_and_tolerance_together() {
    let (fixture, analysis) = two_blocks(Relation::Exact);
    let fit = analysis.joint_fit.as_ref().unwrap();
    let value = quantity(fit.stiffness.at(0, 0), fit.std().0.at(0, 0), "N/m");
    let html = page(&fixture, &analysis);
    let headline = format!("Joint J: k₁₁ = {value}, as the nominal beam's within uncertainty.");
    assert!(html.contains(&headline), "{headline}");
    assert!(html.contains("<div class=\"verdict ok\">"));
}

#[test]
fn figures_of_all_four_estimates_and_the_nominal_stand_in_one_table() {
    let (fixture, analysis) = two_blocks(Relation::Exact);
    let html = page(&fixture, &analysis);
    for heading in ["Plain mean (eq 35, 42)", "Weighted mean", "FRFs across", "All FRFs", "Nominal"] {
        assert!(html.contains(heading), "{heading}");
    }
    for unit in ["MN/m", "kN/rad", "kN·m/m", "kN·m/rad", "N·s/m", "N·s/rad", "N·s<", "N·m·s/rad"] {
        assert!(html.contains(unit), "{unit}");
    }
}

#[test]
fn a_joint_softer_than_its_beam_is_said_so_in_per_cent() {
    let truth = blocks("");
    let frfs = recorded(&truth, &PAIRS);
    let json = truth.to_json().replace("207000000000", "414000000000");
    let stiffer = Fixture::from_json(&json).unwrap();
    assert_ne!(stiffer, truth, "the modulus is in the file as expected");
    let html = page(&stiffer, &analysis(&stiffer, &frfs, Relation::Exact));
    assert!(html.contains("MN/m, 50 % of the nominal beam's"));
    assert!(html.contains("<div class=\"verdict attention\">"));
}

#[test]
fn masked_lines_are_gaps_in_every_curve_and_their_reasons_are_listed() {
    let (fixture, analysis) = two_blocks(Relation::Exact);
    assert_eq!(analysis.spectrum.masked.len(), 1);
    let html = page(&fixture, &analysis);
    assert!(html.contains("no displacement at 0 Hz"));
    assert!(html.contains("1 of 401 lines was masked"));
    let data = plots(&html);
    let first = &data["plots"][0];
    let table = first["tables"][0].as_array().unwrap();
    for (series, described) in first["series"].as_array().unwrap().iter().enumerate() {
        for place in described["places"].as_array().unwrap() {
            let column = table[place.as_u64().unwrap() as usize].as_u64().unwrap() as usize;
            assert!(data["columns"][column][0].is_null(), "series {series} at 0 Hz");
        }
    }
}

#[test]
fn frfs_that_do_not_cross_the_joint_and_remarks_of_the_reading_are_listed() {
    let (fixture, analysis) = two_blocks(Relation::Exact);
    let html = page(&fixture, &analysis);
    assert!(html.contains(
        "1 FRF does not cross the joint between the two blocks and is not part of K and C by line: 1/1."
    ));
    assert!(html.contains("1 FRF at nodes that the fixture does not have left out: 9/1"));
}

#[test]
fn the_foot_names_program_command_and_files_with_their_hashes() {
    let (fixture, analysis) = two_blocks(Relation::Exact);
    let html = page(&fixture, &analysis);
    for text in ["jointscope 9.8.7", "jointscope decompose rig.json", "sha256 5f0c91aa", "sha256 c3ab07d2"] {
        assert!(html.contains(text), "{text}");
    }
}

#[test]
fn the_page_refers_to_nothing_outside_and_keeps_foreign_names_as_text() {
    let (fixture, analysis) = two_blocks(Relation::Exact);
    let html = page(&fixture, &analysis);
    for reference in ["src=\"http", "href=\"http", "url(", "@import", "hits </script>"] {
        assert!(!html.contains(reference), "{reference}");
    }
    assert!(html.contains("default-src 'none'"));
}

#[test]
fn the_same_analysis_gives_the_same_bytes() {
    let (fixture, first) = two_blocks(Relation::Exact);
    let (_, second) = two_blocks(Relation::Exact);
    assert_eq!(page(&fixture, &first), page(&fixture, &second));
}

#[test]
fn four_hundred_lines_stay_below_seven_hundred_kilobytes() {
    let (fixture, analysis) = two_blocks(Relation::Exact);
    let size = page(&fixture, &analysis).len();
    assert!(size < 700_000, "{size} bytes");
}

#[test]
fn four_thousand_lines_stay_below_three_megabytes_and_exact_fixtures_have_no_tolerances() {
    let fixture = blocks("");
    let frfs = recorded_on(&fixture, &PAIRS, SpectralLines::even(0.25, 0.25, 4000).unwrap());
    let options = AnalysisOptions { exact: true, ..AnalysisOptions::default() };
    let html = page(&fixture, &Analysis::of(&fixture, &frfs, &options).unwrap());
    assert!(html.len() < 3_000_000, "{} bytes", html.len());
    assert!(html.contains("No quantity of the fixture has a tolerance"));
}

#[test]
fn bodies_that_do_not_rotate_show_one_element_and_no_interfaces() {
    let fixture = Fixture::from_json(TWO_STOREYS).unwrap();
    let analysis = analysis(&fixture, &recorded(&fixture, &[("2", "1")]), Relation::Exact);
    let html = page(&fixture, &analysis);
    assert!(html.contains("k₁₁") && !html.contains("k₁₂") && !html.contains("k₂₂"));
    assert!(!html.contains(">Interfaces<") && !html.contains(">Interfaces by line<"));
    assert!(html.contains("as the fixture's within uncertainty"));
}

#[test]
fn without_a_fit_the_means_are_stated_with_the_reason() {
    let (fixture, mut analysis) = two_blocks(Relation::Exact);
    let error = || DecompositionError::NoFit("the FRFs leave an element of k or c undetermined");
    (analysis.likelihood, analysis.joint_fit) = (Err(error()), Err(error()));
    analysis.interfaces = None;
    analysis.judgement = Judgement::of(&analysis, &fixture);
    let html = page(&fixture, &analysis);
    assert!(html.contains("<div class=\"verdict problem\">"));
    assert!(html.contains("did not converge: the FRFs leave an element of k or c undetermined"));
    assert!(html.contains("a mean over the band"));
    assert!(!html.contains("<th scope=\"col\" class=\"number\">FRFs across"));
}

#[test]
fn eq_7_is_said_to_leave_out_the_transport_and_the_fit_to_be_the_exact_joint() {
    let (fixture, analysis) = two_blocks(Relation::Paper);
    let html = page(&fixture, &analysis);
    assert!(html.contains("It leaves out the transport"));
    assert!(html.contains("Signs are those of eq (7)"));
    assert!(html.contains("K₂₁ and K₂₂ are negative"));
    assert!(html.contains("(exact joint, all FRFs)"));
    assert!(html.contains("K₁₁") && html.contains("k₁₁"));
    assert!(html.contains("not eq 7"));
}

#[test]
fn a_fit_that_contradicts_the_means_is_not_to_be_used() {
    // The sensor at 4 is wired the wrong way round, which no joint can imitate.
    let fixture = blocks("");
    let frfs = recorded(&fixture, &PAIRS);
    let n = frfs.lines().len();
    let mut values = frfs.all_values().to_vec();
    for (index, pair) in frfs.pairs().iter().enumerate() {
        if pair.response.point == "4" {
            values[index * n..(index + 1) * n].iter_mut().for_each(|value| *value = -*value);
        }
    }
    let variance: Vec<f64> =
        (0..frfs.pairs().len()).flat_map(|i| frfs.variance(i).unwrap().to_vec()).collect();
    let wrong = FrfSet::new(frfs.lines().clone(), frfs.form(), frfs.pairs().to_vec(), values)
        .unwrap()
        .with_variance(variance)
        .unwrap();
    let html = page(&fixture, &analysis(&fixture, &wrong, Relation::Exact));
    assert!(html.contains("<div class=\"verdict problem\">"));
    assert!(
        html.contains("no constant k and c fits these FRFs") || html.contains("this test does not determine")
    );
    assert!(html.contains("Noise and tolerances do not explain the FRFs"));
}

#[test]
fn laws_tests_and_quantities_of_the_joint_from_all_frfs_have_a_section_of_their_own() {
    let fixture = blocks("");
    let frfs = recorded(&fixture, &PAIRS);
    let options = AnalysisOptions { laws: true, ..AnalysisOptions::default() };
    let analysis = Analysis::of(&fixture, &frfs, &options).unwrap();
    let html = page(&fixture, &analysis);
    let best = analysis.joint_fit.as_ref().unwrap().law().unwrap().says();
    let said = ["The joint from all FRFs", "(reciprocal)", "gives out no energy", "bodies/A/mass", &best];
    for text in said {
        assert!(html.to_lowercase().contains(&text.to_lowercase()), "{text}");
    }
}

#[test]
fn where_only_the_fit_across_the_joint_succeeds_the_page_states_that() {
    let (fixture, mut analysis) = two_blocks(Relation::Exact);
    analysis.joint_fit = Err(DecompositionError::NoFit("no start gives finite FRFs"));
    analysis.judgement = Judgement::of(&analysis, &fixture);
    let html = page(&fixture, &analysis);
    assert!(
        html.contains("Maximum likelihood by the exact relation")
            && !html.contains("The joint from all FRFs")
    );
}

#[test]
fn surplus_frfs_that_contradict_each_other_are_reported_as_blocks_that_bend() {
    // A fifth place, said to lie elsewhere than it does.
    let measured = blocks("");
    let pairs = [("4", "1"), ("3", "1"), ("5", "1"), ("4", "2"), ("3", "2"), ("5", "2")];
    let with_five = |x: &str| {
        let json = measured.to_json();
        let value: serde_json::Value = serde_json::from_str(&json).unwrap();
        let mut value = value;
        value["points"]["5"] = serde_json::json!({ "body": "B", "x": x.parse::<f64>().unwrap() });
        Fixture::from_value(&value).unwrap()
    };
    let frfs = recorded(&with_five("0.11"), &pairs);
    let believed = with_five("0.12");
    let html = page(&believed, &analysis(&believed, &frfs, Relation::Exact));
    assert!(html.contains("The blocks did not move rigidly"));
}

#[test]
fn over_lines_that_hold_the_joints_mass_the_law_is_drawn_with_it_and_no_level_or_contradiction_is_taken_from_them()
 {
    let fixture = blocks("");
    let frfs = recorded(&fixture, &PAIRS);
    let mut analysis = analysis(&fixture, &frfs, Relation::Exact);
    // A fit a quarter softer than the lines: a contradiction, unless the joint has a mass.
    let fit = analysis.joint_fit.as_mut().unwrap();
    fit.stiffness = fit.stiffness.scale(0.75);
    let light = Judgement::of(&analysis, &fixture);
    assert!(light.contradiction.is_some());
    let level = ">all FRFs</button>";
    assert!(page(&fixture, &analysis).contains(level), "drawn for a joint without mass");
    analysis.joint_fit.as_mut().unwrap().mass = Some((0.08, 0.001));
    analysis.judgement = Judgement::of(&analysis, &fixture);
    assert!(analysis.judgement.contradiction.is_none());
    let html = page(&fixture, &analysis);
    assert!(html.contains("they hold its inertia and are no stiffness of the joint alone"));
    assert!(!html.contains(level) && html.contains("law from all FRFs"));
    // Without a mass the law is the fitted k on every line; with one it is far from it on low lines, where
    // both blocks move as one and a joint's mass counts with theirs.
    let k11 = |analysis: &Analysis, line: usize| analysis.fitted_at(line).unwrap().0.at(0, 0);
    let (low, high) = (10, analysis.spectrum.h41.lines.len() - 1);
    let heavy = [low, high].map(|line| k11(&analysis, line));
    analysis.joint_fit.as_mut().unwrap().mass = None;
    let light = [low, high].map(|line| k11(&analysis, line));
    assert!((light[0] / light[1] - 1.0).abs() < 1e-6, "{light:?}");
    let off = [0, 1].map(|line| (heavy[line] / light[line] - 1.0).abs());
    assert!(off[0] > 0.5 && off[1] < 0.05, "{heavy:?} {light:?}");
}

#[test]
fn tolerances_are_said_to_be_those_of_the_fit_across_and_none_only_where_there_is_none() {
    let (fixture, mut analysis) = two_blocks(Relation::Exact);
    assert!(
        page(&fixture, &analysis)
            .contains("By how much the fit to the FRFs across the joint, the fixture as stated, moves")
    );
    analysis.tolerances.iter_mut().for_each(|share| share.likelihood = None);
    let html = page(&fixture, &analysis);
    assert!(!html.contains("No quantity of the fixture has a tolerance"));
    analysis.tolerances.clear();
    assert!(page(&fixture, &analysis).contains("No quantity of the fixture has a tolerance"));
}

#[test]
fn a_fixture_without_tolerances_is_said_to_be_taken_as_exact() {
    let (fixture, mut analysis) = two_blocks(Relation::Exact);
    assert!(page(&fixture, &analysis).contains("moving within"));
    analysis.joint_fit.as_mut().unwrap().quantities.clear();
    let html = page(&fixture, &analysis);
    assert!(html.contains("the fixture taken as exact") && !html.contains("moving within"));
}

#[test]
fn interfaces_name_their_fit_and_are_marked_where_none_explains_the_frfs() {
    let (fixture, mut analysis) = two_blocks(Relation::Exact);
    assert_eq!(analysis.interfaces_rest_on(), Some((Method::AllFrfs, true)));
    let marked = "No fit explains these FRFs within noise and tolerances";
    let html = page(&fixture, &analysis);
    assert!(html.contains("by the stiffness of the joint from all FRFs") && !html.contains(marked));
    analysis.joint_fit.as_mut().unwrap().inflation = 30.0;
    analysis.likelihood.as_mut().unwrap().chi2_per_dof = 75.0;
    assert!(page(&fixture, &analysis).contains(marked));
}

/// Two blocks with glue at both ends of their beam, weighed and measured well, in low noise.
fn glued(stiffness: f64) -> (Fixture, Analysis) {
    let glue = |point: &str| {
        format!(
            r#"{{ "kind": "interface_compliance", "place": "{point}", "dof": "rotation", "stiffness": {stiffness}, "damping": 0.05 }}"#
        )
    };
    let fixture = blocks("");
    let built = blocks(&format!(r#", "physics": [{}, {}]"#, glue("2"), glue("3")));
    let lines = SpectralLines::even(0.0, 2.5, 401).unwrap();
    let frfs = synthesize(&built, &transverse(&PAIRS), &lines, Instrument::AsRecorded).unwrap();
    let options = AnalysisOptions { exact: true, ..AnalysisOptions::default() };
    let analysis = Analysis::of(&fixture, &Noise::new(3).on(&frfs, 1e-4), &options).unwrap();
    (fixture, analysis)
}

#[test]
fn interfaces_are_drawn_by_line_beside_their_number_and_lines_without_one_are_counted() {
    let (fixture, analysis) = glued(3e3);
    let found = analysis.interface_spectrum.as_ref().unwrap();
    let html = page(&fixture, &analysis);
    let masked = found.masked.len();
    assert!(masked > 0 && found.lines.len() + masked == 401, "{masked}");
    assert!(html.contains(&format!("{} of 401 lines have a D; the others are masked: ", found.lines.len())));
    assert!(html.contains("no displacement at 0 Hz (1)"));
    let told = |of: usize| found.lines.len() - found.within_noise()[of];
    assert!(told(1) > 100, "{:?}", found.within_noise());
    assert!(html.contains(&format!("rotation at 2 on {}, rotation at 3 on {}", told(1), told(2))));
    for title in ["K, rotation at 2", "C, rotation at 3", "Real part of the compliance, rotation at 2"] {
        assert!(html.contains(title), "{title}");
    }
    assert!(html.contains("at rest, as tabled"));
}

#[test]
fn interfaces_of_which_no_line_tells_a_stiffness_are_named() {
    let (fixture, analysis) = glued(1e9);
    let html = page(&fixture, &analysis);
    assert!(html.contains("No line by itself tells a stiffness of: "));
    assert!(
        !html.contains("K, rotation at 2") && html.contains("Real part of the compliance, rotation at 2")
    );
}
