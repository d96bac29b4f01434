//! Joints side by side, in words.

use crate::format::{quantity, significant};
use crate::models;
pub use crate::ratio::percents;
use crate::{Says, Summary};
use jointscope_comparison::{
    Caution, Compared, Comparison, ElementRanking, Equality, Pair, Scatter, Specimens, WhyApart,
};

/// Pairs beyond which only those with the first joint are listed.
const MANY: usize = 6;

/// Joints up to which decided pairs are listed one by one.
const FEW: usize = 8;

/// Paths listed at the most.
const LISTED: usize = 4;

/// The pairs that are worth listing: all of a few, those with the first joint of many.
pub fn main_pairs(comparison: &Comparison) -> impl Iterator<Item = &Pair> {
    let few = comparison.pairs.len() <= MANY;
    let first = &comparison.joints[0].name;
    comparison.pairs.iter().filter(move |pair| few || pair.first == *first)
}

/// A p-value, or what it is below.
pub fn p_value(p: f64) -> String {
    match p {
        p if p < 1e-15 => "p < 10⁻¹⁵".to_owned(),
        p if p < 1e-3 => format!("p = {}", significant(p, 1)),
        p => format!("p = {p:.3}"),
    }
}

/// Whether joints are the same.
pub(crate) fn equality(equality: &Equality, names: [&str; 2]) -> String {
    let [first, second] = names;
    let p = p_value(equality.p_value);
    let degrees = equality.degrees;
    match equality.is_refuted() {
        true => format!("{first} and {second} are not the same joint: all {degrees} numbers equal has {p}"),
        false if equality.is_blunt() => format!(
            "nothing tells {first} and {second} apart: all {degrees} numbers equal has {p}, but the tests end so far apart in what is not known of the blocks that small differences \
             are not seen; state the blocks more narrowly to see them"
        ),
        false => format!("nothing tells {first} and {second} apart: all {degrees} numbers equal has {p}"),
    }
}

/// Whether the joints of a pair are the same, and what is left out of the test; or why it is not tested.
pub fn tested(comparison: &Comparison, pair: &Pair) -> String {
    let names = [pair.first.as_str(), pair.second.as_str()];
    let [first, second] = names;
    let undetermined = pair.undetermined.join(", ");
    match pair.equality {
        Some(tested) if undetermined.is_empty() => equality(&tested, names),
        Some(tested) => {
            format!(
                "{}; {undetermined}, of which neither's FRFs tell anything, are left out",
                equality(&tested, names)
            )
        }
        None if comparison.compared != Compared::AllFrfs => {
            "the files do not say how the errors of these estimates go together: equality is not tested"
                .to_owned()
        }
        None if pair.laws_differ.is_some() => pair.laws_differ.as_ref().map_or_else(String::new, |of| {
            let [one, other] = [&of.first, &of.second].map(|law| law.replace('_', " "));
            let probability = match of.one_law {
                p if p < 1e-3 => "less than 0.001".to_owned(),
                p => format!("{p:.3}"),
            };
            format!(
                "{first} and {second} are not the same joint: they follow different laws over frequency, {first} most probably a {one} one and {second} a {other} one; that both follow one \
                 law has a probability of {probability}"
            )
        }),
        None if !undetermined.is_empty() => {
            "no number has a standard deviation: equality cannot be tested".to_owned()
        }
        None => format!(
            "it is not tested whether {first} and {second} are the same: their files tell of no law over frequency that is probable for both, with numbers at one frequency, and numbers of different laws \
             are not the same numbers; of files of earlier versions `jointscope decompose` makes them anew"
        ),
    }
}

/// The law over frequency of all joints, or the groups that follow one.
fn laws(comparison: &Comparison) -> Vec<String> {
    let Some(law) = &comparison.law else {
        let groups = comparison.together.one_law.iter();
        let said = |joints: &Vec<String>| {
            format!(
                "taken to follow one law over frequency, the same being the most probable of each: {}",
                joints.join(", ")
            )
        };
        return groups.map(said).collect();
    };
    let name = law.law.replace('_', " ");
    let moved = match law.moved.is_empty() {
        true => String::new(),
        false => format!("; by its own FRFs another is the most probable of {}", law.moved.join(", ")),
    };
    let restated = match law.restated.is_empty() {
        true => String::new(),
        false => format!(
            "; C of {} is stated at the frequency of the first, the middle of its band being another",
            law.restated.join(", ")
        ),
    };
    vec![format!(
        "compared at one law over frequency, the most probable of all together: {name}{moved}{restated}"
    )]
}

