//! What files hold, told in the field's words: for those who want to know, and for refusals of files without
//! FRFs.

mod words;

use std::collections::BTreeMap;

use jointscope_uff::{Dataset58, FunctionType, NodalData, ValueLocation};
use serde::Serialize;

use crate::Source;
use crate::error::enumeration;
use crate::function::functions;
use crate::geometry::Geometry;
use words::{counted, dataset_name, function_name, quantity_name, short, thousands};

/// What the files of a test hold.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Contents {
    /// Number of files with a header (dataset 151).
    pub headers: usize,
    /// Who wrote the files, where they say.
    pub written_by: Vec<String>,
    /// Unit systems (dataset 164) in force.
    pub units: Vec<String>,
    /// Functions, by what they are.
    pub functions: Vec<FunctionKind>,
    /// The nodes of the geometry.
    pub nodes: usize,
    /// How far they reach along x, y and z, in m, where they can be placed.
    pub extent: Option<[[f64; 2]; 3]>,
    /// Its elements.
    pub elements: usize,
    /// Its trace lines.
    pub trace_lines: usize,
    /// Its local coordinate systems.
    pub coordinate_systems: usize,
    /// Mode shapes, in file order.
    pub modes: Vec<ModeShape>,
    /// Other data at nodes, on elements or at points, by what they are.
    pub other_data: BTreeMap<String, usize>,
    /// Datasets that are not read, by number.
    pub other_datasets: BTreeMap<u32, usize>,
    /// Why the nodes cannot be placed.
    pub unplaced: Option<String>,
    /// Datasets that are damaged, with the place.
    pub unreadable: Vec<String>,
}

/// Functions of one type, quantity and extent.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FunctionKind {
    /// What they are: `FRF`, `time history`, `power spectral density`, …
    pub what: String,
    /// Function type of the format.
    pub function_type: i32,
    /// What they measure: `acceleration per excitation force`, `pressure`, …
    pub quantity: Option<String>,
    /// Unit labels as stored.
    pub units: String,
    /// How many there are.
    pub count: usize,
    /// Their channels, response over reference, as the file numbers them.
    pub channels: Vec<String>,
    /// Number of values of each.
    pub values: usize,
    /// First and last abscissa, in the file's unit.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// Unit label of the abscissa.
    pub abscissa_units: String,
    /// Values that the header states, where the dataset is closed after fewer.
    pub stated_values: Option<usize>,
}

/// One mode shape.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeShape {
    /// Natural frequency, Hz.
    pub frequency: Option<f64>,
    /// Damping ratio.
    pub damping_ratio: Option<f64>,
    /// Modal mass as stored, in the file's units.
    pub modal_mass: Option<f64>,
    /// Number of its nodes.
    pub nodes: usize,
    /// Whether it has imaginary parts.
    pub complex: bool,
}

impl Contents {
    /// What the files hold.
    pub fn of(sources: &[Source]) -> Self {
        let mut all = Contents::default();
        for file in sources.iter().map(|source| &source.file) {
            if let Some(header) = &file.header {
                all.headers += 1;
                push_new(&mut all.written_by, header.written_by.clone());
            }
            let functions = file.datasets.iter().filter_map(|dataset| dataset.units.as_ref());
            let nodes = file.nodes.iter().filter_map(|nodes| nodes.units.as_ref());
            for units in functions.chain(nodes) {
                push_new(&mut all.units, units.description.trim().to_owned());
            }
            all.nodes += file.nodes.iter().map(|nodes| nodes.nodes.len()).sum::<usize>();
            all.elements += file.elements.len();
            all.trace_lines += file.traces.len();
            all.coordinate_systems += file.systems.len();
            for data in &file.nodal {
                if data.is_mode() {
                    all.modes.push(mode_shape(data));
                } else {
                    *all.other_data.entry(data_name(data)).or_default() += 1;
                }
            }
            for (number, count) in &file.skipped {
                *all.other_datasets.entry(*number).or_default() += count;
            }
            all.unreadable.extend(
                file.unreadable
                    .iter()
                    .map(|dataset| format!("dataset {} cannot be read: {}", dataset.number, dataset.error)),
            );
        }
        match Geometry::of(sources, None) {
            Ok(geometry) => all.extent = Some(geometry.extent()),
            // Nodes that cannot be placed are told of; files without any are not.
            Err(error) if all.nodes > 0 => all.unplaced = Some(error.to_string()),
            Err(_) => {}
        }
        for function in functions(sources) {
            let channel = match function.dataset.function {
                FunctionType::TimeResponse => function.response().to_string(),
                _ => format!("{}/{}", function.response(), function.reference()),
            };
            all.add(function.dataset, channel);
        }
        all
    }

