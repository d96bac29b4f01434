//! What levels come to in words.

use super::diagnosis::{LevelFinding, LevelResult, SteppedDiagnosis};
use crate::{Estimate, Verdict};
use jointscope_fixture::{Dof, EffectKind};

impl SteppedDiagnosis {
    /// The conclusion in a sentence or two.
    pub fn says(&self) -> String {
        let course = self.course();
        let place = format!("joint {} in {}", self.place.0, self.place.1.name());
        let held = |index: usize| self.levels.get(index).map_or_else(String::new, |l| l.held.to_string());
        match (self.verdict, self.findings.as_slice()) {
            (Verdict::Homogeneous, _) => format!(
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
                let share = 100.0 * findings[0].share;
                let left = if verdict == Verdict::Explained { "" } else { ", and something is left" };
                if self.holds == self.levels.len() {
                    return format!(
                        "{course} {} at {place} explains {share:.0} % of the change{left}.",
                        capital(&names)
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

    /// How frequency and damping go with level.
    fn course(&self) -> String {
        let (Some(first), Some(last)) = (self.levels.first(), self.levels.last()) else {
            return String::new();
        };
        let hz = |l: &LevelResult| l.resonance.frequency.0;
        let percent = |l: &LevelResult| 100.0 * l.resonance.damping_ratio.0;
        let least = self.levels.iter().min_by(|a, b| hz(a).total_cmp(&hz(b))).unwrap_or(first);
        let most = self.levels.iter().max_by(|a, b| hz(a).total_cmp(&hz(b))).unwrap_or(last);
        // A turn counts where it is well beyond the scatter of the fits.
        let beyond = |from: &LevelResult, to: &LevelResult| {
            (hz(from) - hz(to)).abs() > 5.0 * from.resonance.frequency.1.hypot(to.resonance.frequency.1)
        };
        let turns = |at: &LevelResult| {
            at.held != first.held && at.held != last.held && beyond(at, first) && beyond(at, last)
        };
        let frequency = if turns(least) {
            format!(
                "the frequency falls from {:.3} Hz to {:.3} Hz at {} and rises again to {:.3} Hz",
                hz(first),
                hz(least),
                least.held,
                hz(last)
            )
        } else if turns(most) {
            format!(
                "the frequency rises from {:.3} Hz to {:.3} Hz at {} and falls again to {:.3} Hz",
                hz(first),
                hz(most),
                most.held,
                hz(last)
            )
        } else {
            let verb = if !beyond(first, last) {
                "stays"
            } else if hz(last) < hz(first) {
                "falls"
            } else {
                "rises"
            };
            format!("the frequency {verb} from {:.3} to {:.3} Hz", hz(first), hz(last))
                .replace("stays from", "stays:")
        };
        let spread = first.resonance.damping_ratio.1.hypot(last.resonance.damping_ratio.1);
        let moved = last.resonance.damping_ratio.0 - first.resonance.damping_ratio.0;
        let damping = match moved {
            m if m.abs() < 3.0 * spread => "damping stays at",
            m if m > 0.0 => "damping grows from",
            _ => "damping falls from",
        };
        format!(
            "From {} to {} {frequency}, and {damping} {:.3} to {:.3} %.",
            first.held,
            last.held,
            percent(first),
            percent(last)
        )
    }

    /// What a reader should know besides.
    pub fn remarks(&self) -> Vec<String> {
        if self.verdict == Verdict::Homogeneous {
            return vec![format!(
                "Levels were compared on the lines from {:.4} to {:.4} Hz, about their strongest resonance.",
                self.band.0, self.band.1
            )];
        }
        let mut remarks = self.unplaced.clone();
        let (_, unit) = units(self.place.1);
        if let (Some(first), Some(last)) = (self.levels.first(), self.levels.last()) {
            remarks.push(format!(
                "The relative motion of joint {} in {} runs from {:.3e} to {:.3e} {}; with one resonance its components and other joints that the mode moves keep a fixed ratio, so which of them changes cannot be told by these FRFs alone.",
                self.place.0, self.place.1.name(), first.motion, last.motion, units(self.place.1).0
            ));
            remarks.push(format!(
                "Beyond the fixture's, the joint's stiffness goes from {:.3e} to {:.3e} {unit} and its loss stiffness from {:.3e} to {:.3e} {unit}.",
                first.stiffness.0, last.stiffness.0, first.loss.0, last.loss.0
            ));
        }
        if self.levels.iter().any(|l| matches!(l.held, super::level::Held::Force(_))) {
            remarks.push("Where the force was held the response changes along the lines, so frequency and damping of such a level are averages over its amplitudes; laws are fitted at each line's own amplitude.".to_owned());
        }
        let two = self.tried.iter().find(|t| t.form.contains('+') && t.share >= 0.9);
        if let (Some(two), [] | [_]) = (two, self.findings.as_slice()) {
            remarks.push(format!(
                "Friction and a cubic spring together at {} in {} would leave a relative error of {:.3}, but two laws follow {} levels by their freedom: that is no evidence for either.",
                two.joint, two.dof.name(), two.nrmse, self.levels.len()
            ));
        }
        if self.levels.len() < 3 {
            remarks.push("Two levels show that something changes, not by which law: add a third.".to_owned());
        }
        remarks
    }
}

impl LevelFinding {
    /// One plain sentence: what, where, how much with its 95 % interval, over which motions, and what cannot be told from it.
    pub fn says(&self) -> String {
        let size = |index: usize| self.estimates.get(index).map_or_else(String::new, size_of);
        let (motion, _) = units(self.effect.dof.unwrap_or(Dof::Translation));
        let what = match self.effect.kind {
            EffectKind::CubicStiffness => format!("has a cubic stiffness of {}", size(0)),
            EffectKind::Friction => {
                format!(
                    "sticks and slips: friction that gives way at {}, with a stiffness of {} while it sticks",
                    size(0),
                    size(1)
                )
            }
            _ => format!("meets a stop: contact closes after {}, with a stiffness of {}", size(0), size(1)),
        };
        let others: Vec<String> = self
            .alternatives
            .iter()
            .filter(|(_, p)| *p > 0.05)
            .map(|(e, p)| {
                format!("{} at {} in {} ({p:.2})", e.kind.name(), e.place, e.dof.map_or("", Dof::name))
            })
            .collect();
        let others = if others.is_empty() {
            String::new()
        } else {
            format!("; cannot be told from {}", others.join(", "))
        };
        format!(
            "Joint {} in {} {what}; seen at relative motions of {:.3e} to {:.3e} {motion}{others}.",
            self.effect.place,
            self.effect.dof.map_or("", Dof::name),
            self.motions.0,
            self.motions.1
        )
    }
}

fn size_of(estimate: &Estimate) -> String {
    let unit = estimate.unit.replace('*', "·");
    match estimate.interval {
        Some([low, high]) => format!("{:.4e} {unit} (95 %: {low:.3e} to {high:.3e})", estimate.value),
        None => format!("{:.4e} {unit} (not determined by these levels)", estimate.value),
    }
}

fn kind(finding: &LevelFinding) -> &'static str {
    match finding.effect.kind {
        EffectKind::CubicStiffness => "a cubic spring",
        EffectKind::Friction => "friction",
        _ => "a gap",
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn units(dof: Dof) -> (&'static str, &'static str) {
    if dof == Dof::Rotation { ("rad", "N·m/rad") } else { ("m", "N/m") }
}
