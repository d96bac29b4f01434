//! Modes of meshed beams from about half of their coordinates.
//!
//! A mesh fine enough for a band has many more modes than the band, and the eigenproblem costs the cube of
//! their number. Here each stretch of elements moves as its ends make it follow statically, Ψ = −K_ii⁻¹ K_ib
//! (Guyan 1965), and besides by motions of its inside alone, its ends held; stiffness couples none of these
//! with Ψ. What the inside answers to its own inertia while all of it moves as a polynomial p of low degree,
//! K_ii⁻¹ M p, is kept. Motions that are orthogonal to these by K_ii feel nothing of that inertia: they are
//! set aside as modes by themselves, far above the band. They are still among the modes, so that every place
//! yields statically to a force as it does in the whole mesh; only what inertia couples of the two is left
//! out. Craig and Bampton (1968) keep modes of the held inside instead, which take many more to follow a
//! motion that is smooth across the ends.
//!
//! Of random beams with masses, supports and shear, natural frequencies up to twice the band are within 1e-6
//! of the whole mesh's, mostly within 1e-9, and residues in the band within 3e-5 of that of a rigid motion,
//! mostly 1e-8.

use jointscope_linalg::{Cholesky, EigenError, ModalBasis, dot, generalized_symmetric_eigen};

/// Elements of a stretch at most: together with [`KEPT`], what is set aside stays as few coordinates as the
/// eigenproblem has a fast way for.
pub(crate) const LONGEST: usize = 7;
/// Motions kept of each stretch's inside: those that loads of constant to cubic course along it lead to.
const KEPT: usize = 4;

/// Elements one after the other of one beam.
#[derive(Debug, Clone)]
pub(crate) struct Stretch {
    /// The first of its coordinates: y and θ of each node.
    pub first: usize,
    /// Where its nodes are, m.
    pub nodes: Vec<f64>,
}

/// A stretch whose inside is condensed.
struct Condensed {
    /// Coordinates of its inside, which lie between the two of either end.
    inside: std::ops::Range<usize>,
    /// Ψ, a row for each coordinate of the inside over the four of the ends.
    static_motions: Vec<[f64; 4]>,
    /// Motions of the inside alone, one after the other, those that are kept first; of unit stiffness, then
    /// of unit mass.
    own: Vec<Vec<f64>>,
    /// Eigenvalues of those that are set aside.
    aside: Vec<f64>,
}

/// Solves K φ = λ M φ with `stretches` condensed, as far as they are not coupled but through their ends: as
/// many modes as coordinates. Those in the band of a mesh are its own; those far beyond are combinations of
/// its own that yield together as they do, and orthogonal by M among what was set aside or among the rest
/// only.
///
/// # Errors
/// Those of [`generalized_symmetric_eigen`].
pub(crate) fn condensed_modes(
    order: usize,
    mass: &[f64],
    stiffness: &[f64],
    stretches: &[Stretch],
) -> Result<ModalBasis, EigenError> {
    let parts: Vec<Condensed> =
        stretches.iter().filter_map(|stretch| Condensed::of(order, mass, stiffness, stretch)).collect();
    if parts.is_empty() {
        return generalized_symmetric_eigen(order, mass, stiffness);
    }
    let (mut reduced_mass, mut reduced_stiffness) = (mass.to_vec(), stiffness.to_vec());
    let mut kept = vec![true; order];
    for part in &parts {
        part.reduce(order, &mut reduced_mass, &mut reduced_stiffness);
        kept[part.inside.start + KEPT..part.inside.end].fill(false);
    }
    let kept: Vec<usize> = (0..order).filter(|&i| kept[i]).collect();
    let chosen = |matrix: &[f64]| -> Vec<f64> {
        kept.iter().flat_map(|&i| kept.iter().map(move |&j| matrix[i * order + j])).collect()
    };
    let modes = generalized_symmetric_eigen(kept.len(), &chosen(&reduced_mass), &chosen(&reduced_stiffness))?;
    let mut all: Vec<(f64, Motion)> =
        modes.eigenvalues().iter().enumerate().map(|(r, value)| (*value, Motion::Kept(r))).collect();
    for part in &parts {
        let aside = part.aside.iter().zip(&part.own[KEPT..]);
        all.extend(aside.map(|(value, motion)| (*value, Motion::Aside(part, motion))));
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut shapes = vec![0.0; order * order];
    for ((_, motion), shape) in all.iter().zip(shapes.chunks_exact_mut(order)) {
        match motion {
            Motion::Kept(r) => {
                kept.iter().zip(modes.shape(*r)).for_each(|(&i, amplitude)| shape[i] = *amplitude);
                parts.iter().for_each(|part| part.expand(shape));
            }
            Motion::Aside(part, motion) => shape[part.inside.clone()].copy_from_slice(motion),
        }
    }
    let values = all.iter().map(|(value, _)| *value).collect();
    ModalBasis::new(values, shapes).ok_or(EigenError::NoConvergence)
}

/// A mode of the condensed problem, or one that was set aside.
enum Motion<'a> {
    Kept(usize),
    Aside(&'a Condensed, &'a [f64]),
}

