//! Two joints: by how much they differ, in what ratio, and whether they are the same.

use crate::by_law::ByLaw;
use crate::equality::TestedTwo;
use crate::laws_in_common::LawsInCommon;
use crate::normal::{larger_magnitude, mixed_interval, mixed_ratio_interval};
use crate::{Decomposed, Equality, Kind, Number, Together};
use jointscope_inference::{Z95, interval95};
use serde::Serialize;

/// A value with its standard deviation and 95 % interval, SI.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FigureInterval {
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub std: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
}

impl FigureInterval {
    pub(crate) fn normal(value: f64, variance: f64) -> Self {
        let std = variance.max(0.0).sqrt();
        FigureInterval { value, std, ci95: interval95(value, std) }
    }
}

/// The second joint's number over the first one's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ratio {
    /// The ratio.
    pub value: f64,
    /// Its standard deviation, to first order.
    pub std: f64,
    /// Its 95 % interval (Fieller's).
    pub ci95: [f64; 2],
}

/// One number of two joints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairedNumber {
    /// `K11` …, `elastic_centre` (k12/k11, m from the far end), `K22_at_centre` (k22 − k12²/k11).
    pub element: String,
    /// SI unit of the difference.
    pub unit: &'static str,
    /// Second less first.
    pub difference: FigureInterval,
    /// Second over first; nothing where the first cannot be told from zero, where one of them has no
    /// deviation, and for places.
    pub ratio: Option<Ratio>,
    /// Correlation of the two errors; nothing where one of them has none.
    pub correlation: Option<f64>,
    /// Probability that the second is the larger, by magnitude.
    pub second_is_larger: f64,
}

impl PairedNumber {
    /// Whether the 95 % interval of the difference leaves out zero.
    pub fn differs(&self) -> bool {
        let [low, high] = self.difference.ci95;
        low > 0.0 || high < 0.0
    }
}

/// Two joints, number by number.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Pair {
    /// The joint that the other is set against.
    pub first: String,
    /// The other.
    pub second: String,
    /// By number.
    pub numbers: Vec<PairedNumber>,
    /// Whether all numbers of both are the same; nothing where none has a deviation, or where averages and
    /// fits to the FRFs across are compared, whose files do not say how the errors of their numbers go
    /// together.
    pub equality: Option<Equality>,
    /// Numbers that this test leaves out, since neither joint's FRFs tell anything of them.
    #[serde(rename = "untold", skip_serializing_if = "Vec::is_empty")]
    pub undetermined: Vec<String>,
    /// Their laws over frequency, where they count as following laws of their own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub laws_differ: Option<LawsDiffer>,
}

/// Two joints whose FRFs are not of one law over frequency.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LawsDiffer {
    /// The most probable law of the first.
    pub first: String,
    /// The most probable law of the second.
    pub second: String,
    /// Probability that both follow one law, whichever it is, rather than each its own.
    pub one_law: f64,
}

impl LawsDiffer {
    /// Of joints whose laws were compared and differ.
    pub(crate) fn of(first: &Decomposed, second: &Decomposed) -> Option<Self> {
        let common = LawsInCommon::of(&[first, second]).filter(LawsInCommon::is_refuted)?;
        let law = |joint: &Decomposed| Some(joint.fitted.as_ref()?.laws.first()?.law.clone());
        Some(LawsDiffer { first: law(first)?, second: law(second)?, one_law: common.probability })
    }
}

/// A function of a joint's numbers with its derivatives.
struct Derived {
    name: &'static str,
    unit: &'static str,
    is_place: bool,
    of: fn([f64; 3]) -> (f64, [f64; 3]),
}

/// k12/k11 and k22 − k12²/k11 of (k11, k12, k22).
const DERIVED: [Derived; 2] = [
    Derived {
        name: "elastic_centre",
        unit: "m",
        is_place: true,
        of: |[a, b, _]| (b / a, [-b / (a * a), 1.0 / a, 0.0]),
    },
    Derived {
        name: "K22_at_centre",
        unit: "N*m/rad",
        is_place: false,
        of: |[a, b, d]| (d - b * b / a, [(b / a).powi(2), -2.0 * b / a, 1.0]),
    },
];

impl Pair {
    /// Of two joints of all, by each choice of their laws; `tested` is by what they, as the only two, are
    /// tested for being the same.
    pub(crate) fn of(
        by_law: &ByLaw,
        numbers: &[Number],
        (first, second): (usize, usize),
        names: [&str; 2],
        tested: Option<&[TestedTwo]>,
    ) -> Self {
        let part = |n: usize, (weight, together): &(f64, Together)| {
            let of = |a, b| together.covariance((a, n), (b, n));
            let values = [first, second].map(|joint| together.value(joint, n));
            (*weight, values, [of(first, first), of(first, second), of(second, second)])
        };
        let mut all: Vec<PairedNumber> = (0..numbers.len())
            .map(|n| {
                let parts: Vec<Part> = by_law.iter().map(|by| part(n, by)).collect();
                PairedNumber::of((numbers[n].name(), numbers[n].unit()), &parts, false)
            })
            .collect();
        if by_law.iter().all(|(_, together)| together.has_covariances) {
            all.extend(derived(by_law, numbers, (first, second)));
        }
        Pair {
            first: names[0].to_owned(),
            second: names[1].to_owned(),
            numbers: all,
            equality: tested.and_then(Equality::by_law),
            undetermined: tested
                .and_then(|by| by.first())
                .map_or_else(Vec::new, |by| undetermined_by_both(&by.together, numbers)),
            laws_differ: None,
        }
    }

