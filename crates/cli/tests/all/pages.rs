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
