//! The joint of a decomposition, or all that one fit found at once.

use crate::joint::symmetric;
use crate::numbering::Numbering;
use crate::numbers::short;
use crate::{Export, ExportError, ExportOptions, Joint, JointAtFrequency, JointNode};
use jointscope_beam::mass_of_ends;
use jointscope_comparison::{Decomposed, Ends, FiledJoint, FiledTests, Matrix, Uncertain};
use std::collections::BTreeMap;

/// All joints of a decomposition, or the one that the options name; where joints meet at a point they share
/// its node. Each is the joint with the fixture's quantities moving where the file has it, otherwise the
/// maximum-likelihood one.
///
/// # Errors
/// A file that does not say where its joint acts, an estimate judged unusable, numbers that cannot be, node
/// numbers for more than one joint.
pub fn of_decompositions(decomposed: &[Decomposed], options: &ExportOptions) -> Result<Export, ExportError> {
    let names = |all: &[&Decomposed]| all.iter().map(|one| one.joint.as_str()).collect::<Vec<_>>().join(", ");
    let is_wanted = |one: &&Decomposed| options.joint.as_ref().is_none_or(|name| *name == one.joint);
    let chosen: Vec<&Decomposed> = decomposed.iter().filter(is_wanted).collect();
    let known = || names(&decomposed.iter().collect::<Vec<_>>());
    let several = match (chosen.as_slice(), &options.joint) {
        ([], Some(name)) => {
            return Err(ExportError::NoSuchJoint { name: name.clone(), known: known() });
        }
        ([], None) => return Err(ExportError::Nothing),
        ([_], _) => false,
        _ => true,
    };
    if several && options.nodes.is_some() {
        return Err(ExportError::WhichJoint { known: known() });
    }
    let mut notes: Vec<String> = Vec::new();
    let mut joints = Vec::new();
    let mut nodes = Nodes { numbering: Numbering::from(options.first_id)?, points: BTreeMap::new() };
    for one in &chosen {
        let (joint, remarks) = exported(one, options, &mut nodes)?;
        let of_it = |note: String| if several { format!("joint {}: {note}", joint.name) } else { note };
        notes.extend(remarks.into_iter().map(of_it));
        joints.push(joint);
    }
    if several {
        notes.push("errors of these joints go together, since one fit found them: the covariance of all is in stiffness.json".to_owned());
    }
    let (nodes, first_id) = nodes.numbering.finish();
    let joint = if several { "joints" } else { "joint" };
    let title = format!("{joint} {} of a decomposition", names(&chosen));
    let (parts, not_exported) = (Vec::new(), Vec::new());
    Export { title, notes, nodes, joints, parts, not_exported, first_id }.checked()
}

/// The nodes given so far, those of points by their names.
struct Nodes {
    numbering: Numbering,
    points: BTreeMap<String, u64>,
}

/// A joint with remarks on what it is worth.
fn exported(
    decomposed: &Decomposed,
    options: &ExportOptions,
    nodes: &mut Nodes,
) -> Result<(Joint, Vec<String>), ExportError> {
    let ends = decomposed.ends.as_ref().ok_or(ExportError::NoEnds)?;
    let mut notes = judged(decomposed, options.anyway)?;
    let estimate = Estimate::best(decomposed)?;
    let mut joint = placed(decomposed, ends, estimate, options, nodes)?;
    notes.extend(joint.indefinite());
    notes.extend(decomposed.fitted.iter().flat_map(|fitted| failed_tests(&fitted.tests)));
    if options.by_line {
        joint.lines = lines(decomposed)?;
        let noisy = decomposed.lines.len() - joint.lines.len();
        if let Some(mass) = decomposed.fitted.as_ref().and_then(|fitted| fitted.mass) {
            // Each line was solved without a mass, so its K has the inertia in it already.
            joint.mass = None;
            notes.push(format!(
                "the joint's mass of {} kg is not written: K by line has its inertia in it already; the constant K and C belong to a joint with it",
                short(mass.value)
            ));
        }
        if noisy > 0 {
            notes.push(format!("{noisy} lines that noise dominates are left out of K and C by line"));
        }
    }
    Ok((joint, notes))
}

/// What is exported of several estimates.
struct Estimate {
    says: String,
    stiffness: Matrix,
    damping: Matrix,
    /// H, for damping that does not depend on frequency.
    structural: Matrix,
    /// Frequency that it was read at, Hz, and its covariance with K.
    structural_at: Option<(f64, crate::Covariance)>,
    std: Option<(Matrix, Matrix)>,
    covariance: Option<crate::Covariance>,
    mass: Option<Uncertain>,
}

