//! The page around the sections: head with policy and style, verdict, contents, foot, and the data that the
//! script draws.

use std::collections::BTreeSet;

use base64::{Engine, prelude::BASE64_STANDARD};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest, Sha256};

use crate::error::PageError;
use crate::format::hides;
use crate::input_file::InputFile;
use crate::json::script_safe;
use crate::plot::PlotBook;
use crate::section::{Section, Verdict};

const UPLOT_SCRIPT: &str = include_str!("../assets/uplot.iife.min.js");
const UPLOT_STYLE: &str = include_str!("../assets/uplot.min.css");
const UPLOT_LICENSE: &str = include_str!("../assets/uplot.LICENSE.txt");
const SCRIPT: &str = include_str!("../assets/report.js");
const STYLE: &str = include_str!("../assets/report.css");

/// No network, no foreign content: nothing is in force but these styles and scripts, told by their hashes.
/// Attributes of style remain, for drawings are made of them; what they could load is forbidden.
fn policy<'a>(styles: impl Iterator<Item = &'a str>, scripts: &[&'a str]) -> String {
    let hash = |text: &str| format!(" 'sha256-{}'", BASE64_STANDARD.encode(Sha256::digest(text)));
    let scripts: String = scripts.iter().copied().map(hash).collect();
    let scripts = if scripts.is_empty() { " 'none'" } else { &scripts };
    let styles: BTreeSet<String> = styles.map(hash).collect();
    let styles: String = styles.into_iter().collect();
    format!(
        "default-src 'none'; base-uri 'none'; form-action 'none'; img-src data:; script-src{scripts}; style-src-elem{styles}; style-src-attr 'unsafe-inline'"
    )
}

/// The styles that drawings bring with them, so that they are whole as files of their own. No text from
/// outside holds the mark of one.
fn styles_of(section: &Markup) -> impl Iterator<Item = &str> {
    section.0.split("<style>").skip(1).filter_map(|rest| Some(rest.split_once("</style>")?.0))
}

/// Sections above which a page opens with a list of them.
const SECTIONS_WITHOUT_CONTENTS: usize = 2;

/// A report page. Text from outside is escaped wherever it stands.
#[derive(Clone)]
pub(crate) struct Page {
    title: String,
    subtitle: String,
    verdict: Option<Verdict>,
    sections: Vec<Section>,
    foot: Markup,
}

