//! How wrong a model may be: kinds of error with their scales, and the covariance that they make of the
//! features.
//!
//! Errors of different kinds are independent, and so are those of different modes. An error of a shape at a
//! channel is common to all FRFs of that channel. An error of a damping ratio is one of the damping by which
//! the shape's phases are turned too: what of the residues is in quadrature for that reason errs by the same
//! share.

use crate::basis::Pole;
use crate::matching::Pairing;
use crate::modelled::ModelledModes;
use crate::recorded::{Offsets, RecordedModes};
use crate::settings::errors::{
    HELD_SHARE, LARGEST_STRUCK_GAIN, LEAST_SIZE, LEAST_TERM_SQUARED, OF_LOWEST, USUAL_DAMPING,
    USUAL_FREQUENCY, USUAL_GAIN, USUAL_MASS_LINE, USUAL_QUADRATURE, USUAL_SHAPE, USUAL_STRIKE,
    USUAL_UPPER_RESIDUAL,
};
use crate::shapes::Shapes;
use std::sync::Arc;

/// Sizes of a model's error by kind, as standard deviations, relative ones (0.003 is 0.3 %) but for places:
/// what is known of them before, or what a recording says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorSizes {
    /// Of every natural frequency.
    pub frequency: f64,
    /// Of every damping ratio.
    pub damping: f64,
    /// Of every mode's shape at every channel, against the shape's root mean square, and of its modal mass.
    pub shape: f64,
    /// The same in quadrature: the imaginary part of the residues.
    pub quadrature: f64,
    /// Of every FRF's mass line.
    pub mass_line: f64,
    /// Of upper residuals: of all FRFs' alike, and of each by itself.
    pub upper_residual: f64,
    /// Of every FRF's gain, the same in all of its modes: sensors turned, hits off the point.
    pub gain: f64,
    /// Of the place of every sensor and of every reference's impacts, m: how far beside its point it is.
    pub strike: f64,
}

/// Number of kinds.
pub const KINDS: usize = 8;
/// Place of natural frequencies among them.
pub const FREQUENCY: usize = 0;
/// Place of damping ratios among them.
pub const DAMPING: usize = 1;
/// Place of shapes among them.
pub const SHAPE: usize = 2;
const QUADRATURE: usize = 3;
const MASS_LINE: usize = 4;
/// Place of upper residuals among them.
pub const UPPER_RESIDUAL: usize = 5;
/// Place of the upper residual among residual terms.
const UPPER: usize = 1;
/// Place of gains among them.
pub const GAIN: usize = 6;
/// Place of the places of sensors and impacts among them.
pub const STRIKE: usize = 7;

impl Default for ErrorSizes {
    /// What lumped models of machined parts are wrong by: 0.3 % in natural frequencies, 10 % in damping
    /// ratios, 0.5 % in shapes, 0.05 % in quadrature, 0.1 % in mass lines, 15 % in upper residuals, 1 % in
    /// gains; and 1 mm in where hammers strike. Meant as the scales of half-normal priors, of gains of a
    /// half-Cauchy one: fixed beforehand, not fitted.
    fn default() -> Self {
        ErrorSizes {
            frequency: USUAL_FREQUENCY,
            damping: USUAL_DAMPING,
            shape: USUAL_SHAPE,
            quadrature: USUAL_QUADRATURE,
            mass_line: USUAL_MASS_LINE,
            upper_residual: USUAL_UPPER_RESIDUAL,
            gain: USUAL_GAIN,
            strike: USUAL_STRIKE,
        }
    }
}

impl ErrorSizes {
    /// Multiple of its usual size below which an error is none: what is told from noise lies far above.
    pub const LEAST: f64 = LEAST_SIZE;

    /// In the order of the fields.
    pub fn to_array(self) -> [f64; KINDS] {
        let ErrorSizes { frequency, damping, shape, quadrature, mass_line, upper_residual, gain, strike } =
            self;
        [frequency, damping, shape, quadrature, mass_line, upper_residual, gain, strike]
    }

