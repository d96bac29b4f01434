//! A directory for every case: what the diagnosis was given, and the page of what it made of that.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use jointscope::Answer;
use jointscope::fixture::Fixture;
use jointscope::recordings::{ReadOptions, Source, hits_of};
use jointscope::report::{InputFile, PageContext, answer_report};

use super::cases::Concealed;
use crate::input;
use crate::origin;
use crate::output::Outputs;
use crate::refusal::Refusal;

/// The recording's name in a case's directory.
const RECORDING: &str = "hammer-test.uff";

/// Writes the directories `cases/NNN` as the diagnoses come.
pub(super) struct CasePages<'a> {
    directory: PathBuf,
    concealed: &'a Concealed,
    fault: Mutex<Option<Refusal>>,
}

impl<'a> CasePages<'a> {
    /// Below `directory`.
    pub(super) fn below(directory: &Path, concealed: &'a Concealed) -> Self {
        CasePages { directory: directory.join("cases"), concealed, fault: Mutex::new(None) }
    }

    /// Writes fixture, recording and page of the case at a position. The first fault is kept for
    /// [`CasePages::finish`].
    pub(super) fn write(&self, position: usize, answer: &Answer) {
        self.keep(self.try_write(position, answer));
    }

    fn keep(&self, written: Result<(), Refusal>) {
        if let (Err(refusal), Ok(mut fault)) = (written, self.fault.lock()) {
            fault.get_or_insert(refusal);
        }
    }

    fn try_write(&self, position: usize, answer: &Answer) -> Result<(), Refusal> {
        let folder = self.directory.join(name(self.concealed.numbers[position]));
        let case = self.concealed.cases.all()[position];
        let (believed, recording) = (case.believed(), self.concealed.recording(position, &case)?);
        let files = [("fixture.json", believed.to_json().into_bytes()), (RECORDING, recording)];
        let context = PageContext {
            program: origin::program(),
            command: "jointscope diagnose fixture.json hammer-test.uff -o .".to_owned(),
            inputs: files
                .iter()
                .map(|(name, bytes)| InputFile { name: (*name).to_owned(), sha256: input::digest(bytes) })
                .collect(),
            notes: notes(believed, &files[1].1, answer)?,
            hits: answer.hammer_test.clone(),
        };
        let page = answer_report(answer, &context).html().map_err(Refusal::new)?;
        let mut outputs = Outputs::default();
        for (name, bytes) in files {
            outputs.add(folder.join(name), bytes);
        }
        outputs.add(folder.join("report.html"), page);
        outputs.write()
    }

    /// Whether all were written.
    pub(super) fn finish(self) -> Result<(), Refusal> {
        match self.fault.into_inner() {
            Ok(Some(refusal)) => Err(refusal),
            _ => Ok(()),
        }
    }
}

/// What `diagnose` says beside what it found: of hits, what it reads of their file before the rest.
fn notes(believed: &Fixture, recording: &[u8], answer: &Answer) -> Result<Vec<String>, Refusal> {
    if answer.hammer_test.is_none() {
        return Ok(answer.notes.clone());
    }
    let file = jointscope::uff::read(recording).map_err(Refusal::new)?;
    let sources = [Source { name: RECORDING.to_owned(), file }];
    let hits = hits_of(&sources, Some(believed), &ReadOptions::default()).map_err(Refusal::new)?;
    Ok(hits.notes.into_iter().chain(answer.notes.iter().cloned()).collect())
}

/// The directory of a case.
pub(super) fn name(number: usize) -> String {
    format!("{number:03}")
}
