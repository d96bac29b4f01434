//! `jointscope init`: dimensions and materials in, a fixture file with notes out.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use clap::{ArgGroup, Args};
use jointscope::draft::{Bar, Draft, Structure};
use jointscope::recordings::FileChannel;
use jointscope::uff::FunctionType;

use crate::input;
use crate::output::Outputs;
use crate::refusal::Refusal;
use crate::values::positive;

/// How bars are written.
const BARS: &str = "BAR is LENGTHxWIDTHxHEIGHT:MATERIAL in mm, such as 60x40x6:steel: LENGTH along x, WIDTH across, HEIGHT along y, the direction that is struck and measured.
MATERIAL is steel, stainless, aluminium, brass, copper, titanium, magnesium, cast-iron, glass, pmma or abs, or Young's modulus in Pa and density in kg/m^3, such as 2.07e11,7850.";

#[derive(Debug, Args)]
#[command(after_help = BARS, group(ArgGroup::new("structure").required(true).args(["blocks", "frame", "beam"])))]
pub struct InitArguments {
    /// Two rigid blocks with a strip between them: one bar for both, or the left and the right one.
    #[arg(long, value_name = "BAR", num_args = 1..=2, requires = "strip")]
    pub blocks: Vec<Bar>,
    /// The strip between the blocks.
    #[arg(long, value_name = "BAR", requires = "blocks")]
    pub strip: Option<Bar>,
    /// A frame of so many storeys on columns.
    #[arg(long, value_name = "STOREYS", requires = "columns", requires = "storey_mass")]
    pub frame: Option<usize>,
    /// Mass of a storey, kg.
    #[arg(long, value_name = "KG", value_parser = kilograms, requires = "frame")]
    pub storey_mass: Option<f64>,
    /// One column of a storey, its LENGTH the storey's height, its HEIGHT the side along the motion.
    #[arg(long, value_name = "BAR", requires = "frame")]
    pub columns: Option<Bar>,
    /// Columns of each storey.
    #[arg(long, value_name = "N", default_value_t = 4, requires = "frame")]
    pub column_count: usize,
    /// A beam that bends.
    #[arg(long, value_name = "BAR")]
    pub beam: Option<Bar>,
    /// The beam's left end is clamped.
    #[arg(long, requires = "beam")]
    pub clamped: bool,
    /// One standard deviation of a dimension, mm.
    #[arg(long, value_name = "MM", value_parser = millimetres, default_value = "0.1")]
    pub ruler: f64,
    /// Recordings whose nodes become the points; their places are to be filled in.
    #[arg(long, value_name = "F.uff", num_args = 1..)]
    pub points_from: Vec<PathBuf>,
    /// Overwrite a fixture that is there already.
    #[arg(long)]
    pub force: bool,
    /// The fixture file to write.
    #[arg(short, long, value_name = "FIXTURE.json")]
    pub output: PathBuf,
}

/// Drafts the fixture and writes it; answers with its notes, which also stand in the file.
pub fn run(arguments: &InitArguments) -> Result<String, Refusal> {
    let mut lines = Vec::new();
    let points = points(&arguments.points_from, &mut lines)?;
    let draft = Draft { structure: structure(arguments)?, ruler: 1e-3 * arguments.ruler, points };
    let fixture = draft.fixture().map_err(Refusal::new)?;
    if arguments.output.exists() && !arguments.force {
        return Err(Refusal::at(
            &arguments.output,
            "is there already, and may hold work of yours; choose another `-o`, or overwrite it with --force",
        ));
    }
    let mut outputs = Outputs::new(&arguments.points_from);
    outputs.add(&arguments.output, fixture.to_json());
    outputs.write()?;
    let path = arguments.output.display();
    let mut told = vec![format!("{path}: {}, {} points", fixture.name(), fixture.points().len())];
    told.extend(fixture.notes().iter().map(|note| format!("  {note}")));
    told.extend(lines);
    told.push(format!("next: jointscope check {path}"));
    Ok(told.join("\n"))
}

