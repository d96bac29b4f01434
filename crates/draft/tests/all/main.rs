//! Drafted fixtures against closed forms.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

use jointscope_draft::{Bar, Draft, DraftError, Structure};
use jointscope_fixture::{BodyKind, Fixture, JointLaw};
use jointscope_lumped::Assembly;
use std::f64::consts::{PI, TAU};

fn bar(text: &str) -> Bar {
    text.parse().unwrap()
}

fn near(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "{found} instead of {expected}");
}

fn blocks() -> Fixture {
    let structure = Structure::Blocks {
        blocks: [bar("50x50x80:steel"), bar("40x60x30:aluminium")],
        strip: bar("60x40x6:brass"),
    };
    Draft::new(structure).fixture().unwrap()
}

fn first_modes(fixture: &Fixture, highest: f64) -> Vec<f64> {
    let hz = Assembly::new(fixture, highest).unwrap().natural_frequencies_hz();
    hz.into_iter().filter(|hz| *hz > 0.0).collect()
}

#[test]
fn blocks_weigh_and_turn_as_cuboids_do_and_the_strip_bends_as_a_rectangle() {
    let fixture = blocks();
    let expected = [(7850.0, 0.05, 0.05, 0.08, -0.025), (2700.0, 0.04, 0.06, 0.03, 0.08)];
    for (body, (density, length, width, height, centre)) in fixture.bodies().iter().zip(expected) {
        let BodyKind::Rigid(rigid) = &body.kind else { panic!("a block is rigid") };
        let mass: f64 = density * length * width * height;
        near(rigid.mass.value, mass, 1e-5);
        near(rigid.inertia.unwrap().value, mass * (length * length + height * height) / 12.0, 1e-5);
        near(rigid.x_cg.unwrap().value, centre, 1e-5);
    }
    let joint = fixture.joint("J").unwrap();
    let JointLaw::Beam { youngs_modulus, second_moment } = &joint.law else { panic!("the strip is a beam") };
    near(youngs_modulus.value * second_moment.value, 1e11 * 0.04 * 0.006f64.powi(3) / 12.0, 1e-5);
    near(fixture.joint_length(joint), 0.06, 1e-9);
    // The solid weighs the same.
    let geometry = fixture.geometry().unwrap();
    for (solid, body) in geometry.bodies.iter().zip(fixture.bodies()) {
        let BodyKind::Rigid(rigid) = &body.kind else { panic!("a block is rigid") };
        let material = &geometry.materials[solid.material].1;
        near(solid.mass(material), rigid.mass.value, 1e-5);
        near(solid.inertia(material), rigid.inertia.unwrap().value, 1e-5);
    }
}

#[test]
fn deviations_are_those_of_ruler_and_material() {
    let fixture = blocks();
    let quantity = |path: &str| {
        let found = fixture.quantities().into_iter().find(|quantity| quantity.path == path).unwrap();
        found.std.unwrap() / found.value.abs()
    };
    let mass = (0.005f64.powi(2) + (0.1f64 / 50.0).powi(2) * 2.0 + (0.1f64 / 80.0).powi(2)).sqrt();
    near(quantity("bodies/A/mass"), mass, 0.05);
    near(
        quantity("joints/J/beam/second_moment"),
        ((0.1f64 / 40.0).powi(2) + (0.3f64 / 6.0).powi(2)).sqrt(),
        0.05,
    );
    near(quantity("joints/J/beam/youngs_modulus"), 0.05, 0.05);
}

#[test]
fn beams_have_the_natural_frequencies_of_the_closed_form_free_and_clamped() {
    let (modulus, density, length, height) = (7e10f64, 2700.0, 0.4f64, 0.005);
    let beam =
        |clamped| Draft::new(Structure::Beam { bar: bar("400x30x5:aluminium"), clamped }).fixture().unwrap();
    // √(EI/ρA) of a rectangle is h √(E/12ρ).
    let closed = |beta: f64| (beta / length).powi(2) / TAU * height * (modulus / (12.0 * density)).sqrt();
    let free = first_modes(&beam(false), 1500.0);
    for (hz, beta) in free.iter().zip([4.730_040_745, 7.853_204_624, 10.995_607_838]) {
        near(*hz, closed(beta), 1e-3);
    }
    let clamped = first_modes(&beam(true), 1500.0);
    for (hz, beta) in clamped.iter().zip([1.875_104_069, 4.694_091_133, 7.854_757_438]) {
        // A clamp of finite stiffness lowers the third by 0.13 %.
        near(*hz, closed(beta), 2e-3);
    }
}

