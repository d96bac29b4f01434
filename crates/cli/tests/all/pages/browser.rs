//! A browser that opens pages in frames, and a script beside them that tells what it sees.

use std::process::Command;

use serde_json::Value;

use crate::common::Bench;

/// What a browser makes of pages.
pub(super) struct Seen {
    /// What the script made of each page, in order.
    pub pages: Vec<Value>,
    /// What the browser said on its console.
    pub console: Vec<String>,
}

/// Opens pages of a bench side by side, each as it was written, its policy in force; `script` defines `look`,
/// which is given the frame of a page and answers with what can be said as JSON. `None` where there is no
/// browser.
pub(super) fn opened(bench: &Bench, pages: &[&str], script: &str) -> Option<Seen> {
    let frames: String = pages
        .iter()
        .map(|page| {
            format!("<iframe style=\"width:1200px;height:6000px;border:0;position:absolute;left:0;top:0\" src=\"{}\"></iframe>", address(page))
        })
        .collect();
    let around = format!(
        "<!DOCTYPE html><meta charset=\"utf-8\"><body>{frames}<script>{script}\n{}</script>",
        include_str!("frames.js")
    );
    bench.write("frames.html", around);
    let profile = bench.0.join("profile");
    for browser in ["chromium", "chromium-browser", "google-chrome"] {
        let run = Command::new(browser)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--dump-dom"])
            // Files are strangers to one another unless this is said.
            .args(["--enable-logging=stderr", "--allow-file-access-from-files"])
            .args(["--virtual-time-budget=60000", "--window-size=1300,6000"])
            .arg(format!("--user-data-dir={}", profile.display()))
            .arg(format!("file://{}", bench.0.join("frames.html").display()))
            .output();
        let Ok(output) = run else { continue };
        let logged = String::from_utf8_lossy(&output.stderr);
        let console = logged.lines().filter(|line| line.contains("CONSOLE")).map(str::to_owned).collect();
        let document = String::from_utf8_lossy(&output.stdout);
        let told = document.split("id=\"seen\">").nth(1).and_then(|rest| rest.split("</script>").next());
        let told = told.unwrap_or_else(|| panic!("the script did not come to its end: {console:?}"));
        let pages: Vec<Value> = serde_json::from_str(told).unwrap();
        return Some(Seen { pages, console });
    }
    println!("skipped: there is no Chromium here");
    None
}

/// The path of a file as part of an address, whatever characters it holds.
fn address(path: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/-_.".contains(&byte);
    path.bytes()
        .map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
        .collect()
}
