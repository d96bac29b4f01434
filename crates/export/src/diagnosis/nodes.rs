//! Nodes of the repaired fixture's points, and of other places on its bodies.

use crate::numbering::Numbering;
use crate::repaired_joint::is_on;
use crate::{ExportError, JointNode};
use jointscope_fixture::{Effect, EffectKind, Fixture, Point};
use std::collections::BTreeMap;

/// Abscissae that are one, m.
const SAME_PLACE: f64 = 1e-9;

/// The nodes that were asked for so far.
pub(super) struct FixtureNodes<'a> {
    pub(super) fixture: &'a Fixture,
    /// How far longer joints move each body, m.
    shifts: Vec<f64>,
    pub(super) numbering: Numbering,
    /// Whether numbers of nodes are those of the user's model.
    numbers_are_the_models: bool,
    /// Nodes of points by their index.
    points: BTreeMap<usize, u64>,
}

impl<'a> FixtureNodes<'a> {
    pub(super) fn new(fixture: &'a Fixture, numbering: Numbering, numbers_are_the_models: bool) -> Self {
        FixtureNodes {
            fixture,
            shifts: shifts(fixture),
            numbering,
            numbers_are_the_models,
            points: BTreeMap::new(),
        }
    }

    /// A point's node is one of the user's model.
    pub(super) fn existing(&mut self, point: usize, number: u64) -> Result<(), ExportError> {
        let (x, says) = (self.x_of(point), self.point_says(point));
        let node = self.numbering.existing(number, x, says)?;
        self.points.insert(point, node);
        Ok(())
    }

    /// A node beside a place of a body, which moves along y only.
    pub(super) fn along_y(&mut self, body: usize, x: f64, says: String) -> u64 {
        self.numbering.along_y(x + self.shifts[body], says)
    }

    fn x_of(&self, point: usize) -> f64 {
        let point = &self.fixture.points()[point];
        point.x.value + self.shifts[point.body]
    }

    fn point_says(&self, point: usize) -> String {
        let point = &self.fixture.points()[point];
        format!("point {} of body {}", point.name, self.fixture.bodies()[point.body].name)
    }

    pub(super) fn node_of(&mut self, point: usize) -> u64 {
        if let Some(node) = self.points.get(&point) {
            return *node;
        }
        let (x, says) = (self.x_of(point), self.point_says(point));
        // Beside nodes of the model, names of points are no numbers of its nodes.
        let node = match self.numbers_are_the_models {
            true => self.numbering.on_body((x, 0.0), &says),
            false => self.numbering.point(&self.fixture.points()[point].name, x, &says),
        };
        self.points.insert(point, node);
        node
    }

    /// The node at an abscissa of a body: a point's where there is one.
    pub(super) fn node_at(&mut self, body: usize, x: f64) -> u64 {
        let here = |point: &Point| point.body == body && (point.x.value - x).abs() <= SAME_PLACE;
        if let Some(point) = self.fixture.points().iter().position(here) {
            return self.node_of(point);
        }
        self.node_above(body, (x, 0.0))
    }

    /// A node at an abscissa of a body and a height above its axis.
    pub(super) fn node_above(&mut self, body: usize, (x, height): (f64, f64)) -> u64 {
        let says = format!("on body {}", self.fixture.bodies()[body].name);
        self.numbering.on_body((x + self.shifts[body], height), &says)
    }

    pub(super) fn body(&self, name: &str) -> Option<usize> {
        self.fixture.bodies().iter().position(|body| body.name == *name)
    }

    /// Some node of a body that turns as one.
    pub(super) fn any_node_of(&mut self, body: usize) -> u64 {
        match self.fixture.points().iter().position(|point| point.body == body) {
            Some(point) => self.node_of(point),
            None => self.node_at(body, 0.0),
        }
    }

    pub(super) fn end(&mut self, point: usize) -> JointNode {
        let node = self.node_of(point);
        let named = &self.fixture.points()[point];
        let body = self.fixture.bodies()[named.body].name.clone();
        JointNode { point: named.name.clone(), body, x: self.x_of(point), node }
    }
}

/// How far a longer joint moves the bodies beyond it, m, by body.
fn shifts(fixture: &Fixture) -> Vec<f64> {
    let mut shifts = vec![0.0; fixture.bodies().len()];
    let body = |point: usize| fixture.points()[point].body;
    for (index, joint) in fixture.joints().iter().enumerate() {
        let longer = |e: &&Effect| e.kind == EffectKind::JointLength && is_on(fixture, joint, e);
        let dx: f64 = fixture.physics().iter().filter(longer).map(|effect| effect.value(0)).sum();
        let mut beyond = vec![false; shifts.len()];
        beyond[body(joint.to)] = true;
        loop {
            let others = fixture.joints().iter().enumerate().filter(|(other, _)| *other != index);
            let reached = others.map(|(_, other)| (body(other.from), body(other.to)));
            let Some((a, b)) = reached.into_iter().find(|(a, b)| beyond[*a] != beyond[*b]) else { break };
            (beyond[a], beyond[b]) = (true, true);
        }
        shifts.iter_mut().zip(&beyond).filter(|(_, beyond)| **beyond).for_each(|(shift, _)| *shift += dx);
    }
    shifts
}