/// What the tests share, and which share nothing.
pub fn shared(comparison: &Comparison) -> Vec<String> {
    let together = &comparison.together;
    let bodies =
        together.shared.iter().map(|shared| format!("{} ({})", shared.body, shared.joints.join(", ")));
    let bodies: Vec<String> = bodies.collect();
    let mut all = Vec::new();
    if !together.has_covariances {
        all.push(
            "taken as independent: these estimates do not say what the tests have in common, so that ratios and orders look less sure than they are on the same blocks".to_owned(),
        );
    }
    if !bodies.is_empty() {
        all.push(format!(
            "taken as the same blocks, which the fixtures state alike: {}; what is not known of them cancels in differences and ratios, and numbers are those that all these \
             tests together give. `--independent` takes them as different specimens",
            bodies.join(", ")
        ));
    }
    for why in [
        WhyApart::NotStated,
        WhyApart::OnTheBoundary,
        WhyApart::LeftAlone,
        WhyApart::OtherBodies,
        WhyApart::Singular,
        WhyApart::Asked,
    ] {
        let apart = together.apart.iter().filter(|apart| apart.why == why);
        let names: Vec<&str> = apart.map(|apart| apart.joint.as_str()).collect();
        if names.is_empty() {
            continue;
        }
        all.push(format!("taken as on blocks of their own: {}, {}", names.join(", "), reason(why)));
    }
    for joints in &together.at_once {
        all.push(format!(
            "found at once by one fit, whose file says how their errors go together: {}",
            joints.join(", ")
        ));
    }
    all.extend(laws(comparison));
    let differing = &together.differing;
    if !differing.is_empty() {
        let listed = differing.iter().take(LISTED).map(String::as_str).collect::<Vec<_>>().join(", ");
        let more = match differing.len() {
            n if n > LISTED => format!(" and {} more", n - LISTED),
            _ => String::new(),
        };
        all.push(format!(
            "the fixtures differ in {listed}{more}: bodies with these are not taken as the same"
        ));
    }
    all
}

/// Why joints are taken as tested on blocks of their own.
fn reason(why: WhyApart) -> &'static str {
    match why {
        WhyApart::Asked => "as asked for",
        WhyApart::NotStated => {
            "since their files do not say how the fixture acts on them; make them anew with `jointscope decompose`"
        }
        WhyApart::OnTheBoundary => {
            "since C is held where it just gives out no energy, which what the FRFs alone tell knows nothing of"
        }
        WhyApart::LeftAlone => "since the other tests on the same bodies are taken apart",
        WhyApart::OtherBodies => "since no other fixture states a body as theirs do",
        WhyApart::Singular => {
            "since their numbers and the fixture's cannot be told apart to working precision"
        }
        WhyApart::Disagrees => "since their FRFs contradict those of another test",
    }
}

/// `0.53 % to 2.1 %` of the mean: the interval of what specimens differ by.
pub fn between(scatter: &Scatter) -> String {
    let (low, high) = scatter.between_ci95;
    let relative = |value: f64| share(value, scatter.mean.value);
    match high {
        Some(high) => format!("{} to {}", relative(low), relative(high)),
        None => "open: they are closer to each other than they are measured".to_owned(),
    }
}

/// A share of a mean in percent, to three significant digits.
pub fn share(value: f64, mean: f64) -> String {
    let percent = 100.0 * (value / mean).abs();
    match percent {
        p if p == 0.0 || !p.is_finite() => "0 %".to_owned(),
        p if p < 1e-4 => format!("{} %", significant(p, 2)),
        p => format!("{p:.*} %", (2 - p.log10().floor() as i32).clamp(0, 6) as usize),
    }
}

