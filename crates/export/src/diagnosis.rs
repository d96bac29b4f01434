//! What a diagnosis found: the repaired fixture's joints, supports and effects, with what `diagnosis.json`
//! says of their uncertainty.

mod entry;
mod nodes;
mod omitted;

use crate::numbering::Numbering;
use crate::numbers::short;
use crate::parts::{Element, Omitted, Part};
use crate::repaired_joint::{RepairedJoint, is_on};
use crate::{Export, ExportError, ExportOptions, Joint};
use entry::{DiagnosisEntry, FindingEntry, says};
use jointscope_fixture::{Dof, Effect, EffectKind as Kind, Fixture, Place};
use nodes::FixtureNodes;
use omitted::{damping, findings_beside_effects, why_not};
use serde::Deserialize;
use serde_json::Value;
use std::f64::consts::TAU;

/// Lines of K and C by frequency over the recording's band.
const LINES: usize = 201;

/// A diagnosis as an export, of the contents of its `diagnosis.json` and its repaired fixture.
///
/// # Errors
/// A diagnosis that nothing explains, numbers that cannot be, nothing that could be exported.
pub fn of_diagnosis(
    diagnosis: &Value,
    repaired: &Fixture,
    options: &ExportOptions,
) -> Result<Export, ExportError> {
    let diagnosis = DiagnosisEntry::deserialize(diagnosis)
        .map_err(|error| ExportError::Diagnosis(error.to_string().replace('`', "")))?;
    if diagnosis.verdict == "unexplained" && !options.anyway {
        return Err(ExportError::Unexplained);
    }
    let mut exporter = Exporter {
        nodes: FixtureNodes::new(repaired, Numbering::from(options.first_id)?, options.nodes.is_some()),
        notes: vec![format!("verdict of the diagnosis: {}", diagnosis.verdict)],
        parts: Vec::new(),
        omitted: Vec::new(),
        band: diagnosis.band(),
        findings: &diagnosis.findings,
    };
    if diagnosis.unnamed && !diagnosis.findings.is_empty() {
        exporter.notes.push(
            "no finding is likelier than something that is not listed: what was found is a description, not a cause".to_owned(),
        );
    }
    let joints = exporter.joints(options)?;
    exporter.notes.extend(joints.iter().filter_map(Joint::indefinite));
    exporter.supports();
    repaired.physics().iter().for_each(|effect| exporter.effect(effect));
    exporter.omitted.extend(findings_beside_effects(&diagnosis.findings, repaired.physics()));
    exporter.omitted.extend(damping(repaired.damping()));
    if joints.is_empty() && exporter.parts.is_empty() {
        return Err(ExportError::Nothing);
    }
    let (nodes, first_id) = exporter.nodes.numbering.finish();
    Export {
        title: format!("the repaired fixture of a diagnosis, {}", repaired.name()),
        notes: exporter.notes,
        nodes,
        joints,
        parts: exporter.parts,
        not_exported: exporter.omitted,
        first_id,
    }
    .checked()
}

struct Exporter<'a> {
    nodes: FixtureNodes<'a>,
    notes: Vec<String>,
    parts: Vec<Part>,
    omitted: Vec<Omitted>,
    band: Option<(f64, f64)>,
    findings: &'a [FindingEntry],
}

