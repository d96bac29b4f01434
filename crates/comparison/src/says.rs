//! A comparison in words that the terminal and the page share.

use crate::{Comparison, Equality, Pair, Ratio, Scatter, WhyApart};

/// Pairs beyond which only those with the first joint are listed.
const MANY: usize = 6;

/// Paths listed at the most.
const LISTED: usize = 4;

/// The pairs that are worth listing: all of a few, those with the first joint of many.
pub fn main_pairs(comparison: &Comparison) -> impl Iterator<Item = &Pair> {
    let few = comparison.pairs.len() <= MANY;
    let first = &comparison.joints[0].name;
    comparison.pairs.iter().filter(move |pair| few || pair.first == *first)
}

/// `93.02 % (92.98 to 93.06 %)`.
pub fn percents(ratio: &Ratio) -> String {
    let decimals = decimals(ratio.std * 100.0);
    let [low, high] = ratio.ci95.map(|end| 100.0 * end);
    format!("{:.decimals$} % ({low:.decimals$} to {high:.decimals$} %)", 100.0 * ratio.value)
}

/// Digits after the point that show two of a standard deviation.
fn decimals(std: f64) -> usize {
    if std > 0.0 && std.is_finite() { (1 - std.log10().floor() as i32).clamp(0, 6) as usize } else { 2 }
}

/// A p-value, or what it is below.
pub fn p_value(p: f64) -> String {
    match p {
        p if p < 1e-15 => "p < 1e-15".to_owned(),
        p if p < 1e-3 => format!("p = {p:.0e}"),
        p => format!("p = {p:.3}"),
    }
}

/// Whether joints are the same.
pub fn equality(equality: &Equality, names: [&str; 2]) -> String {
    let [first, second] = names;
    let p = p_value(equality.p_value);
    let degrees = equality.degrees;
    match equality.is_refuted() {
        true => format!("{first} and {second} are not the same joint: all {degrees} numbers equal has {p}"),
        false => format!("nothing tells {first} and {second} apart: all {degrees} numbers equal has {p}"),
    }
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
        let reason = match why {
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
        };
        all.push(format!("taken as on blocks of their own: {}, {reason}", names.join(", ")));
    }
    for joints in &together.one_law {
        all.push(format!(
            "taken to follow one law over frequency, the same being the most probable of each: {}",
            joints.join(", ")
        ));
    }
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
        p if p < 1e-4 => format!("{p:.1e} %"),
        p => format!("{p:.*} %", (2 - p.log10().floor() as i32).clamp(0, 6) as usize),
    }
}

/// How a number scatters between specimens.
pub fn scatter(scatter: &Scatter) -> String {
    let relative = |value: f64| share(value, scatter.mean.value);
    format!(
        "{}: mean {:.4e} {}, specimens differ by {} (95 %: {}), measured to {}; the same specimen has {}",
        scatter.element,
        scatter.mean.value,
        scatter.unit,
        relative(scatter.between),
        between(scatter),
        relative(scatter.measurement),
        p_value(scatter.p_value)
    )
}