impl Page {
    /// An empty page.
    pub(crate) fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            subtitle: String::new(),
            verdict: None,
            sections: Vec::new(),
            foot: Markup::default(),
        }
    }

    /// A line below the title, such as the fixture's name and the recordings.
    pub(crate) fn subtitle(self, subtitle: impl Into<String>) -> Self {
        Self { subtitle: subtitle.into(), ..self }
    }

    /// What came out, above everything else.
    pub(crate) fn verdict(self, verdict: Verdict) -> Self {
        Self { verdict: Some(verdict), ..self }
    }

    /// The next section or sections, or none.
    pub(crate) fn sections(mut self, sections: impl IntoIterator<Item = Section>) -> Self {
        self.sections.extend(sections);
        self
    }

    /// Where the page comes from. It has no date, so that the same input gives the same page.
    pub(crate) fn foot(self, program: &str, command: &str, inputs: &[InputFile]) -> Self {
        let foot = html! {
            footer {
                p { (program) }
                @if !command.is_empty() { pre.command { (command) } }
                @if !inputs.is_empty() {
                    dl.inputs {
                        @for input in inputs { dt { (input.name) } dd { "sha256 " (input.sha256) } }
                    }
                }
            }
        };
        Self { foot, ..self }
    }

    /// The page as one HTML file.
    ///
    /// # Errors
    /// A series that is not as long as its abscissa, or an abscissa that does not ascend.
    pub(crate) fn to_html(&self) -> Result<String, PageError> {
        let mut plots = PlotBook::default();
        let anchors = self.anchors();
        let sections = self.sections.iter().zip(&anchors);
        let bodies: Vec<Markup> =
            sections.map(|(section, anchor)| section.render(anchor, &mut plots)).collect::<Result<_, _>>()?;
        let library = format!("/*\n{UPLOT_LICENSE}*/\n{UPLOT_SCRIPT}");
        let (style, scripts) = match plots.is_empty() {
            true => (STYLE.to_owned(), vec![]),
            false => (format!("{UPLOT_STYLE}{STYLE}"), vec![library.as_str(), SCRIPT]),
        };
        let styles = std::iter::once(style.as_str()).chain(bodies.iter().flat_map(styles_of));
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta http-equiv="Content-Security-Policy" content=(policy(styles, &scripts));
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(&style)) }
                }
                body {
                    main {
                        header {
                            h1 { (self.title) }
                            @if !self.subtitle.is_empty() { p.subtitle { (self.subtitle) } }
                        }
                        @if let Some(verdict) = &self.verdict { (verdict) }
                        @if self.sections.len() > SECTIONS_WITHOUT_CONTENTS {
                            nav aria-label="Contents" {
                                @for (section, anchor) in self.sections.iter().zip(&anchors) {
                                    a href={ "#" (anchor) } { (section.heading) }
                                }
                            }
                        }
                        @for body in &bodies { "\n" (body) }
                        (self.foot)
                    }
                    @if !plots.is_empty() { (drawn(&plots, &scripts)) }
                }
            }
        };
        // The replacement character says that something stood there.
        Ok(page.into_string().replace(hides, "\u{fffd}"))
    }

    /// The sections with their anchors.
    pub(crate) fn parts(&self) -> impl Iterator<Item = (String, &Section)> {
        self.anchors().into_iter().zip(&self.sections)
    }

    /// One anchor per section: its heading in lower case with hyphens, numbered where two would be equal.
    fn anchors(&self) -> Vec<String> {
        let mut anchors: Vec<String> = Vec::with_capacity(self.sections.len());
        for section in &self.sections {
            let base = anchor(&section.heading);
            let numbered = (2..).map(|count| format!("{base}-{count}"));
            let free = std::iter::once(base.clone()).chain(numbered).find(|name| !anchors.contains(name));
            anchors.extend(free);
        }
        anchors
    }
}

/// A heading as a part of addresses and file names: lower case and hyphens.
pub(crate) fn anchor(heading: &str) -> String {
    let words = heading.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let anchor = words.map(str::to_ascii_lowercase).collect::<Vec<_>>().join("-");
    if anchor.is_empty() { "section".to_owned() } else { anchor }
}

/// A drawing with the page's variables replaced by their values by day, or by what it states itself for a
/// variable that the page does not have.
pub(crate) fn in_plain_colours(svg: &str) -> String {
    const VARIABLE: &str = "var(--";
    let mut plain = String::with_capacity(svg.len());
    let mut rest = svg;
    while let Some(at) = rest.find(VARIABLE) {
        plain.push_str(&rest[..at]);
        rest = &rest[at + VARIABLE.len()..];
        let end = rest.find(')').unwrap_or(rest.len());
        let (name, own) = rest[..end].split_once(',').unwrap_or((&rest[..end], "#000000"));
        plain.push_str(colour(name).unwrap_or(own.trim()));
        rest = rest.get(end + 1..).unwrap_or_default();
    }
    plain.push_str(rest);
    plain
}

/// A colour of the page by day, as the style sheet's first block states it.
fn colour(name: &str) -> Option<&'static str> {
    let root = STYLE.split_once(":root {")?.1.split_once('}')?.0;
    let mut entries = root.split(';').filter_map(|entry| entry.trim().strip_prefix("--")?.split_once(':'));
    entries.find(|(key, _)| *key == name).map(|(_, value)| value.trim())
}

/// Data and scripts. The scripts' text is ours, and the data cannot leave its place.
fn drawn(plots: &PlotBook, scripts: &[&str]) -> Markup {
    html! {
        noscript {
            p.footnote {
                "The plots need scripts to be allowed for this file; it loads nothing from elsewhere."
            }
        }
        script type="application/json" id="plot-data" { (PreEscaped(script_safe(&plots.to_json()))) }
        @for script in scripts { script { (PreEscaped(script)) } }
    }
}