/// How a number scatters between specimens.
pub(crate) fn scatter(scatter: &Scatter) -> String {
    let relative = |value: f64| share(value, scatter.mean.value);
    format!(
        "{}: mean {}, specimens differ by {} (95 %: {}), measured to {}; the same specimen has {}",
        scatter.element,
        quantity(scatter.mean.value, None, scatter.unit),
        relative(scatter.between),
        between(scatter),
        relative(scatter.measurement),
        p_value(scatter.p_value)
    )
}

/// What can be told of an order that is not stated as a whole:
/// `a < c, d; b < d; the order of the others cannot be told`, or how many pairs of many.
pub fn decided(comparison: &Comparison, entry: &ElementRanking) -> String {
    let name = |joint: &usize| comparison.joints[*joint].name.as_str();
    let count: usize = entry.decided().map(|(_, larger)| larger.len()).sum();
    let all = comparison.pairs.len();
    match count {
        0 => "the order cannot be told, no two of them being decided (95 %)".to_owned(),
        _ if comparison.joints.len() > FEW => {
            format!("{count} of {all} pairs are decided (95 %), the order of the others cannot be told")
        }
        _ => {
            let larger = |larger: &[usize]| larger.iter().map(name).collect::<Vec<_>>().join(", ");
            let each =
                entry.decided().map(|(joint, behind)| format!("{} < {}", name(&joint), larger(behind)));
            let each = each.collect::<Vec<_>>().join("; ");
            format!("{each} (each 95 % or more); the order of the others cannot be told")
        }
    }
}

/// What is compared, in words.
pub fn estimate_words(comparison: &Comparison) -> &'static str {
    match comparison.compared {
        Compared::AllFrfs => "the joints from all FRFs",
        Compared::Likelihood => "maximum-likelihood estimates from the FRFs across each joint",
        Compared::Average => "averages over each joint's band",
    }
}

impl Says for Caution {
    fn says(&self) -> String {
        match self {
            Caution::PoorFit { joint, chi2_per_dof } => format!(
                "{joint}: its fit leaves a chi2 of {} per degree of freedom, so this joint on this fixture does not explain its FRFs; its numbers \
                 may be off by more than their ±",
                short(*chi2_per_dof)
            ),
            Caution::LargeDepartures { joint, tolerance_inflation } => format!(
                "{joint}: its fit moves the fixture's quantities {} times as far as chance does, so something that the fixture leaves out is in its numbers",
                short(tolerance_inflation.sqrt())
            ),
            Caution::Refused { joint, tests } => refused(joint, tests),
            Caution::OnTheBoundary { joint } => format!(
                "{joint}: its C is held where it just gives out no energy, since its FRFs ask for one that would; it is compared as if on blocks of its own, and the intervals \
                 of its C are those without this limit"
            ),
            Caution::Unusable { joint } => {
                format!(
                    "{joint}: its decomposition is judged unusable; its page says why, and nothing here rests on it"
                )
            }
            Caution::Frequencies { joints, frequencies } => unlike_frequencies(joints, frequencies),
            Caution::Masses { with, without } => some_with_mass(with, without),
            Caution::NoFit { joint, why } => format!(
                "{joint}: there is no fit to all its FRFs ({why}), so all joints are compared by estimates that know less"
            ),
            Caution::NoDeviations { joint, numbers } => no_deviations(joint, numbers),
            Caution::SameRecording { first, second } => format!(
                "{first} and {second}: both are of the same recording, so that its noise is in both, and that they agree is no second test"
            ),
            Caution::Lengths { joints, lengths } => unlike_lengths(joints, lengths),
            Caution::BodiesDisagree { joint } => format!(
                "{joint}: its FRFs contradict those of another test on the blocks that both fixtures state alike, so it is compared as if on blocks of its own: \
                 they may be others, or the fixture leaves something out"
            ),
        }
    }
}

fn refused(joint: &str, tests: &[&str]) -> String {
    let said = |test: &&str| match *test {
        "reciprocity" => "k12 and k21 differ",
        "definite" => "its stiffness would push by itself",
        _ => "its damping would give out energy",
    };
    let tests: Vec<&str> = tests.iter().map(said).collect();
    format!("{joint}: physics forbids what its FRFs ask for: {}", tests.join(", "))
}

