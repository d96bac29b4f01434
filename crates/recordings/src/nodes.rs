//! Recordings of a structure that no fixture file describes: the files' own nodes are its points.

use std::collections::{BTreeMap, BTreeSet};

use jointscope_fixture::Fixture;
use jointscope_spectra::{Channel, Dof};
use jointscope_uff::FunctionType;
use serde_json::{Map, Value, json};

use crate::channel_map::AXES;
use crate::{ChannelMap, FileChannel, MapEntry, ReadOptions, Recording, RecordingError, Source};

impl Recording {
    /// Reads the FRFs of a test whose points are the files' nodes, in whatever direction they were measured.
    ///
    /// A node with one direction of translation is a point by its number, whichever direction that is; one
    /// with several is a point for each, such as `101:x` and `101:z`, and rotations about x and y are
    /// `101:rx` and `101:ry`. Entries of the map name points as they like.
    ///
    /// # Errors
    /// As [`Recording::of`].
    pub fn of_nodes(sources: &[Source], options: &ReadOptions) -> Result<Self, RecordingError> {
        let channels: BTreeSet<FileChannel> = sources
            .iter()
            .flat_map(|source| &source.file.datasets)
            .filter(|d| matches!(d.function, FunctionType::FrequencyResponse | FunctionType::Coherence))
            .flat_map(|d| [FileChannel::from(&d.response), FileChannel::from(&d.reference)])
            .collect();
        let mut entries = options.map.entries().to_vec();
        entries.extend(entries_of_nodes(&channels, &options.map));
        let map = ChannelMap::of_entries(entries);
        let named = map.entries().iter().filter_map(MapEntry::named_point).map(str::to_owned);
        let found = channels.iter().filter_map(|channel| Some(map.find(*channel)?.0.point));
        let mut points: Vec<String> = named.chain(found).collect();
        points.extend(channels.iter().map(|channel| channel.node.to_string()));
        Recording::of(sources, &structure(&points)?, &ReadOptions { map, ..options.clone() })
    }
}

/// An entry for every channel that is no transverse channel of its node by itself.
fn entries_of_nodes(channels: &BTreeSet<FileChannel>, given: &ChannelMap) -> Vec<MapEntry> {
    let mut axes: BTreeMap<i64, BTreeSet<u32>> = BTreeMap::new();
    for channel in channels.iter().filter(|channel| !given.names_node(channel.node)) {
        axes.entry(channel.node).or_default().insert(channel.axis());
    }
    let mut entries = Vec::new();
    for (node, axes) in axes {
        let translations = axes.iter().filter(|axis| **axis < 4).count();
        for axis in axes.into_iter().filter(|axis| (*axis as usize) < AXES.len()) {
            let direction = AXES[axis as usize];
            let (point, dof) = match axis {
                0..=3 if translations == 1 => (node.to_string(), Dof::Translation),
                0..=3 => (format!("{node}:{direction}"), Dof::Translation),
                6 => (node.to_string(), Dof::Rotation),
                _ => (format!("{node}:{direction}"), Dof::Rotation),
            };
            // A scalar channel by itself is left to the reader, who says what is taken.
            if axis == 0 && translations == 1 {
                continue;
            }
            let file = FileChannel { node, direction: axis as i32 };
            entries.push(MapEntry::of_one(file, Channel { point, dof }));
        }
    }
    entries
}

/// A body of which nothing is known but its points, each at a place of its own in the order of their names'
/// numbers.
fn structure(names: &[String]) -> Result<Fixture, RecordingError> {
    let number = |name: &String| name.split(':').next().and_then(|n| n.parse::<i64>().ok());
    let mut names: Vec<&String> = names.iter().collect();
    names.sort_by_key(|name| (number(name), (*name).clone()));
    names.dedup();
    let points: Map<String, Value> = names
        .into_iter()
        .enumerate()
        .map(|(place, name)| (name.clone(), json!({ "body": "structure", "x": place })))
        .collect();
    let body = json!({ "mass": 1.0, "inertia": 1.0, "x_cg": 0.0 });
    let file = json!({ "name": "nodes of the files", "bodies": { "structure": body }, "points": points });
    Fixture::from_json(&file.to_string()).map_err(RecordingError::Points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::to_datasets;
    use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
    use jointscope_uff::{Dataset58, Encoding, UffFile};

    fn datasets(pairs: &[(&str, &str)]) -> Vec<Dataset58> {
        let lines = SpectralLines::even(1.0, 1.0, 3).unwrap();
        let named: Vec<FrfPair> = pairs.iter().map(|(o, i)| FrfPair::transverse(o, i)).collect();
        let values = (0..3 * pairs.len()).map(|v| (v as f64 + 1.0).into()).collect();
        let frfs = FrfSet::new(lines, FrfForm::Accelerance, named, values).unwrap();
        to_datasets(&frfs, "nodes", Encoding::default()).unwrap()
    }

    fn pairs(datasets: Vec<Dataset58>, map: &[&str]) -> Vec<String> {
        let source = Source { name: "t.uff".into(), file: UffFile { datasets, ..UffFile::default() } };
        let options = ReadOptions { map: ChannelMap::parse(map).unwrap(), ..ReadOptions::default() };
        let recording = Recording::of_nodes(&[source], &options).unwrap();
        recording.frfs().unwrap().pairs().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn nodes_are_points_in_whatever_direction_they_were_measured() {
        let mut all = datasets(&[("12", "3"), ("4", "3")]);
        for dataset in &mut all {
            dataset.response.direction = -3;
            dataset.reference.direction = 3;
        }
        assert_eq!(pairs(all, &[]), ["4/3", "12/3"]);
    }

    #[test]
    fn a_triaxial_sensor_is_three_points_unless_the_map_picks_one() {
        let mut all = datasets(&[("12", "3"), ("13", "3"), ("14", "3")]);
        for (dataset, direction) in all.iter_mut().zip([1, 2, 3]) {
            dataset.response.number = 12;
            dataset.response.direction = direction;
        }
        assert_eq!(pairs(all.clone(), &[]), ["12:x/3", "12:y/3", "12:z/3"]);
        assert_eq!(pairs(all.clone(), &["12:z=tip:y"]), ["tip/3"]);
        assert_eq!(pairs(all, &["z=y", "3:y=3:y"]), ["12/3"]);
    }
}
