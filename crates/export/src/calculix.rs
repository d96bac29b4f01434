//! Keywords for CalculiX: springs and dashpots to ground on motions that equations make of those of the
//! joint's ends.
//!
//! CalculiX has neither rotational springs nor matrices of a user. Its nodes have three translations, and a
//! rigid body has its rotations as the translations of a ROT NODE. K = k11·v·vᵀ + k·w·wᵀ with v = (1, a) and
//! w = (0, 1), a the place of the elastic centre: each term is a spring on one motion, which is the x of an
//! added node.

use crate::body::Body;
use crate::joint::{ElasticCentre, is_zero};
use crate::numbers::twenty;
use crate::parts::Element;
use crate::{Export, ExportError, Joint};
use jointscope_comparison::Matrix;
use jointscope_fixture::Dof;
use std::collections::BTreeMap;

/// Terms of an equation on a line.
const TERMS: usize = 4;

/// A motion: coefficients of nodes and their directions.
type Terms = Vec<(u64, u8, f64)>;

pub(crate) fn body(export: &Export) -> Result<Body, ExportError> {
    let mut writer = Writer {
        id: export.first_id,
        rotations: BTreeMap::new(),
        nodes: String::new(),
        rest: String::new(),
        notes: Vec::new(),
    };
    for node in export.nodes.iter().filter(|node| !node.existing) {
        let y = if node.only_y { "1.".to_owned() } else { twenty(node.y) };
        writer.nodes += &format!("{}, {}, {y}, 0.\n", node.number, twenty(node.x));
    }
    for joint in &export.joints {
        writer.joint(joint)?;
    }
    for part in &export.parts {
        writer.part(&part.element, export);
    }
    for node in export.nodes.iter().filter(|node| node.only_y) {
        writer.rest += &format!("*BOUNDARY\n{0}, 1, 1\n{0}, 3, 3\n", node.number);
    }
    for (node, rotation) in &writer.rotations {
        writer.notes.push(format!(
            "node {rotation} holds the rotation at node {node} in its third translation: make it the ROT NODE of the *RIGID BODY that node {node} belongs to"
        ));
    }
    if export.nodes.iter().any(|node| node.only_y) {
        writer.notes.push(
            "a resonator's mass stands 1 m along y from its foot, which gives its spring its direction"
                .to_owned(),
        );
    }
    if writer.rest.contains("*EQUATION") {
        writer.notes.push(
            "include this file after every *RIGID BODY, since CalculiX 2.20 takes equations that come before them wrongly; define the nodes of this file that they need before them too (twice does no harm), and keep node sets of rigid bodies ascending".to_owned(),
        );
    }
    let nodes = if writer.nodes.is_empty() { String::new() } else { format!("*NODE\n{}", writer.nodes) };
    Ok(Body { text: nodes + &writer.rest, notes: writer.notes })
}

struct Writer {
    id: u64,
    /// Nodes with the rotations of others.
    rotations: BTreeMap<u64, u64>,
    nodes: String,
    rest: String,
    notes: Vec<String>,
}

impl Writer {
    fn next(&mut self) -> u64 {
        self.id += 1;
        self.id - 1
    }

    fn joint(&mut self, joint: &Joint) -> Result<(), ExportError> {
        let joint = &joint.without_structural(&mut self.notes);
        for (element, matrix) in [("SPRING", &joint.stiffness), ("DASHPOT", &joint.damping)] {
            for (direction, value) in terms(joint, element, matrix)? {
                let motion = self.relative(joint, direction);
                self.grounded(element, motion, value);
            }
        }
        for (what, there) in
            [("structural damping", !is_zero(&joint.structural)), ("mass", joint.mass.is_some())]
        {
            if there {
                self.notes.push(format!(
                    "joint {}: its {what} is not written, for CalculiX has no element for it; csv and json hold the matrix",
                    joint.name
                ));
            }
        }
        Ok(())
    }

    /// The motion `direction`·d of d = u_to − R·u_from.
    fn relative(&mut self, joint: &Joint, direction: [f64; 2]) -> Terms {
        let [y, theta] = direction;
        let mut terms = Vec::new();
        if y != 0.0 {
            terms.extend([(joint.to.node, 2, y), (joint.from.node, 2, -y)]);
        }
        let (near, far) = (-y * joint.length - theta, theta);
        for (end, coefficient) in [(joint.to.node, far), (joint.from.node, near)] {
            if !joint.scalar && coefficient != 0.0 {
                terms.push((self.rotation(end), 3, coefficient));
            }
        }
        terms
    }

