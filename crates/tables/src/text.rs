//! The tables as text, in Markdown, so that they read in a terminal and on a page alike.

use crate::paper::{
    DAMPING, DAMPING_UNITS, ELEMENTS, Elements, GROUPS, MODELS_USED, RANKS, STIFFNESS, STIFFNESS_UNITS,
    compared,
};
use crate::{ProgramRow, Reach, Tables, Witness};
use std::fmt::Write;

/// A table of equally wide columns.
struct Grid(Vec<Vec<String>>);

impl Grid {
    /// With its header, columns between bars.
    fn new(header: &str) -> Self {
        let mut grid = Grid(Vec::new());
        grid.row(header.split(" | ").map(str::to_owned));
        grid
    }

    fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.0.push(cells.into_iter().collect());
    }

    fn write(&self, text: &mut String) {
        let columns = self.0[0].len();
        let width = |c: usize| self.0.iter().map(|row| row[c].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns).map(width).collect();
        for (index, row) in self.0.iter().enumerate() {
            let cells =
                row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}", width = *width));
            let _ = writeln!(text, "| {} |", cells.collect::<Vec<_>>().join(" | "));
            if index == 0 {
                let rules = widths.iter().map(|width| "-".repeat(*width));
                let _ = writeln!(text, "| {} |", rules.collect::<Vec<_>>().join(" | "));
            }
        }
        text.push('\n');
    }
}

/// Four digits, as a table needs them.
fn digits(value: f64) -> String {
    let size = value.abs();
    let decimals = if size == 0.0 { 1 } else { (2 - size.log10().floor() as i32).clamp(0, 6) as usize };
    format!("{value:.decimals$}")
}

fn printed(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| value.to_string())
}

/// A number with its sign, and none where it rounds to zero.
fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    if text.contains(|c| ('1'..='9').contains(&c)) { text } else { text[1..].to_owned() }
}

/// A computed cell with its deviation from the printed one, or `same` where it rounds to what is printed.
fn beside(found: Option<f64>, paper: Option<f64>) -> String {
    match (found, paper) {
        (Some(found), Some(paper)) => {
            let decimals = paper.to_string().split_once('.').map_or(1, |(_, after)| after.len());
            let rounds = (found - paper).abs() <= 0.5 * 10_f64.powi(-(decimals as i32)) * (1.0 + 1e-9);
            let deviation = 100.0 * (found / paper - 1.0);
            let decimals = usize::from(deviation.abs() < 0.95);
            if rounds {
                format!("{} (same)", digits(found))
            } else {
                format!("{} ({} %)", digits(found), signed(deviation, decimals))
            }
        }
        (Some(found), None) => digits(found),
        (None, _) => "-".to_owned(),
    }
}

/// Table 4's other half: which models' values were compared, and whether these put the examples in the order
/// printed.
fn models_used(text: &mut String) {
    text.push_str(
        "Table 4, model used to compare values, and the span of these values in Tables 2 and 3\n\n",
    );
    let mut grid = Grid::new("element | place | example | models | values | unit | above the one before");
    for (group, elements) in RANKS.iter().enumerate() {
        for (element, order) in elements.iter().enumerate() {
            let mut before: Option<[f64; 2]> = None;
            for (place, example) in order.iter().enumerate() {
                let models = MODELS_USED[group][element][place].iter().map(|model| model.name());
                let span = compared(group, element, place);
                let above = before.zip(span).map(|([low, high], [own_low, own_high])| {
                    match (own_low >= high, own_high >= high && own_low >= low, own_high < low) {
                        (true, ..) => "yes",
                        (_, true, _) => "overlaps",
                        (.., true) => "no",
                        _ => "not by all",
                    }
                });
                grid.row([
                    format!("K{}", ELEMENTS[element]),
                    (place + 1).to_string(),
                    (*example).to_owned(),
                    models.collect::<Vec<_>>().join(", "),
                    span.map_or("-".to_owned(), |[low, high]| {
                        if low == high { low.to_string() } else { format!("{low} to {high}") }
                    }),
                    STIFFNESS_UNITS[element].0.to_owned(),
                    above.unwrap_or("-").to_owned(),
                ]);
                before = span.or(before);
            }
        }
    }
    grid.write(text);
    text.push_str(
        "yes: every value of the models used is at least as large as all of the example before; overlaps: smallest and largest are, but the spans overlap; not by all: one of both is not; no: every value is smaller.\n\n",
    );
}

