//! The datasets of a test as FRFs between a fixture's points, or as hits, or as levels.

use std::collections::BTreeSet;

use jointscope_fixture::Fixture;
use jointscope_spectra::{FrfForm, FrfSet};
use num_complex::Complex64;

use crate::coherence::CoherenceNotes;
use crate::common_lines::{common_lines, lines_of, on_other_lines};
use crate::completeness;
use crate::contents::Contents;
use crate::error::{enumeration, with_count};
use crate::function::{LinesCache, append_accelerances, functions};
use crate::gather::{Entry, Gathered, example, gather, in_order, points};
use crate::ordinate::{Ordinate, UnitNotes, may_be_force, ordinate};
use crate::{AssumedUnits, ChannelMap, FileChannel, FunctionError, HeldAmplitude, RecordingError, Source};

/// What the analyst says where the files do not.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadOptions {
    /// Which channel of the files is which of the fixture.
    pub map: ChannelMap,
    /// Units, where a file states none.
    pub assume_units: Option<AssumedUnits>,
    /// Number of averages of every FRF, whatever the files state.
    pub averages: Option<u32>,
    /// Whether coherences are left aside.
    pub ignore_coherence: bool,
}

/// The FRFs of one test, level by level, in the fixture's terms and SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// The levels, at least one: that of no held amplitude first, then forces, then responses, ascending.
    pub levels: Vec<Level>,
    /// Time histories that the files hold besides; they are left aside.
    pub time_histories: TimeHistories,
    /// What a reader of the results should know of the files: one plain sentence each.
    pub notes: Vec<String>,
}

/// FRFs at one amplitude.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// The amplitude that was held; `None` for any but stepped-sine tests.
    pub held: Option<HeldAmplitude>,
    /// Accelerances in SI units along +y and +θ, in the order of the fixture's points, with coherence and
    /// averages where they were recorded; at 0 Hz they are what the file holds, or zero where the file holds
    /// a mobility or receptance. Those that were recorded over a part of the lines are zero on the others.
    pub frfs: FrfSet,
    /// The form in which each FRF was recorded.
    pub recorded_forms: Vec<FrfForm>,
    /// Decay δ of the exponential window over force and responses, 1/s, as ID line 3 states it; 0 without
    /// one. The FRFs are those at s = δ + iω.
    pub window_decay: f64,
}

/// Time histories among the files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TimeHistories {
    /// Number of them, over all hits.
    pub count: usize,
    /// Their channels.
    pub channels: Vec<FileChannel>,
}

impl Recording {
    /// Decay of the exponential window over force and responses that its files state, 1/s; 0 without one.
    pub fn window_decay(&self) -> f64 {
        self.levels.first().map_or(0.0, |level| level.window_decay)
    }

    /// Reads the FRFs of a test from its files.
    ///
    /// FRFs at nodes that the fixture does not have are left out and named in the notes, as are functions
    /// that are no FRFs.
    ///
    /// # Errors
    /// A [`RecordingError`] that names file, function and remedy: units or directions that are not known or
    /// contradict each other, the same FRF twice at one level, functions on different spectral lines, nothing
    /// that belongs to the fixture.
    pub fn of(sources: &[Source], fixture: &Fixture, options: &ReadOptions) -> Result<Self, RecordingError> {
        let mut gathered = gather(sources, fixture, &options.map)?;
        if !gathered.has_frfs() {
            return Err(without_frfs(sources, &gathered));
        }
        let mut notes = Notes::default();
        notes.of_what_is_left_out(&gathered);
        in_order(&mut gathered.coherences, |entry| entry)?;
        let usable = notes.of_ordinates(std::mem::take(&mut gathered.frfs), options)?;
        if usable.is_empty() {
            return Err(not_on_fixture(&gathered, fixture));
        }
        notes.of_lone_coherences(&usable, &gathered.coherences);
        let mut of_coherence = CoherenceNotes::default();
        let levels = levels(&usable, &gathered.coherences, options, &mut of_coherence)?;
        notes.texts.extend(of_coherence.into_texts());
        notes.texts.extend(completeness::of_frfs(sources));
        Ok(Recording {
            levels,
            time_histories: TimeHistories {
                count: gathered.time_histories.len(),
                channels: distinct(&gathered.time_histories),
            },
            notes: notes.texts,
        })
    }

    /// The FRFs of a test at one level.
    ///
    /// # Errors
    /// [`RecordingError::SeveralLevels`].
    pub fn frfs(&self) -> Result<&FrfSet, RecordingError> {
        self.level().map(|level| &level.frfs)
    }

