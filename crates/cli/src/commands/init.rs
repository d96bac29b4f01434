//! `jointscope init`: dimensions and materials in, a fixture file with notes out.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use clap::{ArgGroup, Args};
use jointscope::draft::{Bar, Draft, Structure};
use jointscope::recordings::{FileChannel, Geometry, GeometryError, SpatialAxis};
use jointscope::uff::FunctionType;

use crate::input;
use crate::names::names;
use crate::output::Outputs;
use crate::refusal::Refusal;
use crate::values::positive;

/// How bars are written.
const BARS: &str = "BAR is LENGTHxWIDTHxHEIGHT:MATERIAL in mm, such as 60x40x6:steel: LENGTH along x, WIDTH across, HEIGHT along y, the direction that is struck and measured.
MATERIAL is steel, stainless, aluminium, brass, copper, titanium, magnesium, cast-iron, glass, pmma or abs, or Young's modulus in Pa and density in kg/m^3, such as 2.07e11,7850.";

#[derive(Debug, Args)]
#[command(after_help = BARS, group(ArgGroup::new("structure").required(true).multiple(true).args(["blocks", "frame", "beam", "from_uff"])))]
pub(super) struct InitArguments {
    /// Two rigid blocks with a strip between them: one bar for both, or the left and the right one.
    #[arg(long, value_name = "BAR", num_args = 1..=2, requires = "strip")]
    pub blocks: Vec<Bar>,
    /// The strip between the blocks.
    #[arg(long, value_name = "BAR", requires = "blocks")]
    pub strip: Option<Bar>,
    /// A frame of so many storeys on columns.
    #[arg(long, value_name = "STOREYS", requires = "columns", requires = "storey_mass", conflicts_with_all = ["blocks", "beam"])]
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
    #[arg(long, value_name = "BAR", conflicts_with = "blocks")]
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
    /// Recordings whose nodes become the points at the places of their geometry (datasets 15, 2411),
    /// with --blocks or --beam, or alone.
    #[arg(long, value_name = "F.uff", num_args = 1.., conflicts_with = "points_from")]
    pub from_uff: Vec<PathBuf>,
    /// The axis of the geometry along which the structure lies: x, y or z [default: the one along which the
    /// nodes reach farthest].
    #[arg(long, value_name = "AXIS", value_parser = axis, requires = "from_uff")]
    pub axis: Option<SpatialAxis>,
    /// The abscissa in the geometry, mm, where the fixture's x = 0 is [default: 0 where the points then lie
    /// on the structure, else their middle goes to its middle].
    #[arg(long, value_name = "MM", allow_negative_numbers = true, requires = "from_uff")]
    pub origin: Option<f64>,
    /// The unit of the geometry where the files do not state it, such as mm.
    #[arg(long, value_name = "UNIT", requires = "from_uff")]
    pub length_unit: Option<String>,
    /// Overwrite a fixture that is there already.
    #[arg(long)]
    pub force: bool,
    /// The fixture file to write.
    #[arg(short, long, value_name = "FIXTURE.json")]
    pub output: PathBuf,
}

/// Drafts the fixture and writes it; answers with its notes, which also stand in the file.
pub(super) fn run(arguments: &InitArguments) -> Result<String, Refusal> {
    let mut lines = Vec::new();
    let (points, placed) = match arguments.from_uff.is_empty() {
        true => {
            let named = points(&arguments.points_from, &mut lines)?;
            lines.extend(has_places(&arguments.points_from, &named)?);
            (named, Vec::new())
        }
        false => placed(arguments, &mut lines)?,
    };
    let draft = Draft {
        structure: structure(arguments)?,
        ruler: 1e-3 * arguments.ruler,
        points,
        placed,
        origin: arguments.origin.map(|mm| 1e-3 * mm),
    };
    let fixture = draft.fixture().map_err(Refusal::new)?;
    if arguments.output.exists() && !arguments.force {
        return Err(Refusal::at(
            &arguments.output,
            "is there already, and may hold work of yours; choose another `-o`, or overwrite it with --force",
        ));
    }
    let mut outputs = Outputs::new(arguments.points_from.iter().chain(&arguments.from_uff));
    outputs.add(&arguments.output, fixture.to_json());
    outputs.write()?;
    let path = arguments.output.display();
    let mut answer = vec![format!("{path}: {}, {} points", fixture.name(), fixture.points().len())];
    answer.extend(fixture.notes().iter().map(|note| format!("  {note}")));
    answer.extend(lines);
    answer.push(format!("next: jointscope check {path}"));
    Ok(answer.join("\n"))
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
        ([], None, None, None, None, None) if !arguments.from_uff.is_empty() => Ok(Structure::Unknown),
        _ => Err(Refusal::new(
            "what is to be drafted is not clear: `--blocks BAR --strip BAR`, `--frame N --storey-mass KG --columns BAR`, `--beam BAR`, or `--from-uff F.uff` alone",
        )),
    }
}

