//! Pages in a browser: plots drawn, nothing complained of, names that are text whatever they hold.

use std::process::Command;

use crate::common::{Bench, TWO_BLOCKS};

/// The document that a browser makes of a page, and what it says on its console; `None` where there is no browser.
fn browsed(bench: &Bench, page: &str) -> Option<(String, Vec<String>)> {
    let profile = bench.0.join("profile");
    for browser in ["chromium", "chromium-browser", "google-chrome"] {
        let run = Command::new(browser)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--dump-dom"])
            .args(["--virtual-time-budget=3000", "--window-size=1200,6000"])
            .arg(format!("--user-data-dir={}", profile.display()))
            .arg(format!("file://{}", bench.0.join(page).display()))
            .output();
        let Ok(output) = run else { continue };
        let logged = String::from_utf8_lossy(&output.stderr);
        let console = logged.lines().filter(|line| line.contains("CONSOLE")).map(str::to_owned);
        return Some((String::from_utf8_lossy(&output.stdout).into_owned(), console.collect()));
    }
    println!("skipped: there is no Chromium here");
    None
}

/// What a script would do to the page if the name were markup.
const HOSTILE: &str =
    "<img src=x onerror=document.title='taken'></script><script>document.title='taken'</script>";

#[test]
fn a_browser_draws_every_plot_without_a_complaint_and_takes_no_name_for_markup() {
    let bench = Bench::new("pages-hostile");
    let quoted = serde_json::to_string(HOSTILE).unwrap();
    let fixture = TWO_BLOCKS
        .replace("\"two blocks and a beam\"", &quoted)
        .replace("\"J\"", &quoted)
        .replace("\"A\"", &quoted);
    bench.write("two.json", fixture);
    bench.done(&["synthesize", "two.json", "--lines", "50:1000:10", "-o", "frf.uff"]);
    for command in [
        &["decompose", "two.json", "frf.uff", "-o", "a"][..],
        &["check", "two.json", "frf.uff", "-o", "a"],
        &["modes", "frf.uff", "--fixture", "two.json", "-o", "a"],
    ] {
        bench.done(command);
        let Some((document, console)) = browsed(&bench, "a/report.html") else { return };
        assert_eq!(console, Vec::<String>::new(), "{command:?}");
        assert!(
            document.contains("<footer>") && !document.contains("<title>taken") && !document.contains("<img"),
            "{command:?}"
        );
        let (plots, drawn) =
            (document.matches("class=\"drawing\"").count(), document.matches("<canvas").count());
        assert!(
            drawn == plots && (drawn > 0 || command[0] == "check"),
            "{command:?}: {drawn} of {plots} plots are drawn"
        );
    }
}

#[test]
fn a_place_and_where_models_take_it_are_in_millimetres() {
    let bench = Bench::new("pages-places");
    bench.write("two.json", include_str!("../../../../fixtures/two-blocks/fixture.json"));
    bench.write("hammer-test.uff", include_bytes!("../../../../fixtures/two-blocks/hammer-test.uff"));
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
