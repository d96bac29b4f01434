//! What `jointscope diagnose` writes, whichever way it was found.

use jointscope::fixture::Fixture;
use jointscope_report::{HammerTest, PageContext, PageError};
use serde_json::Value;

use crate::arguments::DiagnoseArguments;
use crate::input;
use crate::output::Outputs;
use crate::refusal::Refusal;

/// The parts of an answer.
pub struct Diagnosed<'a> {
    /// `diagnosis.json`, but for what it was made from.
    pub answer: Value,
    /// The refitted and the repaired fixture.
    pub fixtures: [&'a Fixture; 2],
    /// What a reader should know of the recording.
    pub notes: Vec<String>,
    /// The hits that it was made from.
    pub hits: Option<HammerTest>,
    /// What was found, a line each.
    pub summary: Vec<String>,
}

impl Diagnosed<'_> {
    /// Writes `diagnosis.json`, `refitted.json`, `repaired.json` and the page that `draw` makes; answers with what was found and where the
    /// page is, or with `diagnosis.json` itself.
    pub fn written(
        self,
        arguments: &DiagnoseArguments,
        draw: impl FnOnce(&PageContext) -> Result<String, PageError>,
    ) -> Result<String, Refusal> {
        let files = || std::iter::once(&arguments.fixture).chain(&arguments.recording.files);
        let context = input::context(files(), self.notes, self.hits)?;
        let mut answer = self.answer;
        input::add_origin(&mut answer, &context);
        let answer = serde_json::to_string_pretty(&answer).map_err(Refusal::new)? + "\n";
        let Some(folder) = &arguments.output else { return Ok(answer.trim_end().to_owned()) };
        let page = draw(&context).map_err(Refusal::new)?;
        let page_path = folder.join("report.html");
        let [refitted, repaired] = self.fixtures;
        let mut outputs = Outputs::new(files());
        outputs.add(folder.join("diagnosis.json"), answer.clone());
        outputs.add(folder.join("refitted.json"), refitted.to_json());
        outputs.add(folder.join("repaired.json"), repaired.to_json());
        outputs.add(&page_path, page);
        outputs.write()?;
        if arguments.json {
            return Ok(answer.trim_end().to_owned());
        }
        let mut lines = context.notes;
        lines.extend(self.summary);
        lines.push(page_path.display().to_string());
        Ok(lines.join("\n"))
    }
}
