//! The routes of lumped cases.

/// What a route of lumped cases hides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LumpedRoute {
    /// A flaw of the measuring chain.
    ChannelFlaws,
    /// A load path beside a joint or to ground, or the footing of a joint.
    LoadPaths,
    /// Physics that no effect of a fixture file is.
    UnknownPhysics,
}

impl LumpedRoute {
    /// Every route, in the order in which cases are numbered.
    pub(crate) const ALL: [LumpedRoute; 3] =
        [LumpedRoute::ChannelFlaws, LumpedRoute::LoadPaths, LumpedRoute::UnknownPhysics];

    /// Its name in files.
    pub(crate) fn key(self) -> &'static str {
        match self {
            LumpedRoute::ChannelFlaws => "channel_flaws",
            LumpedRoute::LoadPaths => "load_paths",
            LumpedRoute::UnknownPhysics => "unknown_physics",
        }
    }
}
