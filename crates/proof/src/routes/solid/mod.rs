//! Cases whose recording comes from a solid: the finite-element twin of two blocks on a strip.
//!
//! The diagnosis believes in the lumped fixture of the same assembly. Of all that a solid has beyond it (the
//! strip's mass and shear, layers, plate action, blocks and footing that yield) only what is concealed is
//! left on, and every quantity of the fixture lies within its tolerance of the solid's own. So what is
//! concealed has a name, and a size in closed form.

pub(super) mod assembly;
mod damping;
mod hidden;
mod judged;
mod score;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
pub(super) mod twin;

pub(crate) use judged::SolidJudged;
pub use twin::Shown;

use crate::effect_file::{effect_value, filed_effects};
use crate::generate::{Draw, turn};
use crate::hammer_test::{drawn_hammer, recorded_lines};
use crate::sealable::{Filed, Sealable};
use crate::{Case, GenerationError, Judgeable, Role};
use assembly::{Assembly, StripShape};
use hidden::{CONCEALED, Hidden, IN_THE_SOLID};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_rig::{HammerSetup, StructureError, drawn_within_tolerance, generator};
use jointscope_spectra::{FrfPair, FrfSet};
use rand::{Rng, RngExt};
use serde::Deserialize;
use serde_json::{Value, json};

pub(crate) use score::score;

/// What is true of a solid case.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct SolidTruth {
    /// The case's number among all.
    #[serde(rename = "case")]
    pub index: usize,
    /// What its random numbers were seeded with.
    pub source: String,
    /// How much was hidden.
    pub role: Role,
    /// The solid: the fixture's true quantities with `geometry`, and what is mounted on it; points that
    /// nobody knows of included.
    pub solid: Fixture,
    /// What is left on, of all that the lumped model leaves out.
    pub shown: Shown,
    /// The lumped fixture at its true quantities, what is hidden as its `physics`, sizes in closed form.
    pub lumped: Fixture,
    /// Effects that come with what is hidden and are true if found, though they are not asked for.
    #[serde(skip)]
    pub besides: Vec<Effect>,
    /// How it was measured.
    pub hammer: HammerSetup,
}

/// Roles by case number, repeating.
const ROLES: [Role; 8] = [
    Role::Single,
    Role::Null,
    Role::Single,
    Role::Single,
    Role::Double,
    Role::Single,
    Role::Null,
    Role::Single,
];
/// Draws of a case before giving up.
const DRAWS: usize = 2000;
/// FRFs of the test, in the order in which a file of them is read.
const RECORDED: [(&str, &str); 4] = [("3", "1"), ("3", "2"), ("4", "1"), ("4", "2")];
/// Points of the solid that no fixture states.
const APART: [&str; 2] = ["5", "6"];
/// FRFs that nobody records: at those points and between them and what was measured.
const UNSEEN: [(&str, &str); 6] = [("5", "5"), ("6", "6"), ("6", "5"), ("5", "1"), ("4", "5"), ("6", "2")];

impl SolidTruth {
    /// The case of a number, and apart from it what is true of it.
    pub(crate) fn draw(at: Draw) -> Result<(Case, Self), GenerationError> {
        let Draw { index, number, source, seed, .. } = at;
        let mut random = generator(seed);
        let role = ROLES[number % ROLES.len()];
        let pairs = transverse(RECORDED);
        for _ in 0..DRAWS {
            let what = concealed(role, number, &mut random);
            let shape = what.iter().map(|what| what.shape()).find(|s| *s == StripShape::Thick);
            let Some(assembly) = Assembly::draw(&mut random, shape.unwrap_or(StripShape::Slender))? else {
                continue;
            };
            let mut hidden = Some(Hidden::default());
            for what in what {
                hidden = match hidden {
                    Some(hidden) => hidden.conceal(what, &assembly, &pairs, &mut random)?,
                    None => None,
                };
            }
            let Some(hidden) = hidden else { continue };
            let hammer = drawn_hammer(&mut random, seed);
            let solid = solid(&assembly, &hidden, &mut random)?;
            let believed = drawn_within_tolerance(&assembly.lumped, &mut random)?;
            let lumped = assembly.lumped.with_physics(hidden.effects).map_err(StructureError::from)?;
            let (shown, besides) = (hidden.shown, hidden.besides);
            let Some(solid) = damping::as_without(solid, &shown, &lumped, &besides)? else { continue };
            let truth = SolidTruth { index, source, role, solid, shown, lumped, besides, hammer };
            let [clean, _] = truth.frfs()?;
            return Ok((Case { believed, recorded: hammer.measure(&clean)? }, truth));
        }
        Err(GenerationError::Unlucky(index))
    }

