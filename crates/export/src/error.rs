//! What keeps a joint or a repaired fixture from being exported; some of it `--anyway` overrides.

use crate::{Form, Program};

/// Why nothing is exported.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// A decomposition that does not say where its joint acts.
    #[error(
        "`ends` is missing: the file does not say over which length its joint acts; make it anew with `jointscope decompose`"
    )]
    NoEnds,
    /// The estimate is of no use.
    #[error("the joint is judged unusable: {0}; `--anyway` exports it all the same")]
    Unusable(String),
    /// A diagnosis that nothing explains.
    #[error(
        "the diagnosis is `unexplained`: nothing that can be named explains the recording, so the repaired fixture is no model of it; `--anyway` exports it all the same"
    )]
    Unexplained,
    /// There is no joint by the exact relation.
    #[error(
        "there is no fitted joint, and averages by eq (7) are not the joint's own matrices; decompose with `--relation exact`"
    )]
    OnlyPaper,
    /// No estimate at all.
    #[error("the file has no estimate of the joint; make it anew with `jointscope decompose`")]
    NoEstimate,
    /// Lines of another relation.
    #[error(
        "the lines are by eq (7), which are not the joint's own matrices; decompose with `--relation exact` for `--by-line`"
    )]
    PaperLines,
    /// No line is left.
    #[error("no line can be used for `--by-line`: {0}")]
    NoLines(String),
    /// An entry of `diagnosis.json`.
    #[error("`{0}` is missing or not what it should be; make the file anew with `jointscope diagnose`")]
    Diagnosis(String),
    /// There is no such joint.
    #[error("there is no joint `{name}`; choose one of {known}")]
    NoSuchJoint {
        /// The name asked for.
        name: String,
        /// The joints there are.
        known: String,
    },
    /// Node numbers for one joint of several.
    #[error("the fixture has the joints {known}: choose one with `--joint` for `--nodes`")]
    WhichJoint {
        /// The joints there are.
        known: String,
    },
    /// Node numbers without a joint.
    #[error("the fixture has no joint, so `--nodes` has nothing to number; leave it out")]
    NoJoint,
    /// Nothing is there to be exported.
    #[error(
        "there is nothing to export: the fixture has neither joints nor supports, and nothing was found that has a counterpart in a finite-element model"
    )]
    Nothing,
    /// A number that no program's field holds.
    #[error(
        "{0} has a number beyond 1e90, which no structure has: check the values of the fixture or recording that it was made of"
    )]
    TooLarge(String),
    /// A node number outside what programs read.
    #[error("{0} is no node number: 1 to 99000000 are, and those above are kept for what the file adds")]
    NodeNumber(u64),
    /// One number for two nodes.
    #[error("`--nodes` names node {0} twice; the joint needs two different ones")]
    NodeTwice(u64),
    /// A form that the program does not have.
    #[error("`--form {form}` is not one of {program}'s: it has {known}")]
    FormOf {
        /// The form asked for.
        form: Form,
        /// The program.
        program: Program,
        /// What it has.
        known: &'static str,
    },
    /// Frequency-dependent joints are not written for the program.
    #[error(
        "`--by-line` is for nastran, csv and json: the elements written for {0} do not depend on frequency"
    )]
    ByLine(Program),
    /// DMIG by line.
    #[error(
        "`--by-line` needs a CBUSH, for DMIG does not depend on frequency; leave `--form dmig` or `--by-line` out"
    )]
    DmigByLine,
    /// A matrix without an elastic centre.
    #[error(
        "joint {joint}: {matrix} has no elastic centre (its element 11 is not positive), so {form}; {remedy}"
    )]
    NoCentre {
        /// The joint.
        joint: String,
        /// `K` or `C`.
        matrix: &'static str,
        /// What cannot be written.
        form: &'static str,
        /// What to do instead.
        remedy: &'static str,
    },
    /// C is not about the centre of K.
    #[error(
        "joint {joint}: {matrix} does not act about the elastic centre of K, which a CBUSH needs; leave `--form bush` out or take `--form dmig`"
    )]
    Centres {
        /// The joint.
        joint: String,
        /// Which damping.
        matrix: &'static str,
    },
}