/// The nodes of recordings, as names of points, and what is to be said of their directions.
fn points(files: &[PathBuf], lines: &mut Vec<String>) -> Result<Vec<String>, Refusal> {
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
            names(files)
        )));
    }
    let upright: BTreeSet<i64> = channels
        .iter()
        .filter(|channel| matches!(channel.direction.abs(), 0 | 2))
        .map(|channel| channel.node)
        .collect();
    // One direction a node is the fixture's: of a triaxial sensor the first that there is, and none where ±y
    // is among them.
    let mut elsewhere: BTreeMap<i64, FileChannel> = BTreeMap::new();
    for channel in channels.iter().filter(|channel| nodes.contains(&channel.node)) {
        let direction = channel.direction.abs();
        if matches!(direction, 1 | 3) && !upright.contains(&channel.node) {
            elsewhere.entry(channel.node).or_insert(FileChannel { direction, ..*channel });
        }
    }
    if !elsewhere.is_empty() {
        // One entry for all nodes where it leaves none out; signs are the files' own.
        let axes: BTreeSet<String> = elsewhere.values().map(|channel| channel.direction_name()).collect();
        let entries: Vec<String> = match (axes.first(), axes.len()) {
            (Some(axis), 1) if elsewhere.len() == nodes.len() => vec![format!("{axis}=+y")],
            _ => elsewhere.into_iter().map(|(node, channel)| format!("{channel}={node}:+y")).collect(),
        };
        lines.push(format!(
            "the recording's directions are not ±y throughout: say with every command which of them are the fixture's, `--map {}`",
            entries.join(" ")
        ));
    }
    Ok(nodes.iter().map(i64::to_string).collect())
}

/// That recordings know the places of points as well, where they do.
fn has_places(files: &[PathBuf], named: &[String]) -> Result<Option<String>, Refusal> {
    let sources = files.iter().map(|path| input::source(path)).collect::<Result<Vec<_>, _>>()?;
    let mut nodes = sources.iter().flat_map(|source| &source.file.nodes).flat_map(|nodes| &nodes.nodes);
    let has = nodes.any(|node| named.contains(&node.label.to_string()));
    let sentence = "the recording has a geometry: `--from-uff` in place of `--points-from` puts the points where it has them";
    Ok(has.then(|| sentence.to_owned()))
}

/// Points whose names alone are known, and those whose places are, by name and abscissa in m.
type Points = (Vec<String>, Vec<(String, f64)>);

/// The nodes of recordings at the places of their geometry, and what is to be said of them. Where there are
/// FRFs or histories, their nodes are the points; else all are.
fn placed(arguments: &InitArguments, lines: &mut Vec<String>) -> Result<Points, Refusal> {
    let files = &arguments.from_uff;
    let sources = files.iter().map(|path| input::source(path)).collect::<Result<Vec<_>, _>>()?;
    let geometry = Geometry::of(&sources, arguments.length_unit.as_deref()).map_err(|error| match error {
        GeometryError::NoNodes(_) => Refusal::new(format_args!(
            "{error}, or give the dimensions and take the nodes' names alone with `--points-from`"
        )),
        GeometryError::NoUnit(_) => Refusal::new(format_args!("{error} (`--length-unit mm`)")),
        error => Refusal::new(error),
    })?;
    let of_functions = sources.iter().flat_map(|source| &source.file.datasets).any(|dataset| {
        matches!(dataset.function, FunctionType::FrequencyResponse | FunctionType::TimeResponse)
    });
    let measured = match of_functions {
        true => points(files, lines)?,
        false => geometry.nodes.iter().map(|node| node.node.to_string()).collect(),
    };
    let (known, unknown): (Vec<String>, Vec<String>) = measured
        .into_iter()
        .partition(|name| name.parse().is_ok_and(|number| geometry.node(number).is_some()));
    if known.is_empty() {
        return Err(Refusal::new(format_args!(
            "{}: the geometry has none of the nodes that were measured ({}); export both from one project, or take the nodes' names alone with `--points-from`",
            names(files),
            unknown.join(", ")
        )));
    }
    let nodes = geometry.nodes.into_iter().filter(|node| known.contains(&node.node.to_string())).collect();
    let geometry = Geometry { nodes };
    let axis = arguments.axis.unwrap_or_else(|| geometry.longest_axis());
    let along = geometry.points_along(axis);
    let off = along.iter().map(|point| point.off_line).fold(0.0, f64::max);
    let reach = along.last().zip(along.first()).map_or(0.0, |(last, first)| last.x - first.x);
    let named = match axis {
        SpatialAxis::X => "x",
        SpatialAxis::Y => "y",
        SpatialAxis::Z => "z",
    };
    lines.push(format!("{} nodes along {named} of the geometry, over {:.1} mm", along.len(), 1e3 * reach));
    if off > OFF_LINE * reach {
        lines.push(format!(
            "nodes lie up to {:.1} mm off the line along {named}, of which a planar fixture knows nothing: choose another --axis, or leave those points out",
            1e3 * off
        ));
    }
    Ok((unknown, along.iter().map(|point| (point.node.to_string(), point.x)).collect()))
}

/// How far nodes may lie off the line, as a share of their reach along it, without a word.
const OFF_LINE: f64 = 0.1;

/// Reads an axis.
fn axis(text: &str) -> Result<SpatialAxis, String> {
    SpatialAxis::parse(text).ok_or_else(|| "an axis is x, y or z".to_owned())
}

/// Reads a mass, above zero.
fn kilograms(text: &str) -> Result<f64, String> {
    positive(text).ok_or_else(|| "a mass in kg above zero is needed, such as 3.5".to_owned())
}

/// Reads a length, above zero.
fn millimetres(text: &str) -> Result<f64, String> {
    positive(text).ok_or_else(|| "a length in mm above zero is needed, such as 0.1".to_owned())
}
