//! Where a page comes from, as every page states it.

use jointscope_fixture::Fixture;
use jointscope_pipeline::HammerTest;

use crate::hammer_test;
use crate::input_file::InputFile;
use crate::page::Page;
use crate::section::{Section, Verdict};
use crate::tone::Tone;

/// Where a page comes from: what its foot states, and what was noticed on the way.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PageContext {
    /// The program and its version.
    pub program: String,
    /// The command line.
    pub command: String,
    /// The files that were read.
    pub inputs: Vec<InputFile>,
    /// Remarks from reading the recordings, one plain sentence each.
    pub notes: Vec<String>,
    /// The hammer hits, where the FRFs were estimated from them; a section of its own.
    pub hits: Option<HammerTest>,
}

impl PageContext {
    /// A page under its verdict, with program, command line and the inputs' hashes in its foot.
    pub(crate) fn page(&self, title: impl Into<String>, subtitle: String, verdict: Verdict) -> Page {
        let page = Page::new(title).subtitle(subtitle).verdict(verdict);
        page.foot(&self.program, &self.command, &self.inputs)
    }

    /// A headline, the sentences that go with it, and what was remarked of the recordings.
    pub(crate) fn verdict(
        &self,
        tone: impl Into<Tone>,
        headline: String,
        sentences: impl IntoIterator<Item = String>,
    ) -> Verdict {
        let tone = tone.into();
        Verdict { tone, headline, details: sentences.into_iter().chain(self.notes.iter().cloned()).collect() }
    }

    /// The fixture's name and the recordings.
    pub(crate) fn subtitle(&self, fixture: &Fixture) -> String {
        let recordings = self.recordings(true);
        let parts = [fixture.name(), recordings.as_str()].into_iter().filter(|part| !part.is_empty());
        parts.collect::<Vec<_>>().join(" · ")
    }

    /// The recordings; the first input is none of them where a fixture was read.
    pub(crate) fn recordings(&self, fixture: bool) -> String {
        let files = self.inputs.iter().skip(usize::from(fixture)).map(|input| input.name.as_str());
        files.collect::<Vec<_>>().join(", ")
    }

    /// The section of the hits, where there are any.
    pub(crate) fn hits(&self) -> Option<Section> {
        self.hits.as_ref().map(hammer_test::section)
    }
}
