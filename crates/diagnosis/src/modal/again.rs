//! What was found in the whole of a recording, looked for once more in a part of it.
//!
//! The part does not see what is held out, and has to need by itself what it is to predict that with. Several
//! effects need not be found one by one again: all of them are fitted at once, and whatever this part does
//! not need is left out, statement by statement.

use crate::modal::fit::{ANY, ModalFit, SetOut};
use crate::modal::search::ModalSearch;
use crate::modal::searcher::{Named, Searcher};

impl Searcher<'_> {
    /// A search that needs nothing but several effects found before, or some of them; `None` where there are
    /// none such, or this recording needs none of them.
    pub(super) fn found_again(&self, none: &ModalFit) -> Option<ModalSearch> {
        let known = self.known.filter(|known| known.found.len() > 1)?;
        let names: Vec<usize> =
            known.found.iter().map(|effect| self.name_of(effect)).collect::<Option<_>>()?;
        let start =
            known.found.iter().fold(none.hypothesis.clone(), |rest, effect| rest.with(effect.clone()));
        let alone = self.alone(none.clone());
        let mut best = self.fitted_with(&alone, &names, &start, (SetOut::Both, ANY))?;
        while !best.names.is_empty() {
            let statements = self.statements(&best.names);
            let fewer = statements.iter().filter_map(|statement| self.without(&best, statement, ANY));
            let Some(fewer) = fewer.max_by(|a, b| a.fit.ln.total_cmp(&b.fit.ln)) else { break };
            if best.fit.ln - fewer.fit.ln > self.needed_over(&fewer, &best) {
                break;
            }
            best = fewer;
        }
        if best.names.is_empty() || !self.is_told(&best, none) {
            return None;
        }
        let own = |&name: &usize| vec![Named { names: vec![name], ..best.clone() }];
        Some(ModalSearch {
            alternatives: best.names.iter().map(own).collect(),
            elsewhere: vec![Vec::new(); best.names.len()],
            without: vec![none.ln; best.names.len()],
            none: none.clone(),
            singles: Vec::new(),
            far: Vec::new(),
            more: Vec::new(),
            best,
        })
    }
}
