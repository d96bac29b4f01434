//! What the FRFs say of their own channels: a driving point that is one, and reciprocity.

use jointscope_spectra::FrfSet;
use num_complex::Complex64;

use crate::settings::remarks::{NOT_RECIPROCAL, TAKES_OUT};
use crate::{Excitation, Remark};

/// Channels that cannot be as they are said to be.
pub(crate) fn implausible(frfs: &FrfSet, excitations: &[Excitation]) -> Vec<Remark> {
    let to = excitations.iter().map(|e| e.usable_to).fold(f64::INFINITY, f64::min);
    let last = frfs.lines().hz().iter().rposition(|hz| *hz <= to).unwrap_or(0);
    let values = |index: usize| &frfs.values(index)[1..last.max(1)];
    let mut remarks = Vec::new();
    for (index, pair) in frfs.pairs().iter().enumerate() {
        if pair.response == pair.reference && takes_energy_out(values(index)) {
            remarks.push(Remark::DrawsEnergy(pair.clone()));
        }
        let mirrored = frfs
            .pairs()
            .iter()
            .position(|other| other.response == pair.reference && other.reference == pair.response);
        if let Some(other) = mirrored.filter(|other| *other > index) {
            let difference = relative_difference(values(index), values(other));
            let mirrored = &frfs.pairs()[other];
            if difference > NOT_RECIPROCAL {
                let turned: Vec<Complex64> = values(other).iter().map(|v| -v).collect();
                let is_sign = relative_difference(values(index), &turned) < NOT_RECIPROCAL;
                let frfs = [pair.clone(), mirrored.clone()];
                remarks.push(Remark::NotReciprocal { frfs, difference, is_sign });
            }
        }
    }
    remarks
}

/// Whether most of a driving point's accelerance lies below the real axis: the power that a force puts in is
/// ½|F|² Re(A/iω) = ½|F|² Im A/ω.
fn takes_energy_out(values: &[Complex64]) -> bool {
    let (mut out, mut all) = (0.0, 0.0);
    for value in values {
        let size = value.im * value.im;
        all += size;
        if value.im < 0.0 {
            out += size;
        }
    }
    all > 0.0 && out > TAKES_OUT * all
}

/// √(Σ|a − b|² / ½Σ(|a|² + |b|²)).
fn relative_difference(a: &[Complex64], b: &[Complex64]) -> f64 {
    let (mut difference, mut size) = (0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        difference += (a - b).norm_sqr();
        size += 0.5 * (a.norm_sqr() + b.norm_sqr());
    }
    if size > 0.0 { (difference / size).sqrt() } else { 0.0 }
}
