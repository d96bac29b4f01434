//! Which stiffness drifted: by the share of the strain energy that it has in each mode.

use super::drifted::Drifted;
use super::poles_by_frf::{by_reference, poles_by_frf, references};
use super::table::{Cell, Fit, Table, chance};
use crate::settings::Settings;
use crate::settings::drift::attribution::{
    BESIDE_POLES, DEVIATION_IF_EXPLAINED, DEVIATION_OTHERWISE, EXPLAINS, NAMED, ROUNDS, STIFFNESS_STEP,
};
use crate::settings::drift::differences::CALLED_DRIFT;
use crate::{Hypothesis, Observation};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_inference::interval95;
use jointscope_model_error::{ModelledModes, Pairing, RecordedModes};
use jointscope_spectra::{Channel, FrfSet};
use serde::Serialize;
use std::f64::consts::TAU;

/// How far one reference's FRFs are from those of the references that agree.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReferenceChange {
    /// Where was struck.
    pub reference: Channel,
    /// Whether its poles agree with those that most references share.
    pub agrees: bool,
    /// Relative change of the stiffness that drifted while this reference was struck: zero by definition
    /// where the references agree.
    pub change: f64,
    /// Its standard deviation.
    pub std: f64,
    /// Its interval of 95 %.
    pub ci95: [f64; 2],
    /// Whether the diagnosis goes on with this reference's FRFs.
    pub kept: bool,
}

/// How far one mode moved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeDrift {
    /// Natural frequency, Hz.
    pub frequency: f64,
    /// Relative change of it by reference, in the order of [`TestDrift::references`]; `None` where a
    /// reference does not show the mode.
    pub changes: Vec<Option<f64>>,
    /// Standard deviations of these.
    pub std: Vec<Option<f64>>,
}

/// A test that drifted between references.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TestDrift {
    /// Whose stiffness explains it: `joints/J`, `bodies/F` or `all stiffnesses`; `None` where the modes do
    /// not tell one.
    pub what: Option<String>,
    /// All that explain it, where `what` is `None`; empty where nothing does.
    pub could_be: Vec<String>,
    /// By reference, in the order in which the recording has them. Changes are of `what`; without, of all
    /// stiffnesses alike.
    pub references: Vec<ReferenceChange>,
    /// Probability of poles that differ as much between references by chance.
    pub p_value: f64,
    /// Whether it is so little that the diagnosis goes on with all FRFs, the difference taken out of them.
    pub taken_out: bool,
    /// The modes that tell it.
    pub modes: Vec<ModeDrift>,
}

const ALL: &str = "all stiffnesses";

/// A stiffness with its share in each mode of the table: 2·d ln ω/d ln k.
struct Candidate {
    name: String,
    shares: Vec<f64>,
}

/// Changes of one stiffness in ln k by reference, with their variances, and χ² with its degrees of freedom.
struct StiffnessChanges {
    changes: Vec<(f64, f64)>,
    chi2: f64,
}

impl TestDrift {
    /// Probability by chance of poles that differ between references as much as in this recording, drift or
    /// not; `None` where nothing can be compared. The FRFs' own noise is taken, or estimated where they have
    /// none.
    pub fn chance(fixture: &Fixture, frfs: &FrfSet) -> Option<f64> {
        let observation = Observation::new(frfs, |_| true).ok()?;
        let references = references(&observation);
        let nominal = Hypothesis::nominal(fixture, false);
        let most_left = Settings::default().modal.free_fit_limit;
        let struck = by_reference(&observation, &nominal, &references);
        poles_by_frf(&observation, &struck, (most_left, 1.0 + CALLED_DRIFT))?.table.chance()
    }
}

impl Drifted {
    /// What drifted, told by the shares of strain energy in a model of the structure.
    /// `explains`: whether that model explains the recording down to its noise.
    pub(crate) fn attributed(&self, model: &Fixture, explains: bool) -> TestDrift {
        attributed(self, model, explains)
    }
}

