//! What came of every case: a row each.

use std::fmt;

use csv::Writer;
use serde_json::Value;

use crate::{DecomposedCase, DiagnosedCase};

/// The command that was run on every case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command {
    /// `diagnose`.
    Diagnose,
    /// `decompose`.
    Decompose,
}

impl Command {
    /// As it is typed.
    pub fn name(self) -> &'static str {
        match self {
            Command::Diagnose => "diagnose",
            Command::Decompose => "decompose",
        }
    }

    /// By its name.
    pub fn named(name: &str) -> Option<Self> {
        [Command::Diagnose, Command::Decompose].into_iter().find(|command| command.name() == name)
    }

    /// The file that holds its answer.
    pub fn answer(self) -> &'static str {
        match self {
            Command::Diagnose => "diagnosis.json",
            Command::Decompose => "stiffness.json",
        }
    }

    /// What an answer's contents come to; refused where they are none.
    pub fn state(self, file: &Value) -> State {
        let state = match self {
            Command::Diagnose => DiagnosedCase::of(file).map(|case| State::Diagnosed(Box::new(case))),
            Command::Decompose => DecomposedCase::of(file).map(|case| State::Decomposed(Box::new(case))),
        };
        state.unwrap_or_else(|| {
            State::Refused(format!(
                "its {} is not one that `{}` wrote; run the case anew",
                self.answer(),
                self.name()
            ))
        })
    }
}

/// What came of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// It was diagnosed.
    Diagnosed(Box<DiagnosedCase>),
    /// It was decomposed.
    Decomposed(Box<DecomposedCase>),
    /// There is no answer: why, in one sentence.
    Refused(String),
    /// It has not been tried, as far as the files tell.
    Missing,
}

impl State {
    /// Whether there is an answer.
    pub fn is_answered(&self) -> bool {
        matches!(self, State::Diagnosed(_) | State::Decomposed(_))
    }

    /// What came out, in few words.
    pub fn verdict(&self) -> &str {
        match self {
            State::Diagnosed(case) => &case.verdict,
            State::Decomposed(case) => &case.verdict,
            State::Refused(_) => "refused",
            State::Missing => "not done",
        }
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            State::Diagnosed(case) => match case.findings.first() {
                Some(finding) => write!(f, "{}, {}", case.verdict, finding.name()),
                None => f.write_str(&case.verdict),
            },
            State::Refused(why) => write!(f, "refused: {why}"),
            state => f.write_str(state.verdict()),
        }
    }
}

/// A case and what came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The case's name.
    pub case: String,
    /// What came of it.
    pub state: State,
}

/// All cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// What was run.
    pub command: Command,
    /// In the order of the cases.
    pub rows: Vec<Row>,
}

impl Summary {
    /// How many cases came to what, in the order in which that is first seen:
    /// `7 explained, 2 consistent, 1 refused`.
    pub fn counts(&self) -> Vec<(&str, usize)> {
        let mut counts: Vec<(&str, usize)> = Vec::new();
        for row in &self.rows {
            let verdict = row.state.verdict();
            match counts.iter_mut().find(|(known, _)| *known == verdict) {
                Some((_, count)) => *count += 1,
                None => counts.push((verdict, 1)),
            }
        }
        counts
    }

    /// One sentence: how many cases, and what they came to.
    pub fn says(&self) -> String {
        let counts: Vec<String> = self
            .counts()
            .into_iter()
            .map(|(verdict, count)| format!("{count} {}", verdict.replace('_', " ")))
            .collect();
        let cases = if self.rows.len() == 1 { "case" } else { "cases" };
        format!("{} {cases}: {}", self.rows.len(), counts.join(", "))
    }

