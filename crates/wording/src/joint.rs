//! What a reader should know of the joint found from all FRFs.

use crate::format::{quantity, significant};
use crate::numbers::{listed, percent, plain};
use crate::{Remarks, Says};
use jointscope_decomposition::{Analysis, FoundJoint, JointFit, JointTests, JointsFit, LawFit, LawKind};
use jointscope_inference::interval95;

/// What is true of the analysis whichever of its estimates is taken.
impl Remarks for Analysis {
    fn remarks(&self) -> Vec<String> {
        let merged = self.merged_from.and_then(|recorded| merging(recorded, self.frfs.lines().len()));
        merged.into_iter().chain(window(self)).chain(lost_tolerances(self)).collect()
    }
}

/// Where on the complex plane the joint was read, if not on the imaginary axis.
fn window(analysis: &Analysis) -> Option<String> {
    let decay = analysis.spectrum.decay;
    (decay > 0.0).then(|| {
        format!(
            "the FRFs lie under an exponential window of decay {decay:.4} 1/s: sides and joint are read at s = {decay:.4} 1/s + iω, where they \
             hold exactly, so that K and C are those of the joint and no damping of the window is left in them"
        )
    })
}

/// What the deviations leave out, if anything.
fn lost_tolerances(analysis: &Analysis) -> Option<String> {
    let lost = &analysis.lost_tolerances;
    (!lost.is_empty()).then(|| {
        format!(
            "the ± of the fit leave out the tolerances of {}: the fit could not follow them",
            lost.join(", ")
        )
    })
}

/// That `recorded` lines were merged into `left`; nothing where none was.
pub(crate) fn merging(recorded: usize, left: usize) -> Option<String> {
    (left < recorded).then(|| {
        format!(
            "of {recorded} lines, neighbours over which every FRF is smooth to its noise are merged: {left} are left, which tell the same; results by line are theirs"
        )
    })
}

/// A law without its mass.
fn over_frequency(law: &LawFit) -> String {
    match (law.kind, law.shape) {
        (LawKind::Constant, _) => "constant, without damping".to_owned(),
        (LawKind::Viscous, _) => "constant stiffness with viscous damping".to_owned(),
        (LawKind::Structural, _) => {
            "constant stiffness with structural damping (a loss factor that does not depend on frequency)"
                .to_owned()
        }
        (LawKind::StandardLinearSolid, Some(time)) => {
            format!("a standard linear solid, relaxation time {}", plain(time, "s"))
        }
        (LawKind::Fractional, Some(exponent)) => {
            format!("a springpot beside a spring, exponent {}", significant(exponent, 2))
        }
        (LawKind::LinearStiffness, _) => "a stiffness linear in frequency with viscous damping".to_owned(),
        (kind, None) => kind.name().replace('_', " "),
    }
}

impl Says for LawFit {
    fn says(&self) -> String {
        let law = over_frequency(self);
        match self.mass {
            Some(mass) => format!("{law}, with a mass of {} of its own", plain(mass, "kg")),
            None => law,
        }
    }
}

impl Remarks for JointFit {
    fn remarks(&self) -> Vec<String> {
        let mut all = of_law(self);
        all.extend(of_misfit(self));
        all.extend(of_limits(self));
        all.extend(of_quantities(self));
        all
    }
}

impl Remarks for JointsFit {
    /// What is true of the fit as a whole.
    fn remarks(&self) -> Vec<String> {
        let Some(first) = self.joints.first() else { return Vec::new() };
        let loops: Vec<String> =
            self.joints.iter().filter(|joint| joint.is_in_a_loop).map(|joint| joint.name.clone()).collect();
        let mut all: Vec<String> =
            self.merged.and_then(|(recorded, left)| merging(recorded, left)).into_iter().collect();
        if !loops.is_empty() {
            let (which, their, them) = match loops.len() {
                1 => ("joint", "its", "it"),
                _ => ("joints", "their", "them"),
            };
            all.push(format!(
                "the ends of {which} {} hold together without {them}, in a loop: no two sides meet at {them} alone, so that eq (7) and K and C by line do not apply; k and c \
                 are those of a fit to all FRFs, in which {their} loop is closed",
                listed(&loops)
            ));
        }
        all.extend(of_misfit(&first.fit));
        all.extend(of_quantities(&first.fit));
        all
    }
}

impl Remarks for FoundJoint {
    /// What is true of this joint alone.
    fn remarks(&self) -> Vec<String> {
        let mut all = of_law(&self.fit);
        all.extend(of_limits(&self.fit));
        all
    }
}

