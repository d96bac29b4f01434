//! Node numbers: points keep theirs where their names are numbers.

use crate::{ExportError, Node};

/// The largest number of a node: programs read eight digits, and what is added beyond the nodes needs numbers
/// too.
const LARGEST: u64 = 99_000_000;

/// Numbers given so far.
#[derive(Debug)]
pub(crate) struct Numbering {
    nodes: Vec<Node>,
    next: u64,
}

impl Numbering {
    /// None yet; what has no number of its own is numbered from `first`.
    ///
    /// # Errors
    /// A first number that programs do not read.
    pub(crate) fn from(first: u64) -> Result<Self, ExportError> {
        Ok(Numbering { nodes: Vec::new(), next: readable(first)? })
    }

    /// A node that the model has already.
    pub(crate) fn existing(&mut self, number: u64, x: f64, says: String) -> Result<u64, ExportError> {
        let number = readable(number)?;
        if self.nodes.iter().any(|node| node.number == number) {
            return Err(ExportError::NodeTwice(number));
        }
        self.nodes.push(Node { number, x, y: 0.0, says, existing: true, only_y: false });
        Ok(number)
    }

    /// The node of a point, defined in the file: its name, where that is a number that is free.
    pub(crate) fn point(&mut self, name: &str, x: f64, says: &str) -> u64 {
        let own = name.parse().ok().and_then(|number: u64| readable(number).ok());
        let number = match own.filter(|number| self.is_free(*number)) {
            Some(number) => number,
            None => self.free(),
        };
        self.define(number, (x, 0.0), tied(says), false)
    }

    /// A node on a body that is defined in the file, at a place (x, y), numbered from the first
    /// free one.
    pub(crate) fn on_body(&mut self, place: (f64, f64), says: &str) -> u64 {
        let number = self.free();
        self.define(number, place, tied(says), false)
    }

    /// A node on no body, which moves along y only.
    pub(crate) fn along_y(&mut self, x: f64, says: String) -> u64 {
        let number = self.free();
        self.define(number, (x, 0.0), says, true)
    }

    fn define(&mut self, number: u64, (x, y): (f64, f64), says: String, only_y: bool) -> u64 {
        self.nodes.push(Node { number, x, y, says, existing: false, only_y });
        number
    }

    fn is_free(&self, number: u64) -> bool {
        self.nodes.iter().all(|node| node.number != number)
    }

    fn free(&mut self) -> u64 {
        while !self.is_free(self.next) {
            self.next += 1;
        }
        self.next += 1;
        self.next - 1
    }

    /// The nodes, ascending, and the first number for everything else: from it on none is taken.
    pub(crate) fn finish(mut self) -> (Vec<Node>, u64) {
        self.nodes.sort_by_key(|node| node.number);
        let above = self.nodes.last().map_or(1, |node| node.number + 1);
        (self.nodes, self.next.max(above))
    }
}

/// A number that programs read.
fn readable(number: u64) -> Result<u64, ExportError> {
    if (1..=LARGEST).contains(&number) { Ok(number) } else { Err(ExportError::NodeNumber(number)) }
}

/// What a node defined in the file needs, for nothing there holds it to its body.
fn tied(says: &str) -> String {
    format!("{says}: tie it to the body there")
}
