//! The scores beside their targets.

use jointscope_proof::{Rate, Score, ScoredFigure, Share, TargetStatus};

use super::cells::or_dash;
use crate::format::fixed;
use crate::section::{Block, Card, Section};
use crate::table::Table;
use crate::tone::Tone;

fn tone(status: Option<TargetStatus>) -> Option<Tone> {
    Some(match status? {
        TargetStatus::Met => Tone::Ok,
        TargetStatus::WithinChance => Tone::Attention,
        TargetStatus::Missed => Tone::Problem,
    })
}

pub(super) fn section(score: &Score) -> Section {
    let cards = score.roles.iter().filter(|count| count.cases > 0).map(|count| {
        let card = Card::text(format!("cases: {}", count.role), count.cases.to_string());
        match count.visible {
            Some(visible) if count.role != "null" => card.note(format!("{visible} show")),
            _ => card.note("nothing hidden"),
        }
    });
    Section::new("Scores")
        .cards(cards)
        .with(rates(&score.rates))
        .with(figures(&score.figures))
        .with(verdicts(score))
}

pub(super) fn rates(rates: &[Rate]) -> impl Into<Block> {
    let interval = |share: Share| {
        let [low, high] = share.interval();
        (share.all > 0).then(|| format!("{low:.3} to {high:.3}"))
    };
    Table::of(rates)
        .words("share of cases", |rate| rate.what)
        .numbers("counted", "", |rate| super::counted(rate.share))
        .numbers("share", "", |rate| or_dash(rate.share.value().map(|value| format!("{value:.3}"))))
        .numbers("95 % interval", "", |rate| or_dash(interval(rate.share)))
        .words("target", |rate| rate.target.map_or_else(String::new, |target| target.to_string()))
        .words("", |rate| rate.status().map_or("", TargetStatus::says))
        .marked(|rate| tone(rate.status()))
        .footnote("Intervals by Clopper and Pearson. Missed within chance: the target lies in the interval.")
}

pub(super) fn figures(figures: &[ScoredFigure]) -> impl Into<Block> {
    let is_met =
        |figure: &ScoredFigure| figure.target.zip(figure.value).map(|(target, value)| target.is_met(value));
    Table::of(figures)
        .words("figure", |figure| figure.what)
        .numbers("value", "", |figure| or_dash(figure.value.map(|value| fixed(value, 3))))
        .numbers("from", "", |figure| figure.from.to_string())
        .words("target", |figure| figure.target.map_or_else(String::new, |target| target.to_string()))
        .words("", |figure| is_met(figure).map_or("", |met| if met { "met" } else { "missed" }))
        .marked(|figure| is_met(figure).map(|met| if met { Tone::Ok } else { Tone::Problem }))
}

/// Verdicts counted by what was hidden.
fn verdicts(score: &Score) -> impl Into<Block> {
    let rows = score.verdicts.iter().filter(|(_, counts)| counts.iter().any(|(_, count)| *count > 0));
    let words = score.verdicts.first().map_or(&[][..], |(_, counts)| counts).iter().enumerate();
    let table = Table::of(rows).words("verdicts by what was hidden", |(role, _)| role.name());
    words.fold(table, |table, (index, (word, _))| {
        table.numbers(word.replace('_', " "), "", |(_, counts)| counts[index].1.to_string())
    })
}
