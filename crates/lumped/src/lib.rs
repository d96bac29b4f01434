//! The lumped model (SIM) of an assembly: bodies, joints, supports and effects, solved by modal sums.
//!
//! Bodies are rigid (y, θ about the centre of gravity), rigid without rotation (y alone) or Euler–Bernoulli
//! beams meshed with finite elements. Joints act on d = u_to − R·u_from. The dynamic stiffness of the free
//! assembly, Z(s) = s²M + sC + K with s = iω, is diagonal in its undamped modes whatever its proportional
//! damping, so its receptances are sums over modes: nothing is factorised per line. What is not proportional
//! (supports, dashpots, every effect of the fixture file) is a change of low rank, V Δ Vᵀ, and enters by the
//! Woodbury formula:
//!
//! H = G_oi − G_oV (I + Δ G_VV)⁻¹ Δ G_Vi.
//!
//! * [`Assembly`]: matrices and undamped modes of the free assembly (eq 8–14);
//! * [`Model`]: the assembly with supports and effects, and its receptances between any [`Station`]s;
//! * [`StateSpace`]: the assembly over time, for what has no FRF;
//! * [`MeasuringChain`]: what stands between the structure and a recorded value;
//! * [`ModelledTest`]: the model with a test's channels; [`ContinuedFrfs`], its FRFs at complex frequencies;
//!   [`Tangent`], what small changes of the fixture make of them; [`Vicinity`], tests of fixtures beside one
//!   another for differences;
//! * [`Delta`]: what one effect makes of the scalar through which it acts, over frequency;
//! * [`synthesize`], [`accelerances`]: the FRFs an analyser would record (eq 18, 41), measuring-chain effects
//!   included.
//!
//! ```
//! use jointscope_fixture::Fixture;
//! use jointscope_lumped::{Instrument, synthesize};
//! use jointscope_spectra::{FrfPair, SpectralLines};
//!
//! let fixture = Fixture::from_json(r#"{
//!   "bodies": { "A": { "mass": 2.0, "rotates": false }, "B": { "mass": 3.0, "rotates": false } },
//!   "points": { "1": { "body": "A", "x": 0 }, "2": { "body": "B", "x": 0.1 } },
//!   "joints": { "J": { "from": "1", "to": "2", "stiffness": [[5e6, 0], [0, 0]] } } }"#)?;
//! let lines = SpectralLines::new(vec![100.0])?;
//! let frfs = synthesize(&fixture, &[FrfPair::transverse("2", "1")], &lines, Instrument::AsRecorded)?;
//! // Closed form of two masses on a spring: k / (k (m1 + m2) − ω² m1 m2).
//! let omega2 = (2.0 * std::f64::consts::PI * 100.0_f64).powi(2);
//! let expected = 5e6 / (5e6 * 5.0 - omega2 * 6.0);
//! assert!((frfs.values(0)[0].re - expected).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assembly;
mod bar;
mod chain;
mod condensed;
mod delta;
mod denominator;
mod effects;
mod far_modes;
mod held;
mod joint;
mod joint_element;
mod lanes;
mod mesh;
mod modal_system;
mod model;
mod modes_cache;
mod motions;
mod nominal_stiffness;
mod point_law;
mod receptances;
mod state_space;
mod station;
mod synthesis;
mod tangent;
mod term_station;
mod terms;
mod uniform_beam;
mod vicinity;

pub use assembly::Assembly;
pub use chain::{Instrument, MeasuringChain, Reading, channel_station, signal_power, window_decay};
pub use delta::Delta;
pub use effects::SignalFilter;
pub use joint_element::JointElement;
pub use lanes::{Lanes, Lines};
pub use model::Model;
pub use nominal_stiffness::nominal_stiffness;
pub use point_law::PointLaw;
pub use receptances::Receptances;
pub use state_space::StateSpace;
pub use station::Station;
pub use synthesis::{ContinuedFrfs, ModelledTest, accelerances, synthesize};
pub use tangent::Tangent;
pub use vicinity::Vicinity;

/// Why an assembly cannot be modelled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LumpedError {
    /// The undamped modes could not be found.
    #[error("the assembly's modes cannot be computed: {0}")]
    Modes(#[from] jointscope_linalg::EigenError),
    /// A beam body would need a finer mesh than its modes can be computed of.
    #[error(
        "body `{body}` bends so easily that lines up to {} Hz need {elements:.0} elements of it, more than {most}: check its stiffness, its mass and its length, or take a lower band",
        jointscope_spectra::in_text(*frequency)
    )]
    TooFine {
        /// The body.
        body: String,
        /// Elements that would be needed.
        elements: f64,
        /// The most there may be.
        most: usize,
        /// The highest line, Hz.
        frequency: f64,
    },
    /// An FRF names a point that the fixture does not have.
    #[error("FRF {frf}: the fixture has no point `{point}` (it has {known})")]
    UnknownPoint {
        /// The FRF asked for.
        frf: String,
        /// The missing point.
        point: String,
        /// The points there are.
        known: String,
    },
    /// A rotation or moment was asked of a body that does not rotate.
    #[error("FRF {frf}: point `{point}` sits on a body that does not rotate")]
    NoRotation {
        /// The FRF asked for.
        frf: String,
        /// The point.
        point: String,
    },
    /// An effect makes FRFs depend on the amplitude.
    #[error(
        "physics/{index}: `{kind}` makes the response depend on its amplitude, so it has no single FRF; `jointscope simulate` computes its time histories"
    )]
    NonLinear {
        /// Position in the fixture's `physics`.
        index: usize,
        /// The effect's name.
        kind: &'static str,
    },
    /// An effect has no form over time.
    #[error(
        "physics: `{kind}` is known by frequency only and has no form over time; leave it out, or state its damping by `modal_ratios`"
    )]
    NotInTime {
        /// The effect's name.
        kind: &'static str,
    },
    /// Mass or damping that makes the equations of motion singular.
    #[error(
        "the equations of motion are singular: masses that an effect takes away leave nothing to be moved"
    )]
    SingularMass,
    /// The dynamic stiffness has no inverse at a line.
    #[error(
        "the response is unbounded at {} Hz: the model has an undamped resonance on that line; state some damping or move the line",
        jointscope_spectra::in_text(*frequency)
    )]
    Unbounded {
        /// The line, Hz.
        frequency: f64,
    },
    /// The resulting FRFs are not a valid set.
    #[error(transparent)]
    Spectra(#[from] jointscope_spectra::SpectraError),
}
