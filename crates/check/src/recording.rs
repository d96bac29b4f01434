//! What a test of the fixture recorded.

use crate::channels::{self, ChannelCheck};
use crate::driving_point::{self, DrivingPoint, DrivingPointVerdict};
use crate::reciprocity::{self, Reciprocity};
use crate::recorded_modes::{self, RecordedModes};
use crate::settings::contradictions::AT_START;
use crate::settings::drawn::ASSUMED_RATIO;
use crate::settings::frfs::MANY_POOR_LINES;
use crate::settings::work::MOST_VALUES;
use crate::{CheckOptions, FrfCheck, MassLine, ModelModes, Remark, Totals, frfs, has_dashpots, mass_line};
use jointscope_diagnosis::{OddRecord, contradictory_lines, restored};
use jointscope_fixture::{Damping, Effect, Fixture, Quantity, RatiosOf};
use jointscope_frf::noise::with_variances;
use jointscope_lumped::{Instrument, accelerances};
use jointscope_pipeline::{Error, MeasuredFrfs, Measurement};
use jointscope_screening::{Oddity, Screened, screened};
use jointscope_spectra::{FrfForm, FrfSet, in_sentence, in_text};
use jointscope_wording::Says;
use num_complex::Complex64;
use serde::Serialize;

/// A recording, as it is beside its fixture.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RecordingCheck {
    /// What the files themselves say, one sentence each.
    pub notes: Vec<String>,
    /// First and last line, Hz, and their number.
    pub lines: (f64, f64, usize),
    /// Points of the fixture at which nothing was recorded.
    pub without_recording: Vec<String>,
    /// FRF by FRF.
    pub frfs: Vec<FrfCheck>,
    /// Channel by channel.
    pub channels: Vec<ChannelCheck>,
    /// Driving points.
    pub driving_points: Vec<DrivingPoint>,
    /// Reciprocal pairs.
    pub reciprocity: Vec<Reciprocity>,
    /// The mass line; `None` with a sentence where there is none.
    pub mass_line: Option<MassLine>,
    /// Why there is no mass line.
    pub no_mass_line: Option<String>,
    /// Modes side by side.
    pub modes: Option<RecordedModes>,
    /// Why there are none.
    pub no_modes: Option<String>,
    /// √(Σ|Ĥ − H|²/Σ|H|²) over all FRFs; `None` where the fixture has no FRFs.
    pub nrmse: Option<f64>,
    /// The FRFs as they are meant, with variances.
    #[serde(skip)]
    pub measured: FrfSet,
    /// The same, channels that point the other way turned round: for modes and mass line.
    #[serde(skip)]
    upright: FrfSet,
    /// Decay of the exponential window over force and responses, 1/s; 0 without one.
    #[serde(skip)]
    window_decay: f64,
    /// Bands of lines that contradict all others, Hz.
    #[serde(skip)]
    contradictory: Vec<(f64, f64)>,
    /// The fixture's, FRF after FRF.
    #[serde(skip)]
    pub modelled: Option<Vec<Complex64>>,
}

