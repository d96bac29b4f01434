//! Numbers as pages print them.

use crate::common::{Bench, TWO_BLOCKS};

#[test]
fn a_place_and_where_models_take_it_are_in_millimetres() {
    let bench = Bench::new("pages-places");
    bench.write("two.json", include_str!("../../../../../fixtures/two-blocks/fixture.json"));
    bench.write("hammer-test.uff", include_bytes!("../../../../../fixtures/two-blocks/hammer-test.uff"));
    bench.done(&["diagnose", "two.json", "hammer-test.uff", "-o", "out"]);
    let page = bench.text("out/report.html");
    let rows: Vec<&str> = page.split("<tr").filter(|row| row.contains(">points/2/x<")).collect();
    assert!(rows.len() >= 2, "departures and tolerances have a row each");
    for row in rows {
        assert!(row.contains("0.00 ± 0.10 mm") && !row.contains("µm"), "{row}");
    }
}

/// What a page says: its text without scripts, styles, commands and markup.
fn spoken(page: &str) -> String {
    let mut text = page.to_owned();
    for tag in ["script", "style", "pre", "code", "footer"] {
        while let Some(from) = text.find(&format!("<{tag}")) {
            let end = text[from..].find(&format!("</{tag}>")).map_or(text.len(), |at| from + at);
            text.replace_range(from..end, " ");
            // The closing tag goes with all others.
        }
    }
    let mut spoken = String::new();
    let mut rest = text.as_str();
    while let Some((before, after)) = rest.split_once('<') {
        spoken.push_str(before);
        spoken.push(' ');
        rest = after.split_once('>').map_or("", |(_, after)| after);
    }
    spoken + rest
}

/// Where a number has a hyphen for its minus, or an exponent as computers write it.
fn typed_numbers(text: &str) -> Vec<&str> {
    let is_typed = |word: &&str| {
        let word = word.trim_start_matches(['(', '[']);
        let minus = word.strip_prefix('-').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
        let power = word.split_once('e').is_some_and(|(mantissa, power)| {
            let power = power.trim_start_matches('-').trim_end_matches([',', ')', ';', '.']);
            mantissa.parse::<f64>().is_ok() && power.parse::<u32>().is_ok()
        });
        minus || power
    };
    text.split_whitespace().filter(is_typed).collect()
}

#[test]
fn numbers_on_pages_are_typeset_and_none_has_a_hyphen_for_its_minus() {
    assert_eq!(
        typed_numbers("by -3.9 % (-2 to 3), p = 3e-14, 1.2e5; FRF 3/1 of case-1"),
        ["-3.9", "(-2", "3e-14,", "1.2e5;"]
    );
    let bench = Bench::new("pages-numbers");
    bench.write("two.json", TWO_BLOCKS);
    bench.write("truth.json", TWO_BLOCKS.replace("3.67e-10", "2.1e-10"));
    bench.done(&[
        "synthesize",
        "truth.json",
        "--lines",
        "5:1000:5",
        "-o",
        "frf.uff",
        "--frf",
        "4/1",
        "3/1",
        "4/2",
        "3/2",
        "1/1",
    ]);
    bench.done(&[
        "synthesize",
        "two.json",
        "--lines",
        "5:1000:5",
        "-o",
        "other.uff",
        "--frf",
        "4/1",
        "3/1",
        "4/2",
        "3/2",
    ]);
    for command in [
        &["decompose", "two.json", "frf.uff", "-o", "glued"][..],
        &["decompose", "two.json", "other.uff", "-o", "welded"],
        &["compare", "welded", "glued", "-o", "compared"],
        &["check", "two.json", "frf.uff", "-o", "checked"],
        &["modes", "frf.uff", "--fixture", "two.json", "-o", "modes"],
        &["diagnose", "two.json", "frf.uff", "-o", "out"],
    ] {
        bench.done(command);
        let page = bench.text(&format!("{}/report.html", command.last().unwrap()));
        let typed: Vec<String> = typed_numbers(&spoken(&page)).into_iter().map(str::to_owned).collect();
        assert_eq!(typed, Vec::<String>::new(), "{command:?}");
    }
}
