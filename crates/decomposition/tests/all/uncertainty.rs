//! Whether stated uncertainties are true, by simulation with fixed seeds.

use crate::common::{TwoBlocks, frfs, joint_damping, lines};
use jointscope_averaging::Band;
use jointscope_beam::end_stiffness;
use jointscope_decomposition::{
    Averages, JointLine, JointSpectrum, LikelihoodFit, Relation, Sides, decompose, maximum_likelihood,
};
use jointscope_fixture::Fixture;
use jointscope_linalg::RealMatrix2;
use jointscope_samples::{ACROSS, Noise};
use jointscope_spectra::FrfSet;

struct Truth {
    fixture: Fixture,
    sides: Sides,
    frfs: FrfSet,
    k: RealMatrix2,
    c: RealMatrix2,
}

fn truth() -> Truth {
    // Like example D0: both elastic modes, 75 and 430 Hz, lie within the band.
    let blocks = TwoBlocks {
        mass: [5.36, 5.11],
        half_length: [0.069, 0.066],
        bending_stiffness: 59.3,
        length: 0.0651,
        damping: r#"{"modal_ratios": [0.00716, 0.00172]}"#.into(),
        extra: String::new(),
    };
    let fixture = blocks.fixture();
    Truth {
        sides: Sides::of(&fixture, None).unwrap(),
        frfs: frfs(&fixture, &ACROSS, &lines()),
        k: end_stiffness(blocks.bending_stiffness, blocks.length),
        c: joint_damping(&fixture),
        fixture,
    }
}

fn spectrum(truth: &Truth, frfs: &FrfSet, relation: Relation) -> JointSpectrum {
    decompose(frfs, &truth.sides, relation).unwrap()
}

const ELEMENTS: [(usize, usize); 4] = [(0, 0), (0, 1), (1, 0), (1, 1)];

#[test]
fn by_line_95_percent_intervals_of_k_and_c_cover_the_truth_92_to_98_times_in_100() {
    let truth = truth();
    let mut noise = Noise::new(1);
    for relation in [Relation::Exact, Relation::Paper] {
        let clean = spectrum(&truth, &truth.frfs, relation);
        let expected = spectrum(&truth, &Noise::new(9).on(&truth.frfs, 1e-4), relation);
        let share = |line: &JointLine| expected.solved[line.line].noise_share();
        let mut covered = [[0usize; 4]; 2];
        let mut total = 0;
        for _ in 0..60 {
            let noisy = spectrum(&truth, &noise.on(&truth.frfs, 1e-4), relation);
            // The propagation is of first order: lines that noise dominates are called so and not counted.
            let pairs = noisy.solved.iter().zip(&clean.solved).filter(|(_, clean)| share(clean) < 0.1);
            for (line, true_line) in pairs.step_by(7) {
                let (k_std, c_std) = (line.stiffness_std.unwrap(), line.damping_std.unwrap());
                total += 1;
                for (e, &(i, j)) in ELEMENTS.iter().enumerate() {
                    let inside = |a: f64, b: f64, s: f64| usize::from((a - b).abs() < 1.96 * s);
                    covered[0][e] +=
                        inside(line.stiffness.at(i, j), true_line.stiffness.at(i, j), k_std.at(i, j));
                    covered[1][e] +=
                        inside(line.damping.at(i, j), true_line.damping.at(i, j), c_std.at(i, j));
                }
            }
        }
        println!("{}: {} intervals of {}", relation.name(), total, 60 * 400 / 7);
        assert!(total > 60 * 400 / 7 / 4);
        for (what, counts) in ["K", "C"].iter().zip(covered) {
            for (&(i, j), count) in ELEMENTS.iter().zip(counts) {
                let share = count as f64 / total as f64;
                println!("{} {what}({i},{j}): {:.2} %", relation.name(), 100.0 * share);
                assert!((0.92..0.98).contains(&share), "{} {what}({i},{j}) covers {share}", relation.name());
            }
        }
    }
}

