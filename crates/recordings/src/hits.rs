//! Hammer hits from the time histories of a test.

use std::collections::{BTreeMap, BTreeSet};

use jointscope_fixture::Fixture;
use jointscope_hits::{Hit, MeasuredMotion, Response};
use jointscope_spectra::{Channel, Dof, FrfForm};
use jointscope_uff::{Abscissa, Data, FunctionType};

use crate::completeness;
use crate::contents::Contents;
use crate::error::enumeration;
use crate::function::{Function, functions};
use crate::gather::{Located, Locator, check_distinct, check_entries_apply, check_points, example, points};
use crate::ordinate::{Signal, UnitNotes, seconds, signal};
use crate::{FileChannel, FunctionError, HitsError, ReadOptions, Source};

/// The hammer hits of a test, in the fixture's terms and SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Hits {
    /// The hits by number, the responses of each in the order of the fixture's points (without a fixture, of
    /// the node numbers).
    pub hits: Vec<Hit>,
    /// What a reader of the results should know of the files: one plain sentence each.
    pub notes: Vec<String>,
}

/// Reads the hammer hits of a test: time histories (function type 1) with the same sequence number are the
/// channels of one hit.
///
/// A channel of ordinate type 13 is the force, and its response node and direction are where and whereto the
/// hammer struck; reference fields mean nothing. Without a `fixture` every node is a point named by its
/// number. Where several files count their hits from the same number, each file's are hits of their own, and
/// all are numbered anew.
///
/// ```
/// use jointscope_recordings::{ReadOptions, Source, hits_of};
/// use jointscope_uff::{Abscissa, Axis, Data, Dataset58, FunctionType, Node, UffFile};
///
/// let channel = |node, axis, values| Dataset58 {
///     function: FunctionType::TimeResponse,
///     sequence_number: 1,
///     response: node,
///     abscissa_axis: Axis::time(),
///     ordinate_axis: axis,
///     ..Dataset58::new(Abscissa::Even { start: 0.0, step: 1e-3, count: 4 }, Data::Real(values))
/// };
/// let force = channel(Node::new(1, -2), Axis::excitation_force(), vec![0.0, -90.0, -40.0, 0.0]);
/// let sensor = channel(Node::new(4, 2), Axis::acceleration(), vec![0.0, 2.0, -1.0, 0.5]);
/// let source = Source { name: "hits.uff".into(), file: UffFile { datasets: vec![sensor, force], ..UffFile::default() } };
/// let hits = hits_of(&[source], None, &ReadOptions::default())?.hits;
/// assert_eq!(hits[0].force(), [0.0, 90.0, 40.0, 0.0]); // the hammer pushed along −y, recorded as negative
/// assert_eq!(hits[0].responses()[0].channel.point, "4");
/// # Ok::<(), jointscope_recordings::HitsError>(())
/// ```
///
/// # Errors
/// A [`HitsError`] that names file, function and remedy: no time histories, a hit without a force or with
/// two, channels of a hit on different instants, units or directions that are not known, nothing that belongs
/// to the fixture.
pub fn hits_of(
    sources: &[Source],
    fixture: Option<&Fixture>,
    options: &ReadOptions,
) -> Result<Hits, HitsError> {
    let histories = time_histories(sources)?;
    check_points(fixture, &options.map).map_err(HitsError::Map)?;
    let channels = histories.iter().map(Function::response).collect();
    check_entries_apply(&options.map, &channels).map_err(HitsError::Map)?;
    let mut notes = Vec::new();
    let located = located(&histories, fixture, options, &mut notes)?;
    if located.is_empty() && fixture.is_none() {
        return Err(HitsError::NoSignal {
            files: enumeration(sources.iter().map(|source| &source.name)),
            found: Contents::of(sources).phrase(),
        });
    }
    for is_force in [true, false] {
        let alike = located.iter().filter(|channel| channel.is_force() == is_force);
        let placed = alike.filter_map(|channel| Some((channel.history.response(), &channel.at.as_ref()?.0)));
        check_distinct(&options.map, placed).map_err(HitsError::Map)?;
    }
    let (groups, renumbered) = groups(&located);
    let files = || enumeration(sources.iter().map(|source| &source.name));
    let mut hits = Vec::with_capacity(groups.len());
    let mut struck_elsewhere = Vec::new();
    for (number, group) in &groups {
        match hit(*number, group, &files)? {
            Some(hit) => hits.push(hit),
            None => struck_elsewhere.push(group[0].sequence()),
        }
    }
    if hits.is_empty() {
        return Err(HitsError::NotOnFixture {
            files: files(),
            nodes: enumeration(&channels),
            points: points(fixture),
            example: example(&channels, fixture),
        });
    }
    if !struck_elsewhere.is_empty() {
        let hits = enumeration(struck_elsewhere);
        notes.push(format!("hits at nodes that the fixture does not have left out: {hits}"));
    }
    if renumbered {
        notes.push(renumbering(&groups));
    }
    notes.extend(completeness::of_hits(sources));
    Ok(Hits { hits, notes })
}

