//! A map of numbers by row and column, each cell shaded by its number.

use crate::error::PageError;
use crate::html::{push_element, push_escaped};

/// χ² per value (or per degree of freedom) by place and band: shaded from 1, which is noise, to the end of the scale.
///
/// ```
/// use jointscope_report::HeatMap;
/// let map = HeatMap::new("FRF", ["15 to 200 Hz", "200 to 400 Hz"])
///     .row("4/1", [Some(1.02), Some(37.0)])
///     .row("3/1", [Some(0.97), None]);
/// # let _ = map;
/// ```
#[derive(Debug, Clone)]
pub struct HeatMap {
    corner: String,
    columns: Vec<String>,
    rows: Vec<(String, Vec<Option<f64>>)>,
    counts: bool,
    caption: Option<String>,
    footnote: Option<String>,
}

/// Number at which the shade is full: from there on it is all the same how bad it is.
const FULL: f64 = 100.0;
/// Strength of the full shade, %: the numbers stay readable on it.
const STRONGEST: f64 = 70.0;

impl HeatMap {
    /// A map without rows; `corner` heads the rows' names.
    pub fn new<T: Into<String>>(corner: impl Into<String>, columns: impl IntoIterator<Item = T>) -> Self {
        HeatMap {
            corner: corner.into(),
            columns: columns.into_iter().map(Into::into).collect(),
            rows: Vec::new(),
            counts: false,
            caption: None,
            footnote: None,
        }
    }

    /// A map of counts instead, each shaded by its share of the row; what is zero is left empty.
    pub fn of_counts(mut self) -> Self {
        self.counts = true;
        self
    }

    /// A row with one number per column; checked when the page is rendered.
    pub fn row(mut self, name: impl Into<String>, values: impl IntoIterator<Item = Option<f64>>) -> Self {
        self.rows.push((name.into(), values.into_iter().collect()));
        self
    }

    /// A sentence above the map.
    pub fn caption(mut self, caption: impl Into<String>) -> Self {
        self.caption = Some(caption.into());
        self
    }

    /// A line below the map.
    pub fn footnote(mut self, footnote: impl Into<String>) -> Self {
        self.footnote = Some(footnote.into());
        self
    }

    pub(crate) fn write(&self, html: &mut String) -> Result<(), PageError> {
        html.push_str("<div class=\"table\"><table class=\"heat\">");
        if let Some(caption) = &self.caption {
            push_element(html, "caption", "", caption);
        }
        html.push_str("<thead><tr>");
        push_heading(html, "col", &self.corner);
        self.columns.iter().for_each(|column| push_heading(html, "col", column));
        html.push_str("</tr></thead>\n<tbody>\n");
        for (index, (name, values)) in self.rows.iter().enumerate() {
            if values.len() != self.columns.len() {
                return Err(PageError::RowLength {
                    table: self.caption.clone().unwrap_or_else(|| self.corner.clone()),
                    row: index,
                    expected: self.columns.len(),
                    got: values.len(),
                });
            }
            html.push_str("<tr>");
            push_heading(html, "row", name);
            if self.counts {
                let all = values.iter().flatten().sum::<f64>();
                values.iter().for_each(|value| push_count(html, *value, all));
            } else {
                values.iter().for_each(|value| push_cell(html, *value));
            }
            html.push_str("</tr>\n");
        }
        html.push_str("</tbody></table>");
        if let Some(footnote) = &self.footnote {
            push_element(html, "p", "footnote", footnote);
        }
        html.push_str("</div>\n");
        Ok(())
    }
}

fn push_heading(html: &mut String, scope: &str, text: &str) {
    html.push_str(&format!("<th scope=\"{scope}\">"));
    push_escaped(html, text);
    html.push_str("</th>");
}

fn push_cell(html: &mut String, value: Option<f64>) {
    match value.filter(|value| value.is_finite()) {
        None => html.push_str("<td>–</td>"),
        Some(value) => {
            let shade = STRONGEST * (value.max(1.0).ln() / FULL.ln()).min(1.0);
            html.push_str(&format!("<td style=\"--shade-share:{shade:.0}%\">{}</td>", number(value)));
        }
    }
}

fn push_count(html: &mut String, value: Option<f64>, all: f64) {
    match value.filter(|value| *value > 0.0) {
        None => html.push_str("<td></td>"),
        Some(value) => {
            let shade = STRONGEST * (value / all).min(1.0);
            html.push_str(&format!("<td style=\"--shade-share:{shade:.0}%\">{value:.0}</td>"));
        }
    }
}

/// Short enough for twelve columns: 1.02, 37.4, 374, 3.7k.
fn number(value: f64) -> String {
    match value {
        v if v < 10.0 => format!("{v:.2}"),
        v if v < 100.0 => format!("{v:.1}"),
        v if v < 1e4 => format!("{v:.0}"),
        v if v < 1e6 => format!("{:.0}k", v / 1e3),
        v => format!("{v:.0e}"),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_not_shaded_and_what_is_far_above_it_is() {
        let mut html = String::new();
        HeatMap::new("FRF", ["low", "high"]).row("<4/1>", [Some(0.9), Some(1e5)]).write(&mut html).unwrap();
        assert!(
            html.contains("--shade-share:0%\">0.90<") && html.contains("--shade-share:70%\">100k<"),
            "{html}"
        );
        assert!(html.contains("&lt;4/1&gt;"));
    }

    #[test]
    fn counts_are_shaded_by_their_share_of_the_row() {
        let mut html = String::new();
        let map = HeatMap::new("hidden", ["a", "b"]).of_counts().row("a", [Some(3.0), Some(1.0)]);
        map.row("b", [Some(0.0), Some(2.0)]).write(&mut html).unwrap();
        for part in
            ["--shade-share:52%\">3<", "--shade-share:18%\">1<", "<td></td>", "--shade-share:70%\">2<"]
        {
            assert!(html.contains(part), "{part} in {html}");
        }
    }

    #[test]
    fn what_is_not_known_is_a_dash_and_a_short_row_is_refused() {
        let mut html = String::new();
        let map = HeatMap::new("FRF", ["low", "high"]).row("4/1", [None, Some(f64::NAN)]);
        map.write(&mut html).unwrap();
        assert_eq!(html.matches("<td>–</td>").count(), 2);
        assert!(matches!(map.row("3/1", [None]).write(&mut html), Err(PageError::RowLength { row: 1, .. })));
    }
}
