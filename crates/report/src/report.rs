//! A page and what can be taken off it: its tables and curves as CSV, its figures as SVG.
//!
//! Tables hold what the page shows, with as many digits: a number with its ± becomes two columns or more,
//! units that go from row to row get a column, a minus sign and a power of ten become what programs read,
//! what is not determined is left empty. Curves hold every line in SI units and full precision, however the
//! page thins them. Figures are drawn as the page draws them at first, on white; they need no style sheet of
//! a page.

use csv::Writer;
use maud::Markup;

use crate::error::PageError;
use crate::format::hides;
use crate::page::{self, Page};
use crate::plot::Plot;
use crate::section::Block;
use crate::table::TableText;

/// A page before it is written.
#[derive(Clone)]
pub struct Report {
    page: Page,
}

/// A file beside a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportFile {
    /// Its path from the page, with `/` between parts: `tables/findings.csv`.
    pub path: String,
    /// Its contents.
    pub contents: String,
}

impl Report {
    pub(crate) fn of(page: Page) -> Self {
        Report { page }
    }

    /// The page as one self-contained HTML file.
    ///
    /// # Errors
    /// What was found does not fit its spectral lines.
    pub fn html(&self) -> Result<String, PageError> {
        self.page.to_html()
    }

    /// Every table as CSV, below `tables`.
    pub fn tables(&self) -> Vec<ReportFile> {
        let mut files = Files::new("tables", "csv");
        for (anchor, block) in self.blocks() {
            if let Block::Table(table) = block {
                files.add(&anchor, table_csv(table));
            }
        }
        files.0
    }

    /// The curves of every plot as CSV, below `curves`, a file for each abscissa.
    ///
    /// # Errors
    /// A series that is not as long as its abscissa.
    pub fn curves(&self) -> Result<Vec<ReportFile>, PageError> {
        let mut files = Files::new("curves", "csv");
        for (anchor, plot) in self.plots() {
            for curves in plot.curves()? {
                files.add(&format!("{anchor} {}", plot.title()), csv_of(curves));
            }
        }
        Ok(files.0)
    }

    /// Every plot and drawing as SVG, below `figures`.
    ///
    /// # Errors
    /// A series that is not as long as its abscissa.
    pub fn figures(&self) -> Result<Vec<ReportFile>, PageError> {
        let mut files = Files::new("figures", "svg");
        for (anchor, block) in self.blocks() {
            match block {
                Block::Drawing(drawing, _) => files.add(&anchor, standalone(&drawing.wide)),
                Block::Plots(_, plots) => {
                    for plot in plots {
                        files.add(&format!("{anchor} {}", plot.title()), standalone(&plot.svg()?));
                    }
                }
                Block::Markup(_) | Block::Table(_) => {}
            }
        }
        Ok(files.0)
    }

    /// All things below a heading, with its anchor.
    fn blocks(&self) -> impl Iterator<Item = (String, &Block)> {
        self.page
            .parts()
            .flat_map(|(anchor, section)| section.blocks().iter().map(move |block| (anchor.clone(), block)))
    }

    fn plots(&self) -> impl Iterator<Item = (String, &Plot)> {
        self.blocks().flat_map(|(anchor, block)| {
            let plots = match block {
                Block::Plots(_, plots) => plots.as_slice(),
                _ => &[],
            };
            plots.iter().map(move |plot| (anchor.clone(), plot))
        })
    }
}

/// Files of one folder, no two of one name.
struct Files(Vec<ReportFile>, &'static str, &'static str);

impl Files {
    fn new(folder: &'static str, extension: &'static str) -> Self {
        Files(Vec::new(), folder, extension)
    }

    /// Adds a file; the second of one name gets a number.
    fn add(&mut self, name: &str, contents: String) {
        let name = file_name(name);
        let path = |name: &str| format!("{}/{name}.{}", self.1, self.2);
        let numbered = (2..).map(|count| path(&format!("{name}-{count}")));
        let is_free = |path: &String| self.0.iter().all(|file| file.path != *path);
        let free = std::iter::once(path(&name)).chain(numbered).find(is_free);
        self.0.extend(free.map(|path| ReportFile { path, contents }));
    }
}