    /// All of them times a factor.
    pub fn times(self, factor: f64) -> Self {
        ErrorSizes::from_array(self.to_array().map(|size| factor * size))
    }

    /// The same with `share` of the errors of natural frequency and damping.
    pub fn following(self, share: f64) -> Self {
        ErrorSizes { frequency: share * self.frequency, damping: share * self.damping, ..self }
    }

    /// Size by size the larger one.
    pub fn larger(self, other: Self) -> Self {
        self.with(other, f64::max)
    }

    /// Size by size the smaller one.
    pub fn smaller(self, other: Self) -> Self {
        self.with(other, f64::min)
    }

    fn with(self, other: Self, of: fn(f64, f64) -> f64) -> Self {
        let (own, other) = (self.to_array(), other.to_array());
        ErrorSizes::from_array(std::array::from_fn(|kind| of(own[kind], other[kind])))
    }

    /// From the order of the fields.
    pub fn from_array(sizes: [f64; KINDS]) -> Self {
        let [frequency, damping, shape, quadrature, mass_line, upper_residual, gain, strike] = sizes;
        ErrorSizes { frequency, damping, shape, quadrature, mass_line, upper_residual, gain, strike }
    }
}

/// What is known of the sizes of a model's error before a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizePrior {
    /// Scales of the sizes' priors; of those that are stated the sizes themselves.
    pub scales: ErrorSizes,
    /// Which sizes are stated, in the order of [`ErrorSizes`]: they are taken as they are.
    pub stated: [bool; KINDS],
}

impl From<&ErrorSizes> for SizePrior {
    /// Nothing stated.
    fn from(scales: &ErrorSizes) -> Self {
        SizePrior { scales: *scales, stated: [false; KINDS] }
    }
}

/// The features that a recording and a model both have, and what each kind of error makes of them.
#[derive(Debug, Clone)]
pub struct SharedFeatures {
    /// Places of the compared features among the recording's.
    pub(crate) places: Vec<usize>,
    /// Covariance of the recorded features.
    pub(crate) noise: Arc<[f64]>,
    /// What of the paired modes' residues is in quadrature because of the structure's damping, FRF by FRF.
    turned: Vec<f64>,
    /// By paired mode, the share of its recorded damping that is the structure's: the rest is that of an
    /// exponential window, which nothing is wrong with.
    own_damping: Vec<f64>,
    /// What of the features in quadrature would be otherwise if the structure's damping were distributed
    /// otherwise: all of it or nothing, as one unknown of size one. Empty where that is not in question.
    distributed: Vec<(usize, f64)>,
    /// The same if it were structural and not viscous, or the reverse.
    structural: Vec<(usize, f64)>,
    /// Whether the structure's damping is taken to turn no shape, however the model distributes it.
    in_phase: bool,
    /// Place of the first residue among the compared features.
    pub(crate) first_residue: usize,
    /// By kind, the covariance for a size of one.
    pub(crate) kinds: Vec<Entries>,
    /// What errors of a shape at both channels of an FRF make together, for a size of one each: of residues'
    /// real parts, and of their imaginary parts.
    both: [Entries; 2],
    /// What displacements of sensor and impacts make of residues together, for a metre each, and what those of
    /// either and an error of the gain make, for a metre and a size of one.
    pub(crate) struck: [Entries; 2],
}

/// Entries of the lower triangle of a symmetric matrix that are not zero, by their place in it, row-major.
pub(crate) type Entries = Vec<(usize, f64)>;

/// Puts an entry of a matrix of order `n` among the others, if it is of the lower triangle and not zero.
pub(crate) fn put(entries: &mut Entries, n: usize, (i, j): (usize, usize), value: f64) {
    if j <= i && value != 0.0 {
        entries.push((i * n + j, value));
    }
}

