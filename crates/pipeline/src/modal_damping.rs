//! Measured damping ratios into a fixture: measured modes matched with the modes of the assembly as it
//! stands.

use jointscope_fixture::{Damping, EffectKind, Fixture, FixtureError, Quantity, RatiosOf, Spread};
use jointscope_lumped::{Assembly, LumpedError, Station};
use jointscope_modes::{ExpectedMode, Matches, ModalAnalysis, match_modes};
use jointscope_spectra::{Channel, FrfPair, in_sentence};
use jointscope_wording::format::with_sign;
use std::collections::BTreeSet;

/// A fixture with measured damping ratios.
#[derive(Debug, Clone)]
pub struct MeasuredDamping {
    /// The fixture, its `damping` the ratios of its elastic modes.
    pub fixture: Fixture,
    /// Which measured mode is which elastic mode, those counted from the lowest.
    pub matches: Matches,
    /// Natural frequencies of the elastic modes in the band, Hz.
    pub elastic: Vec<f64>,
    /// What was matched and what was not, one plain sentence each.
    pub remarks: Vec<String>,
}

/// Why measured ratios cannot be put into a fixture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeasuredDampingError {
    /// The assembly has no modes.
    #[error(transparent)]
    Model(#[from] LumpedError),
    /// A channel is at no point of the fixture.
    #[error("the fixture has no point `{0}`, at which the modes were measured")]
    Point(String),
    /// None of the measured modes is one of the fixture's.
    #[error(
        "none of the measured modes ({} Hz) is one of the fixture's ({} Hz) by frequency and shape; correct the fixture first",
        listed(.measured),
        listed(.elastic)
    )]
    NothingMatches {
        /// Measured natural frequencies, Hz.
        measured: Vec<f64>,
        /// Elastic modes of the fixture, Hz.
        elastic: Vec<f64>,
    },
    /// The fixture does not take the ratios.
    #[error(transparent)]
    Fixture(#[from] FixtureError),
}

/// How far beyond the band elastic modes of the fixture are looked for: measured and modelled frequencies
/// differ.
const BEYOND: f64 = 1.2;

/// Puts the measured ratios, with their standard deviations, into the fixture's `modal_ratios`.
///
/// Ratios of elastic modes below the highest matched one that were not matched stay what the fixture says of
/// them; where it says nothing, they are the mean of the measured ones, of unknown deviation.
///
/// # Errors
/// See [`MeasuredDampingError`].
pub fn measured_damping(
    fixture: &Fixture,
    analysis: &ModalAnalysis,
) -> Result<MeasuredDamping, MeasuredDampingError> {
    let hz = analysis.lines().hz();
    let highest = BEYOND * hz[hz.len() - 1];
    let stated = match fixture.damping() {
        Damping::ModalRatios { ratios, of: RatiosOf::AsItStands } => ratios.clone(),
        _ => Vec::new(),
    };
    let as_it_stands = |ratios| Damping::ModalRatios { ratios, of: RatiosOf::AsItStands };
    let assembly = Assembly::new(&fixture.clone().with_damping(as_it_stands(stated.clone()))?, highest)?;
    let by_law = Assembly::new(fixture, highest)?.damping_law().of_modes(assembly.modes().eigenvalues());
    let frequencies = assembly.natural_frequencies_hz();
    let elastic = assembly.elastic_modes();
    let shown = elastic.iter().filter(|&&r| frequencies[r] <= highest).count();
    let expected = expected_modes(fixture, &assembly, analysis.pairs(), shown)?;
    let matches = match_modes(&analysis.modes, &expected);
    let elastic_hz: Vec<f64> = expected.iter().map(|mode| mode.frequency).collect();
    let Some(last) = matches.pairs.iter().map(|pair| pair.expected).max() else {
        return Err(MeasuredDampingError::NothingMatches {
            measured: analysis.modes.iter().map(|mode| mode.frequency).collect(),
            elastic: elastic_hz,
        });
    };
    let measured = |e: usize| {
        matches.pairs.iter().find(|pair| pair.expected == e).map(|pair| &analysis.modes[pair.measured])
    };
    let mean = matches.pairs.iter().map(|pair| analysis.modes[pair.measured].damping_ratio).sum::<f64>()
        / matches.pairs.len() as f64;
    let believed = |e: usize| {
        if let Some(ratio) = stated.get(e).or(stated.last()) {
            return *ratio;
        }
        let (r, damping) = (elastic[e], by_law[elastic[e]]);
        let omega = std::f64::consts::TAU * frequencies[r];
        let ratio = 0.5 * (damping.viscous / omega + damping.structural / (omega * omega));
        if ratio > 0.0 { Quantity::bare(ratio) } else { Quantity { value: mean, spread: Spread::Unknown } }
    };
    let ratios = (0..stated.len().max(last + 1))
        .map(|e| match measured(e) {
            Some(mode) => Quantity::with_std(mode.damping_ratio, mode.damping_std),
            None => believed(e),
        })
        .collect();
    let mut remarks = remarks(analysis, &matches, &elastic_hz, last);
    remarks.extend(without_effects(fixture));
    let fixture = fixture.clone().with_damping(as_it_stands(ratios))?;
    Ok(MeasuredDamping { fixture, matches, elastic: elastic_hz, remarks })
}

