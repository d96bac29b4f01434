//! The commands of the program, each with its arguments in a file of its own.

mod again;
mod check;
mod compare;
mod completions;
mod decompose;
mod diagnose;
mod estimate;
mod export;
mod fem;
mod init;
mod man;
mod many;
mod modes;
mod plan;
mod prove;
mod schema;
mod show;
mod simulate;
mod summary;
mod synthesize;
mod tables;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::refusal::Refusal;
use crate::said::Said;

/// What a model of an assembly leaves out, and how stiff and damped its joints are, from hammer tests.
#[derive(Debug, Parser)]
#[command(name = "jointscope", version, max_term_width = 110, after_help = STATUS)]
pub(crate) struct Program {
    #[command(subcommand)]
    command: Command,
}

/// What scripts have to know.
const STATUS: &str = "Answers go to standard output, notices and progress to standard error.
Exit status: 0 done; 1 done in part (of many cases some have no answer, or standard output took no more); 2 bad usage or bad input: one sentence on standard error, nothing written.";

#[derive(Debug, Subcommand)]
enum Command {
    /// A fixture file from dimensions and materials: two blocks and a strip, a frame, or a beam.
    Init(init::InitArguments),
    /// The JSON Schema of fixture files, with which editors complete and check them.
    Schema(schema::SchemaArguments),
    /// What a fixture weighs, its modes, what every number of it means, and what is odd in each channel of
    /// its recordings: check.json and report.html.
    Check(check::CheckArguments),
    /// FRFs of an assembly, computed from its fixture file, its effects included.
    Synthesize(synthesize::SynthesizeArguments),
    /// FRFs with coherence from hammer hits: time histories of force and responses.
    Estimate(estimate::EstimateArguments),
    /// Stiffness and damping of a joint by frequency, from the FRFs of the assembly: stiffness.json and
    /// report.html.
    Decompose(decompose::DecomposeArguments),
    /// What physics the fixture leaves out, where it sits and how sure that is: diagnosis.json,
    /// refitted.json, repaired.json, report.html.
    Diagnose(diagnose::DiagnoseArguments),
    /// Several decompositions side by side, and which joint is the stiffer: comparison.json and report.html.
    Compare(compare::CompareArguments),
    /// The joint of a decomposition, or what a diagnosis found, as elements for Nastran, ANSYS, Abaqus or
    /// CalculiX, or as plain matrices.
    Export(export::ExportArguments),
    /// FRFs of the fixture's finite-element twin, the assembly as a deformable solid.
    Fem(fem::FemArguments),
    /// Natural frequencies, damping ratios and mode shapes from FRFs, with their standard deviations:
    /// modes.json and report.html.
    Modes(modes::ModesArguments),
    /// What recordings hold: functions and their units, geometry, modes.
    Show(show::ShowArguments),
    /// Accelerations of an assembly over time under recorded forces, effects that depend on amplitude
    /// included.
    Simulate(simulate::SimulateArguments),
    /// What to measure next: candidate measurements ranked by how well they tell look-alike names apart, or
    /// by what they tell of a joint: plan.json and plan.html.
    Plan(plan::PlanArguments),
    /// How often the diagnosis is right: concealed cases of a simulated laboratory, and a table of scores.
    Prove(prove::ProveArguments),
    /// The paper's Tables 1–6, its values beside the program's.
    Tables(tables::TablesArguments),
    /// What came of many cases that were diagnosed or decomposed: summary.csv and summary.html.
    Summary(summary::SummaryArguments),
    /// A script with which a shell completes commands and options.
    Completions(completions::CompletionsArguments),
    /// Manual pages, of the program or of every command.
    Man(man::ManArguments),
}

impl Program {
    /// The arguments that were typed.
    pub(crate) fn read() -> Result<Self, clap::Error> {
        Program::from_arg_matches(&Program::arguments().try_get_matches()?)
    }

    /// What can be typed. Where a folder or a list of cases stands for the fixture, there are no recordings.
    pub(crate) fn arguments() -> clap::Command {
        let of_cases = |command: clap::Command| command.mut_arg("files", |files| files.required(false));
        Program::command().mut_subcommand("diagnose", of_cases).mut_subcommand("decompose", of_cases)
    }

    /// The arguments of a command line that diagnoses; `None` of any other.
    pub(crate) fn diagnose_arguments(words: &[String]) -> Option<diagnose::DiagnoseArguments> {
        let typed = Program::arguments().try_get_matches_from(words).ok()?;
        match Program::from_arg_matches(&typed).ok()?.command {
            Command::Diagnose(arguments) => Some(arguments),
            _ => None,
        }
    }

    /// Runs the command; what it has done is told on standard output.
    pub(crate) fn run(&self) -> Result<Said, Refusal> {
        let said = match &self.command {
            Command::Init(arguments) => init::run(arguments),
            Command::Schema(arguments) => schema::run(arguments),
            Command::Check(arguments) => check::run(arguments),
            Command::Synthesize(arguments) => synthesize::run(arguments),
            Command::Estimate(arguments) => estimate::run(arguments),
            Command::Decompose(arguments) => return decompose::run(arguments),
            Command::Diagnose(arguments) => return diagnose::run(arguments),
            Command::Summary(arguments) => return summary::run(arguments),
            Command::Compare(arguments) => compare::run(arguments),
            Command::Export(arguments) => export::run(arguments),
            Command::Fem(arguments) => fem::run(arguments),
            Command::Modes(arguments) => modes::run(arguments),
            Command::Show(arguments) => show::run(arguments),
            Command::Simulate(arguments) => simulate::run(arguments),
            Command::Plan(arguments) => plan::run(arguments, Program::diagnose_arguments),
            Command::Prove(arguments) => prove::run(arguments),
            Command::Tables(arguments) => tables::run(arguments),
            Command::Completions(arguments) => completions::run(arguments, Program::arguments()),
            Command::Man(arguments) => man::run(arguments, Program::arguments()),
        };
        said.map(Said::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Program::arguments().debug_assert();
    }
}
