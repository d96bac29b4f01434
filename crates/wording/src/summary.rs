//! What was found, a line each, for a terminal.

use crate::format::significant;
use crate::places::held_out_part;
use crate::{Remarks, Says, Summary, model_error};
use jointscope_diagnosis::Diagnosis;
use jointscope_nonlinear::{NonlinearDiagnosis, SteppedDiagnosis};

/// A relative error as a percentage of three digits.
fn share(error: f64) -> String {
    format!("{} %", significant(100.0 * error, 3))
}

/// The verdict, and each finding with its probability.
fn found(verdict: &str, says: String, findings: impl Iterator<Item = (String, f64)>) -> Vec<String> {
    let findings = findings
        .enumerate()
        .map(|(index, (says, probability))| format!("{}. {says} Probability {probability:.2}.", index + 1));
    std::iter::once(format!("{}: {says}", verdict.replace('_', " "))).chain(findings).collect()
}

impl Summary for Diagnosis {
    fn summary(&self) -> Vec<String> {
        let findings = self.findings.iter().map(|finding| (finding.says(), finding.probability));
        let mut lines = found(self.verdict.name(), self.says(), findings);
        let [nominal, refitted, repaired] = self.nrmse();
        let [chi2_nominal, chi2_refitted, chi2_repaired] = self.chi2_per_dof();
        let row = |name: &str, error: f64, chi2: f64| {
            format!(
                "{name}: relative error of the FRFs {}, chi2 per degree of freedom {}",
                share(error),
                significant(chi2, 4)
            )
        };
        lines.extend(crate::diagnosis::ranked(self));
        lines.push(row("fixture as stated", nominal, chi2_nominal));
        lines.push(row("refitted within its tolerances", refitted, chi2_refitted));
        if !self.findings.is_empty() {
            lines.push(row("repaired", repaired, chi2_repaired));
        }
        for (name, error) in ["refitted", "repaired"].iter().zip(self.model_error.iter().flatten()) {
            if *name == "refitted" || !self.findings.is_empty() {
                lines.push(format!("{name}: the model is off by {}", model_error::sizes(error)));
            }
        }
        if let Some(held_out) = self.held_out.as_ref().filter(|_| !self.findings.is_empty()) {
            lines.push(format!(
                "held out ({}): relative error {} refitted, {} repaired",
                held_out.what.iter().map(|part| held_out_part(part)).collect::<Vec<_>>().join(", "),
                share(held_out.nrmse_refitted),
                share(held_out.nrmse_repaired)
            ));
        }
        lines.extend(self.remarks());
        lines
    }
}

impl Summary for NonlinearDiagnosis {
    fn summary(&self) -> Vec<String> {
        let findings = self.findings.iter().map(|finding| (finding.says(), finding.probability));
        let mut lines = found(self.verdict.name(), self.says(), findings);
        let models = ["fixture as stated", "refitted within its tolerances", "repaired"];
        for (name, model) in models.iter().zip(self.models.iter().flatten()) {
            lines.push(format!(
                "{name}: relative error of the responses {}, chi2 per degree of freedom {}",
                share(model.nrmse),
                significant(model.chi2_per_dof, 4)
            ));
        }
        if let Some(held) = &self.held_out {
            lines.push(format!(
                "held out ({} hits): relative error {} refitted, {} repaired",
                held.what.len(),
                share(held.nrmse_refitted),
                share(held.nrmse_repaired)
            ));
        }
        lines.extend(self.remarks());
        lines
    }
}

impl Summary for SteppedDiagnosis {
    fn summary(&self) -> Vec<String> {
        let findings = self.findings.iter().map(|finding| (finding.says(), finding.probability));
        let mut lines = found(self.verdict.name(), self.says(), findings);
        for level in &self.levels {
            lines.push(format!(
            "{}: {} Hz, damping {:.4} %, relative motion {:.3e}, relative error {:.3} refitted, {:.3} repaired, {:.3} with a stiffness of its own",
            level.held,
            crate::levels::frequency(level),
            100.0 * level.resonance.damping_ratio.0,
            level.motion,
            level.nrmse[1],
            level.nrmse[2],
            level.nrmse[3]
        ));
        }
        let tried = self
            .tried
            .iter()
            .map(|t| format!("{} at {} in {} {:.3}", t.form, t.joint, t.dof.name(), t.nrmse));
        lines.push(format!("relative errors over all levels: {}", tried.collect::<Vec<_>>().join(", ")));
        for (name, chi2) in ["fixture as stated", "refitted", "repaired"].iter().zip(self.chi2_per_dof) {
            let told = |chi2| format!("{name}: chi2 per degree of freedom {}", significant(chi2, 4));
            lines.extend(chi2.map(told));
        }
        if let Some(held) = &self.held_out {
            lines.push(format!(
                "levels left out one by one: relative error {:.3} refitted, {:.3} repaired",
                held.nrmse_refitted, held.nrmse_repaired
            ));
        }
        lines.extend(self.remarks());
        lines
    }
}