/// The first elastic modes of the assembly, with what each FRF has of them.
fn expected_modes(
    fixture: &Fixture,
    assembly: &Assembly,
    pairs: &[FrfPair],
    shown: usize,
) -> Result<Vec<ExpectedMode>, MeasuredDampingError> {
    let participation = |channel: &Channel| -> Result<Vec<f64>, MeasuredDampingError> {
        let point = fixture.point(&channel.point);
        let point = point.ok_or_else(|| MeasuredDampingError::Point(channel.point.clone()))?;
        Ok(assembly.participation(&Station { body: point.body, x: point.x.value, dof: channel.dof }))
    };
    let (frequencies, elastic) = (assembly.natural_frequencies_hz(), assembly.elastic_modes());
    let mut expected: Vec<ExpectedMode> = elastic[..shown]
        .iter()
        .map(|&r| ExpectedMode { frequency: frequencies[r], products: Vec::new() })
        .collect();
    for pair in pairs {
        let (response, reference) = (participation(&pair.response)?, participation(&pair.reference)?);
        for (mode, &r) in expected.iter_mut().zip(elastic) {
            mode.products.push(response[r] * reference[r]);
        }
    }
    Ok(expected)
}

fn remarks(analysis: &ModalAnalysis, matches: &Matches, elastic: &[f64], last: usize) -> Vec<String> {
    let mut pairs = matches.pairs.clone();
    pairs.sort_by_key(|pair| pair.expected);
    let mut all: Vec<String> = pairs
        .iter()
        .map(|pair| {
            format!(
                "elastic mode {} of the fixture ({} Hz) is the measured mode at {} Hz ({} %, MAC {:.2})",
                pair.expected + 1,
                in_sentence(elastic[pair.expected]),
                in_sentence(analysis.modes[pair.measured].frequency),
                with_sign(100.0 * pair.shift, 1),
                pair.mac
            )
        })
        .collect();
    if !matches.other_measured.is_empty() {
        let hz: Vec<f64> = matches.other_measured.iter().map(|&m| analysis.modes[m].frequency).collect();
        all.push(format!("no elastic mode of the fixture matches the measured ones at {} Hz", listed(&hz)));
    }
    let missing: Vec<f64> =
        matches.other_expected.iter().filter(|e| **e <= last).map(|&e| elastic[e]).collect();
    if !missing.is_empty() {
        all.push(format!(
            "no measured mode matches the fixture's elastic ones at {} Hz: their ratios are not measured",
            listed(&missing)
        ));
    }
    if analysis.pairs().len() < 3 {
        all.push("with so few FRFs the shapes say little: modes are matched by frequency".to_owned());
    }
    all
}

/// That the ratios are of the modes of bodies, joints and supports, and so are the frequencies they are
/// matched by.
fn without_effects(fixture: &Fixture) -> Option<String> {
    let structural = fixture.effects().map(|effect| effect.kind).filter(|kind| !kind.is_instrumental());
    let names: BTreeSet<&str> = structural.map(EffectKind::name).collect();
    (!names.is_empty()).then(|| {
        format!(
            "the fixture's frequencies here are of its bodies, joints and supports, without the effects it states ({}): part of the differences is theirs",
            names.into_iter().collect::<Vec<_>>().join(", ")
        )
    })
}

fn listed(hz: &[f64]) -> String {
    if hz.is_empty() {
        return "none".to_owned();
    }
    hz.iter().map(|f| in_sentence(*f).to_string()).collect::<Vec<_>>().join(", ")
}
