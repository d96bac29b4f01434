//! Which law follows the levels at one component of one joint.

use super::model::{Change, Subject};
use crate::RestoringLaw;
use num_complex::Complex64;

/// What is tried at a joint's component: nothing, one law, or friction with a cubic spring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    Linear,
    Cubic,
    Friction,
    Gap,
    FrictionAndCubic,
}

impl Form {
    pub const LAWS: [Form; 4] = [Form::Cubic, Form::Friction, Form::Gap, Form::FrictionAndCubic];

    pub fn name(self) -> &'static str {
        match self {
            Form::Linear => "linear",
            Form::Cubic => "cubic_stiffness",
            Form::Friction => "friction",
            Form::Gap => "gap",
            Form::FrictionAndCubic => "friction+cubic_stiffness",
        }
    }

    /// Parameters of its laws.
    pub fn parameters(self) -> usize {
        match self {
            Form::Linear => 0,
            Form::Cubic => 1,
            Form::Friction | Form::Gap => 2,
            Form::FrictionAndCubic => 3,
        }
    }
}

/// A form fitted.
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    pub form: Form,
    pub change: Change,
    /// Root mean square over the levels of the relative errors.
    pub nrmse: f64,
}

/// Starts that are followed to their minimum, the motions those of the levels' own stiffnesses.
const FOLLOWED: usize = 5;
/// Minima that are followed on, the motions those of the law itself.
const POLISHED: usize = 2;

/// The best fit of a form.
pub(crate) fn fitted(subject: &Subject, form: Form) -> Option<Fitted> {
    let frozen = subject.frozen();
    let ranked = |changes: Vec<Change>| {
        let of = |change: Change| (frozen.nrmse(&change), change);
        let mut all: Vec<_> = changes.into_iter().map(of).filter(|(error, _)| error.is_finite()).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    };
    let starts = ranked(starts(subject, form).into_iter().map(|laws| begun(subject, laws)).collect());
    let minima = starts.iter().take(FOLLOWED).filter_map(|(_, start)| Some(frozen.fitted(start, None)?.0));
    let minima = ranked(minima.collect());
    let polished = minima.iter().take(POLISHED).filter_map(|(_, near)| subject.fitted(near, None));
    let fits = polished.map(|(change, _)| Fitted { form, nrmse: subject.nrmse(&change), change });
    fits.filter(|fit| fit.nrmse.is_finite()).min_by(|a, b| a.nrmse.total_cmp(&b.nrmse))
}

/// Laws with the base stiffness that suits them on the average of the levels.
fn begun(subject: &Subject, laws: Vec<RestoringLaw>) -> Change {
    let mut change = Change { log_gain: subject.free.0, base: Complex64::ZERO, laws };
    let count = subject.levels.len();
    let rest = |l: usize| subject.free.1[l] - change.delta(subject.motion(l), subject.seat.yields);
    change.base = (0..count).map(rest).sum::<Complex64>() / count as f64;
    change
}

fn starts(subject: &Subject, form: Form) -> Vec<Vec<RestoringLaw>> {
    let motions: Vec<f64> = (0..subject.levels.len()).map(|l| subject.motion(l)).collect();
    let most = motions.iter().fold(0.0, |a: f64, b| a.max(*b));
    let least = motions.iter().fold(most, |a: f64, b| a.min(*b));
    let span = subject.span();
    let onsets: Vec<f64> =
        (0..8).map(|i| 0.3 * least * (0.95 * most / (0.3 * least)).powf(f64::from(i) / 7.0)).collect();
    let cubics =
        [-1.0, 1.0].map(|sign| RestoringLaw::Cubic { stiffness3: sign * span / (0.75 * most * most) });
    let frictions = || {
        let of = |onset: &f64| {
            [0.5, 1.5, 5.0].map(|times| RestoringLaw::Friction {
                slip_force: times * span * onset,
                stiffness: times * span,
            })
        };
        onsets.iter().flat_map(of).collect::<Vec<_>>()
    };
    match form {
        Form::Linear => vec![Vec::new()],
        Form::Cubic => cubics.map(|law| vec![law]).to_vec(),
        Form::Friction => frictions().into_iter().map(|law| vec![law]).collect(),
        Form::Gap => {
            let of = |c: &f64| {
                [1.0, 3.0, 10.0]
                    .map(|times| vec![RestoringLaw::Gap { clearance: *c, stiffness: times * span }])
            };
            onsets.iter().flat_map(of).collect()
        }
        Form::FrictionAndCubic => {
            // What friction alone came to, bent a little, and everything it started from.
            let alone = fitted(subject, Form::Friction).and_then(|fit| fit.change.laws.first().copied());
            let bent = cubics.map(|law| match law {
                RestoringLaw::Cubic { stiffness3 } => RestoringLaw::Cubic { stiffness3: 0.01 * stiffness3 },
                other => other,
            });
            let beside = alone.into_iter().flat_map(|friction| bent.map(|cubic| vec![friction, cubic]));
            let plain =
                frictions().into_iter().flat_map(|friction| cubics.map(|cubic| vec![friction, cubic]));
            beside.chain(plain).collect()
        }
    }
}

/// Share of what the linear change leaves, beyond what a complex stiffness of its own leaves at each level, that a fit explains.
pub(crate) fn share(subject: &Subject, linear: &Fitted, fit: &Fitted) -> f64 {
    let floor = subject.floor.powi(2).min(linear.nrmse.powi(2));
    let open = linear.nrmse.powi(2) - floor;
    if open <= 0.0 { 0.0 } else { ((linear.nrmse.powi(2) - fit.nrmse.powi(2)) / open).clamp(0.0, 1.0) }
}
