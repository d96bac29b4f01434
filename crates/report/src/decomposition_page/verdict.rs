//! The headline and what it rests on.

use jointscope_decomposition::LikelihoodFit;
use jointscope_fixture::{JointLaw, Nature, Quantity};
use jointscope_frf::noise::NoiseSource;

use super::Subject;
use super::element::{Element, Kind};
use super::estimate::{Estimate, Figure, Method};
use crate::format::{fixed, quantity, significant};
use crate::{Tone, Verdict};

/// χ² per degree of freedom above which a constant joint is said not to explain the FRFs.
pub(super) const POOR_FIT: f64 = 1.3;
/// χ² per degree of freedom above which blocks are said not to have moved rigidly.
const NOT_RIGID: f64 = 2.0;
/// Standard deviations beyond which fit and means contradict each other.
const BEYOND_CHANCE: f64 = 3.0;
/// Share of √(k_ii k_jj) by which fit and means may differ before neither is of use.
const CONTRADICTED: f64 = 0.5;
/// Relative uncertainty above which a stiffness counts as not found.
const NOT_FOUND: f64 = 0.5;

pub(super) fn verdict(subject: &Subject) -> Verdict {
    let figure = headline_figure(subject);
    let not_found = figure.total() > NOT_FOUND * figure.value.abs() || !figure.value.is_finite();
    let fit = subject.analysis.likelihood.as_ref().ok();
    let contradiction = contradiction(subject);
    let contradicted = contradiction.as_ref().is_some_and(|c| c.relative > CONTRADICTED);
    let tone = if fit.is_none() || not_found || contradicted {
        Tone::Problem
    } else if poor_fit(fit) || contradiction.is_some() || rigidity(subject).is_some() || !agrees(subject) {
        Tone::Attention
    } else {
        Tone::Ok
    };
    let headline = if contradicted && !not_found {
        let symbol = first(subject).stiffness(subject.best.paper);
        format!(
            "Joint {}: no constant k and c fits these FRFs; {symbol} = {} is not to be used.",
            subject.analysis.joint,
            quantity(figure.value, figure.total(), first(subject).stiffness_unit)
        )
    } else {
        headline(subject, figure, not_found)
    };
    let mut verdict = Verdict::new(tone, headline);
    for sentence in details(subject) {
        verdict = verdict.detail(sentence);
    }
    verdict
}

fn first(subject: &Subject) -> Element {
    Element::all(subject.is_scalar())[0]
}

/// The stiffness the headline states: the best estimate's (1,1).
fn headline_figure(subject: &Subject) -> Figure {
    subject.best.figure(Kind::Stiffness, first(subject))
}

fn headline(subject: &Subject, figure: Figure, not_found: bool) -> String {
    let element = first(subject);
    let symbol = element.stiffness(subject.best.paper);
    let value = quantity(figure.value, figure.total(), element.stiffness_unit);
    let joint = &subject.analysis.joint;
    let mean = match subject.best.method {
        Method::MaximumLikelihood if subject.is_paper() => " (exact joint, maximum likelihood)",
        Method::MaximumLikelihood => "",
        Method::WeightedMean | Method::PlainMean if subject.best.paper => " by eq (7), a mean over the band",
        Method::WeightedMean | Method::PlainMean => ", a mean over the band",
    };
    if not_found {
        return format!("Joint {joint}: this test does not determine {symbol} ({value}{mean}).");
    }
    let nominal = Kind::Stiffness.nominal_average(subject.analysis, element, subject.best.paper);
    match nominal.filter(|n| *n != 0.0) {
        Some(_) if agrees(subject) => {
            format!(
                "Joint {joint}: {symbol} = {value}{mean}, as {} within uncertainty.",
                subject.nominal_owner()
            )
        }
        Some(nominal) => {
            let share = share(figure.value / nominal);
            format!("Joint {joint}: {symbol} = {value}{mean}, {share} of {}.", subject.nominal_owner())
        }
        None => format!("Joint {joint}: {symbol} = {value}{mean}."),
    }
}

/// A ratio as a percentage without needless digits.
pub(super) fn share(ratio: f64) -> String {
    let percent = 100.0 * ratio;
    if (10.0..1000.0).contains(&percent.abs()) {
        format!("{} %", fixed(percent, 0))
    } else {
        format!("{} %", significant(percent, 2))
    }
}

/// An element on which the fit to the FRFs and the mean over lines do not agree, for all their uncertainty.
struct Contradiction {
    /// Share of √(k_ii k_jj) by which they differ.
    relative: f64,
    sentence: String,
}

