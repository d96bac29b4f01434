//! Random assemblies of several kinds, as an analyst would state them.

mod blocks;
pub(crate) mod elastic;
mod frame;
mod statement;

use crate::StructureError;
use elastic::elastic_frequencies;
use jointscope_fixture::Fixture;
use jointscope_spectra::FrfPair;
use rand::Rng;

/// Kinds of assembly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Family {
    /// Two free blocks and a beam, points 1 to 4: the paper's fixture.
    TwoBlocks,
    /// The same on two soft supports.
    SupportedTwoBlocks,
    /// Three free blocks in a row and two beams, points 1 to 7.
    ThreeBlocks,
    /// Storeys that do not rotate, with springs between neighbours.
    Frame,
    /// A deformable beam that carries a block at its end by a short beam.
    BeamAndBlock,
}

/// Draws of a fixture until its modes suit the band; of a thousand, fewer than ten need as many as this.
const DRAWS: usize = 200;

impl Family {
    /// Every family.
    pub const ALL: [Family; 5] = [
        Family::TwoBlocks,
        Family::SupportedTwoBlocks,
        Family::ThreeBlocks,
        Family::Frame,
        Family::BeamAndBlock,
    ];

    /// A random fixture of the family, with stated standard deviations: masses of 0.2 to 8 kg, its rigid
    /// bodies' elastic modes between 15 and 1000 Hz, damping as modal ratios, Rayleigh constants or a loss
    /// factor.
    ///
    /// # Errors
    /// A fixture that cannot be built, which would be a mistake in the family.
    pub fn draw(self, name: &str, rng: &mut impl Rng) -> Result<Fixture, StructureError> {
        let mut drawn = self.draw_once(name, rng)?;
        for _ in 1..DRAWS {
            if self.suits_the_band(&drawn)? {
                break;
            }
            drawn = self.draw_once(name, rng)?;
        }
        Ok(drawn)
    }

    fn draw_once(self, name: &str, rng: &mut impl Rng) -> Result<Fixture, StructureError> {
        match self {
            Family::TwoBlocks => blocks::row(name, rng, 2, false),
            Family::SupportedTwoBlocks => blocks::row(name, rng, 2, true),
            Family::ThreeBlocks => blocks::row(name, rng, 3, false),
            Family::BeamAndBlock => blocks::beam_and_block(name, rng),
            Family::Frame => frame::storeys(name, rng),
        }
    }

    fn suits_the_band(self, fixture: &Fixture) -> Result<bool, StructureError> {
        let modes = elastic_frequencies(fixture)?;
        let lowest = modes.first().copied().unwrap_or(0.0);
        // A deformable body has modes without end: there the band only has to hold some.
        let within = modes.iter().filter(|f| **f < 1000.0).count();
        Ok(lowest > 15.0 && (within == modes.len() || (self == Family::BeamAndBlock && within >= 3)))
    }

    /// The FRFs that a test of the family usually records: two responses to each of two references.
    pub fn usual_pairs(self) -> Vec<FrfPair> {
        let pairs: &[(&str, &str)] = match self {
            Family::ThreeBlocks => &[
                ("7", "1"),
                ("3", "1"),
                ("4", "1"),
                ("6", "1"),
                ("7", "2"),
                ("3", "2"),
                ("4", "2"),
                ("6", "2"),
            ],
            _ => &[("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")],
        };
        pairs.iter().map(|(response, reference)| FrfPair::transverse(response, reference)).collect()
    }
}
