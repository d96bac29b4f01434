//! The page of several joints side by side: in what ratio they are, who is stiffer, how sure that is, and
//! their spectra in common plots.

mod elements;
mod models;
mod spectra;

use jointscope_comparison::{Comparison, ElementRanking, Kind, Pair, PairedNumber, Scatter, Specimens};
use jointscope_wording::{Says, capitalised, comparison as says, models as model_words};

use crate::context::PageContext;
use crate::format::{fixed, in_column, interval, percent, quantity, quantity_in, significant};
use crate::report::Report;
use crate::section::{Section, Verdict};
use crate::table::Table;
use crate::tone::Tone;
use crate::unit::Scale;
use elements::{elements, name_of, typeset};
use models::model_section;
use spectra::{compliance_section, spectra_section};

/// The page of a comparison: models over measurements, ratios, orders with probabilities, the scatter of
/// specimens, values, and the spectra of H41, K and C (Figures 4–9).
///
/// The same input gives the same bytes.
pub fn comparison_report(comparison: &Comparison, context: &PageContext) -> Report {
    let names: Vec<&str> = comparison.joints.iter().map(|joint| joint.name.as_str()).collect();
    Report::of(
        context
            .page(format!("{} joints side by side", names.len()), names.join(" · "), verdict(comparison))
            .sections(model_section(comparison))
            .sections([ratio_section(comparison), order_section(comparison)])
            .sections(comparison.specimens.iter().map(specimen_section))
            .sections([value_section(comparison)])
            .sections(compliance_section(comparison))
            .sections(
                [Kind::Stiffness, Kind::Damping]
                    .into_iter()
                    .filter_map(|kind| spectra_section(comparison, kind)),
            ),
    )
}

fn symbol(entry: &ElementRanking) -> String {
    name_of(entry.kind, entry.element)
}

fn order_words(comparison: &Comparison, entry: &ElementRanking) -> String {
    if !entry.is_stated() {
        return says::decided(comparison, entry);
    }
    let signs = entry.settled_neighbours().map(|settled| if settled { " < " } else { " ≲ " });
    let names = entry.ranking.order.iter().map(|index| comparison.joints[*index].name.as_str());
    std::iter::once("").chain(signs).zip(names).flat_map(|(sign, name)| [sign, name]).collect()
}

fn verdict(comparison: &Comparison) -> Verdict {
    let stiffness = || comparison.rankings.iter().filter(|entry| entry.kind == Kind::Stiffness);
    let settled: Vec<String> = stiffness().filter(|entry| entry.is_settled()).map(symbol).collect();
    let mut details = Vec::new();
    let headline = match (comparison.pairs.as_slice(), comparison.rankings.first()) {
        ([pair], _) if pair.numbers.first().is_some_and(|number| number.ratio.is_some()) => {
            details.extend(pair.equality.map(|_| sentence(&says::tested(comparison, pair))));
            ratio_words(pair)
        }
        (_, Some(first)) => {
            details.push(match settled.len() {
                0 => "No element of K orders all joints with a probability of 95 %.".to_owned(),
                n if n == stiffness().count() => {
                    "All elements of K order the joints with a probability of 95 % or more.".to_owned()
                }
                _ => format!(
                    "The whole order is sure (95 %) by {}; by the other elements of K it is open.",
                    settled.join(", ")
                ),
            });
            let order = order_words(comparison, first);
            let right = match (first.has_deviations, first.is_stated()) {
                (true, true) => format!(" (right with a probability of {})", sure(first.ranking.probability)),
                (true, false) => String::new(),
                (false, _) => " (nothing tells how sure that is)".to_owned(),
            };
            format!("By {}, from the most compliant to the stiffest: {order}{right}.", symbol(first))
        }
        _ => "There is nothing to compare.".to_owned(),
    };
    let of_models = model_words::sentence(&comparison.models);
    let of_models = of_models.into_iter().chain(model_words::without_measurement(comparison));
    details.extend(of_models.map(|text| capitalised(&sentence(&text))));
    details.extend(comparison.cautions.iter().map(|caution| sentence(&caution.says())));
    details.extend(says::shared(comparison).iter().map(|text| capitalised(&sentence(text))));
    let tone = match (comparison.is_unusable(), comparison.is_conclusive()) {
        (true, _) => Tone::Problem,
        (false, true) => Tone::Ok,
        (false, false) => Tone::Attention,
    };
    Verdict { tone, headline, details }
}

