//! The page of a proof.

use jointscope_proof::{Answers, Family, Judged, Methods, NoAnswer, Plan, RouteScores, Score};
use jointscope_report::{ProofContext, ProofResults, proof_page};

fn judged() -> Vec<Judged> {
    let plan = Plan { cases: 8, seed: 2, families: vec![Family::TwoBlocks], ..Plan::default() };
    let (cases, sealed) = plan.draw().unwrap();
    let silent = Answers::by(&cases, 1, |_| (), |_| Err(NoAnswer::BrokeDown));
    let truths = sealed.open(&silent).unwrap();
    Judged::all(&cases, truths, &silent, 1, |_| ())
}

fn page(judged: &[Judged], pages: bool) -> String {
    let context = ProofContext {
        program: "jointscope 0.1.0".into(),
        command: "jointscope prove -o <out>".into(),
        cases: "8 cases".into(),
        sealed: "ab".repeat(32),
        pages,
    };
    let (score, methods) = (Score::of(judged), Methods::default());
    let routes = RouteScores::default();
    proof_page(&ProofResults { score: &score, methods: &methods, judged, routes: &routes }, &context).unwrap()
}

#[test]
fn the_page_says_what_was_sealed_lists_every_case_and_loads_nothing() {
    let judged = judged();
    let html = page(&judged, true);
    assert!(html.contains(&"ab".repeat(32)) && html.contains("jointscope prove -o &lt;out&gt;"));
    for case in &judged {
        let hidden = case.truth.hidden();
        assert!(html.contains(&format!("<td>{hidden}</td>")), "{hidden}");
    }
    assert!(html.contains("default-src 'none'") && !html.contains("href=\"http"));
    assert_eq!(html, page(&judged, true), "the same input gives the same bytes");
}

#[test]
fn who_answers_nothing_gets_no_verdict_of_success_and_no_links() {
    let html = page(&judged(), true);
    assert!(html.contains("class=\"verdict attention\""), "nulls that nobody called consistent");
    assert!(
        html.contains("no answer") && !html.contains("href=\"./cases"),
        "a case without an answer has no page"
    );
}

#[test]
fn a_proof_of_nothing_is_a_page_too() {
    let html = page(&[], false);
    assert!(html.contains("no case"), "{}", &html[html.len() - 200..]);
}
