//! The complex mode indicator function: how many modes there are at each line.

use jointscope_linalg::singular_values;
use jointscope_spectra::{Channel, Dof, FrfPair, FrfSet};
use num_complex::Complex64;

/// Singular values of the matrix of FRFs, responses by references, line by line.
///
/// Where one mode dominates, one value stands out and peaks at it; two modes close to each other raise two.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeIndicator {
    /// Responses of the matrix.
    pub responses: Vec<Channel>,
    /// References of the matrix.
    pub references: Vec<Channel>,
    /// The values at each line, in the FRFs' unit, the largest first: as many curves as the matrix has
    /// references or responses, whichever are fewer.
    pub curves: Vec<Vec<f64>>,
}

impl ModeIndicator {
    /// Of the translations of a set, or of its rotations where it has no translation: units do not mix. Where
    /// FRFs of the matrix are missing, responses or references are left out until none is.
    ///
    /// `None` of a set without such FRFs.
    pub fn of(frfs: &FrfSet) -> Option<Self> {
        let all = frfs.pairs();
        let of_kind = |dof: Dof| {
            let alike = |pair: &FrfPair| pair.response.dof == dof && pair.reference.dof == dof;
            (0..all.len()).filter(|&index| alike(&all[index])).collect::<Vec<_>>()
        };
        let translations = of_kind(Dof::Translation);
        let used = if translations.is_empty() { of_kind(Dof::Rotation) } else { translations };
        let (responses, references) = complete(&used.iter().map(|&index| &all[index]).collect::<Vec<_>>());
        let place = |response: &Channel, reference: &Channel| {
            let same = |pair: &FrfPair| pair.response == *response && pair.reference == *reference;
            all.iter().position(same)
        };
        let matrix = responses
            .iter()
            .flat_map(|response| references.iter().map(move |reference| place(response, reference)));
        let matrix: Vec<&[Complex64]> =
            matrix.map(|index| Some(frfs.values(index?))).collect::<Option<_>>()?;
        let count = responses.len().min(references.len());
        let mut curves = vec![Vec::with_capacity(frfs.lines().len()); count];
        let mut at_line = Vec::with_capacity(matrix.len());
        for line in 0..frfs.lines().len() {
            at_line.clear();
            at_line.extend(matrix.iter().map(|values| values[line]));
            let values = singular_values(references.len(), &at_line).ok()?;
            curves.iter_mut().zip(values).for_each(|(curve, value)| curve.push(value));
        }
        let own = |channels: Vec<&Channel>| channels.into_iter().cloned().collect();
        (count > 0).then(|| ModeIndicator { responses: own(responses), references: own(references), curves })
    }

    /// Number of FRFs of the matrix.
    pub fn frfs(&self) -> usize {
        self.responses.len() * self.references.len()
    }
}

/// Responses and references between which every FRF is there: the channel that lacks the largest share of its
/// own is left out until none lacks any.
fn complete<'a>(pairs: &[&'a FrfPair]) -> (Vec<&'a Channel>, Vec<&'a Channel>) {
    let distinct = |channel: fn(&'a FrfPair) -> &'a Channel| {
        let mut all: Vec<&Channel> = Vec::new();
        for pair in pairs {
            if !all.contains(&channel(pair)) {
                all.push(channel(pair));
            }
        }
        all
    };
    let (mut responses, mut references) = (distinct(|pair| &pair.response), distinct(|pair| &pair.reference));
    loop {
        let has = |response: &Channel, reference: &Channel| {
            pairs.iter().any(|pair| pair.response == *response && pair.reference == *reference)
        };
        let there = |count: usize, of: usize| count as f64 / of as f64;
        let of_response = |response: &&Channel| {
            there(references.iter().filter(|reference| has(response, reference)).count(), references.len())
        };
        let of_reference = |reference: &&Channel| {
            there(responses.iter().filter(|response| has(response, reference)).count(), responses.len())
        };
        let poorest = |shares: Vec<f64>| shares.into_iter().enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        let response = poorest(responses.iter().map(of_response).collect());
        let reference = poorest(references.iter().map(of_reference).collect());
        match (response, reference) {
            (Some((_, a)), Some((_, b))) if a >= 1.0 && b >= 1.0 => break,
            (Some((index, a)), Some((_, b))) if a <= b => drop(responses.remove(index)),
            (_, Some((index, _))) => drop(references.remove(index)),
            _ => break,
        }
    }
    (responses, references)
}