fn fit(truth: &Truth, frfs: &FrfSet) -> LikelihoodFit {
    let spectrum = spectrum(truth, frfs, Relation::Exact);
    maximum_likelihood(frfs, &truth.sides, &spectrum, None, Some(truth.k)).unwrap()
}

#[test]
fn the_maximum_likelihood_fit_is_unbiased_its_intervals_cover_and_its_chi2_is_one() {
    let truth = truth();
    let mut noise = Noise::new(2);
    let runs = 300;
    let mut covered = [0usize; 6];
    let mut chi2 = 0.0;
    for _ in 0..runs {
        let fit = fit(&truth, &noise.on(&truth.frfs, 0.01));
        chi2 += fit.chi2_per_dof / f64::from(runs);
        let sets =
            [(&fit.stiffness, &truth.k, &fit.stiffness_std), (&fit.damping, &truth.c, &fit.damping_std)];
        for (s, (found, expected, std)) in sets.into_iter().enumerate() {
            for (e, (i, j)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
                let error = (found.at(i, j) - expected.at(i, j)).abs();
                covered[3 * s + e] += usize::from(error < 1.96 * std.at(i, j));
            }
        }
    }
    println!("covered {covered:?} of {runs}, chi2 per dof {chi2:.3}");
    assert!((0.97..1.03).contains(&chi2), "{chi2}");
    for (name, count) in ["k11", "k12", "k22", "c11", "c12", "c22"].iter().zip(covered) {
        let share = count as f64 / f64::from(runs);
        // Two standard deviations of a count of 300 at 95 % are 2.5 %.
        assert!((0.92..0.985).contains(&share), "{name} covers {share}");
    }
}

#[test]
fn fitting_the_frfs_beats_averaging_the_spectrum_as_the_noise_allows() {
    let truth = truth();
    let mut noise = Noise::new(3);
    let runs = 60;
    let mut square = [[0.0; 6]; 3];
    for _ in 0..runs {
        let noisy = noise.on(&truth.frfs, 0.01);
        let spectrum = spectrum(&truth, &noisy, Relation::Exact);
        let fitted = fit(&truth, &noisy);
        let band = Some(Band { from: 474.0, to: 843.0 });
        let averages = Averages::of(&spectrum, band, (fitted.stiffness, fitted.damping)).unwrap();
        let weighted =
            Averages::of(&spectrum, Some(Band { from: 2.5, to: 1000.0 }), (fitted.stiffness, fitted.damping))
                .unwrap()
                .weighted
                .unwrap();
        let ways = [
            (averages.plain.stiffness, averages.plain.damping),
            (weighted.stiffness, weighted.damping),
            (fitted.stiffness, fitted.damping),
        ];
        for (row, (k, c)) in square.iter_mut().zip(ways) {
            for (e, (i, j)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
                row[e] += (k.at(i, j) / truth.k.at(i, j) - 1.0).powi(2) / f64::from(runs);
                row[3 + e] += (c.at(i, j) / truth.c.at(i, j) - 1.0).powi(2) / f64::from(runs);
            }
        }
    }
    for (name, row) in
        ["mean over 474-843 Hz", "weighted, all lines", "maximum likelihood"].iter().zip(square)
    {
        println!("{name}: relative rms error {:?}", row.map(|v: f64| format!("{:.2e}", v.sqrt())));
    }
    for e in 0..6 {
        assert!(square[2][e] <= square[1][e] && square[2][e] <= square[0][e], "element {e}: {square:?}");
    }
    assert!(square[2][0].sqrt() < 1e-4 && square[2][3].sqrt() < 0.05, "{square:?}");
}