    fn add(&mut self, dataset: &Dataset58, channel: String) {
        let kind = function_kind(dataset);
        let same = |other: &&mut FunctionKind| {
            let fields = |k: &FunctionKind| {
                (k.function_type, k.quantity.clone(), k.units.clone(), k.values, k.stated_values)
            };
            fields(other) == fields(&kind) && (other.from, other.to) == (kind.from, kind.to)
        };
        match self.functions.iter_mut().find(same) {
            Some(known) => {
                known.count += 1;
                known.channels.push(channel);
            }
            None => self.functions.push(FunctionKind { channels: vec![channel], ..kind }),
        }
    }

    /// All in one phrase, for refusals:
    /// `a mesh of 441 nodes and 400 elements, 10 mode shapes (0.956 to 31.2 Hz)`.
    pub fn phrase(&self) -> String {
        let mut parts: Vec<String> = Vec::new();
        let mut by_type: BTreeMap<(i32, &str, &str), usize> = BTreeMap::new();
        for kind in &self.functions {
            let quantity = kind.quantity.as_deref().filter(|_| kind.function_type == 1).unwrap_or_default();
            *by_type.entry((kind.function_type, &kind.what, quantity)).or_default() += kind.count;
        }
        parts.extend(by_type.into_iter().map(|((code, what, quantity), count)| match code {
            1 if quantity.is_empty() => counted(count, what),
            1 => format!("{} ({quantity})", counted(count, what)),
            _ => format!("{} (function type {code})", counted(count, what)),
        }));
        parts.extend(self.mesh());
        parts.extend(self.modes_phrase());
        parts.extend(self.other_data.iter().map(|(what, count)| match count {
            1 => what.clone(),
            _ => format!("{count} times {what}"),
        }));
        parts.extend(self.other_datasets.iter().map(|(number, count)| dataset_name(*number, *count)));
        if !self.unreadable.is_empty() {
            parts.push(format!("{} that cannot be read", counted(self.unreadable.len(), "dataset")));
        }
        match (parts.is_empty(), self.headers) {
            (false, _) => enumeration(parts),
            (true, 0) => "nothing".to_owned(),
            (true, _) => "a header (dataset 151) and nothing else".to_owned(),
        }
    }

    fn mesh(&self) -> Option<String> {
        match (self.nodes, self.elements, self.trace_lines) {
            (0, 0, 0) => None,
            (nodes, 0, 0) => Some(format!("a geometry of {}", counted(nodes, "node"))),
            (nodes, 0, lines) => {
                Some(format!("a geometry of {} and {}", counted(nodes, "node"), counted(lines, "trace line")))
            }
            (nodes, elements, _) => {
                Some(format!("a mesh of {} and {}", counted(nodes, "node"), counted(elements, "element")))
            }
        }
    }

    fn modes_phrase(&self) -> Option<String> {
        let count = self.modes.len();
        let frequencies = || self.modes.iter().filter_map(|mode| mode.frequency);
        let range = frequencies().fold(None, |range: Option<(f64, f64)>, f| match range {
            None => Some((f, f)),
            Some((low, high)) => Some((low.min(f), high.max(f))),
        });
        let range = match range {
            None => String::new(),
            Some((low, high)) if low == high => format!(" ({} Hz)", short(low)),
            Some((low, high)) => format!(" ({} to {} Hz)", short(low), short(high)),
        };
        (count > 0).then(|| format!("{}{range}", counted(count, "mode shape")))
    }

