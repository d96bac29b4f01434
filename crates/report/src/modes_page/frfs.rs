//! FRFs: measured, and rebuilt from the modes.

use jointscope_modes::ModalAnalysis;

use super::{LINE_LIMIT, SHOWN};
use crate::phase::{degrees, in_the_quietest_turn};
use crate::{Axis, Plot, Role, Section};

pub(super) fn section(analysis: &ModalAnalysis) -> Section {
    let errors = analysis.relative_errors();
    let mut shown: Vec<usize> = (0..errors.len()).collect();
    shown.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]));
    shown.truncate(SHOWN);
    shown.sort_unstable();
    let some = if shown.len() < errors.len() {
        format!(" Shown are the {} of {} that are met worst.", shown.len(), errors.len())
    } else {
        String::new()
    };
    let section = Section::new("FRFs").paragraph(format!(
        "Accelerances as measured with the 95 % band of their noise, and rebuilt from modes and residual terms.{some}"
    ));
    shown
        .into_iter()
        .fold(section, |section, frf| section.plots(2, [magnitude(analysis, frf), phase(analysis, frf)]))
}

fn magnitude(analysis: &ModalAnalysis, frf: usize) -> Plot {
    let measured = analysis.measured();
    let (name, values) = (analysis.pairs()[frf].to_string(), measured.values(frf));
    // Each part of a value has half its variance, and the modulus takes one part of the noise.
    let half: Vec<f64> = measured
        .variance(frf)
        .unwrap_or_default()
        .iter()
        .map(|variance| 1.96 * (0.5 * variance).sqrt())
        .collect();
    let low = values.iter().zip(&half).map(|(v, half)| (v.norm() - half).max(0.05 * v.norm()));
    let high = values.iter().zip(&half).map(|(v, half)| v.norm() + half);
    Plot::new(format!("FRF {name}"), Axis::frequency(), Axis::logarithmic(format!("|H {name}|"), "(m/s^2)/N"))
        .over(analysis.lines().hz())
        .band("noise, 95 %", Role::Uncertainty, low, high)
        .line("measured", Role::Measured, values.iter().map(|v| v.norm()))
        .dashed("rebuilt", Role::Highlight, analysis.rebuilt(frf).iter().map(|v| v.norm()))
        .height(220)
        .line_limit(LINE_LIMIT)
}

fn phase(analysis: &ModalAnalysis, frf: usize) -> Plot {
    let name = analysis.pairs()[frf].to_string();
    let mut measured = degrees(analysis.measured().values(frf).iter().map(|v| Some(*v)));
    let mut rebuilt = degrees(analysis.rebuilt(frf).iter().map(|v| Some(*v)));
    in_the_quietest_turn(&mut [&mut measured, &mut rebuilt]);
    Plot::new(format!("Phase of FRF {name}"), Axis::frequency(), Axis::linear(format!("arg H {name}"), "°"))
        .over(analysis.lines().hz())
        .line("measured", Role::Measured, measured)
        .dashed("rebuilt", Role::Highlight, rebuilt)
        .height(220)
        .line_limit(LINE_LIMIT)
}