/// Errors of the terms below and above the band, the first of them at `first` among `n` features: as shapes'
/// errors make them, and relative to their sizes. What is held to ground has no mass line, and what a free fit
/// writes there, the end of a record and what a window left of it, is relative to the lowest mode.
fn add_residual_terms(
    kinds: &mut [Entries],
    recorded: &RecordedModes,
    modelled: &ModelledModes,
    (n, first): (usize, usize),
) {
    let frfs = recorded.frfs();
    let squares: f64 = modelled.residual_terms.iter().map(|terms| terms[0] * terms[0]).sum();
    let of_model = (squares / frfs as f64).sqrt();
    let lowest = recorded.modes.first().map_or(0.0, |mode| mode.scale);
    let held =
        if of_model < HELD_SHARE * lowest { OF_LOWEST * lowest / recorded.residual_scales[0] } else { 0.0 };
    let least = [LEAST_TERM_SQUARED.max(held * held), LEAST_TERM_SQUARED];
    for (e, shared) in recorded.low.iter().enumerate() {
        let place = (first + 2 * (e / frfs), first + 2 * (e % frfs));
        put(&mut kinds[SHAPE], n, place, shared / recorded.residual_scales[0].powi(2));
    }
    let relative =
        |frf: usize, term: usize| recorded.residual_terms[frf][term] / recorded.residual_scales[term];
    for frf in 0..frfs {
        for (term, kind) in [(0, MASS_LINE), (UPPER, UPPER_RESIDUAL)] {
            let at = first + 2 * frf + term;
            // Relative to what is there, and where little is there to the others.
            put(&mut kinds[kind], n, (at, at), relative(frf, term).powi(2).max(least[term]));
        }
    }
    // What a model lacks above the band it lacks in all FRFs.
    for a in 0..frfs {
        for b in 0..=a {
            let places = (first + 2 * a + UPPER, first + 2 * b + UPPER);
            put(&mut kinds[UPPER_RESIDUAL], n, places, relative(a, UPPER) * relative(b, UPPER));
        }
    }
}

/// An FRF's gain changes its features in proportion to what the model makes of them.
fn add_gains(
    kind: &mut Entries,
    recorded: &RecordedModes,
    (pairing, modelled): (&Pairing, &ModelledModes),
    (n, first): (usize, usize),
) {
    let frfs = recorded.frfs();
    for frf in 0..frfs {
        let mut of_frf = Vec::new();
        for (k, &(r, m)) in pairing.pairs.iter().enumerate() {
            let at = 2 * pairing.pairs.len() + 2 * k * frfs + 2 * frf;
            let residue = modelled.modes[m].residues[frf] / recorded.modes[r].scale;
            of_frf.extend([(at, residue.re), (at + 1, residue.im)]);
        }
        for term in 0..2 {
            let value = modelled.residual_terms[frf][term] / recorded.residual_scales[term];
            of_frf.push((first + 2 * frf + term, value));
        }
        for &(i, a) in &of_frf {
            of_frf.iter().for_each(|&(j, b)| put(kind, n, (i, j), a * b));
        }
    }
}