    /// The node that has the rotation of another.
    fn rotation(&mut self, node: u64) -> u64 {
        if let Some(rotation) = self.rotations.get(&node) {
            return *rotation;
        }
        let rotation = self.next();
        self.rotations.insert(node, rotation);
        self.nodes += &format!("{rotation}, 0., 0., 0.\n");
        rotation
    }

    fn part(&mut self, element: &Element, export: &Export) {
        match *element {
            Element::Mass { node, mass } => {
                let number = self.next();
                self.rest += &format!(
                    "*ELEMENT, TYPE=MASS, ELSET=JS_{number}\n{number}, {node}\n*MASS, ELSET=JS_{number}\n{}\n",
                    twenty(mass)
                );
            }
            Element::Ground { node, dof, stiffness, damping } => {
                let motion = match dof {
                    Dof::Translation => (node, 2, 1.0),
                    Dof::Rotation => (self.rotation(node), 3, 1.0),
                };
                self.grounded("SPRING", vec![motion], stiffness);
                self.grounded("DASHPOT", vec![motion], damping);
            }
            Element::Spring { from, to, stiffness, damping } => {
                let added = |node: u64| export.nodes.iter().any(|n| n.number == node && n.only_y);
                for (name, value) in [("SPRING", stiffness), ("DASHPOT", damping)] {
                    match added(from) || added(to) {
                        // Its mass lies along y, so the element does.
                        true => self.between(name, from, to, value),
                        false => self.grounded(name, vec![(to, 2, 1.0), (from, 2, -1.0)], value),
                    }
                }
            }
        }
    }

    /// A spring or dashpot on a motion: an added node makes the motion along x, the element leads on to a
    /// fixed one.
    fn grounded(&mut self, element: &str, motion: Terms, value: f64) {
        if value == 0.0 {
            return;
        }
        let (moving, fixed) = (self.next(), self.next());
        self.nodes += &format!("{moving}, 0., 0., 0.\n{fixed}, 1., 0., 0.\n");
        let mut terms = vec![(moving, 1, 1.0)];
        terms.extend(motion.iter().map(|(node, dof, coefficient)| (*node, *dof, -coefficient)));
        self.rest += &format!("*EQUATION\n{}\n", terms.len());
        for line in terms.chunks(TERMS) {
            let line: Vec<String> =
                line.iter().map(|(node, dof, value)| format!("{node}, {dof}, {}", twenty(*value))).collect();
            self.rest += &format!("{}\n", line.join(", "));
        }
        self.rest += &format!("*BOUNDARY\n{moving}, 2, 3\n{fixed}, 1, 3\n");
        self.between(element, moving, fixed, value);
    }

    /// A spring or dashpot along the line between two nodes.
    fn between(&mut self, element: &str, one: u64, other: u64, value: f64) {
        if value == 0.0 {
            return;
        }
        let number = self.next();
        self.rest += &format!(
            "*ELEMENT, TYPE={element}A, ELSET=JS_{number}\n{number}, {one}, {other}\n*{element}, ELSET=JS_{number}\n{}\n",
            twenty(value)
        );
    }
}

/// A symmetric matrix as a sum of value·v·vᵀ: directions with their values.
fn terms(joint: &Joint, element: &str, matrix: &Matrix) -> Result<Vec<([f64; 2], f64)>, ExportError> {
    let [[k11, k12], [_, k22]] = *matrix;
    match ElasticCentre::of(matrix) {
        Some(centre) => {
            let all = [([1.0, centre.offset], centre.translation), ([0.0, 1.0], centre.rotation)];
            Ok(all.into_iter().take(if joint.scalar { 1 } else { 2 }).collect())
        }
        None if k11 == 0.0 && k12 == 0.0 => Ok(vec![([0.0, 1.0], k22)]),
        None => Err(ExportError::NoCentre {
            joint: joint.name.clone(),
            matrix: if element == "SPRING" { "K" } else { "C" },
            form: "no springs or dashpots hold it",
            remedy: "csv and json hold the matrix",
        }),
    }
}