#[test]
fn intervals_of_both_averages_cover_and_weights_do_not_bias() {
    let truth = truth();
    let mut noise = Noise::new(4);
    let runs = 300;
    let mut covered = [[0usize; 8]; 2];
    let model = (truth.k, truth.c);
    for _ in 0..runs {
        let noisy = spectrum(&truth, &noise.on(&truth.frfs, 1e-3), Relation::Exact);
        let averages = Averages::of(&noisy, Some(Band { from: 474.0, to: 843.0 }), model).unwrap();
        for (row, average) in covered.iter_mut().zip([averages.plain, averages.weighted.unwrap()]) {
            for (e, &(i, j)) in ELEMENTS.iter().enumerate() {
                let inside = |a: f64, b: f64, s: f64| usize::from((a - b).abs() < 1.96 * s);
                row[e] +=
                    inside(average.stiffness.at(i, j), truth.k.at(i, j), average.stiffness_std.at(i, j));
                row[4 + e] +=
                    inside(average.damping.at(i, j), truth.c.at(i, j), average.damping_std.at(i, j));
            }
        }
    }
    println!("plain {:?}\nweighted {:?} of {runs}", covered[0], covered[1]);
    for count in covered.iter().flatten() {
        let share = *count as f64 / f64::from(runs);
        assert!((0.915..0.985).contains(&share), "{covered:?}");
    }
}

#[test]
fn the_plain_mean_chooses_a_band_by_itself_that_is_no_worse_than_all_lines() {
    let truth = truth();
    let noisy = spectrum(&truth, &Noise::new(5).on(&truth.frfs, 0.01), Relation::Exact);
    let chosen = Averages::of(&noisy, None, (truth.k, truth.c)).unwrap();
    let all = Averages::of(&noisy, Some(Band { from: 0.0, to: 2000.0 }), (truth.k, truth.c)).unwrap();
    let product =
        |a: &Averages| ELEMENTS.iter().map(|&(i, j)| a.plain.stiffness_std.at(i, j)).product::<f64>();
    assert!(product(&chosen) < product(&all), "{:e} {:e}", product(&chosen), product(&all));
    assert!(chosen.band.from >= 2.5 && chosen.band.to <= 1000.0 && truth.fixture.joints().len() == 1);
}

#[test]
fn where_a_constant_joint_explains_nothing_its_model_covariance_is_the_scatter_of_fits_to_parts_of_the_band()
{
    // Structural damping: no viscous C is right over the whole band.
    let mut truth = truth();
    let damped = TwoBlocks { damping: r#"{"loss_factor": 0.05}"#.into(), ..TwoBlocks::default() };
    truth.fixture = damped.fixture();
    truth.sides = Sides::of(&truth.fixture, None).unwrap();
    truth.k = end_stiffness(damped.bending_stiffness, damped.length);
    let coarse = jointscope_spectra::SpectralLines::even(20.0, 20.0, 50).unwrap();
    let noisy = Noise::new(5).on(&frfs(&truth.fixture, &ACROSS, &coarse), 1e-3);
    let whole = fit(&truth, &noisy);
    assert!(!whole.explains(), "{}", whole.chi2_per_dof);
    let parts: Vec<[f64; 6]> = (0..8)
        .map(|block| {
            let without = block * 50 / 8..(block + 1) * 50 / 8;
            let part = fit(&truth, &noisy.on_lines(|line| !without.contains(&line)).unwrap());
            let (k, c) = (part.stiffness, part.damping);
            [k.at(0, 0), k.at(0, 1), k.at(1, 1), c.at(0, 0), c.at(0, 1), c.at(1, 1)]
        })
        .collect();
    let mean: [f64; 6] = std::array::from_fn(|m| parts.iter().map(|part| part[m]).sum::<f64>() / 8.0);
    let (k_std, c_std) = whole.model_std();
    let stds = [(0, 0), (0, 1), (1, 1)].map(|(i, j)| (k_std.at(i, j), c_std.at(i, j)));
    for m in 0..6 {
        let squares: f64 = parts.iter().map(|part| (part[m] - mean[m]).powi(2)).sum();
        let expected = (7.0 / 8.0 * squares).sqrt();
        let found = if m < 3 { stds[m].0 } else { stds[m - 3].1 };
        assert!((found / expected - 1.0).abs() < 1e-3, "{m}: {found} for {expected}");
    }
    // Noise that covers the difference gives no reason to look.
    let covered = fit(&truth, &Noise::new(5).on(&frfs(&truth.fixture, &ACROSS, &coarse), 0.3));
    assert!(covered.explains() && covered.model_covariance == [[0.0; 6]; 6], "{}", covered.chi2_per_dof);
}
