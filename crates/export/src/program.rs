//! The programs that files are written for, and the forms of a joint that they have.

use std::fmt;

/// What reads the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Program {
    /// MSC, NX, Autodesk Nastran, OptiStruct: bulk data.
    Nastran,
    /// ANSYS Mechanical APDL.
    Ansys,
    /// Abaqus/Standard.
    Abaqus,
    /// CalculiX.
    Calculix,
    /// A table.
    Csv,
    /// JSON.
    Json,
}

impl Program {
    /// The name on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Program::Nastran => "nastran",
            Program::Ansys => "ansys",
            Program::Abaqus => "abaqus",
            Program::Calculix => "calculix",
            Program::Csv => "csv",
            Program::Json => "json",
        }
    }

    /// What its files end in.
    pub fn extension(self) -> &'static str {
        match self {
            Program::Nastran => "bdf",
            Program::Ansys => "mac",
            Program::Abaqus | Program::Calculix => "inp",
            Program::Csv => "csv",
            Program::Json => "json",
        }
    }
}

impl fmt::Display for Program {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How a joint is written, where a program has two ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Nastran: CBUSH and PBUSH about the elastic centre.
    Bush,
    /// Nastran: DMIG on both nodes.
    Dmig,
    /// Abaqus: a linear user element.
    Element,
    /// Abaqus: a matrix of the model.
    Matrix,
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Form::Bush => "bush",
            Form::Dmig => "dmig",
            Form::Element => "element",
            Form::Matrix => "matrix",
        })
    }
}
