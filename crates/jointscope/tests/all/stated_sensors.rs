//! A sensor that the fixture states, and that loads the structure wherever it is moved to, beside what the fixture
//! leaves out.

use crate::common::{RATIOS, believed, four_pairs, hammer, lines};
use jointscope::fixture::{Dof, Effect, EffectKind, Place, Quantity, Spread};
use jointscope::pipeline::Options;
use jointscope::{Measurement, Outcome, Remarks, answer_file, diagnose};
use jointscope_rig::{Instrument, drawn_within_tolerance, frfs, generator};

#[test]
fn it_is_taken_off_for_the_diagnosis_and_is_in_the_fixtures_that_come_of_it() {
    let mut sensor = Effect::new(EffectKind::SensorMass, Place::Responses, None, &[8e-3]);
    sensor.parameters[0] = Quantity { value: 8e-3, spread: Spread::Stated(1e-4) };
    let fixture = believed(RATIOS).with_physics(vec![sensor.clone()]).unwrap();
    let compliance = Effect::new(
        EffectKind::InterfaceCompliance,
        Place::Point("2".into()),
        Some(Dof::Rotation),
        &[9e3, 0.05],
    );
    let truth = drawn_within_tolerance(&believed(RATIOS), &mut generator(41)).unwrap();
    let truth = truth.with_physics(vec![sensor.clone(), compliance.clone()]).unwrap();
    let recorded = frfs(&truth, &four_pairs(), &lines(), Instrument::AsDescribed).unwrap();
    let measurement = Measurement::from(hammer(41).measure(&recorded).unwrap());
    let answer = diagnose(&fixture, &measurement, &Options::default(), |_| {}).unwrap();
    let Outcome::Linear(diagnosis) = &answer.outcome else { panic!("FRFs") };
    assert_eq!(diagnosis.sensors_off, [sensor.clone()]);
    let [found] = &diagnosis.findings[..] else { panic!("{:?}", diagnosis.findings) };
    assert!(found.effect.is_named_as(&compliance), "{:?}", found.effect);
    assert!(diagnosis.model_error.is_some(), "modes decide, lines that a sensor was taken off do not");
    for (fixture, effects) in [(&answer.refitted, 1), (&answer.repaired, 2)] {
        assert_eq!((&fixture.physics()[0], fixture.physics().len()), (&sensor, effects));
    }
    assert!(
        diagnosis.remarks().iter().any(|said| said.contains("stated sensor mass")),
        "{:?}",
        diagnosis.remarks()
    );
    let file = answer_file(&answer);
    assert_eq!(file["sensors_taken_off"][0]["place"], "responses");
}
