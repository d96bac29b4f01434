//! The scores beside their targets.

use jointscope_proof::{Figure, Rate, Score, Standing};

use crate::{Card, Column, Section, Table, Tone};

fn tone(standing: Option<Standing>) -> Option<Tone> {
    Some(match standing? {
        Standing::Met => Tone::Ok,
        Standing::WithinChance => Tone::Attention,
        Standing::Missed => Tone::Problem,
    })
}

pub(super) fn section(score: &Score) -> Section {
    let cards = score.cases.iter().filter(|(_, all, _)| *all > 0).map(|(role, all, visible)| {
        let card = Card::text(format!("cases: {}", role.name()), all.to_string());
        if role.name() == "null" { card.note("nothing hidden") } else { card.note(format!("{visible} show")) }
    });
    Section::new("Scores")
        .cards(cards)
        .table(rates(&score.rates))
        .table(figures(&score.figures))
        .table(verdicts(score))
}

pub(super) fn rates(rates: &[Rate]) -> Table {
    let columns = [
        Column::text("share of cases"),
        Column::numbers("counted", ""),
        Column::numbers("share", ""),
        Column::numbers("95 % interval", ""),
        Column::text("target"),
        Column::text(""),
    ];
    let table = rates.iter().fold(Table::new(columns), |table, rate| {
        let [low, high] = rate.share.interval();
        let standing = rate.standing();
        let cells = [
            rate.what.to_owned(),
            super::counted(rate.share),
            rate.share.value().map_or_else(|| "–".to_owned(), |value| format!("{value:.3}")),
            if rate.share.all > 0 { format!("{low:.3} to {high:.3}") } else { "–".to_owned() },
            rate.target.map_or_else(String::new, |target| target.to_string()),
            standing.map_or("", Standing::says).to_owned(),
        ];
        match tone(standing) {
            Some(tone) => table.marked_row(tone, cells),
            None => table.row(cells),
        }
    });
    table.footnote("Intervals by Clopper and Pearson. Missed within chance: the target lies in the interval.")
}

pub(super) fn figures(figures: &[Figure]) -> Table {
    let columns = [
        Column::text("figure"),
        Column::numbers("value", ""),
        Column::numbers("from", ""),
        Column::text("target"),
        Column::text(""),
    ];
    figures.iter().fold(Table::new(columns), |table, figure| {
        let met = figure.target.zip(figure.value).map(|(target, value)| target.is_met(value));
        let cells = [
            figure.what.to_owned(),
            figure.value.map_or_else(|| "–".to_owned(), |value| format!("{value:.3}")),
            figure.from.to_string(),
            figure.target.map_or_else(String::new, |target| target.to_string()),
            met.map_or("", |met| if met { "met" } else { "missed" }).to_owned(),
        ];
        match met {
            Some(true) => table.marked_row(Tone::Ok, cells),
            Some(false) => table.marked_row(Tone::Problem, cells),
            None => table.row(cells),
        }
    })
}

fn verdicts(score: &Score) -> Table {
    let words: Vec<&str> = score
        .verdicts
        .first()
        .map(|(_, counts)| counts.iter().map(|(word, _)| *word).collect())
        .unwrap_or_default();
    let columns = std::iter::once(Column::text("verdicts by what was hidden"))
        .chain(words.iter().map(|word| Column::numbers(word.replace('_', " "), "")));
    score.verdicts.iter().filter(|(_, counts)| counts.iter().any(|(_, n)| *n > 0)).fold(
        Table::new(columns),
        |table, (role, counts)| {
            let cells = counts.iter().map(|(_, count)| count.to_string());
            table.row(std::iter::once(role.name().to_owned()).chain(cells))
        },
    )
}