    /// The one level of a test.
    ///
    /// # Errors
    /// [`RecordingError::SeveralLevels`].
    pub fn level(&self) -> Result<&Level, RecordingError> {
        match self.levels.as_slice() {
            [level] => Ok(level),
            levels => Err(RecordingError::SeveralLevels {
                count: levels.len(),
                levels: enumeration(levels.iter().map(|level| match level.held {
                    Some(held) => held.to_string(),
                    None => "none stated".to_owned(),
                })),
            }),
        }
    }
}

/// An FRF whose ordinates are understood.
type Usable<'a> = (Entry<'a>, Ordinate);

/// Sentences about the files.
#[derive(Default)]
struct Notes {
    texts: Vec<String>,
}

impl Notes {
    fn of_what_is_left_out(&mut self, gathered: &Gathered) {
        let mut say = |names: &[String], what: &str| {
            if !names.is_empty() {
                let mut names = names.to_vec();
                names.sort();
                self.texts.push(format!("{} {what}: {}", with_count(names.len(), "FRF"), enumeration(names)));
            }
        };
        say(&gathered.elsewhere, "at nodes that the fixture does not have left out");
        say(&gathered.other_directions, "in directions other than y and theta left out");
        if !gathered.scalars.is_empty() {
            let nodes = enumeration(&gathered.scalars);
            self.texts.push(format!("no direction is stated for nodes {nodes}: +y taken"));
        }
        if !gathered.others.is_empty() {
            let types =
                gathered.others.iter().map(|(code, count)| format!("{count} of function type {code}"));
            self.texts.push(format!("functions that are no FRFs left out: {}", enumeration(types)));
        }
        if !gathered.time_histories.is_empty() {
            let count = gathered.time_histories.len();
            self.texts.push(format!("{count} time histories left aside: the files hold FRFs"));
        }
    }

    /// Form and units of every FRF; those that are no motion per force are left out.
    fn of_ordinates<'a>(
        &mut self,
        frfs: Vec<Entry<'a>>,
        options: &ReadOptions,
    ) -> Result<Vec<Usable<'a>>, RecordingError> {
        let mut units = UnitNotes::default();
        let mut other_quantities = Vec::new();
        let mut first_other = None;
        let mut usable = Vec::with_capacity(frfs.len());
        for entry in frfs {
            let function = entry.function;
            let named = (function.source, function.dataset);
            match ordinate(named, options.assume_units.as_ref(), &mut units)
                .map_err(|problem| RecordingError::function(function.place(), problem))?
            {
                Ok(ordinate) => usable.push((entry, ordinate)),
                Err(other) => {
                    other_quantities.push(entry.pair.to_string());
                    first_other.get_or_insert(RecordingError::NotPerForce {
                        place: function.place(),
                        numerator: other.numerator,
                        denominator: other.denominator,
                    });
                }
            }
        }
        if let (true, Some(error)) = (usable.is_empty(), first_other) {
            return Err(error);
        }
        if !other_quantities.is_empty() {
            other_quantities.sort();
            let (count, names) =
                (with_count(other_quantities.len(), "function"), enumeration(other_quantities));
            self.texts.push(format!("{count} of type FRF, but no motion per force, left out: {names}"));
        }
        self.texts.extend(units.into_texts(options.assume_units.as_ref()));
        in_order(&mut usable, |(entry, _)| entry)?;
        Ok(usable)
    }

    fn of_lone_coherences(&mut self, frfs: &[Usable], coherences: &[Entry]) {
        let lone: Vec<String> = coherences
            .iter()
            .filter(|coherence| !frfs.iter().any(|(frf, _)| frf.is_of(coherence)))
            .map(|coherence| coherence.pair.to_string())
            .collect();
        if !lone.is_empty() {
            self.texts.push(format!("coherences without their FRF left out: {}", enumeration(lone)));
        }
    }
}

fn distinct(channels: &[FileChannel]) -> Vec<FileChannel> {
    channels.iter().copied().collect::<BTreeSet<_>>().into_iter().collect()
}

fn without_frfs(sources: &[Source], gathered: &Gathered) -> RecordingError {
    let files = match sources {
        [] => "no files".to_owned(),
        _ => enumeration(sources.iter().map(|source| &source.name)),
    };
    let only_histories = gathered.others.is_empty() && gathered.channels.is_empty();
    if !gathered.time_histories.is_empty() && only_histories {
        return RecordingError::OnlyTimeHistories {
            files,
            count: gathered.time_histories.len(),
            forces: functions(sources).any(|function| may_be_force(&function.dataset.ordinate_axis)),
            channels: distinct(&gathered.time_histories),
        };
    }
    RecordingError::NoFrf { files, found: Contents::of(sources).phrase() }
}