impl RecordingCheck {
    pub(crate) fn of(
        fixture: &Fixture,
        measurement: &Measurement,
        options: &CheckOptions,
        remarks: &mut Vec<Remark>,
    ) -> Result<Self, Error> {
        let (measured, screened) =
            with_force_as_meant(at_one_level(measurement, options)?, fixture, remarks)?;
        remarks.extend(screened.oddities.iter().map(of_oddity));
        let recorded = match restored(&screened.frfs) {
            Some((restored, end)) => {
                remarks.push(Remark::odd("recording", end.says()));
                restored
            }
            None => screened.frfs,
        };
        let with_own_effects = fixture;
        let fixture = &drawn(measured.as_recorded(fixture)?);
        let (measured_frfs, sources) = match with_variances(&recorded) {
            Ok(found) => found,
            Err(_) => (recorded.clone(), Vec::new()),
        };
        let modelled =
            accelerances(fixture, measured_frfs.pairs(), measured_frfs.lines(), Instrument::AsRecorded)
                .map_err(|error| {
                    let says = format!("it has no FRFs to lay beside the recording's: {error}");
                    remarks.push(Remark::wrong("fixture", says));
                })
                .ok();
        let frfs = frfs::of(&measured_frfs, &sources, modelled.as_deref());
        remarks.extend(of_absurd_values(&measured_frfs));
        let channels = channels::of(&frfs, remarks);
        let multiples: Option<Vec<f64>> =
            frfs.iter().map(|frf| Some(frf.level? * frf.sign?.signum())).collect();
        let odd = multiples.and_then(|multiples| OddRecord::among(measured_frfs.pairs(), &multiples));
        // A channel that is turned round is told as one.
        let odd = odd.filter(|odd| odd.factor > 0.0 || !channels.iter().any(|own| own.turned));
        remarks.extend(odd.as_ref().map(of_odd_record));
        let driving_points = driving_point::of(&measured_frfs, measured.window_decay);
        remarks.extend(driving_points.iter().filter_map(of_driving_point));
        let reciprocity = reciprocity::of(&measured_frfs);
        remarks.extend(reciprocity.iter().filter(|pair| pair.odd).map(of_reciprocity));
        let window_decay = measured.window_decay;
        let mut notes = measured.notes;
        if with_own_effects.physics().iter().any(|effect| effect.kind.is_nonlinear()) {
            notes.push("effects of the fixture that depend on amplitude have no FRF: they are left aside beside the recording's".to_owned());
        }
        let contradictory = contradictory(fixture, &recorded, &mut notes);
        remarks.extend(frfs.iter().filter_map(of_coherence));
        let hz = measured_frfs.lines().hz();
        Ok(RecordingCheck {
            notes,
            lines: (hz[0], hz[hz.len() - 1], hz.len()),
            without_recording: without_recording(fixture, &measured_frfs),
            nrmse: modelled
                .as_deref()
                .and_then(|modelled| crate::frfs::nrmse(measured_frfs.all_values(), modelled)),
            frfs,
            driving_points,
            reciprocity,
            mass_line: None,
            no_mass_line: None,
            modes: None,
            no_modes: None,
            upright: upright(&measured_frfs, &channels),
            window_decay,
            channels,
            contradictory,
            measured: measured_frfs,
            modelled,
        })
    }

    /// The fixture's FRFs on the lines of the recording, where it has any.
    pub fn fixture_frfs(&self) -> Option<FrfSet> {
        set_like(&self.measured, self.modelled.clone()?)
    }

    /// The last line, Hz.
    pub(crate) fn highest(&self) -> f64 {
        self.lines.1
    }

    /// What is to be said of lines that contradict all others.
    pub(crate) fn contradictions(
        &self,
        fixture: &Fixture,
        modes: Option<&ModelModes>,
        remarks: &mut Vec<Remark>,
    ) {
        let bending = modes.and_then(ModelModes::first_elastic).unwrap_or(0.0);
        let (first, last, count) = self.lines;
        let start = first + AT_START * (last - first) / count.saturating_sub(1).max(1) as f64;
        for &(from, to) in &self.contradictory {
            let suspended = fixture.supports().is_empty() && from <= start && to < bending;
            remarks.push(of_contradiction(from, to, suspended));
        }
    }