    /// The table with commas between cells: a row of headings, then a row a case. `state` is `done`,
    /// `refused` or `not done`; of a case without an answer `says` holds why.
    pub fn csv(&self) -> String {
        let own = match self.command {
            Command::Diagnose => DiagnosedCase::HEAD.map(str::to_owned).to_vec(),
            Command::Decompose => DecomposedCase::head(),
        };
        let width = own.len();
        let mut writer = Writer::from_writer(Vec::new());
        let mut write = |case: &str, state: &str, cells: Vec<String>| {
            // Rows are of equal length and memory takes them all.
            let _ = writer.write_record([case.to_owned(), state.to_owned()].into_iter().chain(cells));
        };
        write("case", "state", own);
        for row in &self.rows {
            let mut empty = vec![String::new(); width];
            match &row.state {
                State::Diagnosed(case) => write(&row.case, "done", case.cells()),
                State::Decomposed(case) => write(&row.case, "done", case.cells()),
                State::Refused(why) => {
                    empty[width - 1] = why.clone();
                    write(&row.case, "refused", empty);
                }
                State::Missing => write(&row.case, "not done", empty),
            }
        }
        let bytes = writer.into_inner().unwrap_or_default();
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn diagnosis() -> Value {
        json!({
            "verdict": "explained", "says": "The fixture leaves out, say, a mass.",
            "findings": [
                {"kind": "added_mass", "place": "B", "probability": 0.97, "parameters": {
                    "x": {"value": 0.1350004, "std": 0.00012, "unit": "m"}, "mass": {"value": 0.06, "std": null, "unit": "kg"}}},
                {"kind": "channel_gain", "place": "response 4", "dof": null, "probability": 0.9, "parameters": {}}
            ],
            "fit": {"nrmse": {"nominal": 0.5, "refitted": 0.25, "repaired": 0.125}, "chi2_per_dof": {"nominal": 9.0, "refitted": 3.0, "repaired": 1.0}, "held_out": null}
        })
    }

    #[test]
    fn a_row_holds_what_was_found_and_one_without_an_answer_says_why() {
        let summary = Summary {
            command: Command::Diagnose,
            rows: vec![
                Row { case: "a".into(), state: Command::Diagnose.state(&diagnosis()) },
                Row { case: "b".into(), state: State::Refused("b.uff: there is no such file".into()) },
                Row { case: "c".into(), state: State::Missing },
                Row { case: "d".into(), state: Command::Diagnose.state(&json!({})) },
            ],
        };
        let lines: Vec<String> = summary.csv().lines().map(str::to_owned).collect();
        assert_eq!(
            lines[1],
            "a,done,explained,2,added_mass,B,,0.97,x 0.135 ± 0.00012 m; mass 0.06 kg,channel_gain response 4,0.5,0.25,0.125,9,3,1,,,,\"The fixture leaves out, say, a mass.\""
        );
        assert!(lines[2].starts_with("b,refused,") && lines[2].ends_with(",b.uff: there is no such file"));
        assert!(lines[3].starts_with("c,not done,"));
        assert!(lines[4].contains("run the case anew"));
        assert!(lines.iter().all(|line| line.matches(',').count() >= lines[0].matches(',').count()));
        assert_eq!(summary.says(), "4 cases: 1 explained, 2 refused, 1 not done");
    }

    #[test]
    fn a_decomposition_has_its_six_numbers_and_one_that_failed_says_so() {
        let matrix = |a: f64| json!([[a, -2.0], [-2.0, 3.0]]);
        let good = json!({"joint": {"name": "J", "stiffness": matrix(1e6), "damping": matrix(5.0),
            "std": {"stiffness": matrix(1e4), "damping": matrix(0.5)}, "chi2_per_dof": 1.5, "law": "viscous",
            "laws": [{"law": "structural", "probability": 0.1}, {"law": "viscous", "probability": 0.875}]},
            "judgement": {"verdict": "sound"}});
        let State::Decomposed(case) = Command::Decompose.state(&good) else { panic!("no decomposition") };
        assert_eq!(case.numbers[0], Some((1e6, 1e4)));
        assert_eq!(case.numbers[5], Some((3.0, 3.0)));
        assert_eq!(case.law, Some(("viscous".into(), Some(0.875))));
        let failed =
            json!({"joint": {"name": "J", "failed": "too few lines"}, "judgement": {"verdict": "unusable"}});
        let rows = vec![Row { case: "x".into(), state: Command::Decompose.state(&failed) }];
        let csv = Summary { command: Command::Decompose, rows }.csv();
        assert!(csv.ends_with(",too few lines\n") && csv.contains("\nx,done,J,unusable,,"), "{csv}");
    }
}