fn refused(function: &Function, problem: impl Into<FunctionError>) -> HitsError {
    HitsError::Channel { place: function.place(), problem: problem.into() }
}

fn time_histories(sources: &[Source]) -> Result<Vec<Function<'_>>, HitsError> {
    let histories: Vec<Function> = functions(sources)
        .filter(|function| function.dataset.function == FunctionType::TimeResponse)
        .collect();
    if !histories.is_empty() {
        return Ok(histories);
    }
    Err(HitsError::NoTimeHistory {
        files: enumeration(sources.iter().map(|source| &source.name)),
        found: Contents::of(sources).phrase(),
    })
}

/// A channel of a hit in the fixture's terms.
struct LocatedHistory<'a> {
    history: &'a Function<'a>,
    /// `None` for a force at a node that the fixture does not have.
    at: Option<(Channel, (usize, Dof))>,
    signal: Signal,
    /// Sign of the direction times the factor to SI.
    factor: f64,
}

impl LocatedHistory<'_> {
    fn sequence(&self) -> i64 {
        self.history.dataset.sequence_number
    }

    fn is_force(&self) -> bool {
        self.signal == Signal::Force
    }
}

fn located<'a>(
    histories: &'a [Function<'a>],
    fixture: Option<&Fixture>,
    options: &ReadOptions,
    notes: &mut Vec<String>,
) -> Result<Vec<LocatedHistory<'a>>, HitsError> {
    let channels = || histories.iter().map(Function::response);
    let locator = Locator::new(fixture, &options.map, channels(), channels());
    let mut units = UnitNotes::default();
    let (mut elsewhere, mut other_directions, mut neither) =
        (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    let mut scalars = BTreeSet::new();
    let mut all = Vec::with_capacity(histories.len());
    for history in histories {
        let channel = history.response();
        let found = locator.locate(channel, &locator.planar_responses);
        let force_type = jointscope_uff::data_type::EXCITATION_FORCE;
        if matches!(found, Ok(Located::NoSuchPoint)) && history.dataset.ordinate_axis.data_type != force_type
        {
            elsewhere.insert(channel);
            continue;
        }
        history.whole().map_err(|problem| refused(history, problem))?;
        let named = (history.source, history.dataset);
        let read = signal(named, options.assume_units.as_ref(), &mut units);
        let Some((signal, si)) = read.map_err(|problem| refused(history, problem))? else {
            neither.insert(channel);
            continue;
        };
        let (at, sign) = match found.map_err(|problem| refused(history, problem))? {
            Located::At { channel: at, sign, order } => {
                if channel.direction == 0 && !options.map.names_node(channel.node) {
                    scalars.insert(channel.node);
                }
                (Some((at, order)), sign)
            }
            Located::NoSuchPoint => (None, 1.0),
            Located::OtherDirection => {
                other_directions.insert(channel);
                continue;
            }
        };
        all.push(LocatedHistory { history, at, signal, factor: sign * si });
    }
    let mut say = |channels: &BTreeSet<FileChannel>, what: &str| {
        if !channels.is_empty() {
            notes.push(format!("{what}: {}", enumeration(channels)));
        }
    };
    say(&elsewhere, "responses at nodes that the fixture does not have left out");
    say(&other_directions, "channels in directions other than y and theta left out");
    say(&neither, "channels that are neither force nor motion left out");
    if !scalars.is_empty() {
        notes.push(format!("no direction is stated for nodes {}: +y taken", enumeration(&scalars)));
    }
    notes.extend(units.into_texts(options.assume_units.as_ref()));
    Ok(all)
}

type Group<'a> = Vec<&'a LocatedHistory<'a>>;

/// The channels of each hit with its number, and whether the numbers are not those of the files.
fn groups<'a>(all: &'a [LocatedHistory<'a>]) -> (Vec<(u32, Group<'a>)>, bool) {
    let mut by_sequence: BTreeMap<i64, Group> = BTreeMap::new();
    for channel in all {
        by_sequence.entry(channel.sequence()).or_default().push(channel);
    }
    let sources = |group: &Group<'a>| {
        let forces = group.iter().filter(|channel| channel.is_force());
        forces.map(|channel| channel.history.source).collect::<BTreeSet<_>>()
    };
    let counted_apart = by_sequence.values().any(|group| sources(group).len() > 1);
    let mut groups: Vec<((usize, i64), Group)> = Vec::new();
    for (sequence, group) in by_sequence {
        if sources(&group).len() < 2 {
            let first = order_of(all, group[0].history.source);
            groups.push(((first, sequence), group));
            continue;
        }
        let mut by_source: BTreeMap<usize, Group> = BTreeMap::new();
        for channel in group {
            by_source.entry(order_of(all, channel.history.source)).or_default().push(channel);
        }
        groups.extend(by_source.into_iter().map(|(source, group)| ((source, sequence), group)));
    }
    let fits = |(_, sequence): &(usize, i64)| u32::try_from(*sequence).is_ok();
    if !counted_apart && groups.iter().all(|(key, _)| fits(key)) {
        return (groups.into_iter().map(|((_, sequence), g)| (sequence as u32, g)).collect(), false);
    }
    groups.sort_by_key(|(key, _)| *key);
    (groups.into_iter().zip(1..).map(|((_, group), number)| (number, group)).collect(), true)
}