fn attributed(drifted: &Drifted, model: &Fixture, explains: bool) -> TestDrift {
    let deviation = if explains { DEVIATION_IF_EXPLAINED } else { DEVIATION_OTHERWISE };
    let Drifted { table, kept, .. } = drifted;
    let candidates = candidates(model, &drifted.modes, &table.modes);
    let inflation = table.inflation() * table.shared();
    let fitted: Vec<(&Candidate, StiffnessChanges)> = candidates
        .iter()
        .filter_map(|c| Some((c, stiffness_changes(table, kept, c, [inflation, deviation])?)))
        .collect();
    let (degrees, left) = table.degrees();
    let own = table.by_reference(|_| false).map_or(0.0, |fit| fit.chi2);
    let apart = kept.iter().filter(|kept| !**kept).count();
    let explains = |fit: &StiffnessChanges| {
        let excess = (fit.chi2 - own / inflation).max(0.0);
        chance(excess, degrees.saturating_sub(apart), 1.0, left) >= EXPLAINS
    };
    let lowest = fitted.iter().map(|(_, fit)| fit.chi2).fold(f64::INFINITY, f64::min);
    let weight = |fit: &StiffnessChanges| (-0.5 * (fit.chi2 - lowest)).exp();
    let total: f64 = fitted.iter().map(|(_, fit)| weight(fit)).sum();
    let mut able: Vec<&(&Candidate, StiffnessChanges)> = fitted.iter().filter(|(_, c)| explains(c)).collect();
    able.sort_by(|a, b| a.1.chi2.total_cmp(&b.1.chi2));
    let best = able.first().filter(|(_, fit)| weight(fit) / total > NAMED);
    let alike = Candidate { name: ALL.to_owned(), shares: vec![1.0; table.modes.len()] };
    let best_changes = best.map(|(_, fit)| &fit.changes);
    let whole = stiffness_changes(table, kept, &alike, [inflation, deviation]).map(|fit| fit.changes);
    let changes = best_changes.or(whole.as_ref());
    let reference = |(index, reference): (usize, &jointscope_spectra::Channel)| {
        let (ln, variance) = changes.map_or((0.0, 0.0), |changes| changes[index]);
        let deviation = variance.sqrt();
        ReferenceChange {
            reference: reference.clone(),
            change: ln.exp_m1(),
            std: ln.exp() * deviation,
            ci95: interval95(ln, deviation).map(f64::exp_m1),
            agrees: kept[index],
            kept: kept[index] || drifted.levelled,
        }
    };
    // Where one is found there is nothing else to consider.
    let considered = able.iter().filter(|_| best.is_none());
    TestDrift {
        what: best.map(|(candidate, _)| candidate.name.clone()),
        could_be: considered.map(|(candidate, _)| candidate.name.clone()).collect(),
        references: drifted.references.iter().enumerate().map(reference).collect(),
        p_value: drifted.p_value,
        taken_out: drifted.levelled,
        modes: modes(drifted, inflation),
    }
}

/// Changes of one stiffness by reference. The shares of a model that is not exact are off by a factor common
/// to all references of a mode, which is fitted beside them.
fn stiffness_changes(
    table: &Table,
    kept: &[bool],
    candidate: &Candidate,
    [inflation, deviation]: [f64; 2],
) -> Option<StiffnessChanges> {
    let first = table.constants();
    let errors = first + table.references;
    let mut changes = vec![0.0; table.references];
    let mut fit = None;
    for _ in 0..ROUNDS {
        let more = |cell: &Cell| match kept[cell.reference] {
            true => Vec::new(),
            false => {
                let half = 0.5 * candidate.shares[cell.mode];
                let by_error = half * changes[cell.reference];
                vec![(first + cell.reference, half), (errors + cell.mode, by_error)]
            }
        };
        let mut equations = table.equations(more);
        equations.iter_mut().for_each(|(_, _, variance)| *variance *= inflation);
        equations.extend(
            (0..table.modes.len()).map(|mode| (vec![(errors + mode, 1.0)], 0.0, deviation * deviation)),
        );
        let found = Fit::of(&equations, errors + table.modes.len())?;
        changes.copy_from_slice(&found.values[first..errors]);
        fit = Some(found);
    }
    let fit = fit?;
    let unknowns = fit.values.len();
    let of = |reference: usize| {
        let at = first + reference;
        let is_kept = kept[reference];
        if is_kept { (0.0, 0.0) } else { (fit.values[at], fit.covariance[at * (unknowns + 1)]) }
    };
    Some(StiffnessChanges { changes: (0..table.references).map(of).collect(), chi2: fit.chi2 })
}

