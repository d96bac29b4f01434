//! The FRFs of a test at one level.

use crate::{Error, HammerTest, Measurement};
use jointscope_diagnosis::restored;
use jointscope_estimation::EstimateOptions;
use jointscope_fixture::{Effect, EffectKind, Fixture, FixtureError, Place};
use jointscope_recordings::{Hits, Recording};
use jointscope_screening::{Oddity, screened};
use jointscope_spectra::FrfSet;
use jointscope_wording::Says;

/// The FRFs of a test at one level, recorded as such or estimated from its hits.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredFrfs {
    /// The FRFs; those estimated are on the lines that the hammer excites.
    pub frfs: FrfSet,
    /// What a reader of the results should know, one plain sentence each.
    pub notes: Vec<String>,
    /// Decay δ of the exponential window that lies on the FRFs, 1/s; 0 without one.
    pub window_decay: f64,
    /// The hits, where the FRFs were estimated from them.
    pub hammer_test: Option<HammerTest>,
}

impl MeasuredFrfs {
    /// The FRFs of `measurement`: those recorded at its one level, or those estimated from its hits.
    ///
    /// # Errors
    /// FRFs at several levels; hits from which none can be estimated, or that excite no line.
    pub fn of(measurement: &Measurement, options: &EstimateOptions) -> Result<Self, Error> {
        match measurement {
            Measurement::Frfs(recording) => Self::recorded(recording),
            Measurement::Hits(hits) => Self::estimated(hits, options),
        }
    }

    pub(crate) fn recorded(recording: &Recording) -> Result<Self, Error> {
        let level = recording.level()?;
        let mut notes = recording.notes.clone();
        notes.extend(level.held.map(|held| {
            format!(
                "the FRFs are those of one level ({held}): whether anything depends on amplitude they cannot tell"
            )
        }));
        Ok(MeasuredFrfs {
            frfs: level.frfs.clone(),
            notes,
            window_decay: level.window_decay,
            hammer_test: None,
        })
    }

    pub(crate) fn estimated(hits: &Hits, options: &EstimateOptions) -> Result<Self, Error> {
        let test = HammerTest::of(&hits.hits, options)?;
        let frfs = test.estimate.usable().ok_or(Error::NothingExcited)?;
        let mut notes = hits.notes.clone();
        notes.push(test.says(&frfs, options.estimator));
        notes.extend(test.estimate.remarks.iter().map(Says::says));
        Ok(MeasuredFrfs { frfs, notes, window_decay: test.estimate.decay, hammer_test: Some(test) })
    }

    /// The same as the FRFs are meant: what slips of the test or its files made of them is put right or left
    /// out, and said in the notes.
    ///
    /// # Errors
    /// FRFs without any signal, or of which a part was changed.
    pub fn screened(self, fixture: &Fixture) -> Result<Self, Error> {
        self.put_right(fixture, |_| Ok(()))
    }

    /// As [`MeasuredFrfs::screened`], and masses of the fixture that the recording tells to be in another
    /// unit are refused.
    pub(crate) fn plausible(self, fixture: &Fixture) -> Result<Self, Error> {
        self.put_right(fixture, |oddities| {
            let slip = oddities.iter().find_map(|oddity| match oddity {
                Oddity::Masses(slip) => Some(slip.clone()),
                _ => None,
            });
            slip.map_or(Ok(()), |slip| Err(slip.into()))
        })
    }

    /// The same as if records had not ended before the structure was silent; said in the notes.
    pub(crate) fn restored(mut self) -> Self {
        if let Some((frfs, end)) = restored(&self.frfs) {
            self.notes.push(end.says());
            self.frfs = frfs;
        }
        self
    }

    fn put_right(
        mut self,
        fixture: &Fixture,
        judged: impl FnOnce(&[Oddity]) -> Result<(), Error>,
    ) -> Result<Self, Error> {
        let screened = screened(self.frfs, fixture)?;
        judged(&screened.oddities)?;
        self.notes.extend(screened.oddities.iter().map(ToString::to_string));
        self.frfs = screened.frfs;
        Ok(self)
    }

    /// `fixture` as these FRFs show it: under their exponential window, if there is one. The fixture's own
    /// effects stay.
    ///
    /// # Errors
    /// A window that the fixture cannot have beside its own effects.
    pub fn as_recorded(&self, fixture: &Fixture) -> Result<Fixture, FixtureError> {
        Self::under_window(fixture, self.window_decay)
    }

    /// `fixture` under an exponential window of this decay, 1/s; 0 without one.
    pub(crate) fn under_window(fixture: &Fixture, decay: f64) -> Result<Fixture, FixtureError> {
        if decay == 0.0 {
            return Ok(fixture.clone());
        }
        let mut physics = fixture.physics().to_vec();
        physics.push(Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[decay]));
        fixture.clone().with_physics(physics)
    }
}
