//! Phases of FRFs, in the turn in which they are best read.

use num_complex::Complex64;

/// Phases in degrees; nothing where there is no value or it is zero.
pub(crate) fn degrees(values: impl IntoIterator<Item = Option<Complex64>>) -> Vec<Option<f64>> {
    values.into_iter().map(|v| v.filter(|v| *v != Complex64::ZERO).map(|v| v.arg().to_degrees())).collect()
}

/// Moves the phases (degrees) of several curves into one turn, cut where the fewest neighbouring lines jump over the cut: noise about ±180°
/// would fill the pane.
pub(crate) fn in_the_quietest_turn(curves: &mut [&mut Vec<Option<f64>>]) {
    let jumps = |cut: f64| -> usize {
        let of = |values: &Vec<Option<f64>>| {
            let pairs = values.windows(2).filter_map(|pair| pair[0].zip(pair[1]));
            pairs.filter(|(a, b)| (below(*a, cut) - below(*b, cut)).abs() > 180.0).count()
        };
        curves.iter().map(|values| of(values)).sum()
    };
    let cuts = [180.0, 90.0, 60.0, 45.0, 120.0, 135.0, 150.0, 210.0, 225.0, 240.0, 270.0, 30.0];
    let cut = cuts.into_iter().min_by_key(|cut| jumps(*cut)).unwrap_or(180.0);
    for value in curves.iter_mut().flat_map(|values| values.iter_mut()).flatten() {
        *value = below(*value, cut);
    }
}

/// The phase in the turn that ends at `cut`, degrees.
fn below(degrees: f64, cut: f64) -> f64 {
    cut - (cut - degrees).rem_euclid(360.0)
}
