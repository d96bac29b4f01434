//! Cases whose recording comes from a solid as it is: nothing of it idealised.
//!
//! Blocks are as stiff as their material and yield under the strip, the strip weighs, shears and bends as a
//! plate, every mode has a damping ratio of its own. The fixture is what an honest analyst writes: mass and
//! shear of the strip from its dimensions, its footings from a static solve of the nominal solid, each with a
//! standard deviation. No lumped model is right to the noise of such a test.

mod assembly;
mod concealed;
mod footings;
mod names;
mod statics;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

use super::by_name::{Nameable, TrueName};
use super::quiet::quiet_hammer;
use super::solid::twin::read;
use super::solid::{transverse, with_points};
use crate::effect_file::{effect_value, filed_effects};
use crate::generate::{Draw, turn};
use crate::judge::Judge;
use crate::judged::error_on;
use crate::sealable::{Filed, Sealable};
use crate::{Answer, Case, GenerationError, IndependentFits, Judgeable, Judged, Role};
use assembly::{Assembly, UNSTATED};
use concealed::{CONCEALED, Concealed, Size, mount};
use footings::Footings;
use jointscope_fem::{MeshOptions, ModeKind, ModeRange, Omissions, Twin};
use jointscope_fixture::{Effect, Fixture};
use jointscope_rig::{HammerSetup, StructureError, drawn_within_tolerance, generator};
use jointscope_spectra::{FrfSet, SpectraError, SpectralLines};
use names::Gap;
use serde::Deserialize;
use serde_json::{Value, json};

/// How much is hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Nothing, and everything usual is stated.
    Null,
    /// Nothing, and some of what is usual is not stated.
    Gap,
    /// One thing.
    Single,
}

/// By case number, repeating.
const KINDS: [Kind; 8] =
    [Kind::Single, Kind::Null, Kind::Single, Kind::Gap, Kind::Single, Kind::Null, Kind::Single, Kind::Single];
/// Every second gap is a strip that bends as a plate, with nothing of it stated.
const WIDE: usize = 2;
/// Draws of a case before giving up.
const DRAWS: usize = 2000;
/// Spectral lines: first and spacing (Hz), and number. The soft supports' bounce lies below them.
const LINES: (f64, f64, usize) = (20.0, 2.5, 481);
/// Modes up to this multiple of the last line.
const MODES: f64 = 2.0;
/// FRFs of the test, in the order in which a file of them is read.
const RECORDED: [(&str, &str); 4] = [("3", "1"), ("3", "2"), ("4", "1"), ("4", "2")];
/// FRFs at points of the solid that no fixture states.
const UNSEEN: [(&str, &str); 5] = [("91", "91"), ("92", "92"), ("92", "91"), ("91", "1"), ("4", "91")];

/// Fine where strips meet blocks, for their footing is part of the solid; what is left of the mesh's error
/// the static solve has too.
const MESH: MeshOptions =
    MeshOptions { corner: 4, along: 12, across: 2, growth: 3.0, whole: false, without: NOTHING };
const NOTHING: Omissions =
    Omissions { joint_mass: false, shear: false, plate_action: false, block_flexibility: false };

/// What is true of a solid as it is.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct AsIsTruth {
    /// The case's number among all.
    #[serde(rename = "case")]
    pub index: usize,
    /// What its random numbers were seeded with.
    pub source: String,
    /// Whether something usual is left unstated.
    pub gap: bool,
    /// The solid: geometry, what is mounted on it, and points that nobody knows of.
    pub solid: Fixture,
    /// The fixture at its true quantities.
    pub lumped: Fixture,
    /// What is hidden, its size in closed form; nothing or one thing.
    #[serde(skip)]
    pub hidden: Vec<Effect>,
    /// What is true of the solid besides.
    pub also_true: Vec<TrueName>,
    /// How it was measured.
    pub hammer: HammerSetup,
}

impl AsIsTruth {
    /// The case of a number, and apart from it what is true of it.
    pub(crate) fn draw(at: Draw) -> Result<(Case, Self), GenerationError> {
        let Draw { index, number, source, seed, .. } = at;
        let mut random = generator(seed);
        let (kind, turn) = (KINDS[number % KINDS.len()], turn(&KINDS, number));
        let what = (kind == Kind::Single).then(|| CONCEALED[turn % CONCEALED.len()]);
        for _ in 0..DRAWS {
            let gap = match kind {
                Kind::Gap if turn % WIDE == WIDE - 1 => {
                    Gap { strip_mass: true, shear: true, footings: true, wide: true }
                }
                Kind::Gap => Gap::drawn(&mut random),
                _ => Gap::default(),
            };
            let Some(plain) = Assembly::draw(&mut random, gap.wide)? else { continue };
            let nominal = twin(&fixture(&plain.solid()?)?, ModeRange { at_least: 4, up_to: last_line()? })?;
            let footings = Footings::of(&plain, &nominal)?;
            // Where plate action outweighs a footing there is none to be stated.
            if !gap.footings && footings.rotation.iter().any(|compliance| *compliance <= 0.0) {
                continue;
            }
            let assembly = what.map_or(plain.clone(), |what| what.within(plain, &mut random));
            if !assembly.holds_the_strip() {
                continue;
            }
            let lumped = assembly.lumped(Some(gap.stated()), Some(footings))?;
            let size = sizes(&assembly, footings, what)?;
            let hidden: Vec<Effect> =
                what.map(|what| what.effect(&assembly, size, &mut random)).into_iter().collect();
            let mut solid = assembly.solid()?;
            hidden.iter().for_each(|effect| mount(&mut solid, effect));
            let believed = drawn_within_tolerance(&lumped, &mut random)?;
            let truth = AsIsTruth {
                index,
                source,
                gap: gap.is_any(),
                solid: fixture(&solid)?,
                lumped,
                hidden,
                also_true: gap.true_names(size.first_bending),
                hammer: quiet_hammer(&mut random, seed),
            };
            let [clean, _] = truth.frfs()?;
            return Ok((Case { believed, recorded: truth.hammer.measure(&clean)? }, truth));
        }
        Err(GenerationError::Unlucky(index))
    }