/// The stiffnesses of a model with their shares in these modes of a recording: joints, beams, and all of them
/// together.
fn candidates(model: &Fixture, recorded: &RecordedModes, modes: &[usize]) -> Vec<Candidate> {
    let Some(modelled) = ModelledModes::of(model, recorded) else { return Vec::new() };
    let pairing = Pairing::of(recorded, &modelled);
    let partner = |r: &usize| pairing.pairs.iter().find(|(own, _)| own == r).map(|(_, m)| *m);
    let Some(partners) = modes.iter().map(partner).collect::<Option<Vec<usize>>>() else { return Vec::new() };
    // Exactly at a pole of the unchanged model its FRFs have no value to set out from.
    let beside = modelled.beside(BESIDE_POLES);
    let ln_omega = |places: &[Place], by: f64| -> Option<Vec<f64>> {
        let mut physics = model.physics().to_vec();
        let change =
            |place: &Place| Effect::new(EffectKind::StiffnessChange, place.clone(), None, &[by.exp()]);
        physics.extend(places.iter().map(change));
        let changed = ModelledModes::near(&model.clone().with_physics(physics).ok()?, recorded, &beside)?;
        Some(partners.iter().map(|&m| changed.modes[m].pole.omega.ln()).collect())
    };
    let shares = |places: &[Place]| -> Option<Vec<f64>> {
        let (up, down) = (ln_omega(places, STIFFNESS_STEP)?, ln_omega(places, -STIFFNESS_STEP)?);
        Some(up.iter().zip(&down).map(|(up, down)| (up - down) / STIFFNESS_STEP).collect())
    };
    let joints = model
        .joints()
        .iter()
        .map(|joint| (format!("joints/{}", joint.name), Place::Joint(joint.name.clone())));
    let beams = model.bodies().iter().filter(|body| body.kind.is_beam());
    let beams = beams.map(|body| (format!("bodies/{}", body.name), Place::Body(body.name.clone())));
    let single: Vec<(String, Place)> = joints.chain(beams).collect();
    let mut all: Vec<Candidate> = single
        .iter()
        .filter_map(|(name, place)| {
            Some(Candidate { name: name.clone(), shares: shares(std::slice::from_ref(place))? })
        })
        .collect();
    if single.len() > 1 {
        let places: Vec<Place> = single.into_iter().map(|(_, place)| place).collect();
        all.extend(shares(&places).map(|shares| Candidate { name: ALL.to_owned(), shares }));
    }
    all
}

/// How far each mode moved by itself.
fn modes(drifted: &Drifted, inflation: f64) -> Vec<ModeDrift> {
    let Drifted { table, kept, .. } = drifted;
    let Some(fit) = table.by_reference(|reference| kept[reference]) else { return Vec::new() };
    let (first, unknowns) = (table.constants(), fit.values.len());
    let of = |(mode, &recorded): (usize, &usize)| {
        let is_seen =
            |reference: usize| table.cells.iter().any(|c| c.mode == mode && c.reference == reference);
        let at = |reference: usize| first + mode * table.references + reference;
        let change = |reference: usize| match kept[reference] {
            true => (0.0, 0.0),
            false => (
                fit.values[at(reference)].exp_m1(),
                (inflation * fit.covariance[at(reference) * (unknowns + 1)]).sqrt(),
            ),
        };
        let changes: Vec<Option<(f64, f64)>> =
            (0..table.references).map(|reference| is_seen(reference).then(|| change(reference))).collect();
        ModeDrift {
            frequency: drifted.modes.modes[recorded].pole.omega / TAU,
            changes: changes.iter().map(|c| c.map(|c| c.0)).collect(),
            std: changes.iter().map(|c| c.map(|c| c.1)).collect(),
        }
    };
    table.modes.iter().enumerate().map(of).collect()
}
