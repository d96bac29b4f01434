//! The diagnosis and the baselines side by side.

use super::{Baseline, Updated};
use crate::objective::{Tolerance, values};
use crate::statistics::median;
use crate::{Judged, Name, Role, Share, Truth};
use jointscope_diagnosis::Verdict;
use jointscope_fixture::{EffectKind, Fixture};
use jointscope_lumped::{Instrument, synthesize};
use serde_json::{Value, json};

/// One way of dealing with the cases, and what it is worth. `None` where the question does not arise.
#[derive(Debug, Clone, PartialEq)]
pub struct Method {
    /// Key in `proof.json`.
    pub key: &'static str,
    /// What it is, in words.
    pub what: &'static str,
    /// Nulls that it finds nothing amiss in.
    pub nulls: Option<Share>,
    /// Single effects that show of which it gives the hidden name to the letter (kind, place and dof).
    pub named: Option<Share>,
    /// The same by kind alone.
    pub kind: Option<Share>,
    /// Single and double effects that show after which its model fits to the noise.
    pub fits: Option<Share>,
    /// The worst of a fixture's quantities: true less identified, in stated standard deviations, median over those cases.
    pub worst_quantity: Option<f64>,
    /// Of the joints' stiffnesses the worst relative error, median over those cases.
    pub joint_stiffness: Option<f64>,
    /// Relative error on FRFs that nobody recorded, median over those cases.
    pub unmeasured: Option<f64>,
}

/// All of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Methods(pub Vec<Method>);

/// What became of a case whose hidden effects show.
#[derive(Default)]
struct Fates {
    fits: Share,
    worst: Vec<f64>,
    joint: Vec<f64>,
    unmeasured: Vec<f64>,
}

impl Methods {
    /// Compares the answers to judged cases with the baselines' to the same cases, which were `believed` to be what their fixtures say.
    pub fn of(judged: &[Judged], believed: &[&Fixture], baselines: &[Option<Baseline>]) -> Self {
        let all: Vec<(&Judged, &Fixture, &Baseline)> = judged
            .iter()
            .zip(believed)
            .zip(baselines)
            .filter_map(|((judged, believed), baseline)| Some((judged, *believed, baseline.as_ref()?)))
            .collect();
        let nulls = |clean: &dyn Fn(&Judged, &Baseline) -> bool| {
            let nulls = all.iter().filter(|(judged, ..)| judged.truth.role == Role::Null);
            Some(Share::count(nulls, |(judged, _, baseline)| clean(judged, baseline)))
        };
        let singles = |right: &dyn Fn(&Judged, &Baseline) -> bool| {
            let shown =
                all.iter().filter(|(judged, ..)| judged.truth.role == Role::Single && judged.is_visible());
            Some(Share::count(shown, |(judged, _, baseline)| right(judged, baseline)))
        };
        let fates = |model: &dyn Fn(&Judged, &Baseline) -> Option<Updated>| {
            let mut fates = Fates::default();
            for (judged, believed, baseline) in &all {
                if let Some(updated) = model(judged, baseline).filter(|_| is_asked(judged)) {
                    fates.add(judged, believed, &updated);
                }
            }
            fates
        };
        let repaired = fates(&|judged, _| {
            let answer = judged.answer.as_ref().ok()?;
            Some(Updated { fixture: answer.repaired.clone(), chi2_per_dof: answer.chi2_per_dof[2] })
        });
        // By the letter for all: nobody has fitted whether what a lookup names would serve as well.
        let hidden = |judged: &Judged| judged.hidden().into_iter().next();
        let diagnosis = Method {
            nulls: nulls(&|judged, _| {
                judged.answer.as_ref().is_ok_and(|answer| answer.verdict == Verdict::Consistent)
            }),
            named: singles(&|judged, _| hidden(judged).is_some_and(|name| judged.found().contains(&name))),
            kind: singles(&|judged, _| {
                hidden(judged).is_some_and(|name| judged.found().iter().any(|found| found.kind == name.kind))
            }),
            ..repaired.method("diagnosis", "diagnosis")
        };
        let nearest =
            |baseline: &Baseline| baseline.nearest.as_ref().map(|nearest| Name::of(&nearest.effect));
        let lookup = Method {
            nulls: nulls(&|_, baseline| baseline.nearest.is_none()),
            named: singles(&|judged, baseline| hidden(judged) == nearest(baseline)),
            kind: singles(&|judged, baseline| {
                hidden(judged).map(|n| n.kind) == nearest(baseline).map(|n| n.kind)
            }),
            fits: None,
            worst_quantity: None,
            joint_stiffness: None,
            unmeasured: None,
            key: "nearest_signature",
            what: "nearest signature",
        };
        let within = Method {
            nulls: nulls(&|_, baseline| baseline.within.fits()),
            ..fates(&|_, baseline| Some(baseline.within.clone()))
                .method("within_tolerances", "updating within tolerances")
        };
        let freed = Method {
            nulls: nulls(&|_, baseline| baseline.freed.fits()),
            ..fates(&|_, baseline| Some(baseline.freed.clone())).method("freed", "updating, all freed")
        };
        Methods(vec![diagnosis, within, freed, lookup])
    }

