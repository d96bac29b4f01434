//! From files to functions between the fixture's channels: what belongs to the test, what is left out, and
//! why.

use std::collections::{BTreeMap, BTreeSet};

use jointscope_fixture::Fixture;
use jointscope_spectra::{Channel, Dof, FrfPair};
use jointscope_uff::FunctionType;

use crate::error::enumeration;
use crate::function::{Function, functions};
use crate::{ChannelMap, FileChannel, FunctionError, HeldAmplitude, MapEntry, RecordingError, Source};

/// A function between two channels of the fixture.
#[derive(Debug)]
pub(crate) struct Entry<'a> {
    pub pair: FrfPair,
    pub level: Option<HeldAmplitude>,
    /// Product of both channels' signs.
    pub sign: f64,
    pub function: Function<'a>,
    /// Order of the fixture's points, so that the order of the files does not show.
    key: Key,
}

/// Level, response, reference.
type Key = ((u8, u64), (usize, Dof), (usize, Dof));

/// The functions of all files, by what they are.
#[derive(Debug, Default)]
pub(crate) struct Gathered<'a> {
    pub frfs: Vec<Entry<'a>>,
    pub coherences: Vec<Entry<'a>>,
    pub time_histories: Vec<FileChannel>,
    /// Number of functions of each other type, by code.
    pub others: BTreeMap<i32, usize>,
    /// FRFs at nodes that the fixture does not have.
    pub elsewhere: Vec<String>,
    /// FRFs in directions that are not the fixture's.
    pub other_directions: Vec<String>,
    /// Nodes whose direction is not stated.
    pub scalars: BTreeSet<i64>,
    /// Channels of all FRFs and coherences.
    pub channels: BTreeSet<FileChannel>,
}

impl Gathered<'_> {
    /// Whether the files hold FRFs at all.
    pub(crate) fn has_frfs(&self) -> bool {
        !(self.frfs.is_empty() && self.elsewhere.is_empty() && self.other_directions.is_empty())
    }
}

/// Sorts the functions of all files into what they are.
pub(crate) fn gather<'a>(
    sources: &'a [Source],
    fixture: &Fixture,
    map: &ChannelMap,
) -> Result<Gathered<'a>, RecordingError> {
    check_points(Some(fixture), map)?;
    let mut gathered = Gathered::default();
    let mut spectra = Vec::new();
    for function in functions(sources) {
        match function.dataset.function {
            FunctionType::FrequencyResponse | FunctionType::Coherence => spectra.push(function),
            FunctionType::TimeResponse => gathered.time_histories.push(function.response()),
            other => *gathered.others.entry(other.code()).or_default() += 1,
        }
    }
    gathered.channels = spectra.iter().flat_map(|f| [f.response(), f.reference()]).collect();
    check_entries_apply(map, &gathered.channels)?;
    let responses = spectra.iter().map(Function::response);
    let locator = Locator::new(Some(fixture), map, responses, spectra.iter().map(Function::reference));
    for function in spectra {
        locator
            .sort(function, &mut gathered)
            .map_err(|problem| RecordingError::function(function.place(), problem))?;
    }
    let frfs = || gathered.frfs.iter();
    check_distinct(map, frfs().map(|frf| (frf.function.response(), &frf.pair.response)))?;
    check_distinct(map, frfs().map(|frf| (frf.function.reference(), &frf.pair.reference)))?;
    Ok(gathered)
}

/// Refuses a map that names points which the fixture does not have; without a fixture any name is a point.
pub(crate) fn check_points(fixture: Option<&Fixture>, map: &ChannelMap) -> Result<(), RecordingError> {
    let Some(fixture) = fixture else { return Ok(()) };
    let named = map.entries().iter().filter_map(|entry| Some((entry, entry.named_point()?)));
    match named.into_iter().find(|(_, point)| fixture.point(point).is_none()) {
        None => Ok(()),
        Some((entry, point)) => Err(RecordingError::MapPoint {
            entry: entry.text.clone(),
            point: point.to_owned(),
            points: points(Some(fixture)),
        }),
    }
}

