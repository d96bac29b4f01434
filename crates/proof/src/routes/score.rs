//! The scores of a route beside the laboratory's.

use super::by_name::{self, ONE_OR_NONE, Route, UNLISTED, WRONG_EVERYWHERE};
use super::{JudgedRoutes, LumpedJudged, LumpedRoute, solid, struck};
use crate::Sheet;
use crate::sheet::{Keyed, by_key, counted};
use crate::size::SizeScore;
use serde::Serialize;
use std::fmt::{self, Display, Formatter};
use std::ops::Deref;

/// The scores of one route.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RouteScore {
    /// Key in `proof.json`.
    #[serde(skip)]
    pub key: &'static str,
    /// Where its recordings come from, in words.
    pub what: &'static str,
    /// Shares, figures and every case.
    #[serde(flatten)]
    pub sheet: Sheet,
    /// Sizes found against the true ones.
    pub sizes: Vec<SizeScore>,
}

impl Deref for RouteScore {
    type Target = Sheet;

    fn deref(&self) -> &Sheet {
        &self.sheet
    }
}

impl Keyed for RouteScore {
    fn key(&self) -> &str {
        self.key
    }
}

impl Display for RouteScore {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}\n{}", self.key, self.what, self.sheet)?;
        if !self.sizes.is_empty() {
            writeln!(f, "\nsizes found: median error, within 10 %, 95 % intervals that hold the truth")?;
        }
        for SizeScore { what, median, within, held } in &self.sizes {
            let (median, within, held) = (100.0 * median, counted(*within), counted(*held));
            writeln!(f, "  {what:<60} {median:>6.2} %  {within}  {held}")?;
        }
        Ok(())
    }
}

/// The scores of the routes beside the laboratory's FRFs that have any case.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(transparent)]
pub struct RouteScores(#[serde(serialize_with = "by_key")] pub Vec<RouteScore>);

impl RouteScores {
    /// Scores judged cases.
    pub fn of(judged: &JudgedRoutes) -> Self {
        let JudgedRoutes { solid, struck, as_is, modal_errors, lumped } = judged;
        let all = [
            (!solid.is_empty()).then(|| solid::score(solid)),
            (!struck.is_empty()).then(|| struck::score(struck)),
            (!as_is.is_empty()).then(|| by_name::score(AS_IS, &as_is.iter().collect::<Vec<_>>())),
            (!modal_errors.is_empty())
                .then(|| by_name::score(MODAL_ERRORS, &modal_errors.iter().collect::<Vec<_>>())),
        ];
        let of_lumped = |route: LumpedRoute| {
            let own: Vec<&LumpedJudged> = lumped.iter().filter(|case| case.truth.route == route).collect();
            (!own.is_empty()).then(|| by_name::score(lumped_route(route), &own))
        };
        let lumped = LumpedRoute::ALL.into_iter().filter_map(of_lumped);
        RouteScores(all.into_iter().flatten().chain(lumped).collect())
    }
}

const AS_IS: Route = Route {
    key: "solid_as_is",
    what: "recordings of the finite-element twin of two solid blocks on a strip, nothing idealised",
    rates: WRONG_EVERYWHERE,
};
const MODAL_ERRORS: Route = Route {
    key: "modal_errors",
    what: "recordings of lumped structures with an error in every mode",
    rates: WRONG_EVERYWHERE,
};

fn lumped_route(route: LumpedRoute) -> Route {
    let (what, rates) = match route {
        LumpedRoute::ChannelFlaws => {
            ("recordings of lumped structures by a measuring chain with one flaw or none", ONE_OR_NONE)
        }
        LumpedRoute::LoadPaths => (
            "recordings of lumped structures with one further load path, footings that turn, or neither",
            ONE_OR_NONE,
        ),
        LumpedRoute::UnknownPhysics => {
            ("recordings of lumped structures with physics that no effect is, small and large", UNLISTED)
        }
    };
    Route { key: route.key(), what, rates }
}

impl Display for RouteScores {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|score| write!(f, "\n{score}"))
    }
}
