//! The diagnosis beside what people do today.

use jointscope_proof::{Method, Methods, Share, WIDER};

use crate::{Column, Section, Table};

pub(super) fn section(methods: &Methods) -> Section {
    let share = |share: Option<Share>| share.map_or_else(|| "–".to_owned(), super::counted);
    let number =
        |value: Option<f64>, times: f64| value.map_or_else(|| "–".to_owned(), |value| short(times * value));
    type Row<'a> = (&'a str, Box<dyn Fn(&Method) -> String + 'a>);
    let rows: [Row; 7] = [
        ("nulls left alone", Box::new(|m| share(m.nulls))),
        ("right name: kind, place and dof", Box::new(|m| share(m.named))),
        ("right kind", Box::new(|m| share(m.kind))),
        ("model fits to the noise afterwards", Box::new(|m| share(m.fits))),
        ("worst quantity off, stated deviations", Box::new(|m| number(m.worst_quantity, 1.0))),
        ("joint stiffness off, %", Box::new(|m| number(m.joint_stiffness, 100.0))),
        ("unmeasured FRFs off, %", Box::new(|m| number(m.unmeasured, 100.0))),
    ];
    let heads = methods.0.iter().map(|method| Column::numbers(method.what, ""));
    let table = rows.iter().fold(
        Table::new(std::iter::once(Column::text("on the same cases")).chain(heads)),
        |table, (what, cell)| {
            let cells = methods.0.iter().map(cell);
            table.row(std::iter::once((*what).to_owned()).chain(cells))
        },
    );
    Section::new("Beside what people do today")
        .paragraph(format!(
            "Parameter updating moves the quantities that the file states until the model fits: once within their stated tolerances, and once within \
             {WIDER:.0} times those, so that masses, places and stiffnesses can take up what the model lacks. What it then calls identified can be laid beside \
             the truth. It names nothing. The nearest signature is that of the effect, of all kinds at all places in a few sizes, whose change of the \
             FRFs points most nearly where the misfit does."
        ))
        .table(
            table
                .footnote(
                    "Right name and kind: of single effects that show, to the letter; the scores above also count a name that fits as well as the \
                     truth. The last four rows: single and double effects that show, without those where a joint is stiffer as a whole, which \
                     another modulus describes rightly.",
                )
                .footnote(
                    "Worst quantity: the largest departure of an identified quantity from its true value, in the standard deviations that the file states, \
                     median of cases. Joint stiffness: the worst element's relative error, median. Unmeasured FRFs: relative error, median.",
                ),
        )
}

fn short(value: f64) -> String {
    match value.abs() {
        v if v >= 100.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        v if v >= 0.1 => format!("{value:.2}"),
        _ => format!("{value:.3}"),
    }
}
