//! Which FRFs of a recording cross a joint, and which of them tell the motion of one side due to loads on the
//! other.

use crate::Sides;
use jointscope_frf::{BlockChannel, BlockLayout};
use jointscope_spectra::{Channel, FrfPair, FrfSet};

/// What a recording lacks for finding a joint.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CrossingError {
    /// No FRF crosses the joint.
    #[error(
        "no FRF of the recording crosses joint `{joint}`: needed are hammer points on one side ({alpha}) and sensors on the other ({beta}); the recording has {found}"
    )]
    NothingCrosses {
        /// The joint.
        joint: String,
        /// Points on side α.
        alpha: String,
        /// Points on side β.
        beta: String,
        /// FRFs of the recording.
        found: String,
    },
    /// Some crossing FRFs, but not enough.
    #[error(
        "the FRFs across joint `{joint}` ({found}) do not tell displacement from rotation on both sides; missing {missing}"
    )]
    NotEnough {
        /// The joint.
        joint: String,
        /// The FRFs that cross it.
        found: String,
        /// What would complete them.
        missing: String,
    },
    /// The only measured body on a side bends.
    #[error(
        "body `{body}` bends, so its motion cannot be reduced to displacement and rotation of a rigid block: joint `{joint}` needs sensors and hammer points on rigid bodies"
    )]
    Deformable {
        /// The joint.
        joint: String,
        /// The body.
        body: String,
    },
    /// A block that rotates faces one that does not.
    #[error(
        "joint `{joint}` is measured from body `{rotating}`, which rotates, and body `{other}`, which does not: its 2×2 stiffness cannot be told from one coordinate"
    )]
    Mixed {
        /// The joint.
        joint: String,
        /// The rotating body.
        rotating: String,
        /// The other one.
        other: String,
    },
}

/// Which FRFs of a recording tell the motion of a block on side β due to loads on a block on side α, and the
/// reference points on the two.
///
/// FRFs with the hammer on β and the sensor on α count by reciprocity.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossingFrfs {
    /// The FRFs and their positions, as [`jointscope_frf::fit_rigid_motion`] wants them.
    pub layout: BlockLayout,
    /// Body and abscissa (m) of the loaded block's reference point, "1", and the point's name.
    pub loaded: (usize, f64, String),
    /// Body and abscissa (m) of the responding block's reference point, "4", and the point's name.
    pub responding: (usize, f64, String),
    /// FRFs of the recording that are not used.
    pub unused: Vec<FrfPair>,
}

/// An FRF that crosses the joint: index, channel on α, channel on β.
struct Crossing<'a> {
    index: usize,
    alpha: Position<'a>,
    beta: Position<'a>,
}

impl CrossingFrfs {
    /// Chooses the FRFs: those between the pair of blocks, one on each side, that most FRFs connect; of
    /// equals, the blocks that the joint itself connects.
    ///
    /// # Errors
    /// See [`CrossingError`].
    pub(crate) fn of(frfs: &FrfSet, sides: &Sides) -> Result<Self, CrossingError> {
        let crossings = crossings(frfs, sides);
        if crossings.is_empty() {
            return Err(nothing_crosses(frfs, sides));
        }
        let fixture = sides.fixture();
        let [near, far] = [sides.joint().from, sides.joint().to].map(|p| fixture.points()[p].body);
        let mut pairs: Vec<(usize, usize)> = crossings.iter().map(|c| (c.alpha.0, c.beta.0)).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let count =
            |pair: &(usize, usize)| crossings.iter().filter(|c| (c.alpha.0, c.beta.0) == *pair).count();
        let own = |pair: &(usize, usize)| usize::from(pair.0 == near) + usize::from(pair.1 == far);
        let bends = |body: usize| fixture.bodies()[body].kind.is_beam();
        let rigid: Vec<_> = pairs.iter().filter(|p| !bends(p.0) && !bends(p.1)).copied().collect();
        let Some(&(alpha, beta)) = rigid.iter().max_by_key(|p| (count(p), own(p))) else {
            let body = pairs.iter().flat_map(|p| [p.0, p.1]).find(|&b| bends(b)).unwrap_or(near);
            return Err(CrossingError::Deformable {
                joint: sides.joint().name.clone(),
                body: fixture.bodies()[body].name.clone(),
            });
        };
        Self::between(frfs, sides, &crossings, alpha, beta)
    }

