//! Which channel of a file stands for which point of a fixture: by names, by nodes, by what the user says.

use std::fmt;

use jointscope_spectra::{Channel, Dof};

/// A channel as a universal file names it: a node and a direction, shown as `101:+z`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileChannel {
    /// Node number.
    pub node: i64,
    /// Direction: 0 scalar, ±1 to ±3 translation along x, y, z, ±4 to ±6 rotation about them.
    pub direction: i32,
}

impl FileChannel {
    /// The direction without its sign.
    pub(crate) fn axis(self) -> u32 {
        self.direction.unsigned_abs()
    }

    /// +1, or −1 for a channel against its axis.
    pub(crate) fn sign(self) -> f64 {
        if self.direction < 0 { -1.0 } else { 1.0 }
    }

    pub(crate) fn is_rotational(self) -> bool {
        matches!(self.axis(), 4..=6)
    }

    /// Its direction as map entries write it, such as `+z`.
    pub fn direction_name(self) -> String {
        let sign = match self.direction {
            0 => "",
            ..0 => "-",
            _ => "+",
        };
        match AXES.get(self.axis() as usize) {
            Some(axis) => format!("{sign}{axis}"),
            None => format!("direction {}", self.direction),
        }
    }
}

impl From<&jointscope_uff::Node> for FileChannel {
    fn from(node: &jointscope_uff::Node) -> Self {
        FileChannel { node: node.number, direction: node.direction }
    }
}

/// Directions by number: scalar, translations, rotations.
pub(crate) const AXES: [&str; 7] = ["0", "x", "y", "z", "rx", "ry", "rz"];

impl fmt::Display for FileChannel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.node, self.direction_name())
    }
}

/// Which channel of the files is which of the fixture, where node numbers and directions do not say so
/// themselves.
///
/// Without an entry, a node number is a point's name, direction ±2 is ±y and ±6 is ±θ. An entry speaks of one
/// node, `101:+z=1:+y`; of every node, `+z=+y`; or of the nodes whose number fits a pattern, `10*:+z=*:+y`
/// (node 101 is point 1). An entry of one node beats a pattern, and a pattern beats an entry of all. A node
/// that has an entry is known by its entries alone: of a triaxial sensor at node 101, `101:+z=1:+y` takes z
/// and leaves x and y.
///
/// ```
/// use jointscope_recordings::ChannelMap;
/// let map = ChannelMap::parse(["+z=+y", "102:-z=4:+y", "7:+rx=4:+theta"])?;
/// assert_eq!(map.entries().len(), 3);
/// let error = ChannelMap::parse(["101:z=1:+x"]).unwrap_err();
/// assert!(error.to_string().contains("`101:z=1:+x`"));
/// # Ok::<(), jointscope_recordings::ChannelMapError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChannelMap {
    entries: Vec<MapEntry>,
}

/// One line of a [`ChannelMap`].
#[derive(Debug, Clone, PartialEq)]
pub struct MapEntry {
    nodes: Nodes,
    /// The file's direction without its sign.
    axis: u32,
    /// The fixture's point; `*` in it stands for what it stands for in the node's number.
    point: String,
    dof: Dof,
    /// +1 where both point the same way, else −1.
    sign: f64,
    /// The entry as it was written.
    pub text: String,
}

/// The nodes that an entry speaks of.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Nodes {
    /// Those whose number has these digits before and after the `*`, and at least one for it: every one where
    /// it has none.
    Like { before: String, after: String },
    /// The one of this number.
    One(i64),
}

