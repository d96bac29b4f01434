//! Which of several laws the hits need, each beside the others.
//!
//! The first law is found before the second is looked for, and may have stood for it: a joint that is stiffer
//! than stated looks like friction that sticks until the friction that is there has been found elsewhere.
//! What is left of such a law is small and fits well, and what it gained once says nothing of it now.

use super::fit::Fit;
use super::judge::Step;
use super::misfit::View;
use crate::settings::search::{LEAST_GAIN, LEAST_SHARE, RENEWALS};
use jointscope_inference::each;

/// The best fit and its laws without those that the others make needless, with what each of several gains
/// beside the others; `None` for a fit without a finite motion.
pub(super) fn needed(view: &View, mut best: Fit, mut steps: Vec<Step>) -> Option<(Fit, Vec<Step>)> {
    if steps.len() > 1 {
        best = Fit::of(view, &best.hypothesis, RENEWALS)?;
    }
    while steps.len() > 1 {
        let all: Vec<usize> = (0..steps.len()).collect();
        let without = each(&all, |&index| Fit::of(view, &best.hypothesis.without(index), RENEWALS));
        // What has no finite motion without a law needs it.
        let gain =
            |fit: &Option<Fit>| fit.as_ref().map_or(f64::INFINITY, |fit| fit.objective - best.objective);
        let gains: Vec<f64> = without.iter().map(gain).collect();
        let least = all.into_iter().min_by(|&a, &b| gains[a].total_cmp(&gains[b]));
        let most = gains.iter().copied().filter(|gain| gain.is_finite()).fold(0.0, f64::max);
        let asked = LEAST_GAIN.max(LEAST_SHARE * most);
        let Some(least) = least.filter(|&index| gains[index] < asked) else {
            let finite = steps.iter_mut().zip(gains).filter(|(_, gain)| gain.is_finite());
            finite.for_each(|(step, gain)| step.gain = gain);
            break;
        };
        let Some(fewer) = without.into_iter().nth(least).flatten() else { break };
        steps.remove(least);
        for step in &mut steps[least..] {
            let again = each(&step.fits, |fit| Fit::of(view, &fit.hypothesis.without(least), RENEWALS));
            step.fits = again.into_iter().flatten().collect();
            step.fits.sort_by(|a, b| a.objective.total_cmp(&b.objective));
        }
        // Of the laws that are left the last one's names were fitted in the company of all others.
        let last = steps.last().and_then(|step| step.fits.first());
        best = last.filter(|last| last.objective < fewer.objective).cloned().unwrap_or(fewer);
    }
    Some((best, steps))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // helpers of tests fail as tests do
mod tests {
    use super::*;
    use crate::identification::hypothesis::Hypothesis;
    use crate::identification::records::records;
    use crate::identification::search::{Search, Span};
    use crate::simulate;
    use crate::spectra::Compared;
    use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
    use jointscope_hits::Hit;
    use jointscope_spectra::Channel;

    const INTERVAL: f64 = 1.0 / 5120.0;

    fn storeys(physics: &str) -> Fixture {
        Fixture::from_json(&format!(
            r#"{{ "bodies": {{ "A": {{ "mass": 2.0, "rotates": false }}, "B": {{ "mass": 3.0, "rotates": false }} }},
  "points": {{ "1": {{ "body": "A", "x": 0 }}, "2": {{ "body": "B", "x": 0.1 }} }},
  "joints": {{ "J": {{ "from": "1", "to": "2", "stiffness": [[5e6, 0], [0, 0]] }} }},
  "damping": {{ "modal_ratios": [0.02] }}, "physics": [{physics}] }}"#
        ))
        .unwrap()
    }

    fn law(kind: EffectKind, parameters: &[f64]) -> Effect {
        Effect::new(kind, Place::Joint("J".to_owned()), Some(Dof::Translation), parameters)
    }

    #[test]
    fn a_law_that_another_has_made_needless_is_dropped_and_two_that_act_are_both_kept() {
        let cubic =
            r#"{ "kind": "cubic_stiffness", "place": "J", "dof": "translation", "stiffness3": 4e14 }"#;
        let slips = r#"{ "kind": "friction", "place": "J", "dof": "translation", "slip_force": 5, "stiffness": 1e6 }"#;
        let kinds = |physics: &str, friction: [f64; 2]| -> Vec<EffectKind> {
            let struck = |(number, peak): (u32, f64)| {
                let blow = (0..1024).map(|i| peak * (-0.5 * ((f64::from(i) - 50.0) / 2.0).powi(2)).exp());
                let hit =
                    Hit::new(number, INTERVAL, 0.0, Channel::transverse("1"), blow.collect(), Vec::new());
                let channels = ["1", "2"].map(Channel::transverse);
                simulate(&storeys(physics), &[hit.unwrap()], &channels).unwrap().hits.remove(0)
            };
            let hits: Vec<Hit> = [(1, 50.0), (2, 200.0)].into_iter().map(struck).collect();
            let fixture = storeys("");
            let all = records(&fixture, &hits).unwrap();
            let lines = Compared { band: (20.0, 1000.0), exclude: &[] };
            let search = Search::new(all.iter().collect(), lines, (300.0, 400.0));
            let view = search.view(&Span::default());
            let one = Hypothesis::nominal(&fixture, true, &[]).with(law(EffectKind::Friction, &friction));
            let both = one.with(law(EffectKind::CubicStiffness, &[4e14]));
            let fits = [one, both].map(|laws| Fit::of(&view, &laws, RENEWALS).unwrap());
            let best = fits[1].clone();
            let steps = fits.into_iter().map(|fit| Step { fits: vec![fit], gain: 1e6 }).collect();
            let (best, steps) = needed(&view, best, steps).unwrap();
            let laws: Vec<EffectKind> = best.hypothesis.effects().iter().map(|law| law.kind).collect();
            assert_eq!(laws.len(), steps.len());
            laws
        };
        assert_eq!(kinds(cubic, [1e-3, 1e3]), [EffectKind::CubicStiffness]);
        let both = [EffectKind::Friction, EffectKind::CubicStiffness];
        assert_eq!(kinds(&format!("{slips}, {cubic}"), [5.0, 1e6]), both);
    }
}
