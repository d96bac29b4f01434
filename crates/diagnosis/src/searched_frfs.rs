//! Of very many FRFs and lines those that a search looks at.
//!
//! With every channel in at least one of them, few FRFs tell nearly all that all of them tell about a
//! structure: H_ij is made of φ_i and φ_j, mode by mode. The rest confirms: what is found is fitted to all of
//! them, judged on all of them, and its uncertainty is by all of them.

use crate::Observation;
use crate::recorded_lines::most_informative;
use crate::settings::lines::recordings::SEARCHED_FRFS;
use crate::settings::lines::searched::{ALL_VALUES, FEWEST_LINES, SEARCHED_VALUES};
use jointscope_spectra::{Channel, FrfPair};

/// The FRFs to be searched: those with channels that are shown least so far, one after the other, and all of
/// `besides`.
fn chosen<'a>(pairs: &'a [FrfPair], besides: &[FrfPair]) -> Vec<&'a FrfPair> {
    let mut chosen: Vec<&FrfPair> = pairs.iter().filter(|pair| besides.contains(pair)).collect();
    let shown = |chosen: &[&FrfPair], channel: &Channel, of: fn(&FrfPair) -> &Channel| {
        chosen.iter().filter(|pair| of(pair) == channel).count()
    };
    loop {
        let counts = |pair: &&FrfPair| {
            let response = shown(&chosen, &pair.response, |pair| &pair.response);
            (response, shown(&chosen, &pair.reference, |pair| &pair.reference))
        };
        let is_new = |pair: &&FrfPair| counts(pair).0 == 0 || counts(pair).1 == 0;
        let left = pairs.iter().filter(|pair| !chosen.contains(pair));
        let left = left.filter(|pair| chosen.len() < SEARCHED_FRFS || is_new(pair));
        let Some(next) = left.min_by_key(counts) else { break };
        chosen.push(next);
    }
    chosen
}

impl Observation {
    /// The part of it that is searched, `besides` in it; `None` where that is all of it.
    pub(crate) fn searched(&self, besides: &[FrfPair]) -> Option<Observation> {
        let chosen = chosen(self.pairs(), besides);
        let fewer = chosen.len() < self.pairs().len();
        let part = fewer.then(|| self.reduced(|_| true, |pair| chosen.contains(&pair))).flatten();
        let frfs = part.as_ref().unwrap_or(self);
        let (lines, most) = (frfs.lines().len(), (SEARCHED_VALUES / frfs.pairs().len()).max(FEWEST_LINES));
        if lines * frfs.pairs().len() <= ALL_VALUES || lines <= most {
            return part;
        }
        let kept = most_informative(frfs.frfs(), most);
        let hz = frfs.lines().hz();
        let kept: Vec<f64> = hz.iter().zip(kept).filter(|(_, kept)| *kept).map(|(hz, _)| *hz).collect();
        let is_kept = |hz: f64| kept.binary_search_by(|line| line.total_cmp(&hz)).is_ok();
        frfs.reduced(is_kept, |_| true).or(part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(responses: usize, references: usize) -> Vec<FrfPair> {
        let pair = |o: usize, i: usize| FrfPair::transverse(&o.to_string(), &format!("r{i}"));
        (0..responses).flat_map(|o| (0..references).map(move |i| pair(o, i))).collect()
    }

    #[test]
    fn few_of_many_frfs_show_every_channel() {
        let pairs = grid(16, 4);
        let few = chosen(&pairs, &pairs[7..8]);
        assert!(few.len() == SEARCHED_FRFS && few.contains(&&pairs[7]), "{few:?}");
        assert!(pairs.iter().all(|p| few.iter().any(|f| f.response == p.response)));
        let of = |reference: usize| few.iter().filter(|f| f.reference == pairs[reference].reference).count();
        assert!((0..4).all(|reference| of(reference) >= 3), "references are shown alike");
    }

    #[test]
    fn channels_are_shown_though_they_are_more_than_are_searched_else() {
        let pairs = grid(40, 1);
        assert_eq!(chosen(&pairs, &[]).len(), 40);
        assert_eq!(chosen(&grid(4, 4), &[]).len(), 16);
    }
}
