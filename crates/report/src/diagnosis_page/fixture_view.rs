//! The fixture from the side, with the places of the findings marked.

use jointscope_diagnosis::Site;
use jointscope_fixture::{BodyKind, Effect, EffectKind, Fixture, Place};

use super::subject::Subject;
use crate::drawing::{Drawing, Highlight, SideView};

/// The drawing and its caption.
pub(super) fn drawing(subject: &Subject) -> (Drawing, String) {
    let (fixture, diagnosis) = (subject.fixture, subject.diagnosis);
    let mut view = SideView::new(fixture, diagnosis.observation.pairs());
    for (index, finding) in diagnosis.findings.iter().enumerate() {
        let effect = &finding.effect;
        if let Place::Joint(name) = &effect.place {
            view.joints.push(name);
        }
        if let Some((x, body)) = place(fixture, effect) {
            let label = format!("{}. {}", index + 1, effect.kind.name().replace('_', " "));
            view.highlights.push(Highlight { x, body, label });
            let others = finding.evidence.likely_places().filter_map(|other| other.abscissa());
            let other = |x: f64| Highlight { x, body, label: format!("{}. or here", index + 1) };
            view.highlights.extend(others.map(other));
        }
        // What sits at one place has one label.
        if let [.., earlier, last] = view.highlights.as_mut_slice()
            && (earlier.x, earlier.body) == (last.x, last.body)
        {
            earlier.label = format!("{}, {}", earlier.label, last.label);
            view.highlights.pop();
        }
    }
    let best = diagnosis.best_place();
    view.highlights.extend(best.and_then(|location| at_site(fixture, &location.site)));
    let marked = match (diagnosis.findings.len(), best) {
        (0, None) => "no place is marked",
        (0, Some(_)) => "marked is the place that would explain most of what is left",
        (_, Some(_)) => {
            "marked are the places of the findings, which are doubtful, and the place that would explain most by itself"
        }
        (1, _) => "marked is where the finding sits",
        _ => "marked is where the findings sit, by their numbers",
    };
    let elsewhere = match diagnosis.findings.iter().any(|finding| finding.evidence.may_be_elsewhere()) {
        true => ", and where it may sit as well",
        false => "",
    };
    let everywhere = diagnosis
        .findings
        .iter()
        .any(|finding| matches!(finding.effect.place, Place::All | Place::Force | Place::Responses));
    let all = if everywhere { " One finding concerns the whole measurement and has no place." } else { "" };
    (
        view.draw(),
        format!(
            "Side view with the channels in use, responses (sensors) in blue and references (hammer) in green; {marked}{elsewhere}.{all} The outlines of \
             blocks are sketched."
        ),
    )
}

/// Abscissa and body of an effect; nothing for what concerns the whole measurement.
fn place(fixture: &Fixture, effect: &Effect) -> Option<(f64, Option<usize>)> {
    match &effect.place {
        Place::Body(name) => {
            let body = fixture.bodies().iter().position(|body| body.name == *name)?;
            let parameters = effect.kind.spec().parameters;
            let turns = !matches!(&fixture.bodies()[body].kind, BodyKind::Rigid(rigid) if !rigid.rotates);
            let placed = |index: &usize| turns && effect.has_parameter(*index);
            let x = parameters.iter().position(|p| p.name == "x").filter(placed);
            let x = x.map(|index| effect.value(index));
            Some((x.unwrap_or_else(|| centre(fixture, body)), Some(body)))
        }
        Place::Point(name) | Place::Response(name) | Place::Reference(name) => {
            let point = fixture.point(name)?;
            // Where a sensor or an impact really is, not where the fixture has it.
            let offset = if effect.kind == EffectKind::PointOffset { effect.value(0) } else { 0.0 };
            Some((point.x.value + offset, Some(point.body)))
        }
        Place::Record(name) => {
            let point = name.split_once('/').and_then(|(response, _)| fixture.point(response))?;
            Some((point.x.value, Some(point.body)))
        }
        Place::Joint(name) => middle(fixture, name).map(|x| (x, None)),
        Place::Between(one, _) => {
            let body = fixture.bodies().iter().position(|body| body.name == *one)?;
            Some((effect.value(0), Some(body)))
        }
        Place::Force | Place::Responses | Place::All | Place::Quantity(..) => None,
    }
}

fn at_site(fixture: &Fixture, site: &Site) -> Option<Highlight> {
    let (x, body) = match site {
        Site::Body { body, x } => (*x, fixture.bodies().iter().position(|b| b.name == *body)),
        Site::Series { joint, point: None, .. } | Site::Joint(joint) => (middle(fixture, joint)?, None),
        Site::Series { point: Some(point), .. }
        | Site::Response(point)
        | Site::Reference(point)
        | Site::Position(point) => {
            let point = fixture.point(point)?;
            (point.x.value, Some(point.body))
        }
    };
    Some(Highlight { x, body, label: "best place".to_owned() })
}

fn middle(fixture: &Fixture, joint: &str) -> Option<f64> {
    let joint = fixture.joint(joint)?;
    let end = |index: usize| fixture.points().get(index).map(|point| point.x.value);
    Some(0.5 * (end(joint.from)? + end(joint.to)?))
}

fn centre(fixture: &Fixture, body: usize) -> f64 {
    match fixture.bodies().get(body).map(|body| &body.kind) {
        Some(BodyKind::Beam(beam)) => 0.5 * (beam.from.value + beam.to.value),
        Some(BodyKind::Rigid(rigid)) => {
            let first = fixture.points().iter().find(|point| point.body == body).map(|point| point.x.value);
            rigid.x_cg.as_ref().map(|x| x.value).or(first).unwrap_or(0.0)
        }
        None => 0.0,
    }
}
