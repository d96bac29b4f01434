//! A table: one value a row, with its standard deviation and unit.

use crate::body::Body;
use crate::joint::{both_ends, is_zero};
use crate::numbers::exact;
use crate::parts::Element;
use crate::{Export, Joint};

const COVARIED: [&str; 6] = ["k11", "k12", "k22", "c11", "c12", "c22"];
const TWO: [&str; 2] = ["y", "theta"];
const FOUR: [&str; 4] = ["y from", "theta from", "y to", "theta to"];

pub(crate) fn body(export: &Export) -> Body {
    let mut table = Table(String::from("object,name,quantity,frequency,row,column,value,std,unit\n"));
    for node in &export.nodes {
        table.row(["node", &node.number.to_string(), "x", "", "", "", &exact(node.x), "", "m"]);
        table.row(["node", &node.number.to_string(), "y", "", "", "", &exact(node.y), "", "m"]);
    }
    export.joints.iter().for_each(|joint| table.joint(joint));
    for (index, part) in export.parts.iter().enumerate() {
        let name = (index + 1).to_string();
        let mut row = |node: u64, what: &str, value: f64, unit: &str| {
            table.row(["part", &name, what, "", &node.to_string(), "", &exact(value), "", unit]);
        };
        match part.element {
            Element::Mass { node, mass } => row(node, "mass", mass, "kg"),
            Element::Ground { node, dof, stiffness, damping } => {
                let [k, c] = match dof {
                    jointscope_fixture::Dof::Translation => ["N/m", "N*s/m"],
                    jointscope_fixture::Dof::Rotation => ["N*m/rad", "N*m*s/rad"],
                };
                row(node, &format!("stiffness to ground, {}", dof.name()), stiffness, k);
                row(node, &format!("damping to ground, {}", dof.name()), damping, c);
            }
            Element::Spring { from, to, stiffness, damping } => {
                row(from, &format!("stiffness to node {to}"), stiffness, "N/m");
                row(from, &format!("damping to node {to}"), damping, "N*s/m");
            }
        }
    }
    Body { text: table.0, notes: Vec::new() }
}

struct Table(String);

impl Table {
    fn row(&mut self, cells: [&str; 9]) {
        let quoted = cells.map(|cell| match cell.contains([',', '"', '\n', '\r']) {
            true => format!("\"{}\"", cell.replace('"', "\"\"")),
            false => cell.to_owned(),
        });
        self.0 += &quoted.join(",");
        self.0.push('\n');
    }

    fn joint(&mut self, joint: &Joint) {
        let name = &joint.name;
        self.row(["joint", name, "length", "", "", "", &exact(joint.length), "", "m"]);
        let (stiffness_std, damping_std) = joint.std.unzip();
        let lines = joint.lines.iter().map(|line| (exact(line.frequency), &line.stiffness, &line.damping));
        let constant = [(String::new(), &joint.stiffness, &joint.damping)];
        for (frequency, k, c) in constant.into_iter().chain(lines) {
            let of = |std: Option<[[f64; 2]; 2]>| std.filter(|_| frequency.is_empty());
            self.matrix(name, "stiffness", &frequency, &TWO, k, of(stiffness_std), "");
            self.matrix(name, "damping", &frequency, &TWO, c, of(damping_std), "*s");
        }
        if !is_zero(&joint.structural) {
            self.matrix(name, "structural damping", "", &TWO, &joint.structural, None, "");
        }
        for (what, matrix, times) in
            [("stiffness, both ends", &joint.stiffness, ""), ("damping, both ends", &joint.damping, "*s")]
        {
            self.matrix(name, what, "", &FOUR, &both_ends(matrix, joint.length), None, times);
        }
        if let Some(mass) = &joint.mass {
            for (i, row) in mass.iter().enumerate() {
                for (j, value) in row.iter().enumerate() {
                    let unit = ["kg", "kg*m", "kg*m^2"][i % 2 + j % 2];
                    self.row([
                        "joint",
                        name,
                        "mass, both ends",
                        "",
                        FOUR[i],
                        FOUR[j],
                        &exact(*value),
                        "",
                        unit,
                    ]);
                }
            }
        }
        if let Some(centre) = joint.centre().filter(|_| !joint.scalar) {
            let std = joint.centre_std().map(exact).unwrap_or_default();
            let offset = exact(centre.offset);
            self.row(["joint", name, "elastic centre from the far end", "", "", "", &offset, &std, "m"]);
        }
        if let Some(covariance) = &joint.covariance {
            for (i, row) in covariance.iter().enumerate() {
                for (j, value) in row.iter().enumerate() {
                    self.row([
                        "joint",
                        name,
                        "covariance",
                        "",
                        COVARIED[i],
                        COVARIED[j],
                        &exact(*value),
                        "",
                        "SI",
                    ]);
                }
            }
        }
    }

    #[allow(clippy::too_many_arguments)] // one call a matrix, each argument a column
    fn matrix<const N: usize>(
        &mut self,
        name: &str,
        what: &str,
        frequency: &str,
        order: &[&str; N],
        matrix: &[[f64; N]; N],
        std: Option<[[f64; N]; N]>,
        times: &str,
    ) {
        for i in 0..N {
            for j in 0..N {
                let std = std.map(|std| exact(std[i][j])).unwrap_or_default();
                let unit = [["N/m", "N/rad"], ["N*m/m", "N*m/rad"]][i % 2][j % 2].replacen(
                    'N',
                    &format!("N{times}"),
                    1,
                );
                self.row([
                    "joint",
                    name,
                    what,
                    frequency,
                    order[i],
                    order[j],
                    &exact(matrix[i][j]),
                    &std,
                    &unit,
                ]);
            }
        }
    }
}
