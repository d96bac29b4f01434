//! The page of a check: what is odd, what the fixture weighs, its modes, what every number means, and every
//! FRF beside the fixture's.

mod frfs;
mod numbers;
mod rigid;

use jointscope_check::{Check, Figure, RecordingCheck, Remark, Weight};
use jointscope_fixture::Fixture;

use crate::context::PageContext;
use crate::drawing::SideView;
use crate::format::{fixed, percent, significant};
use crate::report::Report;
use crate::section::{Card, Section};
use crate::table::Table;
use crate::tone::Tone;

/// The page of a check.
pub fn check_report(check: &Check, fixture: &Fixture, context: &PageContext) -> Report {
    let tone = match check.remarks.first().map(|remark| remark.weight) {
        None => Tone::Ok,
        Some(Weight::Odd) => Tone::Attention,
        Some(Weight::Wrong) => Tone::Problem,
    };
    let recording = check.recording.as_ref();
    let notes = recording.map(|recording| recording.notes.clone()).unwrap_or_default();
    let verdict = context.verdict(tone, check.headline(), notes);
    let page = context
        .page("Check: fixture and recording", context.subtitle(fixture), verdict)
        .sections((!check.remarks.is_empty()).then(|| remarks(&check.remarks)))
        .sections([assembly(check, fixture)])
        .sections(check.modes.as_ref().map(|modes| rigid::modes(modes, recording)))
        .sections(recording.and_then(rigid::indicator));
    let page = match recording {
        Some(recording) => page.sections(frfs::sections(recording)),
        None => page,
    };
    Report::of(page.sections(context.hits()).sections([numbers::section(check)]))
}

fn tone(weight: Weight) -> Tone {
    match weight {
        Weight::Wrong => Tone::Problem,
        Weight::Odd => Tone::Attention,
    }
}

fn remarks(remarks: &[Remark]) -> Section {
    let table = Table::of(remarks)
        .words("Where", |remark| remark.place.clone())
        .words("What", |remark| remark.says.clone())
        .marked(|remark| Some(tone(remark.weight)));
    Section::new("What is odd").with(table)
}

fn assembly(check: &Check, fixture: &Fixture) -> Section {
    let card = |label: &str, figure: &Figure| Card::quantity(label, figure.value, figure.std, figure.unit);
    let totals = &check.totals;
    let mut cards = vec![card("Total mass", &totals.mass)];
    cards.extend(totals.x_cg.iter().map(|x| card("Centre of gravity, x", x)));
    cards.extend(totals.inertia.iter().map(|inertia| card("Inertia about it", inertia)));
    if let Some(modes) = &check.modes {
        cards.push(Card::text("Rigid-body modes", modes.rigid.to_string()).note("at 0 Hz"));
        let first = modes.modes.iter().find(|mode| !mode.on_supports);
        cards.extend(first.map(|mode| card("First elastic mode", &mode.frequency)));
    }
    if let Some(recording) = &check.recording {
        cards.extend(mass_of(recording));
        cards.extend(recording.nrmse.map(|nrmse| {
            Card::text("Fixture beside FRFs, nrmse", percent(nrmse, 1)).note("as it stands, nothing fitted")
        }));
    }
    let pairs = check.recording.iter().flat_map(|recording| recording.measured.pairs());
    let table = Table::of(&totals.parts)
        .words("Part", |part| part.path.clone())
        .numbers("Mass", "kg", |part| significant(part.mass, 5))
        .numbers("x of its centre of gravity", "mm", |part| millimetres(part.x_cg))
        .numbers("Inertia about it", "kg*m^2", |part| {
            part.inertia.map_or("–".to_owned(), |i| significant(i, 4))
        });
    let channels = if check.recording.is_some() {
        ", responses (sensors) in blue and references (hammer) in green"
    } else {
        ""
    };
    Section::new("The assembly")
        .cards(cards)
        .drawing(
            SideView::new(fixture, pairs).draw(),
            format!("Side view with all points{channels}. The outlines of blocks are sketched."),
        )
        .with(table)
}

fn mass_of(recording: &RecordingCheck) -> Option<Card> {
    let line = recording.mass_line.as_ref()?;
    let mass = line.mass?;
    let card = Card::quantity("Mass by the mass line", mass.value, mass.std, mass.unit);
    Some(card.note("as the recording weighs it").tone(line.odd.then_some(Tone::Attention)))
}

fn millimetres(x: Option<f64>) -> String {
    x.map_or("–".to_owned(), |x| fixed(1e3 * x, 2))
}
