//! Which laws follow the levels at one component of one joint.

use super::problem::{Change, Problem};
use crate::RestoringLaw;
use crate::settings::level_fit::{
    FOLLOWED, FRICTION_STARTS, GAP_STARTS, ONSET_FROM, ONSET_TO, ONSETS, POLISHED, SLIGHTLY,
};
use jointscope_fixture::EffectKind;

/// The laws tried together at a joint's component, by their kinds.
pub(crate) type Form = &'static [EffectKind];

/// Every form but the linear one, which has no laws.
pub(crate) const FORMS: [Form; 4] = [&[CubicStiffness], &[Friction], &[Gap], &[Friction, CubicStiffness]];

use EffectKind::{CubicStiffness, Friction, Gap};

/// A form fitted.
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    pub change: Change,
    /// Root mean square over the levels of the relative errors.
    pub nrmse: f64,
}

impl Fitted {
    /// Names of the effects, `linear` for none.
    pub(super) fn name(&self) -> String {
        let names: Vec<&str> = self.change.laws.iter().map(|law| law.kind().name()).collect();
        if names.is_empty() { "linear".to_owned() } else { names.join("+") }
    }

    /// Whether friction and a cubic spring act together, which follow more by chance than one law does.
    pub(super) fn is_double(&self) -> bool {
        self.change.laws.len() > 1
    }
}

/// The best fit of a form.
pub(crate) fn fitted(problem: &Problem, form: Form) -> Option<Fitted> {
    let frozen = problem.frozen();
    let ranked = |changes: Vec<Change>| {
        let of = |change: Change| (frozen.nrmse(&change), change);
        let mut all: Vec<_> = changes.into_iter().map(of).filter(|(error, _)| error.is_finite()).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    };
    let starts = ranked(starts(problem, form).into_iter().map(|laws| problem.begun(laws)).collect());
    let minima = starts.iter().take(FOLLOWED).filter_map(|(_, start)| Some(frozen.fitted(start)?.0));
    let minima = ranked(minima.collect());
    let polished = minima.iter().take(POLISHED).filter_map(|(_, near)| problem.fitted(near));
    let fits = polished.map(|(change, _)| Fitted { nrmse: problem.nrmse(&change), change });
    fits.filter(|fit| fit.nrmse.is_finite()).min_by(|a, b| a.nrmse.total_cmp(&b.nrmse))
}

fn starts(problem: &Problem, form: Form) -> Vec<Vec<RestoringLaw>> {
    let motions = || problem.levels.iter().map(|level| level.motion());
    let most = motions().fold(0.0, f64::max);
    let least = motions().fold(most, f64::min);
    let span = problem.span();
    let (first, last) = (ONSET_FROM * least, ONSET_TO * most);
    let onset = |i: u32| first * (last / first).powf(f64::from(i) / f64::from(ONSETS - 1));
    let each_onset = |times: [f64; 3], law: &dyn Fn(f64, f64) -> RestoringLaw| -> Vec<RestoringLaw> {
        (0..ONSETS).flat_map(|i| times.map(|times| law(onset(i), times * span))).collect()
    };
    let of_kind = |kind: &EffectKind| match kind {
        CubicStiffness => {
            let stiffness3 = span / (0.75 * most * most);
            [-1.0, 1.0].map(|sign| RestoringLaw::Cubic { stiffness3: sign * stiffness3 }).to_vec()
        }
        Friction => each_onset(FRICTION_STARTS, &|onset, stiffness| RestoringLaw::Friction {
            slip_force: stiffness * onset,
            stiffness,
        }),
        _ => each_onset(GAP_STARTS, &|clearance, stiffness| RestoringLaw::Gap { clearance, stiffness }),
    };
    match form {
        [] => vec![Vec::new()],
        [one] => of_kind(one).into_iter().map(|law| vec![law]).collect(),
        [one, other, ..] => {
            let others = of_kind(other);
            // What the first alone came to, bent a little, and everything it started from.
            let alone = FORMS.iter().find(|form| ***form == [*one]).and_then(|form| fitted(problem, form));
            let alone = alone.and_then(|fit| fit.change.laws.first().copied());
            let slightly = |law: &RestoringLaw| {
                law.with_values(&law.values().iter().map(|value| SLIGHTLY * value).collect::<Vec<f64>>())
            };
            let beside = alone.into_iter().flat_map(|one| others.iter().map(move |o| vec![one, slightly(o)]));
            let plain = of_kind(one).into_iter().flat_map(|one| others.iter().map(move |o| vec![one, *o]));
            beside.chain(plain).collect()
        }
    }
}

/// Share of what the linear change leaves, beyond what no law could take away, that a fit explains.
pub(crate) fn share(problem: &Problem, linear: &Fitted, fit: &Fitted) -> f64 {
    let floor = problem.floor.powi(2).min(linear.nrmse.powi(2));
    let open = linear.nrmse.powi(2) - floor;
    if open <= 0.0 { 0.0 } else { ((linear.nrmse.powi(2) - fit.nrmse.powi(2)) / open).clamp(0.0, 1.0) }
}
