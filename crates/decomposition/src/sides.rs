//! The two sides of a joint: which points and bodies are on which.

use crate::Compliances;
use jointscope_fixture::{Effect, Entry, Fixture, Place};
use jointscope_linalg::{ComplexMatrix2, Matrix2};
use jointscope_lumped::{LumpedError, Model, Station, window_decay};
use jointscope_spectra::SpectralLines;
use num_complex::Complex64;

/// Why a fixture cannot be taken apart at a joint.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SidesError {
    /// No joint was named and there is not exactly one.
    #[error("the fixture has {} joints ({}): choose one with --joint", names.len(), names.join(", "))]
    WhichJoint {
        /// The joints there are.
        names: Vec<String>,
    },
    /// There is no such joint.
    #[error("the fixture has no joint `{name}`; choose one of {} with --joint", names.join(", "))]
    NoSuchJoint {
        /// The name asked for.
        name: String,
        /// The joints there are.
        names: Vec<String>,
    },
    /// The fixture has no joint at all.
    #[error("the fixture has no joint to find; state the one that is looked for under `joints`")]
    NoJoint,
    /// The assembly stays in one piece without the joint.
    #[error(
        "without joint `{0}` the assembly still holds together through its other joints, so it has no two sides to be taken apart into; only a fit to all FRFs finds it"
    )]
    Loop(String),
    /// An effect of the measuring chain that cannot be taken out of FRFs.
    #[error(
        "physics/{index}: `{kind}` cannot be taken out of measured FRFs; decompose needs recordings without it"
    )]
    Instrument {
        /// Position in the fixture's `physics`.
        index: usize,
        /// The effect's name.
        kind: &'static str,
    },
}

/// The fixture taken apart at one joint: side α with the joint's `from`, side β with its `to`.
#[derive(Debug, Clone)]
pub struct Sides {
    fixture: Fixture,
    joint: usize,
    on_alpha: Vec<bool>,
    alpha: Fixture,
    beta: Fixture,
    decay: f64,
}

impl Sides {
    /// Takes the fixture apart at the joint named, or at its only one.
    ///
    /// Effects of the fixture's `physics` that sit on a side stay with it; those of the joint itself are part
    /// of what is to be found. An `exponential_window` says at which s = decay + iω the FRFs were read.
    ///
    /// # Errors
    /// See [`SidesError`].
    pub fn of(fixture: &Fixture, joint: Option<&str>) -> Result<Self, SidesError> {
        let names = || fixture.joints().iter().map(|j| j.name.clone()).collect::<Vec<_>>();
        let joint = match joint {
            _ if fixture.joints().is_empty() => return Err(SidesError::NoJoint),
            Some(name) => fixture
                .joints()
                .iter()
                .position(|j| j.name == name)
                .ok_or_else(|| SidesError::NoSuchJoint { name: name.to_string(), names: names() })?,
            None if fixture.joints().len() == 1 => 0,
            None => return Err(SidesError::WhichJoint { names: names() }),
        };
        check_instruments(fixture)?;
        let on_alpha = connected(fixture, joint);
        let far_body = fixture.points()[fixture.joints()[joint].to].body;
        if on_alpha[far_body] {
            return Err(SidesError::Loop(fixture.joints()[joint].name.clone()));
        }
        let side = |alpha: bool| with_its_effects(fixture, joint, &|body| on_alpha[body] == alpha);
        let decay = window_decay(fixture);
        Ok(Sides { alpha: side(true), beta: side(false), fixture: fixture.clone(), joint, on_alpha, decay })
    }

    /// The whole fixture.
    pub fn fixture(&self) -> &Fixture {
        &self.fixture
    }

    /// The joint that is looked for.
    pub fn joint(&self) -> &jointscope_fixture::Joint {
        &self.fixture.joints()[self.joint]
    }

    /// Whether a body (its index in the whole fixture) belongs to side α.
    pub(crate) fn is_on_alpha(&self, body: usize) -> bool {
        self.on_alpha[body]
    }

    /// The joint's length L, m.
    pub fn length(&self) -> f64 {
        self.fixture.joint_length(self.joint())
    }

    /// Decay δ of the exponential window over force and responses, 1/s; 0 without one. FRFs, sides and joint
    /// hold at s = δ + iω.
    pub fn decay(&self) -> f64 {
        self.decay
    }

    /// s = δ + iω on a line of `omega` rad/s.
    pub(crate) fn s(&self, omega: f64) -> Complex64 {
        Complex64::new(self.decay, omega)
    }

    /// −ω²/s², by which a receptance is multiplied that was made of an accelerance by −1/ω²: under a window
    /// an accelerance is s²H(s).
    pub(crate) fn integrated_at_s(&self, omega: f64) -> Complex64 {
        if self.decay == 0.0 { Complex64::ONE } else { -(omega * omega) / self.s(omega).powi(2) }
    }