impl Condensed {
    /// `None` where there is nothing to set aside, where its inside is coupled with anything but its ends, or
    /// where that does not resist every motion.
    fn of(order: usize, mass: &[f64], stiffness: &[f64], stretch: &Stretch) -> Option<Self> {
        let inside = stretch.first + 2..stretch.first + 2 * stretch.nodes.len() - 2;
        let whole = inside.start - 2..inside.end + 2;
        let count = inside.len();
        let alone = |matrix: &[f64]| {
            let mut rows = matrix[inside.start * order..inside.end * order].chunks_exact(order);
            rows.all(|row| row[..whole.start].iter().chain(&row[whole.end..]).all(|entry| *entry == 0.0))
        };
        if count <= KEPT || !alone(mass) || !alone(stiffness) {
            return None;
        }
        let block: Vec<f64> =
            inside.clone().flat_map(|i| &stiffness[i * order..][inside.clone()]).copied().collect();
        let factor = Cholesky::of(count, &block)?;
        let ends = ends(&inside);
        let mut static_motions = vec![[0.0; 4]; count];
        for (k, end) in ends.into_iter().enumerate() {
            let mut column: Vec<f64> = inside.clone().map(|i| -stiffness[i * order + end]).collect();
            factor.solve_in_place(&mut column);
            static_motions.iter_mut().zip(column).for_each(|(row, value)| row[k] = value);
        }

        // In the coordinates Lᵀu the stiffness is the unit matrix: what is orthogonal there is so by K_ii.
        let (from, length) = (stretch.nodes[0], stretch.nodes[stretch.nodes.len() - 1] - stretch.nodes[0]);
        let load = |power: usize| {
            let motion: Vec<f64> =
                (0..whole.len()).map(|i| monomial(i, stretch.nodes[i / 2] - from, length, power)).collect();
            let mut load: Vec<f64> =
                inside.clone().map(|i| dot(&mass[i * order..][whole.clone()], &motion)).collect();
            factor.solve_lower_in_place(&mut load);
            load
        };
        let mut own = orthonormal(count, (0..KEPT).map(load))?;
        own.iter_mut().for_each(|motion| factor.solve_upper_in_place(motion));

        let rest = &own[KEPT..];
        let images: Vec<Vec<f64>> = rest
            .iter()
            .map(|motion| inside.clone().map(|i| dot(&mass[i * order..][inside.clone()], motion)).collect())
            .collect();
        let mass_of_rest: Vec<f64> =
            rest.iter().flat_map(|a| images.iter().map(move |image| dot(a, image))).collect();
        let unit: Vec<f64> =
            (0..rest.len().pow(2)).map(|e| f64::from(u8::from(e % (rest.len() + 1) == 0))).collect();
        let modes = generalized_symmetric_eigen(rest.len(), &mass_of_rest, &unit).ok()?;
        let aside: Vec<Vec<f64>> = (0..rest.len()).map(|r| combined(count, rest, modes.shape(r))).collect();
        own.truncate(KEPT);
        own.extend(aside);
        Some(Condensed { inside, static_motions, own, aside: modes.eigenvalues().to_vec() })
    }