    /// Holds the recording's modes and mass line against the fixture's.
    pub(crate) fn compare(
        &mut self,
        fixture: &Fixture,
        totals: &Totals,
        modes: &ModelModes,
        remarks: &mut Vec<Remark>,
    ) {
        if let Some(first) = modes.first_elastic().filter(|first| *first > self.lines.1) {
            remarks.push(Remark::odd(
                "recording",
                format!(
                    "its lines end at {} Hz, below the first mode in which the fixture bends, at {} Hz: record farther, or correct the fixture",
                    in_text(self.lines.1),
                    in_sentence(first)
                ),
            ));
        }
        (self.modes, self.no_modes) =
            split(recorded_modes::of(&drawn(fixture.clone()), (&self.upright, self.window_decay), modes));
        let found = match &self.modelled {
            Some(modelled) => {
                mass_line::of(fixture, &self.upright, modelled, totals, modes, self.modes.as_ref())
            }
            None => Err("the fixture has no FRFs".to_owned()),
        };
        (self.mass_line, self.no_mass_line) = split(found);
        let Some(line) = &self.mass_line else { return };
        if let (true, Some(mass)) = (line.odd, line.mass) {
            remarks.push(Remark::odd(
                "mass line",
                format!(
                    "from {} to {} Hz the recording weighs {:.3} kg ± {:.3} kg, the fixture {:.3} kg ({:.2} times as much): the calibration of force or sensors, or mass that the fixture lacks or has too much of",
                    in_sentence(line.band.0),
                    in_sentence(line.band.1),
                    mass.value,
                    mass.std.unwrap_or(0.0),
                    totals.mass.value,
                    totals.mass.value / mass.value
                ),
            ));
        }
        // All of them together are the mass; some of them are channels or points.
        let odd: Vec<String> =
            line.frfs.iter().filter(|frf| frf.odd).map(|frf| frf.frf.to_string()).collect();
        if !odd.is_empty() && !line.odd {
            remarks.push(Remark::odd(
                "mass line",
                format!(
                    "below the first bending mode FRFs {} are not those of the fixture as a rigid body: their points' abscissae, the centres of gravity, the inertias, or these channels' calibration",
                    odd.join(", ")
                ),
            ));
        }
    }
}

fn of_odd_record(odd: &OddRecord) -> Remark {
    let OddRecord { frf, factor, others: [least, largest] } = odd;
    let says = format!(
        "it is {factor:.3} times what the fixture makes of it, the other FRFs {least:.2} to {largest:.2} times: its unit, range or sign"
    );
    Remark::odd(frf.to_string(), says)
}

/// The fixture's FRFs beside measured accelerances, on their channels and lines, as a check draws them:
/// without effects that have none, and with some damping where it has none at all. `None` where the fixture
/// has no FRFs.
pub fn fixture_frfs(fixture: &Fixture, measured: &FrfSet) -> Option<FrfSet> {
    let drawn = drawn(fixture.clone());
    set_like(measured, accelerances(&drawn, measured.pairs(), measured.lines(), Instrument::AsRecorded).ok()?)
}

fn set_like(measured: &FrfSet, values: Vec<Complex64>) -> Option<FrfSet> {
    FrfSet::new(measured.lines().clone(), FrfForm::Accelerance, measured.pairs().to_vec(), values).ok()
}

/// The FRFs screened; turned round, with a remark, where next to all of them have the wrong sign.
fn with_force_as_meant(
    mut measured: MeasuredFrfs,
    fixture: &Fixture,
    remarks: &mut Vec<Remark>,
) -> Result<(MeasuredFrfs, Screened), Error> {
    let mut screened = self::screened(measured.frfs.clone(), fixture)?;
    // A receptance that is called an accelerance has the opposite sign as well.
    let of_another_form = screened.oddities.iter().any(|oddity| matches!(oddity, Oddity::Form(_)));
    if !of_another_form && is_turned(&measured.frfs, fixture) {
        // FRFs of the wrong sign are like none of the fixture's, and labels would be looked for that suit
        // them better.
        measured.frfs = measured.frfs.with_values(|_, value| -value);
        screened = self::screened(measured.frfs.clone(), fixture)?;
        remarks.push(Remark::wrong(
            "force",
            "next to all FRFs have the opposite sign to the fixture's: the force is recorded the other way round; turn it with --map, or in the file (for all that follows here it is turned)",
        ));
    }
    Ok((measured, screened))
}