    /// One of its numbers.
    pub fn number(&self, element: &str) -> Option<&PairedNumber> {
        self.numbers.iter().find(|number| number.element == element)
    }
}

/// The numbers of which two joints' FRFs tell nothing.
fn undetermined_by_both(together: &Together, numbers: &[Number]) -> Vec<String> {
    let is_undetermined = |n: usize| [0, 1].iter().all(|&joint| together.std(joint, n) == 0.0);
    (0..numbers.len()).filter(|&n| is_undetermined(n)).map(|n| numbers[n].name()).collect()
}

/// Two numbers by one choice of laws: how probable it is, their values, variances and covariance.
type Part = (f64, [f64; 2], [f64; 3]);

fn derived(by_law: &ByLaw, numbers: &[Number], (first, second): (usize, usize)) -> Vec<PairedNumber> {
    let place = |i, j| numbers.iter().position(|n| (n.kind, n.element) == (Kind::Stiffness, (i, j)));
    let (Some(a), Some(b), Some(d)) = (place(0, 0), place(0, 1), place(1, 1)) else { return Vec::new() };
    let places = [a, b, d];
    let three = |together: &Together| [first, second].map(|joint| places.map(|n| together.value(joint, n)));
    if by_law.iter().any(|(_, together)| three(together).iter().any(|k| k[0] <= 0.0)) {
        return Vec::new();
    }
    let part = |entry: &Derived, (weight, together): &(f64, Together)| -> Part {
        let [one, other] = three(together).map(entry.of);
        let covariance = |(joint, by): (usize, &[f64; 3]), (other, with): (usize, &[f64; 3])| {
            let products = places.iter().zip(by).flat_map(|(&m, x)| {
                let inner =
                    move |(&n, y): (&usize, &f64)| x * y * together.covariance((joint, m), (other, n));
                places.iter().zip(with).map(inner)
            });
            products.sum::<f64>()
        };
        let (one_by, other_by) = ((first, &one.1), (second, &other.1));
        let variances =
            [covariance(one_by, one_by), covariance(one_by, other_by), covariance(other_by, other_by)];
        (*weight, [one.0, other.0], variances)
    };
    let of = |entry: &Derived| {
        let parts: Vec<Part> = by_law.iter().map(|by| part(entry, by)).collect();
        PairedNumber::of((entry.name.to_owned(), entry.unit), &parts, entry.is_place)
    };
    DERIVED.iter().map(of).collect()
}

impl PairedNumber {
    /// Values are those of the first part; the interval is that of all, each as often as it is probable, and
    /// the standard deviation what a normal number with such an interval has.
    fn of((element, unit): (String, &'static str), parts: &[Part], is_place: bool) -> Self {
        let (_, [a, b], [aa, ab, bb]) = parts[0];
        let ratio = || {
            if aa <= 0.0 || bb <= 0.0 {
                return None;
            }
            let own = mixed_ratio_interval(&parts[..1])?;
            // A law by which the first cannot be told from zero has no ratio.
            let ci95 = mixed_ratio_interval(parts)?;
            let value = b / a;
            let variance = (bb - 2.0 * value * ab + value * value * aa) / (a * a);
            let std = variance.max(0.0).sqrt();
            let std = if parts.len() == 1 { std } else { std * (ci95[1] - ci95[0]) / (own[1] - own[0]) };
            Some(Ratio { value, std, ci95 })
        };
        PairedNumber {
            element,
            unit,
            difference: difference(parts),
            ratio: if is_place { None } else { ratio() },
            correlation: (aa > 0.0 && bb > 0.0).then(|| (ab / (aa * bb).sqrt()).clamp(-1.0, 1.0)),
            second_is_larger: second_is_larger(parts),
        }
    }
}

fn difference(parts: &[Part]) -> FigureInterval {
    let each = parts.iter().map(|&(weight, [a, b], [aa, ab, bb])| (weight, b - a, aa + bb - 2.0 * ab));
    let each: Vec<(f64, f64, f64)> = each.collect();
    let (_, value, variance) = each[0];
    if each.len() == 1 {
        return FigureInterval::normal(value, variance);
    }
    let ci95 = mixed_interval(&each);
    FigureInterval { value, std: 0.5 * (ci95[1] - ci95[0]) / Z95, ci95 }
}

fn second_is_larger(parts: &[Part]) -> f64 {
    if let [(_, [a, b], variances)] = *parts {
        return larger_magnitude(a, b, variances);
    }
    let total: f64 = parts.iter().map(|(weight, ..)| weight).sum();
    let each = parts.iter().map(|&(weight, [a, b], variances)| weight * larger_magnitude(a, b, variances));
    each.sum::<f64>() / total
}
