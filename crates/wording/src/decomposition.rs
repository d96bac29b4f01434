//! A decomposition in words: its headline and what that rests on, and what was found, a line each. What is
//! decided is decided by [`Judgement`](jointscope_decomposition::Judgement).

use crate::element::{symbol, unit};
use crate::format::{fixed, quantity, significant, trimmed};
use crate::numbers::counted;
use crate::{Remarks, Summary, capitalised};
use jointscope_decomposition::{
    Analysis, Contradiction, DynamicStiffnessPart, ElementFigure, JointEstimate, JointFit, JointsFit,
    LikelihoodFit, MatrixElement, Method, Relation, Use,
};
use jointscope_fixture::{Fixture, JointLaw};
use jointscope_frf::noise::NoiseSource;

/// What a page says first of a joint.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JointSummary {
    /// What the joint is, beside the fixture's.
    pub headline: String,
    /// What that rests on, and what speaks against it.
    pub details: Vec<String>,
}

impl JointSummary {
    /// Of `best`, an estimate of `analysis`, which was made with `fixture`.
    pub fn of(analysis: &Analysis, fixture: &Fixture, best: &JointEstimate) -> Self {
        let subject = Subject { analysis, fixture, best };
        JointSummary { headline: headline(&subject), details: details(&subject) }
    }
}

/// What the sentences are made from.
struct Subject<'a> {
    analysis: &'a Analysis,
    fixture: &'a Fixture,
    best: &'a JointEstimate,
}

impl Subject<'_> {
    fn is_paper(&self) -> bool {
        self.analysis.spectrum.relation == Relation::Paper
    }

    fn is_scalar(&self) -> bool {
        self.analysis.spectrum.scalar
    }

    /// Whose the nominal stiffness is.
    fn nominal_owner(&self) -> &'static str {
        match self.fixture.joint(&self.analysis.joint).map(|joint| &joint.law) {
            Some(JointLaw::Beam { .. }) => "the nominal beam's",
            _ => "the fixture's",
        }
    }
}

fn first(subject: &Subject) -> MatrixElement {
    MatrixElement::all(subject.is_scalar())[0]
}

/// A figure of an estimate's K with its uncertainty.
fn value(estimate: &JointEstimate, element: MatrixElement) -> (ElementFigure, String) {
    let figure = estimate.figure(DynamicStiffnessPart::Stiffness, element);
    (figure, quantity(figure.value, figure.total(), unit(DynamicStiffnessPart::Stiffness, element)))
}

fn headline(subject: &Subject) -> String {
    let (element, best, judgement) = (first(subject), subject.best, &subject.analysis.judgement);
    let (joint, owner) = (&subject.analysis.joint, subject.nominal_owner());
    let symbol = symbol(DynamicStiffnessPart::Stiffness, element, best.paper);
    let (figure, value) = value(best, element);
    let mean = match best.method {
        Method::AllFrfs if subject.is_paper() => " (exact joint, all FRFs)",
        Method::MaximumLikelihood if subject.is_paper() => " (exact joint, maximum likelihood)",
        Method::AllFrfs | Method::MaximumLikelihood => "",
        _ if best.paper => " by eq (7), a mean over the band",
        _ => ", a mean over the band",
    };
    if !figure.is_determined() {
        return format!("Joint {joint}: this test does not determine {symbol} ({value}{mean}).");
    }
    let excluded = judgement.contradiction.filter(|contradiction| contradiction.excludes_use());
    if judgement.verdict == Use::Unusable && excluded.is_some() {
        return format!(
            "Joint {joint}: no constant k and c fits these FRFs; {symbol} = {value} is not to be used."
        );
    }
    let nominal = subject.analysis.nominal_average(DynamicStiffnessPart::Stiffness, element, best.paper);
    match nominal.filter(|nominal| *nominal != 0.0) {
        Some(_) if judgement.agrees_with_fixture => {
            format!("Joint {joint}: {symbol} = {value}{mean}, as {owner} within uncertainty.")
        }
        Some(nominal) => {
            format!("Joint {joint}: {symbol} = {value}{mean}, {} of {owner}.", share(figure.value / nominal))
        }
        None => format!("Joint {joint}: {symbol} = {value}{mean}."),
    }
}