/// The first number of a pair as a ratio.
fn ratio_words(pair: &Pair) -> String {
    let ratio = pair.numbers.first().and_then(|number| Some((number, number.ratio?)));
    ratio.map_or(String::new(), |(number, ratio)| {
        format!(
            "By {}, {} is {} of {}.",
            typeset(&number.element),
            pair.second,
            says::percents(&ratio),
            pair.first
        )
    })
}

fn sentence(text: &str) -> String {
    format!("{text}.")
}

fn ratio_section(comparison: &Comparison) -> Section {
    let mut section = Section::new("Ratios and differences").paragraph(format!(
        "By {}. Errors that two joints have in common, such as those of the same blocks, cancel in both as far as they are correlated. Intervals are of 95 %; that of a \
         ratio is Fieller's.",
        says::estimate_words(comparison)
    ));
    for pair in says::main_pairs(comparison) {
        section = section.with(pair_table(comparison, pair));
    }
    let shown = says::main_pairs(comparison).count();
    if shown < comparison.pairs.len() {
        section = section.paragraph(format!(
            "Shown are the pairs with {}; comparison.json has all {}.",
            comparison.joints[0].name,
            comparison.pairs.len()
        ));
    }
    match comparison.equality.filter(|_| comparison.pairs.len() > 1) {
        Some(equality) => section.paragraph(format!(
            "All joints the same: {}, that of the two that differ most times the number of pairs.",
            says::p_value(equality.p_value)
        )),
        None => section,
    }
}

fn pair_table<'a>(comparison: &Comparison, pair: &'a Pair) -> Table<&'a PairedNumber> {
    let ratio =
        |number: &&PairedNumber| number.ratio.map_or("–".to_owned(), |ratio| says::percents(&ratio));
    let difference = |number: &&PairedNumber| {
        let figure = number.difference;
        if figure.std == 0.0 && figure.value == 0.0 {
            return "not determined of either".to_owned();
        }
        let scale = Scale::for_values(figure.ci95.into_iter().chain([figure.value, figure.std]), number.unit);
        let text = quantity_in(figure.value, figure.std, &scale);
        format!("{text} ({})", interval(figure.ci95, &scale, 3))
    };
    let larger = |number: &&PairedNumber| {
        if number.difference.std == 0.0 {
            return "–".to_owned();
        }
        let p = number.second_is_larger;
        let (name, p) = if p >= 0.5 { (&pair.second, p) } else { (&pair.first, 1.0 - p) };
        format!("{name} ({})", sure(p))
    };
    let correlation =
        |number: &&PairedNumber| number.correlation.map_or("–".to_owned(), |value| fixed(value, 4));
    let same = match pair.equality {
        Some(equality) => {
            let bent = match equality.is_blunt() {
                true => format!(
                    ", between tests that the blocks bend by {} deviations",
                    significant(equality.bend, 3)
                ),
                false => String::new(),
            };
            let tested = says::tested(comparison, pair);
            format!(
                "{tested} (χ² {} of {} degrees of freedom{bent}).",
                significant(equality.chi2, 4),
                equality.degrees
            )
        }
        None => sentence(&says::tested(comparison, pair)),
    };
    let differs = |number: &&PairedNumber| number.differs().then_some(Tone::Attention);
    let table = Table::of(&pair.numbers)
        .words("number", |number| typeset(&number.element))
        .words(format!("{} in % of {} (95 %)", pair.second, pair.first), ratio)
        .words(format!("{} less {} (95 %)", pair.second, pair.first), difference)
        .words("larger magnitude", larger)
        .numbers("correlation", "", correlation)
        .caption(format!("{} beside {}", pair.second, pair.first));
    let table = if comparison.is_sound() { table.marked(differs) } else { table };
    table.footnote(same)
}