impl Tables {
    /// All tables, paper beside program, with what they show.
    pub fn to_text(&self) -> String {
        let mut text = String::from(
            "Tables of \"Estimation of Dynamic Stiffness Matrix of Welded or Glued Joints Using a Laboratory Fixture\", paper beside program\n\n\
             The paper prints no dimensions. The fixtures here were inferred from its SIM cells: where program and paper agree there, it is a fit and\n\
             no prediction; `same` means that the program's number rounds to the printed one. Of the cells of finite elements only ratios of K11 were used, for welded examples; the strip's width, which the SIM cells do not fix, is an assumption.\n\n",
        );
        self.inferences(&mut text);
        self.models(&mut text);
        self.stiffness(&mut text);
        self.round_trip(&mut text);
        self.reach(&mut text);
        self.ranks(&mut text);
        self.damping(&mut text);
        text
    }

    fn inferences(&self, text: &mut String) {
        let mut grid = Grid::new("fixture (inferred) | band Hz | numbers inferred | from cells");
        let mut which = String::new();
        for row in self.rows.iter().filter(|row| row.example.own_stiffness()) {
            let (band, inference) = (row.example.band, row.example.inference);
            grid.row([
                row.example.name.to_owned(),
                format!("{}-{}", band.from, band.to),
                inference.numbers.to_string(),
                inference.cells.to_string(),
            ]);
            let _ = writeln!(which, "{}: {}.  ", row.example.name, inference.says);
        }
        grid.write(text);
        text.push_str(&which);
        text.push_str(
            "E1, E5, F1, F2: two damping ratios from C_IN(1,1) and C_IN(2,2) on the fixture of E0, F01, F02; the other cells of C_IN and all of SIM C are predictions.\n",
        );
        text.push_str("\nNot inferred: steel (207 GPa, 0.3, 7850 kg/m^3); points 1 and 4 at 0.8 of their blocks' length, which enters no cell.\n\n");
    }

    fn models(&self, text: &mut String) {
        text.push_str("Table 1: where each model's matrices come from\n\n");
        let mut grid = Grid::new("model | alpha, beta | H41 | joint in | joint out | program");
        for row in [
            "SIM | SIM | SIM | K, C | K, C | synthesize, then decompose --relation paper",
            "EXP | SIM | EXP | - | K, C | decompose --relation paper of your recording; --measured E2=DIR here",
            "FEM | SIM | FEM | C | K, C | fem, then decompose --relation paper",
        ] {
            grid.row(row.split(" | ").map(str::to_owned));
        }
        grid.write(text);
        text.push_str("Solids of the columns FEM program, with the example's damping ratios\n\n");
        let mut grid = Grid::new("example | solid");
        for row in &self.rows {
            grid.row([row.example.name.to_owned(), row.example.solid()]);
        }
        grid.write(text);
        text.push_str(
            "One number was inferred for a welded or glued solid, its layer's modulus, so that K11 by eq (7) is to its integral neighbour's as the cells are. All other cells are predictions, K11 itself but for that ratio.\n\
             The layer stands for weld or glue, gap and fillet together: above steel's 207 GPa it is a seam that is thicker than the strip.\n\n",
        );
    }