/// Bands of lines that contradict all others, where there are few enough to look for them.
fn contradictory(fixture: &Fixture, frfs: &FrfSet, notes: &mut Vec<String>) -> Vec<(f64, f64)> {
    if frfs.all_values().len() > MOST_VALUES {
        notes.push("there are too many FRFs and lines for a quick look at lines that contradict all others: `jointscope diagnose` takes its time".to_owned());
        return Vec::new();
    }
    contradictory_lines(fixture, frfs).unwrap_or_default()
}

/// Points of the fixture at which nothing was recorded, but for those that joints and supports are at.
fn without_recording(fixture: &Fixture, measured: &FrfSet) -> Vec<String> {
    let is_recorded = |name: &str| {
        let mut pairs = measured.pairs().iter();
        pairs.any(|pair| pair.response.point == name || pair.reference.point == name)
    };
    let held: Vec<usize> = fixture.held_points().collect();
    let points = fixture.points().iter().enumerate();
    let without = points.filter(|(index, point)| !is_recorded(&point.name) && !held.contains(index));
    without.map(|(_, point)| point.name.clone()).collect()
}

/// Whether next to all FRFs have the opposite sign to the fixture's.
fn is_turned(measured: &FrfSet, fixture: &Fixture) -> bool {
    let modelled =
        accelerances(&drawn(fixture.clone()), measured.pairs(), measured.lines(), Instrument::AsRecorded);
    modelled.is_ok_and(|modelled| channels::all_turned(&frfs::of(measured, &[], Some(&modelled))))
}

/// The FRFs at one level, the first where there are several.
fn at_one_level(measurement: &Measurement, options: &CheckOptions) -> Result<MeasuredFrfs, Error> {
    let Measurement::Frfs(recording) = measurement else {
        return MeasuredFrfs::of(measurement, &options.estimate);
    };
    let count = recording.levels.len();
    if count < 2 {
        return MeasuredFrfs::of(measurement, &options.estimate);
    }
    let mut first = recording.clone();
    first.levels.truncate(1);
    let mut measured = MeasuredFrfs::of(&Measurement::Frfs(first), &options.estimate)?;
    measured.notes.push(format!(
        "the files hold FRFs at {count} levels: those of the first are looked at here; `jointscope diagnose` says whether anything depends on amplitude"
    ));
    Ok(measured)
}

/// The fixture as its FRFs are drawn: without effects that have none, and with some damping where it has none
/// at all, for resonances without any have no height to compare.
fn drawn(fixture: Fixture) -> Fixture {
    let linear: Vec<Effect> =
        fixture.physics().iter().filter(|effect| !effect.kind.is_nonlinear()).cloned().collect();
    let fixture = match linear.len() == fixture.physics().len() {
        true => fixture,
        false => fixture.clone().with_physics(linear).unwrap_or(fixture),
    };
    if *fixture.damping() != Damping::Undamped || has_dashpots(&fixture) {
        return fixture;
    }
    let ratios =
        Damping::ModalRatios { ratios: vec![Quantity::bare(ASSUMED_RATIO)], of: RatiosOf::AsItStands };
    fixture.clone().with_damping(ratios).unwrap_or(fixture)
}

/// The FRFs with the channels turned round that point the other way.
fn upright(measured: &FrfSet, channels: &[ChannelCheck]) -> FrfSet {
    let turned = |name: String| channels.iter().any(|channel| channel.turned && channel.channel == name);
    let signs: Vec<f64> = measured
        .pairs()
        .iter()
        .map(|pair| {
            let response = turned(format!("response {}", pair.response));
            if response != turned(format!("reference {}", pair.reference)) { -1.0 } else { 1.0 }
        })
        .collect();
    let count = measured.lines().len();
    measured.clone().with_values(|at, value| value * signs[at / count])
}

fn split<T>(found: Result<T, String>) -> (Option<T>, Option<String>) {
    match found {
        Ok(found) => (Some(found), None),
        Err(why) => (None, Some(why)),
    }
}