impl Estimate {
    fn best(decomposed: &Decomposed) -> Result<Self, ExportError> {
        if let Some(fitted) = &decomposed.fitted {
            let std = |i: usize| fitted.covariance[i][i].max(0.0).sqrt();
            let matrix = |first: usize| [[std(first), std(first + 1)], [std(first + 1), std(first + 2)]];
            let mass = fitted.mass.map_or(String::new(), |mass| {
                format!(
                    ", with a mass of its own of {} ± {} kg, uniform over its length, which K and C belong to",
                    short(mass.value),
                    short(mass.std)
                )
            });
            let mut estimate = Estimate {
                says: format!(
                    "the joint from all FRFs, the fixture's quantities moving within their deviations{mass}{}",
                    law_of(fitted)
                ),
                stiffness: symmetric(&fitted.stiffness),
                damping: symmetric(&fitted.damping),
                structural: [[0.0; 2]; 2],
                structural_at: None,
                std: Some((matrix(0), matrix(3))),
                covariance: Some(fitted.covariance),
                mass: fitted.mass,
            };
            if let Some(frequency) = structural_at(fitted) {
                estimate.read_as_structural(frequency, &fitted.covariance);
            }
            return Ok(estimate);
        }
        let (says, estimate) = match &decomposed.likelihood {
            Some(estimate) => ("the maximum-likelihood joint".to_owned(), estimate),
            None if decomposed.relation == "paper" => return Err(ExportError::OnlyPaper),
            None => {
                let average = decomposed.average.as_ref().ok_or(ExportError::NoEstimate)?;
                let (from, to) = average.band;
                (format!("the plain average over {} to {} Hz", short(from), short(to)), &average.estimate)
            }
        };
        Ok(Estimate {
            says,
            stiffness: symmetric(&estimate.stiffness),
            damping: symmetric(&estimate.damping),
            structural: [[0.0; 2]; 2],
            structural_at: None,
            std: Some((estimate.stiffness_std, estimate.damping_std)),
            covariance: None,
            mass: None,
        })
    }

    /// H = ωC in place of the C that loses as much at this frequency: no C is written beside it, and no
    /// deviation of one. `covariance` is that of K and C.
    fn read_as_structural(&mut self, hz: f64, covariance: &crate::Covariance) {
        let omega = std::f64::consts::TAU * hz;
        let times = |i: usize| if i >= OF_STIFFNESS { omega } else { 1.0 };
        let of_structural =
            std::array::from_fn(|m| std::array::from_fn(|n| covariance[m][n] * times(m) * times(n)));
        self.structural_at = Some((hz, of_structural));
        self.structural = self.damping.map(|row| row.map(|c| omega * c));
        self.damping = [[0.0; 2]; 2];
        self.std = self.std.map(|(stiffness, _)| (stiffness, [[0.0; 2]; 2]));
        if let Some(covariance) = &mut self.covariance {
            for (m, row) in covariance.iter_mut().enumerate() {
                for (n, entry) in row.iter_mut().enumerate() {
                    if m >= OF_STIFFNESS || n >= OF_STIFFNESS {
                        *entry = 0.0;
                    }
                }
            }
        }
    }
}

/// Numbers of a joint that are of K; those of C come after them.
const OF_STIFFNESS: usize = 3;

/// The frequency at which the numbers of a structural joint are stated, Hz.
fn structural_at(fitted: &FiledJoint) -> Option<f64> {
    let follows = fitted.follows.as_ref().filter(|follows| follows.law.starts_with("structural"))?;
    Some(follows.frequency)
}

/// What law the numbers are of.
fn law_of(fitted: &FiledJoint) -> String {
    let words = |law: &str| law.replace('_', " ");
    match (&fitted.follows, fitted.law.as_deref()) {
        (Some(follows), Some(law)) if law == follows.law && follows.is_viscous() => {
            "; viscous, the most probable law over frequency".to_owned()
        }
        (Some(follows), Some(_)) if structural_at(fitted).is_some() => {
            let loss = follows.loss_factor.and_then(|loss| loss.value[0][0].zip(loss.std[0][0]));
            let loss = loss.map_or(String::new(), |(loss, std)| {
                format!(", the loss factor of k11 being {} +- {}", short(loss), short(std))
            });
            format!("; its law over frequency is {}{loss}", words(&follows.law))
        }
        (Some(follows), Some(_)) if !follows.is_viscous() => format!(
            "; its law over frequency is {}, and K and C are what it has at {} Hz alone",
            words(&follows.law),
            short(follows.frequency)
        ),
        (_, Some(law)) => match law.strip_prefix("viscous") {
            Some(_) => "; viscous, the most probable law over frequency".to_owned(),
            None => format!(
                "; K and C are those of a viscous joint, over frequency the most probable law is {}",
                words(law)
            ),
        },
        (_, None) => String::new(),
    }
}