fn of_law(fit: &JointFit) -> Vec<String> {
    let mut all = Vec::new();
    all.extend(fit.law().map(|law| {
            let sure = if law.is_certain() { "" } else { "most probably " };
            // The mass has a sentence of its own.
            let what = if fit.mass.is_some() { over_frequency(law) } else { law.says() };
            format!(
                "of the laws compared, the joint is over frequency {sure}{what} (probability {}); the ± hold by how much the laws differ in the middle of \
                 the band",
                percent(law.probability)
            )
        }));
    all.extend(in_its_terms(fit));
    all.extend(fit.mass.map(|(mass, std)| {
            format!(
                "the FRFs {} a mass of the joint of {}; k and c are those of a joint with it, and K and C by line, which hold its inertia, are not \
                 compared with them",
                if fit.has_certain_mass() { "show" } else { "most probably show" },
                quantity(mass, std, "kg")
            )
        }));
    all
}

/// What k, c and tests are of where that is no viscous joint, and its losses in its own terms.
fn in_its_terms(fit: &JointFit) -> Option<String> {
    let at = plain(fit.follows.omega / std::f64::consts::TAU, "Hz");
    let shape = |what: &str, unit: &str| {
        fit.follows.shape.map_or(String::new(), |(value, std)| {
            let interval = match unit {
                "" => format!("{} ± {}", significant(value, 3), significant(std, 2)),
                unit => format!("{} ± {}", plain(value, unit), plain(std, unit)),
            };
            format!("; {what} {interval}")
        })
    };
    Some(match fit.follows.law {
        LawKind::Viscous => return None,
        LawKind::Constant => {
            "k and the tests are those of a joint without damping, and c is zero by this law".to_owned()
        }
        LawKind::Structural => {
            let elements = [(0, 0, "k11"), (0, 1, "k12"), (1, 1, "k22")];
            let each: Vec<String> = elements
                .iter()
                .filter_map(|(row, column, name)| {
                    let (loss, std) = fit.loss_factor(*row, *column)?;
                    let [low, high] = interval95(loss, std).map(|end| significant(end, 3));
                    Some(format!("of {name} {} (95 %: {low} to {high})", significant(loss, 3)))
                })
                .collect();
            format!(
                "k, c and the tests are those of a structural joint: the loss factor is {}; c is ηk/ω at {at}, the middle of the band, and falls with frequency",
                listed(&each)
            )
        }
        LawKind::StandardLinearSolid => format!(
            "k, c and the tests are those of a standard linear solid, k and c at {at}, the middle of the band{}",
            shape("relaxation time", "s")
        ),
        LawKind::Fractional => format!(
            "k, c and the tests are those of a springpot beside a spring, k and c at {at}, the middle of the band{}",
            shape("exponent", "")
        ),
        LawKind::LinearStiffness => format!(
            "k, c and the tests are those of a stiffness linear in frequency, k at {at}, the middle of the band"
        ),
    })
}

fn of_misfit(fit: &JointFit) -> Vec<String> {
    let mut all = Vec::new();
    if fit.tolerance_inflation > 1.0 {
        all.push(format!(
                "the fixture's quantities would be farther from what is stated than chance takes them: the ± are {} times as large as noise and tolerances make \
                 them; something is stated wrongly or left out, which `jointscope diagnose` may name",
                significant(fit.tolerance_inflation.sqrt(), 2)
            ));
    }
    if fit.inflation > 1.0 {
        all.push(format!(
                "noise and tolerances do not explain the FRFs (χ² per degree of freedom {}): the noise is taken {} times as large, and the ± hold \
                 how far the joint moves when an eighth of the lines is left out",
                significant(fit.chi2_per_dof, 3),
                significant(fit.inflation.sqrt(), 2)
            ));
    }
    all
}

fn of_limits(fit: &JointFit) -> Vec<String> {
    let mut all = Vec::new();
    if fit.is_on_the_boundary {
        all.push(
            "a free c would give out energy; it is held at the limit of what a passive joint can do"
                .to_owned(),
        );
    }
    all.extend(fit.tests.remarks());
    all
}

fn of_quantities(fit: &JointFit) -> Vec<String> {
    let mut all = Vec::new();
    let far: Vec<String> = fit
        .quantities
        .iter()
        .filter(|quantity| quantity.is_far())
        .map(|quantity| {
            format!("{} by {} standard deviations", quantity.path, significant(quantity.deviations, 2))
        })
        .collect();
    if !far.is_empty() {
        all.push(format!("the FRFs move {}", listed(&far)));
    }
    all
}

impl Remarks for JointTests {
    fn remarks(&self) -> Vec<String> {
        let said = |name: &str| match name {
            "reciprocity" => (self.reciprocity, "k12 and k21 differ: the joint is not reciprocal"),
            "definite" => (self.definite, "k has a negative eigenvalue: the joint would not stay at rest"),
            _ => (self.passive, "c has a negative eigenvalue: the joint would give out energy"),
        };
        let sentence = |name: &str| {
            let (p, what) = said(name);
            Some(format!(
                "{what} (p = {}); a sensor, a place or a block is to be looked at",
                significant(p?, 2)
            ))
        };
        self.failed().into_iter().filter_map(sentence).collect()
    }
}
