//! Words and cells that several sections have.

use crate::table::Cell;
use crate::tone::Tone;
use jointscope_proof::Share;

/// "46 of 48", or that there is none.
pub(super) fn counted(share: Share) -> String {
    if share.all == 0 { "no case".to_owned() } else { format!("{} of {}", share.of, share.all) }
}

/// A case's number, which leads to its page where it has one.
pub(super) fn case_number(index: usize, has_page: bool) -> Cell {
    match has_page {
        true => Cell::Link(format!("{index:03}"), format!("cases/{index:03}/report.html")),
        false => format!("{index:03}").into(),
    }
}

/// Green where all is right (and something was `asked` for), red where a fault would mislead a reader, amber
/// where it is of the second order.
pub(super) fn tone(faults: &[String], asked: bool, lesser: &[&str]) -> Option<Tone> {
    if faults.is_empty() {
        return asked.then_some(Tone::Ok);
    }
    let grave = faults.iter().any(|fault| !lesser.contains(&fault.as_str()));
    Some(if grave { Tone::Problem } else { Tone::Attention })
}

/// A number where there is one.
pub(super) fn or_dash(text: Option<String>) -> String {
    text.unwrap_or_else(|| "–".to_owned())
}
