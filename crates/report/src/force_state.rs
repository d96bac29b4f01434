//! The section of a joint's force–state map.

use jointscope_fixture::{Dof, Fixture};
use jointscope_nonlinear::{ForceState, ForceStateError, ForceStateMap, MotionSource, RestoringLaw};

use crate::format::significant;
use crate::scatter::{Scatter, draw};
use crate::section::Section;

/// Most points of a panel.
const POINTS: usize = 1500;
/// Points of a law's curve.
const CURVE: usize = 121;

/// What joints bore against how they were moved, or why that cannot be drawn.
pub(crate) fn section(maps: &[Result<ForceStateMap, ForceStateError>], fixture: &Fixture) -> Section {
    let mut section = Section::new("Force against motion, as measured");
    for map in maps {
        section = match map {
            Ok(map) => drawn(section, map, fixture),
            Err(why) => section.paragraph(format!("A force–state map is not drawn: {why}.")),
        };
    }
    section
}

fn drawn(section: Section, map: &ForceStateMap, fixture: &Fixture) -> Section {
    let mut section = section.paragraph(origin(map, fixture));
    let modelled: Vec<&str> = of_source(map, MotionSource::Model);
    if !modelled.is_empty() {
        section = section.warnings([format!(
            "Too few sensors follow {}: its motion is taken from the fitted model, so d is in part what the model says.",
            modelled.join(" and ")
        )]);
    }
    for component in &map.components {
        let name = component.dof.name();
        let description = format!("force of joint {} against {name} and velocity", map.joint);
        section = section.drawing(draw(&panels(component), &description), caption(map, component));
    }
    section
}

fn of_source(map: &ForceStateMap, source: MotionSource) -> Vec<&str> {
    map.sources.iter().filter(|(_, s)| *s == source).map(|(name, _)| name.as_str()).collect()
}

fn origin(map: &ForceStateMap, fixture: &Fixture) -> String {
    let mut text = format!(
        "Joint {} under hit {} ({:.0} N). Its force is the inertia force of {} less the hammer's: neither stiffness nor law of the joint enters it. The relative motion d is integrated from accelerations above {} Hz and is the fitted model's below; force and motion are drawn up to {} Hz.",
        map.joint,
        map.hit,
        map.peak_force,
        map.weighed.join(" and "),
        significant(map.band.0, 4),
        significant(map.band.1, 4)
    );
    let balanced = of_source(map, MotionSource::Momentum);
    if !balanced.is_empty() {
        text.push_str(&format!(
            " The motion of {} follows from the other sensors and the hammer by the balance of momentum of {}, which nothing holds.",
            balanced.join(" and "),
            if fixture.name().is_empty() { "the assembly" } else { fixture.name() }
        ));
    }
    text
}

fn panels(component: &ForceState) -> Vec<Scatter> {
    let (length, speed, force) = match component.dof {
        Dof::Translation => ("m", "m/s", "N"),
        Dof::Rotation => ("rad", "rad/s", "N*m"),
    };
    let (d, v) = (&component.motion, &component.velocity);
    let beyond = component.beyond_linear();
    let left = component.left_over();
    let along_d = |title: &str, y: &str, values: &[f64], curve: Vec<[f64; 2]>| Scatter {
        title: title.to_owned(),
        axes: [("d".to_owned(), length), (y.to_owned(), force)],
        clouds: by_sign(d, values, v),
        curve,
    };
    let laws = curve(component);
    let whole = laws.iter().map(|[d, g]| [*d, component.stiffness * d + g]).collect();
    let dashpot = component.dashpot();
    let fastest = v.iter().fold(0.0, |most: f64, v| v.abs().max(most));
    vec![
        along_d("All of it", "force", &component.force, whole),
        along_d("Beyond the linear spring", "force − k·d", &beyond, laws),
        Scatter {
            title: "Beyond spring and law".to_owned(),
            axes: [("ḋ".to_owned(), speed), ("force − k·d − g(d)".to_owned(), force)],
            clouds: by_sign(v, &left, v),
            curve: vec![[-fastest, -dashpot * fastest], [fastest, dashpot * fastest]],
        },
    ]
}

/// Thinned points, those with a falling d apart from those with a rising one.
fn by_sign(x: &[f64], y: &[f64], velocity: &[f64]) -> Vec<(&'static str, Vec<[f64; 2]>)> {
    let every = x.len().div_ceil(POINTS).max(1);
    let of = |rising: bool| {
        let points = x.iter().zip(y).zip(velocity).step_by(every);
        points.filter(|(_, v)| (**v >= 0.0) == rising).map(|((x, y), _)| [*x, *y]).collect()
    };
    vec![("--trace-1", of(true)), ("--trace-2", of(false))]
}

/// The laws over the range of d. One that remembers is carried along twice from end to end, so that its
/// outermost loop is drawn.
fn curve(component: &ForceState) -> Vec<[f64; 2]> {
    let low = component.motion.iter().copied().fold(0.0, f64::min);
    let high = component.motion.iter().copied().fold(0.0, f64::max);
    let at = |i: usize| low + (high - low) * i as f64 / (CURVE - 1) as f64;
    let remembers = component.laws.iter().any(|law| matches!(law, RestoringLaw::Friction { .. }));
    let there = (0..CURVE).map(at);
    let path: Vec<f64> = match remembers {
        true => there.clone().chain((0..CURVE).rev().map(at)).chain(there).collect(),
        false => there.collect(),
    };
    let forces: Vec<Vec<f64>> = component.laws.iter().map(|law| law.forces(&path)).collect();
    let all = |i: usize| forces.iter().fold(0.0, |sum, force| sum + force[i]);
    let mut points: Vec<[f64; 2]> = path.iter().enumerate().map(|(i, d)| [*d, all(i)]).collect();
    // The first leg of a loop only leads up to it.
    if remembers { points.split_off(CURVE) } else { points }
}

fn caption(map: &ForceStateMap, component: &ForceState) -> String {
    let name = component.dof.name();
    let coupling = "the part that the other component's motion causes is taken off";
    let explained = match component.explained() {
        Some(share) => format!(
            "The law found explains {:.1} % of the mean square of what lies beyond the linear spring.",
            100.0 * share
        ),
        None => "No law was found for this component.".to_owned(),
    };
    format!(
        "Joint {} in {name}: force against d ({coupling}), the same without k·d, and what is left against velocity; blue while d rises, orange while it falls. Curves: linear spring with the law found, the law alone (of friction, the outermost loop), and the dashpot that fits what is left, {:.3} {}. {explained}",
        map.joint,
        component.dashpot(),
        if component.dof == Dof::Rotation { "N·m·s/rad" } else { "N·s/m" },
    )
}
