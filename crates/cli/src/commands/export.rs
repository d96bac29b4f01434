//! `jointscope export`: a decomposition or a diagnosis in, what was found as elements of a finite-element
//! program out.

use std::path::{Path, PathBuf};

use clap::Args;
use jointscope::comparison::Decomposed;
use jointscope::export::{self, Export, ExportOptions, Form, Program};
use jointscope::report::PageContext;

use crate::input::{self, FixtureFile};
use crate::origin;
use crate::output::{Outputs, counted};
use crate::refusal::Refusal;
use crate::values::one_of;

/// Options of `jointscope export`.
#[derive(Debug, Args)]
pub(super) struct ExportArguments {
    /// The directory that `decompose` or `diagnose` wrote to; or its stiffness.json or diagnosis.json, where
    /// it holds both.
    #[arg(value_name = "DIR")]
    pub answer: PathBuf,
    /// The program that is to read it.
    #[arg(long = "to", value_name = "PROGRAM", value_parser = one_of(&PROGRAMS))]
    pub program: Program,
    /// The file to write, or a directory for a file `joint` with the program's usual ending.
    #[arg(short, long, value_name = "DIR|FILE")]
    pub output: PathBuf,
    /// Only this joint of several.
    #[arg(long, value_name = "J")]
    pub joint: Option<String>,
    /// Nodes of your model at the joint's near and far end, others are numbered from --first-id; without it
    /// all are defined in the file and numbered like the fixture's points.
    #[arg(long, value_name = "FROM,TO", value_parser = nodes)]
    pub nodes: Option<[u64; 2]>,
    /// First number of elements, properties and of nodes that no point has.
    #[arg(long, value_name = "N", default_value_t = 900_001, value_parser = clap::value_parser!(u64).range(1..=99_000_000))]
    pub first_id: u64,
    /// How a joint is written: `bush` or `dmig` (nastran), `element` or `matrix` (abaqus) [default: bush
    /// where it holds the joint, element].
    #[arg(long, value_parser = one_of(&FORMS))]
    pub form: Option<Form>,
    /// K and C by frequency too: PBUSHT and tables (nastran), rows (csv, json).
    #[arg(long)]
    pub by_line: bool,
    /// Export what is judged unusable or unexplained all the same.
    #[arg(long)]
    pub anyway: bool,
}

const PROGRAMS: [(&str, Program); 6] = [
    ("nastran", Program::Nastran),
    ("ansys", Program::Ansys),
    ("abaqus", Program::Abaqus),
    ("calculix", Program::Calculix),
    ("csv", Program::Csv),
    ("json", Program::Json),
];

const FORMS: [(&str, Form); 4] =
    [("bush", Form::Bush), ("dmig", Form::Dmig), ("element", Form::Element), ("matrix", Form::Matrix)];

/// Writes the file; answers with what is in it and what is not.
pub(super) fn run(arguments: &ExportArguments) -> Result<String, Refusal> {
    let answer = Answer::find(&arguments.answer)?;
    let files = answer.files();
    let path = file(&arguments.output, arguments.program);
    let mut outputs = Outputs::new(&files);
    let options = ExportOptions {
        joint: arguments.joint.clone(),
        nodes: arguments.nodes,
        first_id: arguments.first_id,
        by_line: arguments.by_line,
        anyway: arguments.anyway,
    };
    let export = answer.export(&options)?;
    let context = origin::context(&files, Vec::new(), None)?;
    let text = export::write(&export, arguments.program, arguments.form, &made(&context))
        .map_err(|error| Refusal::at(&files[0], error))?;
    match arguments.program {
        Program::Json => {
            let mut value = export::json(&export);
            let notes = value["notes"].take();
            origin::add(&mut value, &context);
            value["notes"] = notes;
            outputs.add_json(&path, &value);
        }
        _ => outputs.add(&path, text),
    }
    outputs.write()?;
    Ok(summary(&export, &path))
}

/// Where what was found stands.
enum Answer {
    Decomposition(PathBuf),
    Diagnosis { diagnosis: PathBuf, repaired: PathBuf },
}