/// A title in lower case and hyphens; letters and digits that no file name should have become plain ones.
fn file_name(title: &str) -> String {
    let plain: String = title
        .chars()
        .map(|c| match c {
            '₀'..='₉' => char::from(b'0' + (u32::from(c) - u32::from('₀')) as u8).to_string(),
            '²' => "2".to_owned(),
            'χ' => "chi".to_owned(),
            'δ' => "delta".to_owned(),
            'ω' => "omega".to_owned(),
            'Σ' => "sum".to_owned(),
            c => c.to_string(),
        })
        .collect();
    page::anchor(&plain)
}

/// A drawing as a file of its own: colours as they are by day, no variables of a page, which few programs for
/// drawings know.
fn standalone(svg: &Markup) -> String {
    let text = page::in_plain_colours(&svg.0).replace(hides, "\u{fffd}");
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{text}\n")
}

/// A table as text with commas between cells.
fn table_csv(table: &TableText) -> String {
    let (columns, rows) = table.cells();
    let mut head: Vec<String> = Vec::new();
    let mut lines: Vec<Vec<String>> = vec![Vec::new(); rows.len()];
    for (index, column) in columns.iter().enumerate() {
        let name = if column.unit.is_empty() {
            column.heading.to_owned()
        } else {
            format!("{} [{}]", column.heading, column.unit)
        };
        let split: Vec<(Vec<String>, &str)> =
            rows.iter().map(|row| with_unit(row[index], column.is_number)).collect();
        let has_units = split.iter().any(|(_, unit)| !unit.is_empty());
        let (cells, units): (Vec<Vec<String>>, Vec<&str>) = split.into_iter().unzip();
        let width = cells.iter().map(Vec::len).max().unwrap_or(1).max(1);
        head.push(name.clone());
        head.extend((1..width).map(|part| match part {
            1 => format!("± {name}"),
            part => format!("± ({part}) {name}"),
        }));
        head.extend(has_units.then(|| format!("unit of {name}")));
        for ((line, mut cell), unit) in lines.iter_mut().zip(cells).zip(units) {
            cell.resize(width, String::new());
            line.extend(cell);
            line.extend(has_units.then(|| unit.to_owned()));
        }
    }
    csv_of(std::iter::once(head).chain(lines))
}

/// A cell and the unit in it, where rows have units of their own: `3.32 ± 0.02 MN/m`.
fn with_unit(cell: &str, is_number: bool) -> (Vec<String>, &str) {
    let is_unit = |unit: &str| unit.starts_with(|c: char| c.is_alphabetic() || c == '%' || c == '°');
    match cell.rsplit_once(' ') {
        Some((value, unit)) if is_unit(unit) && (is_number || value.contains(" ± ")) => match numbers(value)
        {
            Some(numbers) => (numbers, unit),
            None => (parts(cell, is_number), ""),
        },
        _ => (parts(cell, is_number), ""),
    }
}

/// A cell as programs read it: a number and what stands behind its ±, or its words.
fn parts(cell: &str, is_number: bool) -> Vec<String> {
    if matches!(cell, "–" | crate::format::NOT_DETERMINED) {
        return vec![String::new()];
    }
    match numbers(cell) {
        Some(numbers) if is_number || numbers.len() == 1 => numbers,
        _ => vec![cell.to_owned()],
    }
}

/// The numbers of `3.320 ± 0.020`, `(3.670 ± 0.037)×10⁻¹⁰`, `−5.1`, `37k`; `None` where it is something else.
fn numbers(cell: &str) -> Option<Vec<String>> {
    let (all, exponent) = match cell.strip_prefix('(').and_then(|rest| rest.split_once(')')) {
        Some((inner, power)) => (inner, power_of_ten(power)?),
        None => (cell, String::new()),
    };
    all.split(" ± ")
        .map(|part| {
            let (mantissa, own) = match part.find('×') {
                Some(at) => (&part[..at], power_of_ten(&part[at..])?),
                None => match part.strip_suffix('k') {
                    Some(thousands) => (thousands, "e3".to_owned()),
                    None => (part, String::new()),
                },
            };
            let exponent = if own.is_empty() { &exponent } else { &own };
            let number = format!("{}{exponent}", mantissa.replace('−', "-"));
            number.parse::<f64>().ok().filter(|number| number.is_finite()).map(|_| number)
        })
        .collect()
}

/// `×10⁻⁷` as `e-7`.
fn power_of_ten(text: &str) -> Option<String> {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let exponent: Option<String> = text
        .strip_prefix("×10")?
        .chars()
        .map(|c| match c {
            '⁻' => Some('-'),
            c => RAISED.iter().position(|raised| *raised == c).map(|digit| char::from(b'0' + digit as u8)),
        })
        .collect();
    exponent.map(|exponent| format!("e{exponent}"))
}