    fn between(
        frfs: &FrfSet,
        sides: &Sides,
        crossings: &[Crossing],
        alpha: usize,
        beta: usize,
    ) -> Result<Self, CrossingError> {
        let fixture = sides.fixture();
        let rotates = |body: usize| fixture.bodies()[body].kind.rotates();
        if rotates(alpha) != rotates(beta) {
            let (rotating, other) = if rotates(alpha) { (alpha, beta) } else { (beta, alpha) };
            return Err(CrossingError::Mixed {
                joint: sides.joint().name.clone(),
                rotating: fixture.bodies()[rotating].name.clone(),
                other: fixture.bodies()[other].name.clone(),
            });
        }
        let used: Vec<&Crossing> =
            crossings.iter().filter(|c| c.alpha.0 == alpha && c.beta.0 == beta).collect();
        let [near, far] = [sides.joint().from, sides.joint().to].map(|p| fixture.points()[p].x.value);
        // `used` is not empty: the pair of blocks was taken from the crossings.
        let (Some(loaded), Some(responding)) =
            (farthest(used.iter().map(|c| c.alpha), near), farthest(used.iter().map(|c| c.beta), far))
        else {
            return Err(nothing_crosses(frfs, sides));
        };
        let position = |(_, x, channel): Position, reference: f64| BlockChannel {
            offset: x - reference,
            dof: channel.dof,
        };
        let channels = used
            .iter()
            .map(|c| (c.index, position(c.beta, responding.1), position(c.alpha, loaded.1)))
            .collect();
        let layout = BlockLayout { channels, rotate: [rotates(beta), rotates(alpha)] };
        check_complete(frfs, sides, &used, &layout)?;
        let unused = frfs
            .pairs()
            .iter()
            .enumerate()
            .filter(|(index, _)| used.iter().all(|c| c.index != *index))
            .map(|(_, pair)| pair.clone())
            .collect();
        let named = |(body, x, channel): Position| (body, x, channel.point.clone());
        Ok(CrossingFrfs { layout, loaded: named(loaded), responding: named(responding), unused })
    }

    /// Whether the blocks do not rotate, so that the joint is the scalar of eq (5).
    pub(crate) fn is_scalar(&self) -> bool {
        !self.layout.rotate[0]
    }
}

/// A channel's body, abscissa and name.
type Position<'a> = (usize, f64, &'a Channel);

/// The position farthest from the joint's end, the first of equals: the paper's points 1 and 4.
fn farthest<'a>(positions: impl Iterator<Item = Position<'a>>, end: f64) -> Option<Position<'a>> {
    positions.fold(None, |best: Option<Position<'a>>, position| match best {
        Some(b) if (b.1 - end).abs() >= (position.1 - end).abs() => Some(b),
        _ => Some(position),
    })
}

fn crossings<'a>(frfs: &'a FrfSet, sides: &Sides) -> Vec<Crossing<'a>> {
    let position = |channel: &'a Channel| {
        sides.fixture().point(&channel.point).map(|point| (point.body, point.x.value, channel))
    };
    let mut all = Vec::new();
    for (index, pair) in frfs.pairs().iter().enumerate() {
        let (Some(response), Some(reference)) = (position(&pair.response), position(&pair.reference)) else {
            continue;
        };
        match (sides.is_on_alpha(reference.0), sides.is_on_alpha(response.0)) {
            (true, false) => all.push(Crossing { index, alpha: reference, beta: response }),
            (false, true) => all.push(Crossing { index, alpha: response, beta: reference }),
            _ => {}
        }
    }
    all
}

fn nothing_crosses(frfs: &FrfSet, sides: &Sides) -> CrossingError {
    let points = |alpha: bool| {
        let names = sides.fixture().points().iter().filter(|p| sides.is_on_alpha(p.body) == alpha);
        names.map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ")
    };
    CrossingError::NothingCrosses {
        joint: sides.joint().name.clone(),
        alpha: points(true),
        beta: points(false),
        found: names(frfs.pairs()),
    }
}

fn names(pairs: &[FrfPair]) -> String {
    pairs.iter().map(FrfPair::to_string).collect::<Vec<_>>().join(", ")
}

/// Every combination of the measured channels must be there, and two abscissae on each rotating side.
fn check_complete(
    frfs: &FrfSet,
    sides: &Sides,
    used: &[&Crossing],
    layout: &BlockLayout,
) -> Result<(), CrossingError> {
    let distinct = |channels: Vec<&Channel>| {
        let mut all: Vec<Channel> = channels.into_iter().cloned().collect();
        all.sort();
        all.dedup();
        all
    };
    let alpha = distinct(used.iter().map(|c| c.alpha.2).collect());
    let beta = distinct(used.iter().map(|c| c.beta.2).collect());
    let fail = |missing: String| {
        let found = used.iter().map(|c| frfs.pairs()[c.index].clone()).collect::<Vec<_>>();
        Err(CrossingError::NotEnough { joint: sides.joint().name.clone(), found: names(&found), missing })
    };
    let needed = if layout.rotate[0] { 2 } else { 1 };
    if beta.len() < needed {
        return fail(format!("a second sensor at another abscissa than point {}", beta[0]));
    }
    if alpha.len() < needed {
        return fail(format!("a second hammer point at another abscissa than point {}", alpha[0]));
    }
    if used.len() < needed * needed {
        let missing: Vec<String> = beta
            .iter()
            .flat_map(|b| alpha.iter().map(move |a| (b, a)))
            .filter(|(b, a)| used.iter().all(|c| c.beta.2 != *b || c.alpha.2 != *a))
            .map(|(b, a)| FrfPair::new(b.clone(), a.clone()).to_string())
            .collect();
        return fail(format!("FRF {}", missing.join(", ")));
    }
    Ok(())
}