/// The position of a file among the files.
fn order_of(all: &[LocatedHistory], source: &str) -> usize {
    all.iter().position(|channel| channel.history.source == source).unwrap_or(0)
}

/// The hit of a group of channels; `None` where it was struck at no point of the fixture.
fn hit(number: u32, group: &Group, files: &dyn Fn() -> String) -> Result<Option<Hit>, HitsError> {
    let sequence = group[0].sequence();
    let mut forces = group.iter().filter(|channel| channel.is_force());
    let Some(force) = forces.next() else {
        return Err(HitsError::NoForce {
            files: files(),
            hit: sequence,
            responses: enumeration(group.iter().map(|channel| channel.history.response())),
        });
    };
    if let Some(second) = forces.next() {
        let (first, second) = (force.history.place(), second.history.place());
        return Err(HitsError::TwoForces { hit: sequence, first, second });
    }
    let Some((struck, _)) = force.at.clone() else { return Ok(None) };
    let instants = Instants::of(force.history)?;
    let mut responses = Vec::with_capacity(group.len() - 1);
    for channel in group {
        let (Signal::Motion(form), Some((at, order))) = (channel.signal, &channel.at) else {
            continue;
        };
        instants.check(sequence, channel.history)?;
        // Without a fixture, points stand in the order of their numbers.
        let number = at.point.parse::<i64>().unwrap_or(i64::MAX);
        let key = (*order, number, at.clone());
        responses.push((key, Response::new(at.clone(), motion(form), values(channel)?)));
    }
    responses.sort_by(|(a, _), (b, _)| a.cmp(b));
    let responses = responses.into_iter().map(|(_, response)| response).collect();
    Hit::new(number, instants.interval, instants.start, struck, values(force)?, responses)
        .map(Some)
        .map_err(|problem| HitsError::Hit { files: files(), problem })
}

fn motion(form: FrfForm) -> MeasuredMotion {
    match form {
        FrfForm::Receptance => MeasuredMotion::Displacement,
        FrfForm::Mobility => MeasuredMotion::Velocity,
        FrfForm::Accelerance => MeasuredMotion::Acceleration,
    }
}

fn values(channel: &LocatedHistory) -> Result<Vec<f64>, HitsError> {
    match &channel.history.dataset.data {
        Data::Real(values) => Ok(values.iter().map(|value| value * channel.factor).collect()),
        Data::Complex(_) => Err(HitsError::Complex(channel.history.place())),
    }
}

/// When the samples of a channel were taken.
struct Instants {
    interval: f64,
    start: f64,
}

/// How far two channels may part, as a share of the interval: times are stored with few digits.
const SAME_INSTANT: f64 = 1e-3;

impl Instants {
    fn of(history: &Function) -> Result<Self, HitsError> {
        let factor = seconds(&history.dataset.abscissa_axis).map_err(|problem| refused(history, problem))?;
        let instants = match &history.dataset.abscissa {
            Abscissa::Even { start, step, .. } => Instants { interval: step * factor, start: start * factor },
            Abscissa::Uneven(times) => {
                let (Some(first), Some(last)) = (times.first(), times.last()) else {
                    return Ok(Instants { interval: 1.0, start: 0.0 });
                };
                let interval = (last - first) / (times.len().max(2) - 1) as f64;
                let at = |(i, time): (usize, &f64)| (time - first - i as f64 * interval).abs();
                // Times that were rounded to a few digits are evenly spaced all the same.
                if times.iter().enumerate().map(at).any(|off| off > 0.05 * interval) {
                    return Err(HitsError::Uneven(history.place()));
                }
                Instants { interval: interval * factor, start: first * factor }
            }
        };
        Ok(instants)
    }

    /// Refuses a response that was not sampled at the force's instants.
    fn check(&self, hit: i64, response: &Function) -> Result<(), HitsError> {
        let found = Instants::of(response)?;
        let place = || response.place();
        if (found.interval - self.interval).abs() > SAME_INSTANT * self.interval {
            let (force, response) = (self.interval, found.interval);
            return Err(HitsError::Interval { place: place(), hit, force, response });
        }
        if (found.start - self.start).abs() > SAME_INSTANT.max(0.01) * self.interval {
            let (force, response) = (self.start, found.start);
            return Err(HitsError::Start { place: place(), hit, force, response });
        }
        Ok(())
    }
}

/// Which numbers the hits have, where the files' own could not be kept.
fn renumbering(groups: &[(u32, Group)]) -> String {
    let mut runs: Vec<(&str, u32, u32)> = Vec::new();
    for (number, group) in groups {
        let source = group[0].history.source;
        match runs.last_mut() {
            Some((last, _, to)) if *last == source => *to = *number,
            _ => runs.push((source, *number, *number)),
        }
    }
    let named = runs.iter().map(|(source, from, to)| match from == to {
        true => format!("{from} from {source}"),
        false => format!("{from} to {to} from {source}"),
    });
    format!("hits are numbered through all files: {}", enumeration(named))
}
