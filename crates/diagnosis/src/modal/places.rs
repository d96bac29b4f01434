//! Where along its body a finding may sit, by modes.

use crate::estimates::estimates;
use crate::finding::Elsewhere;
use crate::modal::along::Along;
use crate::modal::search::ModalSearch;
use crate::modal::searcher::{Named, Searcher};

/// Where along its body an effect may sit.
#[derive(Debug, Clone)]
pub(crate) struct Places {
    /// About the most probable place; `None` where derivatives there tell as much.
    pub(super) own: Option<Along>,
    /// The other places.
    pub(super) elsewhere: Vec<Elsewhere>,
}

impl Searcher<'_> {
    /// Where along its body effect `index` of the best hypothesis may sit, each place with its share of the
    /// probability of all.
    pub(super) fn places(&self, search: &ModalSearch, index: usize) -> Places {
        let best = &search.best;
        let own = self.along(best, index);
        let last = |named: &Named| named.fit.hypothesis.effect_count() - 1;
        // What the ridge about the best place leads to is no other place.
        let apart = |named: &&Named| {
            own.as_ref().is_none_or(|along| !along.holds(&named.fit.hypothesis, last(named)))
        };
        let others: Vec<(&Named, Option<Along>)> = search.elsewhere[index]
            .iter()
            .filter(apart)
            .map(|named| (named, self.along(named, last(named))))
            .collect();
        let ln = |named: &Named, along: &Option<Along>| match (along, &own) {
            (Some(along), Some(own)) => along.ln - own.ln,
            _ => named.fit.ln - best.fit.ln,
        };
        let total = 1.0 + others.iter().map(|(named, along)| ln(named, along).exp()).sum::<f64>();
        let elsewhere = |(named, along): &(&Named, Option<Along>)| {
            let hypothesis = &named.fit.hypothesis;
            let effect = hypothesis.effects().pop()?;
            let estimates = match along {
                Some(along) => along.estimates(hypothesis, last(named), &effect),
                None => {
                    let covariance = named.fit.covariance_at(&self.widened(&named.fit));
                    estimates(hypothesis, last(named), &effect, covariance.as_ref(), 1.0)
                }
            };
            Some(Elsewhere { estimates, share: ln(named, along).exp() / total })
        };
        Places { elsewhere: others.iter().filter_map(elsewhere).collect(), own }
    }
}
