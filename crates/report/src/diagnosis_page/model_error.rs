//! How wrong the models are beside what is usual, where that decides instead of the noise.

use jointscope_wording::{ErrorInWords, error_in_words};

use super::subject::Subject;
use crate::section::Section;
use crate::table::Table;
use crate::tone::Tone;

pub(super) fn section(subject: &Subject) -> Option<Section> {
    let [refitted, repaired] = subject.diagnosis.model_error.as_ref()?.each_ref().map(error_in_words);
    let has_findings = !subject.diagnosis.findings.is_empty();
    let size = |error: &ErrorInWords| error.with_interval.clone();
    let known = |error: &ErrorInWords| match error.is_stated {
        true => format!("{} (stated)", error.usual),
        false => error.usual.clone(),
    };
    let mut table = Table::of(refitted.into_iter().zip(repaired))
        .words("Error of", |(refitted, _)| refitted.kind)
        .words("refitted", |(refitted, _)| size(refitted));
    if has_findings {
        table = table.words("repaired", |(_, repaired)| size(repaired));
    }
    let table = table
        .words("usual", |(refitted, _)| known(refitted))
        .marked(|(_, repaired)| repaired.large.then_some(Tone::Attention))
        .footnote(
            "Standard deviations over the modes in the band, relative, with their intervals of 95 %; of residues relative to the mode's root mean square; of places how far \
             beside their points sensors sit and hammers strike. What the fixture states is taken as it is. Marked: more than twice the usual or stated, which no adequate model has.",
        );
    let words = if has_findings {
        "The model's own error is larger than the noise of the FRFs, so the hypotheses were compared by modes: a finding is needed where it makes \
         the error smaller. χ² against the noise decides nothing here."
    } else {
        "The model's own error is larger than the noise of the FRFs, so the hypotheses were compared by modes: an effect would be needed where it \
         made the error smaller, and none does by enough. χ² against the noise decides nothing here."
    };
    Some(Section::new("Error of the model").paragraph(words).with(table))
}
