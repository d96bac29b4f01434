//! A route's scores as text and as JSON.

use super::{CaseLine, RouteScore, RouteScores};
use crate::table::{counted, figure_value, rate_value, share_value, write_figures, write_rates};
use serde_json::{Map, Value, json};
use std::fmt::{self, Display, Formatter, Write};

impl Display for RouteScores {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|score| write!(f, "\n{score}"))
    }
}

impl Display for RouteScore {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.key, self.what)?;
        for (role, all, asked) in &self.cases {
            match asked {
                0 => writeln!(f, "  {role:<8} {all}")?,
                asked => writeln!(f, "  {role:<8} {all}, {asked} asked for")?,
            }
        }
        writeln!(f, "\nshares (95 % binomial interval), target:")?;
        write_rates(f, &self.rates)?;
        writeln!(f, "\nfigures, target:")?;
        write_figures(f, &self.figures)?;
        if !self.sizes.is_empty() {
            writeln!(f, "\nsizes found: median error, within 10 %, 95 % intervals that hold the truth")?;
        }
        for size in &self.sizes {
            writeln!(
                f,
                "  {:<60} {:>6.2} %  {}  {}",
                size.what,
                100.0 * size.median,
                counted(size.within),
                counted(size.held)
            )?;
        }
        Ok(())
    }
}

impl RouteScore {
    /// The scores as JSON, every case included.
    pub fn to_value(&self) -> Value {
        let sizes = self.sizes.iter().map(|size| {
            json!({
                "what": size.what, "median_error": size.median, "within_10_percent": share_value(size.within),
                "held_by_ci95": share_value(size.held),
            })
        });
        json!({
            "what": self.what,
            "roles": self.cases.iter()
                .map(|(role, all, asked)| ((*role).to_owned(), json!({ "cases": all, "asked": asked })))
                .collect::<Map<_, _>>(),
            "rates": self.rates.iter().map(rate_value).collect::<Map<_, _>>(),
            "figures": self.figures.iter().map(figure_value).collect::<Map<_, _>>(),
            "sizes": sizes.collect::<Vec<_>>(),
            "cases": self.lines.iter().map(|line| line.value.clone()).collect::<Vec<_>>(),
        })
    }
}

impl CaseLine {
    /// The case in a few lines: what was hidden, what was found.
    pub fn account(&self) -> String {
        let what = if self.faults.is_empty() { "right".to_owned() } else { self.faults.join(", ") };
        let mut text = format!("case {}: {what}\n  hidden: {}", self.index, self.hidden);
        if !self.size.is_empty() {
            // Writing to a string cannot fail.
            let _ = write!(text, "; {}", self.size);
        }
        let _ = write!(text, "\n  answer: {}\n", self.verdict);
        self.details.iter().for_each(|line| {
            let _ = writeln!(text, "  {line}");
        });
        text
    }
}
