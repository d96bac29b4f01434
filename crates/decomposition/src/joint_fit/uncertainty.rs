//! How well the joint is known: by noise and tolerances, by what the model gets wrong, by a fixture stated
//! too surely.

use super::law::Dynamics;
use crate::settings::noise::JACKKNIFE_BLOCKS;
use jointscope_inference::{Covariance, Parameter, birge_ratio, jackknife};

/// k11, k12, k22, c11, c12, c22 in SI units for one unit of a viscous law's coordinates.
pub(super) fn units(law: &Dynamics) -> [f64; 6] {
    let u = &law.unit;
    let elements = [u.at(0, 0), u.at(0, 1), u.at(1, 1)];
    std::array::from_fn(|slot| elements[slot % 3] * if slot < 3 { 1.0 } else { 1.0 / law.middle })
}

/// How far `coordinates` move when each of eight blocks of lines is left out; `step` is the step that other
/// weights lead to.
pub(super) fn jackknifed_by(
    lines: usize,
    weights: &[f64],
    coordinates: &[f64],
    step: impl Fn(&[f64]) -> Option<Vec<f64>>,
) -> Option<Covariance> {
    let blocks = JACKKNIFE_BLOCKS.min(lines);
    let without = |block: usize| {
        let (from, to) = (block * lines / blocks, (block + 1) * lines / blocks);
        let outside = |i: usize| i % lines < from || i % lines >= to;
        let rest: Vec<f64> =
            weights.iter().enumerate().map(|(i, w)| if outside(i) { *w } else { 0.0 }).collect();
        let step = step(&rest)?;
        Some(coordinates.iter().zip(&step).map(|(at, step)| at + step).collect::<Vec<f64>>())
    };
    let fits: Option<Vec<Vec<f64>>> = (0..blocks).map(without).collect();
    Some(jackknife(&fits?))
}

/// Covariance of all coordinates with what the inflation by tolerances and the model's error add.
pub(super) fn total(posterior: &Covariance, inflation: f64, model: Option<&Covariance>) -> Covariance {
    let entries = posterior.entries().iter().enumerate();
    let sum = |(e, v): (usize, &f64)| inflation * v + model.map_or(0.0, |model| model.entries()[e]);
    Covariance::new(posterior.order(), entries.map(sum).collect())
}

/// Squared departures of the quantities (those after the first `own` parameters) from what is stated, per
/// what chance would make of them (Birge's ratio): what of a quantity the FRFs tell may depart, what they do
/// not tell stays. 1 where chance explains them.
pub(super) fn tolerance_inflation(
    parameters: &[Parameter],
    own: usize,
    at: &[f64],
    covariance: &Covariance,
) -> f64 {
    let (mut squares, mut expected) = (0.0, 0.0);
    for (index, parameter) in parameters.iter().enumerate().skip(own) {
        if parameter.precision > 0.0 {
            squares += parameter.squared_departure(at[index]);
            expected += (1.0 - parameter.precision * covariance.at(index, index)).clamp(0.0, 1.0);
        }
    }
    birge_ratio(squares, expected)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inflation_widens_every_coordinate_and_the_models_error_is_added_to_it() {
        let posterior = Covariance::new(2, vec![4.0, 1.0, 1.0, 9.0]);
        let model = Covariance::new(2, vec![0.0, 0.5, 0.5, 7.0]);
        assert_eq!(total(&posterior, 2.0, Some(&model)).entries(), [8.0, 2.5, 2.5, 25.0]);
        assert_eq!(total(&posterior, 3.0, None).std(1), 27.0_f64.sqrt());
    }

    #[test]
    fn the_jackknife_of_a_mean_over_lines_of_several_frfs_is_the_scatter_of_its_blocks() {
        // Three FRFs of 19 lines; the mean of each FRF is a coordinate, found from weights of one.
        let (lines, frfs) = (19, 3);
        let value = |i: usize| (i * i % 17) as f64 + i as f64 / 7.0;
        let mean = |frf: usize, without: &std::ops::Range<usize>| {
            let kept: Vec<f64> = (0..lines)
                .filter(|line| !without.contains(line))
                .map(|line| value(frf * lines + line))
                .collect();
            kept.iter().sum::<f64>() / kept.len() as f64
        };
        let at: Vec<f64> = (0..frfs).map(|frf| mean(frf, &(0..0))).collect();
        let step = |weights: &[f64]| {
            let weighted = |frf: usize| {
                let of = frf * lines..(frf + 1) * lines;
                of.clone().map(|i| weights[i] * value(i)).sum::<f64>() / weights[of].iter().sum::<f64>()
            };
            Some((0..frfs).map(|frf| weighted(frf) - at[frf]).collect())
        };
        let found = jackknifed_by(lines, &[1.0; 57], &at, step).unwrap();
        let fits: Vec<Vec<f64>> = (0..8)
            .map(|block| {
                let without = block * lines / 8..(block + 1) * lines / 8;
                (0..frfs).map(|frf| mean(frf, &without)).collect()
            })
            .collect();
        for (found, expected) in found.entries().iter().zip(jackknife(&fits).entries()) {
            assert!((found - expected).abs() < 1e-12 && *found != 0.0, "{found} for {expected}");
        }
        assert_eq!(jackknifed_by(lines, &[1.0; 57], &at, |_| None), None);
    }

    #[test]
    fn quantities_that_depart_further_than_chance_takes_them_inflate_by_birges_ratio_of_what_is_told_of_them()
    {
        let stated = Parameter::new(jointscope_inference::Transform::Linear { centre: 0.0, scale: 1.0 })
            .with_precision(1.0);
        let parameters =
            [Parameter { precision: 0.0, ..stated }, stated, stated, Parameter { precision: 0.0, ..stated }];
        // Of the first quantity the FRFs tell three quarters, of the second nothing, of the third no one said
        // anything.
        let covariance = Covariance::new(
            4,
            [0.5, 0.25, 1.0, 9.0].iter().enumerate().fold(vec![0.0; 16], |mut all, (i, v)| {
                all[5 * i] = *v;
                all
            }),
        );
        let of = |departures: [f64; 3]| {
            tolerance_inflation(
                &parameters,
                1,
                &[100.0, departures[0], departures[1], departures[2]],
                &covariance,
            )
        };
        assert!((of([3.0, 1.0, 80.0]) - 10.0 / 0.75).abs() < 1e-12);
        // Chance: χ² of 0.75 degrees of freedom above 2.25 once in twelve times.
        assert_eq!(of([1.5, 0.0, 80.0]), 1.0);
        assert_eq!(of([0.1, 0.0, 0.0]), 1.0);
        let undetermined = Covariance::new(4, (0..16).map(|e| f64::from(u8::from(e % 5 == 0))).collect());
        assert_eq!(tolerance_inflation(&parameters, 1, &[0.0, 9.0, 9.0, 9.0], &undetermined), 1.0);
    }
}