    /// Noise-free accelerances: those recorded, as the measuring chain reads them, and those that nobody
    /// records, as a perfect instrument would.
    ///
    /// # Errors
    /// A solid that cannot be meshed or whose modes cannot be found; none of a case that was drawn.
    pub(crate) fn frfs(&self) -> Result<[FrfSet; 2], GenerationError> {
        self.frfs_on(&twin::MESH)
    }

    fn frfs_on(&self, mesh: &jointscope_fem::MeshOptions) -> Result<[FrfSet; 2], GenerationError> {
        let lines = recorded_lines()?;
        let twin = twin::twin(&self.solid, &self.shown, mesh, lines.hz()[lines.len() - 1])?;
        Ok([
            twin::read(&twin, self.effects(), &transverse(RECORDED), &lines)?,
            twin::read(&twin, &[], &transverse(UNSEEN), &lines)?,
        ])
    }
}

impl Filed for SolidTruth {
    fn from_value(value: &Value) -> Option<Self> {
        let besides = filed_effects(&value["lumped"], &value["besides"])?;
        Some(SolidTruth { besides, ..SolidTruth::deserialize(value).ok()? })
    }
}

impl Sealable for SolidTruth {
    fn to_value(&self) -> Value {
        json!({
            "case": self.index,
            "route": "solid",
            "source": self.source,
            "role": self.role,
            "hidden": self.hidden(),
            "lumped": self.lumped,
            "besides": self.besides.iter().map(effect_value).collect::<Vec<_>>(),
            "solid": self.solid,
            "shown": self.shown,
            "hammer": self.hammer,
        })
    }
}

/// A fixture of the same assembly with the points of a solid at which nobody measured.
pub(super) fn with_points(fixture: &Fixture, solid: &Fixture, names: [&str; 2]) -> Option<Fixture> {
    let (mut value, known) = (fixture.to_value(), solid.to_value());
    for name in names {
        value["points"][name] = known["points"][name].clone();
    }
    Fixture::from_value(&value).ok()
}

pub(super) fn transverse<const N: usize>(pairs: [(&str, &str); N]) -> [FrfPair; N] {
    pairs.map(|(response, reference)| FrfPair::transverse(response, reference))
}

/// What is concealed in a case: singles take all in turn, of two the first is in the solid itself.
fn concealed(role: Role, number: usize, random: &mut impl Rng) -> Vec<hidden::Concealed> {
    match role {
        Role::Single => vec![CONCEALED[turn(&ROLES, number) % CONCEALED.len()]],
        Role::Double => {
            let first = random.random_range(0..IN_THE_SOLID);
            let step = random.random_range(1..CONCEALED.len());
            vec![CONCEALED[first], CONCEALED[(first + step) % CONCEALED.len()]]
        }
        _ => Vec::new(),
    }
}

/// The fixture that is meshed: true quantities, geometry, what is mounted, and points where something is read
/// elsewhere or not at all.
fn solid(assembly: &Assembly, hidden: &Hidden, random: &mut impl Rng) -> Result<Fixture, GenerationError> {
    let mut value = assembly.lumped.to_value();
    value["geometry"] = assembly.geometry(hidden.layer.map(|l| (l.end, l.thickness, l.modulus)));
    for ((name, body), x) in APART.iter().zip(["A", "B"]).zip(assembly.apart(random)) {
        value["points"][*name] = json!({ "body": body, "x": x });
    }
    for effect in &hidden.effects {
        match (&effect.place, effect.kind) {
            (Place::Body(body), EffectKind::AddedMass) => {
                value["bodies"][body.as_str()]["masses"] =
                    json!([{ "x": effect.value(0), "mass": effect.value(1) }]);
            }
            (Place::Body(body), EffectKind::Support) => {
                value["supports"] = json!({ "S": {
                    "body": body, "x": effect.value(0), "stiffness": effect.value(1), "damping": effect.value(2) } });
            }
            (Place::Point(point), EffectKind::PointOffset) => {
                let Some(known) = assembly.lumped.point(point) else { continue };
                let body = &assembly.lumped.bodies()[known.body].name;
                value["points"][twin::displaced_name(point)] =
                    json!({ "body": body, "x": known.x.value + effect.value(0) });
            }
            _ => {}
        }
    }
    Ok(Fixture::from_value(&value).map_err(StructureError::from)?)
}
