//! Whether functions are missing, as where a file was cut.
//!
//! A universal file states nowhere how many functions it holds: one that was cut between two of them is a
//! whole file. Only what the others have tells that something is missing: a coherence, a response of one
//! reference, a channel of one hit.

use std::collections::{BTreeMap, BTreeSet};

use jointscope_uff::{FunctionType, data_type};

use crate::error::enumeration;
use crate::function::{Function, functions};
use crate::{FileChannel, HeldAmplitude, Source};

/// Others that must agree on what belongs to each of them: one alone may differ on purpose.
const OTHERS: usize = 2;

const REMEDY: &str = "where a file was cut before it, copy or export that file again";

/// What FRFs lack that others have, a sentence each.
pub(crate) fn of_frfs(sources: &[Source]) -> Vec<String> {
    let of_type = |of: FunctionType| -> BTreeSet<Key> {
        functions(sources).filter(|function| function.dataset.function == of).map(|f| key(&f)).collect()
    };
    let frfs = of_type(FunctionType::FrequencyResponse);
    let coherences = of_type(FunctionType::Coherence);
    let by_reference = || lacking(frfs.iter().map(|(level, [to, from])| ((*level, *from), *to)));
    let by_response = || lacking(frfs.iter().map(|(level, [to, from])| ((*level, *to), *from)));
    let by_level = || lacking(frfs.iter().map(|(level, channels)| (*level, *channels)));
    let says = |channels: Vec<[FileChannel; 2]>, others: usize, row: &str, what: &str| {
        let frfs = named("FRF", channels.iter().map(|[to, from]| format!("{to}/{from}")).collect());
        format!("there is no {frfs}, and the {others} other {row} have that {what}: {REMEDY}")
    };
    let missing = by_reference()
        .map(|((_, from), to, others)| {
            says(to.into_iter().map(|to| [to, from]).collect(), others, "references", "response")
        })
        .or_else(|| {
            by_response().map(|((_, to), from, others)| {
                says(from.into_iter().map(|from| [to, from]).collect(), others, "responses", "reference")
            })
        })
        .or_else(|| by_level().map(|(_, channels, others)| says(channels, others, "levels", "FRF")));
    missing.into_iter().chain(without_coherence(&frfs, &coherences)).collect()
}

/// What hits lack that others have, a sentence each.
pub(crate) fn of_hits(sources: &[Source]) -> Vec<String> {
    let is_response = |function: &Function| {
        function.dataset.function == FunctionType::TimeResponse
            && function.dataset.ordinate_axis.data_type != data_type::EXCITATION_FORCE
    };
    // Files may count their hits from the same number. The hammer may strike elsewhere each time, so
    // responses are compared.
    let responses = functions(sources).filter(is_response);
    let rows = responses.map(|f| ((f.source, f.dataset.sequence_number), along_axis(f.response())));
    let says = |((_, hit), missing, others): ((&str, i64), Vec<FileChannel>, usize)| {
        let responses = named("response", missing.iter().map(ToString::to_string).collect());
        format!("hit {hit} has no {responses}, which the {others} other hits have: {REMEDY}")
    };
    lacking(rows).map(says).into_iter().collect()
}

/// Level, response and reference, whatever the sense of their directions.
type Key = (Option<(u8, u64)>, [FileChannel; 2]);

fn key(function: &Function) -> Key {
    let channels = [function.response(), function.reference()].map(along_axis);
    (function.level().map(HeldAmplitude::key), channels)
}

fn along_axis(channel: FileChannel) -> FileChannel {
    FileChannel { direction: channel.direction.saturating_abs(), ..channel }
}

/// The one row that has some of the items, but not all, that every other row has: its key, what it lacks, and
/// how many others there are.
fn lacking<K: Ord + Copy, T: Ord + Copy>(
    functions: impl Iterator<Item = (K, T)>,
) -> Option<(K, Vec<T>, usize)> {
    let mut rows: BTreeMap<K, BTreeSet<T>> = BTreeMap::new();
    for (row, item) in functions {
        rows.entry(row).or_default().insert(item);
    }
    let whole = rows.values().max_by_key(|items| items.len())?.clone();
    let mut others = rows.iter().filter(|(_, items)| **items != whole);
    let (Some((row, items)), None) = (others.next(), others.next()) else { return None };
    let missing = whole.difference(items).copied().collect();
    (rows.len() > OTHERS && items.is_subset(&whole)).then_some((*row, missing, rows.len() - 1))
}

fn without_coherence(frfs: &BTreeSet<Key>, coherences: &BTreeSet<Key>) -> Option<String> {
    let (with, without): (Vec<&Key>, Vec<&Key>) = frfs.iter().partition(|frf| coherences.contains(frf));
    let names: BTreeSet<String> = without.iter().map(|(_, [to, from])| format!("{to}/{from}")).collect();
    // Where most have none, none were meant to.
    if without.is_empty() || with.len() < OTHERS || without.len() >= with.len() {
        return None;
    }
    let has = if without.len() == 1 { "has" } else { "have" };
    let frfs = named("FRF", names.into_iter().collect());
    Some(format!("{frfs} {has} no coherence, which {} others have: {REMEDY}", with.len()))
}

fn named(what: &str, names: Vec<String>) -> String {
    let several = if names.len() > 1 { "s" } else { "" };
    format!("{what}{several} {}", enumeration(names))
}
