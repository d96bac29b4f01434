//! Pages in a browser: plots drawn, nothing complained of, names that are text whatever they hold, nothing
//! lost on paper or in a narrow window.

use serde_json::{Value, json};

use super::browser::opened;
use crate::common::{Bench, TWO_BLOCKS};
use crate::{hits, levels};
use jointscope_samples::{TWO_STOREYS, with};

/// What a script would do to the page if the name were markup.
const HOSTILE: &str =
    "<img src=x onerror=document.title='taken'></script><script>document.title='taken'</script>";

/// The same as the name of a folder, for which there are characters that will not do.
const HOSTILE_FOLDER: &str = if cfg!(unix) { "<img src=x onerror=document.title='taken'>" } else { "b & c" };

/// A fixture with these of its names hostile.
fn hostile(fixture: &str, names: &[&str]) -> String {
    let hostile = json!(HOSTILE).to_string();
    names.iter().fold(fixture.to_owned(), |text, name| {
        let name = json!(name).to_string();
        assert!(text.contains(&name), "{name}");
        text.replace(&name, &hostile)
    })
}

/// Demands of every page that nothing is complained of, no name is taken for markup, every plot is drawn, the
/// policy is in force, a narrow window is wide enough, and a sheet of paper holds everything; then that the
/// page has plots where it is said to.
#[track_caller]
pub(crate) fn sound(bench: &Bench, pages: &[(&str, bool)]) {
    let paths: Vec<&str> = pages.iter().map(|(page, _)| *page).collect();
    let Some(seen) = opened(bench, &paths, include_str!("look.js")) else { return };
    assert_eq!(seen.console, Vec::<String>::new());
    assert_eq!(seen.pages.len(), pages.len());
    for ((path, has_plots), page) in pages.iter().zip(&seen.pages) {
        let count = |what: &str| page[what].as_u64().unwrap();
        assert!(page["title"] != "taken" && count("images") == 0 && count("foot") == 1, "{path}: {page}");
        assert_eq!(count("plots") > 0, *has_plots, "{path}: {page}");
        assert_eq!(page["undrawn"], json!([]), "{path}");
        // The library and what draws with it; the data beside them are no script.
        assert_eq!(count("scripts"), if *has_plots { 2 } else { 0 }, "{path}");
        assert_policy(path, page);
        assert_eq!(count("narrow"), 390, "{path}: the page is wider than its window");
        assert_eq!(count("rules"), 1, "{path}: one part of the style sheet is for paper");
        assert_eq!(page["lost"], json!([]), "{path}: lost on paper");
    }
}

/// Scripts are told by their hashes and by nothing else, and what is not spoken of is forbidden.
#[track_caller]
fn assert_policy(path: &str, page: &Value) {
    let policy = page["policy"].as_str().unwrap();
    let scripts = policy.split("; ").find_map(|rule| rule.strip_prefix("script-src ")).unwrap();
    let told = |source: &str| source == "'none'" || source.starts_with("'sha256-");
    assert!(scripts.split(' ').all(told) && policy.starts_with("default-src 'none'; "), "{path}: {policy}");
}

#[test]
fn what_a_page_should_not_show_is_seen() {
    let bench = Bench::new("pages-spoilt");
    let table = "<div class=table><table><tr><td style='min-width:900px'>first<td>last</table></div>";
    let hidden = "<p style='overflow:hidden;white-space:nowrap'>".to_owned() + &"far ".repeat(300) + "</p>";
    let spoilt = format!(
        "<!DOCTYPE html><style>@media print {{ .table {{ overflow: visible }} }} @media screen {{ .table {{ overflow-x: auto }} }}</style>\
         <main>{table}{hidden}<img alt=''><div class=drawing></div></main><script>console.error('wrong'); document.title = 'taken'</script>"
    );
    bench.write("spoilt.html", spoilt);
    let Some(seen) = opened(&bench, &["spoilt.html"], include_str!("look.js")) else { return };
    assert!(
        !seen.console.is_empty() && seen.console.iter().all(|line| line.contains("wrong")),
        "{:?}",
        seen.console
    );
    let page = &seen.pages[0];
    let [title, policy, undrawn] = ["title", "policy", "undrawn"].map(|what| &page[what]);
    assert!(title == "taken" && policy.is_null() && undrawn.as_array().unwrap().len() == 1, "{page}");
    assert_eq!((page["images"].as_u64(), page["scripts"].as_u64()), (Some(1), Some(1)));
    let lost = page["lost"].to_string();
    assert!(lost.contains("TD : last") && lost.contains("P : far"), "{lost}");
}

#[test]
fn a_browser_draws_a_joint_a_check_and_modes_without_a_complaint_and_takes_no_name_for_markup() {
    let fixture = hostile(TWO_BLOCKS, &["two blocks and a beam", "J", "A"]);
    let bench = Bench::synthesized("pages-hostile", &fixture, "50:1000:10");
    bench.done(&["decompose", "two.json", "frf.uff", "-o", "joint"]);
    bench.done(&["check", "two.json", "frf.uff", "-o", "checked"]);
    bench.done(&["modes", "frf.uff", "--fixture", "two.json", "-o", "modes"]);
    sound(&bench, &[("joint/report.html", true), ("checked/report.html", true), ("modes/report.html", true)]);
}

