//! Every place through which one unknown scalar a line may act, and which place an effect acts through.

use super::Site;
use crate::Observation;
use crate::bodies::{extent, turns};
use crate::settings::location::sites::{GRID, GRID_OF_BEAM, SAME_PLACE, STRETCH};
use jointscope_fixture::{BodyKind, Dof, Effect, Entry, Fixture, Joint, Place};
use jointscope_lumped::{JointElement, nominal_stiffness};
use jointscope_spectra::Channel;

/// The sites of a fixture and a recording; of each stretch of a body several abscissae from which the best
/// may be sought.
pub(super) fn sites(fixture: &Fixture, observation: &Observation) -> Vec<Vec<Site>> {
    let stretches = |body| on_body(fixture, body).chunks(STRETCH).map(<[Site]>::to_vec).collect::<Vec<_>>();
    let mut all: Vec<Vec<Site>> = (0..fixture.bodies().len()).flat_map(stretches).collect();
    for joint in fixture.joints() {
        let stiffness = nominal_stiffness(&joint.law, fixture.joint_length(joint));
        if stiffness.at(0, 0) > 0.0 {
            all.extend(series(fixture, joint, Dof::Translation).into_iter().map(|site| vec![site]));
        }
        if stiffness.at(1, 1) > 0.0 {
            all.extend(series(fixture, joint, Dof::Rotation).into_iter().map(|site| vec![site]));
        }
        all.push(vec![Site::Joint(joint.name.clone())]);
    }
    let channels = |name: fn(&jointscope_spectra::FrfPair) -> &Channel| {
        let mut names: Vec<&Channel> = observation.pairs().iter().map(name).collect();
        names.sort();
        names.dedup();
        names.into_iter()
    };
    all.extend(channels(|p| &p.response).map(|c| vec![Site::Response(c.to_string())]));
    all.extend(channels(|p| &p.reference).map(|c| vec![Site::Reference(c.to_string())]));
    let mut seats: Vec<&Channel> = channels(|p| &p.response)
        .chain(channels(|p| &p.reference))
        .filter(|c| c.dof == Dof::Translation)
        .collect();
    seats.sort();
    seats.dedup();
    let turns = |c: &&Channel| fixture.point(&c.point).is_some_and(|p| turns(fixture, p.body));
    all.extend(seats.into_iter().filter(turns).map(|c| vec![Site::Position(c.point.clone())]));
    all
}

fn on_body(fixture: &Fixture, body: usize) -> Vec<Site> {
    let name = &fixture.bodies()[body].name;
    let at = |x: f64| Site::Body { body: name.clone(), x };
    let (low, high) = extent(fixture, body);
    if !turns(fixture, body) {
        return vec![at(low)];
    }
    let count = match &fixture.bodies()[body].kind {
        BodyKind::Rigid(_) => GRID,
        BodyKind::Beam(_) => GRID_OF_BEAM,
    };
    let mut places: Vec<f64> =
        (0..count).map(|i| low + (high - low) * i as f64 / (count - 1).max(1) as f64).collect();
    places.extend(fixture.points().iter().filter(|p| p.body == body).map(|p| p.x.value));
    if let BodyKind::Rigid(rigid) = &fixture.bodies()[body].kind {
        places.extend(rigid.x_cg.map(|q| q.value));
    }
    places.sort_by(f64::total_cmp);
    places.dedup_by(|a, b| (*a - *b).abs() < SAME_PLACE * (high - low));
    places.into_iter().map(at).collect()
}

/// A joint's series sites in one direction. Without mass of its own, translation reads the same at either
/// end; at a point that two joints share nothing can be put in series with one of them alone.
fn series(fixture: &Fixture, joint: &Joint, dof: Dof) -> Vec<Site> {
    let points = fixture.points();
    let site = |point| Site::Series { joint: joint.name.clone(), point, dof };
    if dof == Dof::Translation && !JointElement::new(fixture, joint).is_heavy() {
        return vec![site(None)];
    }
    let alone = |p: &&usize| fixture.joints().iter().filter(|j| j.from == **p || j.to == **p).count() == 1;
    [joint.from, joint.to].iter().filter(alone).map(|p| site(Some(points[*p].name.clone()))).collect()
}

impl Site {
    /// Whether both are the same but for a body's abscissa.
    pub(super) fn is_like(&self, other: &Site) -> bool {
        match (self, other) {
            (Site::Body { body, .. }, Site::Body { body: another, .. }) => body == another,
            _ => self == other,
        }
    }

    /// Whether `effect` would act through this site of `fixture`. A body's abscissa is not compared: the
    /// effect's own is fitted.
    pub fn holds(&self, effect: &Effect, fixture: &Fixture) -> bool {
        match (self, &effect.place, effect.kind.spec().entry) {
            (Site::Body { body, .. }, Place::Body(name), Entry::RankOne) => {
                body == name && effect.dof.is_none()
            }
            (Site::Series { joint, point, dof }, Place::Point(name), Entry::InSeries) => {
                let ends = fixture.joint(joint).map(|j| [j.from, j.to]);
                let at_an_end = ends.is_some_and(|e| e.iter().any(|p| fixture.points()[*p].name == *name));
                let here = point.as_ref().is_none_or(|point| point == name);
                here && at_an_end && effect.dof == Some(*dof)
            }
            (
                Site::Series { joint, dof: Dof::Translation, point: None, .. },
                Place::Joint(name),
                Entry::InSeries,
            )
            | (Site::Joint(joint), Place::Joint(name), Entry::Modulus) => joint == name,
            (Site::Response(channel), Place::Response(name), Entry::Signal | Entry::SensorLoad)
            | (Site::Reference(channel), Place::Reference(name), Entry::Signal)
            | (Site::Position(channel), Place::Point(name), Entry::Offset) => channel == name,
            _ => false,
        }
    }

    /// The site through which `effect` acts in `fixture`; `None` for an effect of higher rank.
    pub fn of(fixture: &Fixture, effect: &Effect) -> Option<Self> {
        let sites = match (&effect.place, effect.kind.spec().entry) {
            (Place::Body(body), Entry::RankOne) if effect.dof.is_none() => {
                vec![Site::Body { body: body.clone(), x: effect.value(0) }]
            }
            (Place::Point(name), Entry::Offset) => vec![Site::Position(name.clone())],
            (Place::Response(name), _) => vec![Site::Response(name.clone())],
            (Place::Reference(name), _) => vec![Site::Reference(name.clone())],
            (Place::Joint(name), Entry::Modulus) => vec![Site::Joint(name.clone())],
            _ => {
                let dofs = [Dof::Translation, Dof::Rotation];
                let of = |joint| dofs.into_iter().flat_map(move |dof| series(fixture, joint, dof));
                fixture.joints().iter().flat_map(of).collect()
            }
        };
        sites.into_iter().find(|site| site.holds(effect, fixture))
    }
}