fn unlike_frequencies(joints: &[String], frequencies: &[f64]) -> String {
    let each =
        joints.iter().zip(frequencies).map(|(joint, hz)| format!("{joint} at {} Hz", significant(*hz, 4)));
    let each: Vec<String> = each.collect();
    format!(
        "numbers of joints whose stiffness or damping depends on frequency are those in the middle of their bands, and these differ ({}): C, of a structural joint ηK/ω, is \
         not of one frequency; compare loss factors, or decompose with the same --band",
        each.join(", ")
    )
}

fn some_with_mass(with: &[String], without: &[String]) -> String {
    format!(
        "{} {} a mass of the joint's own and {} none: stiffnesses of joints with and without a mass are not of the same thing",
        with.join(", "),
        if with.len() == 1 { "has" } else { "have" },
        without.join(", ")
    )
}

fn no_deviations(joint: &str, numbers: &[String]) -> String {
    let (has, it) = if numbers.len() == 1 { ("has", "it") } else { ("have", "them") };
    format!(
        "{joint}: {} {has} no standard deviation, so nothing tells how sure what follows from {it} is",
        numbers.join(", ")
    )
}

fn unlike_lengths(joints: &[String], lengths: &[f64]) -> String {
    let each = joints.iter().zip(lengths).map(|(joint, l)| format!("{joint} {:.2} mm", 1e3 * l));
    let each: Vec<String> = each.collect();
    format!("K and C act over lengths that differ, and are so not of the same thing: {}", each.join(", "))
}

fn short(value: f64) -> String {
    match value.abs() {
        v if v >= 1000.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        v if v >= 0.01 => format!("{value:.2}"),
        _ => significant(value, 2),
    }
}

/// What to mind first, models over measurements, ratios, orders, specimens.
impl Summary for Comparison {
    fn summary(&self) -> Vec<String> {
        let mut lines: Vec<String> = self.cautions.iter().map(|c| format!("caution: {}", c.says())).collect();
        lines.push(format!("by {}", estimate_words(self)));
        lines.extend(shared(self));
        lines.extend(models::lines(self));
        for pair in main_pairs(self) {
            lines.extend(paired(self, pair));
        }
        lines.push("from the smallest magnitude to the largest:".to_owned());
        lines.extend(self.rankings.iter().map(|entry| {
            if !entry.is_stated() {
                return format!("{}: {}", entry.number().name(), decided(self, entry));
            }
            let order: Vec<&str> =
                entry.ranking.order.iter().map(|i| self.joints[*i].name.as_str()).collect();
            // No order is certain.
            let right = match entry.ranking.probability {
                _ if !entry.has_deviations => "nothing tells how sure that is".to_owned(),
                p if p > 0.999 => "right with a probability of more than 0.999".to_owned(),
                p => format!("right with a probability of {p:.3}"),
            };
            format!("{}: {} ({right})", entry.number().name(), order.join(" < "))
        }));
        lines.extend(self.specimens.iter().flat_map(scatters));
        lines
    }
}

fn paired(comparison: &Comparison, pair: &Pair) -> Vec<String> {
    // Ratios of a model and a measurement stand in a table of their own.
    let is_in_a_table = |element: &str| {
        let names = [&pair.first, &pair.second];
        let mut of_pair = comparison
            .models
            .iter()
            .filter(|one| names.contains(&&one.model) && names.contains(&&one.measurement));
        of_pair.any(|one| one.numbers.iter().any(|number| number.element == element))
    };
    let ratios = pair.numbers.iter().filter_map(|number| {
        let ratio = number.ratio.filter(|_| !is_in_a_table(&number.element))?;
        Some(format!("{}: {} is {} of {}", number.element, pair.second, percents(&ratio), pair.first))
    });
    let is_of_fits = comparison.compared == Compared::AllFrfs;
    ratios.chain(is_of_fits.then(|| tested(comparison, pair))).collect()
}

fn scatters(specimens: &Specimens) -> Vec<String> {
    let head = format!("{}: {} specimens", specimens.name, specimens.joints.len());
    let lines = specimens.numbers.iter().map(scatter);
    std::iter::once(head).chain(lines.map(|line| format!("  {line}"))).collect()
}