impl SharedFeatures {
    /// Of the modes that are paired, with the model's modes and shapes.
    pub fn new(
        recorded: &RecordedModes,
        pairing: &Pairing,
        modelled: &ModelledModes,
        shapes: &Shapes,
    ) -> Self {
        let (modes, frfs, all) = (recorded.modes.len(), recorded.frfs(), recorded.count());
        let mut places = Vec::new();
        for &(r, _) in &pairing.pairs {
            places.extend([2 * r, 2 * r + 1]);
        }
        let of_residues = |r: usize| 2 * modes + 2 * r * frfs;
        for &(r, _) in &pairing.pairs {
            places.extend(of_residues(r)..of_residues(r) + 2 * frfs);
        }
        places.extend(2 * modes + 2 * modes * frfs..all);
        let n = places.len();
        let entry = |e: usize| recorded.covariance[places[e / n] * all + places[e % n]];
        let noise = (0..n * n).map(entry).collect();
        let mut kinds = vec![Entries::new(); KINDS];
        let matched = pairing.pairs.len();
        let mut turned = Vec::with_capacity(matched * frfs);
        let own = |&(r, _): &(usize, usize)| own_share(&recorded.modes[r].pole, modelled.window_decay);
        let own_damping: Vec<f64> = pairing.pairs.iter().map(own).collect();
        let mut both = [Entries::new(), Entries::new()];
        for k in 0..matched {
            put(&mut kinds[FREQUENCY], n, (2 * k, 2 * k), 1.0);
        }
        for (k, &(r, m)) in pairing.pairs.iter().enumerate() {
            let scale = recorded.modes[r].scale;
            let first = 2 * matched + 2 * k * frfs;
            turned.extend(shapes.quadrature[m].iter().map(|quadrature| quadrature / scale));
            for a in 0..frfs {
                // Near a node of a channel the product of both errors is all there is.
                let product = (shapes.mean_square(m) / scale).powi(2);
                for (part, both) in both.iter_mut().enumerate() {
                    both.push(((first + 2 * a + part) * (n + 1), product));
                }
                for b in 0..=a {
                    let shared = shapes.shared(m, a, b) / scale.powi(2);
                    // A modal mass errs as a shape does, and all residues of its mode with it.
                    let of_mass =
                        modelled.modes[m].residues[a].re * modelled.modes[m].residues[b].re / scale.powi(2);
                    let (a, b) = (first + 2 * a, first + 2 * b);
                    put(&mut kinds[SHAPE], n, (a, b), shared + of_mass);
                    put(&mut kinds[QUADRATURE], n, (a + 1, b + 1), shared);
                }
            }
        }
        let first = 2 * matched + 2 * matched * frfs;
        add_residual_terms(&mut kinds, recorded, modelled, (n, first));
        add_gains(&mut kinds[GAIN], recorded, (pairing, modelled), (n, first));
        kinds[DAMPING] = of_damping(n, frfs, &turned, &own_damping);
        SharedFeatures {
            places,
            noise,
            turned,
            distributed: Vec::new(),
            structural: of_structural_damping(recorded, (pairing, modelled), &own_damping),
            in_phase: false,
            own_damping,
            first_residue: 2 * matched,
            kinds,
            both,
            struck: [Entries::new(), Entries::new()],
        }
    }

    /// The same where nobody knows how the structure's damping is distributed: whether as these `shapes` of
    /// the paired modes have it, or so that it turns no phases.
    pub fn with_damping_distributed_otherwise(
        mut self,
        recorded: &RecordedModes,
        pairing: &Pairing,
        shapes: &Shapes,
    ) -> Self {
        let frfs = recorded.frfs();
        for (k, &(r, m)) in pairing.pairs.iter().enumerate() {
            let first = self.first_residue + 2 * k * frfs;
            for (frf, quadrature) in shapes.quadrature[m].iter().enumerate() {
                let part = quadrature / recorded.modes[r].scale;
                self.distributed.push((first + 2 * frf + 1, part));
                self.turned[k * frfs + frf] -= part;
            }
        }
        self.kinds[DAMPING] = of_damping(self.count(), frfs, &self.turned, &self.own_damping);
        self
    }

    /// Whether damping whose distribution is in question turns a residue by more than its noise.
    pub fn turns_phases(&self) -> bool {
        let n = self.count();
        self.distributed.iter().any(|&(place, part)| part * part > self.noise[place * (n + 1)])
    }

    /// The same where the structure's damping turns no shape, whatever the model's does. As one unknown
    /// ([`SharedFeatures::with_damping_distributed_otherwise`]) that is said of the shapes where a fit sets out:
    /// on the way it turns others, and comes to rest where the model turns none, which may be where an effect is
    /// nothing.
    pub fn with_shapes_in_phase(self) -> Self {
        SharedFeatures { in_phase: true, ..self.with_ratios_alone() }
    }

    /// Whether the structure's damping is taken to turn no shape.
    pub fn is_in_phase(&self) -> bool {
        self.in_phase
    }