/// A ratio as a percentage without needless digits.
pub fn share(ratio: f64) -> String {
    let percent = 100.0 * ratio;
    let is_plain = (10.0..1000.0).contains(&percent.abs());
    format!("{} %", if is_plain { fixed(percent, 0) } else { significant(percent, 2) })
}

fn details(subject: &Subject) -> Vec<String> {
    let judgement = &subject.analysis.judgement;
    let whole = subject.analysis.joint_fit.as_ref().ok();
    let rests_on = match (whole, &subject.analysis.likelihood) {
        (Some(whole), _) => rests_on_all(subject, whole),
        (None, Ok(fit)) => rests_on(subject, fit),
        (None, Err(error)) => format!(
            "{}. The figures below are means over {} ({} lines, {}).",
            capitalised(&error.to_string()),
            band(subject.analysis),
            subject.analysis.averages.lines,
            noise(subject)
        ),
    };
    let remarks = whole.map(Remarks::remarks).unwrap_or_default();
    let poor_fit = judgement.poor_fit.filter(|_| whole.is_none()).map(|chi2| {
        format!(
            "χ²/dof = {}: one constant k and c does not explain the FRFs within their noise. What may be behind it: \
             masses, lengths or sensor places that are a little off (enough where noise is as low as here), a block, \
             sensor or interface that does more than the model says, or a joint that changes with frequency. The ± \
             of the fit hold how far it moves when an eighth of the lines is left out; trust them as far as K below is level.",
            significant(chi2, 2)
        )
    });
    let not_rigid = judgement.not_rigid.map(|chi2| {
        format!(
            "The blocks did not move rigidly: surplus FRFs contradict each other (χ²/dof {}). A sensor, a place or a \
             block that bends is to be checked first.",
            significant(chi2, 2)
        )
    });
    let contradiction = judgement.contradiction.map(|contradiction| contradicted(subject, contradiction));
    let sentences =
        [other_elements(subject), Some(rests_on), paper_means(subject), poor_fit, contradiction, not_rigid];
    let remarks = remarks.iter().map(|remark| format!("{}.", capitalised(remark)));
    sentences.into_iter().flatten().chain(remarks).collect()
}

fn contradicted(subject: &Subject, Contradiction { element, fit, mean, .. }: Contradiction) -> String {
    let text = |value: f64| quantity(value, None, unit(DynamicStiffnessPart::Stiffness, element));
    format!(
        "The mean over {} contradicts the fit beyond both ±, most in {}: {} against {}. The model, not the noise, limits what is \
         known of this joint; take the difference for the uncertainty.",
        band(subject.analysis),
        symbol(DynamicStiffnessPart::Stiffness, element, false),
        text(mean),
        text(fit)
    )
}

/// What eq (7) gives, and that it is something else than the figures above.
fn paper_means(subject: &Subject) -> Option<String> {
    let element = first(subject);
    let (_, value) = value(&JointEstimate::plain(subject.analysis), element);
    subject.is_paper().then(|| {
        format!(
            "Eq (7) gives {} = {value} as a plain mean over {}. It leaves out that a rotation of one end of the joint moves the other, so it \
             varies with frequency even for a constant joint, and its mean depends on the band. The maximum-likelihood figures are the \
             exact joint's.",
            symbol(DynamicStiffnessPart::Stiffness, element, true),
            band(subject.analysis)
        )
    })
}

/// The other elements of K against the fixture's, where the first is determined.
fn other_elements(subject: &Subject) -> Option<String> {
    let (best, paper) = (subject.best, subject.best.paper);
    let is_determined = |element| best.figure(DynamicStiffnessPart::Stiffness, element).is_determined();
    let elements =
        MatrixElement::distinct(subject.is_scalar()).skip(1).filter(|_| is_determined(first(subject)));
    let shares = elements.filter_map(|element| {
        let nominal = subject.analysis.nominal_average(DynamicStiffnessPart::Stiffness, element, paper)?;
        let symbol = symbol(DynamicStiffnessPart::Stiffness, element, paper);
        if !is_determined(element) {
            return Some(format!("{symbol} is not determined"));
        }
        let value = best.figure(DynamicStiffnessPart::Stiffness, element).value;
        (nominal != 0.0).then(|| format!("{symbol} is {}", share(value / nominal)))
    });
    let shares: Vec<String> = shares.collect();
    (!shares.is_empty()).then(|| format!("Compared with {}, {}.", subject.nominal_owner(), shares.join(", ")))
}