fn not_on_fixture(gathered: &Gathered, fixture: &Fixture) -> RecordingError {
    RecordingError::NotOnFixture {
        nodes: enumeration(&gathered.channels),
        points: points(Some(fixture)),
        example: example(&gathered.channels, Some(fixture)),
    }
}

/// One set of FRFs for each run of equal levels.
fn levels(
    frfs: &[Usable],
    coherences: &[Entry],
    options: &ReadOptions,
    notes: &mut CoherenceNotes,
) -> Result<Vec<Level>, RecordingError> {
    let mut cache = LinesCache::default();
    frfs.chunk_by(|(a, _), (b, _)| a.level == b.level)
        .map(|frfs| level(frfs, coherences, &mut cache, (options, &mut *notes)))
        .collect()
}

/// What the largest value of a set and each of its FRFs must lie between, (m/s²)/N or the like of rotations:
/// ten decades beyond the heaviest and the lightest of structures.
const MAGNITUDES: [f64; 2] = [1e-30, 1e20];

fn level<'a>(
    frfs: &[Usable<'a>],
    coherences: &[Entry<'a>],
    cache: &mut LinesCache<'a>,
    (options, notes): (&ReadOptions, &mut CoherenceNotes),
) -> Result<Level, RecordingError> {
    let first = &frfs[0].0;
    let entries: Vec<&Entry> = frfs.iter().map(|(entry, _)| entry).collect();
    let (lines, parts) = common_lines(&entries, cache)?;
    let mut values = Vec::with_capacity(frfs.len() * lines.len());
    let window_decay = decay_of(first)?;
    for ((entry, ordinate), part) in frfs.iter().zip(&parts) {
        let decay = decay_of(entry)?;
        if decay != window_decay {
            return Err(RecordingError::Windows {
                first: first.function.place(),
                first_decay: window_decay,
                second: entry.function.place(),
                second_decay: decay,
            });
        }
        let recorded = entry.function.complex().map_err(|problem| entry.refuse(problem))?;
        values.resize(values.len() + part.start, Complex64::ZERO);
        append_accelerances(&mut values, recorded, ordinate.form, entry.sign * ordinate.si, &part.lines);
        values.resize(values.len() + part.beyond, Complex64::ZERO);
    }
    let largest = |values: &[Complex64]| values.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let silent = largest(&values) < MAGNITUDES[0];
    for ((entry, _), own) in frfs.iter().zip(values.chunks(lines.len())) {
        let largest = largest(own).min(f64::MAX);
        if largest > MAGNITUDES[1] || (silent && largest > 0.0) {
            return Err(entry.refuse(FunctionError::Magnitude(largest)));
        }
    }
    let pairs = frfs.iter().map(|(entry, _)| entry.pair.clone()).collect();
    let mut set = FrfSet::new(lines.clone(), FrfForm::Accelerance, pairs, values)?;
    for (index, ((entry, _), part)) in frfs.iter().zip(&parts).enumerate() {
        let mut averages = entry.function.averages().map_err(|problem| entry.refuse(problem))?;
        if let Some(coherence) = entry.counterpart(coherences).filter(|_| !options.ignore_coherence) {
            let found = lines_of(coherence, cache)?;
            let start = found.place_of(&part.lines);
            let start = start.ok_or_else(|| on_other_lines((entry, &part.lines), (coherence, &found)))?;
            let values = coherence.function.coherence().map_err(|problem| coherence.refuse(problem))?;
            if let Some(values) = notes.usable(entry.pair.to_string(), values) {
                // Of other than as many values as lines the set refuses them.
                let of_frf = values.get(start..start + part.lines.len()).unwrap_or(&values);
                set.set_coherence(index, part.over_all_lines(of_frf))?;
            }
            if averages.is_none() {
                averages = coherence.function.averages().map_err(|problem| coherence.refuse(problem))?;
            }
        }
        set.set_averages(index, options.averages.or(averages));
    }
    let recorded_forms = frfs.iter().map(|(_, ordinate)| ordinate.form).collect();
    Ok(Level { held: first.level, frfs: set, recorded_forms, window_decay })
}

fn decay_of(entry: &Entry) -> Result<f64, RecordingError> {
    entry.function.window_decay().map_err(|problem| entry.refuse(problem))
}