fn of_oddity(oddity: &Oddity) -> Remark {
    match oddity {
        Oddity::Unexcited { point, is_reference, .. } => {
            let kind = if *is_reference { "reference" } else { "response" };
            Remark::odd(format!("{kind} {point}"), oddity.to_string())
        }
        Oddity::Empty(_) => Remark::odd("recording", format!("{oddity} (here and in a diagnosis)")),
        Oddity::Masses(slip) => {
            let says = format!(
                "{}{}; correct it, or insist on it with `diagnose --as-stated`",
                slip.problem, slip.advice
            );
            Remark::wrong(slip.place.clone(), says)
        }
        oddity => Remark::wrong("recording", format!("{oddity} (here and in a diagnosis)")),
    }
}

fn of_absurd_values(measured: &FrfSet) -> impl Iterator<Item = Remark> {
    measured.pairs().iter().enumerate().filter_map(|(index, pair)| {
        let hz = in_text(frfs::absurd(measured, index)?);
        let says = format!("its value at {hz} Hz is more than a million times what the lines about it have: no structure has that; export it again, or leave that line out of a diagnosis with --exclude");
        Some(Remark::wrong(pair.to_string(), says))
    })
}

fn of_driving_point(point: &DrivingPoint) -> Option<Remark> {
    let share = 100.0 * point.negative;
    let says = match point.verdict {
        DrivingPointVerdict::Turned => format!(
            "a driving point that would give out power on {share:.0} % of its lines: sensor and hammer point opposite ways; turn one of them with --map, or correct the file"
        ),
        DrivingPointVerdict::Mixed => format!(
            "a driving point that would give out power on {share:.0} % of its lines: the sensor is not where the hammer strikes, or a delay or filter turns the phase of one channel"
        ),
        DrivingPointVerdict::Passive | DrivingPointVerdict::NotJudged => return None,
    };
    Some(Remark::odd(point.frf.to_string(), says))
}

fn of_reciprocity(pair: &Reciprocity) -> Remark {
    let level = match pair.level {
        level if !(0.9..=1.1).contains(&level) => {
            format!("; the first reads {level:.2} times the second, as a calibration would have it")
        }
        _ => String::new(),
    };
    Remark::odd(
        format!("{} and {}", pair.frf, pair.other),
        format!(
            "by reciprocity they are one FRF, but they are {:.0} % apart where noise makes {:.1} %{level}: a point hit beside its mark, a sensor whose mass roves, calibration, or something that is not linear",
            100.0 * pair.difference,
            100.0 * pair.expected
        ),
    )
}

/// Of a band; `suspended` where it could be that of a suspension.
fn of_contradiction(from: f64, to: f64, suspended: bool) -> Remark {
    let (from, to) = (in_text(from), in_text(to));
    let lines = if from == to {
        format!("the line at {from} Hz")
    } else {
        format!("the lines from {from} to {to} Hz")
    };
    match suspended {
        true => Remark::odd(
            "recording",
            format!(
                "{lines}, at the start and below the first bending mode, contradict all others, as drift, mains hum or a suspension that the fixture lacks does: state the suspension as `supports`, or start above it; a diagnosis leaves them out"
            ),
        ),
        false => Remark::wrong(
            "recording",
            format!(
                "{lines} contradict all others, as mains hum, clipped peaks or a tone from elsewhere do: a diagnosis leaves them out"
            ),
        ),
    }
}

fn of_coherence(frf: &FrfCheck) -> Option<Remark> {
    let coherence = frf.coherence.filter(|coherence| coherence.low > MANY_POOR_LINES)?;
    Some(Remark::odd(
        frf.frf.to_string(),
        format!(
            "its coherence is below 0.8 on {:.0} % of the lines (median {:.2}): more averages, a harder tip, or no double hits",
            100.0 * coherence.low,
            coherence.median
        ),
    ))
}
