//! What the baselines make of cases, and how they are compared.

use crate::common::{judged, opened};
use jointscope_proof::{Baseline, Family, Lookup, Methods, Name, Plan, Role, Share, Updated};

fn plan() -> Plan {
    Plan { cases: 16, seed: 11, families: vec![Family::TwoBlocks], ..Plan::default() }
}

#[test]
fn updating_leaves_a_null_alone_and_bends_quantities_where_something_is_missing() {
    let (cases, truths) = opened(&plan());
    let null = truths.iter().position(|truth| truth.role == Role::Null).unwrap();
    let left_alone = Baseline::of(&cases[null]).unwrap();
    assert!(left_alone.within.fits() && left_alone.nearest.is_none(), "{}", left_alone.within.chi2_per_dof);
    // An attached resonator: no mass, inertia or stiffness has its peak.
    let single = truths.iter().position(|truth| truth.index == 4).unwrap();
    let baseline = Baseline::of(&cases[single]).unwrap();
    assert!(!baseline.within.fits(), "{}", truths[single].hidden());
    assert!(baseline.freed.chi2_per_dof <= baseline.within.chi2_per_dof * 1.01, "wider bounds fit no worse");
    assert!(baseline.nearest.unwrap().likeness > 0.0);
}

#[test]
fn a_misfit_made_by_one_signature_of_the_library_is_looked_up() {
    use jointscope_diagnosis::{Observation, catalogue};
    use jointscope_lumped::{Instrument, synthesize};
    let (cases, _) = opened(&plan());
    let believed = &cases[1].believed;
    let observation = Observation::new(&cases[1].recorded, |_| true).unwrap();
    let candidates = catalogue(believed, &observation);
    let candidate = candidates.iter().find(|c| c.kind.name() == "body_flexibility").unwrap();
    let effect = candidate.effect(1);
    let with = believed.clone().with_physics(vec![effect.clone()]).unwrap();
    let set = synthesize(&with, observation.pairs(), observation.lines(), Instrument::AsRecorded).unwrap();
    let variance = observation.weights().iter().map(|w| 2.0 / w).collect();
    let exact = Observation::new(&set.with_variance(variance).unwrap(), |_| true).unwrap();
    let nearest = Lookup::of(believed, &exact).unwrap();
    assert_eq!(Name::of(&nearest.effect), Name::of(&effect));
    assert!(nearest.likeness > 1.0 - 1e-9, "{}", nearest.likeness);
}

#[test]
fn methods_are_compared_by_their_names_and_by_how_wrong_their_quantities_are() {
    let (cases, truths) = opened(&plan());
    let all: Vec<_> = truths.iter().map(|truth| judged(truth, truth.effects())).collect();
    let believed: Vec<_> = cases.iter().map(|case| &case.believed).collect();
    let baselines: Vec<Option<Baseline>> = truths
        .iter()
        .zip(&cases)
        .map(|(truth, case)| {
            // Updating that has left everything as it was stated, and a lookup that knows the truth.
            let updated = Updated { fixture: case.believed.clone(), chi2_per_dof: 5.0 };
            let nearest =
                truth.effects().first().map(|effect| Lookup { effect: effect.clone(), likeness: 1.0 });
            Some(Baseline { within: updated.clone(), freed: updated, nearest })
        })
        .collect();
    let methods = Methods::of(&all, &believed, &baselines).0;
    let keys: Vec<&str> = methods.iter().map(|method| method.key).collect();
    assert_eq!(keys, ["diagnosis", "within_tolerances", "freed", "nearest_signature"]);
    for named in [methods[0].named, methods[3].named] {
        assert_eq!(named, Some(Share { of: 8, all: 8 }));
    }
    assert_eq!(methods[0].nulls, Some(Share { of: 4, all: 4 }));
    assert_eq!(methods[1].nulls, Some(Share { of: 0, all: 4 }), "what is left there is no noise");
    // The true quantities as an answer are right; stated ones are off by what was drawn, one to four
    // deviations at the worst.
    assert!(methods[0].worst_quantity.unwrap() < 1e-9 && methods[0].unmeasured.unwrap() < 1e-6);
    let worst = methods[1].worst_quantity.unwrap();
    assert!((1.0..4.0).contains(&worst), "{worst}");
    assert!(methods[1].unmeasured.unwrap() > 1e-3);
}