/// Why a channel map makes no sense.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ChannelMapError {
    /// Neither `node:direction=point:direction` nor `direction=direction`.
    #[error(
        "the map entry `{entry}` is not `node:direction=point:direction`, such as `101:+z=1:+y`, or `direction=direction`, such as `+z=+y` for all nodes"
    )]
    Form {
        /// The entry.
        entry: String,
    },
    /// The file's node is no whole number.
    #[error(
        "in the map entry `{entry}`, `{found}` is no node number: the file's side comes first, as in `101:+z=1:+y`"
    )]
    Node {
        /// The entry.
        entry: String,
        /// What stands there.
        found: String,
    },
    /// A `*` on one side alone, or more than one on a side.
    #[error(
        "in the map entry `{entry}`, `*` must stand once on both sides: it is the same digits in node and point, as in `10*:+z=*:+y`"
    )]
    Star {
        /// The entry.
        entry: String,
    },
    /// A direction that does not exist.
    #[error("in the map entry `{entry}`, `{found}` is none of the directions {possible}")]
    Direction {
        /// The entry.
        entry: String,
        /// What stands there.
        found: String,
        /// What may stand there.
        possible: &'static str,
    },
    /// A translation mapped to a rotation, or the other way round.
    #[error(
        "the map entry `{entry}` takes a translation for a rotation: x, y, z become y, and rx, ry, rz become theta"
    )]
    Kind {
        /// The entry.
        entry: String,
    },
    /// Two entries for one channel of the file.
    #[error("the map entries `{first}` and `{second}` name the same channel of the file: leave one out")]
    Twice {
        /// The first entry.
        first: String,
        /// The second entry.
        second: String,
    },
}

impl ChannelMap {
    /// Reads entries `node:direction=point:direction`, or `direction=direction` for all nodes: the file's
    /// directions are `x`, `y`, `z`, `rx`, `ry`, `rz` or `0` (none stated), the fixture's `y` and `theta`,
    /// each with a sign or without (`+`).
    ///
    /// # Errors
    /// An entry of another form, a translation for a rotation, two entries for one channel.
    pub fn parse<S: AsRef<str>>(entries: impl IntoIterator<Item = S>) -> Result<Self, ChannelMapError> {
        let mut map = ChannelMap::default();
        for entry in entries {
            let entry = MapEntry::parse(entry.as_ref())?;
            let same = |other: &&MapEntry| other.nodes == entry.nodes && other.axis == entry.axis;
            if let Some(first) = map.entries.iter().find(same) {
                return Err(ChannelMapError::Twice { first: first.text.clone(), second: entry.text });
            }
            map.entries.push(entry);
        }
        Ok(map)
    }

    pub(crate) fn of_entries(entries: Vec<MapEntry>) -> Self {
        ChannelMap { entries }
    }

    /// The entries, as given.
    pub fn entries(&self) -> &[MapEntry] {
        &self.entries
    }

    /// Whether any entry speaks of this node.
    pub(crate) fn names_node(&self, node: i64) -> bool {
        self.entries.iter().any(|entry| entry.point(node).is_some())
    }

    /// The fixture's channel that a channel of the file is by an entry, and the sign between them.
    pub(crate) fn find(&self, file: FileChannel) -> Option<(Channel, f64)> {
        let entry = self.entries_of(file).next()?;
        let channel = Channel { point: entry.point(file.node)?, dof: entry.dof };
        Some((channel, entry.sign * file.sign()))
    }

    /// The entries that decide on a channel of the file: of those that speak of its node, the ones that speak
    /// of the fewest nodes. More than one contradict each other.
    pub(crate) fn entries_of(&self, file: FileChannel) -> impl Iterator<Item = &MapEntry> {
        let of_node = move || self.entries.iter().filter(move |entry| entry.point(file.node).is_some());
        let rank = of_node().map(|entry| entry.nodes.rank()).max();
        of_node().filter(move |entry| Some(entry.nodes.rank()) == rank && entry.axis == file.axis())
    }
}

impl Nodes {
    /// Higher for fewer nodes.
    fn rank(&self) -> u8 {
        match self {
            Nodes::Like { before, after } if before.is_empty() && after.is_empty() => 0,
            Nodes::Like { .. } => 1,
            Nodes::One(_) => 2,
        }
    }
}

impl MapEntry {
    /// An entry for one channel of the files.
    pub(crate) fn of_one(file: FileChannel, channel: Channel) -> Self {
        MapEntry {
            nodes: Nodes::One(file.node),
            axis: file.axis(),
            text: format!("{file}={channel}"),
            point: channel.point,
            dof: channel.dof,
            sign: file.sign(),
        }
    }

