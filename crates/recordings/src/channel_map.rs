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
        let sign = match self.direction {
            0 => "",
            ..0 => "-",
            _ => "+",
        };
        match AXES.get(self.axis() as usize) {
            Some(axis) => write!(f, "{}:{sign}{axis}", self.node),
            None => write!(f, "{}:direction {}", self.node, self.direction),
        }
    }
}

/// Which channel of the files is which of the fixture, where node numbers and directions do not say so themselves.
///
/// Without an entry, a node number is a point's name, direction ±2 is ±y and ±6 is ±θ. A node that has an entry is known by its
/// entries alone: of a triaxial sensor at node 101, `101:+z=1:+y` takes z and leaves x and y.
///
/// ```
/// use jointscope_recordings::ChannelMap;
/// let map = ChannelMap::parse(["101:+z=1:+y", "102:-z=4:+y", "7:+rx=4:+theta"])?;
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
    /// The file's channel, along its positive direction.
    pub file: FileChannel,
    /// The fixture's channel.
    pub channel: Channel,
    /// +1 where both point the same way, else −1.
    pub sign: f64,
    /// The entry as it was written.
    pub text: String,
}

/// Why a channel map makes no sense.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ChannelMapError {
    /// No `node:direction=point:direction`.
    #[error("the map entry `{entry}` is not `node:direction=point:direction`, such as `101:+z=1:+y`")]
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
    /// Reads entries `node:direction=point:direction`: the file's directions are `x`, `y`, `z`, `rx`, `ry`, `rz` or `0` (none
    /// stated), the fixture's `y` and `theta`, each with a sign or without (`+`).
    ///
    /// # Errors
    /// An entry of another form, a translation for a rotation, two entries for one channel.
    pub fn parse<S: AsRef<str>>(entries: impl IntoIterator<Item = S>) -> Result<Self, ChannelMapError> {
        let mut map = ChannelMap::default();
        for entry in entries {
            let entry = MapEntry::parse(entry.as_ref())?;
            if let Some(first) = map.entries.iter().find(|other| other.file == entry.file) {
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
    pub fn names_node(&self, node: i64) -> bool {
        self.entries.iter().any(|entry| entry.file.node == node)
    }

    /// The fixture's channel that a channel of the file is by an entry, and the sign between them.
    pub fn find(&self, file: FileChannel) -> Option<(&Channel, f64)> {
        let same = |entry: &&MapEntry| entry.file.node == file.node && entry.file.axis() == file.axis();
        self.entries.iter().find(same).map(|entry| (&entry.channel, entry.sign * file.sign()))
    }
}

impl MapEntry {
    fn parse(text: &str) -> Result<Self, ChannelMapError> {
        let entry = || text.to_owned();
        let form = || ChannelMapError::Form { entry: entry() };
        let (file, fixture) = text.split_once('=').ok_or_else(form)?;
        let (node, file_direction) = file.rsplit_once(':').ok_or_else(form)?;
        let (point, direction) = fixture.rsplit_once(':').ok_or_else(form)?;
        let node = node
            .trim()
            .parse()
            .map_err(|_| ChannelMapError::Node { entry: entry(), found: node.to_owned() })?;
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
        let file = FileChannel { node, direction: axis as i32 };
        if axis != 0 && file.is_rotational() != (dof == Dof::Rotation) {
            return Err(ChannelMapError::Kind { entry: entry() });
        }
        if point.trim().is_empty() {
            return Err(form());
        }
        let channel = Channel { point: point.trim().to_owned(), dof };
        Ok(MapEntry { file, channel, sign: file_sign * sign, text: entry() })
    }
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
        assert_eq!(find(3), Some((&Channel::transverse("1"), -1.0)));
        assert_eq!(find(-3), Some((&Channel::transverse("1"), 1.0)));
        assert_eq!(find(2), None);
        assert!(map.names_node(101) && !map.names_node(1));
    }

    #[test]
    fn a_point_may_have_any_name_but_an_empty_one() {
        let map = ChannelMap::parse(["3:y=left:tip:theta", "3:rz=left:tip:-theta"]);
        assert!(matches!(map, Err(ChannelMapError::Kind { .. })));
        let map = ChannelMap::parse(["3:rz=left:tip:-theta"]).unwrap();
        assert_eq!(map.entries()[0].channel, Channel::rotational("left:tip"));
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
