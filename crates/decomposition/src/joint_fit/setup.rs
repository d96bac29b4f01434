//! What all fits of one recording share.

use super::recorded::Recorded;
use jointscope_fixture::Fixture;

/// What all fits of one recording share.
#[derive(Clone, Copy)]
pub(super) struct Setup<'a> {
    pub recorded: &'a Recorded,
    pub fixture: &'a Fixture,
    /// Places of the joints that are looked for among the fixture's.
    pub joints: &'a [usize],
    /// By body, the piece that it is in without these joints; pieces are numbered from 0.
    pub pieces: &'a [usize],
}
