//! The solid against a finer mesh, and against its closed form.

use super::*;
use crate::Plan;
use jointscope_fem::MeshOptions;

/// The case of this number.
fn drawn(seed: u64, number: usize) -> Result<(Case, SolidTruth), GenerationError> {
    SolidTruth::draw(Draw::of(&Plan { seed, ..Plan::default() }, "solid", number, number))
}

/// Elements half as long and thick.
const FINER: MeshOptions = MeshOptions { corner: 8, along: 64, across: 2, growth: 3.0, ..twin::MESH };

/// The first two transverse frequencies.
fn transverse(truth: &SolidTruth, mesh: &MeshOptions) -> [f64; 2] {
    let twin = twin::twin(&truth.solid, &truth.shown, mesh, 1000.0).unwrap();
    let own = twin.frequencies().into_iter().zip(&twin.kinds);
    let mut own = own.filter(|(_, kind)| **kind == jointscope_fem::ModeKind::Transverse).map(|(hz, _)| hz);
    [own.next().unwrap(), own.next().unwrap()]
}

/// The same of the lumped fixture with what is hidden in closed form, all that comes with it included: where
/// its FRF 4/1 peaks about `near`.
fn closed_form(truth: &SolidTruth, near: [f64; 2]) -> [f64; 2] {
    let of_the_strip = |effect: &&Effect| {
        let kinds = [EffectKind::JointMass, EffectKind::InterfaceCompliance, EffectKind::ShearDeformation];
        kinds.contains(&effect.kind)
    };
    let effects = truth.effects().iter().chain(&truth.besides).filter(of_the_strip).cloned().collect();
    let mut value = truth.lumped.clone().with_physics(effects).unwrap().to_value();
    value["damping"] = json!({ "modal_ratios": [1e-4] });
    let fixture = Fixture::from_value(&value).unwrap();
    near.map(|near| {
        let lines: Vec<f64> = (0..2001).map(|i| near * (0.98 + 2e-5 * f64::from(i))).collect();
        let lines = jointscope_spectra::SpectralLines::new(lines).unwrap();
        let pairs = [FrfPair::transverse("4", "1")];
        let set =
            jointscope_rig::frfs(&fixture, &pairs, &lines, jointscope_rig::Instrument::Perfect).unwrap();
        let largest =
            set.values(0).iter().enumerate().max_by(|a, b| a.1.norm().total_cmp(&b.1.norm())).unwrap();
        lines.hz()[largest.0]
    })
}

#[test]
fn the_mesh_is_fine_enough_and_closed_forms_are_those_of_the_solid() {
    // A null, a layer, the shear of a thick strip: there plane sections that blocks hold flat make the solid
    // stiffer than 5/6 GA.
    for (number, allowed) in [(1, 1e-3), (2, 1e-3), (3, 8e-3)] {
        let (_, truth) = drawn(1, number).unwrap();
        let [coarse, fine] = [&twin::MESH, &FINER].map(|mesh| transverse(&truth, mesh));
        let closed = closed_form(&truth, fine);
        let off = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|i| a[i] / b[i] - 1.0);
        let (mesh, form) = (off(coarse, fine), off(closed, fine));
        assert!(mesh.iter().all(|error| error.abs() < 1e-3), "case {number}: {mesh:?} of {fine:?} Hz");
        assert!(form.iter().all(|error| error.abs() < allowed), "case {number}: {form:?} of {fine:?} Hz");
    }
}

#[test]
fn a_truth_reads_back_as_it_was_written_and_gives_the_same_frfs() {
    for number in [2, 4, 11] {
        let (_, truth) = drawn(3, number).unwrap();
        let text = truth.to_value().to_string();
        let read = SolidTruth::from_value(&serde_json::from_str(&text).unwrap()).unwrap();
        assert_eq!(read.to_value().to_string(), text, "case {number}");
        assert_eq!(read.frfs().unwrap(), truth.frfs().unwrap(), "case {number}");
    }
}
