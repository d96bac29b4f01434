//! `jointscope fem`: a fixture with `geometry` in, the FRFs of its finite-element twin out.

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::time::Instant;

use clap::{Args, ValueEnum};
use jointscope::fem::{
    MeshOptions, ModeKind, ModeRange, Omissions, Progress, Superposition, Twin, calculix_deck,
};

use crate::computed_frfs::ComputedFrfs;
use crate::input::FixtureFile;
use crate::output::Outputs;
use crate::progress::{self, Bar};
use crate::refusal::Refusal;

/// Options of `jointscope fem`.
#[derive(Debug, Args)]
pub(super) struct FemArguments {
    #[command(flatten)]
    pub frfs: ComputedFrfs,
    /// Superpose only the rigid motions and the first N transverse modes [default: all modes up to twice the
    /// last line, and what lies beyond].
    #[arg(long, value_name = "N")]
    pub modes: Option<usize>,
    /// Elements where a strip meets its blocks: its thickness over N.
    #[arg(long, value_name = "N", default_value_t = MeshOptions::default().corner)]
    pub corner: usize,
    /// Elements along a strip, at the least.
    #[arg(long, value_name = "N", default_value_t = MeshOptions::default().along)]
    pub along: usize,
    /// Elements across half a strip's width.
    #[arg(long, value_name = "N", default_value_t = MeshOptions::default().across)]
    pub across: usize,
    /// Factor by which elements grow away from the strips' ends.
    #[arg(long, value_name = "FACTOR", default_value_t = MeshOptions::default().growth)]
    pub growth: f64,
    /// Mesh the whole depth and not its half: torsion and sideways modes come in.
    #[arg(long)]
    pub whole: bool,
    /// Switch off something that the lumped model leaves out, to see what it does.
    #[arg(long, value_name = "WHAT", value_enum, num_args = 1..)]
    pub without: Vec<Omission>,
    /// Also write the mesh as an input deck for CalculiX or Abaqus.
    #[arg(long, value_name = "F.inp")]
    pub deck: Option<PathBuf>,
}

/// What can be switched off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Omission {
    /// The mass of strips and layers.
    JointMass,
    /// Shear deformation of strips.
    Shear,
    /// Bending of strips across their width (Poisson's ratio).
    PlateAction,
    /// The blocks' own flexibility, and with it that of the strips' footing.
    BlockFlexibility,
}

/// Modes below which the deck's program need not look.
const DECK_MODES: usize = 16;

/// Share by which the boxes of `geometry` and the stated bodies may differ without a word.
const AGREEMENT: f64 = 0.01;

/// Computes the twin's FRFs and writes them; answers with the modes and what was written.
pub(super) fn run(arguments: &FemArguments) -> Result<String, Refusal> {
    let asked = &arguments.frfs;
    let fixture = FixtureFile::read(&asked.fixture)?;
    let pairs = asked.pairs(&fixture)?;
    let options = MeshOptions {
        corner: arguments.corner,
        along: arguments.along,
        across: arguments.across,
        growth: arguments.growth,
        whole: arguments.whole,
        without: Omissions {
            joint_mass: arguments.without.contains(&Omission::JointMass),
            shear: arguments.without.contains(&Omission::Shear),
            plate_action: arguments.without.contains(&Omission::PlateAction),
            block_flexibility: arguments.without.contains(&Omission::BlockFlexibility),
        },
    };
    if options.without.shear && arguments.deck.is_some() {
        return Err(Refusal::new(
            "`--deck` writes isotropic materials, and without shear the strips are none: leave one out",
        ));
    }
    let hz = asked.lines.hz();
    let last = hz[hz.len() - 1];
    let range = ModeRange { at_least: arguments.modes.unwrap_or(0).max(4), up_to: 2.0 * last };
    Outputs::foresee([&asked.fixture], [asked.output.clone()].into_iter().chain(arguments.deck.clone()))?;
    let start = Instant::now();
    let bar = progress::bar(STEPS, "{bar:30} {msg} ({elapsed})", "steps: meshing");
    let twin = Twin::of(&fixture, &options, range, |progress| show(&bar, progress));
    drop(bar);
    let twin = twin.map_err(|error| fixture.refusal(error))?;
    let superposition = match arguments.modes {
        None => Superposition::Complete,
        Some(count) => Superposition::First(count),
    };
    let frfs = twin.frfs(&pairs, &asked.lines, superposition).map_err(|error| fixture.refusal(error))?;
    let mut outputs = asked.outputs(&fixture, &frfs, None)?;
    if let Some(deck) = &arguments.deck {
        outputs.add(deck, calculix_deck(&twin.mesh, fixture.name(), DECK_MODES));
    }
    outputs.write()?;
    let elapsed = start.elapsed().as_secs_f64();
    let mut said = summary(&twin, elapsed);
    said.push(asked.written(&frfs));
    Ok(said.join("\n"))
}

fn summary(twin: &Twin, elapsed: f64) -> Vec<String> {
    let mut said = twin.disagreements(AGREEMENT);
    said.push(format!(
        "mesh: {} elements, {} nodes, {} equations, {}; mass {:.4} kg",
        twin.mesh.elements.len(),
        twin.mesh.nodes.len(),
        twin.matrices.order(),
        if twin.mesh.whole { "whole depth" } else { "half the depth" },
        twin.mass()
    ));
    said.push(format!(
        "{} rigid motions, at {:.0e} of the first elastic frequency; residual of the modes {:.0e}; {elapsed:.1} s",
        twin.modes.rigid.len(),
        twin.rigid_frequency(),
        twin.modes.residual
    ));
    let counted = twin.modes.rigid.len() + twin.modes.eigenvalues.len();
    said.push(match twin.modes.complete_below.is_finite() {
        true => format!(
            "{counted} modes, rigid ones included, are all there are below {:.3} Hz, by the count of negative pivots",
            twin.modes.complete_below.sqrt() / TAU
        ),
        false => format!("{counted} modes, rigid ones included, are all there are"),
    });
    for (index, (hz, kind)) in twin.frequencies().iter().zip(&twin.kinds).enumerate() {
        let kind = match kind {
            ModeKind::Transverse => "transverse",
            ModeKind::Other => "not transverse",
        };
        said.push(format!("mode {}: {hz:.3} Hz, {kind}", index + 1));
    }
    said
}

/// Steps of the bar: mesh, matrices, and a hundred for the modes.
const STEPS: u64 = 102;

fn show(bar: &Bar, progress: Progress) {
    match progress {
        Progress::Meshed(nodes, elements) => {
            bar.set_message(format!("steps: {elements} elements, {nodes} nodes"));
            bar.set_position(1);
        }
        Progress::Assembled(equations) => {
            bar.set_message(format!("steps: {equations} equations, factorising"));
            bar.set_position(2);
        }
        Progress::Modes(found, wanted) => {
            bar.set_message(format!("steps: {found} of {wanted} modes"));
            bar.set_position(2 + (100 * found / wanted.max(1)) as u64);
        }
    }
}