impl Answer {
    fn find(path: &Path) -> Result<Self, Refusal> {
        if !path.exists() {
            return Err(Refusal::at(path, "there is no such directory; check the path"));
        }
        let of_diagnosis = |diagnosis: PathBuf| {
            let repaired = diagnosis.with_file_name("repaired.json");
            Answer::Diagnosis { diagnosis, repaired }
        };
        if !path.is_dir() {
            let is = |name: &str| path.file_name().is_some_and(|own| own == name);
            return match (is("stiffness.json"), is("diagnosis.json")) {
                (true, _) => Ok(Answer::Decomposition(path.to_owned())),
                (_, true) => Ok(of_diagnosis(path.to_owned())),
                _ => Err(Refusal::at(
                    path,
                    "is neither a stiffness.json nor a diagnosis.json; give the directory that `jointscope decompose` or `jointscope diagnose` wrote to",
                )),
            };
        }
        let (stiffness, diagnosis) = (path.join("stiffness.json"), path.join("diagnosis.json"));
        match (stiffness.exists(), diagnosis.exists()) {
            (true, false) => Ok(Answer::Decomposition(stiffness)),
            (false, true) => Ok(of_diagnosis(diagnosis)),
            (true, true) => Err(Refusal::at(
                path,
                "holds both a stiffness.json and a diagnosis.json; name the one to export",
            )),
            (false, false) => Err(Refusal::at(
                path,
                "holds neither stiffness.json nor diagnosis.json; give the directory that `jointscope decompose` or `jointscope diagnose` wrote to",
            )),
        }
    }

    fn files(&self) -> Vec<PathBuf> {
        match self {
            Answer::Decomposition(path) => vec![path.clone()],
            Answer::Diagnosis { diagnosis, repaired } => vec![diagnosis.clone(), repaired.clone()],
        }
    }

    fn export(&self, options: &ExportOptions) -> Result<Export, Refusal> {
        match self {
            Answer::Decomposition(path) => {
                let contents = input::json(path)?;
                let joints = Decomposed::all("", &contents).map_err(|error| Refusal::at(path, error))?;
                export::of_decompositions(&joints, options).map_err(|error| Refusal::at(path, error))
            }
            Answer::Diagnosis { diagnosis, repaired } => {
                let contents = input::json(diagnosis)?;
                let fixture = FixtureFile::read(repaired)?;
                export::of_diagnosis(&contents, &fixture, options)
                    .map_err(|error| Refusal::at(diagnosis, error))
            }
        }
    }
}

/// The file to write: what is a directory, or looks like one, gets a file of its own in it.
fn file(output: &Path, program: Program) -> PathBuf {
    let is_directory = output.is_dir()
        || output.extension().is_none()
        || output.as_os_str().to_string_lossy().ends_with(std::path::MAIN_SEPARATOR);
    match is_directory {
        true => output.join(format!("joint.{}", program.extension())),
        false => output.to_owned(),
    }
}

/// The origin, as lines of a comment.
fn made(context: &PageContext) -> Vec<String> {
    let mut lines = vec![format!("made by {}: {}", context.program, context.command)];
    lines.extend(context.inputs.iter().map(|input| format!("from {}, SHA-256 {}", input.name, input.sha256)));
    lines
}

fn summary(export: &Export, path: &Path) -> String {
    let mut lines = vec![export.title.clone()];
    for joint in &export.joints {
        lines.push(format!(
            "joint {} between nodes {} and {}: {}",
            joint.name, joint.from.node, joint.to.node, joint.says
        ));
    }
    lines.extend(export.parts.iter().map(|part| part.says.clone()));
    lines.extend(export.notes.iter().cloned());
    lines.extend(
        export.not_exported.iter().map(|omitted| format!("not exported: {}; {}", omitted.what, omitted.why)),
    );
    lines.push(format!(
        "{}, {}",
        counted(export.joints.len(), "joint"),
        counted(export.parts.len(), "other part")
    ));
    lines.push(path.display().to_string());
    lines.join("\n")
}

/// Reads `FROM,TO`.
fn nodes(text: &str) -> Result<[u64; 2], String> {
    let form = "two different node numbers are needed, such as 101,202";
    let numbers: Vec<u64> =
        text.split(',').map(|number| number.trim().parse()).collect::<Result<_, _>>().map_err(|_| form)?;
    match numbers.as_slice() {
        [from, to] if from != to => Ok([*from, *to]),
        _ => Err(form.to_owned()),
    }
}
