//! What a diagnosis of hits comes to in words.

use super::diagnosis::{Estimate, Finding, NonlinearDiagnosis, Verdict};
use jointscope_fixture::{Dof, EffectKind};

impl Verdict {
    /// The word used in `diagnosis.json`.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Homogeneous => "consistent",
            Verdict::Explained => "explained",
            Verdict::PartlyExplained => "partly_explained",
            Verdict::Unexplained => "unexplained",
        }
    }
}

impl NonlinearDiagnosis {
    /// The conclusion in a sentence.
    pub fn says(&self) -> String {
        let homogeneity = &self.homogeneity;
        let (weakest, strongest) = match (homogeneity.levels.first(), homogeneity.levels.last()) {
            (Some(first), Some(last)) => (first.0, last.0),
            _ => (0.0, 0.0),
        };
        let range = format!("between hits of {} N and {} N", Short(weakest), Short(strongest));
        let chance = match homogeneity.p_value < 1e-3 {
            true => "p < 0.001".to_owned(),
            false => format!("p = {:.2}", homogeneity.p_value),
        };
        match self.verdict {
            Verdict::Homogeneous => format!(
                "FRFs do not change {range} beyond noise ({chance}): nothing depends on amplitude there."
            ),
            Verdict::Explained => format!("FRFs change {range} ({chance}), and what was found explains how."),
            Verdict::PartlyExplained => {
                format!(
                    "FRFs change {range} ({chance}); what was found is needed and explains most of it, but something is left."
                )
            }
            Verdict::Unexplained => format!(
                "FRFs change {range} ({chance}), most between {:.0} and {:.0} Hz, and neither a cubic spring nor friction nor a gap at a joint explains it.",
                homogeneity.band.0, homogeneity.band.1
            ),
        }
    }

    /// What a reader should know besides: how far the hits reach, and how the noise was measured.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        if self.verdict == Verdict::Homogeneous {
            for reach in &self.reach {
                let (motion, force) = units(reach.dof);
                remarks.push(format!(
                    "Joint {} was moved by {} {motion} at the most in {}: a gap wider than that, and friction that sticks up to about {} {force}, are out of reach of these hits.",
                    reach.joint, Short(reach.motion), reach.dof.name(), Short(reach.force)
                ));
            }
        }
        if let Some(time) = self.followed {
            remarks.push(format!(
                "Some hits are compared only up to {} s after the blow: from there on the motion depends on more than the force is known to, and no model could follow it.",
                Short(time)
            ));
        }
        if !self.homogeneity.from_repeats {
            remarks.push("No two hits are alike, so noise was taken from the ends of the records: repeat each strength to have it measured.".to_owned());
        }
        remarks
    }
}

impl Finding {
    /// What was found, in a few words.
    pub fn name(&self) -> String {
        let dof = self.effect.dof.map_or("", Dof::name);
        let kind = match self.effect.kind {
            EffectKind::CubicStiffness => "cubic stiffness",
            EffectKind::Friction => "friction",
            _ => "gap",
        };
        format!("{kind} of joint {} in {dof}", self.effect.place)
    }

    /// One plain sentence: what, where, how much with its 95 % interval, and what cannot be told from it.
    pub fn says(&self) -> String {
        let place = format!("Joint {} in {}", self.effect.place, self.effect.dof.map_or("", Dof::name));
        let size = |index: usize| self.estimates.get(index).map_or_else(String::new, Estimate::says);
        let (motion, _) = units(self.effect.dof.unwrap_or(Dof::Translation));
        let what = match self.effect.kind {
            EffectKind::CubicStiffness if self.effect.value(0) < 0.0 => {
                format!("softens as it is moved further: a cubic stiffness of {}", size(0))
            }
            EffectKind::CubicStiffness => {
                format!("stiffens as it is moved further: a cubic stiffness of {}", size(0))
            }
            EffectKind::Friction => format!(
                "sticks and slips: friction that gives way at {}, with a stiffness of {} while it sticks",
                size(0),
                size(1)
            ),
            _ => format!("meets a stop: contact closes after {}, with a stiffness of {}", size(0), size(1)),
        };
        let mut sentence =
            format!("{place} {what}; the hits move it by up to {} {motion}", Short(self.reach));
        let notable: Vec<String> = self
            .alternatives
            .iter()
            .filter(|(_, p)| *p >= 0.05)
            .map(|(e, p)| {
                format!(
                    "{} in {} ({:.0} %)",
                    e.kind.name().replace('_', " "),
                    e.dof.map_or("", Dof::name),
                    100.0 * p
                )
            })
            .collect();
        if !notable.is_empty() {
            sentence.push_str(&format!("; these hits cannot tell it from {}", notable.join(", ")));
        }
        sentence + "."
    }
}

impl Estimate {
    /// Value, unit and 95 % interval.
    pub fn says(&self) -> String {
        let unit = self.unit.replace('*', "·");
        match self.interval {
            Some([low, high]) => {
                format!("{} {unit} (95 %: {} to {})", Short(self.value), Short(low), Short(high))
            }
            None => format!("{} {unit} (not determined by these hits)", Short(self.value)),
        }
    }
}

fn units(dof: Dof) -> (&'static str, &'static str) {
    if dof == Dof::Rotation { ("rad", "N·m") } else { ("m", "N") }
}

/// A number with four digits, by powers of ten where it is large or small.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let size = self.0.abs();
        if size == 0.0 {
            f.write_str("0")
        } else if (0.01..1e5).contains(&size) {
            let decimals = (3 - size.log10().floor() as i32).max(0) as usize;
            write!(f, "{:.decimals$}", self.0)
        } else {
            write!(f, "{:.3e}", self.0)
        }
    }
}