    fn stiffness(&self, text: &mut String) {
        for (element, table) in [(0, 2), (3, 2), (1, 3), (2, 3)] {
            let (unit, size) = STIFFNESS_UNITS[element];
            let _ = writeln!(text, "Table {table}: |K{}| by eq (7), averaged, {unit}\n", ELEMENTS[element]);
            let mut grid = Grid::new(
                "example | type | SIM paper | SIM program | FEM paper | FEM program, 2 modes | \
                 FEM program, all modes | EXP paper | EXP yours",
            );
            for row in &STIFFNESS {
                let cell = |cells: &Option<Elements>| cells.map(|cells| cells[element]);
                let (own, solid) = (self.own(row.example), self.row(row.example));
                let of = |m: &crate::Extracted| ProgramRow::magnitudes(&m.paper.stiffness)[element] / size;
                let yours = self.measured(row.example).map(|m| m.stiffness[element] / size);
                // The paper has no finite elements of glued examples.
                let printed_beside = |found: Option<f64>| match (found, cell(&row.fem)) {
                    (Some(_), None) => format!("{} to EXP", beside(found, cell(&row.exp))),
                    (found, printed) => beside(found, printed),
                };
                grid.row([
                    row.example.to_owned(),
                    row.joint.name().to_owned(),
                    printed(cell(&row.sim)),
                    beside(own.map(|r| of(&r.sim)), cell(&row.sim)),
                    printed(cell(&row.fem)),
                    printed_beside(solid.and_then(|r| r.fem_two.as_ref().map(of))),
                    printed_beside(solid.and_then(|r| r.fem_all.as_ref().map(of))),
                    printed(cell(&row.exp)),
                    beside(yours, cell(&row.exp)),
                ]);
            }
            grid.write(text);
        }
        text.push_str("Why FEM is not met: K11 K22 / (K12 K21) of its cells, in magnitudes, which no stiffness of strip or layer brings above one\n\n");
        let mut grid = Grid::new("example | FEM paper | FEM program, 2 modes");
        for row in STIFFNESS.iter().filter(|row| row.fem.is_some()) {
            let ratio = |[k11, k12, k21, k22]: Elements| digits(1e3 * k11 * k22 / (k12 * k21));
            let found = self.row(row.example).and_then(|r| r.fem_two.as_ref());
            let si = found.map(|m| ProgramRow::magnitudes(&m.paper.stiffness));
            let printed = |[k11, k12, k21, k22]: Elements| [k11 / 1e6, k12 / 1e3, k21 / 1e3, k22 / 1e3];
            grid.row([
                row.example.to_owned(),
                row.fem.map_or("-".to_owned(), ratio),
                si.map_or("-".to_owned(), |si| ratio(printed(si))),
            ]);
        }
        grid.write(text);
        text.push_str(
            "Between two equal blocks the ratio stays below one away from the poles of eq (7), for solids as for SIM: where K11, K12 and K21 are met, K22 cannot be. Equal blocks also give K12 = K21; the paper's cells\n\
             differ, E0's by a factor of 1.9. F1's K12/K11 of 60 mm, measured, is that of a joint 120 mm long if both ends are alike; its strip has 25. What was tried besides (strips, bands, modes, places of the rotations, masses) is in docs/records/2026-11-21-solid.md.\n\n",
        );
    }

    fn round_trip(&self, text: &mut String) {
        text.push_str(
            "What eq (7) does to its own round trip, and what the exact relation gives (averages over the band)\n\n",
        );
        let mut grid = Grid::new(
            "example | element | put in | SIM eq (7) | SIM exact | FEM exact, all modes | \
                 unit",
        );
        for row in self.rows.iter().filter(|row| row.example.own_stiffness()) {
            for (element, (i, j)) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().enumerate() {
                let (unit, size) = STIFFNESS_UNITS[element];
                let stated = row.stiffness.at(i, j);
                let against = |found: f64| {
                    format!(
                        "{} ({} %)",
                        digits(found / size),
                        signed(100.0 * ((found / stated).abs() - 1.0), 2)
                    )
                };
                grid.row([
                    row.example.name.to_owned(),
                    format!("K{}", ELEMENTS[element]),
                    digits(stated / size),
                    against(row.sim.paper.stiffness.at(i, j)),
                    against(row.sim.exact.stiffness.at(i, j)),
                    row.fem_all.as_ref().map_or("-".to_owned(), |fem| against(fem.exact.stiffness.at(i, j))),
                    unit.to_owned(),
                ]);
            }
        }
        grid.write(text);
        text.push_str(
            "Put in is k on d = u3 - R u2; deviations are of magnitudes. Eq (7) leaves R out: it tends to k R, which is not symmetric, and only far above its two poles. In the finite-element\n\
             column the strip shears, has mass and yields where it meets its blocks: the deviation is what the lumped strip leaves out.\n\n",
        );
    }

    fn reach(&self, text: &mut String) {
        text.push_str(
            "Where eq (7) can give a SIM row, two blocks and a massless strip in a band that holds no pole of eq (7): K11 K22 / (K12 K21), in magnitudes, is 2/3 to 1 above the upper pole,\n\
             below 1 below the lower one and above 1 between them (two equal blocks)\n\n",
        );
        let mut grid = Grid::new("example | as printed | within rounding | program | can be met");
        let mut witnesses = String::new();
        for row in &STIFFNESS {
            let Some(reach) = Reach::of_sim(row) else { continue };
            let program = self.own(row.example).map(|r| {
                let [k11, k12, k21, k22] = ProgramRow::magnitudes(&r.sim.paper.stiffness);
                digits(k11 * k22 / (k12 * k21))
            });
            grid.row([
                row.example.to_owned(),
                digits(reach.ratio),
                format!("{} to {}", digits(reach.rounding.0), digits(reach.rounding.1)),
                program.unwrap_or("-".to_owned()),
                reach.says(),
            ]);
            if let Some(witness) = row.sim.as_ref().and_then(Witness::between_the_poles) {
                let _ = writeln!(
                    witnesses,
                    "{}, as printed, between the poles: {}.  ",
                    row.example,
                    witness.says()
                );
            }
        }
        grid.write(text);
        text.push_str(&witnesses);
        text.push_str(
            "Between the poles the signs turn round; the paper prints magnitudes. D0's K12 and K21 differ by more than rounding, so its blocks are not equal. Whether D0 and F02 are met by plausible dimensions is open.\n\n",
        );
    }

