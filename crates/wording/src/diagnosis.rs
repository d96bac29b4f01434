//! A diagnosis in sentences: what is left out, or where what has no name sits and how it goes with frequency.

mod remarks;

use crate::departures::departed;
use crate::finding::{found, it, with_fitted_size};
use crate::format::{fixed, significant};
use crate::misfit::{sits, varies};
use crate::numbers::{apart, figures};
use crate::places::quantity_name;
use crate::{Says, model_error};
use jointscope_diagnosis::{Diagnosis, OddRecord, Tried};
use jointscope_findings::Verdict;

/// The verdict: what it is, and what to do about it. What the test itself did and nothing takes out of its FRFs
/// goes before everything else, then what the stated quantities would have to be.
impl Says for Diagnosis {
    fn says(&self) -> String {
        let verdict = match &self.model_error {
            Some(errors) => model_error::verdict(self, errors),
            None => by_noise(self),
        };
        let drifted = self.drift.as_ref().filter(|drift| !drift.taken_out);
        let drifted = drifted.map_or_else(String::new, |drift| format!("{} ", drift.says()));
        format!("{drifted}{}{}{verdict}", odd(self).unwrap_or_default(), departed(self))
    }
}

/// The one record that no place of a structure makes another multiple than the others.
fn odd(diagnosis: &Diagnosis) -> Option<String> {
    let OddRecord { frf, factor, others: [least, largest] } = diagnosis.odd_record()?;
    Some(format!(
        "FRF {frf} is {} times what the fixture makes of it, the others {} to {} times: look at its unit, range and sign first, or state that the gain of each record is unsure \
         (`channels`, `\"*\"`), and it is named. ",
        significant(factor, 3),
        significant(least, 3),
        significant(largest, 3)
    ))
}

/// The verdict where the noise of the FRFs decides.
fn by_noise(diagnosis: &Diagnosis) -> String {
    match diagnosis.verdict {
        Verdict::Unexplained if diagnosis.is_only_departed() => by_its_quantities(diagnosis),
        Verdict::Unexplained => unexplained(diagnosis),
        Verdict::Consistent => consistent(diagnosis),
        Verdict::Explained => explained(diagnosis),
        Verdict::PartlyExplained if diagnosis.is_unnamed() => unnamed(diagnosis),
        Verdict::PartlyExplained if diagnosis.beside_modes.is_some() => explained_beside_modes(diagnosis),
        Verdict::PartlyExplained => partly_explained(diagnosis),
    }
}

/// Quantities far from what is stated explain the recording, as [`departed`] says before.
fn by_its_quantities(diagnosis: &Diagnosis) -> String {
    let [nominal, refitted, _] = diagnosis.chi2_per_dof();
    format!(
        "No effect is needed besides: the fixture so changed explains the FRFs down to their noise (χ² per degree of freedom {}, {} \
         before the refit).",
        figures(refitted),
        figures(nominal)
    )
}

fn consistent(diagnosis: &Diagnosis) -> String {
    let [nominal, refitted, _] = diagnosis.chi2_per_dof();
    if diagnosis.baseline.is_some() {
        return format!(
            "Nothing has changed since the baseline: the fixture explains the FRFs down to their noise (χ² per degree of freedom {}).",
            figures(refitted)
        );
    }
    match refitted < 0.5 * nominal {
        true => format!(
            "Nothing is left out: within its stated tolerances the fixture explains the FRFs down to their noise (χ² per degree of \
             freedom {}, {} before the refit).",
            figures(refitted),
            figures(nominal)
        ),
        false => format!(
            "Nothing is left out: the fixture explains the FRFs down to their noise (χ² per degree of freedom {}).",
            figures(refitted)
        ),
    }
}

