//! All rows of the paper's Tables 1 to 6, the paper's cells beside the program's.

use crate::paper::{DAMPING, ELEMENTS, Elements, GROUPS, STIFFNESS, STIFFNESS_UNITS};
use crate::{Extracted, Measured, ProgramRow, Reach, Side, TablesError, examples};
use jointscope_fem::MeshOptions;
use jointscope_linalg::RealMatrix2;
use serde_json::{Map, Value, json};

/// The paper's tables with the program's cells.
#[derive(Debug, Clone)]
pub struct Tables {
    /// Rows of which a fixture could be inferred.
    pub rows: Vec<ProgramRow>,
    /// The user's own decompositions.
    pub measured: Vec<Measured>,
}

impl Tables {
    /// Computes every cell that has a fixture, one example after the other; `progress` is told which is next.
    /// Without `mesh` the finite-element cells are left out.
    ///
    /// # Errors
    /// See [`TablesError`].
    pub fn of(
        mesh: Option<&MeshOptions>,
        measured: Vec<Measured>,
        mut progress: impl FnMut(&str, usize, usize),
    ) -> Result<Self, TablesError> {
        let examples = examples()?;
        let count = examples.len();
        let mut rows = Vec::with_capacity(count);
        for (index, example) in examples.into_iter().enumerate() {
            progress(example.name, index, count);
            rows.push(ProgramRow::of(example, mesh)?);
        }
        Ok(Tables { rows, measured })
    }

    /// The program's row of an example.
    pub fn row(&self, example: &str) -> Option<&ProgramRow> {
        self.rows.iter().find(|row| row.example.name == example)
    }

    pub(crate) fn own(&self, example: &str) -> Option<&ProgramRow> {
        self.row(example).filter(|row| row.example.own_stiffness())
    }

    pub(crate) fn measured(&self, example: &str) -> Option<&Measured> {
        self.measured.iter().find(|measured| measured.example == example)
    }

    /// Examples of a group of Table 4 in the order of an element, by a choice of cells; those without one are
    /// left out.
    pub fn rank(group: usize, element: usize, cell: impl Fn(&str) -> Option<Elements>) -> Vec<&'static str> {
        let mut known: Vec<(&'static str, f64)> =
            GROUPS[group].iter().filter_map(|name| Some((*name, cell(name)?[element]))).collect();
        known.sort_by(|a, b| a.1.total_cmp(&b.1));
        known.into_iter().map(|(name, _)| name).collect()
    }

    /// Everything as JSON, SI units and signs included.
    pub fn to_value(&self) -> Value {
        let matrix = |m: &RealMatrix2| json!(m.0);
        let extracted = |e: &Extracted| {
            json!({
                "eq7": { "stiffness": matrix(&e.paper.stiffness), "damping": matrix(&e.paper.damping) },
                "exact": { "stiffness": matrix(&e.exact.stiffness), "damping": matrix(&e.exact.damping) },
            })
        };
        let mut root = Map::new();
        for row in &STIFFNESS {
            let printed = |cells: &Option<Elements>| {
                cells.map(|c| json!([0, 1, 2, 3].map(|e| c[e] * STIFFNESS_UNITS[e].1)))
            };
            let mut entry = json!({
                "joint": row.joint.name(),
                "paper": { "stiffness": { "elements": ELEMENTS, "sim": printed(&row.sim), "exp": printed(&row.exp), "fem": printed(&row.fem) } },
            });
            if let Some(damping) = DAMPING.iter().find(|d| d.example == row.example) {
                entry["paper"]["damping"] = json!({ "elements": ELEMENTS, "in": damping.input, "sim": damping.sim, "fem": damping.fem });
            }
            if let Some(reach) = Reach::of_sim(row) {
                entry["paper"]["k11_k22_over_k12_k21"] = json!({
                    "value": reach.ratio,
                    "rounding": [reach.rounding.0, reach.rounding.1],
                    "met": reach.sides().into_iter().map(Side::name).collect::<Vec<_>>(),
                });
            }
            if let Some(program) = self.row(row.example) {
                let inference = program.example.inference;
                entry["program"] = json!({
                    "band": [program.example.band.from, program.example.band.to],
                    "inferred": { "numbers": inference.numbers, "from_cells": inference.cells, "says": inference.says },
                    "own_stiffness": program.example.own_stiffness(),
                    "solid": program.example.solid(),
                    "stated_stiffness": matrix(&program.stiffness),
                    "damping_in": program.input,
                    "sim": extracted(&program.sim),
                    "fem_two_modes": program.fem_two.as_ref().map(extracted),
                    "fem_all_modes": program.fem_all.as_ref().map(extracted),
                });
            }
            if let Some(measured) = self.measured(row.example) {
                entry["measured"] = json!({ "relation": measured.relation, "stiffness": measured.stiffness, "damping": measured.damping });
            }
            root.insert(row.example.to_owned(), entry);
        }
        Value::Object(root)
    }
}
