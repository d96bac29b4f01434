//! The page of the proof: what the diagnosis is worth on concealed cases, for a reader who does not believe
//! it.

mod calibration;
mod cases;
mod cells;
mod context;
mod detection;
mod methods;
mod routes;
mod scores;

pub use context::ProofContext;

use jointscope_proof::{Judged, Methods, Rate, Role, RouteScores, Score};

use crate::error::PageError;
use crate::page::Page;
use crate::section::{Section, Verdict};
use crate::tone::Tone;
use cells::counted;

/// What the page shows.
#[derive(Debug, Clone, Copy)]
pub struct ProofResults<'a> {
    /// The scores.
    pub score: &'a Score,
    /// The diagnosis beside the baselines.
    pub methods: &'a Methods,
    /// Every case of the laboratory with its truth and its answer.
    pub judged: &'a [Judged],
    /// The scores of the other routes.
    pub routes: &'a RouteScores,
}

/// The page of a proof as one self-contained HTML file: the verdict in a sentence; scores with their targets;
/// the diagnosis beside what people do today; detection against size; which kind was taken for which; whether
/// probabilities and intervals mean what they say; every case with what was hidden and what was found, and a
/// way to its own page.
///
/// The same input gives the same bytes.
///
/// # Errors
/// Results whose lists do not fit each other.
pub fn proof_page(results: &ProofResults, context: &ProofContext) -> Result<String, PageError> {
    let of_the_laboratory = (!is_left_out(results)).then(|| {
        [
            scores::section(results.score),
            methods::section(results.methods),
            detection::section(&results.score.detection),
            detection::confusion(&results.score.confusion),
            calibration::section(results.score),
            cases::section(results.judged, context),
        ]
    });
    Page::new("Proof: what the diagnosis is worth")
        .subtitle(&context.cases)
        .verdict(verdict(results))
        .foot(&context.program, &context.command, &[])
        .sections(of_the_laboratory.into_iter().flatten())
        .sections(results.routes.0.iter().map(|route| routes::section(route, context)))
        .sections([seal(context)])
        .to_html()
}

/// Whether other routes alone were asked for.
fn is_left_out(results: &ProofResults) -> bool {
    results.judged.is_empty() && !results.routes.0.is_empty()
}

fn verdict(results: &ProofResults) -> Verdict {
    let ProofResults { score, methods, .. } = results;
    let share = |key: &str| score.rate(key).map(|rate| rate.share).unwrap_or_default();
    let (named, alarms) = (share("single_place"), share("null_finding"));
    let wrong = share("outside_wrong_name");
    let is_missed = |rate: &&Rate| rate.status() == Some(jointscope_proof::TargetStatus::Missed);
    let rates = score.rates.iter().chain(results.routes.0.iter().flat_map(|route| &route.rates));
    let missed: Vec<&str> = rates.filter(is_missed).map(|rate| rate.what).collect();
    let tone = if missed.is_empty() { Tone::Ok } else { Tone::Attention };
    let headline = match is_left_out(results) {
        true => "The laboratory's own FRFs were left out: what follows are cases by other routes.".to_owned(),
        false => format!(
            "Hidden effects that show were given their right names in {}; something was found in {} where nothing was hidden; \
             unknown physics got a wrong name with certainty in {}.",
            counted(named),
            counted(alarms),
            counted(wrong)
        ),
    };
    let lookup = methods.0.iter().find(|method| method.key == "nearest_signature").and_then(|m| m.named);
    let lookup = lookup.filter(|share| share.all > 0).map(|share| {
        format!(
            "On the same cases the nearest of a library of simulated signatures has the right name in {}.",
            counted(share)
        )
    });
    let targets = match missed.len() {
        0 => "No target is missed beyond chance; where there are few cases that says little, and the intervals say how little.".to_owned(),
        _ => format!("Missed beyond chance: {}.", missed.join("; ")),
    };
    let routes = results.routes.0.iter().map(routes::sentence);
    Verdict { tone, headline, details: lookup.into_iter().chain(routes).chain([targets]).collect() }
}

fn seal(context: &ProofContext) -> Section {
    Section::new("What was sealed when")
        .paragraph(
            "The diagnosis is handed a fixture and a recording, nothing else. What is true of the cases was put under seal first: the SHA-256 \
             of the truths was printed, and written to seal.json, before the first diagnosis began. All answers were written to answers.json \
             before the truths were opened, and then everything above was counted. Truths, names, objectives and faults of every case are in \
             proof.json; what the baselines made of them is in baselines.json; the seconds, which differ from machine to machine, are in timing.json.",
        )
        .command(&format!("sha256 {}", context.sealed))
        .paragraph(
            "Recordings come from a simulated laboratory that shares no code with the diagnosis or its model; those of other routes from where their \
             sections say. A name counts as right if it is the \
             hidden one, or if its best fit comes as near to the recording as a fit from the truth does, within 9 in χ²: no test could tell the two apart. An effect \
             shows if a fit without it is worse by 50 or more.",
        )
        .notes([format!("Nulls, singles, doubles, unknown physics and graded effects: {}.", roles())])
}

fn roles() -> String {
    Role::ALL.map(|role| role.name()).join(", ")
}
