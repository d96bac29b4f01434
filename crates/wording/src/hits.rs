//! A diagnosis of hits in sentences.

use crate::departures::{also, would_be};
use crate::format::significant;
use crate::{Remarks, Says, amplitude};
use jointscope_findings::Verdict;
use jointscope_nonlinear::NonlinearDiagnosis;
use jointscope_spectra::in_sentence;

/// The conclusion in a sentence.
impl Says for NonlinearDiagnosis {
    fn says(&self) -> String {
        let homogeneity = &self.homogeneity;
        let (weakest, strongest) = match (homogeneity.levels.first(), homogeneity.levels.last()) {
            (Some(first), Some(last)) => (first.peak_force, last.peak_force),
            _ => (0.0, 0.0),
        };
        let range =
            format!("between hits of {} N and {} N", significant(weakest, 4), significant(strongest, 4));
        let chance = match homogeneity.p_value < 1e-3 {
            true => "p < 0.001".to_owned(),
            false => format!("p = {:.2}", homogeneity.p_value),
        };
        match self.verdict {
            Verdict::Consistent => format!(
                "FRFs do not change {range} beyond noise ({chance}): nothing depends on amplitude there."
            ),
            Verdict::Explained => format!("FRFs change {range} ({chance}), and what was found explains how."),
            Verdict::PartlyExplained => {
                let left = departed(self).unwrap_or_else(|| "something is left".to_owned());
                format!(
                    "FRFs change {range} ({chance}); what was found is needed and explains most of it, but {left}."
                )
            }
            Verdict::Unexplained => format!(
                "FRFs change {range} ({chance}), most between {} and {} Hz, and neither a cubic spring nor friction nor a gap at a joint explains it.",
                in_sentence(homogeneity.band.0),
                in_sentence(homogeneity.band.1)
            ),
        }
    }
}

/// What the stated quantities take up beside the laws found, and what to do about it.
fn departed(diagnosis: &NonlinearDiagnosis) -> Option<String> {
    let [.., repaired] = diagnosis.models.as_ref()?;
    // Beside a law that is not the right one quantities tell nothing.
    let departed = repaired.departed();
    let first = departed.first().filter(|_| repaired.leaves_noise_alone())?;
    let std = first.stated.std?;
    let numbers = [first.stated.value, std, first.value];
    let others: Vec<String> = departed[1..].iter().map(|other| other.stated.path.clone()).collect();
    Some(format!(
        "{}{}: something that does not depend on amplitude is left out besides; measure again what is stated, or diagnose the FRFs of the weakest hits alone",
        would_be(&first.stated.path, first.stated.key.unit(), numbers, first.deviations),
        also(&others)
    ))
}

/// How far the hits reach, and how the noise was measured.
impl Remarks for NonlinearDiagnosis {
    fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        if self.verdict == Verdict::Consistent {
            for reach in &self.reach {
                let (motion, force) = amplitude::units(reach.dof);
                remarks.push(format!(
                    "Joint {} was moved by {} {motion} at the most in {}: a gap wider than that, and friction that sticks up to about {} {force}, are out of reach of these hits.",
                    reach.joint, significant(reach.motion, 4), reach.dof.name(), significant(reach.force, 4)
                ));
            }
        }
        if let Some(time) = self.followed {
            remarks.push(format!(
                "Some hits are compared only up to {} s after the blow: from there on the motion depends on more than the force is known to, and no model could follow it.",
                significant(time, 4)
            ));
        }
        if !self.homogeneity.from_repeats {
            remarks.push("No two hits are alike, so noise was taken from the ends of the records: repeat each strength to have it measured.".to_owned());
        }
        remarks
    }
}