    /// Matrices in terms of the ends' motions, which the inside follows statically, and the inside's own.
    fn reduce(&self, order: usize, mass: &mut [f64], stiffness: &mut [f64]) {
        let (inside, ends) = (self.inside.clone(), ends(&self.inside));
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            let pull: f64 = inside
                .clone()
                .zip(&self.static_motions)
                .map(|(i, row)| stiffness[ends[a] * order + i] * row[b])
                .sum();
            stiffness[ends[a] * order + ends[b]] += pull;
        }
        // M_ib and M_ib + M_ii Ψ.
        let coupling: Vec<[f64; 4]> = inside.clone().map(|i| ends.map(|end| mass[i * order + end])).collect();
        let moved: Vec<[f64; 4]> = inside
            .clone()
            .zip(&coupling)
            .map(|(i, coupling)| {
                let row = &mass[i * order..][inside.clone()];
                std::array::from_fn(|b| {
                    coupling[b]
                        + row.iter().zip(&self.static_motions).map(|(m, motion)| m * motion[b]).sum::<f64>()
                })
            })
            .collect();
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            let rows = coupling.iter().zip(&moved).zip(&self.static_motions);
            let inertia: f64 = rows.map(|((c, m), motion)| motion[a] * m[b] + c[a] * motion[b]).sum();
            mass[ends[a] * order + ends[b]] += inertia;
        }
        let images: Vec<Vec<f64>> = self.own[..KEPT]
            .iter()
            .map(|motion| inside.clone().map(|i| dot(&mass[i * order..][inside.clone()], motion)).collect())
            .collect();
        for (k, motion) in self.own[..KEPT].iter().enumerate() {
            let at = inside.start + k;
            for (b, end) in ends.into_iter().enumerate() {
                let inertia: f64 = motion.iter().zip(&moved).map(|(own, moved)| own * moved[b]).sum();
                (mass[at * order + end], mass[end * order + at]) = (inertia, inertia);
                (stiffness[at * order + end], stiffness[end * order + at]) = (0.0, 0.0);
            }
            for (l, image) in images.iter().enumerate() {
                mass[at * order + inside.start + l] = dot(motion, image);
                stiffness[at * order + inside.start + l] = f64::from(u8::from(k == l));
            }
        }
    }

    /// The inside of a shape whose first entries there are amplitudes of the motions kept.
    fn expand(&self, shape: &mut [f64]) {
        let ends = ends(&self.inside).map(|end| shape[end]);
        let inside = &mut shape[self.inside.clone()];
        let amplitudes: [f64; KEPT] = std::array::from_fn(|k| inside[k]);
        for (value, row) in inside.iter_mut().zip(&self.static_motions) {
            *value = dot(row, &ends);
        }
        for (amplitude, motion) in amplitudes.into_iter().zip(&self.own) {
            inside.iter_mut().zip(motion).for_each(|(value, own)| *value += amplitude * own);
        }
    }
}

/// The coordinates of both ends.
fn ends(inside: &std::ops::Range<usize>) -> [usize; 4] {
    [inside.start - 2, inside.start - 1, inside.end, inside.end + 1]
}

/// Coordinate `i`, y or θ, of a node at `x` as a stretch moves as a power of its length.
fn monomial(i: usize, x: f64, length: f64, power: usize) -> f64 {
    let share = x / length;
    match (i % 2, power) {
        (0, _) => share.powi(power as i32),
        (_, 0) => 0.0,
        _ => power as f64 * share.powi(power as i32 - 1) / length,
    }
}

/// An orthonormal basis of all vectors of `count` entries, the first of them a basis of the `given` ones, by
/// Householder's reflections; `None` where those depend on one another.
fn orthonormal(count: usize, given: impl Iterator<Item = Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    let mut mirrors: Vec<Vec<f64>> = Vec::new();
    for mut vector in given {
        mirrors.iter().for_each(|mirror| reflect(mirror, &mut vector));
        let at = mirrors.len();
        vector[..at].fill(0.0);
        let size = dot(&vector, &vector).sqrt();
        vector[at] += if vector[at] < 0.0 { -size } else { size };
        let norm = dot(&vector, &vector).sqrt();
        if norm.is_nan() || norm <= 0.0 {
            return None;
        }
        vector.iter_mut().for_each(|value| *value /= norm);
        mirrors.push(vector);
    }
    let column = |k: usize| {
        let mut unit = vec![0.0; count];
        unit[k] = 1.0;
        mirrors.iter().rev().for_each(|mirror| reflect(mirror, &mut unit));
        unit
    };
    Some((0..count).map(column).collect())
}

fn reflect(mirror: &[f64], vector: &mut [f64]) {
    let twice = 2.0 * dot(mirror, vector);
    vector.iter_mut().zip(mirror).for_each(|(value, m)| *value -= twice * m);
}