    /// Noise-free accelerances: those recorded, as the measuring chain reads them, and those that nobody
    /// records, as a perfect instrument would.
    ///
    /// # Errors
    /// A solid that cannot be meshed or whose modes cannot be found; none of a case that was drawn.
    pub(crate) fn frfs(&self) -> Result<[FrfSet; 2], GenerationError> {
        let lines = lines()?;
        let twin = twin(&self.solid, ModeRange { at_least: 4, up_to: MODES * last_line()? })?;
        Ok([
            read(&twin, &self.hidden, &transverse(RECORDED), &lines)?,
            read(&twin, &[], &transverse(UNSEEN), &lines)?,
        ])
    }
}

fn lines() -> Result<SpectralLines, SpectraError> {
    SpectralLines::even(LINES.0, LINES.1, LINES.2)
}

fn last_line() -> Result<f64, SpectraError> {
    let lines = lines()?;
    Ok(lines.hz()[lines.len() - 1])
}

fn fixture(value: &Value) -> Result<Fixture, GenerationError> {
    Ok(Fixture::from_value(value).map_err(StructureError::from)?)
}

fn twin(solid: &Fixture, range: ModeRange) -> Result<Twin, GenerationError> {
    Ok(Twin::of(solid, &MESH, range, |_| ())?)
}

/// What only the solid itself tells: how its blocks bend, and how much more than its footing a layer yields.
fn sizes(assembly: &Assembly, footings: Footings, what: Option<Concealed>) -> Result<Size, GenerationError> {
    let mut size = Size::default();
    for which in 0..2 {
        let alone = twin(&assembly.block_alone(which)?, ModeRange { at_least: 6, up_to: last_line()? })?;
        let mut modes = alone.frequencies().into_iter().zip(&alone.kinds);
        let bending = modes.find(|(_, kind)| **kind == ModeKind::Transverse);
        size.first_bending[which] = bending.map_or(f64::INFINITY, |(hz, _)| hz);
    }
    if let (Some(Concealed::Glue), Some(layer)) = (what, assembly.layer) {
        let solid = twin(&fixture(&assembly.solid()?)?, ModeRange { at_least: 4, up_to: last_line()? })?;
        let glued = Footings::of(assembly, &solid)?;
        size.layer_stiffness = (glued.rotation[layer.end] - footings.rotation[layer.end]).recip();
    }
    Ok(size)
}

impl Sealable for AsIsTruth {
    fn to_value(&self) -> Value {
        json!({
            "case": self.index,
            "route": "solid_as_is",
            "source": self.source,
            "gap": self.gap,
            "hidden": Judgeable::hidden(self),
            "right": self.hidden.iter().map(effect_value).collect::<Vec<_>>(),
            "also_true": self.also_true,
            "lumped": self.lumped,
            "solid": self.solid,
            "hammer": self.hammer,
        })
    }
}

impl Filed for AsIsTruth {
    fn from_value(value: &Value) -> Option<Self> {
        let hidden = filed_effects(&value["lumped"], &value["right"])?;
        Some(AsIsTruth { hidden, ..AsIsTruth::deserialize(value).ok()? })
    }
}

impl Judgeable for AsIsTruth {
    fn index(&self) -> usize {
        self.index
    }

    fn role(&self) -> Role {
        if self.hidden.is_empty() { Role::Null } else { Role::Single }
    }

    fn effects(&self) -> &[Effect] {
        &self.hidden
    }

    fn hidden(&self) -> String {
        match self.hidden.first() {
            Some(effect) => crate::describe(effect),
            None if self.gap => {
                let stated: Vec<_> = self.lumped.physics().iter().map(|effect| effect.kind.name()).collect();
                format!(
                    "nothing; of the strip stated: {}",
                    if stated.is_empty() { "nothing".into() } else { stated.join(", ") }
                )
            }
            None => "nothing".to_owned(),
        }
    }

    fn independent_fits(&self, case: &Case, answer: &Answer) -> Option<IndependentFits> {
        let [clean, unseen] = self.frfs().ok()?;
        let judge = Judge::of(case)?;
        let error = |fixture: &Fixture| error_on(&unseen, &with_points(fixture, &self.solid, UNSTATED)?);
        Some(IndependentFits {
            truth: judge.objective_of_clean(&clean, &self.lumped)?,
            unseen: error(&answer.refitted).zip(error(&answer.repaired)).map(Into::into),
            ..IndependentFits::of_answer(&judge, answer)?
        })
    }
}

impl Nameable for AsIsTruth {
    fn is_gap(&self) -> bool {
        self.gap
    }

    fn stands_for(&self, _: &Effect, _: &IndependentFits) -> bool {
        false
    }

    fn is_true(&self, found: &Effect) -> bool {
        self.also_true.iter().any(|name| name.is_of(found))
    }

    /// Sizes are drawn so that all show.
    fn shows(_: &Judged<Self>) -> bool {
        true
    }
}
