//! Response and reference of an FRF, as names and options write them: `4/1`, `4:+z/1:-z`.

use std::fmt;

use jointscope_uff::Node;

/// Response over reference.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ChannelPair {
    /// The response's node and direction.
    pub(crate) response: Node,
    /// The reference's.
    pub(crate) reference: Node,
}

/// Why a text is no pair of channels.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is not response over reference, such as `4/1` or `4:+z/1:+z`")]
pub struct PairError(pub String);

impl ChannelPair {
    /// Reads `4/1` (along +y) or `4:+z/1:-z`; directions are x, y, z, and rx, ry, rz (or theta) about them.
    ///
    /// # Errors
    /// Anything else.
    pub(crate) fn parse(text: &str) -> Result<Self, PairError> {
        let parsed = text.split_once('/').and_then(|(response, reference)| {
            Some(ChannelPair { response: channel(response)?, reference: channel(reference)? })
        });
        parsed.ok_or_else(|| PairError(text.trim().to_owned()))
    }
}

impl fmt::Display for ChannelPair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let one = |node: &Node| format!("{}:{}", node.number, direction_name(node.direction));
        write!(f, "{}/{}", one(&self.response), one(&self.reference))
    }
}

fn direction_name(direction: i32) -> String {
    let axis = ["scalar", "x", "y", "z", "rx", "ry", "rz"].get(direction.unsigned_abs() as usize).copied();
    format!("{}{}", if direction < 0 { '-' } else { '+' }, axis.unwrap_or("?"))
}

/// One channel: a node number, and a direction behind a colon; +y where none is stated.
pub(crate) fn channel(text: &str) -> Option<Node> {
    let (number, along) = text.trim().split_once(':').unwrap_or((text.trim(), "+y"));
    let number: i64 = number.trim().parse().ok().filter(|number| *number >= 0)?;
    Some(Node::new(number, direction(along)?))
}

/// `+x` to `-rz`; a direction without sign is positive.
pub(crate) fn direction(text: &str) -> Option<i32> {
    let text = text.trim();
    let (sign, axis) = match text.strip_prefix('-') {
        Some(axis) => (-1, axis),
        None => (1, text.strip_prefix('+').unwrap_or(text)),
    };
    let number = match axis.to_lowercase().as_str() {
        "x" => 1,
        "y" => 2,
        "z" => 3,
        "rx" => 4,
        "ry" => 5,
        "rz" | "theta" => 6,
        _ => return None,
    };
    Some(sign * number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_is_response_over_reference_with_directions_if_stated() {
        let check =
            |text: &str, expected: &str| assert_eq!(ChannelPair::parse(text).unwrap().to_string(), expected);
        check("4/1", "4:+y/1:+y");
        check(" 4:+z / 1:-Z", "4:+z/1:-z");
        check("12:theta/3:rx", "12:+rz/3:+rx");
        for bad in ["4", "4/", "a/1", "4:q/1", "-4/1", "4//1", ""] {
            assert!(ChannelPair::parse(bad).is_err(), "{bad}");
        }
    }
}