    /// The same where the structure's damping is distributed as the model has it, and of its law.
    pub fn with_damping_as_modelled(mut self) -> Self {
        self.distributed.clear();
        self.structural.clear();
        self
    }

    /// The same with errors of the damping that change the modes' damping ratios alone, and no phases: for a
    /// fit that sets out from where damping may be far more or less than where it ends.
    pub fn with_ratios_alone(mut self) -> Self {
        let (n, ratios) = (self.count(), self.first_residue);
        self.kinds[DAMPING].retain(|(place, _)| place % (n + 1) == 0 && place / n < ratios);
        self.turned.fill(0.0);
        self.distributed.clear();
        self
    }

    /// Whether errors of the damping, of the size `damping`, and another distribution of it make as much of
    /// the quadrature of the same modes here as there, but for less than noise does.
    pub fn damps_like(&self, other: &SharedFeatures, damping: f64) -> bool {
        let (n, first) = (self.count(), self.first_residue);
        let noise = |k: usize| self.noise[(first + 2 * k + 1) * (n + 1)].sqrt();
        let apart = |(k, (a, b)): (usize, (&f64, &f64))| damping * (a - b).abs() > noise(k);
        let part = |of: &SharedFeatures, k: usize| of.distributed.get(k).map_or(0.0, |(_, value)| *value);
        let otherwise = |k: usize| (part(self, k) - part(other, k)).abs() > noise(k);
        self.turned.len() == other.turned.len()
            && !self.turned.iter().zip(&other.turned).enumerate().any(apart)
            && !(0..self.turned.len()).any(otherwise)
    }

    /// Recorded features less those of the model: ln ω and ln ζ of the paired modes, their residues FRF by
    /// FRF, then all residual terms. Residues and residual terms are in units of the recording's root mean
    /// squares.
    pub fn residual(
        &self,
        recorded: &RecordedModes,
        features: &[f64],
        modelled: &ModelledModes,
        pairing: &Pairing,
    ) -> Vec<f64> {
        let frfs = recorded.frfs();
        let mut model = Vec::with_capacity(self.places.len());
        for &(_, m) in &pairing.pairs {
            let pole = modelled.modes[m].pole;
            model.extend([pole.omega.ln(), pole.damping_ratio.max(f64::MIN_POSITIVE).ln()]);
        }
        for &(r, m) in &pairing.pairs {
            let scale = recorded.modes[r].scale;
            let residue = |frf: usize| {
                let offset =
                    recorded.offsets.as_ref().map(|own| own.residues[r][frf] * modelled.signals[m][frf]);
                let (own, signal) = (modelled.modes[m].residues[frf], modelled.signals[m][frf]);
                let own = if self.in_phase { signal * (own / signal).re } else { own };
                own + modelled.leaks[frf][r] + offset.unwrap_or_default()
            };
            model.extend((0..frfs).map(residue).flat_map(|a| [a.re / scale, a.im / scale]));
        }
        for frf in 0..frfs {
            let term = |k: usize| {
                let signal = |own: &Offsets| modelled.signals_at_ends[k][frf] / own.signals_at_ends[k][frf];
                let offset = |own: &Offsets| own.terms[frf][k] * signal(own).re;
                let offset = recorded.offsets.as_ref().map(offset);
                (modelled.residual_terms[frf][k] + offset.unwrap_or_default()) / recorded.residual_scales[k]
            };
            model.extend((0..2).map(term));
        }
        self.places.iter().zip(model).map(|(&place, model)| features[place] - model).collect()
    }

    /// Number of features compared.
    pub fn count(&self) -> usize {
        self.places.len()
    }

    /// S = noise + Σ size²·kind, the covariance of the features of a model whose error has these sizes:
    /// row-major, its lower triangle, which is all that a Cholesky factor reads. What stands above the
    /// diagonal means nothing.
    pub fn covariance(&self, sizes: &ErrorSizes) -> Vec<f64> {
        let mut sum = self.noise.to_vec();
        self.add_errors(sizes, &mut sum);
        sum
    }