/// An entry that applies to nothing is a slip, and so are two patterns for one channel; files without any
/// channel are refused for that instead.
pub(crate) fn check_entries_apply(
    map: &ChannelMap,
    channels: &BTreeSet<FileChannel>,
) -> Result<(), RecordingError> {
    let applies = |entry: &&MapEntry| channels.iter().any(|channel| entry.applies_to(*channel));
    if let Some(entry) = map.entries().iter().find(|entry| !applies(entry) && !channels.is_empty()) {
        return Err(RecordingError::MapUnused { entry: entry.text.clone(), channels: enumeration(channels) });
    }
    for &channel in channels {
        let mut entries = map.entries_of(channel);
        if let (Some(first), Some(second)) = (entries.next(), entries.next()) {
            let (first, second) = (first.text.clone(), second.text.clone());
            return Err(RecordingError::MapAmbiguous { channel, first, second });
        }
    }
    Ok(())
}

/// Refuses two channels of the files that an entry of many nodes makes one channel of the fixture; entries of
/// one node each may.
pub(crate) fn check_distinct<'c>(
    map: &ChannelMap,
    located: impl Iterator<Item = (FileChannel, &'c Channel)>,
) -> Result<(), RecordingError> {
    let mut seen: BTreeMap<&Channel, FileChannel> = BTreeMap::new();
    for (second, channel) in located {
        let first = *seen.entry(channel).or_insert(second);
        if (first.node, first.axis()) == (second.node, second.axis()) {
            continue;
        }
        let entries = [first, second].into_iter().flat_map(|file| map.entries_of(file));
        if let Some(entry) = entries.into_iter().find(|entry| entry.named_point().is_none()) {
            let (entry, channel) = (entry.text.clone(), channel.clone());
            return Err(RecordingError::MapMerges { entry, channel, first, second });
        }
    }
    Ok(())
}

/// Where a channel of the files is in the fixture.
pub(crate) enum Located {
    At { channel: Channel, sign: f64, order: (usize, Dof) },
    NoSuchPoint,
    OtherDirection,
}

/// Finds the fixture's channel of a channel of the files. Without a fixture every node is a point of its
/// number's name.
pub(crate) struct Locator<'f> {
    fixture: Option<&'f Fixture>,
    map: &'f ChannelMap,
    /// Nodes with a response along y or about z: what else they measured is no riddle.
    pub(crate) planar_responses: BTreeSet<i64>,
    pub(crate) planar_references: BTreeSet<i64>,
}

impl<'f> Locator<'f> {
    pub(crate) fn new(
        fixture: Option<&'f Fixture>,
        map: &'f ChannelMap,
        responses: impl Iterator<Item = FileChannel>,
        references: impl Iterator<Item = FileChannel>,
    ) -> Self {
        fn planar(channels: impl Iterator<Item = FileChannel>) -> BTreeSet<i64> {
            channels
                .filter(|channel| matches!(channel.axis(), 0 | 2 | 6))
                .map(|channel| channel.node)
                .collect()
        }
        Locator { fixture, map, planar_responses: planar(responses), planar_references: planar(references) }
    }