/// Remarks on what the estimate is worth; refuses one that is of no use.
fn judged(decomposed: &Decomposed, anyway: bool) -> Result<Vec<String>, ExportError> {
    let Some(judgement) = &decomposed.judgement else {
        let at_once = decomposed.fitted.as_ref().filter(|_| decomposed.at_once.is_some());
        return Ok(at_once.map_or(Vec::new(), fitted_with_others));
    };
    let why = match (judgement.poor_fit, &decomposed.failed) {
        (_, Some(failed)) => failed.clone(),
        (Some(chi2), None) => format!("a constant joint leaves chi2 per degree of freedom {chi2:.3}"),
        (None, None) => "k11 is not determined, or fit and means exclude each other".to_owned(),
    };
    match judgement.verdict.as_str() {
        "unusable" if !anyway => Err(ExportError::Unusable(why)),
        "unusable" => Ok(vec![format!("THE JOINT IS JUDGED UNUSABLE: {why}")]),
        "with_care" => {
            let mut notes = vec!["use with care: the joint departs from the fixture, or the model does not explain the test in full".to_owned()];
            if let Some(chi2) = judgement.poor_fit {
                notes.push(format!("chi2 per degree of freedom of this constant joint: {chi2:.3}"));
            }
            Ok(notes)
        }
        _ => Ok(Vec::new()),
    }
}

/// Remarks on what a fit of several joints leaves unexplained; no judgement is passed on one of them.
fn fitted_with_others(fitted: &FiledJoint) -> Vec<String> {
    let error = &fitted.model_error;
    let chi2 = fitted.chi2_per_dof.filter(|_| error.inflation > 1.0);
    let unexplained = chi2.map(|chi2| {
        format!("use with care: the fit leaves chi2 per degree of freedom {chi2:.3}, so noise and tolerances do not explain the test in full")
    });
    let departing = (error.tolerance_inflation > 1.0).then(|| {
        format!(
            "use with care: the fit moves the fixture's quantities {:.1} times as far as chance does",
            error.tolerance_inflation.sqrt()
        )
    });
    unexplained.into_iter().chain(departing).collect()
}

/// Remarks on what physics forbids of the joint that the FRFs speak for.
fn failed_tests(tests: &FiledTests) -> Vec<String> {
    let said = |(name, p): (&str, f64)| {
        let (what, but) = match name {
            "reciprocity" => ("a joint that is not reciprocal", "K and C are written symmetric all the same"),
            "definite" => ("a K with a negative eigenvalue", "look for what the fixture leaves out"),
            _ => ("a C that gives out energy", "C is held to the nearest that does not"),
        };
        format!("the FRFs speak for {what} (p = {}), which physics forbids: {but}", short(p))
    };
    tests.failed().map(said).collect()
}

fn placed(
    decomposed: &Decomposed,
    ends: &Ends,
    estimate: Estimate,
    options: &ExportOptions,
    nodes: &mut Nodes,
) -> Result<Joint, ExportError> {
    let mut end = |end: &jointscope_comparison::End, existing: Option<u64>| {
        let says = format!("point {} of body {}", end.point, end.body);
        let node = match (existing, nodes.points.get(&end.point)) {
            (Some(number), _) => nodes.numbering.existing(number, end.x, says)?,
            (None, Some(number)) => *number,
            (None, None) => nodes.numbering.point(&end.point, end.x, &says),
        };
        nodes.points.insert(end.point.clone(), node);
        Ok::<_, ExportError>(JointNode { point: end.point.clone(), body: end.body.clone(), x: end.x, node })
    };
    let [[_, k12], [_, k22]] = estimate.stiffness;
    let [[_, c12], [_, c22]] = estimate.damping;
    Ok(Joint {
        name: decomposed.joint.clone(),
        says: estimate.says,
        from: end(&ends.from, options.nodes.map(|nodes| nodes[0]))?,
        to: end(&ends.to, options.nodes.map(|nodes| nodes[1]))?,
        length: ends.length,
        scalar: [k12, k22, c12, c22].iter().all(|element| *element == 0.0),
        stiffness: estimate.stiffness,
        damping: estimate.damping,
        structural: estimate.structural,
        structural_at: estimate.structural_at,
        mass: estimate.mass.map(|mass| mass_of_ends(mass.value, ends.length)),
        std: estimate.std,
        covariance: estimate.covariance,
        lines: Vec::new(),
    })
}

fn lines(decomposed: &Decomposed) -> Result<Vec<JointAtFrequency>, ExportError> {
    if decomposed.relation != "exact" {
        return Err(ExportError::PaperLines);
    }
    if decomposed.at_once.is_some() {
        let why = "joints that one fit found at once have none; `jointscope decompose --joint` solves the lines of one joint that alone connects its sides";
        return Err(ExportError::NoLines(why.to_owned()));
    }
    let lines: Vec<JointAtFrequency> = decomposed
        .lines
        .iter()
        .filter(|line| !line.noisy)
        .map(|line| JointAtFrequency {
            frequency: line.frequency,
            stiffness: symmetric(&line.stiffness),
            damping: symmetric(&line.damping),
        })
        .collect();
    match lines.len() {
        0 | 1 => Err(ExportError::NoLines(format!("noise dominates all but {} of them", lines.len()))),
        _ => Ok(lines),
    }
}
