//! The diagnosis beside what people do today.

use jointscope_proof::{Method, Methods, Share, WIDER};

use crate::{Column, Section, Table};

pub(super) fn section(methods: &Methods) -> Section {
    let columns = [
        Column::text("method, on the same cases"),
        Column::numbers("nulls left alone", ""),
        Column::numbers("right name", ""),
        Column::numbers("right kind", ""),
        Column::numbers("fits to the noise", ""),
        Column::numbers("worst quantity", "deviations"),
        Column::numbers("joint stiffness off", "%"),
        Column::numbers("unmeasured FRFs off", "%"),
    ];
    let table = methods.0.iter().fold(Table::new(columns), |table, method| {
        let share = |share: Option<Share>| share.map_or_else(|| "–".to_owned(), super::counted);
        let number = |value: Option<f64>, times: f64| {
            value.map_or_else(|| "–".to_owned(), |value| short(times * value))
        };
        let Method { what, nulls, named, kind, fits, worst_quantity, joint_stiffness, unmeasured, .. } =
            method;
        table.row([
            (*what).to_owned(),
            share(*nulls),
            share(*named),
            share(*kind),
            share(*fits),
            number(*worst_quantity, 1.0),
            number(*joint_stiffness, 100.0),
            number(*unmeasured, 100.0),
        ])
    });
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
                    "Right name and kind: of single effects that show; the baselines' by the letter, the diagnosis' also where another name fits as well as \
                     the truth. The last four columns: single and double effects that show, without those where a joint is stiffer as a whole, which \
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
