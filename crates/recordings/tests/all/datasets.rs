//! FRFs to a universal file and back.

use crate::common::fixture;
use jointscope_recordings::{ReadOptions, Recording, Source, to_datasets};
use jointscope_spectra::{Channel, FrfForm, FrfPair, FrfSet, SpectralLines};
use jointscope_uff::{Abscissa, Encoding, read, write};
use num_complex::Complex64;
use proptest::prelude::*;

fn set(lines: Vec<f64>, form: FrfForm) -> FrfSet {
    let lines = SpectralLines::new(lines).unwrap();
    let theta = FrfPair::new(Channel::rotational("4"), Channel::rotational("2"));
    let pairs = vec![FrfPair::transverse("3", "1"), FrfPair::transverse("4", "1"), theta];
    let values =
        (0..3 * lines.len()).map(|i| Complex64::new(1.0 / (1.0 + i as f64), -0.1 * i as f64)).collect();
    let mut set = FrfSet::new(lines.clone(), form, pairs, values).unwrap();
    set.set_coherence(1, vec![0.75; lines.len()]).unwrap();
    set.set_averages(1, Some(7));
    set
}

fn back(set: &FrfSet, encoding: Encoding) -> FrfSet {
    let bytes = write(&to_datasets(set, "round trip", encoding).unwrap()).unwrap();
    let source = Source { name: "round trip".into(), file: read(&bytes).unwrap() };
    let recording = Recording::of(&[source], &fixture(), &ReadOptions::default()).unwrap();
    assert!(recording.notes.is_empty(), "units are stated, nothing is left out: {:?}", recording.notes);
    recording.frfs().unwrap().clone()
}

proptest! {
    #[test]
    fn frfs_on_any_lines_come_back_from_binary_unchanged(
        start in 0.0f64..100.0, steps in prop::collection::vec(1e-3f64..10.0, 1..40)
    ) {
        let lines = steps.iter().scan(start, |hz, step| { *hz += step; Some(*hz) }).collect();
        let accelerances = set(lines, FrfForm::Accelerance);
        prop_assert_eq!(back(&accelerances, Encoding::default()), accelerances);
    }
}

#[test]
fn frfs_of_every_form_come_back_in_both_encodings() {
    for form in [FrfForm::Receptance, FrfForm::Mobility, FrfForm::Accelerance] {
        for encoding in [Encoding::default(), Encoding::Ascii] {
            let frfs = set((1..=400).map(|i| 2.5 * f64::from(i)).collect(), form);
            let (found, expected) = (back(&frfs, encoding), frfs.to_form(FrfForm::Accelerance).unwrap());
            assert_eq!(found.lines(), expected.lines());
            assert_eq!(
                (found.averages(1), found.coherence(1)),
                (expected.averages(1), expected.coherence(1))
            );
            for (found, expected) in found.all_values().iter().zip(expected.all_values()) {
                assert!(
                    (found - expected).norm() <= 1e-11 * expected.norm(),
                    "{form:?}: {expected}, got {found}"
                );
            }
        }
    }
}

fn spacing(lines: Vec<f64>, encoding: Encoding) -> Result<bool, String> {
    let datasets = to_datasets(&set(lines, FrfForm::Accelerance), "", encoding).map_err(|e| e.to_string())?;
    Ok(matches!(datasets[0].abscissa, Abscissa::Even { .. }))
}

#[test]
fn lines_are_stored_evenly_only_where_the_header_holds_them() {
    let lines = |step: f64| (0..1000).map(|i| 10.0 + step * f64::from(i)).collect::<Vec<_>>();
    assert_eq!(spacing(lines(0.01953125), Encoding::default()), Ok(true));
    assert_eq!(spacing(lines(0.1), Encoding::default()), Ok(true));
    assert_eq!(spacing(lines(1.0 / 3.0), Encoding::default()), Ok(false));
    assert_eq!(spacing(lines(1.0 / 3.0), Encoding::Ascii), Ok(true), "good to ten digits");
    assert_eq!(spacing(vec![1.0, 2.0, 4.0], Encoding::Ascii), Ok(false));
    assert_eq!(spacing(vec![7.25], Encoding::Ascii), Ok(true));
    let message = spacing(vec![1.0, 2.0, 4.00000001], Encoding::Ascii).unwrap_err();
    assert!(message.contains("4.00000001 Hz") && message.contains("binary"), "{message}");
}

#[test]
fn a_point_that_is_no_node_number_is_refused_by_name() {
    for name in ["tip", "007", "-3", "1.5", ""] {
        let lines = SpectralLines::new(vec![1.0]).unwrap();
        let pairs = vec![FrfPair::transverse(name, "1")];
        let frfs = FrfSet::new(lines, FrfForm::Accelerance, pairs, vec![Complex64::ONE]).unwrap();
        let message = to_datasets(&frfs, "", Encoding::default()).unwrap_err().to_string();
        assert!(message.contains(&format!("`{name}`")) && message.contains("whole numbers"), "{message}");
    }
}

#[test]
fn a_long_test_name_is_cut_and_never_refused() {
    let name = "two blocks\nand a beam ".repeat(10);
    let datasets = to_datasets(&set(vec![1.0], FrfForm::Accelerance), &name, Encoding::Ascii).unwrap();
    assert!(datasets[0].id_lines[0].starts_with("two blocks and a beam"));
    assert!(write(&datasets).is_ok());
}
