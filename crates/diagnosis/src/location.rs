//! Where a mismatch sits, with no law assumed: one unknown dynamic stiffness δ(ω) a place.
//!
//! A component that was left out and acts through one station b changes the dynamic stiffness by δ·b·bᵀ, and
//! so the FRFs by −γ(ω)·p(ω) with a pattern p that the model knows and γ = δ/(1 + δ·bᵀZ⁻¹b). With more FRFs
//! than one, a free γ on every line is over-determined: at the right place one γ explains all FRFs within
//! their noise, at a wrong one it cannot. What stays unexplained, by place, FRF and band, is the map of the
//! mismatch; the γ of the best place, turned back into δ, is a measured dynamic stiffness, whose law over
//! frequency names the physics.
//!
//! Stated deviations include noise, tolerances and abscissa. In twenty simulated tests of 86 lines each, two
//! of them cover the true δ on 92 % of the lines for an added mass, on 94 % for a channel's gain and on 81 %
//! for a spring in series, and the true parameter of the law in nine cases of ten or more
//! (`stated_deviations_cover_the_truth_about_as_often_as_they_should`).

mod descent;
mod fitted_law;
mod free_scalars;
mod guess;
mod laws;
mod map;
mod pattern;
mod problem;
mod recorded;
mod scalar;
mod sites;
mod tangent;

pub use map::{locate, measure};
pub(crate) use map::{located, measured};

use crate::candidate::Candidate;
use jointscope_fixture::{Dof, Effect, Fixture, Motion, ParameterSpec};
use jointscope_spectra::FrfPair;
use num_complex::Complex64;
use serde::{Serialize, Serializer};

/// This step, as [`Diagnosis::stopped`](crate::Diagnosis::stopped) names it where the work did not suffice
/// for it.
pub(crate) const LOCATION_STEP: &str = "the places of what is left";

/// A place through which one unknown scalar a line may act.
#[derive(Debug, Clone, PartialEq)]
pub enum Site {
    /// A component on a body at an abscissa (m), felt through its transverse motion.
    Body {
        /// The body's name.
        body: String,
        /// Abscissa, m.
        x: f64,
    },
    /// A compliance in series with one end of a joint, or with the joint as a whole in shear.
    Series {
        /// The joint's name.
        joint: String,
        /// The point at that end; `None` for both alike (translation in a massless joint).
        point: Option<String>,
        /// The direction that yields.
        dof: Dof,
    },
    /// The joint's own law: its elastic stiffness is multiplied by 1 + δ.
    Joint(String),
    /// A response channel: its FRFs are multiplied by 1 + δ.
    Response(String),
    /// A reference channel: its FRFs are divided by 1 + δ.
    Reference(String),
    /// A sensor or impact that sits δ metres from where it is said to be.
    Position(String),
}

/// What one place leaves unexplained, and the dynamic stiffness that it would have to have.
#[derive(Debug, Clone, Serialize)]
pub struct Location {
    /// The place.
    #[serde(skip)]
    pub site: Site,
    /// χ² per degree of freedom that is left with one free scalar a line there, tolerances yielding.
    pub chi2_per_dof: f64,
    /// Σ (departure/std)² of the fixture's quantities there: a wrong place often explains as much, with
    /// tolerances that nobody would believe.
    pub departures: f64,
    /// Real values less real unknowns.
    pub degrees: usize,
    /// Probability of as much by chance.
    pub p_value: f64,
    /// What is left by band, ascending.
    pub bands: Vec<BandMisfit>,
    /// χ² per real value left, by FRF.
    #[serde(skip)]
    pub frfs: Vec<(FrfPair, f64)>,
    /// δ on each line where it is determined; stated of the best places.
    #[serde(skip)]
    pub delta: Vec<LineEstimate>,
    /// Number of lines without δ: the pattern vanishes, too few FRFs are valid, or the noise does not let it
    /// be inverted.
    #[serde(skip)]
    pub masked: usize,
    /// The laws that come closest to δ(ω), the closest first; stated of the best places.
    #[serde(skip)]
    pub laws: Vec<LawFit>,
}

/// What a model leaves in one band.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BandMisfit {
    /// Lower end, Hz.
    pub from: f64,
    /// Upper end, Hz.
    pub to: f64,
    /// χ² per degree of freedom; of an FRF per real value, nothing where no value of the band counts.
    pub chi2_per_dof: Option<f64>,
}

/// A law over frequency fitted to the δ(ω) of a place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LawFit {
    /// What it would be, in words.
    #[serde(rename = "law")]
    pub name: &'static str,
    /// δ(ω) as a formula.
    pub formula: &'static str,
    /// Its parameters.
    #[serde(serialize_with = "by_name")]
    pub parameters: Vec<LawParameter>,
    /// χ² per degree of freedom that the law leaves of δ, tolerances yielding: what it leaves of the FRFs
    /// beyond what free scalars leave. Far above 1 where δ does not follow it, never below 0.
    pub chi2_per_dof: f64,
    /// Real values of δ less parameters.
    pub degrees: usize,
    /// The law on the lines of [`Location::delta`].
    #[serde(skip)]
    pub values: Vec<Complex64>,
}

/// A parameter of a law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LawParameter {
    /// Its name, as in fixture files.
    #[serde(skip)]
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// One standard deviation, tolerances and abscissa included.
    pub std: f64,
    /// Its unit.
    pub unit: &'static str,
}

