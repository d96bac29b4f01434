//! A directory for every case: what the diagnosis was given, and the page of what it made of that.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use jointscope::Diagnosis;
use jointscope::estimation::Estimator;
use jointscope::fixture::Fixture;
use jointscope_proof::{StruckDiagnosis, StruckOutcome};
use jointscope_recordings::{ReadOptions, Source, hits_of};
use jointscope_report::{HammerTest, InputFile, PageContext, diagnosis_page, hits_page};
use sha2::{Digest, Sha256};

use super::cases::Concealed;
use crate::measured::what_was_estimated;
use crate::output::Outputs;
use crate::refusal::Refusal;

/// The recording's name in a case's directory.
const RECORDING: &str = "hammer-test.uff";

/// Writes the directories `cases/NNN` as the diagnoses come.
pub struct CasePages<'a> {
    directory: PathBuf,
    concealed: &'a Concealed,
    fault: Mutex<Option<Refusal>>,
}

impl<'a> CasePages<'a> {
    /// Below `directory`.
    pub fn below(directory: &Path, concealed: &'a Concealed) -> Self {
        CasePages { directory: directory.join("cases"), concealed, fault: Mutex::new(None) }
    }

    /// Writes fixture, recording and page of the case of FRFs at a position. The first fault is kept for [`CasePages::finish`].
    pub fn write(&self, position: usize, diagnosis: &Diagnosis) {
        self.keep(self.try_write(position, |believed, context, _| {
            diagnosis_page(diagnosis, believed, context).map_err(Refusal::new)
        }));
    }

    /// As [`CasePages::write`], of hits.
    pub fn write_hits(&self, position: usize, diagnosis: &StruckDiagnosis) {
        self.keep(self.try_write(position, |believed, context, recording| {
            context.notes = notes(believed, recording, diagnosis)?;
            let first_struck = self.concealed.firsts()[1];
            let hits = self.concealed.cases.struck[position - first_struck].hits.clone();
            context.hits = Some(HammerTest { hits, estimate: diagnosis.estimate.clone() });
            match &diagnosis.outcome {
                StruckOutcome::Changes => hits_page(&diagnosis.amplitude, believed, context),
                StruckOutcome::Linear(linear) => diagnosis_page(&linear.1, &linear.0, context),
            }
            .map_err(Refusal::new)
        }));
    }

    fn keep(&self, written: Result<(), Refusal>) {
        if let (Err(refusal), Ok(mut fault)) = (written, self.fault.lock()) {
            fault.get_or_insert(refusal);
        }
    }

    fn try_write(
        &self,
        position: usize,
        draw: impl FnOnce(&Fixture, &mut PageContext, &[u8]) -> Result<String, Refusal>,
    ) -> Result<(), Refusal> {
        let folder = self.directory.join(name(self.concealed.numbers[position]));
        let believed = self.concealed.believed(position);
        let recording = self.concealed.recording(position)?;
        let files = [("fixture.json", believed.to_json().into_bytes()), (RECORDING, recording)];
        let hash = |bytes: &[u8]| Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        let mut context = PageContext {
            program: format!("jointscope {}", env!("CARGO_PKG_VERSION")),
            command: "jointscope diagnose fixture.json hammer-test.uff -o .".to_owned(),
            inputs: files
                .iter()
                .map(|(name, bytes)| InputFile { name: (*name).to_owned(), sha256: hash(bytes) })
                .collect(),
            notes: Vec::new(),
            hits: None,
        };
        let page = draw(believed, &mut context, &files[1].1)?;
        let mut outputs = Outputs::default();
        for (name, bytes) in files {
            outputs.add(folder.join(name), bytes);
        }
        outputs.add(folder.join("report.html"), page);
        outputs.write()
    }

    /// Whether all were written.
    pub fn finish(self) -> Result<(), Refusal> {
        match self.fault.into_inner() {
            Ok(Some(refusal)) => Err(refusal),
            _ => Ok(()),
        }
    }
}

/// What `diagnose` says of hits beside what it found.
fn notes(believed: &Fixture, recording: &[u8], diagnosis: &StruckDiagnosis) -> Result<Vec<String>, Refusal> {
    let file = jointscope_uff::read(recording).map_err(Refusal::new)?;
    let sources = [Source { name: RECORDING.to_owned(), file }];
    let mut notes = hits_of(&sources, Some(believed), &ReadOptions::default()).map_err(Refusal::new)?.notes;
    if let Some(frfs) = diagnosis.estimate.usable() {
        notes.push(what_was_estimated(&diagnosis.estimate, &frfs, Estimator::default()));
    }
    notes.extend(diagnosis.estimate.remarks.iter().cloned());
    if let StruckOutcome::Linear(_) = diagnosis.outcome {
        notes.push(diagnosis.amplitude.says());
        notes.extend(diagnosis.amplitude.remarks());
    }
    Ok(notes)
}

/// The directory of a case.
pub fn name(number: usize) -> String {
    format!("{number:03}")
}