fn order_section(comparison: &Comparison) -> Section {
    let stated = |entry: &ElementRanking, p: f64| match entry.has_deviations {
        true => sure(p),
        false => "–".to_owned(),
    };
    let each = |entry: &&ElementRanking| match entry.is_stated() {
        true => entry.ranking.adjacent.iter().map(|p| stated(entry, *p)).collect::<Vec<_>>().join(", "),
        false => "–".to_owned(),
    };
    let table = Table::of(&comparison.rankings)
        .words("element", |entry| symbol(entry))
        .words("from the smallest magnitude to the largest", |entry| order_words(comparison, entry))
        .words("whole order right", |entry| stated(entry, entry.ranking.probability))
        .words("each larger than the one before", each)
        .footnote("≲ : less than 95 % sure. An order that is not at least twice as likely right as wrong is not stated. Probabilities by 20 000 draws of all joints at once, errors in common included.");
    let ranks =
        Table::of(0..comparison.joints.len()).words("joint", |&joint| comparison.joints[joint].name.clone());
    let ranks = comparison.rankings.iter().fold(ranks, |table, entry| {
        table.words(symbol(entry), |&joint| {
            if !entry.has_deviations {
                return "–".to_owned();
            }
            let ranks = &entry.ranking.ranks[joint];
            let shown = ranks.iter().enumerate().filter(|(_, p)| **p >= SELDOM);
            shown.map(|(rank, p)| format!("{} ({})", rank + 1, sure(*p))).collect::<Vec<_>>().join(", ")
        })
    });
    Section::new("Rank order")
        .with(table)
        .with(ranks.caption("Ranks with their probabilities (1: the smallest magnitude)"))
}

/// Probability below which a rank is not listed.
const SELDOM: f64 = 0.05;

fn specimen_section(specimens: &Specimens) -> Section {
    let relative = |scatter: &&Scatter, value: f64| says::share(value, scatter.mean.value);
    let table = Table::of(&specimens.numbers)
        .words("number", |scatter| typeset(&scatter.element))
        .words("mean ± std", |scatter| quantity(scatter.mean.value, scatter.mean.std, scatter.unit))
        .words("between specimens (95 %)", |scatter| {
            format!("{} ({})", relative(scatter, scatter.between), says::between(scatter))
        })
        .words("of measurement", |scatter| relative(scatter, scatter.measurement))
        .words("the same specimen", |scatter| says::p_value(scatter.p_value))
        .marked(|scatter| scatter.is_significant().then_some(Tone::Attention))
        .footnote("Standard deviations as shares of the mean. Errors that all specimens share, such as those of the same blocks, are no scatter between them.");
    Section::new(format!("Specimens: {}", specimens.name))
        .paragraph(format!(
            "{} of one kind: {}. What they differ by, apart from how well each is measured.",
            specimens.joints.len(),
            specimens.joints.join(", ")
        ))
        .with(table)
}

fn value_section(comparison: &Comparison) -> Section {
    let table = |kind: Kind| {
        let table = Table::of(0..comparison.joints.len())
            .words("joint", |&joint| comparison.joints[joint].name.clone());
        let table = elements(comparison).iter().fold(table, |table, &element| {
            let values = (0..comparison.joints.len()).map(|j| kind.of(&comparison.estimate(j), element).0);
            let scale = Scale::for_values(values, kind.unit(element));
            table.numbers(name_of(kind, element), scale.unit(), |&joint| {
                let (value, std) = kind.of(&comparison.estimate(joint), element);
                in_column(value, std, &scale)
            })
        });
        table.footnote("± one standard deviation: noise, the fixture's tolerances, and what a constant joint leaves unexplained")
    };
    Section::new("Values").with(table(Kind::Stiffness)).with(table(Kind::Damping))
}

/// A probability as a percentage that never claims to be certain of what was found by drawing.
fn sure(probability: f64) -> String {
    if probability > 0.999 { "> 99.9 %".to_owned() } else { percent(probability, 1) }
}