    fn sort<'a>(&self, function: Function<'a>, gathered: &mut Gathered<'a>) -> Result<(), FunctionError> {
        let is_frf = function.dataset.function == FunctionType::FrequencyResponse;
        let name = || format!("{}/{}", function.response(), function.reference());
        let response = self.locate(function.response(), &self.planar_responses);
        let reference = self.locate(function.reference(), &self.planar_references);
        if matches!(response, Ok(Located::NoSuchPoint)) || matches!(reference, Ok(Located::NoSuchPoint)) {
            if is_frf {
                gathered.elsewhere.push(name());
            }
            return Ok(());
        }
        let (response, reference) = (response?, reference?);
        let (
            Located::At { channel: response, sign: response_sign, order: response_order },
            Located::At { channel: reference, sign: reference_sign, order: reference_order },
        ) = (response, reference)
        else {
            if is_frf {
                gathered.other_directions.push(name());
            }
            return Ok(());
        };
        let scalar = [function.response(), function.reference()];
        gathered.scalars.extend(
            scalar.iter().filter(|c| c.direction == 0 && !self.map.names_node(c.node)).map(|c| c.node),
        );
        function.whole()?;
        let level = function.level();
        let entry = Entry {
            pair: FrfPair::new(response, reference),
            level,
            sign: response_sign * reference_sign,
            function,
            key: (level.map_or((0, 0), HeldAmplitude::key), response_order, reference_order),
        };
        if is_frf {
            gathered.frfs.push(entry)
        } else {
            gathered.coherences.push(entry)
        }
        Ok(())
    }

    pub(crate) fn locate(
        &self,
        file: FileChannel,
        planar_nodes: &BTreeSet<i64>,
    ) -> Result<Located, FunctionError> {
        if self.map.names_node(file.node) {
            return match self.map.find(file) {
                Some((channel, sign)) => self.at(channel, sign),
                None => Ok(Located::OtherDirection),
            };
        }
        let point = file.node.to_string();
        if self.fixture.is_some_and(|fixture| fixture.point(&point).is_none()) {
            return Ok(Located::NoSuchPoint);
        }
        match file.axis() {
            0 | 2 => self.at(Channel::transverse(point), file.sign()),
            6 => self.at(Channel::rotational(point), file.sign()),
            1..=5 if planar_nodes.contains(&file.node) => Ok(Located::OtherDirection),
            axis @ 1..=5 => {
                // The map speaks of positive directions.
                let direction = FileChannel { direction: axis as i32, ..file }.direction_name();
                let becomes = if axis < 4 { "y" } else { "theta" };
                Err(FunctionError::Direction { node: file.node, direction, becomes })
            }
            _ => Err(FunctionError::NoSuchDirection { node: file.node, direction: file.direction }),
        }
    }

    fn at(&self, channel: Channel, sign: f64) -> Result<Located, FunctionError> {
        let Some(fixture) = self.fixture else {
            return Ok(Located::At { order: (0, channel.dof), channel, sign });
        };
        let points = fixture.points();
        let Some(index) = points.iter().position(|point| point.name == channel.point) else {
            return Ok(Located::NoSuchPoint);
        };
        if channel.dof == Dof::Rotation && !fixture.bodies()[points[index].body].kind.rotates() {
            return Err(FunctionError::NoRotation { point: channel.point });
        }
        Ok(Located::At { order: (index, channel.dof), channel, sign })
    }
}

/// A map entry that would put a channel of the files on the fixture, as an example of one.
pub(crate) fn example(channels: &BTreeSet<FileChannel>, fixture: Option<&Fixture>) -> String {
    let missing = |channel: &&FileChannel| {
        fixture.is_some_and(|fixture| fixture.point(&channel.node.to_string()).is_none())
    };
    let file = channels.iter().find(missing).or(channels.first()).copied();
    let file = file.unwrap_or(FileChannel { node: 101, direction: 2 });
    let direction = if file.is_rotational() { "+theta" } else { "+y" };
    let point = fixture.and_then(|fixture| fixture.points().first()).map_or("1", |point| &point.name);
    format!("{file}={point}:{direction}")
}

/// The fixture's points, for messages.
pub(crate) fn points(fixture: Option<&Fixture>) -> String {
    enumeration(fixture.into_iter().flat_map(Fixture::points).map(|point| &point.name))
}

/// Sorts functions by level, response and reference, in the order of the fixture's points.
///
/// # Errors
/// The same function twice.
pub(crate) fn in_order<'a, T>(
    items: &mut [T],
    entry: impl for<'t> Fn(&'t T) -> &'t Entry<'a>,
) -> Result<(), RecordingError> {
    items.sort_by_key(|item| entry(item).key);
    let two = items.windows(2).map(|two| (entry(&two[0]), entry(&two[1])));
    match two.into_iter().find(|(first, second)| first.key == second.key) {
        None => Ok(()),
        Some((first, second)) => {
            let level = first.level.map_or(String::new(), |level| format!(" at {level}"));
            Err(RecordingError::Twice {
                what: first.function.what(),
                frf: format!("{}{level}", first.pair),
                first: first.function.place(),
                second: second.function.place(),
            })
        }
    }
}

impl Entry<'_> {
    /// The function of the same channels and level among others in order.
    pub(crate) fn counterpart<'e, 'a>(&self, others: &'e [Entry<'a>]) -> Option<&'e Entry<'a>> {
        others.binary_search_by_key(&self.key, |entry| entry.key).ok().map(|index| &others[index])
    }

    /// Whether both are of the same channels and level.
    pub(crate) fn is_of(&self, other: &Entry) -> bool {
        self.key == other.key
    }

    /// The error of this function.
    pub(crate) fn refuse(&self, problem: FunctionError) -> RecordingError {
        RecordingError::function(self.function.place(), problem)
    }
}