impl Exporter<'_> {
    fn joints(&mut self, options: &ExportOptions) -> Result<Vec<Joint>, ExportError> {
        let fixture = self.nodes.fixture;
        let known = || fixture.joints().iter().map(|j| j.name.as_str()).collect::<Vec<_>>().join(", ");
        let chosen: Vec<_> = fixture
            .joints()
            .iter()
            .filter(|joint| options.joint.as_ref().is_none_or(|name| *name == joint.name))
            .collect();
        match (&options.joint, options.nodes) {
            (Some(name), _) if chosen.is_empty() => {
                return Err(ExportError::NoSuchJoint { name: name.clone(), known: known() });
            }
            (None, Some(_)) if chosen.is_empty() => return Err(ExportError::NoJoint),
            (None, Some(_)) if chosen.len() > 1 => return Err(ExportError::WhichJoint { known: known() }),
            _ => {}
        }
        if let (Some(nodes), [joint]) = (options.nodes, chosen.as_slice()) {
            for (point, number) in [joint.from, joint.to].into_iter().zip(nodes) {
                self.nodes.existing(point, number)?;
            }
        }
        for joint in fixture.joints().iter().filter(|joint| !chosen.iter().any(|c| c.name == joint.name)) {
            let why = "another joint was chosen with --joint".to_owned();
            self.omitted.push(Omitted { what: format!("joint {} with its effects", joint.name), why });
        }
        chosen.into_iter().map(|joint| self.joint(joint, options.by_line)).collect()
    }

    fn joint(&mut self, joint: &jointscope_fixture::Joint, by_line: bool) -> Result<Joint, ExportError> {
        let element = RepairedJoint::new(self.nodes.fixture, joint)
            .map_err(|error| ExportError::Diagnosis(error.to_string()))?;
        let centre = self.band.map_or(1.0, |(from, to)| (from * to).sqrt());
        let matrices = element.matrices(centre).map_err(|error| ExportError::Diagnosis(error.to_string()))?;
        let on_it =
            self.nodes.fixture.physics().iter().filter(|effect| is_on(self.nodes.fixture, joint, effect));
        let on_it: Vec<String> = on_it.map(|effect| says(self.findings, effect)).collect();
        let effects = match on_it.is_empty() {
            true => "no effects".to_owned(),
            false => on_it.join("; "),
        };
        if let Some(hz) = matrices.read_at {
            let note = depends_on_frequency(&joint.name, &element, hz, self.band);
            self.notes.push(note);
        }
        let lines = match (by_line, self.band) {
            (false, _) => Vec::new(),
            (true, None) => {
                return Err(ExportError::NoLines(
                    "diagnosis.json does not state the recording's band".into(),
                ));
            }
            (true, Some((from, to))) => {
                let step = (to - from) / (LINES - 1) as f64;
                element.lines((0..LINES).map(|i| from + step * i as f64))
            }
        };
        let rotates = |point: usize| {
            self.nodes.fixture.bodies()[self.nodes.fixture.points()[point].body].kind.rotates()
        };
        let scalar = !(rotates(joint.from) && rotates(joint.to));
        let cut = |[[a, b], [c, d]]: jointscope_comparison::Matrix| match scalar {
            true => [[a, 0.0], [0.0, 0.0]],
            false => [[a, b], [c, d]],
        };
        Ok(Joint {
            name: joint.name.clone(),
            says: format!("of the repaired fixture, with {effects}"),
            from: self.nodes.end(joint.from),
            to: self.nodes.end(joint.to),
            length: matrices.length,
            scalar,
            stiffness: cut(matrices.stiffness),
            damping: cut(matrices.damping),
            structural: cut(matrices.structural),
            structural_at: None,
            mass: matrices.mass,
            std: None,
            covariance: None,
            lines,
        })
    }

    fn supports(&mut self) {
        for support in self.nodes.fixture.supports() {
            let (body, x) = self.nodes.fixture.support_place(support);
            let node = self.nodes.node_at(body, x);
            let says = format!("support {} of the repaired fixture", support.name);
            let value = |q: &Option<jointscope_fixture::Quantity>| q.map_or(0.0, |q| q.value);
            let mut add = |dof: Dof, stiffness: f64, damping: f64| {
                if stiffness != 0.0 || damping != 0.0 {
                    let element = Element::Ground { node, dof, stiffness, damping };
                    self.parts.push(Part { says: says.clone(), element });
                }
            };
            add(Dof::Translation, support.stiffness.value, value(&support.damping));
            add(Dof::Rotation, value(&support.rotational_stiffness), value(&support.rotational_damping));
        }
    }

    /// An effect as a part, or why it is none; those of joints are in their matrices.
    fn effect(&mut self, effect: &Effect) {
        if self.nodes.fixture.joints().iter().any(|joint| is_on(self.nodes.fixture, joint, effect)) {
            return;
        }
        let says = says(self.findings, effect);
        let value = |index: usize| effect.value(index);
        match (effect.kind, &effect.place) {
            (Kind::AddedMass, Place::Body(name)) => {
                let Some(body) = self.nodes.body(name) else { return };
                let node = match value(2) {
                    0.0 => self.nodes.node_at(body, value(0)),
                    height => self.nodes.node_above(body, (value(0), height)),
                };
                self.parts.push(Part { says, element: Element::Mass { node, mass: value(1) } });
            }
            (Kind::Support, Place::Body(name)) => {
                let Some(body) = self.nodes.body(name) else { return };
                let dof = effect.dof.unwrap_or(Dof::Translation);
                let node = match dof {
                    Dof::Translation => self.nodes.node_at(body, value(0)),
                    Dof::Rotation => self.nodes.any_node_of(body),
                };
                let element = Element::Ground { node, dof, stiffness: value(1), damping: value(2) };
                self.parts.push(Part { says, element });
            }
            (Kind::AttachedResonator, Place::Body(name)) => {
                let Some(body) = self.nodes.body(name) else { return };
                let from = self.nodes.node_at(body, value(0));
                let (mass, omega, ratio) = (value(1), TAU * value(2), value(3));
                let on = format!("mass of the resonator on node {from}, moves along y only");
                let to = self.nodes.along_y(body, value(0), on);
                let stiffness = mass * omega * omega;
                let damping = 2.0 * ratio * mass * omega;
                self.parts.push(Part {
                    says: format!("{says}: its mass"),
                    element: Element::Mass { node: to, mass },
                });
                let element = Element::Spring { from, to, stiffness, damping };
                self.parts.push(Part { says: format!("{says}: its spring and dashpot"), element });
            }
            (Kind::Bypass, Place::Between(one, other)) => {
                let (Some(one), Some(other)) = (self.nodes.body(one), self.nodes.body(other)) else { return };
                let (from, to) = (self.nodes.node_at(one, value(0)), self.nodes.node_at(other, value(1)));
                let element = Element::Spring { from, to, stiffness: value(2), damping: value(3) };
                self.parts.push(Part { says, element });
            }
            _ => self.omitted.push(Omitted { what: says, why: why_not(effect).to_owned() }),
        }
    }
}

/// That a joint's matrices are those of one frequency, and how far k11 goes over the band.
fn depends_on_frequency(name: &str, element: &RepairedJoint, hz: f64, band: Option<(f64, f64)>) -> String {
    let mut note = format!(
        "joint {name} depends on frequency: K and C are those at {} Hz, the middle of the recording's band",
        short(hz)
    );
    if let Some((from, to)) = band {
        let ends = element.lines([from, to].into_iter());
        let k11 = [0, 1].map(|i| short(ends[i].stiffness[0][0]));
        let (from, to) = (short(from), short(to));
        note += &format!("; k11 goes from {} N/m at {from} Hz to {} N/m at {to} Hz", k11[0], k11[1]);
    }
    note
}
