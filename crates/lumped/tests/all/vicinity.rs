//! Derivatives of meshed beams from one solution, against central differences of many.

use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, Vicinity, accelerances};
use jointscope_spectra::{FrfPair, SpectralLines};
use num_complex::Complex64;

/// What each number multiplies.
const NUMBERS: [&str; 11] = [
    "E·I",
    "mass per length",
    "length",
    "a point mass",
    "its place",
    "the clamp's spring",
    "its rotational spring",
    "another spring",
    "a damping ratio",
    "the shear stiffness",
    "the rotary inertia",
];
/// Relative steps, as far as rounding of element lengths asks for and widths of resonances allow: of
/// derivatives, and of the differences they are compared with.
const STEP: f64 = 2e-5;
const WIDE: f64 = 1e-4;
const HIGHEST: f64 = 1500.0;

/// A strip with two masses: whether it is clamped or free, and whether an effect rebuilds it.
#[derive(Debug, Clone, Copy)]
struct Strip {
    clamped: bool,
    sheared: bool,
}

impl Strip {
    /// Whether it has one of the numbers.
    fn has(self, number: usize) -> bool {
        match number {
            5..=7 => self.clamped,
            9.. => self.sheared,
            _ => true,
        }
    }
}

const CLAMPED: Strip = Strip { clamped: true, sheared: false };

/// A steel strip. The numbers are multiples of what is written here.
fn fixture(strip: Strip, by: &[f64; NUMBERS.len()]) -> Fixture {
    let shear = format!(
        r#", "physics": [{{ "kind": "shear_deformation", "place": "beam", "shear_stiffness": {}, "rotary_inertia": {} }}]"#,
        3e6 * by[9],
        4e-6 * by[10]
    );
    let supports = format!(
        r#", "supports": {{ "clamp": {{ "body": "beam", "x": 0.0, "stiffness": {}, "rotational_stiffness": {} }},
                            "spring": {{ "body": "beam", "x": 0.31, "stiffness": {} }} }}"#,
        1e7 * by[5],
        2e3 * by[6],
        1e5 * by[7]
    );
    let text = format!(
        r#"{{ "bodies": {{
               "beam": {{ "beam": {{ "from": 0, "to": {}, "youngs_modulus": {}, "second_moment": 2.27e-10, "mass_per_length": {} }},
                          "masses": [{{ "x": {}, "mass": {} }}, {{ "x": 0.29, "mass": 0.007 }}] }} }},
             "points": {{ "1": {{ "body": "beam", "x": 0.045 }}, "2": {{ "body": "beam", "x": 0.21 }}, "3": {{ "body": "beam", "x": 0.37 }} }}, "joints": {{}},
             "damping": {{ "modal_ratios": [{}, 0.006] }}{}{} }}"#,
        0.38 * by[2],
        1.6e11 * by[0],
        0.947 * by[1],
        0.12 * by[4],
        0.0107 * by[3],
        0.012 * by[8],
        if strip.clamped { supports } else { String::new() },
        if strip.sheared { shear } else { String::new() }
    );
    Fixture::from_json(&text).unwrap()
}

fn pairs() -> Vec<FrfPair> {
    [("1", "1"), ("2", "1"), ("3", "2")].map(|(o, i)| FrfPair::transverse(o, i)).to_vec()
}

fn lines() -> SpectralLines {
    SpectralLines::new((1..=100).map(|line| 0.01 * HIGHEST * f64::from(line)).collect()).unwrap()
}

fn moved(number: usize, by: f64) -> [f64; NUMBERS.len()] {
    let mut all = [1.0; NUMBERS.len()];
    all[number] += by;
    all
}

