//! A diagnosis of stepped-sine FRFs at several levels in sentences.

use crate::format::quantity_in;
use crate::numbers::{capitalised, decimals, rounded};
use crate::unit::Scale;
use crate::{Remarks, Says, amplitude};
use jointscope_findings::Verdict;
use jointscope_fixture::EffectKind;
use jointscope_nonlinear::{
    DampingCourse, FrequencyCourse, Held, LevelFinding, LevelResult, SteppedDiagnosis,
};
use jointscope_spectra::in_sentence;

/// The conclusion in a sentence or two.
impl Says for SteppedDiagnosis {
    fn says(&self) -> String {
        let course = course(self);
        let place = format!("joint {} in {}", self.place.0, self.place.1.name());
        let held = |index: usize| self.levels.get(index).map_or_else(String::new, |l| l.held.to_string());
        match (self.verdict, self.findings.as_slice()) {
            (Verdict::Consistent, _) => format!(
                "From {} to {} neither frequency nor damping changes beyond noise (p = {:.2}): nothing depends on amplitude there.",
                held(0),
                held(self.levels.len() - 1),
                self.change.0
            ),
            (Verdict::Unexplained, _) | (_, []) => format!(
                "{course} One cubic spring, friction element or gap at a joint does not explain it: the change sits at {place} as well as anywhere, and is left without a name."
            ),
            (verdict, findings) => {
                let names: Vec<String> = findings.iter().map(|f| kind(f).to_owned()).collect();
                let names = names.join(" with ");
                let share = 100.0 * findings[0].evidence.share;
                let left = match verdict {
                    Verdict::Explained => "",
                    _ if self.levels.len() < 3 => ", as other laws do: two levels do not tell which",
                    _ => ", and something is left",
                };
                if self.holds == self.levels.len() {
                    return format!(
                        "{course} {} at {place} explains {share:.0} % of the change{left}.",
                        capitalised(&names)
                    );
                }
                format!(
                    "{course} Up to {} {names} at {place} explains {share:.0} % of the change; above, from {}, neither that law nor anything else in the catalogue explains how the levels go on.",
                    held(self.holds - 1),
                    held(self.holds)
                )
            }
        }
    }
}

/// A level's natural frequency, Hz, with the digits that its deviation leaves: levels differ in the last
/// ones.
pub(crate) fn frequency(level: &LevelResult) -> String {
    let (hz, std) = level.resonance.frequency;
    // Without noise a deviation is next to nothing, and seven digits are enough.
    let most = 6 - hz.abs().max(f64::MIN_POSITIVE).log10().floor() as i32;
    rounded(hz, decimals(std).min(most))
}

/// How frequency and damping go with level.
fn course(diagnosis: &SteppedDiagnosis) -> String {
    let (Some(first), Some(last)) = (diagnosis.levels.first(), diagnosis.levels.last()) else {
        return String::new();
    };
    let hz = frequency;
    let percent = |l: &LevelResult| 100.0 * l.resonance.damping_ratio.0;
    let frequency = match diagnosis.frequency_course() {
        FrequencyCourse::Dips(least) => format!(
            "the frequency falls from {} Hz to {} Hz at {} and rises again to {} Hz",
            hz(first),
            hz(least),
            least.held,
            hz(last)
        ),
        FrequencyCourse::Peaks(most) => format!(
            "the frequency rises from {} Hz to {} Hz at {} and falls again to {} Hz",
            hz(first),
            hz(most),
            most.held,
            hz(last)
        ),
        FrequencyCourse::Falls => format!("the frequency falls from {} to {} Hz", hz(first), hz(last)),
        FrequencyCourse::Rises => format!("the frequency rises from {} to {} Hz", hz(first), hz(last)),
        _ => format!("the frequency stays: {} to {} Hz", hz(first), hz(last)),
    };
    let damping = match diagnosis.damping_course() {
        DampingCourse::Stays => "damping stays at",
        DampingCourse::Grows => "damping grows from",
        DampingCourse::Falls => "damping falls from",
    };
    format!(
        "From {} to {} {frequency}, and {damping} {:.3} to {:.3} %.",
        first.held,
        last.held,
        percent(first),
        percent(last)
    )
}

/// What the levels can tell and what not.
impl Remarks for SteppedDiagnosis {
    fn remarks(&self) -> Vec<String> {
        if self.verdict == Verdict::Consistent {
            return vec![format!(
                "Levels were compared on the lines from {} to {} Hz, about their strongest resonance.",
                in_sentence(self.band.0),
                in_sentence(self.band.1)
            )];
        }
        let mut remarks = self.unplaced.clone();
        let (motion, force) = amplitude::units(self.place.1);
        if let (Some(first), Some(last)) = (self.levels.first(), self.levels.last()) {
            let moved = Scale::for_values([first.motion, last.motion], motion);
            remarks.push(format!(
                "The relative motion of joint {} in {} runs from {} to {}; with one resonance its components and other joints that the mode moves keep a fixed ratio, so which of them changes cannot be told by these FRFs alone.",
                self.place.0,
                self.place.1.name(),
                quantity_in(first.motion, None, &moved),
                quantity_in(last.motion, None, &moved)
            ));
            let of = |values: [f64; 2]| Scale::for_values(values, &format!("{force}/{motion}"));
            let beyond = of([first.stiffness.0, last.stiffness.0]);
            let loss = of([first.loss.0, last.loss.0]);
            remarks.push(format!(
                "Beyond the fixture's, the joint's stiffness goes from {} to {} and its loss stiffness from {} to {}.",
                quantity_in(first.stiffness.0, None, &beyond),
                quantity_in(last.stiffness.0, None, &beyond),
                quantity_in(first.loss.0, None, &loss),
                quantity_in(last.loss.0, None, &loss)
            ));
        }
        if self.levels.iter().any(|l| matches!(l.held, Held::Force(_))) {
            remarks.push("Where the force was held the response changes along the lines, so frequency and damping of such a level are averages over its amplitudes; laws are fitted at each line's own amplitude.".to_owned());
        }
        if let Some(two) = self.unproved_pair() {
            remarks.push(format!(
                "Friction and a cubic spring together at {} in {} would leave a relative error of {:.3}, but two laws follow {} levels by their freedom: that is no evidence for either.",
                two.joint, two.dof.name(), two.nrmse, self.levels.len()
            ));
        }
        if let Some(channel) = &self.held_at {
            remarks.push(format!(
                "The amplitude that was held is taken to be that of response {channel}, the first of the files, for no FRF is of a driving point. Of another response the law would be of another size: put the FRF of the response that was held first."
            ));
        }
        if self.levels.len() < 3 {
            remarks.push("Two levels show that something changes, not by which law: add a third.".to_owned());
        }
        remarks
    }
}

fn kind(finding: &LevelFinding) -> &'static str {
    match finding.effect.kind {
        EffectKind::CubicStiffness => "a cubic spring",
        EffectKind::Friction => "friction",
        _ => "a gap",
    }
}