#[test]
fn a_frame_of_equal_storeys_has_the_natural_frequencies_of_the_closed_form() {
    let (storeys, mass) = (4, 3.5);
    let structure = Structure::Frame { storeys, mass, column: bar("300x25x6:aluminium"), columns: 4 };
    let fixture = Draft::new(structure).fixture().unwrap();
    let stiffness: f64 = 4.0 * 12.0 * 7e10 * 0.025 * 0.006f64.powi(3) / 12.0 / 0.3f64.powi(3);
    let modes = first_modes(&fixture, 500.0);
    assert_eq!(modes.len(), storeys);
    for (index, hz) in modes.iter().enumerate() {
        let sine = ((2 * index + 1) as f64 * PI / (2.0 * (2 * storeys + 1) as f64)).sin();
        near(*hz, 2.0 * (stiffness / mass).sqrt() * sine / TAU, 1e-4);
    }
}

#[test]
fn a_draft_that_is_written_and_read_again_is_the_same() {
    let beam = Structure::Beam { bar: bar("500x40x6:2.1e11,7800"), clamped: true };
    for structure in
        [beam, Structure::Frame { storeys: 2, mass: 1.5, column: bar("200x20x2:steel"), columns: 2 }]
    {
        let fixture = Draft::new(structure).fixture().unwrap();
        assert_eq!(Fixture::from_json(&fixture.to_json()).unwrap(), fixture);
        assert!(fixture.notes().len() >= 3);
    }
    assert_eq!(Fixture::from_json(&blocks().to_json()).unwrap(), blocks());
}

#[test]
fn points_of_a_recording_are_placeholders_that_the_notes_name() {
    let points: Vec<String> = ["101", "102", "103", "104", "105"].map(String::from).to_vec();
    let structure = Structure::Blocks {
        blocks: [bar("50x50x50:steel"), bar("50x50x50:steel")],
        strip: bar("60x40x6:steel"),
    };
    let draft = Draft { points: points.clone(), ..Draft::new(structure) };
    let fixture = draft.fixture().unwrap();
    let on = |name: &str| fixture.bodies()[fixture.point(name).unwrap().body].name.clone();
    assert_eq!(points.iter().map(|name| on(name)).collect::<String>(), "AAABB");
    let unknown: Vec<String> =
        fixture.quantities().into_iter().filter(|q| q.std.is_none()).map(|q| q.path).collect();
    assert!(points.iter().all(|name| unknown.contains(&format!("points/{name}/x"))), "{unknown:?}");
    assert!(fixture.notes().iter().any(|note| note.starts_with("FILL IN") && note.contains("101, 102")));
}

#[test]
fn what_cannot_be_built_is_told_in_a_sentence() {
    let refused = |blocks: [&str; 2], strip: &str| {
        let structure = Structure::Blocks { blocks: blocks.map(bar), strip: bar(strip) };
        Draft::new(structure).fixture().unwrap_err().to_string()
    };
    let told = refused(["50x50x50:steel", "50x30x50:steel"], "60x40x6:steel");
    assert!(told.contains("the strip is 40.0 mm wide and block B only 30.0 mm"), "{told}");
    let frame = |storeys, mass| {
        let structure = Structure::Frame { storeys, mass, column: bar("200x20x2:steel"), columns: 4 };
        Draft::new(structure).fixture()
    };
    assert_eq!(frame(0, 1.0), Err(DraftError::Storeys { storeys: 0, columns: 4 }));
    assert_eq!(frame(3, -1.0), Err(DraftError::Mass(-1.0)));
    for (text, part) in [
        ("60x40:steel", "LENGTHxWIDTHxHEIGHT"),
        ("60x40x0:steel", "above zero"),
        ("60x40x6", "60x40x6:steel"),
        ("60x40x6:cheese", "take one of steel"),
        ("60x40x6:2e11", "2.07e11,7850"),
        ("60x40x6:nan,7800", "2.07e11,7850"),
    ] {
        let told = text.parse::<Bar>().unwrap_err().to_string();
        assert!(told.contains(part), "{text}: {told}");
    }
}