/// Fourth-order differences of whole solutions.
fn differences(strip: Strip, number: usize) -> Vec<Complex64> {
    let predicted = |step: f64| {
        accelerances(&fixture(strip, &moved(number, step)), &pairs(), &lines(), Instrument::AsRecorded)
            .unwrap()
    };
    let [near, far] = [WIDE, 2.0 * WIDE].map(|step| {
        let [up, down] = [predicted(step), predicted(-step)];
        up.iter().zip(&down).map(|(u, d)| (u - d) / (2.0 * step)).collect::<Vec<_>>()
    });
    near.iter().zip(&far).map(|(near, far)| (near * 4.0 - far) / 3.0).collect()
}

#[test]
fn derivatives_of_clamped_free_and_rebuilt_beams_are_those_of_whole_solutions() {
    for [clamped, sheared] in [[true, false], [false, false], [true, true], [false, true]] {
        let strip = Strip { clamped, sheared };
        let here = fixture(strip, &[1.0; NUMBERS.len()]);
        let (pairs, lines) = (pairs(), lines());
        // Condensed modes leave a little inertia out, and more of it where sections resist being turned.
        let allowed = |number: usize| match (sheared, NUMBERS[number]) {
            (false, _) => 1e-4,
            (true, "the rotary inertia") => 1.5e-2,
            (true, "length") => 5e-3,
            (true, _) => 2e-4,
        };
        let about = Vicinity::where_it_pays(here, HIGHEST).unwrap();
        for (number, name) in NUMBERS.iter().enumerate().filter(|(n, _)| strip.has(*n)) {
            let [there, back] = [STEP, -STEP].map(|step| {
                let stepped = fixture(strip, &moved(number, step));
                let test = about.beside(&stepped, &pairs, Instrument::AsRecorded).unwrap();
                assert!(test.is_first_order(), "{name}, {strip:?}: a whole solution");
                test.accelerances(&lines).unwrap()
            });
            let expected = differences(strip, number);
            let count = lines.len();
            for (frf, expected) in expected.chunks_exact(count).enumerate() {
                let largest = expected.iter().map(|e| e.norm()).fold(0.0, f64::max);
                for (line, expected) in expected.iter().enumerate() {
                    let value = frf * count + line;
                    let found = (there[value] - back[value]) / (2.0 * STEP);
                    assert!(
                        (found - expected).norm() < allowed(number) * largest,
                        "{name}, {strip:?}, FRF {frf} at {} Hz: {found:.3e} for {expected:.3e}, largest {largest:.3e}",
                        lines.hz()[line]
                    );
                }
            }
        }
    }
}

#[test]
fn what_is_no_small_step_is_solved_for() {
    let about = Vicinity::where_it_pays(fixture(CLAMPED, &[1.0; NUMBERS.len()]), HIGHEST).unwrap();
    // A support a fifth as stiff; a mass that sits elsewhere, and a node with it.
    for (number, by) in [(7, -0.8), (4, 0.1)] {
        let far = fixture(CLAMPED, &moved(number, by));
        let test = about.beside(&far, &pairs(), Instrument::AsRecorded).unwrap();
        assert!(!test.is_first_order(), "{}", NUMBERS[number]);
        let whole = accelerances(&far, &pairs(), &lines(), Instrument::AsRecorded).unwrap();
        assert_eq!(test.accelerances(&lines()).unwrap(), whole, "{}", NUMBERS[number]);
    }
}

#[test]
fn nothing_is_gained_beside_rigid_bodies_and_uniform_free_beams() {
    let rigid = r#"{ "bodies": { "A": { "mass": 1.0, "inertia": 1e-3, "x_cg": 0 } }, "points": { "1": { "body": "A", "x": 0 } }, "joints": {} }"#;
    let beam = r#"{ "bodies": { "B": { "beam": { "from": 0, "to": 1, "youngs_modulus": 2e11, "second_moment": 1e-9, "mass_per_length": 1 } } },
                    "points": { "1": { "body": "B", "x": 0 } }, "joints": {} }"#;
    for text in [rigid, beam] {
        assert!(Vicinity::where_it_pays(Fixture::from_json(text).unwrap(), HIGHEST).is_none());
    }
}
