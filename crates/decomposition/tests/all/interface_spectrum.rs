//! The interfaces line by line: put into a fixture, synthesised, decomposed and found again.

use crate::common::{TwoBlocks, frfs, lines};
use jointscope_decomposition::{
    Analysis, AnalysisOptions, InterfaceLine, InterfaceMask, InterfaceSpectrum, LineSpring, Relation, Sides,
    decompose, interface_spectrum,
};
use jointscope_fixture::JointLaw;
use jointscope_frf::MaskReason;
use jointscope_samples::{ACROSS, Noise};
use jointscope_spectra::{FrfSet, SpectralLines};
use num_complex::Complex64;
use proptest::prelude::*;

/// A spring and its dashpot: N·m/rad and N·m·s/rad, of a translation N/m and N·s/m.
type Spring = (f64, f64);

/// Two blocks on a massless beam without losses, with springs and dashpots at its ends.
#[derive(Debug, Clone)]
struct Case {
    blocks: TwoBlocks,
    near: Spring,
    far: Spring,
    translation: Spring,
}

impl Case {
    fn new(near: Spring, far: Spring, translation: Spring) -> Self {
        let blocks = TwoBlocks { damping: r#"{"loss_factor": 0}"#.into(), ..TwoBlocks::default() };
        Case { blocks, near, far, translation }
    }

    fn recorded(&self, lines: &SpectralLines, window: f64) -> FrfSet {
        let interface = |point: &str, dof: &str, (stiffness, damping): Spring| {
            format!(
                r#"{{"kind": "interface_compliance", "place": "{point}", "dof": "{dof}", "stiffness": {stiffness:e}, "damping": {damping:e}}}"#
            )
        };
        let physics = [
            interface("2", "rotation", self.near),
            interface("3", "rotation", self.far),
            interface("3", "translation", self.translation),
        ];
        let window = match window {
            0.0 => String::new(),
            decay => format!(r#", {{"kind": "exponential_window", "place": "all", "decay": {decay}}}"#),
        };
        let extra = format!(r#", "physics": [{}{window}]"#, physics.join(", "));
        frfs(&TwoBlocks { extra, ..self.blocks.clone() }.fixture(), &ACROSS, lines)
    }

    fn found_under(&self, recorded: &FrfSet, window: f64) -> InterfaceSpectrum {
        let extra = match window {
            0.0 => String::new(),
            decay => {
                format!(
                    r#", "physics": [{{"kind": "exponential_window", "place": "all", "decay": {decay}}}]"#
                )
            }
        };
        let stated = TwoBlocks { extra, ..self.blocks.clone() }.fixture();
        let spectrum = decompose(recorded, &Sides::of(&stated, None).unwrap(), Relation::Exact).unwrap();
        interface_spectrum(&spectrum, self.blocks.bending_stiffness, 0.0).unwrap()
    }

    fn found(&self, recorded: &FrfSet) -> InterfaceSpectrum {
        self.found_under(recorded, 0.0)
    }

    /// Translation, near and far rotation.
    fn truth(&self) -> [Spring; 3] {
        [self.translation, self.near, self.far]
    }
}

/// Glue at both ends, its rotations as stiff as the beam's end (4EI/L = 4.7 kN·m/rad) and half as much again.
fn glued() -> Case {
    Case::new((7.2e3, 0.05), (5.5e3, 0.03), (4e7, 90.0))
}

fn springs(line: &InterfaceLine) -> [Option<LineSpring>; 3] {
    line.all().map(|interface| interface.spring)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn springs_and_dashpots_at_both_ends_of_a_beam_come_back_on_every_line(
        near in 1e3f64..3e4, far in 1e3f64..3e4, across in 5e6f64..5e7, loss in 1e-6f64..2e-5, window in prop::sample::select(vec![0.0, 40.0])
    ) {
        let case = Case::new((near, loss * near), (far, 0.5 * loss * far), (across, loss * across));
        let found = case.found_under(&case.recorded(&lines(), window), window);
        prop_assert_eq!(found.lines.len() + found.masked.len(), 400);
        prop_assert!(found.masked.is_empty());
        for line in &found.lines {
            for (found, (stiffness, damping)) in springs(line).into_iter().zip(case.truth()) {
                let found = found.unwrap();
                let size = stiffness.hypot(std::f64::consts::TAU * line.frequency * damping);
                let omega = std::f64::consts::TAU * line.frequency;
                // The blocks' compliances are larger than the interfaces' as 1/ω², and rounding with them.
                let rounding = 1e-9 * (1.0 + (300.0 / line.frequency).powi(2));
                prop_assert!((found.stiffness - stiffness).abs() < 1e3 * rounding * size, "{} Hz: K {} for {stiffness}", line.frequency, found.stiffness);
                prop_assert!((found.damping - damping).abs() * omega < 1e3 * rounding * size, "{} Hz: C {} for {damping}", line.frequency, found.damping);
                prop_assert!(found.std_of_both().is_none());
            }
        }
    }
}

/// How often stated 95 % intervals hold what was put in: real and imaginary part of each compliance, K and C
/// of each spring.
struct Coverage {
    lines: usize,
    compliances: [[usize; 2]; 3],
    stated: [usize; 3],
    springs: [[usize; 2]; 3],
    /// Mean of χ² per degree of freedom of D12 = D21.
    asymmetry: f64,
}

const RUNS: u32 = 60;

fn coverage(case: &Case, share_of_noise: f64) -> Coverage {
    let clean = case.recorded(&lines(), 0.0);
    let mut noise = Noise::new(11);
    let mut all =
        Coverage { lines: 0, compliances: [[0; 2]; 3], stated: [0; 3], springs: [[0; 2]; 3], asymmetry: 0.0 };
    let inside = |found: f64, truth: f64, std: f64| usize::from((found - truth).abs() < 1.96 * std);
    for _ in 0..RUNS {
        let found = case.found(&noise.on(&clean, share_of_noise));
        all.asymmetry += found.asymmetry().unwrap() / f64::from(RUNS);
        for line in &found.lines {
            all.lines += 1;
            let omega = std::f64::consts::TAU * line.frequency;
            for (e, (interface, (k, c))) in line.all().into_iter().zip(case.truth()).enumerate() {
                let truth = Complex64::new(k, omega * c).inv();
                let std = interface.compliance.std.unwrap();
                all.compliances[e][0] += inside(interface.compliance.value.re, truth.re, std);
                all.compliances[e][1] += inside(interface.compliance.value.im, truth.im, std);
                let Some(spring) = interface.spring else { continue };
                all.stated[e] += 1;
                let (k_std, c_std) = spring.std.unwrap();
                all.springs[e][0] += inside(spring.stiffness, k, k_std);
                all.springs[e][1] += inside(spring.damping, c, c_std);
            }
        }
    }
    all
}

#[test]
fn stated_95_percent_intervals_of_compliances_springs_and_dashpots_cover_the_truth_93_to_97_times_in_100() {
    // At a tenth of a per cent of noise a quarter of the lines tells anything, at a hundredth nearly all.
    for share_of_noise in [1e-3, 1e-4] {
        let all = coverage(&glued(), share_of_noise);
        println!(
            "noise {share_of_noise}: {} of {} lines, D12 = D21 by chi2 per dof {:.3}",
            all.lines,
            400 * RUNS,
            all.asymmetry
        );
        assert!((0.97..1.05).contains(&all.asymmetry), "{}", all.asymmetry);
        assert!(all.lines > 5000);
        let check = |what: &str, of: usize, counts: [usize; 2]| {
            let shares = counts.map(|count| count as f64 / of as f64);
            println!("{what}: {:.1} and {:.1} % of {of}", 100.0 * shares[0], 100.0 * shares[1]);
            assert!(shares.iter().all(|share| (0.93..0.97).contains(share)), "{what} cover {shares:?}");
        };
        for (e, name) in ["translation", "near rotation", "far rotation"].into_iter().enumerate() {
            check(&format!("{name}, compliance"), all.lines, all.compliances[e]);
            if all.stated[e] > 0 {
                check(&format!("{name}, K and C"), all.stated[e], all.springs[e]);
            }
        }
        assert!(all.stated[1].min(all.stated[2]) > 2000, "{:?}", all.stated);
    }
}

#[test]
fn ends_too_stiff_for_the_noise_give_compliances_and_no_stiffness_and_are_counted() {
    // A weld a thousand times as stiff as the beam's end.
    let case = Case::new((4e6, 0.1), (4e6, 0.1), (1e11, 0.0));
    let found = case.found(&Noise::new(3).on(&case.recorded(&lines(), 0.0), 1e-4));
    assert!(found.lines.len() > 200, "{}", found.lines.len());
    let told = found.within_noise().map(|count| found.lines.len() - count);
    assert!(told.into_iter().all(|count| count <= found.lines.len() / 100), "{told:?}");
    assert!(found.lines.iter().all(|line| line.near_rotation.compliance.std.is_some()));
}

#[test]
fn lines_that_cannot_be_solved_or_whose_inverse_noise_hides_are_masked_with_the_reason() {
    let case = glued();
    let from_zero = SpectralLines::even(0.0, 2.5, 401).unwrap();
    let found = case.found(&Noise::new(4).on(&case.recorded(&from_zero, 0.0), 1e-3));
    assert_eq!(found.masked[0], (0, InterfaceMask::Unsolved(MaskReason::ZeroFrequency)));
    let hidden = found.masked.iter().filter(|(_, why)| *why == InterfaceMask::Noise).count();
    assert!(hidden > 200 && found.lines.len() + hidden + 1 == 401, "{hidden} of {}", found.lines.len());
    assert!(found.masked.is_sorted_by_key(|(line, _)| *line));
    assert!(found.lines.iter().all(|line| found.masked.iter().all(|(masked, _)| *masked != line.line)));
}

#[test]
fn a_channel_out_of_calibration_breaks_reciprocity_and_the_lines_say_so() {
    let case = glued();
    let recorded = case.recorded(&lines(), 0.0);
    let mut values = recorded.all_values().to_vec();
    // Sensor 4 reads one per cent high: two of the four FRFs.
    for (index, block) in values.chunks_mut(400).enumerate() {
        let factor = if recorded.pairs()[index].to_string().starts_with('4') { 1.01 } else { 1.0 };
        block.iter_mut().for_each(|value| *value *= factor);
    }
    let gained =
        FrfSet::new(recorded.lines().clone(), recorded.form(), recorded.pairs().to_vec(), values).unwrap();
    let found = |frfs: &FrfSet| case.found(&Noise::new(6).on(frfs, 1e-4)).asymmetry().unwrap();
    assert!(found(&recorded) < 1.2 && found(&gained) > 3.0, "{} {}", found(&recorded), found(&gained));
}

#[test]
fn the_inertia_of_a_joint_with_a_mass_is_taken_out_of_its_interfaces() {
    // A beam of two thirds of the stated EI, 80 g of it: what it yields more than the stated one is
    // r₂ = r₃ = ΔL/2 and t = −ΔL³/6, Δ = 1/EI' − 1/EI.
    let stated = glued().blocks;
    let softer = TwoBlocks {
        bending_stiffness: stated.bending_stiffness / 1.5,
        extra: r#", "physics": [{"kind": "joint_mass", "place": "J", "mass": 0.08}]"#.into(),
        ..stated.clone()
    };
    let recorded = frfs(&softer.fixture(), &ACROSS, &lines());
    let sides = Sides::of(&stated.fixture(), None).unwrap();
    let spectrum = decompose(&recorded, &sides, Relation::Exact).unwrap();
    let (more, length) = (0.5 / stated.bending_stiffness, stated.length);
    let truth = [-more * length.powi(3) / 6.0, 0.5 * more * length, 0.5 * more * length];
    let furthest = |mass: f64, to: f64| {
        let found = interface_spectrum(&spectrum, stated.bending_stiffness, mass).unwrap();
        assert_eq!(found.lines.len(), 400);
        let errors = found.lines.iter().filter(|line| line.frequency <= to).flat_map(|line| {
            let values = line.all().map(|interface| interface.compliance.value);
            std::array::from_fn::<f64, 3, _>(|e| ((values[e] - truth[e]) / truth[e]).norm())
        });
        errors.fold(0.0, f64::max)
    };
    // The beam that was recorded bends by its own inertia besides: 1.8 % at 1000 Hz.
    assert!(furthest(0.08, 700.0) < 0.01 && furthest(0.08, 1000.0) < 0.02, "{:e}", furthest(0.08, 1000.0));
    assert!(furthest(0.0, 1000.0) > 1e3, "{:e}", furthest(0.0, 1000.0));
}

#[test]
fn what_is_not_known_of_the_fixture_counts_as_it_moves_the_interfaces() {
    // Soft enough to be told in spite of what is not known of blocks and beam.
    let case = Case::new((1.2e3, 0.05), (0.9e3, 0.03), (4e6, 90.0));
    let fixture = case.blocks.fixture();
    let noisy = Noise::new(8).on(&case.recorded(&lines(), 0.0), 1e-4);
    let analysis = Analysis::of(&fixture, &noisy, &AnalysisOptions::default()).unwrap();
    let found = analysis.interface_spectrum.unwrap();
    // Compliances with each quantity moved to both sides, by decompositions of their own.
    let moved: Vec<[InterfaceSpectrum; 2]> = fixture
        .quantities()
        .iter()
        .enumerate()
        .filter_map(|(index, quantity)| {
            let std = quantity.std.filter(|std| *std > 0.0)?;
            Some([1.0, -1.0].map(|sign| {
                let mut other = fixture.clone();
                other.set_quantities([(index, quantity.value + sign * 1e-2 * std)]);
                let JointLaw::Beam { youngs_modulus, second_moment } = &other.joints()[0].law else {
                    unreachable!()
                };
                let of_beam = youngs_modulus.value * second_moment.value;
                let sides = Sides::of(&other, None).unwrap();
                let spectrum = decompose(&noisy, &sides, Relation::Exact).unwrap();
                interface_spectrum(&spectrum, of_beam, found.mass).unwrap()
            }))
        })
        .collect();
    assert!(moved.len() > 8, "{}", moved.len());
    let mut checked = 0;
    for line in found.lines.iter().filter(|line| line.frequency > 100.0) {
        let of = |all: &InterfaceSpectrum| all.lines.iter().find(|other| other.line == line.line).copied();
        for (e, interface) in line.all().into_iter().enumerate() {
            let changes: Option<Vec<Complex64>> = moved
                .iter()
                .map(|[up, down]| {
                    let (up, down) = (of(up)?, of(down)?);
                    Some((up.all()[e].compliance.value - down.all()[e].compliance.value) * 50.0)
                })
                .collect();
            let Some(changes) = changes else { continue };
            let squares: f64 = changes.iter().map(|change| change.re * change.re).sum();
            let stated = interface.compliance.std_fixture()[0];
            let expected = squares.sqrt();
            let place = format!("{} Hz, {e}", line.frequency);
            assert!((stated / expected - 1.0).abs() < 0.02, "{place}: {stated:e} for {expected:e}");
            // A spring's relative deviation is its compliance's.
            if let Some(spring) = interface.spring {
                let share = spring.std_fixture.0 / spring.stiffness;
                let of_compliance = stated / interface.compliance.value.re;
                assert!((share / of_compliance - 1.0).abs() < 0.1, "{place}: {share} for {of_compliance}");
                checked += 1;
            }
        }
    }
    assert!(checked > 100, "{checked}");
}

#[test]
fn a_spectrum_by_eq_7_has_no_interfaces_by_line() {
    let case = glued();
    let sides = Sides::of(&case.blocks.fixture(), None).unwrap();
    let spectrum = decompose(&case.recorded(&lines(), 0.0), &sides, Relation::Paper).unwrap();
    assert!(interface_spectrum(&spectrum, case.blocks.bending_stiffness, 0.0).is_none());
}
