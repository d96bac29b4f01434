//! The page of one diagnosis: what was left out, where it sits, what shows it, and how far to believe it.

mod delta;
mod findings;
mod fixture_view;
mod frfs;
mod judgement;
mod law;
mod misfit;
mod noise;
mod tolerances;

use jointscope_diagnosis::{Diagnosis, Fit, Verdict as Conclusion};
use jointscope_fixture::Fixture;

use crate::hammer_test;
use crate::{Page, PageContext, PageError, Section, Tone, Verdict};

/// Lines beyond which panes are drawn thinned, so that a page of long recordings stays small.
const LINE_LIMIT: usize = 2_000;
/// FRFs and places that are shown at the most; the page says how many there are.
const SHOWN: usize = 12;

/// What the sections of the page are made from.
#[derive(Clone, Copy)]
struct Subject<'a> {
    diagnosis: &'a Diagnosis,
    fixture: &'a Fixture,
}

impl<'a> Subject<'a> {
    /// The models that are compared, by name. The repaired one is there only where it is another than the refitted.
    fn models(&self) -> Vec<(&'static str, &'a Fit)> {
        let search = &self.diagnosis.search;
        let mut models = vec![("nominal", &search.nominal), ("refitted", &search.refitted)];
        if !self.diagnosis.findings.is_empty() {
            models.push(("repaired", &search.repaired));
        }
        models
    }
}

/// The page of a diagnosis as one self-contained HTML file: the verdict in a sentence; the fixture with the places marked; findings with
/// intervals, probabilities and look-alikes; errors before and after, held-out lines included; δ(ω) with the law that names it; the FRFs of all
/// models; maps of the misfit; tolerances and where they ended; the noise.
///
/// `fixture` is the one that `diagnosis` was made with. The same input gives the same bytes.
///
/// # Errors
/// A diagnosis whose lists do not fit its spectral lines.
pub fn diagnosis_page(
    diagnosis: &Diagnosis,
    fixture: &Fixture,
    context: &PageContext,
) -> Result<String, PageError> {
    let subject = Subject { diagnosis, fixture };
    let mut page = Page::new("Diagnosis: what the fixture leaves out")
        .subtitle(context.subtitle(fixture))
        .verdict(verdict(diagnosis, context));
    if let Some(test) = &context.hits {
        page = page.section(hammer_test::section(test));
    }
    page = page
        .section(fixture_view::section(&subject))
        .section(findings::section(&subject))
        .section(judgement::section(&subject));
    let others: [Option<Section>; 5] = [
        delta::section(&subject),
        Some(frfs::section(&subject)),
        Some(misfit::section(&subject)),
        tolerances::section(&subject),
        Some(noise::section(&subject)),
    ];
    for section in others.into_iter().flatten() {
        page = page.section(section);
    }
    page.foot(context.foot()).to_html()
}

fn verdict(diagnosis: &Diagnosis, context: &PageContext) -> Verdict {
    let tone = match diagnosis.verdict {
        Conclusion::Consistent => Tone::Ok,
        Conclusion::Explained => Tone::Attention,
        Conclusion::PartlyExplained | Conclusion::Unexplained => Tone::Problem,
    };
    let said = diagnosis.findings.iter().map(|finding| finding.says());
    let remarks = said.chain(diagnosis.remarks()).chain(context.notes.iter().cloned());
    remarks.fold(Verdict::new(tone, diagnosis.says()), Verdict::detail)
}
