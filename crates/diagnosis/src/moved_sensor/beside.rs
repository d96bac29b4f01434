//! What a diagnosis comes to beside a sensor that loads the structure where it is.

use super::told::MovedSensor;
use crate::Hypothesis;
use crate::finding::{Finding, FrfEvidence};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::held_out::Division;
use crate::modal::{ModelError, fixture_by_modes};
use crate::routes::Parts;
use crate::search::Search;
use jointscope_findings::{Estimate, HeldOut, Verdict};

impl MovedSensor {
    /// The sensor as a finding.
    fn finding(&self) -> Finding {
        let mass = Estimate::of(self.effect().kind.spec().parameters[0], None, self.effect().value(0));
        Finding {
            estimates: vec![mass.within(self.deviation)],
            probability: self.probability,
            alternatives: self.alternatives.clone(),
            evidence: FrfEvidence { gain: self.gained, elsewhere: Vec::new(), measured: None },
            effect: self.effect().clone(),
        }
    }

    /// What was decided of the recording `without` the sensor, with it; `refitted` is what the fixture by
    /// itself comes to.
    pub(crate) fn beside(
        &self,
        fitter: &Fitter,
        (refitted, without): (Search, Parts),
        division: Option<&Division>,
    ) -> Parts {
        let with = |hypothesis: &Hypothesis| hypothesis.with(self.effect().clone());
        let by_modes = fixture_by_modes(fitter, &refitted.nominal.hypothesis);
        let refitted = match &by_modes {
            Some((hypothesis, _)) => refitted.refitted_from(fitter, hypothesis),
            None => refitted,
        };
        let repaired = Fit::at(with(&without.search.repaired.hypothesis), fitter.observation);
        let search = Search { repaired: repaired.unwrap_or_else(|| refitted.refitted.clone()), ..refitted };
        let held_out = division.and_then(|division| {
            let blind = self.blind(&fitter.on(&division.seen), &search, &without.search)?;
            let judged = division.judge(&blind, &search, fitter.observation)?;
            // The names were chosen by the whole.
            Some(HeldOut { same_findings: None, ..judged })
        });
        let verdict = match without.verdict {
            Verdict::Consistent | Verdict::Explained => Verdict::Explained,
            Verdict::PartlyExplained | Verdict::Unexplained => Verdict::PartlyExplained,
        };
        let errors = |[own, repaired]: [ModelError; 2]| {
            let refitted = by_modes.as_ref().map_or(own, |(_, error)| *error);
            [refitted, repaired]
        };
        let [_, repaired] = without.models();
        let mut findings = without.findings;
        findings.push(self.finding());
        findings.sort_by(|a, b| b.evidence.gain.total_cmp(&a.evidence.gain));
        Parts {
            verdict,
            findings,
            held_out,
            stated: Some([search.refitted.hypothesis.clone(), with(&repaired)]),
            model_error: without.model_error.map(errors),
            search,
            locations: without.locations,
            baseline_error: None,
            baseline: None,
            tried: without.tried,
        }
    }

    /// The fixture, and what was found with the sensor, fitted to what a fitter sees.
    fn blind(&self, fitter: &Fitter, search: &Search, without: &Search) -> Option<Search> {
        let own = MovedSensor::of(fitter.observation, &self.load.model, &search.candidates)?;
        let unloaded = own.load.taken_off(fitter.observation)?;
        let refitted = fitter.local(&search.refitted.hypothesis, None, f64::INFINITY)?;
        let repaired = fitter.on(&unloaded).local(&without.repaired.hypothesis, None, f64::INFINITY)?;
        let hypothesis = repaired.hypothesis.with(own.effect().clone());
        Some(Search { refitted, repaired: Fit { hypothesis, ..repaired }, ..search.clone() })
    }
}