/// What the joint from all FRFs rests on.
fn rests_on_all(subject: &Subject, fit: &JointFit) -> String {
    let range = match (&subject.analysis.spectrum.solved[..], fit.lines) {
        ([first, .., last], lines) if lines == subject.analysis.spectrum.h41.lines.len() => {
            format!(" ({})", hertz(first.frequency, last.frequency))
        }
        _ => String::new(),
    };
    let fixture = match fit.quantities.is_empty() {
        true => "the fixture taken as exact. The ± are one standard deviation, from noise",
        false => {
            "the fixture's quantities moving within their tolerances. The ± are one standard deviation, noise and tolerances together"
        }
    };
    format!(
        "From {} {} on {} lines{range}, {}, {fixture}. χ²/dof = {}.",
        fit.frfs.len(),
        if fit.frfs.len() == 1 { "FRF" } else { "FRFs" },
        fit.lines,
        noise(subject),
        significant(fit.chi2_per_dof, 3)
    )
}

fn rests_on(subject: &Subject, fit: &LikelihoodFit) -> String {
    let analysis = subject.analysis;
    let channels = analysis.plan.layout.channels.len().max(1);
    let lines = fit.values / channels;
    let (solved, all) = (&analysis.spectrum.solved, analysis.spectrum.h41.lines.len());
    let range = match (solved.first(), solved.last()) {
        (Some(first), Some(last)) if lines == solved.len() => hertz(first.frequency, last.frequency),
        _ => band(subject.analysis),
    };
    let explained = match analysis.judgement.poor_fit {
        Some(_) => String::new(),
        None => format!(
            " χ²/dof = {}: one constant k and c explains the FRFs within their noise.",
            significant(fit.chi2_per_dof, 3)
        ),
    };
    format!(
        "Maximum likelihood by the exact relation, {channels} {}, {lines} of {all} lines ({range}), {}. The ± are one \
         standard deviation, from noise and the fixture's tolerances together.{explained}",
        if channels == 1 { "FRF" } else { "FRFs" },
        noise(subject)
    )
}

/// The band of the averages: `474 to 843.5 Hz`.
pub fn band(analysis: &Analysis) -> String {
    let band = analysis.averages.band;
    hertz(band.from, band.to)
}

/// `474 to 843.5 Hz`.
fn hertz(from: f64, to: f64) -> String {
    format!("{} to {} Hz", plain(from), plain(to))
}

/// A frequency without zeros at its end.
pub fn plain(hz: f64) -> String {
    trimmed(&fixed(hz, 2))
}

fn noise(subject: &Subject) -> String {
    let analysis = subject.analysis;
    let used = analysis.plan.layout.channels.iter().filter_map(|(index, ..)| analysis.noise.get(*index));
    let sources: Vec<&NoiseSource> = used.collect();
    let scatter = sources.iter().filter(|source| source.is_by_scatter()).count();
    match (sources.len(), scatter) {
        (0, _) => "noise as stated with the FRFs".into(),
        (_, 0) => "noise from coherence and averages".into(),
        (all, some) if some == all => "noise estimated from the FRFs' scatter from line to line".into(),
        (all, some) => format!("noise from coherence, for {some} of {all} FRFs from their scatter"),
    }
}

impl Summary for JointsFit {
    fn summary(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for joint in &self.joints {
            lines.push(format!("joint {}", joint.name));
            lines.extend(numbers(&joint.fit, elements_of(joint.fit.scalar)));
            lines.extend(joint.remarks());
        }
        lines.extend(self.joints.first().map(|first| basis(&first.fit)));
        lines.extend(self.remarks());
        lines
    }
}

