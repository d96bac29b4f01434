//! The diagnosis and the baselines side by side.

use super::{Baseline, Updated};
use crate::judged::error_on;
use crate::objective::{Tolerance, values};
use crate::sheet::{Keyed, by_key};
use crate::statistics::median;
use crate::{Judged, Name, Role, Share};
use jointscope_fixture::{EffectKind, Fixture, QuantityKey, QuantityOwner};
use serde::Serialize;
use std::fmt::{self, Display, Formatter};

/// One way of dealing with the cases, and what it is worth. `None` where the question does not arise.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Method {
    /// Key in `proof.json`.
    #[serde(skip)]
    pub key: &'static str,
    /// What it is, in words.
    pub what: &'static str,
    /// Nulls that it finds nothing amiss in.
    #[serde(rename = "nulls_clean")]
    pub nulls: Option<Share>,
    /// Single effects that show of which it gives the hidden name to the letter (kind, place and dof).
    #[serde(rename = "right_name")]
    pub named: Option<Share>,
    /// The same by kind alone.
    #[serde(rename = "right_kind")]
    pub kind: Option<Share>,
    /// Single and double effects that show after which its model fits to the noise.
    #[serde(rename = "fits_to_the_noise")]
    pub fits: Option<Share>,
    /// The worst of a fixture's quantities: true less identified, in stated standard deviations, median over
    /// those cases.
    #[serde(rename = "worst_quantity_in_stated_deviations")]
    pub worst_quantity: Option<f64>,
    /// Of the joints' stiffnesses the worst relative error, median over those cases.
    #[serde(rename = "joint_stiffness_relative_error")]
    pub joint_stiffness: Option<f64>,
    /// Relative error on FRFs that nobody recorded, median over those cases.
    #[serde(rename = "unmeasured_relative_error")]
    pub unmeasured: Option<f64>,
}

impl Keyed for Method {
    fn key(&self) -> &str {
        self.key
    }
}

/// All of them.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(transparent)]
pub struct Methods(#[serde(serialize_with = "by_key")] pub Vec<Method>);

/// A case with what the diagnosis and the baselines made of it.
struct Compared<'a> {
    judged: &'a Judged,
    believed: &'a Fixture,
    baseline: &'a Baseline,
}

impl Methods {
    /// Compares the answers to judged cases with the baselines' to the same cases, which were `believed` to
    /// be what their fixtures say.
    pub fn of(judged: &[Judged], believed: &[&Fixture], baselines: &[Option<Baseline>]) -> Self {
        let all = judged.iter().zip(believed).zip(baselines);
        let all: Vec<Compared> = all
            .filter_map(|((judged, believed), baseline)| {
                baseline.as_ref().map(|baseline| Compared { judged, believed, baseline })
            })
            .collect();
        let of_role = |role: Role| all.iter().filter(move |case| case.judged.truth.role == role);
        let nulls = |clean: &dyn Fn(&Compared) -> bool| Some(Share::count(of_role(Role::Null), clean));
        // By the letter for all: nobody has fitted whether what a lookup names would serve as well.
        let singles = |right: &dyn Fn(&Compared, &Name) -> bool| {
            let shown = of_role(Role::Single).filter(|case| case.judged.is_visible());
            Some(Share::count(shown, |case| case.judged.hidden().iter().any(|hidden| right(case, hidden))))
        };
        let nearest = |case: &Compared| case.baseline.nearest.as_ref().map(|n| Name::of(&n.effect));
        let diagnosis = Method {
            nulls: nulls(&|case| case.judged.is_consistent()),
            named: singles(&|case, hidden| case.judged.found().contains(hidden)),
            kind: singles(&|case, hidden| case.judged.found().iter().any(|name| name.kind == hidden.kind)),
            ..Method::of_models("diagnosis", "diagnosis", &all, |case| {
                let answer = case.judged.answer.as_ref().ok()?;
                Some(Updated { fixture: answer.repaired.clone(), chi2_per_dof: answer.chi2_per_dof[2] })
            })
        };
        let within = Method {
            nulls: nulls(&|case| case.baseline.within.fits()),
            ..Method::of_models("within_tolerances", "updating within tolerances", &all, |case| {
                Some(case.baseline.within.clone())
            })
        };
        let freed = Method {
            nulls: nulls(&|case| case.baseline.freed.fits()),
            ..Method::of_models("freed", "updating, all freed", &all, |case| {
                Some(case.baseline.freed.clone())
            })
        };
        let lookup = Method {
            key: "nearest_signature",
            what: "nearest signature",
            nulls: nulls(&|case| case.baseline.nearest.is_none()),
            named: singles(&|case, hidden| nearest(case).as_ref() == Some(hidden)),
            kind: singles(&|case, hidden| nearest(case).is_some_and(|name| name.kind == hidden.kind)),
            ..Method::default()
        };
        Methods(vec![diagnosis, within, freed, lookup])
    }
}

