//! K and C over the spectral lines.

use jointscope_decomposition::{Analysis, DynamicStiffnessPart, JointEstimate, MatrixElement, Method};
use jointscope_inference::interval95;

use super::subject::Subject;
use crate::plot::{AVERAGING_BAND, Axis, Plot, Role, Span, YRange};
use crate::section::Section;
use jointscope_wording::element::{meaning, symbol, unit};

pub(super) fn sections(subject: &Subject) -> [Section; 2] {
    let columns = if subject.is_scalar() { 1 } else { 2 };
    let symbols = if subject.is_paper() { ("K", "C") } else { ("k", "c") };
    [(DynamicStiffnessPart::Stiffness, "Stiffness", symbols.0), (DynamicStiffnessPart::Damping, "Damping", symbols.1)].map(
        |(part, word, symbol)| {
            let mut section = Section::new(format!("{word} by line")).paragraph(introduction(subject, part, symbol));
            if part == DynamicStiffnessPart::Stiffness && subject.is_paper() {
                section = section.paragraph(
                    "Eq (7) takes the motion at both ends of the joint as that of one place. It leaves out the transport \
                     R = [[1, L],[0, 1]] over the joint's length: a rotation of the near end moves the far end by L·θ, and a \
                     force there is a moment F·L here. On a beam of length L the result varies with frequency, has peaks, is \
                     not symmetric, and tends to EI/L³·[[12, 6L],[−6L, −2L²]] at high frequency: K₂₁ and K₂₂ are negative \
                     there. Signs are those of eq (7).",
                );
            }
            let elements = MatrixElement::all(subject.is_scalar());
            section.plots(columns, elements.iter().map(|element| plot(subject, part, *element)))
        },
    )
}

fn introduction(subject: &Subject, part: DynamicStiffnessPart, symbol: &str) -> String {
    let analysis = subject.analysis;
    let noisy = analysis.noisy_lines();
    let of = match part {
        DynamicStiffnessPart::Stiffness => "the real part of the dynamic stiffness",
        DynamicStiffnessPart::Damping => "its imaginary part over ω",
    };
    let solved = analysis.spectrum.solved.len();
    let dots = match noisy {
        0 => String::new(),
        n => format!(
            " Dots: {n} of {solved} lines on which noise exceeds 30 % of an element of k; the interval is only indicative there."
        ),
    };
    let mass = if analysis.lines_hold_mass() {
        " The joint has a mass of its own, of which these lines know nothing: they hold its inertia and are no stiffness of the joint alone. \
         The law drawn over them has that inertia in it; k and c above have not, and are not held against these lines."
    } else {
        ""
    };
    format!(
        "{symbol} on each line, {of}, by {}. The light band is the 95 % interval from noise alone, gaps are masked lines.{dots}{mass}",
        subject.relation_words()
    )
}

fn plot(subject: &Subject, part: DynamicStiffnessPart, element: MatrixElement) -> Plot {
    let analysis = subject.analysis;
    let paper = subject.is_paper();
    let symbol = symbol(part, element, paper);
    let columns = Columns::of(analysis, part, element);
    let level = level(subject, part, element);
    let range = columns.range(analysis, level.map(|(_, value)| value));
    let band = analysis.averages.band;
    let axis = Axis::linear(symbol.clone(), unit(part, element));
    let mut plot = Plot::new(format!("{symbol}, {}", meaning(part, element)), Axis::frequency(), axis)
        .over(analysis.spectrum.h41.lines.hz());
    if columns.low.iter().any(Option::is_some) {
        plot = plot.band("95 % interval", Role::Uncertainty, columns.low, columns.high);
    }
    if columns.noisy.iter().any(Option::is_some) {
        plot = plot.points("noise dominates", Role::Uncertainty, columns.noisy);
    }
    plot = plot.line("by line", Role::Measured, columns.quiet);
    if columns.nominal.iter().any(Option::is_some) {
        plot = plot.dashed("nominal", Role::Nominal, columns.nominal);
    } else if let Some(nominal) = analysis.nominal_average(part, element, paper) {
        plot = plot.horizontal("nominal", Role::Nominal, nominal);
    }
    match law(subject, part, element) {
        Some(values) => plot = plot.line("law from all FRFs", Role::Estimate, values),
        None => {
            if let Some((label, value)) = level {
                plot = plot.horizontal(label, Role::Estimate, value);
            }
        }
    }
    plot.shaded(AVERAGING_BAND, band.from, band.to)
        .y_range(range)
        .masked(analysis.spectrum.masked.len())
        .caption(caption(subject, part, element))
}