fn structure(arguments: &InitArguments) -> Result<Structure, Refusal> {
    let InitArguments { blocks, strip, frame, storey_mass, columns, column_count, beam, clamped, .. } =
        arguments;
    if *clamped && beam.is_none() {
        return Err(Refusal::new("--clamped is of a beam: give `--beam BAR` with it, or leave it out"));
    }
    match (blocks.as_slice(), strip, frame, storey_mass, columns, beam) {
        ([a, rest @ ..], Some(strip), ..) => {
            let b = rest.first().unwrap_or(a);
            Ok(Structure::Blocks { blocks: [a.clone(), b.clone()], strip: strip.clone() })
        }
        ([], None, Some(storeys), Some(mass), Some(column), None) => Ok(Structure::Frame {
            storeys: *storeys,
            mass: *mass,
            column: column.clone(),
            columns: *column_count,
        }),
        ([], None, None, None, None, Some(bar)) => {
            Ok(Structure::Beam { bar: bar.clone(), clamped: *clamped })
        }
        _ => Err(Refusal::new(
            "what is to be drafted is not clear: `--blocks BAR --strip BAR`, `--frame N --storey-mass KG --columns BAR`, or `--beam BAR`",
        )),
    }
}

/// The nodes of recordings, as names of points, and what is to be said of their directions.
fn points(files: &[PathBuf], lines: &mut Vec<String>) -> Result<Vec<String>, Refusal> {
    input::once(files)?;
    let mut channels: BTreeSet<FileChannel> = BTreeSet::new();
    for path in files {
        for dataset in &input::source(path)?.file.datasets {
            if matches!(
                dataset.function,
                FunctionType::FrequencyResponse | FunctionType::Coherence | FunctionType::TimeResponse
            ) {
                channels.insert(FileChannel::from(&dataset.response));
            }
            // A time history is of one node: its reference means nothing.
            if matches!(dataset.function, FunctionType::FrequencyResponse | FunctionType::Coherence) {
                channels.insert(FileChannel::from(&dataset.reference));
            }
        }
    }
    let nodes: BTreeSet<i64> =
        channels.iter().map(|channel| channel.node).filter(|node| *node != 0).collect();
    if nodes.is_empty() && !files.is_empty() {
        return Err(Refusal::new(format_args!(
            "{}: no FRF or time history in it names a node, so there are no points to take; number the channels in the analyser, or leave out --points-from",
            input::names(files)
        )));
    }
    let upright: BTreeSet<i64> = channels
        .iter()
        .filter(|channel| matches!(channel.direction.abs(), 0 | 2))
        .map(|channel| channel.node)
        .collect();
    // One direction a node is the fixture's: of a triaxial sensor the first that there is, and none where ±y is among them.
    let mut elsewhere: BTreeMap<i64, &FileChannel> = BTreeMap::new();
    for channel in channels.iter().filter(|channel| nodes.contains(&channel.node)) {
        if !matches!(channel.direction.abs(), 0 | 2 | 6) && !upright.contains(&channel.node) {
            elsewhere.entry(channel.node).or_insert(channel);
        }
    }
    if !elsewhere.is_empty() {
        let entries: Vec<String> =
            elsewhere.into_iter().map(|(node, channel)| format!("{channel}={node}:+y")).collect();
        lines.push(format!(
            "the recording's directions are not ±y throughout: say with every command which of them are the fixture's, `--map {}`",
            entries.join(" ")
        ));
    }
    Ok(nodes.iter().map(i64::to_string).collect())
}

/// Reads a mass, above zero.
fn kilograms(text: &str) -> Result<f64, String> {
    positive(text).ok_or_else(|| "a mass in kg above zero is needed, such as 3.5".to_owned())
}

/// Reads a length, above zero.
fn millimetres(text: &str) -> Result<f64, String> {
    positive(text).ok_or_else(|| "a length in mm above zero is needed, such as 0.1".to_owned())
}
