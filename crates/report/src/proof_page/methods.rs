//! The diagnosis beside what people do today.

use jointscope_proof::{Method, Methods, Share, WIDER};

use super::cells::or_dash;
use crate::section::Section;
use crate::table::Table;

pub(super) fn section(methods: &Methods) -> Section {
    let share = |share: Option<Share>| or_dash(share.map(super::counted));
    let number = |value: Option<f64>, times: f64| or_dash(value.map(|value| short(times * value)));
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
    let table = Table::of(rows).words("on the same cases", |(what, _)| *what);
    let table = methods
        .0
        .iter()
        .fold(table, |table, method| table.numbers(method.what, "", |(_, cell)| cell(method)));
    Section::new("Beside what people do today")
        .paragraph(format!(
            "Parameter updating moves the quantities that the file states until the model fits: once within their stated tolerances, and once within \
             {WIDER:.0} times those, so that masses, places and stiffnesses can take up what the model lacks. What it then calls identified can be laid beside \
             the truth. It names nothing. The nearest signature is that of the effect, of all kinds at all places in a few sizes, whose change of the \
             FRFs points most nearly where the misfit does."
        ))
        .with(
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
