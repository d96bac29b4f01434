//! The way from a measurement to an answer.

use crate::homogeneity::Homogeneity;
use crate::{Answer, Error, MeasuredFrfs, Measurement, Options, hits, levels};
use jointscope_diagnosis::{Diagnosis, DiagnosisOptions, Step, Watch, with_idle_points_exact};
use jointscope_fixture::{Damping, Fixture, JointLaw, Quantity, RatiosOf, Spread};
use jointscope_lumped::Assembly;
use jointscope_screening::plausible;

/// Damping ratio from which that of a fixture without any is sought.
const RATIO: f64 = 0.005;
/// Modes that have one of their own, at the most.
const MODES: usize = 12;

/// The fixture, with damping ratios of which nothing is known where it has no damping at all: nothing that
/// was recorded has none.
fn damped(fixture: Fixture, measured: &mut MeasuredFrfs) -> Result<Fixture, Error> {
    let of_supports =
        fixture.supports().iter().any(|s| s.damping.is_some() || s.rotational_damping.is_some());
    let of_joints = fixture
        .joints()
        .iter()
        .any(|joint| matches!(joint.law, JointLaw::Stiffness { damping: Some(_), .. }));
    if *fixture.damping() != Damping::Undamped || of_supports || of_joints {
        return Ok(fixture);
    }
    let hz = measured.frfs.lines().hz();
    let highest = hz[hz.len() - 1];
    let with = |count: usize| {
        let ratios = vec![Quantity { value: RATIO, spread: Spread::Unknown }; count];
        fixture.clone().with_damping(Damping::ModalRatios { ratios, of: RatiosOf::AsItStands })
    };
    let Ok(assembly) = Assembly::new(&with(1)?, highest) else { return Ok(fixture) };
    let frequencies = assembly.natural_frequencies_hz();
    let shown = assembly.elastic_modes().iter().filter(|r| frequencies[**r] <= highest).count();
    measured.notes.push(
        "the fixture states no damping: ratios of its modes were fitted without knowing anything of them; state `damping`, or measure it with `jointscope modes`"
            .to_owned(),
    );
    Ok(with(shown.clamp(1, MODES))?)
}

/// How far a diagnosis has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Progress<'a> {
    /// The FRFs are known, and the search for effects begins.
    Searching {
        /// Number of FRFs.
        frfs: usize,
        /// Number of spectral lines.
        lines: usize,
    },
    /// What the search is doing.
    Searched(Step<'a>),
}

/// Finds what `fixture` leaves out of `measurement`; `progress` is called as it comes along, from any thread.
///
/// # Errors
/// See [`Error`]; [`Error::concern`] says which of the inputs is at fault.
pub fn diagnose(
    fixture: &Fixture,
    measurement: &Measurement,
    options: &Options,
    progress: impl Fn(Progress) + Sync,
) -> Result<Answer, Error> {
    if !options.as_stated {
        plausible(fixture)?;
    }
    let homogeneity = match measurement {
        Measurement::Frfs(recording) => levels::homogeneity(fixture, recording, options)?,
        Measurement::Hits(hits) => hits::homogeneity(fixture, hits, options)?,
    };
    let (measured, homogeneity) = match homogeneity {
        Homogeneity::Changes(mut answer) => {
            answer.notes.extend(options.unheeded_where_amplitude_matters());
            return Ok(*answer);
        }
        Homogeneity::Linear(measured, p_value) => (*measured, p_value),
    };
    // Before anything is said of the fixture's numbers: on a few lines they look like any others.
    options.check(&measured.frfs)?;
    let mut measured =
        if options.as_stated { measured.screened(fixture)? } else { measured.plausible(fixture)? };
    let fixture = measured.as_recorded(fixture)?;
    let fixture = damped(fixture, &mut measured)?;
    let frfs = &measured.frfs;
    options.check(frfs)?;
    progress(Progress::Searching { frfs: frfs.pairs().len(), lines: frfs.lines().len() });
    let step_taken = |step: Step| progress(Progress::Searched(step));
    let searched = with_idle_points_exact(fixture.clone(), frfs.pairs());
    let asked = DiagnosisOptions { estimated: measured.hammer_test.is_some(), ..options.diagnosis.clone() };
    let diagnosis = Diagnosis::watched(&searched, frfs, &asked, Watch::by(&step_taken))?;
    Answer::linear(fixture, diagnosis, homogeneity, measured)
}