fn by_name<S: Serializer>(parameters: &[LawParameter], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(parameters.iter().map(|parameter| (parameter.name, parameter)))
}

/// δ on one spectral line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LineEstimate {
    /// The line, Hz.
    pub frequency: f64,
    /// δ: the unknown component's dynamic stiffness (N/m for a body or a translation in series, N·m/rad for a
    /// rotation in series: there infinite means that nothing yields), the relative change of a joint's
    /// elastic stiffness or of a channel (1), a position's offset (m).
    #[serde(serialize_with = "jointscope_spectra::complex")]
    pub value: Complex64,
    /// Standard deviation of its real part, and of its imaginary part.
    pub std: f64,
}

impl Location {
    /// The effects that the laws of this place are, the closest law first: those of `candidates` that act
    /// through it and of which a law tells every parameter but an abscissa and what is nothing unless stated.
    pub(crate) fn effects(&self, candidates: &[Candidate], fixture: &Fixture) -> Vec<Effect> {
        let of_law = |law: &LawFit| {
            let told =
                |name: &str| law.parameters.iter().find(|told| told.name == name).map(|told| told.value);
            let of = |candidate: &Candidate| {
                let effect = candidate.effect(0);
                let spec = effect.kind.spec();
                let known = spec.parameters.iter().filter(|parameter| told(parameter.name).is_some()).count();
                if !self.site.holds(&effect, fixture) || known < law.parameters.len() {
                    return None;
                }
                let value = |parameter: &ParameterSpec| match (&self.site, told(parameter.name)) {
                    (_, Some(value)) => Some(value),
                    (Site::Body { x, .. }, None) if parameter.motion == Motion::AlongBody => Some(*x),
                    (_, None) => parameter.default,
                };
                let values: Vec<f64> = spec.parameters.iter().map(value).collect::<Option<_>>()?;
                Some(Effect::new(effect.kind, effect.place.clone(), effect.dof, &values))
            };
            candidates.iter().filter_map(of).collect::<Vec<_>>()
        };
        self.laws.iter().flat_map(of_law).collect()
    }

    /// χ² left and what the priors charge for the tolerances.
    pub(crate) fn cost(&self) -> f64 {
        self.chi2_per_dof * self.degrees as f64 + self.departures
    }
}

impl Site {
    /// Unit of δ.
    pub fn unit(&self) -> &'static str {
        match self {
            Site::Body { .. } | Site::Series { dof: Dof::Translation, .. } => "N/m",
            Site::Series { dof: Dof::Rotation, .. } => "N*m/rad",
            Site::Response(_) | Site::Reference(_) | Site::Joint(_) => "1",
            Site::Position(_) => "m",
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use jointscope_fixture::{EffectKind, Place};

    const BLOCKS: &str = r#"{
      "bodies": { "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }, "B": { "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 } },
      "points": { "2": { "body": "A", "x": 0 }, "3": { "body": "B", "x": 0.065 } },
      "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 } } } }"#;

    fn location(site: Site, parameters: &[(&'static str, f64)]) -> Location {
        let told = |&(name, value)| LawParameter { name, value, std: 0.0, unit: "" };
        let parameters = parameters.iter().map(told).collect();
        let law =
            LawFit { name: "", formula: "", parameters, chi2_per_dof: 1.0, degrees: 1, values: Vec::new() };
        let (bands, frfs, delta, laws) = (Vec::new(), Vec::new(), Vec::new(), vec![law]);
        Location {
            site,
            chi2_per_dof: 1.0,
            departures: 0.0,
            degrees: 1,
            p_value: 1.0,
            bands,
            frfs,
            delta,
            masked: 0,
            laws,
        }
    }

    #[test]
    fn a_law_at_a_place_is_every_effect_there_of_which_it_tells_all() {
        let fixture = Fixture::from_json(BLOCKS).unwrap();
        let on = |body: &str| Site::Body { body: body.into(), x: 0.11 };
        let of = |kind, place, values: &[f64]| {
            crate::candidate::candidate(kind, place, None, vec![values.to_vec()])
        };
        let body = |name: &str| Place::Body(name.into());
        let candidates = [
            of(EffectKind::AddedMass, body("B"), &[0.1, 0.01]),
            of(EffectKind::Support, body("A"), &[0.0, 1e4, 0.0]),
            of(EffectKind::Support, body("B"), &[0.1, 1e4, 0.0]),
            of(EffectKind::AttachedResonator, body("B"), &[0.1, 0.01, 300.0, 0.01]),
        ];
        let told = |site, parameters: &[(&'static str, f64)]| {
            location(site, parameters).effects(&candidates, &fixture)
        };
        let support = |stiffness, damping| {
            vec![Effect::new(EffectKind::Support, body("B"), None, &[0.11, stiffness, damping])]
        };
        assert_eq!(told(on("B"), &[("stiffness", 1.6e5)]), support(1.6e5, 0.0));
        assert_eq!(told(on("B"), &[("stiffness", 1.6e5), ("damping", 0.5)]), support(1.6e5, 0.5));
        // A resonator has a mass too, and a frequency of which this law tells nothing.
        let lump = vec![Effect::new(EffectKind::AddedMass, body("B"), None, &[0.11, 0.06])];
        assert_eq!(told(on("B"), &[("mass", 0.06)]), lump);
        assert!(told(on("B"), &[("damping", 0.5)]).is_empty(), "a support without its spring");
        assert!(told(Site::Joint("J".into()), &[("stiffness", 1.0)]).is_empty());
    }
}
