//! The page around the sections: head with policy and style, verdict, contents, foot, and the data that the script draws.

use crate::elements::Verdict;
use crate::error::PageError;
use crate::html::{push_element, push_escaped, script_safe};
use crate::plot::{ColumnPool, PlotData};
use crate::section::Section;

const UPLOT_SCRIPT: &str = include_str!("../assets/uplot.iife.min.js");
const UPLOT_STYLE: &str = include_str!("../assets/uplot.min.css");
const UPLOT_LICENSE: &str = include_str!("../assets/uplot.LICENSE.txt");
const SCRIPT: &str = include_str!("../assets/report.js");
const STYLE: &str = include_str!("../assets/report.css");

/// No network, no foreign content: style and script come with the page or not at all.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

/// Sections above which a page opens with a list of them.
const SECTIONS_WITHOUT_CONTENTS: usize = 2;

/// A report page.
#[derive(Debug, Clone)]
pub struct Page {
    title: String,
    subtitle: Option<String>,
    verdict: Option<Verdict>,
    sections: Vec<Section>,
    foot: Option<Foot>,
}

impl Page {
    /// An empty page.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), subtitle: None, verdict: None, sections: Vec::new(), foot: None }
    }

    /// A line below the title, such as the fixture's name and the recordings.
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = Some(subtitle.into());
        self
    }

    /// What came out, above everything else.
    pub fn verdict(mut self, verdict: Verdict) -> Self {
        self.verdict = Some(verdict);
        self
    }

    /// The next section.
    pub fn section(mut self, section: Section) -> Self {
        self.sections.push(section);
        self
    }

    /// Where the page comes from.
    pub fn foot(mut self, foot: Foot) -> Self {
        self.foot = Some(foot);
        self
    }

    /// The page as one HTML file.
    ///
    /// # Errors
    /// A series that is not as long as its abscissa, an abscissa that does not ascend, or a table row that does not fit its header.
    pub fn to_html(&self) -> Result<String, PageError> {
        let mut pool = ColumnPool::default();
        let mut plots = Vec::new();
        let mut body = String::new();
        let anchors = self.anchors();
        for (section, anchor) in self.sections.iter().zip(&anchors) {
            section.write(&mut body, anchor, &mut pool, &mut plots)?;
        }

        let mut html = String::with_capacity(body.len() + 100_000);
        self.write_head(&mut html, !plots.is_empty());
        self.write_header(&mut html, &anchors);
        html.push_str(&body);
        if let Some(foot) = &self.foot {
            foot.write(&mut html);
        }
        html.push_str("</main>\n");
        if !plots.is_empty() {
            write_scripts(&mut html, &plots, &pool);
        }
        html.push_str("</body>\n</html>\n");
        Ok(html)
    }

    fn write_head(&self, html: &mut String, plots: bool) {
        html.push_str("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
        html.push_str(&format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n"));
        html.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
        html.push_str("<meta name=\"color-scheme\" content=\"light dark\">\n");
        push_element(html, "title", "", &self.title);
        html.push_str("\n<style>\n");
        if plots {
            html.push_str(UPLOT_STYLE.trim());
            html.push('\n');
        }
        html.push_str(STYLE);
        html.push_str("</style>\n</head>\n<body>\n<main>\n");
    }

    fn write_header(&self, html: &mut String, anchors: &[String]) {
        html.push_str("<header>");
        push_element(html, "h1", "", &self.title);
        if let Some(subtitle) = &self.subtitle {
            push_element(html, "p", "subtitle", subtitle);
        }
        html.push_str("</header>\n");
        if let Some(verdict) = &self.verdict {
            verdict.write(html);
        }
        if self.sections.len() > SECTIONS_WITHOUT_CONTENTS {
            html.push_str("<nav aria-label=\"Contents\">");
            for (section, anchor) in self.sections.iter().zip(anchors) {
                html.push_str(&format!("<a href=\"#{anchor}\">"));
                push_escaped(html, &section.heading);
                html.push_str("</a>");
            }
            html.push_str("</nav>\n");
        }
    }

    /// One anchor per section: its heading in lower case with hyphens, numbered where two would be equal.
    fn anchors(&self) -> Vec<String> {
        let mut anchors: Vec<String> = Vec::with_capacity(self.sections.len());
        for section in &self.sections {
            let base = anchor(&section.heading);
            let mut candidate = base.clone();
            let mut count = 1;
            while anchors.contains(&candidate) {
                count += 1;
                candidate = format!("{base}-{count}");
            }
            anchors.push(candidate);
        }
        anchors
    }
}

fn anchor(heading: &str) -> String {
    let words: Vec<String> = heading
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_ascii_lowercase)
        .collect();
    if words.is_empty() { "section".to_owned() } else { words.join("-") }
}

fn write_scripts(html: &mut String, plots: &[PlotData], pool: &ColumnPool) {
    // Plain data without maps: serialising it cannot fail, and without plots the page would still be readable.
    let described = serde_json::to_string(plots).unwrap_or_else(|_| "[]".to_owned());
    html.push_str("<noscript><p class=\"footnote\">The plots need scripts to be allowed for this file; it loads nothing from elsewhere.</p></noscript>\n");
    html.push_str("<script type=\"application/json\" id=\"plot-data\">{\"plots\":");
    html.push_str(&script_safe(&described));
    html.push_str(",\n\"columns\":");
    html.push_str(&pool.to_json());
    html.push_str("}</script>\n<script>\n/*\n");
    html.push_str(UPLOT_LICENSE.trim());
    html.push_str("\n*/\n");
    html.push_str(UPLOT_SCRIPT.trim());
    html.push_str("\n</script>\n<script>\n");
    html.push_str(SCRIPT);
    html.push_str("</script>\n");
}

/// Where a page comes from: program, inputs, command line. It has no date, so that the same input gives the same page.
#[derive(Debug, Clone)]
pub struct Foot {
    program: String,
    inputs: Vec<(String, String)>,
    command: Option<String>,
}

impl Foot {
    /// The program and its version.
    pub fn new(program: impl Into<String>) -> Self {
        Self { program: program.into(), inputs: Vec::new(), command: None }
    }

    /// A file that was read, and its hash.
    pub fn input(mut self, name: impl Into<String>, hash: impl Into<String>) -> Self {
        self.inputs.push((name.into(), hash.into()));
        self
    }

    /// The command line that wrote the page.
    pub fn command(mut self, line: impl Into<String>) -> Self {
        self.command = Some(line.into());
        self
    }

    fn write(&self, html: &mut String) {
        html.push_str("<footer>");
        push_element(html, "p", "", &self.program);
        if let Some(command) = &self.command {
            push_element(html, "pre", "command", command);
        }
        if !self.inputs.is_empty() {
            html.push_str("<dl class=\"inputs\">");
            for (name, hash) in &self.inputs {
                push_element(html, "dt", "", name);
                push_element(html, "dd", "", hash);
            }
            html.push_str("</dl>");
        }
        html.push_str("</footer>\n");
    }
}