fn csv_of(rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut writer = Writer::from_writer(Vec::new());
    for row in rows {
        // Rows are of equal length and memory takes them all.
        let _ = writer.write_record(&row);
    }
    let bytes = writer.into_inner().unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Axis, Role};
    use crate::section::Section;
    use crate::table::Table;
    use maud::html;

    fn report() -> Report {
        let values = [Some(1e6), None, Some(-3.25e-7)];
        let plot = || {
            Plot::new("K₁₁, fitted", Axis::frequency(), Axis::linear("K₁₁", "N/m"))
                .over([10.0, 20.5, 30.0])
                .line("measured, all", Role::Measured, values)
                .band("95 %", Role::Uncertainty, [0.5, 1.0, 1.5], [2.0, 3.0, f64::NAN])
        };
        let table =
            Table::of([("a, b", "(3.670 ± 0.037)×10⁻¹⁰"), ("c", "−5.1 ± 1.2×10⁻⁷"), ("d", "not determined")])
                .words("joint", |row| row.0)
                .numbers("k₁₁", "MN/m", |row| row.1);
        let section = Section::new("Values").with(table).plots(2, [plot(), plot()]);
        let drawing = html! { svg xmlns="http://www.w3.org/2000/svg" { path style="stroke:var(--measured,#123456)" {} } };
        Report::of(Page::new("page").sections([section.drawing(drawing, "a sketch")]))
    }

    #[test]
    fn a_table_is_written_with_numbers_that_programs_read_and_their_deviations_apart() {
        let files = report().tables();
        assert_eq!(files.len(), 1);
        assert_eq!(files[0].path, "tables/values.csv");
        assert_eq!(
            files[0].contents,
            "joint,k₁₁ [MN/m],± k₁₁ [MN/m]\n\"a, b\",3.670e-10,0.037e-10\nc,-5.1,1.2e-7\nd,,\n"
        );
    }

    #[test]
    fn rows_with_units_of_their_own_have_a_column_for_them() {
        let table = Table::of(["70.00 ± 0.10 mm", "(5.900 ± 0.030)×10⁻⁴ kg·m²", "92.6 %", "above 3 MN/m"])
            .numbers("stated", "", |cell| *cell);
        let report = Report::of(Page::new("page").sections([Section::new("s").with(table)]));
        assert_eq!(
            report.tables()[0].contents,
            "stated,± stated,unit of stated\n70.00,0.10,mm\n5.900e-4,0.030e-4,kg·m²\n92.6,,%\nabove 3 MN/m,,\n"
        );
        assert_eq!(with_unit("1 line", false), (vec!["1 line".to_owned()], ""));
    }

    #[test]
    fn words_that_only_look_like_numbers_stay_words() {
        for (cell, is_number, expected) in [
            ("4/1", false, vec!["4/1"]),
            ("1.2 to 3.4", true, vec!["1.2 to 3.4"]),
            ("1.0 ± 0.2", false, vec!["1.0 ± 0.2"]),
            ("37k", true, vec!["37e3"]),
            ("−0.02", false, vec!["-0.02"]),
            ("", true, vec![""]),
            ("inf", true, vec!["inf"]),
        ] {
            assert_eq!(parts(cell, is_number), expected, "{cell}");
        }
    }

    #[test]
    fn curves_have_every_line_in_si_units_and_a_gap_is_an_empty_cell() {
        let files = report().curves().unwrap();
        let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
        assert_eq!(paths, ["curves/values-k11-fitted.csv", "curves/values-k11-fitted-2.csv"]);
        assert_eq!(
            files[0].contents,
            "Frequency [Hz],\"measured, all [N/m]\",\"95 %, low [N/m]\",\"95 %, high [N/m]\"\n10,1e6,0.5,2\n20.5,,1,3\n30,-3.25e-7,1.5,\n"
        );
    }

    #[test]
    fn figures_stand_by_themselves_in_the_colours_of_the_page_by_day() {
        let files = report().figures().unwrap();
        assert_eq!(files.len(), 3);
        for file in &files {
            assert!(
                file.contents.starts_with("<?xml") && !file.contents.contains("var("),
                "{}",
                file.contents
            );
            assert!(file.contents.contains("#0072b2"), "{}", file.contents);
        }
        assert_eq!(files[2].path, "figures/values.svg");
    }
}
