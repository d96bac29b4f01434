//! A directory for every case: what the diagnosis was given, and the page of what it made of that.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use jointscope::Diagnosis;
use jointscope_report::{InputFile, PageContext, diagnosis_page};
use sha2::{Digest, Sha256};

use super::cases::Concealed;
use crate::output::Outputs;
use crate::refusal::Refusal;

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

    /// Writes fixture, recording and page of the case at a position. The first fault is kept for [`CasePages::finish`].
    pub fn write(&self, position: usize, diagnosis: &Diagnosis) {
        let written = self.try_write(position, diagnosis);
        if let (Err(refusal), Ok(mut fault)) = (written, self.fault.lock()) {
            fault.get_or_insert(refusal);
        }
    }

    fn try_write(&self, position: usize, diagnosis: &Diagnosis) -> Result<(), Refusal> {
        let folder = self.directory.join(name(self.concealed.numbers[position]));
        let believed = &self.concealed.cases[position].believed;
        let files = [
            ("fixture.json", believed.to_json().into_bytes()),
            ("hammer-test.uff", self.concealed.recording(position)?),
        ];
        let hash = |bytes: &[u8]| Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        let context = PageContext {
            program: format!("jointscope {}", env!("CARGO_PKG_VERSION")),
            command: "jointscope diagnose fixture.json hammer-test.uff -o .".to_owned(),
            inputs: files
                .iter()
                .map(|(name, bytes)| InputFile { name: (*name).to_owned(), sha256: hash(bytes) })
                .collect(),
            notes: Vec::new(),
            hits: None,
        };
        let page = diagnosis_page(diagnosis, believed, &context).map_err(Refusal::new)?;
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

/// The directory of a case.
pub fn name(number: usize) -> String {
    format!("{number:03}")
}