/// The element that the fit and the weighted mean differ in most; nothing where they agree or are of different relations.
fn contradiction(subject: &Subject) -> Option<Contradiction> {
    if subject.best.method != Method::MaximumLikelihood || subject.is_paper() {
        return None;
    }
    let weighted = Estimate::weighted(subject.analysis)?;
    let plain = Estimate::plain(subject.analysis);
    let elements = Element::all(subject.is_scalar());
    let best = |element: Element| subject.best.figure(Kind::Stiffness, element);
    let size = |element: Element| {
        let at = |index: usize| best(Element { row: index, column: index, ..element }).value.abs().sqrt();
        at(element.row) * at(element.column)
    };
    let differences = elements.iter().filter_map(|&element| {
        let (fit, mean) = (best(element), weighted.figure(Kind::Stiffness, element));
        // Tolerances of the weighted mean are much those of the plain one.
        let tolerance = plain.figure(Kind::Stiffness, element).tolerance.unwrap_or(0.0);
        let difference = (fit.value - mean.value).abs();
        let beyond = difference > BEYOND_CHANCE * fit.total().hypot(mean.noise).hypot(tolerance);
        beyond.then(|| (element, fit.value, mean.value, difference / size(element)))
    });
    let (element, fit, mean, relative) = differences.max_by(|a, b| a.3.total_cmp(&b.3))?;
    let text = |value: f64| quantity(value, None, element.stiffness_unit);
    let sentence = format!(
        "The mean over {} contradicts the fit beyond both ±, most in {}: {} against {}. The model, not the noise, limits what is \
         known of this joint; take the difference for the uncertainty.",
        band(subject),
        element.stiffness(false),
        text(mean),
        text(fit)
    );
    Some(Contradiction { relative, sentence })
}

fn poor_fit(fit: Option<&LikelihoodFit>) -> bool {
    fit.is_some_and(|fit| fit.chi2_per_dof > POOR_FIT)
}

/// χ² per degree of freedom of the rigid motion, where that is too large.
fn rigidity(subject: &Subject) -> Option<f64> {
    subject.analysis.spectrum.h41.rigidity().filter(|r| *r > NOT_RIGID)
}

/// Whether every element of K agrees with the fixture's within both uncertainties.
fn agrees(subject: &Subject) -> bool {
    Element::distinct(subject.is_scalar()).all(|element| {
        let figure = subject.best.figure(Kind::Stiffness, element);
        let Some(nominal) = Kind::Stiffness.nominal_average(subject.analysis, element, subject.best.paper)
        else {
            return false;
        };
        let known = nominal_std(subject, element).unwrap_or(0.0);
        (figure.value - nominal).abs() <= 1.96 * figure.total().hypot(known)
    })
}

/// How well the fixture knows an element of its joint's stiffness.
fn nominal_std(subject: &Subject, element: Element) -> Option<f64> {
    let joint = subject.joint()?;
    let relative = |q: &Quantity, nature: Nature| Some(q.std(nature, false)? / q.value);
    match &joint.law {
        JointLaw::Beam { youngs_modulus, second_moment } => {
            let points = subject.fixture.points();
            let length = subject.fixture.joint_length(joint);
            let end = |point: usize| points.get(point)?.x.std(Nature::Abscissa, false);
            let of_length = end(joint.from)?.hypot(end(joint.to)?) / length;
            // EI/L³, EI/L², EI/L.
            let power = 3.0 - (element.row + element.column) as f64;
            let of_bending = relative(youngs_modulus, Nature::YoungsModulus)?
                .hypot(relative(second_moment, Nature::SecondMoment)?);
            Some(of_bending.hypot(power * of_length) * element.of(&subject.analysis.nominal_stiffness).abs())
        }
        JointLaw::Stiffness { stiffness, .. } => {
            stiffness.get(element.row + element.column)?.std(Nature::JointStiffness, false)
        }
    }
}

fn details(subject: &Subject) -> Vec<String> {
    let mut sentences = Vec::new();
    let figure = headline_figure(subject);
    if figure.total() <= NOT_FOUND * figure.value.abs() {
        sentences.extend(other_elements(subject));
    }
    match &subject.analysis.likelihood {
        Ok(fit) => sentences.push(rests_on(subject, fit)),
        Err(error) => sentences.push(format!(
            "{}. The figures below are means over {} ({} lines, {}).",
            capitalised(&error.to_string()),
            band(subject),
            subject.analysis.averages.lines,
            noise(subject)
        )),
    }
    sentences.extend(paper_means(subject));
    if let Ok(fit) = &subject.analysis.likelihood
        && fit.chi2_per_dof > POOR_FIT
    {
        sentences.push(format!(
            "χ²/dof = {}: one constant k and c does not explain the FRFs within their noise. What may be behind it: \
             masses, lengths or sensor places that are a little off (enough where noise is as low as here), a block, \
             sensor or interface that does more than the model says, or a joint that changes with frequency. The ± \
             of the fit hold how far it moves when an eighth of the lines is left out; trust them as far as K below is level.",
            significant(fit.chi2_per_dof, 2)
        ));
    }
    sentences.extend(contradiction(subject).map(|contradiction| contradiction.sentence));
    if let Some(rigidity) = rigidity(subject) {
        sentences.push(format!(
            "The blocks did not move rigidly: surplus FRFs contradict each other (χ²/dof {}). A sensor, a place or a \
             block that bends is to be checked first.",
            significant(rigidity, 2)
        ));
    }
    sentences
}