fn explained(diagnosis: &Diagnosis) -> String {
    let [_, refitted, repaired] = diagnosis.chi2_per_dof();
    let [with, without] = apart([repaired, refitted], 3);
    let [error_with, error_without] = errors(diagnosis);
    let what = match &diagnosis.baseline {
        Some(_) => "Since the baseline this has changed:",
        None => "The fixture leaves out",
    };
    format!(
        "{what} {}; with {} the FRFs are explained down to their noise (χ² per degree of freedom {with}; without \
         {without}{}; error {error_with} %, without {error_without} %).",
        found(diagnosis),
        it(diagnosis),
        farthest_quantity(diagnosis)
    )
}

/// What no modes explain counts as noise: all but that is explained.
fn explained_beside_modes(diagnosis: &Diagnosis) -> String {
    let [error_with, error_without] = errors(diagnosis);
    format!(
        "The fixture leaves out {}; with {} the FRFs are explained but for {error_with} % of them (without {error_without} %). No structure's modes explain them to better than {} %.",
        found(diagnosis),
        it(diagnosis),
        significant(100.0 * diagnosis.beside_modes.unwrap_or_default(), 2)
    )
}

/// The error with what was found and without it, %.
fn errors(diagnosis: &Diagnosis) -> [String; 2] {
    let [_, without, with] = diagnosis.nrmse();
    apart([100.0 * with, 100.0 * without], 2)
}

/// The closest of the known effects is no name of what is left out.
fn unnamed(diagnosis: &Diagnosis) -> String {
    let [_, refitted, repaired] = diagnosis.chi2_per_dof();
    format!(
        "Something is left out that none of the effects known here accounts for: the closest, {}, takes χ² per degree of freedom from {} \
         to {} only, and what is left sits {}{}.",
        found(diagnosis),
        figures(refitted),
        figures(repaired),
        sits(diagnosis, &diagnosis.search.repaired),
        varies(diagnosis, &diagnosis.search.repaired)
    )
}

fn partly_explained(diagnosis: &Diagnosis) -> String {
    let [_, refitted, repaired] = diagnosis.chi2_per_dof();
    format!(
        "The fixture leaves out {}, but that is not all: χ² per degree of freedom falls from {} to {}, and what is left sits {}{}.",
        found(diagnosis),
        figures(refitted),
        figures(repaired),
        sits(diagnosis, &diagnosis.search.repaired),
        varies(diagnosis, &diagnosis.search.repaired)
    )
}

fn unexplained(diagnosis: &Diagnosis) -> String {
    let [_, refitted, _] = diagnosis.chi2_per_dof();
    format!(
        "Something is left out that none of the effects known here accounts for (χ² per degree of freedom {}): it sits {}{}.",
        figures(refitted),
        sits(diagnosis, &diagnosis.search.refitted),
        varies(diagnosis, &diagnosis.search.refitted)
    )
}

/// `, and the mass of A would have to be 33 standard deviations off`, where the refit without effects takes a
/// quantity that far.
fn farthest_quantity(diagnosis: &Diagnosis) -> String {
    diagnosis.farthest_quantity().map_or_else(String::new, |(path, deviations)| {
        let quantity = quantity_name(path);
        format!(", and {quantity} would have to be {} standard deviations off", significant(deviations, 2))
    })
}

/// Effects that are told of those that were tried in vain.
const RANKED: usize = 3;

/// What came nearest where nothing was found to explain the recording.
pub(crate) fn ranked(diagnosis: &Diagnosis) -> Option<String> {
    let all = Some(diagnosis.tried_in_vain()).filter(|all| !all.is_empty())?;
    let told = |tried: &Tried| format!("{} {}", with_fitted_size(&tried.effect), fixed(tried.ln_gain, 1));
    let nearest: Vec<String> = all.iter().take(RANKED).map(told).collect();
    Some(format!(
        "tried in vain, with what it gains in ln p of the modes over the fixture alone: {}{}",
        nearest.join(", "),
        if all.len() > RANKED {
            format!("; {} more in the result", all.len() - RANKED)
        } else {
            String::new()
        }
    ))
}