    /// The name of the point that a node is, if the entry speaks of it.
    pub(crate) fn point(&self, node: i64) -> Option<String> {
        match &self.nodes {
            Nodes::One(own) => (*own == node).then(|| self.point.clone()),
            Nodes::Like { before, after } => {
                let number = node.to_string();
                let digits = number.strip_prefix(before.as_str())?.strip_suffix(after.as_str())?;
                (!digits.is_empty()).then(|| self.point.replacen('*', digits, 1))
            }
        }
    }

    /// The point that the entry names, where it speaks of one node.
    pub(crate) fn named_point(&self) -> Option<&str> {
        matches!(self.nodes, Nodes::One(_)).then_some(self.point.as_str())
    }

    /// Whether it applies to a channel of the files, be there an entry of fewer nodes or not.
    pub(crate) fn applies_to(&self, file: FileChannel) -> bool {
        self.axis == file.axis() && self.point(file.node).is_some()
    }

    fn parse(text: &str) -> Result<Self, ChannelMapError> {
        let entry = || text.to_owned();
        let form = || ChannelMapError::Form { entry: entry() };
        let (file, fixture) = text.split_once('=').ok_or_else(form)?;
        let (node, file_direction, point, direction) = match (file.rsplit_once(':'), fixture.rsplit_once(':'))
        {
            (Some((node, file_direction)), Some((point, direction))) => {
                (node.trim(), file_direction, point.trim(), direction)
            }
            (None, None) if AXES.contains(&signed(file).1.as_str()) => ("*", file, "*", fixture),
            _ => return Err(form()),
        };
        let nodes = nodes(node, point).map_err(|problem| match problem {
            None => ChannelMapError::Star { entry: entry() },
            Some(found) => ChannelMapError::Node { entry: entry(), found },
        })?;
        let (file_sign, file_axis) = signed(file_direction);
        let axis =
            AXES.iter().position(|axis| *axis == file_axis).ok_or_else(|| ChannelMapError::Direction {
                entry: entry(),
                found: file_direction.to_owned(),
                possible: "x, y, z, rx, ry, rz, 0 of a file",
            })?;
        let (sign, axis_name) = signed(direction);
        let dof = match axis_name.as_str() {
            "y" => Dof::Translation,
            "theta" => Dof::Rotation,
            _ => {
                return Err(ChannelMapError::Direction {
                    entry: entry(),
                    found: direction.to_owned(),
                    possible: "y, theta of a fixture",
                });
            }
        };
        if axis != 0 && (axis > 3) != (dof == Dof::Rotation) {
            return Err(ChannelMapError::Kind { entry: entry() });
        }
        if point.is_empty() {
            return Err(form());
        }
        Ok(MapEntry {
            nodes,
            axis: axis as u32,
            point: point.to_owned(),
            dof,
            sign: file_sign * sign,
            text: entry(),
        })
    }
}

/// The nodes of an entry; what stands there where it is no number, or nothing where a `*` is amiss.
fn nodes(node: &str, point: &str) -> Result<Nodes, Option<String>> {
    let unknown = || Some(node.to_owned());
    let Some((before, after)) = node.split_once('*') else {
        let one = node.parse().map(Nodes::One).map_err(|_| unknown())?;
        return if point.contains('*') { Err(None) } else { Ok(one) };
    };
    if after.contains('*') || point.matches('*').count() != 1 {
        return Err(None);
    }
    if node.chars().any(|c| c != '*' && !c.is_ascii_digit()) {
        return Err(unknown());
    }
    Ok(Nodes::Like { before: before.to_owned(), after: after.to_owned() })
}