#[test]
fn storeys_beyond_the_points_of_a_recording_take_names_that_no_point_has() {
    let structure = Structure::Frame { storeys: 4, mass: 3.5, column: bar("300x25x6:aluminium"), columns: 4 };
    let draft = Draft { points: vec!["2".into(), "3".into()], ..Draft::new(structure) };
    let fixture = draft.fixture().unwrap();
    let names: Vec<&str> = fixture.points().iter().map(|point| point.name.as_str()).collect();
    assert_eq!(names.len(), 4, "{names:?}");
    assert!(["1", "2", "3", "4"].iter().all(|name| names.contains(name)), "{names:?}");
}

/// Two blocks of 60 mm with a strip of 65 mm between them, and points at these places of a recording's
/// geometry, mm.
fn placed(places: &[(&str, f64)], origin: Option<f64>) -> Result<Fixture, DraftError> {
    let structure = Structure::Blocks {
        blocks: [bar("60x50x50:steel"), bar("60x50x50:steel")],
        strip: bar("65x30x5:steel"),
    };
    let placed = places.iter().map(|(name, x)| (name.to_string(), 1e-3 * x)).collect();
    Draft { placed, origin: origin.map(|mm| 1e-3 * mm), ..Draft::new(structure) }.fixture()
}

/// A point's body and abscissa, mm.
fn place(fixture: &Fixture, name: &str) -> (String, f64) {
    let point = fixture.point(name).unwrap();
    (fixture.bodies()[point.body].name.clone(), (1e6 * point.x.value).round() / 1e3)
}

#[test]
fn points_of_a_geometry_lie_on_the_bodies_at_their_places() {
    let fixture = placed(&[("1", -55.0), ("2", 0.0), ("7", 30.0), ("3", 65.0), ("4", 120.0)], None).unwrap();
    assert_eq!(place(&fixture, "1"), ("A".into(), -55.0));
    assert_eq!(place(&fixture, "2"), ("A".into(), 0.0));
    assert_eq!(place(&fixture, "4"), ("B".into(), 120.0));
    assert!(
        fixture.point("7").is_none()
            && fixture.notes().iter().any(|note| note.contains("points 7 lie between"))
    );
    // The same in a geometry that begins elsewhere: stated, and by the middles.
    for origin in [Some(1000.0), None] {
        let moved = placed(&[("1", 945.0), ("4", 1120.0)], origin).unwrap();
        assert_eq!(place(&moved, "1"), ("A".into(), -55.0), "{origin:?}");
        assert_eq!(moved.notes().iter().any(|note| note.contains("CHECK")), origin.is_none());
    }
}

#[test]
fn points_that_no_body_reaches_are_refused_with_their_places() {
    let told = placed(&[("1", 0.0), ("2", 400.0)], None).unwrap_err().to_string();
    assert!(told.contains("over 400.0 mm and the structure only over 185.0 mm"), "{told}");
    let told = placed(&[("1", 0.0), ("2", 60.0)], Some(-100.0)).unwrap_err().to_string();
    assert!(told.contains("point 2 would lie at x = 160.0 mm"), "{told}");
    let frame = Structure::Frame { storeys: 2, mass: 1.0, column: bar("200x20x2:steel"), columns: 2 };
    let draft = Draft { placed: vec![("1".into(), 0.0)], ..Draft::new(frame) };
    assert_eq!(draft.fixture(), Err(DraftError::Frame));
    assert_eq!(Draft::new(Structure::Unknown).fixture(), Err(DraftError::Nothing));
}

#[test]
fn a_bar_of_negative_length_is_refused_wherever_its_points_are() {
    let shortened = Bar { length: -1e-4, ..bar("60x50x50:steel") };
    let structure =
        Structure::Blocks { blocks: [shortened, bar("60x50x50:steel")], strip: bar("65x30x5:steel") };
    let draft = Draft { placed: vec![("1".into(), 0.0)], origin: Some(0.0), ..Draft::new(structure) };
    assert!(matches!(draft.fixture(), Err(DraftError::Fixture(_))), "{:?}", draft.fixture());
}

#[test]
fn points_alone_make_a_fixture_whose_masses_are_free() {
    let placed: Vec<(String, f64)> = vec![("5".into(), 0.2), ("6".into(), 0.5)];
    let fixture = Draft { placed, ..Draft::new(Structure::Unknown) }.fixture().unwrap();
    assert_eq!(place(&fixture, "6"), ("body".into(), 500.0));
    let free: Vec<String> =
        fixture.quantities().into_iter().filter(|q| q.std.is_none()).map(|q| q.path).collect();
    assert_eq!(free, ["bodies/body/mass", "bodies/body/inertia", "bodies/body/x_cg"]);
    assert!(fixture.notes().iter().any(|note| note.starts_with("FILL IN")));
}