fn combined(count: usize, motions: &[Vec<f64>], shares: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; count];
    for (motion, share) in motions.iter().zip(shares) {
        sum.iter_mut().zip(motion).for_each(|(to, value)| *to += share * value);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Assembly, Station};
    use jointscope_fixture::Fixture;
    use num_complex::Complex64;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    /// Receptance at `hz` with a loss factor of 1 %.
    fn receptance(assembly: &Assembly, [out, input]: [&Station; 2], hz: f64) -> Complex64 {
        let (out, input) = (assembly.participation(out), assembly.participation(input));
        let of = |(r, eigenvalue): (usize, &f64)| {
            out[r] * input[r] / (eigenvalue * Complex64::new(1.0, 0.01) - (TAU * hz).powi(2))
        };
        assembly.modes().eigenvalues().iter().enumerate().map(of).sum()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn beams_with_masses_supports_and_shear_answer_as_their_whole_meshes_do(
            masses in prop::collection::vec((0.02f64..0.48, 1e-3f64..0.1), 0..6), clamp in 2.0f64..9.0, spring in 2.0f64..7.0,
            at in 0.1f64..0.45, shear in prop::option::of(5e6f64..1e8), highest in 300.0f64..4000.0, places in prop::array::uniform3(0.0f64..0.5),
        ) {
            let masses: Vec<String> = masses.iter().map(|(x, mass)| format!(r#"{{"x": {x}, "mass": {mass}}}"#)).collect();
            let shear = shear.map_or(String::new(), |g| format!(
                r#", "physics": [{{"kind": "shear_deformation", "place": "beam", "shear_stiffness": {g}, "rotary_inertia": 2e-5}}]"#
            ));
            let fixture = Fixture::from_json(&format!(
                r#"{{ "bodies": {{ "beam": {{ "beam": {{ "from": 0, "to": 0.5, "youngs_modulus": 2e11, "second_moment": 1e-9, "mass_per_length": 1.2 }},
                                              "masses": [{}] }} }},
                      "points": {{ "1": {{ "body": "beam", "x": 0.0 }} }}, "joints": {{}}, "damping": {{ "modal_ratios": [0.005] }},
                      "supports": {{ "clamp": {{ "point": "1", "stiffness": {}, "rotational_stiffness": {} }},
                                     "spring": {{ "body": "beam", "x": {at}, "stiffness": {} }} }}{shear} }}"#,
                masses.join(", "), 10f64.powf(clamp), 10f64.powf(clamp - 4.0), 10f64.powf(spring),
            )).unwrap();
            let (whole, condensed) = (Assembly::new(&fixture, highest).unwrap(), Assembly::condensed(&fixture, highest).unwrap());
            let last = whole.order() - 1;
            prop_assert!(condensed.modes().eigenvalues()[last] != whole.modes().eigenvalues()[last], "nothing was condensed");
            for (a, b) in condensed.natural_frequencies_hz().iter().zip(whole.natural_frequencies_hz()).filter(|(_, b)| *b < 2.0 * highest) {
                prop_assert!((a - b).abs() < 2e-6 * b.max(0.03 * highest), "{a} Hz instead of {b} Hz");
            }
            let stations = places.map(|x| Station::transverse(0, x));
            let [a, b] = [&condensed, &whole].map(|assembly| stations.each_ref().map(|station| assembly.participation(station)));
            let within = (0..=last).take_while(|r| whole.natural_frequencies_hz()[*r] < highest);
            let largest = 1.0 / (1.2 * 0.5);
            for (r, o, i) in within.flat_map(|r| [(r, 0, 0), (r, 0, 1), (r, 1, 2)]) {
                let (a, b) = (a[o][r] * a[i][r], b[o][r] * b[i][r]);
                prop_assert!((a - b).abs() < 1e-4 * largest, "residue ({o}, {i}) of mode {r}: {a} instead of {b}");
            }
            for hz in [0.02, 0.11, 0.37, 0.63, 0.98].map(|share| share * highest) {
                let own = stations.each_ref().map(|station| receptance(&whole, [station; 2], hz).norm());
                for (o, i) in [(0, 0), (0, 1), (1, 2)] {
                    let pair = [&stations[o], &stations[i]];
                    let (a, b) = (receptance(&condensed, pair, hz), receptance(&whole, pair, hz));
                    prop_assert!((a - b).norm() < 2e-3 * (own[o] * own[i]).sqrt(), "({o}, {i}) at {hz} Hz: {a} instead of {b}");
                }
            }
        }
    }

    #[test]
    fn a_stretch_whose_inside_is_tied_to_something_else_is_left_as_it_is() {
        // Five masses of 1 kg in a row, in both directions, each on springs to its neighbours; something is
        // tied to the middle one.
        let order = 12;
        let mass: Vec<f64> = (0..order * order).map(|e| f64::from(u8::from(e % (order + 1) == 0))).collect();
        let mut stiffness = vec![0.0; order * order];
        let mut tie = |i: usize, j: usize, k: f64| {
            [(i, i, k), (j, j, k), (i, j, -k), (j, i, -k)]
                .iter()
                .for_each(|&(a, b, k)| stiffness[a * order + b] += k);
        };
        (0..8).for_each(|i| tie(i, i + 2, 1e4 * (1.0 + i as f64)));
        tie(5, 11, 3e3);
        let stretch = Stretch { first: 0, nodes: vec![0.0, 0.1, 0.2, 0.3, 0.4] };
        let condensed = condensed_modes(order, &mass, &stiffness, &[stretch]);
        assert_eq!(condensed, generalized_symmetric_eigen(order, &mass, &stiffness));
    }
}