/// Two storeys with hostile names, FRFs of them with noise, `before.uff`, and of the same with a mass that
/// nobody has stated, `after.uff`.
fn storeys(name: &str) -> Bench {
    let bench = Bench::new(name);
    let mass = r#""physics": [{ "kind": "added_mass", "place": "high", "x": 0.18, "mass": 0.6 }]"#;
    let names = ["two storeys", "high", "C"];
    bench.write("storeys.json", hostile(TWO_STOREYS, &names));
    bench.write("truth.json", hostile(&with(TWO_STOREYS, mass), &names));
    for (fixture, recording) in [("storeys.json", "before.uff"), ("truth.json", "after.uff")] {
        let frfs = ["--frf", "1/1", "2/1", "--lines", "20:400:4", "--noise", "0.5", "-o", recording];
        bench.done(&[&["synthesize", fixture][..], &frfs].concat());
    }
    bench
}

#[test]
fn a_browser_draws_a_diagnosis_two_states_and_plans_without_a_complaint_and_takes_no_name_for_markup() {
    let bench = storeys("pages-diagnosis");
    bench.done(&["diagnose", "storeys.json", "after.uff", "-o", "found"]);
    assert_eq!(bench.json("found/diagnosis.json")["findings"][0]["place"], HOSTILE);
    bench.done(&["diagnose", "storeys.json", "after.uff", "--baseline", "before.uff", "-o", "states"]);
    bench.done(&["plan", "storeys.json", "found", "-o", "next"]);
    let interval = format!("{HOSTILE}/k11=1%");
    bench.done(&["plan", "storeys.json", "after.uff", "--interval", &interval, "-o", "narrower"]);
    let pages = [
        ("found/report.html", true),
        ("states/report.html", true),
        ("next/plan.html", false),
        ("narrower/plan.html", false),
    ];
    sound(&bench, &pages);
}

#[test]
fn a_browser_draws_joints_side_by_side_without_a_complaint_and_takes_no_name_for_markup() {
    let bench = storeys("pages-compared");
    bench.done(&["decompose", "storeys.json", "before.uff", "-o", "a"]);
    bench.done(&["decompose", "storeys.json", "after.uff", "-o", HOSTILE_FOLDER]);
    bench.done(&["compare", "a", HOSTILE_FOLDER, "-o", "compared"]);
    let said = ["--as", "sim=a", "--as", &format!("exp={HOSTILE_FOLDER}"), "-o", "models"];
    bench.done(&[&["compare"][..], &said].concat());
    let kind = format!("<img src>=a,{HOSTILE_FOLDER}");
    bench.done(&["compare", "--specimens", &kind, "-o", "specimens"]);
    let pages = ["compared", "models", "specimens"].map(|folder| format!("{folder}/report.html"));
    sound(&bench, &pages.each_ref().map(|page| (page.as_str(), true)));
}

#[test]
fn a_browser_shows_many_cases_without_a_complaint_and_takes_no_name_for_markup() {
    let bench = storeys("pages-many");
    for case in ["all/a", &format!("all/{HOSTILE_FOLDER}"), "all/refused"] {
        std::fs::create_dir_all(bench.0.join(case)).unwrap();
        bench.write(&format!("{case}/storeys.json"), bench.text("storeys.json"));
        std::fs::copy(bench.0.join("after.uff"), bench.0.join(case).join("test.uff")).unwrap();
    }
    bench.write("all/refused/test.uff", HOSTILE);
    for (command, folder) in [("diagnose", "found"), ("decompose", "joints")] {
        assert_eq!(bench.run(&[command, "all", "-o", folder]).status.code(), Some(1), "a case is refused");
    }
    let of_case = format!("joints/{HOSTILE_FOLDER}/report.html");
    sound(&bench, &[("found/summary.html", false), ("joints/summary.html", false), (&of_case, true)]);
}

#[test]
fn a_browser_draws_what_depends_on_amplitude_without_a_complaint_and_takes_no_name_for_markup() {
    let bench = levels::bench("pages-levels", levels::CUBIC, &[10.0, 30.0, 50.0, 80.0]);
    bench.write("storeys.json", hostile(levels::STOREYS, &["two storeys", "high", "C"]));
    bench.done(&levels::DIAGNOSE);
    assert!(bench.text("out/report.html").contains("Frequency and damping against amplitude"));
    sound(&bench, &[("out/report.html", true)]);

    let bench = hits::recorded("pages-hits", hits::CUBIC, &[40.0, 41.0, 150.0, 153.0, 500.0, 490.0]);
    bench.write("plain.json", hostile(&hits::fixture(""), &["two blocks and a beam", "J", "A"]));
    bench.done(&["diagnose", "plain.json", "hits.uff", "-o", "out"]);
    assert!(bench.text("out/report.html").contains("Force against motion, as measured"));
    sound(&bench, &[("out/report.html", true)]);
}

#[test]
fn a_browser_draws_a_proof_and_the_page_of_a_case_without_a_complaint() {
    let bench = Bench::new("pages-proof");
    // Case 1 hides nothing: the quickest to diagnose.
    let case = ["prove", "--cases", "8", "--seed", "3", "--only", "1", "--family", "two-blocks"];
    let output = bench.run(&[&case[..], &["-o", "proof"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    sound(&bench, &[("proof/report.html", false), ("proof/cases/001/report.html", true)]);
}