    fn ranks(&self, text: &mut String) {
        text.push_str("Table 4: from the most compliant to the stiffest\n\n");
        let mut grid =
            Grid::new("element | Table 4 | EXP cells of Tables 2-3 | FEM cells | FEM program | program");
        let paper = |name: &str| STIFFNESS.iter().find(|row| row.example == name);
        for group in 0..GROUPS.len() {
            for (element, order) in RANKS[group].iter().enumerate() {
                let measured = Tables::rank(group, element, |name| paper(name)?.exp);
                let computed = Tables::rank(group, element, |name| paper(name)?.fem);
                let solids = Tables::rank(group, element, |name| {
                    Some(ProgramRow::magnitudes(&self.row(name)?.fem_two.as_ref()?.paper.stiffness))
                });
                let program = Tables::rank(group, element, |name| {
                    self.measured(name)
                        .map(|m| m.stiffness)
                        .or_else(|| Some(ProgramRow::magnitudes(&self.own(name)?.sim.paper.stiffness)))
                });
                grid.row([
                    format!("K{}", ELEMENTS[element]),
                    order.join(" "),
                    against(&measured, order),
                    against(&computed, order),
                    against(&solids, order),
                    against(&program, order),
                ]);
            }
        }
        grid.write(text);
        text.push_str("E0 was not measured. FEM program: with two modes. Program: your measurements where given, SIM elsewhere; what was not computed is left out of the comparison.\n\n");
        models_used(text);
    }

    fn damping(&self, text: &mut String) {
        for (element, table) in [(0, 5), (3, 5), (1, 6), (2, 6)] {
            let (unit, _) = DAMPING_UNITS[element];
            let _ = writeln!(text, "Table {table}: |C{}| by eq (7), averaged, {unit}\n", ELEMENTS[element]);
            let mut grid = Grid::new(
                "example | C_IN paper | C_IN program | SIM paper | SIM program | SIM exact | \
                 FEM paper | FEM program, 2 modes | FEM program, all modes",
            );
            for row in &DAMPING {
                let program = self.row(row.example);
                let of = |m: &crate::Extracted| ProgramRow::magnitudes(&m.paper.damping)[element];
                let exact = program.map(|r| ProgramRow::magnitudes(&r.sim.exact.damping)[element]);
                let fem = row.fem.map(|cells| cells[element]);
                grid.row([
                    row.example.to_owned(),
                    printed(Some(row.input[element])),
                    beside(program.map(|r| r.input[element]), Some(row.input[element])),
                    printed(Some(row.sim[element])),
                    beside(program.map(|r| of(&r.sim)), Some(row.sim[element])),
                    exact.map_or("-".to_owned(), digits),
                    printed(fem),
                    beside(program.and_then(|r| r.fem_two.as_ref().map(of)), fem),
                    beside(program.and_then(|r| r.fem_all.as_ref().map(of)), fem),
                ]);
            }
            grid.write(text);
        }
        text.push_str(
            "Table 6 prints kN/rad and kNm/m, which are units of stiffness. C_IN is the block of interface 2 in (40). There is damping of SIM for welded examples because\n\
             the paper puts their measured damping ratios on the integral neighbour's stiffness. FEM is of the solids above; the paper has none of F1 and F2.\n",
        );
    }
}

/// An order, and whether it is the one printed, among those it has.
fn against(order: &[&str], printed: &[&str]) -> String {
    if order.len() < 2 {
        return "-".to_owned();
    }
    let expected: Vec<&str> = printed.iter().copied().filter(|name| order.contains(name)).collect();
    let mark = if expected == order { "same" } else { "differs" };
    format!("{} ({mark})", order.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_rounds_to_zero_has_no_sign_and_small_deviations_a_decimal() {
        assert_eq!([signed(-0.001, 2), signed(0.004, 2), signed(-0.006, 2)], ["0.00", "0.00", "-0.01"]);
        assert_eq!(beside(Some(308.0), Some(308.6)), "308 (-0.2 %)");
        assert_eq!(beside(Some(3.03), Some(3.6)), "3.03 (-16 %)");
        assert_eq!(beside(Some(3.32), Some(3.3)), "3.32 (same)");
    }
}
