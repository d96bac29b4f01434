//! The FRFs of the baseline and of the recording, and what the models make of both and of their difference.

use jointscope_diagnosis::{Baseline, Fit, Observation};
use num_complex::Complex64;

use super::frfs::{panes, shown, shown_of, with_held_out};
use super::subject::Subject;
use crate::plot::{Axis, Curve, FrfPanes, Plot, Role, Style, YRange};
use crate::section::Section;

/// The colour of the baseline among those of equal curves: the recording that was diagnosed has its own.
const BEFORE: usize = 2;

pub(super) fn section(subject: &Subject, baseline: &Baseline) -> Section {
    let models = match subject.diagnosis.findings.is_empty() {
        true => "as the fixture calibrated on the baseline predicts it",
        false => "as the fixture predicts them, calibrated on the baseline and repaired with what was found",
    };
    let mut section = Section::new("FRFs").paragraph(format!(
        "Accelerances as measured, with the 95 % band of their noise, those of the baseline, and {models}.{}",
        shown_of(subject)
    ));
    let states = States { subject, baseline };
    for index in shown(subject) {
        let plots = if states.on_the_same_lines() { states.together(index) } else { states.apart(index) };
        let panes = panes(subject, index, super::frfs::models(subject, index));
        section = section.plots(2, with_held_out(subject, index, plots.into_iter().chain(panes.below())));
    }
    section
}

struct States<'s, 'a> {
    subject: &'s Subject<'a>,
    baseline: &'a Baseline,
}

impl<'a> States<'_, 'a> {
    fn on_the_same_lines(&self) -> bool {
        self.baseline.observation.lines() == self.subject.diagnosis.observation.lines()
    }

    /// Both states in one pane, and their difference in another.
    fn together(&self, index: usize) -> [Plot; 2] {
        let mut curves = vec![self.recorded_before(index), self.calibrated(index)];
        curves.extend(self.repaired(index));
        let panes = panes(self.subject, index, curves);
        let caption = match self.subject.diagnosis.findings.is_empty() {
            true => {
                "Magnitude; where the recordings part something has changed, be it from one test to the next."
            }
            false => {
                "Magnitude; where the recordings part something has changed, and what the repaired model follows of it is explained."
            }
        };
        // Of a recording compared with itself there is no change to draw.
        let second = match panes.measured == self.recorded_before(index).values {
            true => panes.phase().caption("Phase; the recording is that of the baseline."),
            false => self.difference(&panes, index),
        };
        [panes.magnitude().caption(caption), second]
    }

    /// The change of an FRF, recorded and predicted.
    fn difference(&self, now: &FrfPanes<'a>, index: usize) -> Plot {
        let sizes = |now: &[Option<Complex64>], before: &[Option<Complex64>]| -> Vec<Option<f64>> {
            now.iter()
                .zip(before)
                .map(|(now, before)| now.zip(*before).map(|(a, b)| (a - b).norm()))
                .collect()
        };
        let recorded = sizes(&now.measured, &self.recorded_before(index).values);
        let axis = Axis::logarithmic(format!("|Δ{}|", now.symbol), now.unit);
        let plot = Plot::new(format!("Change of {}", now.title), Axis::frequency(), axis)
            .over(now.hz)
            .y_range(YRange::decades(recorded.iter().flatten().copied().filter(|size| *size > 0.0)))
            .line("recorded", Role::Measured, recorded)
            .height(220);
        let repaired = self.repaired(index);
        let caption = match repaired.is_some() {
            true => {
                "Magnitude of the difference between the two recordings, and between the repaired and the calibrated model."
            }
            false => "Magnitude of the difference between the two recordings.",
        };
        let predicted = |repaired: Curve| sizes(&repaired.values, &self.calibrated(index).values);
        repaired
            .map(predicted)
            .into_iter()
            .fold(plot, |plot, sizes| plot.series(Style::Line, "predicted", Role::Highlight, sizes))
            .caption(caption)
    }

    /// Each state in a pane of its own: the lines are not the same.
    fn apart(&self, index: usize) -> [Plot; 2] {
        let now = panes(self.subject, index, self.repaired(index).into_iter().collect());
        let before = FrfPanes {
            title: format!("{}, baseline", now.title),
            hz: self.baseline.observation.lines().hz(),
            measured: self.recorded_before(index).values,
            noise: Vec::new(),
            coherence: self.baseline.observation.coherence(index),
            curves: vec![self.calibrated(index)],
            ..now.clone()
        };
        let caption = "Magnitude; the lines of the two recordings are not the same.";
        [before.magnitude().caption(caption), now.magnitude().caption(caption)]
    }

    fn recorded_before(&self, index: usize) -> Curve {
        let observation = &self.baseline.observation;
        let values = of_frf(observation, observation.values(), index);
        Curve { label: "baseline", role: Role::Trace(BEFORE), style: Style::Line, values }
    }

    fn calibrated(&self, index: usize) -> Curve {
        let values = of_frf(&self.baseline.observation, &self.baseline.calibrated.predicted, index);
        Curve { label: "calibrated", role: Role::Reference, style: Style::Dashed, values }
    }

    /// The model with the findings, where there are any.
    fn repaired(&self, index: usize) -> Option<Curve> {
        let diagnosis = self.subject.diagnosis;
        let of = |fit: &Fit| of_frf(&diagnosis.observation, &fit.predicted, index);
        (!diagnosis.findings.is_empty()).then(|| Curve {
            label: "repaired",
            role: Role::Highlight,
            style: Style::Dashed,
            values: of(&diagnosis.search.repaired),
        })
    }
}

/// The values of FRF `index` of those of an observation.
fn of_frf(observation: &Observation, values: &[Complex64], index: usize) -> Vec<Option<Complex64>> {
    let n = observation.lines().len();
    values[index * n..(index + 1) * n].iter().map(|v| Some(*v)).collect()
}