    /// Compliances of the sides on `lines`, all above 0 Hz (eq 8–12), at s = δ + iω. `loaded` and
    /// `responding` are (body index in the whole fixture, abscissa) of the reference points on sides α and β.
    ///
    /// A line at 0 Hz has no compliance; its matrices are zero.
    ///
    /// # Errors
    /// A side that cannot be modelled, or an undamped resonance of a side on a line.
    pub fn compliances(
        &self,
        lines: &SpectralLines,
        loaded: (usize, f64),
        responding: (usize, f64),
    ) -> Result<Compliances, LumpedError> {
        let joint = self.joint();
        let [near, far] = [joint.from, joint.to].map(|p| &self.fixture.points()[p]);
        let highest = lines.hz()[lines.len() - 1];
        let alpha = Model::new(&self.alpha, highest)?;
        let beta = Model::new(&self.beta, highest)?;
        let at = |body: usize, x: f64| Station::both(self.index_on_side(body), x);
        let [near_end, far_end] = [near, far].map(|p| at(p.body, p.x.value));
        let (loads, motion) = (at(loaded.0, loaded.1), at(responding.0, responding.1));
        Ok(Compliances {
            alpha21: self.matrices(&alpha, near_end, loads, lines)?,
            alpha22: self.matrices(&alpha, near_end, near_end, lines)?,
            beta33: self.matrices(&beta, far_end, far_end, lines)?,
            beta43: self.matrices(&beta, motion, far_end, lines)?,
            length: self.length(),
        })
    }

    /// Side α (or β) as a fixture of its own.
    pub(crate) fn side(&self, alpha: bool) -> &Fixture {
        if alpha { &self.alpha } else { &self.beta }
    }

    /// Place of the joint among the whole fixture's.
    pub(crate) fn joint_index(&self) -> usize {
        self.joint
    }

    /// Index of a body within its side.
    fn index_on_side(&self, body: usize) -> usize {
        (0..body).filter(|&other| self.on_alpha[other] == self.on_alpha[body]).count()
    }

    fn matrices(
        &self,
        model: &Model,
        outputs: [Station; 2],
        inputs: [Station; 2],
        lines: &SpectralLines,
    ) -> Result<Vec<ComplexMatrix2>, LumpedError> {
        let hz = lines.hz();
        // Lines ascend: only the first can be at 0 Hz.
        let skipped = usize::from(hz[0] == 0.0);
        let s: Vec<Complex64> = lines.omegas().skip(skipped).map(|omega| self.s(omega)).collect();
        let n = s.len();
        let mut values = vec![Complex64::ZERO; 4 * n];
        model
            .receptances(&outputs, &inputs)
            .on_lines(&s, &mut values)
            .map_err(|line| LumpedError::Unbounded { frequency: hz[skipped + line] })?;
        let at = |line: usize| {
            Matrix2::new(values[line], values[n + line], values[2 * n + line], values[3 * n + line])
        };
        let mut matrices = vec![Matrix2::zero(); skipped];
        matrices.extend((0..n).map(at));
        Ok(matrices)
    }
}

/// The bodies reached from the joint's near end without crossing it.
fn connected(fixture: &Fixture, joint: usize) -> Vec<bool> {
    let body = |point: usize| fixture.points()[point].body;
    let mut reached = vec![false; fixture.bodies().len()];
    reached[body(fixture.joints()[joint].from)] = true;
    loop {
        let mut grew = false;
        for (_, other) in fixture.joints().iter().enumerate().filter(|(i, _)| *i != joint) {
            let (a, b) = (body(other.from), body(other.to));
            if reached[a] != reached[b] {
                (reached[a], reached[b], grew) = (true, true, true);
            }
        }
        if !grew {
            return reached;
        }
    }
}

fn with_its_effects(fixture: &Fixture, joint: usize, keep: &dyn Fn(usize) -> bool) -> Fixture {
    with_effects_of(fixture, fixture.part(keep, &[joint]))
}

/// A part of a fixture with those of the fixture's effects that sit on it.
pub(crate) fn with_effects_of(fixture: &Fixture, side: Fixture) -> Fixture {
    let own = |effect: &&Effect| match &effect.place {
        Place::Body(name) => side.body(name).is_some(),
        Place::Joint(name) => side.joint(name).is_some(),
        Place::Point(name) => {
            let ends = side.joints().iter().flat_map(|j| [j.from, j.to]);
            let at_a_joint = ends.map(|p| &side.points()[p].name).any(|end| end == name);
            effect.kind.spec().entry == Entry::InSeries && at_a_joint
        }
        Place::Between(one, other) => side.body(one).is_some() && side.body(other).is_some(),
        _ => false,
    };
    let effects = fixture.physics().iter().filter(own).cloned().collect();
    // An effect that was possible in the whole is possible on its side.
    side.clone().with_physics(effects).unwrap_or(side)
}

pub(crate) fn check_instruments(fixture: &Fixture) -> Result<(), SidesError> {
    let cannot = |e: &Effect| e.kind.is_instrumental() && e.kind.spec().entry != Entry::Window;
    let found = fixture.physics().iter().enumerate().find(|(_, e)| cannot(e));
    found.map_or(Ok(()), |(index, effect)| Err(SidesError::Instrument { index, kind: effect.kind.name() }))
}