/// Sign and name of a direction.
fn signed(direction: &str) -> (f64, String) {
    let direction = direction.trim();
    let (sign, axis) = match direction.strip_prefix('-') {
        Some(axis) => (-1.0, axis),
        None => (1.0, direction.strip_prefix('+').unwrap_or(direction)),
    };
    (sign, axis.to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_of_both_sides_and_of_the_channel_multiply() {
        let map = ChannelMap::parse(["101:-z=1:+y"]).unwrap();
        let find = |direction| map.find(FileChannel { node: 101, direction });
        assert_eq!(find(3), Some((Channel::transverse("1"), -1.0)));
        assert_eq!(find(-3), Some((Channel::transverse("1"), 1.0)));
        assert_eq!(find(2), None);
        assert!(map.names_node(101) && !map.names_node(1));
    }

    #[test]
    fn one_entry_speaks_of_all_nodes_and_whatever_speaks_of_fewer_beats_it() {
        let map = ChannelMap::parse(["+z=-y", "10*:+x=*:+y", "104:+y=tip:+y", "ry=theta"]).unwrap();
        let find = |node, direction| map.find(FileChannel { node, direction });
        assert_eq!(find(7, 3), Some((Channel::transverse("7"), -1.0)));
        assert_eq!(find(7, -3), Some((Channel::transverse("7"), 1.0)));
        assert_eq!(find(7, 5), Some((Channel::rotational("7"), 1.0)));
        assert_eq!(find(103, 1), Some((Channel::transverse("3"), 1.0)));
        assert_eq!(find(104, 2), Some((Channel::transverse("tip"), 1.0)));
        // Each node is known by the entries of the fewest nodes alone.
        assert_eq!((find(7, 2), find(103, 3), find(104, 1), find(104, 3)), (None, None, None, None));
        // The star stands for one digit or more.
        assert_eq!(find(10, 3), Some((Channel::transverse("10"), -1.0)));
        let all = ChannelMap::parse(["*:z=*:-y"]).unwrap();
        assert_eq!(all.find(FileChannel { node: 7, direction: 3 }), find(7, 3));
    }

    #[test]
    fn a_point_may_have_any_name_but_an_empty_one() {
        let map = ChannelMap::parse(["3:y=left:tip:theta", "3:rz=left:tip:-theta"]);
        assert!(matches!(map, Err(ChannelMapError::Kind { .. })));
        let map = ChannelMap::parse(["3:rz=left:tip:-theta"]).unwrap();
        let turned = FileChannel { node: 3, direction: 6 };
        assert_eq!(map.find(turned), Some((Channel::rotational("left:tip"), -1.0)));
        assert!(matches!(ChannelMap::parse(["3:y=:y"]), Err(ChannelMapError::Form { .. })));
    }

    #[test]
    fn every_bad_entry_is_named_with_its_remedy() {
        let check = |entry: &str, part: &str| {
            let message = ChannelMap::parse([entry]).unwrap_err().to_string();
            assert!(message.contains(&format!("`{entry}`")) && message.contains(part), "{message}");
        };
        check("101", "such as `101:+z=1:+y`");
        check("101:+z", "such as `101:+z=1:+y`");
        check("tip:+z=1:+y", "`tip` is no node number");
        check("101:+w=1:+y", "x, y, z, rx, ry, rz");
        check("101:+z=1:+z", "y, theta of a fixture");
        check("101:+z=1:+theta", "translation for a rotation");
        check("+z=1:+y", "such as `+z=+y` for all nodes");
        check("1=2", "such as `101:+z=1:+y`");
        check("+z=+z", "y, theta of a fixture");
        check("+z=+theta", "translation for a rotation");
        check("*:+z=1:+y", "once on both sides");
        check("10*:+z=1:+y", "once on both sides");
        check("101:+z=*:+y", "once on both sides");
        check("1*0*:+z=*:+y", "once on both sides");
        check("t*:+z=*:+y", "`t*` is no node number");
        let twice = ChannelMap::parse(["+z=+y", "*:-z=*:+y"]).unwrap_err();
        assert!(twice.to_string().contains("`+z=+y` and `*:-z=*:+y`"), "{twice}");
        let twice = ChannelMap::parse(["101:+z=1:+y", "101:-z=2:+y"]).unwrap_err();
        assert!(twice.to_string().contains("`101:+z=1:+y` and `101:-z=2:+y`"), "{twice}");
    }

    #[test]
    fn channels_of_the_file_are_shown_as_a_map_writes_them() {
        let shown = |direction| FileChannel { node: 4, direction }.to_string();
        assert_eq!(shown(-2), "4:-y");
        assert_eq!(shown(6), "4:+rz");
        assert_eq!(shown(0), "4:0");
        assert_eq!(shown(9), "4:direction 9");
    }
}