/// The law that the joint's numbers are of over the lines, its mass included as the lines hold it; of spectra
/// by the exact relation, where laws were compared.
fn law(subject: &Subject, part: DynamicStiffnessPart, element: MatrixElement) -> Option<Vec<Option<f64>>> {
    let analysis = subject.analysis;
    let fit = analysis.joint_fit.as_ref().ok().filter(|_| !subject.is_paper())?;
    // Without laws and mass it is level, which is drawn as such.
    if fit.law().is_none() && fit.mass.is_none() {
        return None;
    }
    let at = |line: usize| analysis.fitted_at(line).map(|both| element.of(&part.of(both)));
    Some((0..analysis.spectrum.h41.lines.len()).map(at).collect())
}

/// The horizontal line: the best figure of the same relation as the spectrum.
fn level(
    subject: &Subject,
    part: DynamicStiffnessPart,
    element: MatrixElement,
) -> Option<(&'static str, f64)> {
    if subject.analysis.lines_hold_mass() {
        return None;
    }
    let estimate = if subject.best.paper == subject.is_paper() {
        *subject.best
    } else {
        JointEstimate::weighted(subject.analysis).unwrap_or_else(|| JointEstimate::plain(subject.analysis))
    };
    let label = match estimate.method {
        Method::MaximumLikelihood => "maximum likelihood",
        Method::AllFrfs => "all FRFs",
        Method::WeightedMean => "weighted mean",
        Method::PlainMean => "mean",
    };
    Some((label, estimate.figure(part, element).value)).filter(|(_, value)| value.is_finite())
}

fn caption(subject: &Subject, part: DynamicStiffnessPart, element: MatrixElement) -> String {
    let symbol = symbol(part, element, subject.is_paper());
    let what = if subject.is_paper() {
        "eq (7) varies over the lines even for a constant joint; the dashed curve is what it makes of the fixture's".to_owned()
    } else if subject.analysis.lines_hold_mass() {
        "with the inertia of the joint's mass, as the law drawn has it; without one a constant joint would be level".to_owned()
    } else {
        "a constant joint would be level".to_owned()
    };
    format!("{symbol}: {what}.")
}

/// One element over all lines of the recording.
struct Columns {
    quiet: Vec<Option<f64>>,
    noisy: Vec<Option<f64>>,
    low: Vec<Option<f64>>,
    high: Vec<Option<f64>>,
    nominal: Vec<Option<f64>>,
}

impl Columns {
    fn of(analysis: &Analysis, part: DynamicStiffnessPart, element: MatrixElement) -> Self {
        let count = analysis.spectrum.h41.lines.len();
        let empty = || vec![None; count];
        let mut columns =
            Columns { quiet: empty(), noisy: empty(), low: empty(), high: empty(), nominal: empty() };
        for line in &analysis.spectrum.solved {
            let value = element.of(part.of((&line.stiffness, &line.damping)));
            let std = part.of((&line.stiffness_std, &line.damping_std)).as_ref().map(|std| element.of(std));
            let column = if line.is_noisy() { &mut columns.noisy } else { &mut columns.quiet };
            column[line.line] = Some(value);
            if let Some(std) = std {
                let [low, high] = interval95(value, std);
                columns.low[line.line] = Some(low);
                columns.high[line.line] = Some(high);
            }
        }
        for (line, nominal) in columns.nominal.iter_mut().enumerate() {
            *nominal = analysis.nominal_at(line, part, element);
        }
        columns
    }

    /// What is drawn at first: the middle of the averaging band's lines, the level and nominal curves there,
    /// and some room about them for the other lines. Poles and noisy lines would squash all of it.
    fn range(&self, analysis: &Analysis, level: Option<f64>) -> YRange {
        let hz = analysis.spectrum.h41.lines.hz();
        let band = |hz: f64| analysis.averages.band.contains(hz);
        let inside = within(&self.quiet, hz, band).chain(within(&self.noisy, hz, band));
        let middle = Span::percentiles(inside, YRange::ROBUST);
        let nominal = Span::percentiles(within(&self.nominal, hz, band), (5.0, 95.0));
        let span = middle.and(nominal).and(Span::of(level));
        let most = Span::percentiles(within(&self.quiet, hz, |_| true), (5.0, 95.0));
        let (Some(_), Some((low, high))) = (middle.0, span.0) else { return YRange::Robust };
        let room = (middle.width() + 0.5 * span.width()).max(0.02 * span.magnitude());
        let (a, b) = most.0.unwrap_or((low, high));
        YRange::Fixed {
            low: (low - 0.3 * room).min(a.max(low - room)),
            high: (high + 0.3 * room).max(b.min(high + room)),
        }
    }
}

/// Values at the frequencies (Hz) asked for.
fn within(values: &[Option<f64>], hz: &[f64], inside: impl Fn(f64) -> bool) -> impl Iterator<Item = f64> {
    values.iter().zip(hz).filter_map(move |(value, hz)| value.filter(|_| inside(*hz)))
}
