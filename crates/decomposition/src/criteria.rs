//! The criteria by which an analysis is judged: its fit, what fit and means say of each other, the fixture.

use crate::settings::estimates::{BEYOND_CHANCE, NOT_RIGID, ON_THE_BOUNDARY};
use crate::{
    Analysis, Contradiction, DynamicStiffnessPart, JointEstimate, Judgement, MatrixElement, Method, Relation,
    Use,
};
use jointscope_fixture::{Fixture, JointLaw, Nature, Quantity};
use jointscope_inference::Z95;

impl Judgement {
    /// Judges an analysis made with this fixture.
    pub fn of(analysis: &Analysis, fixture: &Fixture) -> Self {
        let best = JointEstimate::best(analysis);
        let scalar = analysis.spectrum.scalar;
        let fit = analysis.likelihood.as_ref().ok();
        let first = best.figure(DynamicStiffnessPart::Stiffness, MatrixElement::all(scalar)[0]);
        let whole = analysis.joint_fit.as_ref().ok();
        let poor_fit = match whole {
            Some(whole) => (!whole.explains()).then_some(whole.chi2_per_dof),
            None => fit.filter(|fit| !fit.explains()).map(|fit| fit.chi2_per_dof),
        };
        let contradiction = contradiction(analysis, &best);
        let not_rigid = analysis.spectrum.h41.rigidity().filter(|chi2| *chi2 > NOT_RIGID);
        let agrees_with_fixture =
            MatrixElement::distinct(scalar).all(|element| agrees(analysis, fixture, &best, element));
        let is_short = poor_fit.or(not_rigid).is_some();
        // What explains every FRF is worth more than means over lines of it.
        let excluded = is_short && contradiction.is_some_and(|contradiction| contradiction.excludes_use());
        let verdict = if (fit.is_none() && whole.is_none()) || !first.is_determined() || excluded {
            Use::Unusable
        } else if is_short || contradiction.is_some() || !agrees_with_fixture {
            Use::WithCare
        } else {
            Use::Sound
        };
        let of_fit = || {
            fit.is_some_and(|fit| {
                let c = &fit.damping;
                match scalar {
                    true => c.at(0, 0) == 0.0,
                    false => c.determinant() <= ON_THE_BOUNDARY * c.at(0, 0) * c.at(1, 1),
                }
            })
        };
        let damping_at_limit = whole.map_or_else(of_fit, |whole| whole.is_on_the_boundary);
        Judgement { verdict, poor_fit, contradiction, not_rigid, agrees_with_fixture, damping_at_limit }
    }
}

/// The element that the fit and the weighted mean differ in most; nothing where they agree, are of different
/// relations, or the fitted joint has a mass, which the lines hold as well.
fn contradiction(analysis: &Analysis, best: &JointEstimate) -> Option<Contradiction> {
    if !matches!(best.method, Method::MaximumLikelihood | Method::AllFrfs)
        || analysis.spectrum.relation == Relation::Paper
        || analysis.lines_hold_mass()
    {
        return None;
    }
    let weighted = JointEstimate::weighted(analysis)?;
    let plain = JointEstimate::plain(analysis);
    let root = |index: usize| {
        best.figure(DynamicStiffnessPart::Stiffness, MatrixElement { row: index, column: index })
            .value
            .abs()
            .sqrt()
    };
    let differences = MatrixElement::all(analysis.spectrum.scalar).iter().filter_map(|&element| {
        let [fit, mean, plain] = [best, &weighted, &plain]
            .map(|estimate| estimate.figure(DynamicStiffnessPart::Stiffness, element));
        // Tolerances of the weighted mean are much those of the plain one.
        let tolerance = plain.tolerance.unwrap_or(0.0);
        let difference = (fit.value - mean.value).abs();
        let beyond = difference > BEYOND_CHANCE * fit.total().hypot(mean.noise).hypot(tolerance);
        let relative = difference / (root(element.row) * root(element.column));
        beyond.then_some(Contradiction { element, fit: fit.value, mean: mean.value, relative })
    });
    differences.max_by(|a, b| a.relative.total_cmp(&b.relative))
}

fn agrees(analysis: &Analysis, fixture: &Fixture, best: &JointEstimate, element: MatrixElement) -> bool {
    let figure = best.figure(DynamicStiffnessPart::Stiffness, element);
    // Nothing disagrees with what is stated as unknown.
    let Some(known) = nominal_std(analysis, fixture, element) else { return true };
    let nominal = analysis.nominal_average(DynamicStiffnessPart::Stiffness, element, best.paper);
    nominal.is_some_and(|nominal| (figure.value - nominal).abs() <= Z95 * figure.total().hypot(known))
}

/// How well the fixture knows an element of its joint's stiffness.
fn nominal_std(analysis: &Analysis, fixture: &Fixture, element: MatrixElement) -> Option<f64> {
    let joint = fixture.joint(&analysis.joint)?;
    let relative = |q: &Quantity, nature: Nature| Some(q.std(nature, false)? / q.value);
    match &joint.law {
        JointLaw::Beam { youngs_modulus, second_moment } => {
            let points = fixture.points();
            let end = |point: usize| points.get(point)?.x.std(Nature::Abscissa, false);
            let of_length = end(joint.from)?.hypot(end(joint.to)?) / fixture.joint_length(joint);
            // EI/L³, EI/L², EI/L.
            let power = 3.0 - (element.row + element.column) as f64;
            let of_bending = relative(youngs_modulus, Nature::YoungsModulus)?
                .hypot(relative(second_moment, Nature::SecondMoment)?);
            Some(of_bending.hypot(power * of_length) * element.of(&analysis.nominal_stiffness).abs())
        }
        JointLaw::Stiffness { stiffness, .. } => {
            stiffness.get(element.row + element.column)?.std(Nature::JointStiffness, false)
        }
    }
}
