//! The page of one diagnosis: what was left out, where it sits, what shows it, and how far to believe it.

mod changes;
mod delta;
mod departures;
mod findings;
mod fixture_view;
mod frfs;
mod glance;
mod judgement;
mod misfit;
mod model_error;
mod noise;
mod subject;
mod tolerances;
mod two_states;

use jointscope_diagnosis::Diagnosis;
use jointscope_fixture::Fixture;
use jointscope_wording::Says;

use crate::context::PageContext;
use crate::report::Report;
use crate::section::Verdict;
use crate::tone::Tone;
use subject::Subject;

/// The page of a diagnosis: the verdict in a sentence; what was found, how sure, how much better, what to do,
/// and the fixture with the places marked; findings with intervals, probabilities and look-alikes; with a
/// baseline the modes then and now; the error of the model and the departures, where there are any; errors
/// before and after, held-out lines included; δ(ω) with the law that names it; the FRFs of all models; maps
/// of the misfit; tolerances and where they ended; the noise.
///
/// `fixture` is the one that `diagnosis` was made with. The same input gives the same bytes.
pub fn diagnosis_report(diagnosis: &Diagnosis, fixture: &Fixture, context: &PageContext) -> Report {
    let subject = Subject { diagnosis, fixture };
    let said = diagnosis.findings.iter().map(|finding| finding.says());
    // A quantity far from what is stated is to be looked at even where nothing else is missing.
    let tone = if diagnosis.is_only_departed() { Tone::Attention } else { diagnosis.verdict.into() };
    let title = match &diagnosis.baseline {
        None => "Diagnosis: what the fixture leaves out",
        Some(_) => "Diagnosis: what has changed since the baseline",
    };
    let frfs = match &diagnosis.baseline {
        None => frfs::section(&subject),
        Some(baseline) => two_states::section(&subject, baseline),
    };
    let verdict = Verdict { tone, headline: diagnosis.says(), details: said.collect() };
    Report::of(
        context
            .page(title, context.subtitle(fixture), verdict)
            .sections([glance::section(&subject, &context.notes), findings::section(&subject)])
            .sections(changes::section(&subject))
            .sections(model_error::section(&subject))
            .sections(departures::section(&subject))
            .sections([judgement::section(&subject)])
            .sections(delta::section(&subject))
            .sections([frfs, misfit::section(&subject)])
            .sections(tolerances::section(&subject))
            .sections([noise::section(&subject)])
            .sections(context.hits()),
    )
}