    /// As JSON.
    pub fn to_value(&self) -> Value {
        let share =
            |share: &Option<Share>| share.map(|s| json!({ "count": s.of, "of": s.all, "share": s.value() }));
        let method = |method: &Method| {
            let value = json!({
                "what": method.what, "nulls_clean": share(&method.nulls), "right_name": share(&method.named),
                "right_kind": share(&method.kind), "fits_to_the_noise": share(&method.fits),
                "worst_quantity_in_stated_deviations": method.worst_quantity,
                "joint_stiffness_relative_error": method.joint_stiffness,
                "unmeasured_relative_error": method.unmeasured,
            });
            (method.key.to_owned(), value)
        };
        Value::Object(self.0.iter().map(method).collect())
    }
}

/// Whether a case says something about identified quantities. A joint that is stiffer as a whole *is* described by another modulus: there
/// an updated one is no error.
fn is_asked(judged: &Judged) -> bool {
    let of_effects = matches!(judged.truth.role, Role::Single | Role::Double);
    let own_stiffness = |truth: &Truth| truth.effects().iter().any(|e| e.kind == EffectKind::StiffnessChange);
    of_effects && judged.is_visible() && !own_stiffness(&judged.truth)
}

impl Fates {
    fn add(&mut self, judged: &Judged, believed: &Fixture, updated: &Updated) {
        self.fits.all += 1;
        self.fits.of += usize::from(updated.fits());
        let (identified, exact) = (values(&updated.fixture), values(&judged.truth.fixture));
        let quantities = believed.quantities();
        let (mut worst, mut joint) = (0.0_f64, None::<f64>);
        for tolerance in Tolerance::all(believed) {
            worst = worst.max((tolerance.departure(&identified) - tolerance.departure(&exact)).abs());
            let path = &quantities[tolerance.index].path;
            // The coupling of a stiffness matrix may be zero.
            if path.starts_with("joints/") && !path.contains("damping") && !path.ends_with("0/1") {
                let error = tolerance.value(&identified) / tolerance.value(&exact) - 1.0;
                joint = Some(joint.unwrap_or(0.0).max(error.abs()));
            }
        }
        self.worst.push(worst);
        self.joint.extend(joint);
        let unseen = &judged.truth.unseen;
        if let Ok(set) = synthesize(&updated.fixture, unseen.pairs(), unseen.lines(), Instrument::Perfect) {
            let (mut error, mut size) = (0.0, 0.0);
            for (modelled, exact) in set.all_values().iter().zip(unseen.all_values()) {
                error += (modelled - exact).norm_sqr();
                size += exact.norm_sqr();
            }
            self.unmeasured.push((error / size).sqrt());
        }
    }

    fn method(self, key: &'static str, what: &'static str) -> Method {
        Method {
            key,
            what,
            nulls: None,
            named: None,
            kind: None,
            fits: Some(self.fits),
            worst_quantity: median(&self.worst),
            joint_stiffness: median(&self.joint),
            unmeasured: median(&self.unmeasured),
        }
    }
}
