//! The shipped example.

use crate::common::{chi_squared, frfs_in};
use jointscope_fixture::{Dof, Effect, EffectKind, Place};
use jointscope_rig::glued_joint::{GluedJoint, SEED};
use jointscope_rig::{Instrument, frfs, read};
use std::path::Path;

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let files = || GluedJoint::new(SEED).unwrap().files().unwrap();
    assert_eq!(files(), files());
    assert_ne!(files()[1].1, GluedJoint::new(SEED + 1).unwrap().files().unwrap()[1].1);
}

#[test]
fn the_shipped_recording_is_the_one_of_its_seed() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/glued-joint/hammer-test.uff");
    let test = GluedJoint::new(SEED).unwrap();
    let shipped = frfs_in(&std::fs::read(&path).unwrap(), &test.fixture);
    let made = frfs_in(&test.files().unwrap()[1].1, &test.fixture);
    assert_eq!(shipped.pairs(), made.pairs());
    // Elementary functions differ in their last digit from one machine to another.
    for (a, b) in shipped.all_values().iter().zip(made.all_values()) {
        assert!((a - b).norm() <= 1e-5 * b.norm());
    }
}

#[test]
fn the_recording_is_the_glued_structure_within_its_noise_and_far_from_what_was_believed() {
    let test = GluedJoint::new(SEED).unwrap();
    let recorded = frfs_in(&test.files().unwrap()[1].1, &test.fixture);
    let truth = read(&test.structure, &[], recorded.pairs(), recorded.lines()).unwrap();
    let (chi2, dof) = chi_squared(&recorded, &truth, 10);
    assert!((chi2 / dof - 1.0).abs() < 0.1, "{}", chi2 / dof);
    let believed = frfs(&test.fixture, recorded.pairs(), recorded.lines(), Instrument::Perfect).unwrap();
    assert!(chi_squared(&recorded, &believed, 10).0 > 100.0 * dof);
}

#[test]
fn the_joint_is_about_half_as_stiff_as_believed() {
    let [believed, real] = GluedJoint::new(SEED).unwrap().static_stiffness().unwrap();
    let ratio = real[0][0] / believed[0][0];
    assert!((0.4..0.6).contains(&ratio), "{ratio}");
    assert!((real[0][1] / real[1][0] - 1.0).abs() < 1e-9);
}

#[test]
fn the_stated_static_stiffness_is_what_the_structure_shows_when_block_a_is_held() {
    // Block A held, block B loaded by a unit force at point 3: its slow displacement there is the
    // flexibility.
    let test = GluedJoint::new(SEED).unwrap();
    let flexibility = {
        let [_, k] = test.static_stiffness().unwrap();
        k[1][1] / (k[0][0] * k[1][1] - k[0][1] * k[1][0])
    };
    let mut held = test.structure.assembly().clone();
    for motion in [0, 1] {
        held.spring(&jointscope_rig::Row::coordinate(motion), 1e15, jointscope_rig::Law::ELASTIC);
    }
    let station = test.structure.motion(&jointscope_spectra::Channel::transverse("3")).unwrap().clone();
    let order = held.order();
    let mut lu = jointscope_linalg::LuWorkspace::new();
    lu.factorize(order, |z| held.dynamic_stiffness(num_complex::Complex64::ZERO, z)).unwrap();
    let mut motion = vec![num_complex::Complex64::ZERO; order];
    station.terms().iter().for_each(|&(i, factor)| motion[i] += factor);
    lu.solve_in_place(&mut motion);
    let got: f64 = station.terms().iter().map(|&(i, factor)| motion[i].re * factor).sum();
    assert!((got / flexibility - 1.0).abs() < 1e-6, "{got} instead of {flexibility} m/N");
}

#[test]
fn the_effects_of_the_fixture_file_describe_the_glued_structure_down_to_its_noise() {
    let test = GluedJoint::new(SEED).unwrap();
    let recorded = frfs_in(&test.files().unwrap()[1].1, &test.fixture);
    let layer = |point: &str, dof, stiffness: f64| {
        let values = [stiffness, stiffness * test.layers[0].viscosity];
        Effect::new(EffectKind::InterfaceCompliance, Place::Point(point.into()), Some(dof), &values)
    };
    let of_joint = |kind, value| Effect::new(kind, Place::Joint("J".into()), None, &[value]);
    let mut effects = [
        layer("2", Dof::Rotation, test.layers[0].rotation),
        layer("3", Dof::Rotation, test.layers[1].rotation),
        of_joint(EffectKind::JointMass, test.strip.mass_per_length * test.strip.length),
        of_joint(EffectKind::ShearDeformation, test.strip.shear_stiffness),
        layer("2", Dof::Translation, test.layers[0].translation),
        layer("3", Dof::Translation, test.layers[1].translation),
    ];
    effects[3].parameters.push(jointscope_fixture::Quantity::bare(0.0));
    let mut ratios = Vec::new();
    for count in 0..=effects.len() {
        let model = test.truth.clone().with_physics(effects[..count].to_vec()).unwrap();
        let model = frfs(&model, recorded.pairs(), recorded.lines(), Instrument::Perfect).unwrap();
        let (chi2, dof) = chi_squared(&recorded, &model, 10);
        println!("{count} effects: chi2/dof {:.2}", chi2 / dof);
        ratios.push(chi2 / dof);
    }
    // What is left is the strip's rotary inertia, a few ten-thousandths of the blocks': no effect describes
    // it, and the tolerances of the blocks cover it.
    assert!(ratios[0] > 1e5 && ratios[effects.len()] < 1.5, "{ratios:?}");
}

#[test]
fn the_shipped_fixture_is_the_one_of_the_test() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/glued-joint/fixture.json");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), jointscope_rig::glued_joint::FIXTURE);
}