    /// All of it, a line each.
    pub fn says(&self) -> Vec<String> {
        let mut lines: Vec<String> = self.written_by.iter().map(|who| format!("written by {who}")).collect();
        lines.extend(self.units.iter().map(|units| format!("units (dataset 164): {units}")));
        lines.extend(self.functions.iter().map(FunctionKind::says));
        let reach = self.extent.map_or(String::new(), |extent| {
            let along = ["x", "y", "z"].iter().zip(extent).filter(|(_, [from, to])| from != to);
            let along =
                along.map(|(axis, [from, to])| format!("{axis} from {} to {} m", short(from), short(to)));
            format!(": {}", enumeration(along))
        });
        lines.extend(self.mesh().map(|mesh| mesh + &reach));
        lines.extend(self.unplaced.iter().cloned());
        if self.coordinate_systems > 0 {
            lines.push(counted(self.coordinate_systems, "local coordinate system"));
        }
        lines.extend(self.modes_phrase());
        for (index, mode) in self.modes.iter().enumerate().take(SHOWN_MODES) {
            let frequency =
                mode.frequency.map_or("no frequency stated".into(), |f| format!("{} Hz", short(f)));
            let damping = mode
                .damping_ratio
                .map_or(String::new(), |d| format!(", damping ratio {} %", short(100.0 * d)));
            let complex = if mode.complex { ", complex" } else { "" };
            lines.push(format!(
                "  {}. {frequency}{damping}, {}{complex}",
                index + 1,
                counted(mode.nodes, "node")
            ));
        }
        if self.modes.len() > SHOWN_MODES {
            lines.push(format!("  and {} more", self.modes.len() - SHOWN_MODES));
        }
        lines.extend(self.other_data.iter().map(|(what, count)| match count {
            1 => what.clone(),
            _ => format!("{count} times {what}"),
        }));
        lines.extend(
            self.other_datasets.iter().map(|(n, count)| format!("{}: not read", dataset_name(*n, *count))),
        );
        lines.extend(self.unreadable.iter().cloned());
        lines
    }
}

/// Modes listed one by one.
const SHOWN_MODES: usize = 20;

fn push_new(all: &mut Vec<String>, text: String) {
    if !text.is_empty() && !all.contains(&text) {
        all.push(text);
    }
}

fn mode_shape(data: &NodalData) -> ModeShape {
    ModeShape {
        frequency: data.frequency,
        damping_ratio: data.damping_ratio,
        modal_mass: data.modal_mass,
        nodes: data.values.len(),
        complex: data.values.iter().flat_map(|at| &at.values).any(|value| value.im != 0.0),
    }
}

fn data_name(data: &NodalData) -> String {
    let quantity = quantity_name(i32::try_from(data.quantity).unwrap_or(0)).unwrap_or("data");
    match data.location {
        ValueLocation::Nodes => format!("{quantity} at {}", counted(data.values.len(), "node")),
        ValueLocation::Other(2) => format!("{quantity} on elements"),
        ValueLocation::Other(3) => format!("{quantity} at nodes on elements"),
        ValueLocation::Other(_) => format!("{quantity} at points"),
    }
}

fn function_kind(dataset: &Dataset58) -> FunctionKind {
    let (numerator, denominator) = (&dataset.ordinate_axis, &dataset.denominator_axis);
    let label = |text: &str| {
        let text = text.trim();
        if text.eq_ignore_ascii_case("none") { String::new() } else { text.to_owned() }
    };
    let mut units = label(&numerator.units);
    if !label(&denominator.units).is_empty() {
        units = format!("{units} per {}", label(&denominator.units));
    }
    let count = dataset.data.len();
    let value = |index: usize| if count == 0 { 0.0 } else { dataset.abscissa.value(index) };
    FunctionKind {
        what: function_name(dataset.function).to_owned(),
        function_type: dataset.function.code(),
        quantity: match (quantity_name(numerator.data_type), quantity_name(denominator.data_type)) {
            (Some(numerator), Some(denominator)) => Some(format!("{numerator} per {denominator}")),
            (numerator, _) => numerator.map(str::to_owned),
        },
        units,
        count: 1,
        channels: Vec::new(),
        values: count,
        from: value(0),
        to: value(count.saturating_sub(1)),
        abscissa_units: label(&dataset.abscissa_axis.units),
        stated_values: dataset.stated_points,
    }
}

impl FunctionKind {
    /// How many functions of which kind, in a line.
    fn says(&self) -> String {
        let stated = self
            .stated_values
            .map_or(String::new(), |stated| format!(" of the {} that the header states", thousands(stated)));
        let quantity = self.quantity.as_ref().map_or(String::new(), |quantity| format!(" of {quantity}"));
        let units = match self.units.as_str() {
            // A coherence has none.
            "" if self.function_type == FunctionType::Coherence.code() => String::new(),
            "" => ", no unit stated".to_owned(),
            units => format!(" in {units}"),
        };
        format!(
            "{}{quantity}{units}: {} values{stated} from {} to {} {}; channels {}",
            counted(self.count, &self.what),
            thousands(self.values),
            short(self.from),
            short(self.to),
            self.abscissa_units,
            enumeration(&self.channels),
        )
    }
}