impl Summary for Analysis {
    fn summary(&self) -> Vec<String> {
        let spectrum = &self.spectrum;
        let all = spectrum.solved.len() + spectrum.masked.len();
        let mut lines =
            vec![format!("joint {}: {} of {all} lines solved", self.joint, spectrum.solved.len())];
        for (reason, count) in spectrum.masked_summary() {
            lines.push(format!("{} masked: {}", counted(count, "line"), reason.why()));
        }
        match self.noisy_lines() {
            0 => {}
            1 => lines.push("1 line is dominated by noise; its interval is only indicative".to_owned()),
            noisy => lines
                .push(format!("{noisy} lines are dominated by noise; their intervals are only indicative")),
        }
        let elements = elements_of(spectrum.scalar);
        match (&self.joint_fit, &self.likelihood) {
            (Ok(fit), _) => lines.extend(all_frfs(fit, elements)),
            (Err(error), Ok(fit)) => {
                lines.push(format!("{error}; from the FRFs across the joint alone:"));
                lines.extend(across(self, fit, elements));
            }
            (Err(error), Err(_)) => lines.push(error.to_string()),
        }
        lines
    }
}

const UNITS: [[&str; 3]; 2] = [["N/m", "N/rad", "N*m/rad"], ["N*s/m", "N*s/rad", "N*m*s/rad"]];

/// The elements of a symmetric matrix, or the one that means anything where bodies do not rotate.
fn elements_of(scalar: bool) -> &'static [(usize, usize)] {
    if scalar { &[(0, 0)] } else { &[(0, 0), (0, 1), (1, 1)] }
}

/// The joint from all FRFs, an element a line, and what is to be known of it.
fn all_frfs(fit: &JointFit, elements: &[(usize, usize)]) -> Vec<String> {
    let mut lines = numbers(fit, elements);
    lines.push(basis(fit));
    lines.extend(fit.remarks());
    lines
}

fn numbers(fit: &JointFit, elements: &[(usize, usize)]) -> Vec<String> {
    let (k_std, c_std) = fit.std();
    let parts = [("k", &fit.stiffness, k_std), ("c", &fit.damping, c_std)];
    let mut lines = Vec::new();
    for ((symbol, value, std), units) in parts.into_iter().zip(UNITS) {
        for &(i, j) in elements {
            let text = quantity(value.at(i, j), std.at(i, j), units[i + j]);
            lines.push(format!("{symbol}{}{} = {text}", i + 1, j + 1));
        }
    }
    lines
}

/// What a fit rests on.
fn basis(fit: &JointFit) -> String {
    let fixture = match fit.quantities.is_empty() {
        true => "the fixture taken as exact",
        false => "the fixture moving within its tolerances",
    };
    format!(
        "from {} over {}, {fixture}; chi2 per degree of freedom {:.3}",
        counted(fit.frfs.len(), "FRF"),
        counted(fit.lines, "line"),
        fit.chi2_per_dof
    )
}

/// The joint from the FRFs across it, with the fixture taken as exact.
fn across(analysis: &Analysis, fit: &LikelihoodFit, elements: &[(usize, usize)]) -> Vec<String> {
    let (k_fixture, c_fixture) = analysis.tolerance_of_likelihood();
    let (k_model, c_model) = fit.model_std();
    let parts = [
        ("k", &fit.stiffness, [fit.stiffness_std, k_fixture, k_model]),
        ("c", &fit.damping, [fit.damping_std, c_fixture, c_model]),
    ];
    let mut lines = Vec::new();
    for ((symbol, value, shares), units) in parts.into_iter().zip(UNITS) {
        for &(i, j) in elements {
            let std = shares.iter().map(|share| share.at(i, j).powi(2)).sum::<f64>().sqrt();
            let text = quantity(value.at(i, j), std, units[i + j]);
            lines.push(format!("{symbol}{}{} = {text}", i + 1, j + 1));
        }
    }
    lines.push(format!("chi2 per degree of freedom of this constant joint: {:.3}", fit.chi2_per_dof));
    if !fit.explains() {
        lines.push(
            "with the fixture as stated, a constant joint does not explain the FRFs within their noise; the ± allow for \
             it as far as the band shows, and the page says what may be behind it"
                .to_owned(),
        );
    }
    lines
}
