//! The interval that is wanted of one element of a joint.

use crate::says;
use jointscope_fixture::QuantityKey;
use std::str::FromStr;

/// An interval that is wanted of one element of a joint: `J/k11=1%` or `J/k11=2e4`, half of it, 95 %.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// The joint.
    pub joint: String,
    /// `k` or `c`, and the element's row and column, from 1.
    pub(super) element: (char, usize, usize),
    /// Half the width, relative or in the element's unit.
    pub half_width: HalfWidth,
}

/// Half the width of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HalfWidth {
    /// As a share of the value.
    Relative(f64),
    /// In the unit of the value.
    Absolute(f64),
}

impl FromStr for Wanted {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = || {
            "a joint's element and half of its 95 % interval are needed, such as J/k11=1% or J/k11=2e4"
                .to_owned()
        };
        let (path, width) = text.rsplit_once('=').ok_or_else(form)?;
        let (joint, element) = path.rsplit_once('/').ok_or_else(form)?;
        let element = match element.trim() {
            "k11" => ('k', 1, 1),
            "k12" | "k21" => ('k', 1, 2),
            "k22" => ('k', 2, 2),
            "c11" => ('c', 1, 1),
            "c12" | "c21" => ('c', 1, 2),
            "c22" => ('c', 2, 2),
            other => return Err(format!("`{other}` is none of k11, k12, k22, c11, c12 and c22")),
        };
        let positive = |text: &str| text.trim().parse().ok().filter(|v: &f64| v.is_finite() && *v > 0.0);
        let half_width = match width.trim().strip_suffix('%') {
            Some(percent) => HalfWidth::Relative(positive(percent).ok_or_else(form)? / 100.0),
            None => HalfWidth::Absolute(positive(width).ok_or_else(form)?),
        };
        let joint = joint.trim();
        let joint = joint.strip_prefix("joints/").unwrap_or(joint).to_owned();
        if joint.is_empty() { Err(form()) } else { Ok(Wanted { joint, element, half_width }) }
    }
}

impl Wanted {
    pub(super) fn key(&self) -> QuantityKey {
        let (which, row, column) = self.element;
        match which {
            'k' => QuantityKey::JointStiffness(row - 1, column - 1),
            _ => QuantityKey::JointDamping(row - 1, column - 1),
        }
    }

    pub(super) fn reached(&self, interval: f64, value: f64) -> bool {
        interval
            <= match self.half_width {
                HalfWidth::Relative(share) => share * value.abs(),
                HalfWidth::Absolute(width) => width,
            }
    }

    pub(super) fn says(&self) -> String {
        let (which, row, column) = self.element;
        let width = match self.half_width {
            HalfWidth::Relative(share) => format!("{} %", says::three(100.0 * share)),
            HalfWidth::Absolute(width) => format!("{} {}", says::three(width), self.key().unit()),
        };
        format!("{which}{row}{column} of joint {} to within ± {width} (95 %)", self.joint)
    }
}