/// What eq (7) gives, and that it is something else than the figures above.
fn paper_means(subject: &Subject) -> Option<String> {
    if !subject.is_paper() {
        return None;
    }
    let mean = Estimate::plain(subject.analysis);
    let element = first(subject);
    let figure = mean.figure(Kind::Stiffness, element);
    Some(format!(
        "Eq (7) gives {} = {} as a plain mean over {}. It leaves out that a rotation of one end of the joint moves the other, so it \
         varies with frequency even for a constant joint, and its mean depends on the band. The maximum-likelihood figures are the \
         exact joint's.",
        element.stiffness(true),
        quantity(figure.value, figure.total(), element.stiffness_unit),
        band(subject)
    ))
}

/// The other elements of K against the fixture's.
fn other_elements(subject: &Subject) -> Option<String> {
    let shares: Vec<String> = Element::distinct(subject.is_scalar())
        .skip(1)
        .filter_map(|element| {
            let paper = subject.best.paper;
            let nominal = Kind::Stiffness.nominal_average(subject.analysis, element, paper)?;
            let figure = subject.best.figure(Kind::Stiffness, element);
            let symbol = element.stiffness(paper);
            if figure.total() > NOT_FOUND * figure.value.abs() {
                return Some(format!("{symbol} is not determined"));
            }
            (nominal != 0.0).then(|| format!("{symbol} is {}", share(figure.value / nominal)))
        })
        .collect();
    let all = shares.join(", ");
    (!shares.is_empty()).then(|| format!("Compared with {}, {all}.", subject.nominal_owner()))
}

fn rests_on(subject: &Subject, fit: &LikelihoodFit) -> String {
    let analysis = subject.analysis;
    let channels = analysis.plan.layout.channels.len().max(1);
    let lines = fit.values / channels;
    let all = analysis.spectrum.h41.lines.len();
    let whole = lines == analysis.spectrum.solved.len();
    let range = if whole { solved_range(subject) } else { band(subject) };
    let explained = if fit.chi2_per_dof > POOR_FIT {
        String::new()
    } else {
        format!(
            " χ²/dof = {}: one constant k and c explains the FRFs within their noise.",
            significant(fit.chi2_per_dof, 3)
        )
    };
    format!(
        "Maximum likelihood by the exact relation, {channels} {}, {lines} of {all} lines ({range}), {}. The ± are one \
         standard deviation, from noise and the fixture's tolerances together.{explained}",
        if channels == 1 { "FRF" } else { "FRFs" },
        noise(subject)
    )
}

fn solved_range(subject: &Subject) -> String {
    let solved = &subject.analysis.spectrum.solved;
    match (solved.first(), solved.last()) {
        (Some(first), Some(last)) => hertz(first.frequency, last.frequency),
        _ => String::new(),
    }
}

pub(super) fn band(subject: &Subject) -> String {
    let band = subject.analysis.averages.band;
    hertz(band.from, band.to)
}

/// `474 to 843.5 Hz`.
pub(super) fn hertz(from: f64, to: f64) -> String {
    format!("{} to {} Hz", plain(from), plain(to))
}

/// A frequency without zeros at its end.
pub(super) fn plain(hz: f64) -> String {
    let text = fixed(hz, 2);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

pub(super) fn noise(subject: &Subject) -> String {
    let analysis = subject.analysis;
    let used = analysis.plan.layout.channels.iter().filter_map(|(index, ..)| analysis.noise.get(*index));
    let sources: Vec<NoiseSource> = used.copied().collect();
    let scatter = sources.iter().filter(|source| **source == NoiseSource::Scatter).count();
    match (sources.len(), scatter) {
        (0, _) => "noise as stated with the FRFs".into(),
        (_, 0) => "noise from coherence and averages".into(),
        (all, some) if some == all => "noise estimated from the FRFs' scatter from line to line".into(),
        (all, some) => format!("noise from coherence, for {some} of {all} FRFs from their scatter"),
    }
}

fn capitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