    /// Adds the covariance that errors of these sizes make, row-major, to the lower triangle of `sum`.
    pub(crate) fn add_errors(&self, sizes: &ErrorSizes, sum: &mut [f64]) {
        for (kind, size) in self.kinds.iter().zip(sizes.to_array()) {
            kind.iter().for_each(|&(place, value)| sum[place] += size * size * value);
        }
        let (shape, quadrature) = (sizes.shape.powi(2), sizes.quadrature.powi(2));
        for (both, size) in self.both.iter().zip([shape * shape, 2.0 * shape * quadrature]) {
            both.iter().for_each(|&(place, value)| sum[place] += size * value);
        }
        let (strike, gain) = (sizes.strike.powi(2), sizes.gain.min(LARGEST_STRUCK_GAIN).powi(2));
        for (struck, size) in self.struck.iter().zip([strike * strike, strike * gain]) {
            struck.iter().for_each(|&(place, value)| sum[place] += size * value);
        }
        let n = self.count();
        for unknown in [&self.distributed, &self.structural] {
            for (k, &(i, a)) in unknown.iter().enumerate() {
                unknown[..=k].iter().for_each(|&(j, b)| sum[i * n + j] += a * b);
            }
        }
    }
}

/// What the law of the damping makes of the features. Beside its resonance a mode of structural damping,
/// ω² − Ω² + iηω², is one of viscous damping with ζ = η/2 whose residue is turned by ζ: of 1/(ω² − Ω² + 2iζω²)
/// and 1/(ω² − Ω² + 2iζωΩ) the difference is 2iζω(Ω − ω)/(ω² − Ω² + 2iζω²)², and Ω − ω next to ω is
/// −(ω² − Ω²)/2ω, so that −iζ/(ω² − Ω²) is left, and what is of the order of ζ². A law that nobody stated may
/// be either, or in part both, and is that of all modes.
fn of_structural_damping(
    recorded: &RecordedModes,
    (pairing, modelled): (&Pairing, &ModelledModes),
    own_damping: &[f64],
) -> Vec<(usize, f64)> {
    let residues = pairing.pairs.iter().zip(own_damping).flat_map(|(&(r, m), own)| {
        let by = own * recorded.modes[r].pole.damping_ratio / recorded.modes[r].scale;
        modelled.modes[m].residues.iter().map(move |residue| by * residue.re)
    });
    let first = 2 * pairing.pairs.len() + 1;
    residues.enumerate().map(|(k, turned)| (first + 2 * k, turned)).collect()
}

/// The share of a recorded mode's damping that is the structure's and not that of a window of this decay, 1/s.
fn own_share(pole: &Pole, window_decay: f64) -> f64 {
    let decay = pole.damping_ratio * pole.omega;
    if decay > 0.0 { (1.0 - window_decay / decay).max(0.0) } else { 1.0 }
}

/// What errors of the modes' damping make of `n` features, for a size of one, entries that are not zero by
/// their place: the damping that turns a shape's phases, which puts so much of each residue in quadrature, is
/// as wrong as that which makes the mode die away, of which `own` is the structure's share.
fn of_damping(n: usize, frfs: usize, turned: &[f64], own: &[f64]) -> Entries {
    let matched = own.len();
    let mut all = Entries::new();
    for (k, (turned, own)) in turned.chunks_exact(frfs.max(1)).zip(own).enumerate() {
        let first = 2 * matched + 2 * k * frfs;
        let parts = turned.iter().enumerate().map(|(frf, part)| (first + 2 * frf + 1, *part));
        let of_mode: Vec<(usize, f64)> = std::iter::once((2 * k + 1, *own)).chain(parts).collect();
        for &(i, a) in &of_mode {
            of_mode.iter().for_each(|&(j, b)| put(&mut all, n, (i, j), a * b));
        }
    }
    all
}
