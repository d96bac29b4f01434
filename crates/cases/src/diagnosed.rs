//! What `diagnosis.json` says of a case, as far as a row of a table holds it.

use serde::Deserialize;
use serde_json::Value;

/// A case that was diagnosed.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagnosedCase {
    /// `consistent`, `explained`, `partly_explained` or `unexplained`.
    pub verdict: String,
    /// The sentence on the page.
    pub says: String,
    /// What was found, the strongest first.
    pub findings: Vec<FindingRow>,
    /// Relative error of the nominal, refitted and repaired model.
    pub nrmse: [Option<f64>; 3],
    /// χ² per degree of freedom of the same.
    pub chi2_per_dof: [Option<f64>; 3],
    /// Relative error of the refitted and the repaired model on what no fit saw.
    pub held_out: [Option<f64>; 2],
    /// Whether a limit of work or time ended the search.
    pub stopped: bool,
}

/// A finding.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct FindingRow {
    /// Kind of effect.
    pub kind: String,
    /// Where.
    #[serde(default)]
    pub place: Option<String>,
    /// `translation` or `rotation`, where it has one.
    #[serde(default)]
    pub dof: Option<String>,
    /// That it is this.
    #[serde(default)]
    pub probability: Option<f64>,
    #[serde(default)]
    parameters: Value,
}

impl FindingRow {
    /// Kind, place and dof in words: `interface_compliance 2 rotation`.
    pub(crate) fn name(&self) -> String {
        let parts = [Some(&self.kind), self.place.as_ref(), self.dof.as_ref()];
        parts.into_iter().flatten().map(String::as_str).collect::<Vec<_>>().join(" ")
    }

    /// Its parameters: name, value, standard deviation and unit.
    pub fn estimates(&self) -> impl Iterator<Item = (&str, f64, Option<f64>, &str)> {
        let parameters = self.parameters.as_object().into_iter().flatten();
        parameters.filter_map(|(name, parameter)| {
            let number = |key: &str| parameter.get(key).and_then(Value::as_f64);
            let unit = parameter.get("unit").and_then(Value::as_str).unwrap_or("1");
            Some((name.as_str(), number("value")?, number("std"), unit))
        })
    }

    /// Parameters in words: `stiffness 9141 ± 91 N*m/rad; damping …`.
    pub(crate) fn parameters(&self) -> String {
        let Some(parameters) = self.parameters.as_object() else { return String::new() };
        let one = |(name, parameter): (&String, &Value)| {
            let value = parameter.get("value")?.as_f64()?;
            let std =
                parameter.get("std").and_then(Value::as_f64).map(|std| format!(" ± {}", digits(std, 2)));
            let unit = parameter.get("unit").and_then(Value::as_str).filter(|unit| *unit != "1");
            let unit = unit.map(|unit| format!(" {unit}"));
            Some(format!(
                "{name} {}{}{}",
                digits(value, 5),
                std.unwrap_or_default(),
                unit.unwrap_or_default()
            ))
        };
        parameters.iter().filter_map(one).collect::<Vec<_>>().join("; ")
    }
}

/// A number of so many significant digits in its shorter spelling.
fn digits(value: f64, digits: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    spelled(rounded)
}

/// A number that reads back as itself, in its shorter spelling.
pub(crate) fn spelled(value: f64) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if plain.len() <= scientific.len() + 2 { plain } else { scientific }
}

impl DiagnosedCase {
    /// Of the contents of `diagnosis.json`; `None` where they are no diagnosis.
    pub(crate) fn of(file: &Value) -> Option<Self> {
        let text = |key: &str| file.get(key).and_then(Value::as_str).map(str::to_owned);
        let by_model = |key: &str| {
            ["nominal", "refitted", "repaired"]
                .map(|model| file.get("fit").and_then(|fit| fit.get(key)?.get(model)?.as_f64()))
        };
        let held_out = |key: &str| file.get("fit").and_then(|fit| fit.get("held_out")?.get(key)?.as_f64());
        Some(DiagnosedCase {
            verdict: text("verdict")?,
            says: text("says").unwrap_or_default(),
            findings: serde_json::from_value(file.get("findings")?.clone()).ok()?,
            nrmse: by_model("nrmse"),
            chi2_per_dof: by_model("chi2_per_dof"),
            held_out: [held_out("nrmse_refitted"), held_out("nrmse_repaired")],
            stopped: file.get("stopped").is_some(),
        })
    }

    pub(crate) const HEAD: [&'static str; 18] = [
        "verdict",
        "findings",
        "kind",
        "place",
        "dof",
        "probability",
        "parameters",
        "further_findings",
        "nrmse_nominal",
        "nrmse_refitted",
        "nrmse_repaired",
        "chi2_per_dof_nominal",
        "chi2_per_dof_refitted",
        "chi2_per_dof_repaired",
        "held_out_nrmse_refitted",
        "held_out_nrmse_repaired",
        "stopped",
        "says",
    ];

    pub(crate) fn cells(&self) -> Vec<String> {
        let number = |value: Option<f64>| value.map(spelled).unwrap_or_default();
        let first = self.findings.first();
        let of_first = |part: fn(&FindingRow) -> Option<String>| first.and_then(part).unwrap_or_default();
        let further: Vec<String> = self.findings.iter().skip(1).map(FindingRow::name).collect();
        let mut cells = vec![
            self.verdict.clone(),
            self.findings.len().to_string(),
            of_first(|finding| Some(finding.kind.clone())),
            of_first(|finding| finding.place.clone()),
            of_first(|finding| finding.dof.clone()),
            number(first.and_then(|finding| finding.probability)),
            of_first(|finding| Some(finding.parameters())),
            further.join("; "),
        ];
        cells.extend(
            self.nrmse.iter().chain(&self.chi2_per_dof).chain(&self.held_out).map(|value| number(*value)),
        );
        cells.push(if self.stopped { "yes" } else { "" }.to_owned());
        cells.push(self.says.clone());
        cells
    }
}