impl Method {
    /// What models made of the cases whose hidden effects show are worth.
    fn of_models(
        key: &'static str,
        what: &'static str,
        all: &[Compared],
        model: impl Fn(&Compared) -> Option<Updated>,
    ) -> Self {
        let asked = all.iter().filter(|case| is_asked(case.judged));
        let models: Vec<_> = asked.filter_map(|case| Some((case, model(case)?))).collect();
        let errors = models.iter().map(|(case, updated)| quantity_errors(case, &updated.fixture));
        let (worst, joint): (Vec<f64>, Vec<Option<f64>>) = errors.unzip();
        let joint: Vec<f64> = joint.into_iter().flatten().collect();
        let unmeasured = models
            .iter()
            .filter_map(|(case, updated)| error_on(&case.judged.truth.unseen().ok()?, &updated.fixture));
        Method {
            key,
            what,
            fits: Some(Share::count(&models, |(_, updated)| updated.fits())),
            worst_quantity: median(&worst),
            joint_stiffness: median(&joint),
            unmeasured: median(&unmeasured.collect::<Vec<_>>()),
            ..Method::default()
        }
    }
}

/// Whether a case says something about identified quantities. A joint that is stiffer as a whole *is*
/// described by another modulus: there an updated one is no error.
fn is_asked(judged: &Judged) -> bool {
    let of_effects = matches!(judged.truth.role, Role::Single | Role::Double);
    let own_stiffness = judged.truth.effects().iter().any(|e| e.kind == EffectKind::StiffnessChange);
    of_effects && judged.is_visible() && !own_stiffness
}

/// The worst departure of identified quantities from the true ones in stated deviations, and the worst
/// relative error of a joint's stiffness.
fn quantity_errors(case: &Compared, identified: &Fixture) -> (f64, Option<f64>) {
    let (identified, exact) = (values(identified), values(&case.judged.truth.fixture));
    let quantities = case.believed.quantities();
    let (mut worst, mut joint) = (0.0_f64, None::<f64>);
    for tolerance in Tolerance::all(case.believed) {
        worst = worst.max((tolerance.departure(&identified) - tolerance.departure(&exact)).abs());
        let quantity = &quantities[tolerance.index];
        let is_stiffness = match quantity.key {
            // The coupling of a stiffness matrix may be zero.
            QuantityKey::JointStiffness(row, column) => row == column,
            key => matches!(key, QuantityKey::YoungsModulus | QuantityKey::SecondMoment),
        };
        if matches!(quantity.owner, QuantityOwner::Joint(_)) && is_stiffness {
            let error = tolerance.value(&identified) / tolerance.value(&exact) - 1.0;
            joint = Some(joint.unwrap_or(0.0).max(error.abs()));
        }
    }
    (worst, joint)
}

impl Display for Methods {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "diagnosis and baselines: nulls left alone, right name, right kind, fits to the noise; then worst quantity in stated deviations, \
             worst joint stiffness, error on unmeasured FRFs (medians):"
        )?;
        for method in &self.0 {
            let shares = [method.nulls, method.named, method.kind, method.fits];
            let shares = shares.map(|s| s.map_or_else(|| "–".to_owned(), |s| format!("{}/{}", s.of, s.all)));
            let numbers = [method.worst_quantity, method.joint_stiffness, method.unmeasured];
            let numbers = numbers.map(|n| n.map_or_else(|| "–".to_owned(), |n| format!("{n:.2e}")));
            let shares: String = shares.iter().map(|share| format!(" {share:>8}")).collect();
            let numbers: String = numbers.iter().map(|number| format!(" {number:>9}")).collect();
            writeln!(f, "  {:<28}{shares} {numbers}", method.what)?;
        }
        Ok(())
    }
}
