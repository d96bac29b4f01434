//! The stabilisation chart under the FRFs' sum.

use jointscope_modes::{ChartPole, ModalAnalysis, Stability};
use jointscope_spectra::FrfSet;

use crate::mode_indicator;
use crate::plot::{Axis, Plot, Role, YRange};
use crate::section::Section;

/// Poles above which the chart is drawn thinned.
const POLES: usize = 8_000;

pub(super) fn section(analysis: &ModalAnalysis, modelled: Option<&FrfSet>) -> Section {
    let (lowest, highest) = analysis.orders;
    let seen = match analysis.columns {
        1 => String::new(),
        columns => {
            format!(" Each order has as many poles as {columns} columns of the matrix of FRFs times it.")
        }
    };
    // Of one column it is the sum itself.
    let is_sum = analysis.complete && analysis.columns == 1 && modelled.is_none();
    let indicator = (!is_sum).then(|| mode_indicator::plot(analysis.measured(), modelled)).flatten();
    let indicator = indicator.map(|plot| modes_marked(analysis, plot));
    Section::new("Stabilisation chart")
        .paragraph(format!(
            "Damped poles of denominators of order {lowest} to {highest}. A mode stays where it is from order to order; poles of mere arithmetic wander.{seen} Vertical lines are the \
             modes taken; the option --pick takes others, --orders draws another chart."
        ))
        .plot(sum(analysis))
        .plots(1, indicator)
        .plot(poles(analysis))
}

/// Root of the FRFs' summed squares.
fn sum(analysis: &ModalAnalysis) -> Plot {
    let (n, frfs) = (analysis.lines().len(), analysis.pairs().len());
    let of = |values: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        (0..n).map(|line| (0..frfs).map(|frf| values(frf, line)).sum::<f64>().sqrt()).collect()
    };
    let measured = of(&|frf, line| analysis.measured().values(frf)[line].norm_sqr());
    let rebuilt = of(&|frf, line| analysis.rebuilt(frf)[line].norm_sqr());
    modes_marked(
        analysis,
        Plot::new("All FRFs together", Axis::frequency(), Axis::logarithmic("√Σ|H|²", "(m/s^2)/N"))
            .over(analysis.lines().hz())
            .line("measured", Role::Measured, measured)
            .dashed("rebuilt from the modes", Role::Highlight, rebuilt),
    )
    .height(200)
}

fn poles(analysis: &ModalAnalysis) -> Plot {
    let hz = analysis.lines().hz();
    let in_band = |pole: &&ChartPole| pole.frequency >= hz[0] && pole.frequency <= hz[hz.len() - 1];
    let mut poles: Vec<&ChartPole> = analysis.chart.iter().filter(in_band).collect();
    poles.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    // Poles of one frequency are drawn as near one another as numbers can be.
    let mut last = hz[0];
    let of_poles = poles.iter().map(|pole| {
        last = pole.frequency.max(last + 1e-9 * pole.frequency.max(1.0));
        last
    });
    // The ends of the band, without a pole, so that both panes begin and end alike.
    let mut frequencies: Vec<f64> = std::iter::once(hz[0]).chain(of_poles).collect();
    frequencies.push(hz[hz.len() - 1].max(frequencies[poles.len()] * (1.0 + 1e-9)));
    let orders = |stability: Stability| {
        let drawn = poles.iter().map(|p| (p.stability == stability).then_some(p.order as f64));
        std::iter::once(None).chain(drawn).chain([None]).collect::<Vec<_>>()
    };
    let plot = Plot::new("Poles by order", Axis::frequency(), Axis::linear("Order", ""))
        .over(frequencies)
        .points("new", Role::Reference, orders(Stability::New))
        .points("frequency stays", Role::Nominal, orders(Stability::Frequency))
        .points("frequency and damping stay", Role::Estimate, orders(Stability::Stable));
    modes_marked(analysis, plot)
        .y_range(YRange::Fixed { low: 0.0, high: analysis.orders.1 as f64 + 1.0 })
        .height(320)
        .masked(0)
        .line_limit(POLES)
        .caption("Stays: within 0.2 % of the frequency, and within 10 % of the damping ratio, of the order before.")
}

fn modes_marked(analysis: &ModalAnalysis, plot: Plot) -> Plot {
    analysis.modes.iter().enumerate().fold(plot, |plot, (index, mode)| {
        plot.vertical(format!("{}", index + 1), Role::Highlight, mode.frequency)
    })
}
