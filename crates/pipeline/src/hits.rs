//! Whether anything changes with the strength of the hits.

use crate::homogeneity::{Homogeneity, not_judged};
use crate::{Answer, Error, MeasuredFrfs, Options};
use jointscope_fixture::Fixture;
use jointscope_nonlinear::{NonlinearDiagnosis, Verdict};
use jointscope_recordings::Hits;
use jointscope_wording::{Remarks, Says};

/// Estimates the FRFs of `hits` and tests whether they change with strength; if so, the law is sought.
pub(crate) fn homogeneity(fixture: &Fixture, hits: &Hits, options: &Options) -> Result<Homogeneity, Error> {
    let mut measured = MeasuredFrfs::estimated(hits, &options.estimate)?;
    let in_use = measured.hammer_test.as_ref().map(|test| test.hits_in_use()).unwrap_or_default();
    let p_value = match NonlinearDiagnosis::of(fixture, &in_use, &options.nonlinear()) {
        Ok(diagnosis) if diagnosis.verdict != Verdict::Consistent => {
            return Ok(Homogeneity::Changes(Box::new(Answer::of_hits(fixture, diagnosis, measured))));
        }
        Ok(diagnosis) => {
            measured.notes.push(diagnosis.says());
            measured.notes.extend(diagnosis.remarks());
            Some(diagnosis.homogeneity.p_value)
        }
        Err(error) => {
            measured.notes.push(not_judged(&error));
            None
        }
    };
    Ok(Homogeneity::Linear(Box::new(measured), p_value))
}
